"""Names of files and folders that cannot be: every verb says so in one line, code 2, and writes nothing."""

from shlex import split

import pytest

from symfpu import Chain, InputError, export, lindstedt, prove_propagation, save, solve_amplitudes
from tests.cli.running import refusal

RULE = split("-N 6 --seeds 1,2 --order 2")
SMALL_SWEEP = split("sweep --longest 3 --largest 1 --order 1")
FAMILY = split("family -N 8 --alpha 0.4 --seeds 3 --to-energy 0.011 --from-energy 0.01")
SOLVE = split("solve -N 8 --alpha 0.3 --seeds 1 --omega 0.3905 --order 4")

# What stands for the saved torus is "@"; the bad name comes last.
FILES = {
    "prove": ["prove", *RULE, "-o"],
    "solve": [*SOLVE, "-o"],
    "refine": ["refine", "@", "-o"],
    "export": ["export", "@", "--lang", "c", "-o"],
    "orbit": ["orbit", "@", "--time", "10", "-o"],
    "orbit, checkpoint": ["orbit", "@", "--time", "10", "--checkpoint"],
    "orbit, save": ["orbit", "@", "--time", "10", "--save"],
    "gali, checkpoint": ["gali", "@", "--time", "100", "--checkpoint"],
    "sweep": [*SMALL_SWEEP, "-o"],
    "sweep, cases": [*SMALL_SWEEP, "--file"],
}
FOLDERS = {
    "family": [*FAMILY, "-o"],
    "gali": ["gali", "@", "--time", "100", "-o"],
    "reproduce": ["reproduce", "section5", "-o"],
}
READ = {
    "show": ["show"],
    "verify": ["verify"],
    "certify": ["certify"],
    "refine": ["refine"],
    "export": ["export", "--lang", "c", "-o", "unwritten.c"],
    "orbit": ["orbit", "--time", "10"],
    "gali": ["gali", "--time", "100"],
}
NO_FILES = {"empty": "", "blank": "  "} | {name: name for name in (".", "folder", "folder.csv", "none/x.csv", "file/x.csv")}
NO_FOLDERS = {"empty": "", "blank": "  ", "file": "file", "below a file": "file/x"}
NO_INPUT = {"empty": ""} | {name: name for name in (".", "folder", "none", "none/x", "file/x")}


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


def refused(capsys, tmp_path, argv):
    before = sorted(path.name for path in tmp_path.rglob("*"))
    refusal(capsys, *argv)
    assert sorted(path.name for path in tmp_path.rglob("*")) == before


@pytest.mark.parametrize("name", NO_FILES.values(), ids=NO_FILES)
@pytest.mark.parametrize("verb", FILES)
def test_no_file_to_write(verb, name, saved, capsys, tmp_path):
    argv = [saved if word == "@" else word for word in FILES[verb]]
    refused(capsys, tmp_path, [*argv, name])


@pytest.mark.parametrize("name", NO_FOLDERS.values(), ids=NO_FOLDERS)
@pytest.mark.parametrize("verb", FOLDERS)
def test_no_folder_to_write(verb, name, saved, capsys, tmp_path):
    argv = [saved if word == "@" else word for word in FOLDERS[verb]]
    refused(capsys, tmp_path, [*argv, name])


@pytest.mark.parametrize("name", NO_INPUT.values(), ids=NO_INPUT)
@pytest.mark.parametrize("verb", READ)
def test_no_file_to_read(verb, name, capsys, tmp_path):
    first, *others = READ[verb]
    refused(capsys, tmp_path, [first, name, *others])


def test_the_functions_refuse_an_empty_name_too():
    series = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 4)
    for name in ("", ".", "none/x.c"):
        with pytest.raises(InputError):
            export(solve_amplitudes(series), "c", name)
        with pytest.raises(InputError):
            prove_propagation(4, (1,), 1).write(name)
