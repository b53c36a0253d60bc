"""Export: languages, names, files that are there, and the command line."""

import random

import pytest

from symfpu.bundles.bundle import save
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.codegen.evaluator import compile_evaluator
from symfpu.codegen.export import LANGUAGES, export
from symfpu.errors import InputError
from symfpu.proofs.certificates import random_point
from symfpu.series.lindstedt import lindstedt
from symfpu.series.residues import residue_series
from symfpu.tori.amplitudes import solve_amplitudes


@pytest.fixture(scope="module")
def series():
    return lindstedt(Chain(8, "0.3"), (1,), ("0.3905",), 4)


@pytest.fixture(scope="module")
def torus(series):
    return solve_amplitudes(series)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_writes_a_file_that_says_what_it_is(torus, language, tmp_path):
    path = export(torus, language, tmp_path / "breather")
    assert path.suffix == f".{LANGUAGES[language].extension}"
    text = path.read_text()
    for fact in ("Chain(N=8, alpha=0.3)", "0.3905", "coordinates 4", "breather", "symfpu.export", "hash"):
        assert fact in text
    assert text.isascii()


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_series_says_its_orders(series, language, tmp_path):
    text = export(series, language, tmp_path / "free", order=3, frequency_order=2).read_text()
    for fact in (
        "Chain(N=8, alpha=0.3)",
        "0.3905",
        "frequencies 2, coordinates 3",
        "symfpu.export(series",
        "order=3",
        "hash of the series",
    ):
        assert fact in text
    assert text.isascii()


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
        export(residue_series(Chain(8, "0.3"), (1,), random_point(8, 1, 3, random.Random(1)), 2), "c", tmp_path / "x")
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
