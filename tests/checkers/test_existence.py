"""Certificates of existence: every number altered is refused, and with a digest made to fit whatever the theorem would not give."""

import copy
import math
import re
from fractions import Fraction
from functools import cache

import mpmath
import pytest

import symfpu
from symfpu import Chain, prove_existence
from symfpu.certified.force_series import ball, of_growth
from symfpu.certified.packed_integers import packed
from symfpu.chain.potentials.potential import Growth as ProverGrowth
from symfpu.checkers import existence as check_existence
from symfpu.checkers.existence import COSINE_UNITS, Cosines, verify
from symfpu.checkers.existence.claim import Growth, read_claim, rest_of_growth
from symfpu.checkers.existence.reading import unpacked
from symfpu.checkers.existence.theorem import check_contraction
from symfpu.checkers.existence.wording import decimal_interval, theorem_text
from symfpu.checkers.reading import CertificateError
from tests.checkers.certificate_files import altered, bounds_of, check_refused, reason, sealed


def both():
    return symfpu.torus(Chain(3, alpha="0.3", beta="1/7"), (1,), amplitudes={1: "0.3"})


def wave():
    return symfpu.torus(Chain(5, alpha="0.3", beta="1/7", ends="periodic"), (1,), amplitudes={1: "0.3"})


MADE = {
    "frequency": lambda: prove_existence(both()),
    "amplitude": lambda: prove_existence(both(), amplitude="0.3"),
    "energy": lambda: prove_existence(symfpu.torus(Chain(3, potential="toda:1/2"), (1,), energy="0.02"), energy="0.02"),
    "segment of amplitude": lambda: prove_existence(both(), amplitude="0.3", half_width="1e-5"),
    "segment of frequency": lambda: prove_existence(both(), half_width="1e-6"),
    "segment of energy": lambda: prove_existence(both(), energy="0.0453646", half_width="1e-6"),
    "wave": lambda: prove_existence(wave()),
    "segment of waves": lambda: prove_existence(wave(), amplitude="0.3", half_width="1e-5"),
}


@cache
def certificate(name="frequency"):
    return MADE[name]().certificate()


def entry(i, change):
    """A change of one number of a list that is written as text."""

    def changed(text):
        values = unpacked(text, "text")
        values[i] = change(values[i])
        return packed(values)

    return changed


@pytest.mark.parametrize("name", MADE)
def test_certificates_hold(name, tmp_path):
    assert reason(verify, certificate(name), tmp_path) is None


def shifted(text):
    return str(Fraction(text) + Fraction(1, 10**12))


FORGERIES = {
    "a smaller radius": (("radius", 0), lambda m: m // 2, "exceeds r"),
    "a radius above that of uniqueness": (("unique", 1), lambda e: e + 200, "above that of uniqueness"),
    "more uniqueness": (("unique", 0), lambda m: 2 * m, "not below 1"),
    "another amplitude": (("amplitude", 0), lambda m: m + m // 10**12, "amplitude"),
    "a narrower amplitude": (("amplitude", 1), lambda m: m // 3, "amplitude"),
    "another energy": (("energy", 0), lambda m: m + m // 10**12, "H may be outside"),
    "a narrower energy": (("energy", 1), lambda m: m // 4, "H may be outside"),
    "another frequency": (("omega",), shifted, "not the frequency"),
    "another coupling": (("coefficients", 0), lambda _: "300000000001/1000000000000", "exceeds r"),
    "another coefficient": (("orbit", 1), entry(0, lambda c: c + c // 10**12), "exceeds r"),
    "one more bond": (("N",), lambda N: N + 1, "wrong"),
    "another seed": (("seed",), lambda _: 2, "wrong length|seed|block"),
    "other bits": (("bits",), lambda b: b + 1, "exceeds r|amplitude|not below"),
    "another inverse": (("inverse", 0), entry(0, lambda a: 3 * a), "not below 1|exceeds r"),
    "a weight below 1": (("weights",), entry(0, lambda _: 1), "a weight"),
    "a wider strip": (("nu",), lambda _: "2", "not below 1|exceeds r"),
    "no strip": (("nu",), lambda _: "1", "nu is not"),
    "fewer free harmonics": (("free",), lambda _: 1, "wrong number of weights|block"),
}


OF_KINDS = {
    "another amplitude given": ("amplitude", ("value",), lambda _: "300000000001/1000000000000", "exceeds r"),
    "an amplitude of the other sign": ("amplitude", ("value",), lambda v: f"-{v}", "exceeds r"),
    "a wider frequency": ("amplitude", ("frequency", 1), lambda m: m // 3, "frequency may be outside"),
    "another frequency of the orbit": ("amplitude", ("omega",), shifted, "exceeds r"),
    "another energy given": ("energy", ("value",), shifted, "exceeds r"),
    "another function": ("energy", ("growths", 0, 2), shifted, "linear force"),
    "another degree": ("energy", ("degree",), lambda _: 4, "exceeds r"),
    "functions and a polynomial": ("energy", ("coefficients",), lambda _: ["1"], "one of the two"),
    "an amplitude for an energy": ("energy", ("fixed",), lambda _: "amplitude", "exceeds r|not below 1"),
    "a frequency for an amplitude": ("amplitude", ("fixed",), lambda _: "frequency", "not the frequency"),
    "nothing fixed": ("amplitude", ("fixed",), lambda _: "phase", "nothing that can be fixed"),
    "no weight of the frequency": ("amplitude", ("weights",), entry(0, lambda _: 1), "a weight"),
    "another scale": ("amplitude", ("scales", 0), lambda e: e + 8, "not below 1|exceeds r"),
    "a segment without a direction": ("amplitude", ("half_width",), lambda _: "1/1000000", "without a direction"),
    "a direction without a segment": ("segment of amplitude", ("half_width",), lambda _: "0", "without a segment"),
    "a longer segment": ("segment of amplitude", ("half_width",), lambda _: "1/50000", "exceeds r|not below 1"),
    "a longer segment of frequency": ("segment of frequency", ("half_width",), lambda _: "1/500000", "exceeds r|not below"),
    "a longer segment of energy": ("segment of energy", ("half_width",), lambda _: "1/500000", "exceeds r|not below"),
    "another direction": ("segment of energy", ("direction", 1), entry(0, lambda c: c + c // 5), "exceeds r|not below 1"),
    "a slower frequency": ("segment of energy", ("direction_frequency",), lambda c: c // 2, "exceeds r|not below 1"),
    "a narrower interval of A": ("segment of energy", ("amplitude", 1), lambda m: m // 3, "amplitude of the orbit"),
    "a narrower interval of H": ("segment of amplitude", ("energy", 1), lambda m: m // 3, "H may be outside"),
    "a smaller radius": ("segment of amplitude", ("radius", 0), lambda m: m // 2, "exceeds r"),
    "a wave for an orbit": ("frequency", ("ends",), lambda _: "travelling", "wrong length"),
    "an orbit for a wave": ("wave", ("ends",), lambda _: "fixed", "wrong length"),
    "other ends": ("wave", ("ends",), lambda _: "free", "neither"),
    "a larger ring": ("wave", ("N",), lambda N: N + 1, "exceeds r|not below|wrong length"),
    "a wave of another seed": ("wave", ("seed",), lambda _: 2, "exceeds r|not below|block"),
    "a wave of no seed": ("wave", ("seed",), lambda _: 0, "mode 0"),
    "a wave of a seed too large": ("wave", ("seed",), lambda _: 3, "out of its range"),
    "a wave of another amplitude": ("wave", ("amplitude", 0), lambda m: m + m // 10**12, "amplitude"),
    "a wave of another energy": ("wave", ("energy", 0), lambda m: m + m // 10**12, "H may be outside"),
    "a wave of a narrower energy": ("wave", ("energy", 1), lambda m: m // 8, "H may be outside"),
    "another harmonic of a wave": ("wave", ("orbit", 2), entry(0, lambda c: c + c // 10**10), "exceeds r"),
    "waves of a narrower H": ("segment of waves", ("energy", 1), lambda m: m // 8, "H may be outside"),
    "waves of a wider segment": ("segment of waves", ("half_width",), lambda _: "1/30000", "exceeds r|not below 1"),
}


EVERY = [*((name, ("frequency", *forgery)) for name, forgery in FORGERIES.items()), *OF_KINDS.items()]


@pytest.mark.parametrize(("name", "forgery"), EVERY)
def test_forgeries_with_a_digest_that_fits_are_refused(name, forgery, tmp_path):
    kind, place, change, why = forgery
    check_refused(verify, sealed(altered(certificate(kind), place, change)), tmp_path, why)


NO_ORBIT = {
    "format": "symfpu existence certificate", "schema": 3, "ends": "fixed", "N": 2, "coefficients": ["0"] * 5 + ["1"], "growths": [],
    "degree": 7, "seed": 1, "fixed": "frequency", "value": "9/10", "half_width": "0", "omega": "9/10", "nu": "17/16",
    "bits": 80, "orbit": ["", packed([2**50])], "scales": [], "direction": [], "direction_frequency": 0,
    "slope_harmonics": 1, "free": 2, "block": [[1, 1]], "inverse_bits": 20, "inverse": [packed([1762313])],
    "weight_bits": 0, "weights": packed([1]), "radius": [1, 60], "unique": [1, 40], "amplitude": [2**70 * 7 // 10, 2**64, 100],
    "energy": [2**59, 2**55, 120], "frequency": [],
}  # fmt: skip


def test_where_the_force_rounds_to_nothing_the_linear_part_counts(tmp_path):
    """V = r^2/2 + r^8/8, c_1[1] = 2^-30: r^7 is below the last place, and no orbit has omega = 0.9 beside sqrt(2)."""
    assert "exceeds r" in reason(verify, sealed(NO_ORBIT), tmp_path)


def test_a_harmonic_that_the_orbit_lacks_is_seen_where_products_are_cut(tmp_path):
    """An orbit of A = 1e-20 with 4 2^-bits added at harmonic 9, ten times the radius."""
    small = prove_existence(symfpu.torus(Chain(3, alpha="0.3"), (1,), amplitudes={1: "1e-20"}), amplitude="1e-20")
    data = copy.deepcopy(small.certificate())
    assert reason(verify, data, tmp_path) is None
    assert small.radius < 2.0 ** -data["bits"]
    while len(data["orbit"]) < 10:
        data["orbit"].append(packed([0]))
    data["orbit"][9] = packed([4])
    assert "exceeds r" in reason(verify, sealed(data), tmp_path)


@pytest.mark.parametrize("half", [0, 1, 11, 99, 110, 1050, 5000])
@pytest.mark.parametrize("middle", [1051, -1051, 9999, 1234567, 3])
def test_printed_intervals_hold_those_that_were_checked(middle, half):
    middle_text, half_text = decimal_interval([middle, half, 10]).split(" +- ")
    printed, width = Fraction(middle_text), Fraction(half_text)
    assert printed - width <= Fraction(middle - half, 1024)
    assert Fraction(middle + half, 1024) <= printed + width


@pytest.mark.parametrize("unique", [Fraction(10001, 10**8), Fraction(9999, 7), Fraction(1, 2)])
def test_the_printed_radius_of_uniqueness_is_not_above_the_one_checked(unique):
    text = theorem_text(read_claim(certificate()), certificate(), Fraction(1, 2**60), unique)
    within = Fraction(re.search(r"only one within (\S+) in", text).group(1))
    assert unique * Fraction(99, 100) < within <= unique


def test_the_length_of_a_segment_counts_in_its_contraction():
    """The largest R of its middle is too large for its ends."""
    _, bounds = bounds_of(certificate("segment of amplitude"))
    assert check_contraction(bounds, Fraction(0), bounds.linear(), Fraction(1, 10**9), Fraction(1, 10**6)) is None
    low, high = Fraction(0), Fraction(1)
    while high - low > bounds.length() / 8:
        middle = (low + high) / 2
        below = bounds.linear() + bounds.curvature(middle) * middle < 1
        low, high = (middle, high) if below else (low, middle)
    assert 0 < bounds.length() < low
    with pytest.raises(CertificateError, match="not below 1"):
        check_contraction(bounds, Fraction(0), bounds.linear(), Fraction(1, 10**9), low)


def test_the_energy_depends_on_far_harmonics_no_more_than_its_bound():
    claim, bounds = bounds_of(certificate("energy"))
    condition, bonds = bounds.condition, bounds.bonds
    for first in (1, 4, 9):
        bound = condition.farthest(first, bonds)
        assert bound > 0
        for n in range(first, 16):
            for q in claim.allowed(n):
                size = max(map(abs, condition.by(n, q, claim, bonds)))
                assert Fraction(size, bounds.unit) / claim.nu**n <= bound + Fraction(4, bounds.unit)


@pytest.mark.parametrize("numbers", [(1, 0, 1), ("1/6", 1, -7), ("-1/6", 1, -13), (2, "-1/2", "1/3")])
@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_what_a_function_has_beyond_a_degree_is_bounded(numbers, derivative):
    """Against two hundred of its coefficients by their product formula; the prover has the same bound in balls."""
    weight, slope, rate = map(Fraction, numbers)
    x, degree, coefficient, total = Fraction(1, 20), 7, weight, Fraction(0)
    for k in range(200):
        if k > degree:
            total += abs(coefficient) * math.perm(k, derivative) * x ** (k - derivative)
        coefficient *= (rate - slope * k) / (k + 1)
    bound = rest_of_growth(Growth(weight, slope, rate), degree + 1, x, derivative)
    assert 0 < total <= bound <= 2 * total
    assert of_growth(ProverGrowth(weight, slope, rate), degree + 1, ball(x), derivative).overlaps(ball(bound))


def test_choices_may_differ_but_not_the_theorem(tmp_path):
    """Another weight proves the same theorem."""
    assert reason(verify, sealed(altered(certificate(), ("weights",), entry(-1, lambda v: v + 1))), tmp_path) is None


@pytest.mark.parametrize("N", [2, 7, 32])
def test_cosines_are_within_their_units(N):
    for places in (60, 200):
        found = Cosines(N, places)
        with mpmath.workprec(places + 40):
            for k in range(-1, 8 * N):
                exact = mpmath.ldexp(mpmath.cospi(mpmath.mpf(k) / (2 * N)), places)
                assert abs(found.of(k) - exact) < COSINE_UNITS


def test_integers_as_text_are_read_as_they_were_written():
    values = [0, 1, -1, 22, 23, -23, -24, 10**40, -(10**40) + 7, *range(-3000, 3000, 7)]
    assert unpacked(packed(values), "text") == values
    for text in ("!o", "Q", "Q!", "é", " "):
        with pytest.raises(CertificateError, match="text"):
            unpacked(text, "text")


def test_packed_columns_multiply_exactly():
    rows = [[3, -5, 2**40], [-(2**40), 0, 7], [1, 1, -1]]
    columns = check_existence.Packed(rows, 2**70)
    for factors in ({0: 2**70, 2: -(2**70)}, {1: -1}, {}):
        expected = [sum(x * row[l] for l, x in factors.items()) for row in rows]
        assert columns.combination(factors) == expected
    with pytest.raises(CertificateError, match="larger than its bound"):
        columns.combination({0: 2**70 + 1})
