"""The equation of travelling waves: its derivatives, its blocks, and what it makes of the particles of a ring."""

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from symfpu import Torus
from symfpu.refinement.conditions import EnergyLevel, Ratio, amplitude, frequency
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Lattice, places_of
from tests.refinement.test_conditions import RICHARDSON, STEP, derivative
from tests.refinement.test_invariance import ball
from tests.tolerances import FOURTEEN_DIGITS, ROUNDING
from tests.tori.test_ring_torus import ring

LAWS = {"both": {"alpha": "0.3", "beta": "0.5"}, "even": {"beta": 1}, "toda": {"potential": "toda:1/2"}}
SEEDS = (2, -3)


@cache
def made(law, reach=3):
    """An equation with shifts and random coefficients of all harmonics up to sum |nu| = reach."""
    equation = InvarianceEquation(ring(7, **LAWS[law]), SEEDS, ball(2, 3))
    draw = np.random.default_rng(4)
    there = equation.mask & (np.abs(equation.harmonics).sum(axis=1) <= reach)[:, None]
    c = np.where(there, draw.normal(scale=0.03, size=there.shape), 0)
    c[equation.seed_rows, equation.seed_columns] = 0.3, -0.4
    return equation, c.astype(np.longdouble), np.array([0.01, -0.02], dtype=np.longdouble)


def plain_waves(N, seeds, radius):
    """An equation of alpha on a ball, and coefficients 0.1 of the shortest harmonics."""
    equation = InvarianceEquation(ring(N, alpha="0.3"), seeds, ball(2, radius))
    low = equation.mask & (np.abs(equation.harmonics).sum(axis=1) <= 1)[:, None]
    return equation, np.where(low, 0.1, 0.0)


def torus(law):
    """The particles of these coefficients."""
    equation, c, shifts = made(law, 1)
    moving = equation.mask[:, 0]
    omega = tuple(map(Fraction, map(float, equation.seed_frequencies + shifts)))
    return Torus(equation.chain, SEEDS, omega, equation.harmonics[moving], c[moving].astype(float), travels=True)


@pytest.mark.parametrize("law", ["both", "even"])
def test_force_and_energies_are_those_of_the_particles(law):
    """By the chain: the mean over all angles of the energies, and of the forces times the waves.

    Of waves of the seeds alone, whose cubes do not fold on the lattice.
    """
    equation, c, shifts = made(law, 1)
    plain, number = torus(law), 12
    waves = plain.harmonics @ np.array(SEEDS)
    forces, H, harmonic = np.zeros(len(plain.cosines)), 0.0, 0.0
    for theta in plain.angle_grid(number):
        turned = [replace(plain, phases=dict(zip(SEEDS, angles, strict=True))) for angles in theta]
        Q, P = (np.array(values) for values in zip(*(torus.state() for torus in turned), strict=True))
        x = plain.chain.positions(Q)
        pull = plain.chain.positions(plain.chain.accelerations(Q))
        r = np.roll(x, -1, axis=1) - x
        linear = r - np.roll(r, 1, axis=1)
        j = np.arange(7)
        phases = 2 * np.pi / 7 * np.multiply.outer(waves, j) - (theta @ plain.harmonics.T)[:, :, None]
        forces += ((pull - linear)[:, None, :] * np.sin(phases)).sum(axis=(0, 2))
        H += plain.chain.energy(Q, P).sum()
        harmonic += plain.chain.harmonic_energies(Q, P).sum()
    points = number**2
    expected = -2 * forces / (points * 7**0.5) * np.sign(np.sin(np.pi * waves / 7))
    found = equation.force(c)[equation.mask].astype(float)
    assert np.abs(found - expected).max() < FOURTEEN_DIGITS
    for kind, total in ((False, H), (True, harmonic)):
        assert np.isclose(float(equation.energy(c, shifts, harmonic=kind)[0]), total / points, rtol=FOURTEEN_DIGITS)


@pytest.mark.parametrize("law", LAWS)
def test_blocks_and_sparse_parts_are_the_derivative(law):
    equation, c, _ = made(law)
    slopes = equation.slopes(c)
    rows, columns = np.nonzero(equation.mask)
    block = equation.block(slopes, rows, columns)
    draw = np.random.default_rng(5)
    change = np.where(equation.mask, draw.normal(size=equation.mask.shape), 0)
    along = equation.force_change(slopes, change)[equation.mask]
    assert np.allclose(block @ change[equation.mask], along, rtol=ROUNDING, atol=FOURTEEN_DIGITS)
    sparse = equation.sparse_rows(slopes, rows, columns).toarray()
    held = sparse != 0
    assert held.any()
    pairs = abs(rows[:, None] - rows) > 0
    heights = equation.grid.spectrum(slopes)[0]
    mean = heights[0]
    diagonal = np.isclose(sparse.diagonal(), mean * equation.linear[equation.mask].astype(float) ** 2, rtol=FOURTEEN_DIGITS)
    assert diagonal.any() or not held[~pairs].any()
    difference = (equation.force(c + STEP * change) - equation.force(c - STEP * change))[equation.mask]
    assert np.allclose((difference / (2 * STEP)).astype(float), along, rtol=0, atol=STEP.astype(float))


def test_what_an_even_potential_forbids_has_no_force():
    """On any lattice: there products of long harmonics fold onto those of even length."""
    equation, c, _ = made("even")
    grid = Lattice(ball(2, 4))
    there = np.zeros((len(grid.harmonics), 1))
    there[places_of(equation.harmonics, grid.harmonics)] = c
    force, odd = equation.force(there, grid=grid), grid.harmonics.sum(axis=1) % 2 == 1
    assert not force[~odd].any()
    assert force[odd].any()


def conditions(law):
    equation, c, shifts = made(law)
    H, _ = equation.energy(c, shifts, harmonic=False)
    return {
        "frequency": frequency(1, shifts[1] + 1, equation.seed_frequencies),
        "amplitude": amplitude(1, np.longdouble(0.2), 2),
        "amplitude ratio": Ratio(1, 0.7, energies=False),
        "energy": EnergyLevel(H, harmonic=False),
        "harmonic energy": EnergyLevel(H, harmonic=True),
        "energy ratio": Ratio(1, 1.7, energies=True),
    }


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("kind", ["frequency", "amplitude", "amplitude ratio", "energy", "harmonic energy", "energy ratio"])
def test_gradients_are_derivatives(law, kind):
    equation, c, shifts = made(law)
    condition = conditions(law)[kind]
    by_cosine, by_shift = condition.gradient(equation, c, shifts)
    draw = np.random.default_rng(6)
    dc, dw = np.where(equation.mask, draw.normal(size=c.shape), 0), draw.normal(size=2)
    expected = derivative(lambda h: condition.value(equation, c + h * dc, shifts + h * dw))
    given = (by_cosine * dc).sum() + by_shift @ dw
    assert abs(given - expected) < RICHARDSON * max(1, abs(given)) * 100
