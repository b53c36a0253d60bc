"""Export: languages, names, files that are there, and the command line."""

import pytest

from symfpu import Chain, InputError, compile_evaluator, export, lindstedt, save, solve_amplitudes
from symfpu.cli.main import main
from tests.store.test_saved_file import SERIES


@pytest.fixture(scope="module")
def series():
    return lindstedt(Chain(8, "0.3"), (1,), ("0.3905",), 4)


@pytest.fixture(scope="module")
def torus(series):
    return solve_amplitudes(series)


def test_an_existing_file_is_kept_unless_forced(torus, tmp_path):
    path = export(torus, "numpy", tmp_path / "breather.py")
    path.write_text("mine")
    with pytest.raises(InputError, match="--force"):
        export(torus, "numpy", path)
    assert path.read_text() == "mine"
    export(torus, "numpy", path, force=True)
    assert "positions" in path.read_text()


@pytest.mark.parametrize("name", ["1torus", "my-torus", "for", "Torus", "lambda", "a" * 41, "tor us", "tör"])
def test_names_must_be_identifiers_everywhere(torus, name, tmp_path):
    with pytest.raises(InputError, match="identifier"):
        export(torus, "c", tmp_path / f"{name}.c")


def test_what_cannot_be_exported_says_so(series, torus, tmp_path):
    with pytest.raises(InputError, match="c, fortran"):
        export(torus, "cobol", tmp_path / "x")
    with pytest.raises(InputError, match="solve_amplitudes"):
        compile_evaluator(series)
    with pytest.raises(InputError, match=r"^order = 5: allowed is 0\.\.4"):
        export(series, "c", tmp_path / "x", order=5)
    with pytest.raises(InputError, match=r"^frequency_order = 6: "):
        export(series, "c", tmp_path / "x", frequency_order=6)
    with pytest.raises(InputError, match=r"^order = 2: allowed is none for a torus"):
        export(torus, "c", tmp_path / "x", order=2)
    with pytest.raises(InputError, match="residues"):
        export(SERIES["residue"](), "c", tmp_path / "x")
    with pytest.raises(InputError, match="file name"):
        export(torus, "fortran", tmp_path / "orbit")
    assert not list(tmp_path.iterdir())
    with pytest.raises(InputError, match="nowhere"):
        export(torus, "c", tmp_path / "nowhere" / "x")


def test_command_line(torus, series, tmp_path, capsys):
    file = save(tmp_path / "torus.symfpu", torus)
    words = ["export", str(file), "--lang", "c", "-o", str(tmp_path / "breather")]
    assert main(words) == 0
    assert capsys.readouterr().out.strip() == f"written: {tmp_path / 'breather.c'}"
    assert "symfpu export" in (tmp_path / "breather.c").read_text()
    assert main(words) == 2
    assert "--force" in capsys.readouterr().err
    assert main([*words, "--force"]) == 0
    alone = str(save(tmp_path / "s.symfpu", series))
    assert main(["export", alone, "--lang", "c", "-o", str(tmp_path / "y")]) == 2
    assert "--series" in capsys.readouterr().err
    assert main(["export", alone, "--lang", "c", "-o", str(tmp_path / "y"), "--series", "--order", "2"]) == 0
    assert "coordinates 2" in (tmp_path / "y.c").read_text()
    assert main(["export", str(file), "--lang", "octave", "-o", str(tmp_path / "z"), "--series", "--frequency-order", "9"]) == 2
    assert "0..4" in capsys.readouterr().err
