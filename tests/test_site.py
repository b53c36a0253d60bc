"""The site: public names by topic, docstrings, formulas, links, the gallery, and the whole of it without a warning."""

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

import symfpu
from tests.system import raising

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))

import make_site  # noqa: E402
from docutils.utils.math import MathError  # noqa: E402
from press import check, formulas, gallery, links, topics  # noqa: E402

VERDICTS = ("holds", "holds in part", "does not hold", "undecided")


def test_every_public_name_is_in_one_topic():
    names = [name for topic in topics.topics() for name in topic.names]
    pictures = re.findall(r"(\w+) as \1,?$", (ROOT / "symfpu/plots/__init__.py").read_text(), re.MULTILINE)
    flat = {f"symfpu.{name}" for name in symfpu.__all__} - {"symfpu.plots"}
    assert sorted(names) == sorted([*flat, *(f"symfpu.plots.{name}" for name in pictures)])


def test_what_results_inherit_is_shared_and_not_public():
    shared = topics.shared_classes(["symfpu.Torus", "symfpu.Assessment", "symfpu.Orbit"])
    assert "symfpu.results.result.Result" in shared
    assert not {name.rpartition(".")[2] for name in shared} & set(symfpu.__all__)


def test_a_formula_is_drawn_by_the_browser():
    assert formulas.mathml(r"$\dots \log t / t$", block=False).startswith("<math")
    with pytest.raises(MathError):
        formulas.mathml(r"\nosuchcommand{x}", block=False)


@pytest.mark.parametrize(
    ("target", "docname", "page"),
    [
        ("../symfpu/chain/chain.py", "equations", "_files/symfpu/chain/chain.py"),
        ("../notebooks/02_torus.ipynb", "plots", "tutorials/02_torus"),
        ("docs/errata.md", "index", "errata"),
        ("../docs/toda.md", "tutorials/06_potentials_and_rings", "toda"),
        ("../generated", "export", "_files/generated"),
    ],
)
def test_links_of_a_code_host_are_links_of_the_site(target, docname, page):
    assert links.page_of(links.repository_path(target, docname)) == page


def test_a_link_to_nothing_is_none():
    assert links.repository_path("../symfpu/nowhere.py", "equations") is None


def test_equations_are_found_where_they_are_cited():
    assert [found[0] for found in links.CITED.finditer("(Eqs. moda, modb) or Eq. omeser; Eq. nothing")] == ["Eqs. moda, modb", "Eq. omeser"]


@pytest.mark.long
@pytest.mark.filterwarnings("ignore")
def test_an_example_without_a_picture_is_refused(tmp_path):
    with pytest.raises(ValueError, match="draws 0 figures"):
        gallery.run(gallery.Example("none", "None", "", "a = 1"), tmp_path / "none.png")


def test_the_paper_s_page_counts_its_verdicts():
    claims = (ROOT / "docs/errata.md").read_text().split("## Claims of sections")[1]
    kinds = "|".join(sorted(VERDICTS, key=len, reverse=True))
    counts = [Counter(re.findall(rf"\| \**({kinds})\** \|", part)) for part in claims.split("\n### ")[1:]]
    rows = re.findall(r"^\| \[[^]]+\]\(errata\.md#\S+\) \|(.*)\|$", (ROOT / "docs/paper.md").read_text(), re.MULTILINE)
    printed = [[int(cell.strip() or 0) for cell in row.split("|")] for row in rows]
    assert printed == [[found[verdict] for verdict in VERDICTS] for found in counts]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The whole site, built as `make docs` does, which fails for a lost link and for an example of the gallery that does not run."""
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, str(ROOT / "docs/make_site.py"), str(folder)]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr[-3000:]
    return check.pages(folder / "html")


@pytest.mark.long
def test_the_site_has_its_pages(site):
    names = {page.removesuffix(".html") for page in site}
    written = {path.stem for path in (ROOT / "docs").glob("*.md")}
    tutorials = {f"tutorials/{path.stem}" for path in (ROOT / "notebooks").glob("*.ipynb")}
    examples = {f"gallery/{example.name}" for example in gallery.examples()}
    assert names >= written | tutorials | examples | {f"api/{topic.slug}" for topic in topics.topics()} | {"search"}
    documented = set.union(*(page.targets for page in site.values()))
    assert {f"symfpu.{name}" for name in symfpu.__all__} - {"symfpu.plots"} <= documented


LINKS = {
    "index.html": True,
    "#here": True,
    "part/page.html#there": True,
    "part/picture.png": True,
    "https://example.org/#x": True,
    "part/nowhere.html": False,
    "part/nowhere.png": False,
    "#there": False,
    "part/page.html#here": False,
    "../index.html": False,
}


@pytest.mark.parametrize(("link", "leads"), LINKS.items(), ids=LINKS)
def test_lost_links_are_found(link, leads, tmp_path):
    (tmp_path / "part").mkdir()
    (tmp_path / "part" / "picture.png").touch()
    (tmp_path / "index.html").write_text(f'<p id="here"><a href="{link}">a</a></p>')
    (tmp_path / "part" / "page.html").write_text('<a name="there" href="../index.html#here">b</a>')
    expected = [] if leads else [("index.html", link)]
    assert check.lost_in(tmp_path) == expected


def test_links_without_a_network_say_so_in_one_line(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(check.socket, "create_connection", raising(OSError()))
    (tmp_path / "a.md").write_text("[a](https://example.org/page) [b](http://example.com)")
    assert check.silent_hosts(tmp_path.glob("*.md")) == ["example.com", "example.org"]
    assert make_site.ask(tmp_path) == 1
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "panel.holoviz.org" in said
    assert not (tmp_path / "pages").exists()


@pytest.mark.long
def test_pages_load_nothing_from_elsewhere(site):
    assert {one for page in site.values() for one in page.loaded if re.match(r"(https?:)?//", one)} == set()


@pytest.mark.long
@pytest.mark.parametrize(("text", "code"), [("[a](index.md#title)", 0), ("[a](nowhere.md)", 1), ("[a](index.md#none)", 1)])
def test_a_lost_link_is_an_error(text, code, tmp_path):
    (tmp_path / "index.md").write_text(f"# Title\n\n{text}\n")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "-n", "-C", "-D", "extensions=myst_parser", "-D", "myst_heading_anchors=3"]
    assert subprocess.run([*command, str(tmp_path), str(tmp_path / "out")], capture_output=True, check=False).returncode == code
