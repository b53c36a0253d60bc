"""Names of files and folders that cannot be: every verb says so in one line, code 2, and writes nothing."""

import pytest

from symfpu.bundles.bundle import save
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.codegen.export import export
from symfpu.errors import InputError
from symfpu.proofs.certificates import prove_propagation
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes

RULE = ["-N", "6", "--seeds", "1,2", "--order", "2"]
SMALL_SWEEP = ["sweep", "--longest", "3", "--largest", "1", "--order", "1"]
FAMILY = [
    "family",
    "-N",
    "8",
    "--alpha",
    "0.4",
    "--seeds",
    "3",
    "--to-energy",
    "0.011",
    "--from-energy",
    "0.01",
]
SOLVE = ["solve", "-N", "8", "--alpha", "0.3", "--seeds", "1", "--omega", "0.3905", "--order", "4"]

# What stands for the saved torus is "@"; the bad name comes last.
FILES = {
    "prove": ["prove", *RULE, "-o"],
    "solve": [*SOLVE, "-o"],
    "refine": ["refine", "@", "-o"],
    "export": ["export", "@", "--lang", "c", "-o"],
    "orbit": ["orbit", "@", "--time", "10", "-o"],
    "orbit, checkpoint": ["orbit", "@", "--time", "10", "--checkpoint"],
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
NO_FILES = {
    "empty": "",
    "blank": "  ",
    "here": ".",
    "folder": "folder",
    "folder.csv": "folder.csv",
    "no parent": "none/x.csv",
    "below a file": "file/x.csv",
}
NO_FOLDERS = {"empty": "", "blank": "  ", "file": "file", "below a file": "file/x"}
NO_INPUT = {
    "empty": "",
    "here": ".",
    "folder": "folder",
    "missing": "none",
    "no parent": "none/x",
    "below a file": "file/x",
}


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
    code = main(argv)
    captured = capsys.readouterr()
    assert (code, captured.out) == (2, "")
    assert len(captured.err.splitlines()) == 1
    assert captured.err.startswith("symfpu: ")
    assert "Traceback" not in captured.err
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
