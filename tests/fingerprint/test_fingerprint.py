"""The numbers of every function are those of values.json, and a comparison sees what has changed."""

import mpmath
import numpy as np
import pytest

import symfpu
from tests.fingerprint.comparison import compared, computed, read, reasons, unexplained
from tests.fingerprint.entries import LEFT_OUT, differences, entry, exact, fifteen, noise, solver


@pytest.mark.long
def test_numbers_are_those_of_the_file():
    old = read()
    assert compared(old, computed()) == {}


def test_every_class_with_a_record_is_in_the_file():
    kinds = {value["value"]["kind"] for value in read().values() if isinstance(value["value"], dict) and "kind" in value["value"]}
    classes = {name: getattr(symfpu, name) for name in symfpu.__all__}
    missing = {name for name, kind in classes.items() if isinstance(kind, type) and hasattr(kind, "record")} - kinds
    assert missing == INSIDE


INSIDE = {"Event", "GroupGrowth", "Member", "NormalEvent", "RootCertificate", "SavedFile", "SweepRows"}  # of other records


def test_a_reason_is_a_sentence_and_names_what_is_there():
    keys = set(read())
    for pattern, reason in reasons().items():
        assert reason.endswith("."), pattern
        assert "*" in pattern or pattern in keys


CHANGES = {
    "a digit": (1.0, 1.0 + 1e-8),
    "a zero": (solver([0.0, 1.0]), solver([0.1, 1.0])),
    "a decimal for a whole number": (solver("3 modes"), solver("3.5 modes")),
    "a whole number": ([1, 2], [1, 3]),
    "a word": ({"verdict": "stable"}, {"verdict": "unstable"}),
    "a number in a sentence": (solver("the smallest divisor is 0.0123"), solver("the smallest divisor is 0.0133")),
    "a count in a sentence": (solver("4 of 5 modes"), solver("3 of 5 modes")),
    "a key less": ({"order": 1, "verdict": "stable"}, {"order": 1}),
    "a key more": ({"order": 1}, {"order": 1, "verdict": "stable"}),
    "a list that is longer": ([1.0, 2.0], [1.0, 2.0, 3.0]),
    "the small part of a list": ([1.0, 1e-3], [1.0, 1.001e-3]),
    "nan for a number": ([1.0, 2.0], [1.0, float("nan")]),
    "none for a number": (0.5, None),
    "a residual of many digits": ({"residual": 1e-31}, {"residual": 1e-19}),
    "a residual of a truncation": ({"residual": 3.1e-4}, {"residual": 3.2e-4}),
    "a sign": (mpmath.mpf("1e-3"), mpmath.mpf("-1e-3")),
    "many digits": (mpmath.mpf(1) / 3, mpmath.mpf(1) / 3 + mpmath.mpf("1e-14")),
    "a fraction": (exact("1/3"), exact("1/4")),
    "the size of noise": (noise(1e-5), noise(2e-5)),
}


@pytest.mark.parametrize("name", CHANGES)
def test_changes_are_seen(name):
    old, new = map(entry, CHANGES[name])
    [line] = differences(old["value"], new["value"], old["within"])
    assert "was" in line


SAME = {
    "rounding": (1.0, 1.0 + 1e-15),
    "rounding of the largest": ([1.0, 1e-14], [1.0, 2e-14]),
    "a solver": (solver(0.5), solver(0.5 + 1e-12)),
    "the residual of doubles": ({"residual": 3e-16}, {"residual": 7e-15}),
    "products of an iteration": ({"newton": [{"products": 12, "residual": 1e-15}]}, {"newton": [{"products": 13, "residual": 3e-15}]}),
    "the last digit in a sentence": (solver("residual 3.14e-05 at mode 3"), solver("residual 3.15e-05 at mode 3")),
    "a zero": (0.0, -0.0),
    "this run": ({"seconds": 1.0, "order": 1}, {"seconds": 2.0, "order": 1}),
    "a number of no dimension": (np.array(0.5), 0.5),
}


@pytest.mark.parametrize("name", SAME)
def test_what_moves_between_machines_is_no_change(name):
    old, new = map(entry, SAME[name])
    assert differences(old["value"], new["value"], old["within"]) == []


def test_a_change_needs_a_reason(monkeypatch):
    old = {"a/b/c": entry(1.0), "a/b/d": entry(1)}
    new = {"a/b/c": entry(2.0), "a/b/e": entry(1)}
    found = compared(old, new)
    assert list(found) == ["a/b/c", "a/b/d", "a/b/e"]
    monkeypatch.setattr("tests.fingerprint.comparison.reasons", lambda: {"a/b/c": "It was half of the truth."})
    assert unexplained(found, old) == ["a/b/d"]
    monkeypatch.setattr("tests.fingerprint.comparison.reasons", lambda: {"a/*": "Another convention."})
    assert unexplained(found, old) == []


def test_numbers_have_fifteen_digits():
    with mpmath.workdps(30):
        third = mpmath.mpf(1) / 3
    assert fifteen(third) == "3.33333333333333e-1"
    assert fifteen(1 / 3) == "3.33333333333333e-01"
    assert set(entry({"provenance": {"created": "today"}, "order": 1})["value"]) == {"order"} == {"order"} - LEFT_OUT
