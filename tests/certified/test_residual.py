"""Residuals of tori: the bound is above the residual at every angle, and not far above it."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, prove_residual, refine
from symfpu.certified.rounded_torus import polynomial_of, rounded_torus
from symfpu.certified.series import Series, product
from tests.certified.tori import AMPLITUDES, entries, one_off, rational, torus, turned, value
from tests.tolerances import ENERGY_OF_TORUS, NEWTON_RESIDUAL

LAWS = {"alpha": {"alpha": "0.3"}, "beta": {"beta": "1/2"}, "both": {"alpha": "1/3", "beta": "0.2"}}
NEAR = 3  # times the largest residual on a grid: the bound is no more


def on_a_grid(torus, points):
    """Largest |x'' - force| of every particle at the angles of a grid, in 30 digits."""
    rounded = rounded_torus(torus)
    chain = torus.chain
    angles = [mpmath.mpf(2) * k / points for k in range(points)]
    worst = [mpmath.mpf(0)] * (chain.N - 1)
    for a in angles:
        for b in angles:
            x, moved = [0] * (chain.N + 1), [0] * (chain.N - 1)
            for j, series in enumerate(rounded.particles):
                for nu, c in entries(series):
                    wave = c * mpmath.cospi(turned(nu, (a, b)))
                    x[j + 1] += wave
                    moved[j] -= rate(torus, nu) ** 2 * wave
            r = [x[j + 1] - x[j] for j in range(chain.N)]
            for j in range(chain.N - 1):
                force = slope(rounded, r[j + 1]) - slope(rounded, r[j])
                worst[j] = max(worst[j], abs(moved[j] - force))
    return worst


def rate(torus, nu):
    return rational(turned(nu, torus.frequencies))


def slope(rounded, r):
    return r + sum(rational(c) * r**k for k, c in rounded.couplings.items())


@pytest.mark.parametrize("law", ["alpha", pytest.param("beta", marks=pytest.mark.long), pytest.param("both", marks=pytest.mark.long)])
def test_the_bound_is_above_the_residual_on_a_grid_and_near_it(law):
    with mpmath.workdps(30):
        found = prove_residual(torus(**LAWS[law]))
        on_grid = on_a_grid(torus(**LAWS[law]), 8)
        for bound, value in zip(found.particles, on_grid, strict=True):
            assert value <= bound
        assert found.bound <= NEAR * max(on_grid)


def test_a_torus_with_one_coefficient_off_has_that_much_more_of_it():
    """(nu.omega)^2 - Omega^2 times the change, here of a harmonic where that is about 1."""
    change = 1e-6
    assert change / 10 < prove_residual(one_off(torus(), change)).bound < 10 * change
    assert prove_residual(torus()).bound < NEWTON_RESIDUAL


def energy_at(torus, a, b):
    """H of the rounded torus at the angles pi a, pi b."""
    rounded = rounded_torus(torus)
    x, p = [0] * (torus.chain.N + 1), [0] * (torus.chain.N + 1)
    for j, series in enumerate(rounded.particles, start=1):
        x[j] = value(series, (a, b))
        p[j] = -sum(c * rate(torus, nu) * mpmath.sinpi(turned(nu, (a, b))) for nu, c in entries(series))
    r = [x[j + 1] - x[j] for j in range(torus.chain.N)]
    terms = {1: Fraction(1), **rounded.couplings}
    stored = sum(rational(c) * s ** (k + 1) / (k + 1) for k, c in terms.items() for s in r)
    return sum(v**2 for v in p) / 2 + stored


LAWS_AND_LENGTHS = [("alpha", 3), ("beta", 4), ("both", 3)]
PRECISE = [pytest.param(*case, 30, marks=[pytest.mark.long] * (case[0] != "alpha")) for case in LAWS_AND_LENGTHS]


@pytest.mark.parametrize(("law", "N", "digits"), [*((*case, None) for case in LAWS_AND_LENGTHS), *PRECISE])
def test_the_energy_is_within_its_radius_at_all_angles(law, N, digits):
    """And the radius is that of a conserved quantity: as small as what the torus leaves of the equations."""
    exact = torus(N, **LAWS[law]) if digits is None else refine(torus(N, **LAWS[law]), digits=digits)
    with mpmath.workdps(60):
        found = prove_residual(exact)
        for a, b in [(0, 0), ("0.3", "1.1"), ("1.7", "0.45"), ("0.9", "0.2")]:
            assert abs(energy_at(exact, mpmath.mpf(a), mpmath.mpf(b)) - found.energy) <= found.energy_radius
        assert found.energy_radius < ENERGY_OF_TORUS * found.bound


def test_a_moved_coefficient_shows_in_the_radius_of_the_energy():
    exact, off = torus(), one_off(torus(), 1e-6)
    with mpmath.workdps(30):
        found = prove_residual(off)
        values = [energy_at(off, mpmath.mpf(k) / 8, mpmath.mpf(3 * k) / 8) for k in range(16)]
        assert max(values) - min(values) <= 2 * found.energy_radius
        assert max(values) - min(values) > 1e6 * prove_residual(exact).energy_radius


def test_nothing_is_said_of_an_energy_with_a_harmonic_that_does_not_turn():
    resonant = replace(torus().in_doubles(), frequencies=(Fraction(1), Fraction(7, 4)))
    found = prove_residual(resonant)
    assert found.energy is None
    assert found.energy_radius is None
    assert "nothing is proved" in found.text()


def test_digits_of_the_torus_are_those_of_the_bound():
    for digits in (20, 40):
        found = prove_residual(refine(torus(), digits=digits))
        assert found.bound < mpmath.mpf(10) ** -digits
        assert found.digits == digits


def test_products_are_exact_and_errors_are_of_what_was_rounded():
    rng = np.random.default_rng(3)
    one, other = (np.array([[int(x) for x in row] for row in rng.integers(-99, 99, (5, 3))], dtype=object) for _ in range(2))
    full = product(one, other)
    for at in np.ndindex(full.shape):
        pairs = [(i, tuple(np.subtract(at, i))) for i in np.ndindex(one.shape)]
        terms = [one[i] * other[j] for i, j in pairs if all(0 <= k < n for k, n in zip(j, other.shape, strict=True))]
        assert full[at] == sum(terms)
    a, b = Series(one, 10), Series(other, 10)
    off = np.abs(np.array(full / 2**20 - padded(((a * b).values / 2**10), full.shape), dtype=float)).sum()
    assert off <= (a * b).error / 2**10


def padded(values, shape):
    room = np.zeros(shape)
    room[tuple(slice((m - n) // 2, (m + n) // 2) for m, n in zip(shape, values.shape, strict=True))] = values
    return room


def test_powers_of_any_degree_are_within_their_error():
    r = Series(np.array([3, 100, 3], dtype=object), 10)
    found = polynomial_of(r, {2: Fraction(1, 3), 5: Fraction(-2, 7)})
    x = (100 + 6) / mpmath.mpf(2**10)
    exact = x**2 / 3 - 2 * x**5 / 7
    assert abs(sum(int(x) for x in found.values) / mpmath.mpf(2**10) - exact) <= mpmath.mpf(found.error) / 2**10


def test_what_it_is_not_about_is_refused_by_name():
    with pytest.raises(InputError, match="prove_existence"):
        prove_residual(symfpu.torus(Chain(4, alpha="0.3"), (1,), amplitudes={1: "0.1"}))
    guess = symfpu.torus(Chain(3, potential="toda:1/2"), tuple(AMPLITUDES), amplitudes=AMPLITUDES, method="series", order=4)
    with pytest.raises(InputError, match="poly"):
        prove_residual(guess)
    with pytest.raises(InputError):
        prove_residual("torus")
    right = torus().in_doubles()
    wrong = replace(right, cosines=right.cosines[:, ::-1])
    with pytest.raises(InputError, match="reflection"):
        prove_residual(wrong)
