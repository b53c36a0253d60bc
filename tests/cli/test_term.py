"""The verb term: the formulas of the series, for all N and for one, in every form, and what it refuses."""

import re
from shlex import split

import pytest
import symengine as se

from symfpu import Chain, closed_form, lindstedt, saved_file
from tests.cli.running import answer, shown

ALL = split("term -N N --alpha 1 --seeds 1,N-1 --order 2")
ONE = split("term -N 8 --alpha 0.3 --seeds 1 --order 1")
EVERY = Chain("N", alpha=1)


@pytest.mark.parametrize("form", ["expanded", "factored", "cse"])
def test_forms_are_those_of_the_series(capsys, form):
    found = answer(capsys, *ALL[:-1], "3", "-q", "N-2", "--form", form)
    expected = lindstedt(EVERY, (1, "N-1"), order=3).term("N-2", 3, form=form)
    expression, names = (expected.expression, expected.names) if form == "cse" else (expected, ())
    assert found["expression"] == str(expression)
    assert found["names"] == [[str(name), str(value)] for name, value in names]
    assert bool(names) == (form == "cse")
    assert (found["N"], found["seeds"], found["q"], found["order"], found["form"]) == ("N", [1, "N-1"], "N-2", 3, form)
    assert found["valid_from"] == 9
    assert found["name"] == "Q_{N-2}^(3)"


def test_a_frequency_is_closed_in_the_length(capsys):
    found = answer(capsys, *ALL, "-q", "1", "--frequency", "--form", "closed")
    series = lindstedt(EVERY, (1, "N-1"), order=2)
    assert found["expression"] == str(closed_form(series.frequency_correction(1, 2), EVERY, series.seeds))
    assert found["name"] == "omega_1^(2)"


def test_a_factored_frequency_expands_to_the_expanded_one(capsys):
    forms = [answer(capsys, *ALL, "-q", "1", "--frequency", "--form", form)["expression"] for form in ("factored", "expanded")]
    assert forms[0] != forms[1]
    named = [re.sub(r"_\{(.*?)\}", lambda found: "_" + found[1].replace("-", "m"), text) for text in forms]
    first, second = map(se.sympify, named)  # L_2(0, 1), which SymEngine reads as a function
    assert se.expand(first - second) == 0


def test_lines_for_a_reader_say_for_which_lengths(capsys):
    first, *others = shown(capsys, *ALL, "-q", "2").splitlines()
    expected = lindstedt(EVERY, (1, "N-1"), order=2).term(2, 2)
    assert first == f"Q_2^(2) = {expected}"
    assert others[:2] == ["to be multiplied by mu^2, mu = 1/sqrt(2N)", "for every N >= 7"]


def test_one_chain_and_numbers(capsys):
    symbols = answer(capsys, *ONE, "-q", "2")
    assert "valid_from" not in symbols
    assert symbols["expression"] == str(lindstedt(Chain(8, alpha="0.3"), (1,), order=1).term(2, 1))
    numbers = answer(capsys, *ONE, "-q", "2", "--omega", "0.3905", "--digits", "30")
    expected = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 1, digits=30).term(2, 1)
    assert (numbers["expression"], numbers["form"], numbers["frequencies"]) == (str(expected), None, {"1": "0.3905"})


def test_the_series_is_kept(capsys, tmp_path):
    file = tmp_path / "all.symfpu"
    shown(capsys, *ALL, "-q", "1", "-o", file)
    kept = saved_file(file)
    assert repr(kept.result) == repr(lindstedt(EVERY, (1, "N-1"), order=2))
    assert kept.provenance["command"].startswith("symfpu term -N N")
    assert "for N >= 7" in shown(capsys, "show", file)


def test_latex_fits_a_page(capsys):
    lines = shown(capsys, *ALL[:-1], "3", "-q", "N-2", "--form", "cse", "--latex").splitlines()
    assert (lines[0], lines[-1]) == (r"\begin{aligned}", r"\end{aligned}")
    assert any("x_{0} &= " in line for line in lines)
    assert r"\sin{\left(" in shown(capsys, *ALL, "-q", "1", "--frequency", "--form", "closed", "--latex")
