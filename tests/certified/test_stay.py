"""How long orbits stay near a torus: against integrated orbits; what cannot be proved says why."""

import re
from fractions import Fraction
from functools import cache
from itertools import pairwise

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, NoStayProof, prove_stay, refine
from symfpu.certified.frame import directions_of
from symfpu.certified.growth import Growth
from symfpu.certified.norms import norms, weights_of
from symfpu.certified.rounded_torus import residual_of, rounded_torus, stretches_of
from symfpu.certified.stay import told_apart
from symfpu.normal.search import _Search
from tests.certified.tori import one_off, rational, torus, value
from tests.tolerances import COARSE_STAY, DIGITS_STAY, DOUBLES_STAY, FRAME_RESIDUAL, FRAME_SEEN


def silent(*_):
    """No progress."""


@cache
def precise():
    return refine(torus(), digits=30)


@cache
def coarse():
    """A torus that is off, so that orbits leave it visibly."""
    return one_off(torus(), 1e-10)


def test_a_frame_takes_all_modes(monkeypatch):
    """Where one is missing it names that one: the others are no frame."""
    found = _Search.mode
    monkeypatch.setattr(_Search, "mode", lambda search, q, *rest: None if q == 3 else found(search, q, *rest))
    with pytest.raises(symfpu.NoNormalModes, match="continues mode 3"):
        directions_of(symfpu.torus(Chain(4, alpha="0.3"), (2,), amplitudes={2: "0.1"}), silent)


def taylor(torus, time, step, order=20, digits=30):
    """The orbit from phi = 0 by Taylor series of the particles, and the stretches of the torus."""
    rounded = rounded_torus(torus)
    N, terms = torus.chain.N, {1: Fraction(1), **rounded.couplings}
    with mpmath.workdps(digits):
        x = [value(series, (0, 0)) for series in rounded.particles]
        p = [mpmath.mpf(0)] * (N - 1)
        for _ in range(round(time / step)):
            series = [[a, b] for a, b in zip(x, p, strict=True)]
            for k in range(order):
                push = tensions(series, terms, k)
                for j, row in enumerate(series):
                    row.append((push[j + 1] - push[j]) / ((k + 1) * (k + 2)))
            x = [mpmath.polyval(row[::-1], step) for row in series]
            p = [mpmath.polyval([k * c for k, c in enumerate(row)][:0:-1], step) for row in series]
        return stretches(x)


def tensions(series, terms, k):
    """The coefficient of t^k of V'(r) of every bond."""
    rows = [[0] * (k + 1), *(row[: k + 1] for row in series), [0] * (k + 1)]
    found = []
    for a, b in pairwise(rows):
        r = [y - x for x, y in zip(a, b, strict=True)]
        power, total = r, 0
        for n in range(1, max(terms) + 1):
            power = r if n == 1 else [sum(power[i] * r[m - i] for i in range(m + 1)) for m in range(k + 1)]
            if n in terms:
                total += rational(terms[n]) * power[k]
        found.append(total)
    return found


def stretches(x):
    ends = [0, *x, 0]
    return [b - a for a, b in pairwise(ends)]


def at_time(torus, time):
    """Stretches of the torus at angles omega t."""
    with mpmath.workdps(30):
        turns = [rational(w) * time / mpmath.pi for w in torus.frequencies]
        return stretches([value(series, turns) for series in rounded_torus(torus).particles])


def slopes(torus):
    """Above |dr_j/dtheta_m| of every bond at all angles: by angle, the largest of all bonds."""
    rounded = rounded_torus(torus)
    bonds = stretches_of(list(rounded.particles))
    return [max(bond.by_angle(m).norm for bond in bonds) for m in range(2)]


def test_an_integrated_orbit_stays_within_the_distance_and_the_drift():
    """By Taylor series of order 20 in 30 digits; the torus is off by 1e-10, so that it leaves."""
    time = 8
    proof = prove_stay(coarse(), time=time)
    orbit, near = taylor(coarse(), time, mpmath.mpf(1) / 4), at_time(coarse(), time)
    away = max(abs(a - b) for a, b in zip(orbit, near, strict=True))
    by_angles = sum(d * s for d, s in zip(proof.drift.values(), slopes(coarse()), strict=True))
    assert away <= proof.distance + by_angles
    assert away > 0.01 * (proof.distance + by_angles)  # it does leave, and the bound is not far off
    assert proof.distance < COARSE_STAY


def test_the_frame_is_nearly_symplectic_and_leaves_little():
    rounded = rounded_torus(torus())
    found = norms(rounded, directions_of(torus(), silent), [x.norm for x in residual_of(rounded)])
    growth = found.growth(weights_of(found))
    assert growth.room > Fraction(99, 100)
    assert growth.terms[1] < FRAME_RESIDUAL


def test_a_frequency_of_the_frame_that_is_off_is_seen():
    """The planted bug: sigma wrong by 1e-6 leaves about 2 sigma 1e-6 of the linearised equations."""
    wide = torus(4)
    rounded = rounded_torus(wide)
    directions = list(directions_of(wide, silent))
    left = [x.norm for x in residual_of(rounded)]
    normal = directions[-1]
    directions[-1] = type(normal)(normal.mode, normal.rate + Fraction(1, 10**6), normal.particles)
    found = norms(rounded, directions, left)
    assert found.growth(weights_of(found)).terms[1] > FRAME_SEEN


def test_thirty_digits_stay_for_1e9_and_doubles_say_how_long():
    proof = prove_stay(precise())
    assert proof.distance < DIGITS_STAY
    assert proof.longest > 1e13
    assert proof.distance_at("1e6") < proof.distance < proof.distance_at("1e12")
    with pytest.raises(InputError, match="time"):
        prove_stay(torus(), time=0)
    with pytest.raises(NoStayProof, match="more digits") as caught:
        prove_stay(torus())
    assert 1e4 < caught.value.longest < 1e9
    assert prove_stay(torus(), time=int(caught.value.longest / 2)).distance < DOUBLES_STAY


def test_the_distance_is_about_residual_times_time():
    """No Gronwall: a hundred times the time, a hundred times the distance."""
    proof = prove_stay(precise(), time=10**4)
    assert 90 < proof.distance_at(10**6) / proof.distance_at(10**4) < 110
    assert proof.bound == symfpu.prove_residual(precise()).bound


def test_the_time_is_below_that_of_the_scalar_equation():
    """d' = r + c d^2 is a tangent: time arctan(d sqrt(c/r)) / sqrt(r c)."""
    r, c = 1e-10, 4.0
    growth = Growth((Fraction(r), Fraction(0), Fraction(c)), Fraction(1), Fraction(0))
    for d in (1e-8, 5e-6, 1e-3):
        exact = np.arctan(d * np.sqrt(c / r)) / np.sqrt(r * c)
        assert 0.9 * exact < growth.time(Fraction(d)) < exact
    d = 1e-8
    assert d < growth.distance(growth.time(Fraction(d))) < 1.05 * d


@pytest.mark.long
def test_a_hyperbolic_torus_is_refused_by_name():
    """Seeds 1 and 5 of N = 8, beta = 1 (docs/normal-modes.md)."""
    sizes = {1: "0.1", 5: "0.7"}
    guess = symfpu.torus(Chain(8, beta=1), tuple(sizes), amplitudes=sizes, method="series", order=6)
    with pytest.raises(InputError, match="elliptic"):
        prove_stay(refine(guess, amplitudes=sizes))


@pytest.mark.long
@pytest.mark.parametrize("law", [{"beta": "1/2"}, {"potential": "poly:1/4,0,1/5"}], ids=str)
def test_other_polynomials(law):
    proof = prove_stay(refine(torus(4, **law), digits=30))
    assert proof.distance < DIGITS_STAY


def test_a_time_just_too_long_is_told_from_the_longest():
    """Both with as many digits as differ, the longest not above itself, and it can be proved."""
    longest = prove_stay(torus(), time=1).longest
    with pytest.raises(NoStayProof) as caught:
        prove_stay(torus(), time=Fraction(longest) * (1 + Fraction(1, 10**6)))
    asked, most = map(float, re.search("a stay of (.*): at most (.*?); ", str(caught.value)).groups())
    assert longest < asked
    assert most <= caught.value.longest == longest
    assert prove_stay(torus(), time=most).time == most


def test_times_far_apart_have_three_digits():
    assert told_apart(1e9, 123456.0) == ("1.0e+9", "1.23e+5")
    assert told_apart(2.0000001, 2.0) == ("2.01", "2.0")
    assert told_apart(2.0, 1.9999999) == ("2.0", "1.99")
