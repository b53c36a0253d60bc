"""The checker of certificates of tori: what is altered is refused, and it shares no code with the prover."""

import ast
import copy
import json
import random
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest

from symfpu import prove_residual, prove_stay
from symfpu.checkers import torus as check_torus
from symfpu.checkers.reading import CertificateError
from symfpu.checkers.torus import Packing, Series, product, verify
from symfpu.checkers.torus.budget import STEPS_A_BYTE, Budget
from symfpu.checkers.torus.claim import read_claim
from symfpu.checkers.torus.residual import residuals
from symfpu.checkers.torus.series import by_pairs
from tests.checkers.certificate_files import altered, check_refused, sealed
from tests.every_result import two_angles


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


def test_both_kinds_are_theorems(tmp_path):
    of_residual, of_energy = checked(residual(), tmp_path)
    assert "leaves" in of_residual
    assert "H of that torus is within" in of_energy
    lines = checked(stay(), tmp_path)
    assert lines[1] == of_energy
    assert "every orbit that starts on this torus stays, for 1.00e3 units of time" in lines[2]


def halved(pair):
    return [pair[0] // 2, pair[1]]


REACHED = "the distance may be reached"
# what is altered, and why it is refused, if for one reason
CLAIMS = {
    "a smaller residual": (("residual", 0), lambda m: m // 2, "the residual may be"),
    "a smaller radius of the energy": (("energy", 1), halved, "the energy may be"),
    "another energy": (("energy", 0, 0), lambda m: -m, "the energy may be"),
    "an energy without a radius": (("energy",), lambda ball: ball[:-1], ""),
    "a radius below zero": (("energy", 1, 0), lambda m: -m, ""),
    "a longer time": (("stay", 0), lambda _: "100000", REACHED),
    "a smaller weighted distance": (("stay", 1), halved, REACHED),
    "a smaller distance": (("stay", 2), halved, "stretches may differ"),
    "a smaller momentum": (("stay", 3), halved, "velocities may differ"),
    "a smaller drift": (("stay", 4, 1), halved, "an angle may drift"),
    "a larger weighted distance": (("stay", 1, 0), lambda m: m * 2, ""),
    "another coupling": (("coefficients", 0), lambda _: "31/100", "the residual may be"),
    "another frequency": (("omega", 0), lambda w: str(Fraction(w) + Fraction(1, 10**9)), "the residual may be"),
    "another N": (("N",), lambda _: 4, ""),
    "other seeds": (("seeds",), lambda _: [2, 1], ""),
    "a coefficient of the torus": (("torus", 3, 2), lambda c: c + 2**40, "the residual may be"),
    "a harmonic of the torus": (("torus",), lambda rows: rows[:5] + rows[6:], ""),
    "fewer bits": (("bits",), lambda bits: bits - 1, ""),
    "another twist": (("directions", 0, 2, 0), lambda c: c * 2, REACHED),
    "no twist": (("directions", 0, 2), lambda _: [], ""),
    "one direction twice": (("directions",), lambda all_of_them: [all_of_them[0], all_of_them[0], *all_of_them[2:]], ""),
    "no weight": (("weights",), lambda weights: weights[:-1], ""),
    "a weight of zero": (("weights", 0), lambda _: 0, ""),
    "no directions": (("directions",), lambda _: [], ""),
    "fewer bits of the frame": (("frame_bits",), lambda _: 50, ""),
    "an action that turns": (("directions", 0, 1), lambda _: 5, ""),
    "a harmonic twice": (("torus",), lambda rows: [*rows, rows[0]], ""),
    "a negative time": (("stay", 0), lambda _: "-1", ""),
    "a boolean": (("weights", 0), lambda _: True, ""),
    "another schema": (("schema",), lambda _: 1, ""),
}


@pytest.mark.parametrize("name", CLAIMS)
def test_an_altered_claim_with_a_digest_that_fits_is_refused(name, tmp_path):
    *change, why = CLAIMS[name]
    check_refused(verify, sealed(altered(stay(), *change)), tmp_path, why)


def test_the_printed_time_is_not_above_the_one_checked(tmp_path):
    lines = checked(sealed(altered(stay(), ("stay", 0), lambda _: "9999/10")), tmp_path)
    assert "stays, for 9.99e2 units of time" in lines[2]


@pytest.mark.parametrize("kept", [0, 1])
def test_a_point_or_a_torus_of_fewer_angles_is_refused(kept, tmp_path):
    """Its residual is small, at rest or as a single mode; but it is not what the sentence says."""
    data = copy.deepcopy(residual())
    for row in data["torus"]:
        if row[1] or not kept:
            row[2:] = [0] * len(row[2:])
    data["residual"] = [1, 0]
    check_refused(verify, sealed(data), tmp_path, "nothing moves with the angle")


def test_rounded_frequencies_are_not_called_exact(tmp_path):
    data = residual() | {"residual": [8, 0]}
    assert "with frequencies near " in checked(sealed(data), tmp_path)[0]
    data |= {"omega": ["1", "7/4"]}
    check_refused(verify, sealed(data), tmp_path, "a harmonic of the energy does not turn")
    assert "with frequencies 1.00000000000, 1.75000000000, leaves" in checked(sealed(data | {"energy": []}), tmp_path)[0]


def test_a_frame_without_a_claim_is_refused(tmp_path):
    check_refused(verify, sealed(residual() | {"weights": [1]}), tmp_path, "without a claim")


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
    far = altered(residual(), ("torus", -1, 0), lambda _: -1628)
    assert spent_on_residual(far) < 4 * spent_on_residual(residual())


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
    data = residual() | {"N": 4, "seeds": [1, 2, 3], "omega": ["1", "1/2", "1/3"], "coefficients": ["1"], "residual": [2**60, 0]}
    data["torus"] = [[1, 0, 0, 1, 1], [0, 1, 0, 1, 0], [0, 0, 1, 1, 1], [301, 501, 501, 0, 0]]
    check_refused(verify, sealed(data), tmp_path, "more steps than its size allows")
