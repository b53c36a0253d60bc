"""Names of files and folders that cannot be: every verb says so in one line, code 2, and writes nothing."""

from itertools import product
from shlex import split

import pytest

from symfpu import Chain, InputError, export, lindstedt, prove_propagation, save, solve_amplitudes
from tests.cli.running import refusal

RULE = split("-N 6 --seeds 1,2 --order 2")
SMALL_SWEEP = split("sweep --longest 3 --largest 1 --order 1")
FAMILY = split("family -N 8 --alpha 0.4 --seeds 3 --to-energy 0.011 --from-energy 0.01")
SOLVE = split("solve -N 8 --alpha 0.3 --seeds 1 --omega 0.3905 --order 4")

# "@" stands for the saved torus, "?" for the bad name
FILES = [
    ["prove", *RULE, "-o", "?"],
    [*SOLVE, "-o", "?"],
    ["refine", "@", "-o", "?"],
    ["export", "@", "--lang", "c", "-o", "?"],
    *(["orbit", "@", "--time", "10", option, "?"] for option in ("-o", "--checkpoint", "--save")),
    ["gali", "@", "--time", "100", "--checkpoint", "?"],
    *([*SMALL_SWEEP, option, "?"] for option in ("-o", "--file")),
]
FOLDERS = [[*FAMILY, "-o", "?"], ["gali", "@", "--time", "100", "-o", "?"], ["reproduce", "section5", "-o", "?"]]
READ = [
    *([verb, "?"] for verb in ("show", "verify", "certify", "refine")),
    ["export", "?", "--lang", "c", "-o", "unwritten.c"],
    ["orbit", "?", "--time", "10"],
    ["gali", "?", "--time", "100"],
]
NO_FILES = ("", "  ", ".", "folder", "folder.csv", "none/x.csv", "file/x.csv")
NO_FOLDERS = ("", "  ", "file", "file/x")
NO_INPUT = ("", ".", "folder", "none", "none/x", "file/x")
TYPED = [
    (name, words) for verbs, names in ((FILES, NO_FILES), (FOLDERS, NO_FOLDERS), (READ, NO_INPUT)) for words, name in product(verbs, names)
]


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    series = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 4)
    return str(save(tmp_path_factory.mktemp("saved") / "torus.symfpu", solve_amplitudes(series)))


@pytest.fixture(autouse=True)
def there(tmp_path, monkeypatch):
    """A working folder with folders and a file in it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "file").write_text("not a folder")


@pytest.mark.parametrize(("name", "words"), TYPED)
def test_a_bad_name_is_refused_and_nothing_is_written(name, words, saved, capsys, tmp_path):
    before = sorted(path.name for path in tmp_path.rglob("*"))
    refusal(capsys, *({"@": saved, "?": name}.get(word, word) for word in words))
    assert sorted(path.name for path in tmp_path.rglob("*")) == before


def test_the_functions_refuse_an_empty_name_too():
    series = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 4)
    for name in ("", ".", "none/x.c"):
        with pytest.raises(InputError):
            export(solve_amplitudes(series), "c", name)
        with pytest.raises(InputError):
            prove_propagation(4, (1,), 1).write(name)
