"""Builds the site: lays out the pages of docs/, the notebooks, the API and the gallery, and runs Sphinx over them.

    python docs/make_site.py FOLDER [--links]

FOLDER/html/index.html is its first page; links within the site lead to pages and anchors that are there, or it is an error.
--links : ask the network whether links to elsewhere lead somewhere, and build nothing; one line says so where there is no network.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

os.environ.setdefault("MPLBACKEND", "agg")
DOCS = Path(__file__).parent
ROOT = DOCS.parent
sys.path.insert(0, str(DOCS))

from press import check, gallery, topics  # noqa: E402

SAME = ("*.md", "*.png", "conf.py")
CONTENTS = re.compile(r"^:::\{toctree\}\n(.*?)^:::$", re.MULTILINE | re.DOTALL)
STRICT = ["-W", "--keep-going", "-n", "-q"]
TUTORIALS = """# Tutorials

The notebooks of [notebooks/](../notebooks), with the results that are stored in them; tests run them.

:::{{toctree}}
:maxdepth: 1

{names}
:::
"""


def lay_out(folder: Path) -> Path:
    """The sources of the site, new: the pages as they are in docs/, and what is made for it."""
    shutil.rmtree(folder, ignore_errors=True)
    pages = folder / "docs"
    pages.mkdir(parents=True)
    shutil.copy2(ROOT / "README.md", folder)
    for pattern in SAME:
        for path in DOCS.glob(pattern):
            shutil.copy2(path, pages)
    shutil.copytree(DOCS / "_static", pages / "_static")
    _add_pages_of_no_section(pages)
    _write_api(pages / "api")
    _copy_notebooks(pages / "tutorials")
    gallery.write(pages / "gallery")
    return pages


def _add_pages_of_no_section(pages: Path) -> None:
    """A page that no table of contents names goes to the end of the guide's."""
    found = "\n".join(path.read_text() for path in pages.glob("*.md"))
    named = {
        line.strip() for block in CONTENTS.findall(found) for line in block.splitlines()
    }
    others = sorted(
        path.stem for path in pages.glob("*.md") if path.stem not in {*named, "index"}
    )
    guide = pages / "guide.md"
    text = guide.read_text().rstrip().removesuffix(":::")
    guide.write_text("\n".join([text.rstrip(), *others, ":::", ""]))


def _write_api(folder: Path) -> None:
    folder.mkdir()
    for name, text in topics.pages().items():
        (folder / f"{name}.rst").write_text(text)


def _copy_notebooks(folder: Path) -> None:
    folder.mkdir()
    found = sorted((ROOT / "notebooks").glob("*.ipynb"))
    for path in found:
        shutil.copy2(path, folder)
    (folder / "index.md").write_text(
        TUTORIALS.format(names="\n".join(path.stem for path in found))
    )


def build(folder: Path) -> int:
    """The site; warnings and lost links are errors. Returns the exit code."""
    pages = lay_out(folder / "pages")
    code = _sphinx(pages, folder, "html")
    lost = check.lost_in(folder / "html")
    for name, link in lost:
        print(f"{name}: {link} leads nowhere", file=sys.stderr)
    return code or int(bool(lost))


def ask(folder: Path) -> int:
    """Whether links to elsewhere lead somewhere. Returns the exit code, 1 without a network."""
    written = [ROOT / "README.md", *DOCS.glob("*.md"), *ROOT.glob("notebooks/*.ipynb")]
    silent = check.silent_hosts(written)
    if silent:
        print(
            f"make links needs a network, none of {', '.join(silent)} answers; make docs checks the links within",
            file=sys.stderr,
        )
        return 1
    return _sphinx(lay_out(folder / "pages"), folder, "linkcheck")


def _sphinx(pages: Path, folder: Path, builder: str) -> int:
    """Sphinx over the pages; warnings are errors. Returns its exit code."""
    output = folder / builder
    shutil.rmtree(output, ignore_errors=True)
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-b",
        builder,
        "-d",
        str(folder / "trees"),
        "-E",
        *STRICT,
    ]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(DOCS)])}
    words = [*command, str(pages), str(output)]
    built = subprocess.run(words, env=environment, check=False)  # noqa: S603, our own words
    return built.returncode


if __name__ == "__main__":
    target = Path(sys.argv[1])
    sys.exit(ask(target) if "--links" in sys.argv else build(target))
