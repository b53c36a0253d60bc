"""The option --plot of the verbs: a picture in the format of its suffix, and what is refused before anything is computed."""

from shlex import split

import pytest

from symfpu import save
from symfpu.cli.main import main
from tests.cli.running import refusal
from tests.plots import cases

BEGINNINGS = {".png": b"\x89PNG", ".pdf": b"%PDF", ".svg": b"<?xml"}
# "@" stands for the file of a torus
VERBS = {
    "solve": split("solve -N 8 --alpha 0.3 --seeds 1 --omega 0.3905 --order 4"),
    "breather": split("solve -N 9 --beta 1 --seeds 2 --amplitudes 0.3"),
    "family": split("family -N 8 --alpha 0.3 --seeds 1 --to-energy 0.001 --from-energy 0.0005"),
    "propagate": split("propagate -N 32 --seeds 3,5 --order 4"),
    "refine": split("refine @"),
    "orbit": split("orbit @ --time 50 --samples 20"),
    "gali": split("gali @ --time 100 --vectors 2"),
}


@pytest.fixture(scope="module")
def words(tmp_path_factory):
    """What is typed for a verb."""
    saved = str(save(tmp_path_factory.mktemp("plot") / "torus.symfpu", cases.breather()))
    return {verb: [saved if word == "@" else word for word in typed] for verb, typed in VERBS.items()}


@pytest.mark.long
@pytest.mark.parametrize(
    ("verb", "suffix"),
    [
        ("solve", ".png"),
        ("breather", ".svg"),
        ("family", ".pdf"),
        ("propagate", ".PNG"),
        ("propagate", ".svg"),
        ("refine", ".png"),
        ("orbit", ".svg"),
        ("gali", ".pdf"),
    ],
)
def test_a_verb_draws_what_it_found(verb, suffix, words, tmp_path, capsys):
    file = tmp_path / f"picture{suffix}"
    assert main([*words[verb], "--plot", str(file)]) == 0
    assert file.read_bytes().startswith(BEGINNINGS[suffix.lower()])
    assert capsys.readouterr().out.splitlines()[-1] == f"drawn: {file}"
    assert [path.name for path in tmp_path.iterdir()] == [file.name]


WRONG = ["picture.jpg", "picture", "png", "folder.png/", "nowhere/picture.png", ""]


@pytest.mark.parametrize(("verb", "name"), [*(("propagate", name) for name in WRONG), *((verb, "a.jpg") for verb in VERBS)])
def test_a_wrong_file_is_refused_before_anything_is_computed(verb, name, words, tmp_path, capsys):
    (tmp_path / "folder.png").mkdir()
    target = f"{tmp_path}/{name}" if name else ""
    assert refusal(capsys, *words[verb], "--plot", target).startswith("symfpu: plot = ")


@pytest.mark.parametrize("suffix", [".svg", pytest.param(".pdf", marks=pytest.mark.long)])
def test_the_same_picture_has_the_same_bytes(suffix, tmp_path):
    files = [tmp_path / f"{name}{suffix}" for name in "ab"]
    for file in files:
        assert main([*VERBS["propagate"], "--plot", str(file)]) == 0
    assert files[0].read_bytes() == files[1].read_bytes()
