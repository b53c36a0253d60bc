"""Conditions on a torus: zero where they are met, and gradients that are derivatives."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import symfpu
from symfpu import Chain, Torus, refine
from symfpu.refinement.conditions import (
    EnergyLevel,
    Ratio,
    Start,
    amplitude,
    amplitude_line,
    frequency,
    plane,
    ratio_conditions,
    resonance,
)
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.invariance import InvarianceEquation
from tests.refinement.test_invariance import ball
from tests.tolerances import FIXED_ENERGY, ROUNDING

# Central differences with steps h and 2h, the error of second order removed: what is left is 4 h^4 f^(5)/5! = 24 (h/A)^4 = 3e-13
# relative for A/A_0^2 with amplitudes of 0.3, and the rounding of long doubles over h, 1e-15.
STEP, RICHARDSON = np.longdouble(1e-4), 1e-11

CHAIN = Chain(7, alpha="0.3", beta="0.5")
SEEDS = (2, 6, 3)
PHASES = (0.4, 1.0, 2.0)


class State:
    """An equation of three seeds with random coefficients and shifts, and the torus they make."""

    def __init__(self):
        self.equation = InvarianceEquation(CHAIN, SEEDS, ball(3, 2))
        draw = np.random.default_rng(8)
        c = np.where(self.equation.mask, draw.normal(scale=0.03, size=self.equation.mask.shape), 0)
        c[self.equation.seed_rows, self.equation.seed_columns] = 0.3, -0.4, 0.5
        self.cosines, self.shifts = c.astype(np.longdouble), np.array([0.01, -0.02, 0.03], dtype=np.longdouble)
        omega = self.equation.seed_frequencies + self.shifts
        frequencies = tuple(Fraction(float(w)) for w in omega)
        self.torus = Torus(CHAIN, SEEDS, frequencies, self.equation.harmonics, c, dict.fromkeys(SEEDS, 0.0))

    def value(self, condition, cosines=None, shifts=None):
        return condition.value(self.equation, self.cosines if cosines is None else cosines, self.shifts if shifts is None else shifts)


@pytest.fixture(scope="module")
def state():
    return State()


def met(state):
    """Conditions that the state meets, by quantities of the torus that the package computes elsewhere."""
    torus, A = state.torus, state.cosines[state.equation.seed_rows, state.equation.seed_columns]
    spectrum, turned = torus.average_spectrum(), replace(torus, phases=dict(zip(SEEDS, PHASES, strict=True)))
    rate, linear = float(sum(n * w for n, w in zip((1, -2, 3), torus.frequencies, strict=True))), CHAIN.frequencies()[np.array(SEEDS) - 1]
    scales, tangent = np.array([0.5, 2.0, 1.5]), np.array([0.3, -0.5, 0.2, 0.7, -0.4, 0.1])
    steps = np.array([0.25, 1.0, -0.5])
    return {
        "frequency": frequency(1, state.shifts[1], linear),
        "resonance": resonance((1, -2, 3), np.longdouble(rate - linear @ (1, -2, 3)), 0.7),
        "amplitude": amplitude(2, A[2], 3),
        "amplitude ratio": Ratio(1, float(A[1] / A[0]), energies=False),
        "amplitude line": amplitude_line((1, 2), A - 0.3 * steps, steps),
        "energy ratio": Ratio(2, float(spectrum[2] / spectrum[1]), energies=True),
        "energy": EnergyLevel(np.longdouble(torus.energy()), harmonic=False),
        "harmonic energy": EnergyLevel(np.longdouble(torus.harmonic_energies().sum()), harmonic=True),
        "start": Start(1, np.longdouble(turned.Q(0.0)[SEEDS[1] - 1]), PHASES, 0.7),
        "plane": plane(np.append(np.log(np.abs(A)), state.shifts / scales), tangent, scales, 0.0),
    }


KINDS = (
    "frequency",
    "resonance",
    "amplitude",
    "amplitude ratio",
    "amplitude line",
    "energy ratio",
    "energy",
    "harmonic energy",
    "start",
    "plane",
)


@pytest.mark.parametrize("kind", KINDS)
def test_a_condition_is_zero_where_it_is_met(state, kind):
    assert abs(state.value(met(state)[kind])) <= ROUNDING


def derivative(function):
    """Of a function of one number at zero."""
    one, two = ((function(k * STEP) - function(-k * STEP)) / (2 * k * STEP) for k in (1, 2))
    return float(4 * one - two) / 3


def test_energies_at_the_start_and_in_the_mean():
    """On a torus H is the same at all angles; the harmonic energy is not, and each of its two names is what it says."""
    torus = refine(symfpu.torus(Chain(6, alpha="0.3"), (1, 2), amplitudes={1: "0.3", 2: "0.2"}, method="series", order=4))
    equation = InvarianceEquation(torus.chain, torus.seeds, torus.harmonics)
    c, shifts = torus.cosines.astype(np.longdouble), shifts_of(torus)
    start, mean = equation.energy_at_start(c)[0], equation.mean_energy(c, shifts)[0]
    assert float(mean) == pytest.approx(float(start), rel=FIXED_ENERGY)
    start, mean = equation.harmonic_energy_at_start(c)[0], equation.mean_harmonic_energy(c, shifts)[0]
    assert float(start) == pytest.approx(torus.harmonic_energies().sum(), rel=ROUNDING)
    assert float(mean) == pytest.approx(torus.average_spectrum().sum(), rel=ROUNDING)
    assert abs(start / mean - 1) > 1e-3
    assert equation.energy(c, shifts, harmonic=True)[0] == start


@pytest.mark.parametrize("name", ["mean_energy", "mean_harmonic_energy"])
def test_mean_energies_have_their_derivatives(state, name):
    energy, draws = getattr(state.equation, name), np.random.default_rng(6)
    dc = np.where(state.equation.mask, draws.normal(size=state.cosines.shape), 0)
    dw = draws.normal(size=len(SEEDS))
    _, (by_cosine, by_shift) = energy(state.cosines, state.shifts)
    expected = derivative(lambda h: energy(state.cosines + h * dc, state.shifts + h * dw)[0])
    assert abs(float((by_cosine * dc).sum() + by_shift @ dw) - expected) < RICHARDSON * 100


@pytest.mark.parametrize("kind", KINDS)
def test_gradients_are_derivatives(state, kind):
    condition = met(state)[kind]
    by_cosine, by_shift = condition.gradient(state.equation, state.cosines, state.shifts)
    assert by_cosine.dtype == by_shift.dtype == np.float64
    scale = max(np.abs(by_cosine).max(), np.abs(by_shift).max())
    for row, column in zip(*np.nonzero(state.equation.mask), strict=True):
        unit = np.zeros(state.cosines.shape)
        unit[row, column] = 1
        slope = derivative(lambda h, unit=unit: state.value(condition, cosines=state.cosines + h * unit))
        assert by_cosine[row, column] == pytest.approx(slope, abs=RICHARDSON * scale)
    for i, unit in enumerate(np.eye(3)):
        slope = derivative(lambda h, unit=unit: state.value(condition, shifts=state.shifts + h * unit))
        assert by_shift[i] == pytest.approx(slope, abs=RICHARDSON * scale)
    # where there is no unknown; that of a start is read at unknowns alone
    assert kind == "start" or not by_cosine[~state.equation.mask].any()


def test_ratios_are_to_the_first_seed():
    ratio = {3: 1, 2: 4, 6: "2"}
    assert ratio_conditions(SEEDS, ratio, energies=False) == [Ratio(1, 0.5, energies=False), Ratio(2, 0.25, energies=False)]
    assert ratio_conditions(SEEDS, ratio, energies=True) == [Ratio(1, 0.5, energies=True), Ratio(2, 0.25, energies=True)]
    assert ratio_conditions((5,), {5: 2}, energies=True) == []
