"""The verb term: the formulas of the series, for all N and for one, in every form, and what it refuses."""

import json
import re

import pytest
import symengine as se

from symfpu.bundles.bundle import load
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.series.closed_forms import closed_form
from symfpu.series.lindstedt import lindstedt

ALL = ["term", "-N", "N", "--alpha", "1", "--seeds", "1,N-1", "--order", "2"]
ONE = ["term", "-N", "8", "--alpha", "0.3", "--seeds", "1", "--order", "1"]
EVERY = Chain("N", alpha=1)


def run(capsys, *arguments):
    code = main(list(arguments))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def record(capsys, *arguments):
    code, out, err = run(capsys, *arguments, "--json")
    assert (code, err) == (0, "")
    return json.loads(out)


@pytest.mark.parametrize("form", ["expanded", "factored", "cse"])
def test_forms_are_those_of_the_series(capsys, form):
    found = record(capsys, *ALL[:-1], "3", "-q", "N-2", "--form", form)
    expected = lindstedt(EVERY, (1, "N-1"), order=3).term("N-2", 3, form=form)
    expression, names = (expected.expression, expected.names) if form == "cse" else (expected, ())
    assert found["expression"] == str(expression)
    assert found["names"] == [[str(name), str(value)] for name, value in names]
    assert bool(names) == (form == "cse")
    assert (found["N"], found["seeds"], found["q"], found["order"], found["form"]) == ("N", [1, "N-1"], "N-2", 3, form)
    assert found["valid_from"] == 9
    assert found["name"] == "Q_{N-2}^(3)"


def test_a_frequency_is_closed_in_the_length(capsys):
    found = record(capsys, *ALL, "-q", "1", "--frequency", "--form", "closed")
    series = lindstedt(EVERY, (1, "N-1"), order=2)
    assert found["expression"] == str(closed_form(series.frequency_correction(1, 2), EVERY, series.seeds))
    assert found["name"] == "omega_1^(2)"


def test_a_factored_frequency_expands_to_the_expanded_one(capsys):
    forms = [record(capsys, *ALL, "-q", "1", "--frequency", "--form", form)["expression"] for form in ("factored", "expanded")]
    assert forms[0] != forms[1]
    named = [re.sub(r"_\{(.*?)\}", lambda found: "_" + found[1].replace("-", "m"), text) for text in forms]
    first, second = map(se.sympify, named)  # L_2(0, 1), which SymEngine reads as a function
    assert se.expand(first - second) == 0


def test_lines_for_a_reader_say_for_which_lengths(capsys):
    code, out, err = run(capsys, *ALL, "-q", "2")
    expected = lindstedt(EVERY, (1, "N-1"), order=2).term(2, 2)
    assert (code, err) == (0, "")
    first, *others = out.splitlines()
    assert first == f"Q_2^(2) = {expected}"
    assert others[:2] == ["to be multiplied by mu^2, mu = 1/sqrt(2N)", "for every N >= 7"]


def test_latex_fits_a_page(capsys):
    _, out, _ = run(capsys, *ALL[:-1], "3", "-q", "N-2", "--form", "cse", "--latex")
    lines = out.splitlines()
    assert (lines[0], lines[-1]) == (r"\begin{aligned}", r"\end{aligned}")
    assert "x_{0} &= " in out
    _, closed, _ = run(capsys, *ALL, "-q", "1", "--frequency", "--form", "closed", "--latex")
    assert r"\sin{\left(" in closed


def test_one_chain_and_numbers(capsys):
    symbols = record(capsys, *ONE, "-q", "2")
    assert "valid_from" not in symbols
    assert symbols["expression"] == str(lindstedt(Chain(8, alpha="0.3"), (1,), order=1).term(2, 1))
    numbers = record(capsys, *ONE, "-q", "2", "--omega", "0.3905", "--digits", "30")
    expected = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 1, digits=30).term(2, 1)
    assert (numbers["expression"], numbers["form"], numbers["frequencies"]) == (str(expected), None, {"1": "0.3905"})


def test_the_series_is_kept(capsys, tmp_path):
    file = tmp_path / "all.symfpu"
    assert run(capsys, *ALL, "-q", "1", "-o", str(file))[0] == 0
    kept = load(file)
    assert repr(kept.series) == repr(lindstedt(EVERY, (1, "N-1"), order=2))
    assert kept.provenance["command"].startswith("symfpu term -N N")
    code, out, _ = run(capsys, "show", str(file))
    assert code == 0
    assert "for N >= 7" in out


BAD = {
    "frequencies for all N": ([*ALL, "-q", "1", "--omega", "0.1,1.9"], "frequencies"),
    "a mode from the end of one chain": ([*ONE, "-q", "N-1"], "q"),
    "a seed from the end of one chain": (["term", "-N", "8", "--alpha", "1", "--seeds", "N-1", "-q", "1", "--order", "2"], "seeds"),
    "a mode that is not reached": ([*ALL, "-q", "9"], "q"),
    "a mode that is none": ([*ALL, "-q", "N+1"], "q"),
    "a frequency of no seed": ([*ALL, "-q", "2", "--frequency"], "q"),
    "an unknown form": ([*ALL, "-q", "1", "--form", "short"], "form"),
    "a frequency in named parts": ([*ALL, "-q", "1", "--frequency", "--form", "cse"], "form"),
    "a form with numbers": ([*ALL, "-q", "1", "--omega", "0.1,1.9", "--form", "cse"], "form"),
    "digits without frequencies": (
        ["term", "-N", "8", "--alpha", "1", "--seeds", "1", "-q", "1", "--order", "2", "--digits", "20"],
        "frequencies",
    ),
    "a length that is none": (["term", "-N", "M", "--alpha", "1", "--seeds", "1", "-q", "1", "--order", "2"], "N"),
    "no seeds": (["term", "-N", "N", "--alpha", "1", "--seeds", "", "-q", "1", "--order", "2"], "seeds"),
}


@pytest.mark.parametrize(("words", "named"), BAD.values(), ids=BAD)
def test_bad_input_is_one_line_and_code_2(capsys, words, named):
    code, out, err = run(capsys, *words)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert err.startswith(f"symfpu: {named} = ")


def test_solve_asks_for_a_length(capsys):
    code, _, err = run(capsys, "solve", "-N", "N", "--alpha", "1", "--seeds", "1", "--omega", "0.1", "--order", "2")
    assert code == 2
    assert err.startswith("symfpu: N = 'N'")
