"""The checker of certificates of tori: what is altered is refused, and it shares no code with the prover."""

import ast
import copy
import json
import random
import re
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest

from symfpu import prove_residual, prove_stay
from symfpu.proofs import check_torus
from symfpu.proofs.check_torus import Packing, Series, product, verify
from symfpu.proofs.check_torus.budget import STEPS_A_BYTE, Budget
from symfpu.proofs.check_torus.claim import read_claim
from symfpu.proofs.check_torus.residual import residuals
from symfpu.proofs.check_torus.series import by_pairs
from symfpu.proofs.reading import READING_ERRORS, CertificateError
from tests.proofs.certificate_files import sealed
from tests.results import two_angles


@cache
def stay():
    return prove_stay(two_angles(), time=1000).certificate()


@cache
def residual():
    return prove_residual(two_angles()).certificate()


def checked(data, folder):
    path = folder / "certificate.json"
    path.write_text(json.dumps(data, separators=(",", ":")))
    return verify(path)


def refused(data, folder, reason=""):
    with pytest.raises(CertificateError, match=reason or None):
        checked(data, folder)


def test_both_kinds_are_theorems(tmp_path):
    of_residual, of_energy = checked(residual(), tmp_path)
    assert "leaves" in of_residual
    assert "H of that torus is within" in of_energy
    lines = checked(stay(), tmp_path)
    assert lines[1] == of_energy
    assert "every orbit that starts on this torus stays, for 1.00e3 units of time" in lines[2]


@pytest.mark.parametrize("make", [residual, stay])
def test_no_altered_number_passes(make, tmp_path):
    """Every number of the file, one digit changed: the digest binds all of them."""
    text = json.dumps(make(), separators=(",", ":"))
    path = tmp_path / "certificate.json"
    numbers = list(re.finditer(r"[0-9]+", text))
    for found in random.Random(5).sample(numbers, 150):
        digit = str((int(text[found.start()]) + 1) % 10)
        path.write_text(text[: found.start()] + digit + text[found.start() + 1 :])
        with pytest.raises((CertificateError, *READING_ERRORS)):
            check_torus.read_certificate(path)


CLAIMS = {
    "a smaller residual": lambda d: d["residual"].__setitem__(0, d["residual"][0] // 2),
    "a smaller radius of the energy": lambda d: d["energy"].__setitem__(1, halved(d["energy"][1])),
    "another energy": lambda d: d["energy"][0].__setitem__(0, -d["energy"][0][0]),
    "an energy without a radius": lambda d: d["energy"].pop(),
    "a radius below zero": lambda d: d["energy"][1].__setitem__(0, -d["energy"][1][0]),
    "a longer time": lambda d: d["stay"].__setitem__(0, "100000"),
    "a smaller weighted distance": lambda d: d["stay"].__setitem__(1, halved(d["stay"][1])),
    "a smaller distance": lambda d: d["stay"].__setitem__(2, halved(d["stay"][2])),
    "a smaller momentum": lambda d: d["stay"].__setitem__(3, halved(d["stay"][3])),
    "a smaller drift": lambda d: d["stay"][4].__setitem__(1, halved(d["stay"][4][1])),
    "a larger weighted distance": lambda d: d["stay"].__setitem__(1, [d["stay"][1][0] * 2, d["stay"][1][1]]),
    "another coupling": lambda d: d["coefficients"].__setitem__(0, "31/100"),
    "another frequency": lambda d: d["omega"].__setitem__(0, str(Fraction(d["omega"][0]) + Fraction(1, 10**9))),
    "another N": lambda d: d.__setitem__("N", 4),
    "other seeds": lambda d: d.__setitem__("seeds", [2, 1]),
    "a coefficient of the torus": lambda d: d["torus"][3].__setitem__(2, d["torus"][3][2] + 2**40),
    "a harmonic of the torus": lambda d: d["torus"].pop(5),
    "fewer bits": lambda d: d.__setitem__("bits", d["bits"] - 1),
    "another twist": lambda d: d["directions"][0][2].__setitem__(0, d["directions"][0][2][0] * 2),
    "no twist": lambda d: d["directions"][0].__setitem__(2, []),
    "one direction twice": lambda d: d["directions"].__setitem__(1, copy.deepcopy(d["directions"][0])),
    "no weight": lambda d: d["weights"].pop(),
    "a weight of zero": lambda d: d["weights"].__setitem__(0, 0),
    "no directions": lambda d: d.__setitem__("directions", []),
    "fewer bits of the frame": lambda d: d.__setitem__("frame_bits", 50),
    "an action that turns": lambda d: d["directions"][0].__setitem__(1, 5),
    "a harmonic twice": lambda d: d["torus"].append(d["torus"][0]),
    "a negative time": lambda d: d["stay"].__setitem__(0, "-1"),
    "a boolean": lambda d: d["weights"].__setitem__(0, True),
    "another schema": lambda d: d.__setitem__("schema", 1),
    "a key more": lambda d: d.__setitem__("more", 1),
}


REASONS = {
    "a smaller residual": "the residual may be",
    "a smaller radius of the energy": "the energy may be",
    "another energy": "the energy may be",
    "a longer time": "the distance may be reached",
    "a smaller weighted distance": "the distance may be reached",
    "a smaller distance": "stretches may differ",
    "a smaller momentum": "velocities may differ",
    "a smaller drift": "an angle may drift",
    "another coupling": "the residual may be",
    "another frequency": "the residual may be",
    "a coefficient of the torus": "the residual may be",
    "another twist": "the distance may be reached",
}


def halved(pair):
    return [pair[0] // 2, pair[1]]


@pytest.mark.parametrize("name", CLAIMS)
def test_an_altered_claim_with_a_digest_that_fits_is_refused(name, tmp_path):
    data = copy.deepcopy(stay())
    CLAIMS[name](data)
    refused(sealed(data), tmp_path, REASONS.get(name, ""))


def test_the_printed_time_is_not_above_the_one_checked(tmp_path):
    data = copy.deepcopy(stay())
    data["stay"][0] = "9999/10"
    lines = checked(sealed(data), tmp_path)
    assert "stays, for 9.99e2 units of time" in lines[2]


@pytest.mark.parametrize("kept", [0, 1])
def test_a_point_or_a_torus_of_fewer_angles_is_refused(kept, tmp_path):
    """Its residual is small, at rest or as a single mode; but it is not what the sentence says."""
    data = copy.deepcopy(residual())
    for row in data["torus"]:
        if row[1] or not kept:
            row[2:] = [0] * len(row[2:])
    data["residual"] = [1, 0]
    refused(sealed(data), tmp_path, "nothing moves with the angle")


def test_rounded_frequencies_are_not_called_exact(tmp_path):
    data = copy.deepcopy(residual())
    data["residual"] = [8, 0]
    assert "with frequencies near " in checked(sealed(data), tmp_path)[0]
    data["omega"] = ["1", "7/4"]
    refused(sealed(data), tmp_path, "a harmonic of the energy does not turn")
    data["energy"] = []
    assert "with frequencies 1.00000000000, 1.75000000000, leaves" in checked(sealed(data), tmp_path)[0]


def test_a_frame_without_a_claim_is_refused(tmp_path):
    data = copy.deepcopy(residual())
    data["weights"] = [1]
    refused(sealed(data), tmp_path, "without a claim")


@pytest.mark.long
def test_what_passes_with_a_digest_that_fits_claims_no_more(tmp_path):
    """Choices of the frame may move in their last places; then the theorem follows still."""
    rng, passed = random.Random(7), 0
    for _ in range(20):
        data = copy.deepcopy(stay())
        row = rng.choice(rng.choice(data["directions"])[3])
        row[-1] += rng.choice([1, -1])
        try:
            lines = checked(sealed(data), tmp_path)
        except CertificateError:
            continue
        passed += 1
        assert lines[:2] == checked(stay(), tmp_path)[:2]
    assert passed


def test_packed_products_are_those_of_the_definition():
    rng = random.Random(2)
    one, other = ({(rng.randint(-3, 3), rng.randint(-2, 2)): rng.randint(-999, 999) for _ in range(9)} for _ in range(2))
    direct = {}
    for a, x in one.items():
        for b, y in other.items():
            nu = (a[0] + b[0], a[1] + b[1])
            direct[nu] = direct.get(nu, 0) + x * y
    packing = Packing([Series(one, 0), Series(other, 0)], 1)
    found = packing.unpacked(packing.packed(Series(one, 0)) * packing.packed(Series(other, 0)))
    assert found == {nu: x for nu, x in direct.items() if x}
    assert product(Series(one, 0), Series({}, 0), Budget(1)).values == {}


def test_no_number_of_it_is_rounded():
    files = sorted(Path(check_torus.__file__).parent.glob("*.py"))
    assert len(files) > 5
    tree = [node for file in files for node in ast.walk(ast.parse(file.read_text()))]
    assert not [node for node in tree if isinstance(node, ast.Constant) and isinstance(node.value, float)]


def test_one_far_harmonic_costs_little():
    """One number of a certificate of 2 kB, -1628 for the harmonic of an angle, used to cost a minute."""
    data = copy.deepcopy(residual())
    data["torus"][-1][0] = -1628
    steps = [spent_on_residual(data), spent_on_residual(residual())]
    assert steps[0] < 4 * steps[1]


def spent_on_residual(data):
    claim = read_claim(data)
    before = claim.budget.left
    residuals(claim)
    return before - claim.budget.left


def test_both_ways_of_a_product_are_the_same():
    few, many = {(1628, 0): 5, (0, 1): -7}, {(i, 3 - i): 2**i for i in range(4)}
    packing = Packing([Series(few, 0), Series(many, 0)], 1)
    exact = by_pairs(Series(few, 0), Series(many, 0))
    assert packing.unpacked(packing.packed(Series(few, 0)) * packing.packed(Series(many, 0))) == exact
    budget = Budget(1)
    assert product(Series(few, 0), Series(many, 0), budget).values == exact
    assert 0 < STEPS_A_BYTE - budget.left < packing.steps


def test_work_beyond_the_size_of_the_file_is_refused(tmp_path):
    """Harmonics of the energy in a box of 17 million places, named by four rows."""
    data = copy.deepcopy(residual())
    data |= {"N": 4, "seeds": [1, 2, 3], "omega": ["1", "1/2", "1/3"], "coefficients": ["1"]}
    data["torus"] = [[1, 0, 0, 1, 1], [0, 1, 0, 1, 0], [0, 0, 1, 1, 1], [301, 501, 501, 0, 0]]
    data["residual"] = [2**60, 0]
    refused(sealed(data), tmp_path, "more steps than its size allows")
