"""Results as records and tables, one family of names for all; how the package is cited."""

import re
import tomllib
from dataclasses import replace
from pathlib import Path

import mpmath
import pytest

import symfpu
from symfpu import Chain, InputError, cite, family
from symfpu.families.family import SHOWN_MEMBERS
from symfpu.results.text_tables import markdown_table
from tests.every_result import public_classes, result
from tests.tolerances import THIRTY_DIGITS


@pytest.mark.long
def test_digits_are_not_lost():
    """Sums of numbers of many digits are taken with these digits."""
    torus = result("Torus, FromSeries, digits")
    found = torus.record()
    with mpmath.workdps(40):
        total = torus.harmonic_energies().sum()
        assert abs(mpmath.mpf(found["harmonic_energy"]) / total - 1) < THIRTY_DIGITS


def test_frequencies_are_by_seed_as_amplitudes_are():
    torus = result("Torus, FromSeries")
    assert list(torus.omega) == list(torus.amplitudes) == [1, 2]
    assert tuple(torus.omega.values()) == torus.frequencies == tuple(torus.origin.series.omega.values())
    again = symfpu.lindstedt(torus.origin.series.chain, (2, 1), torus.omega, 2)
    assert again.frequencies == torus.frequencies
    with pytest.raises(InputError, match="a number for each of the seeds"):
        symfpu.lindstedt(torus.origin.series.chain, (1, 2), {1: "0.39"}, 2)


def test_a_sweep_of_another_potential_names_it():
    """Its exceptions are as those of a proof."""
    case = next(case for case in result("Sweep").cases if case.seeds == (1, 2))
    refuted = replace(case, verdict="refuted", exceptions=((3, 1, None),))
    found = symfpu.Sweep("toda:1/2", 1, (refuted,)).record()
    assert (found["potential"], found["cases"], "model" in found) == ("toda:1/2", 1, False)
    assert found["exceptions"][0]["exceptions"] == [{"mode": 3, "predicted": 1, "actual": None}]


def test_every_result_with_frequencies_of_seeds_has_them_by_seed():
    """Where `frequencies` is a method it is by seed itself."""
    kinds = [getattr(symfpu, name) for name in public_classes()]
    given = [kind for kind in kinds if not callable(getattr(kind, "frequencies", None))]
    with_both = [kind for kind in given if {"seeds", "frequencies"} <= attributes_of(kind)]
    assert len(with_both) > 7
    assert [kind for kind in with_both if "omega" not in attributes_of(kind)] == []


def attributes_of(kind):
    return {*dir(kind), *getattr(kind, "__dataclass_fields__", ())}


def test_a_file_has_the_record_of_what_it_holds():
    held = result("SavedFile")
    found, inside = held.record(), held.result.record()
    assert (inside["kind"], inside["origin"]) == ("Torus", "FromSeries")
    assert {key: found[key] for key in inside if key != "assessment"} == inside
    assert {"provenance", "assessment", "test_vectors"} <= set(found)


def test_markdown_table():
    assert markdown_table(["a", "b"], [["1", "2"]]) == "| a | b |\n| --- | --- |\n| 1 | 2 |"


@pytest.fixture(scope="module")
def found():
    return family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")


@pytest.mark.parametrize("times", [1, 2, 3, 5])
def test_a_text_that_leaves_members_out_says_so(found, times):
    long = replace(found, members=found.members * times)
    lines = long.text().splitlines()
    shown = [line for line in lines if line.startswith("  Member(")]
    assert shown[0].strip() == repr(long.members[0])
    assert shown[-1].strip() == repr(long.members[-1])
    assert len(shown) == min(len(long.members), SHOWN_MEMBERS + 1)
    said = [line for line in lines if "members shown" in line]
    assert (said == []) == (len(shown) == len(long.members))
    assert all(f"{len(shown)} of {len(long.members)} members shown" in line for line in said)


ROOT = Path(__file__).parents[2]


def test_the_file_is_what_the_package_says():
    assert (ROOT / "CITATION.cff").read_text() == cite("cff") + "\n", "make citation"


def test_the_version_is_that_of_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["version"] == symfpu.__version__
    for form in ("text", "bibtex", "cff"):
        assert symfpu.__version__ in cite(form)


def test_bibtex_has_closed_entries_with_their_fields():
    entries = cite("bibtex").split("\n\n")
    assert [re.match(r"@(\w+)\{(\w+),", entry).groups() for entry in entries] == [("misc", "symfpu"), ("article", "qtori2013")]
    assert all(entry.count("{") == entry.count("}") for entry in entries)
    assert "author = {Christodoulidi, H. and Efthymiopoulos, C.}" in entries[1]


def test_another_form_is_refused():
    with pytest.raises(InputError, match="text, bibtex, cff"):
        cite("ris")
