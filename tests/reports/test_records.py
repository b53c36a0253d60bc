"""Every public result has a record: JSON that strict readers take, the chain and seeds as everywhere, numbers in one form."""

import json
import re
from pathlib import Path

import mpmath
import pytest

import symfpu
from symfpu.errors import InputError
from symfpu.proofs.sweeps import SweepCase
from symfpu.reports.records import record
from tests.test_pickle import RESULTS, public_classes
from tests.tolerances import THIRTY_DIGITS

WITHOUT = {"Chain": "an argument", "Evaluator": "a program", "ExpandableTerm": "an expression", "NamedParts": "an expression"}
WITHOUT |= dict.fromkeys(("AtlasBorder", "NormalFrequencies", "NormalMode", "ParametricResonance", "SpectralLine"), "a row of a table")
CASES = {name: make for name, (make, _) in RESULTS.items() if hasattr(getattr(symfpu, name.partition(",")[0], object), "record")}
CASES = {name: make for name, make in CASES.items() if name != "Bundle"}  # that of what it holds: below
QUICK = {"QTorus", "Event", "Sweep", "ProfileLine", "ProfileDistance", "PropagationProof", "RuleForAllN", "Recurrence", "LeadingTerm"}
QUICK |= {"Atlas", "BorderLaw"}
FORMS = {
    "frequencies": str,
    "amplitudes": str,
    "energy": str,
    "harmonic_energy": str,
    "average_harmonic_energy": str,
    "residual": float,
    "verdict": str,
    "digits": (int, type(None)),
}
PAGE = (Path(__file__).parents[2] / "docs" / "records.md").read_text()


def strict(found):
    """As a strict reader gets it: no NaN, no Infinity."""
    return json.loads(json.dumps(found, allow_nan=False))


def numbers(value):
    """All numbers of a record that are no whole ones."""
    if isinstance(value, dict):
        return [x for item in value.values() for x in numbers(item)]
    if isinstance(value, list):
        return [x for item in value for x in numbers(item)]
    return [value] if isinstance(value, float) else []


def test_every_public_result_has_a_record_or_a_reason():
    with_record = {name for name in public_classes() if hasattr(getattr(symfpu, name), "record")}
    assert public_classes() - with_record == set(WITHOUT)


EVERY = [name if name in QUICK else pytest.param(name, marks=pytest.mark.long) for name in CASES]


@pytest.mark.parametrize("name", EVERY)
def test_records_are_json_with_the_same_keys_and_forms(name, tmp_path):
    result = CASES[name](tmp_path)
    found = result.record()
    assert strict(found) == found
    assert (found["kind"], found["symfpu_version"]) == (type(result).__name__, symfpu.__version__)
    for value in numbers(found):
        assert float(f"{value:.15g}") == value
    if hasattr(result, "chain"):
        assert {key: found[key] for key in result.chain.typed} == result.chain.typed
    if isinstance(getattr(result, "seeds", None), tuple) and hasattr(result, "chain"):
        assert found["seeds"] == list(result.seeds)
    for key, form in FORMS.items():
        values = found.get(key)
        inside = values.values() if isinstance(values, dict) else [values] * (values is not None)
        assert all(isinstance(value, form) for value in inside), key
    if hasattr(type(result), "verdict"):
        assert found["verdict"] == result.verdict


@pytest.mark.parametrize("name", EVERY)
def test_keys_are_on_the_page(name, tmp_path):
    words = set(re.findall(r"`(\w+)`", PAGE))
    assert {key for key in CASES[name](tmp_path).record() if key not in words} - AS_COLUMNS == set()


AS_COLUMNS = {"N", "alpha", "beta", "potential"}


@pytest.mark.long
def test_a_file_has_the_record_of_what_it_holds(tmp_path):
    make, _ = RESULTS["Bundle"]
    bundle = make(tmp_path)
    found = bundle.record()
    assert strict(found) == found
    inside = bundle.torus.record()
    assert inside["kind"] == "QTorus"
    assert {key: found[key] for key in inside if key != "assessment"} == inside
    assert {"provenance", "assessment", "test_vectors"} <= set(found)


@pytest.mark.long
def test_digits_are_not_lost(tmp_path):
    """Sums of numbers of many digits are taken with these digits."""
    torus = RESULTS["QTorus, digits"][0](tmp_path)
    found = torus.record()
    with mpmath.workdps(40):
        total = torus.harmonic_energies().sum()
        assert abs(mpmath.mpf(found["harmonic_energy"]) / total - 1) < THIRTY_DIGITS


def test_frequencies_are_by_seed_as_amplitudes_are(tmp_path):
    torus = RESULTS["QTorus"][0](tmp_path)
    assert list(torus.omega) == list(torus.amplitudes) == [1, 2]
    assert tuple(torus.omega.values()) == torus.frequencies == tuple(torus.series.omega.values())
    again = symfpu.lindstedt(torus.series.chain, (2, 1), torus.omega, 2)
    assert again.frequencies == torus.frequencies
    with pytest.raises(InputError, match="a number for each of the seeds"):
        symfpu.lindstedt(torus.series.chain, (1, 2), {1: "0.39"}, 2)


def test_a_sweep_of_another_potential_names_it():
    """Its exceptions are as those of a proof."""
    case = SweepCase(4, (1, 2), "refuted", ((3, 1, None),), True)
    found = symfpu.Sweep("toda:1/2", 1, (case,)).record()
    assert (found["potential"], found["cases"], "model" in found) == ("toda:1/2", 1, False)
    assert found["exceptions"][0]["exceptions"] == [{"mode": 3, "predicted": 1, "actual": None}]


def test_every_result_with_frequencies_of_seeds_has_them_by_seed():
    """Where `frequencies` is a method it is by seed itself."""
    kinds = [getattr(symfpu, name) for name in public_classes()]
    given = [kind for kind in kinds if not callable(getattr(kind, "frequencies", None))]
    with_both = [kind for kind in given if {"seeds", "frequencies"} <= attributes_of(kind)]
    assert len(with_both) > 10
    assert [kind for kind in with_both if "omega" not in attributes_of(kind)] == []


def attributes_of(kind):
    return {*dir(kind), *getattr(kind, "__dataclass_fields__", ())}


def test_what_is_no_result_is_refused():
    with pytest.raises(InputError, match="a result with a record"):
        record("torus")
