"""Conditions on a torus: zero where they are met, and gradients that are derivatives."""

from fractions import Fraction

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.refinement.conditions import (
    Amplitude,
    AmplitudeRatio,
    Crossing,
    Energy,
    EnergyRatio,
    FrequencyShift,
    Plane,
    plane_variables,
    ratio_conditions,
)
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.tori.quasiperiodic import FourierTorus
from tests.refinement.test_invariance import ball
from tests.tolerances import ROUNDING

# Central differences with steps h and 2h, the error of second order removed: what is left is 4 h^4 f^(5)/5! = 24 (h/A)^4 = 3e-13
# relative for A/A_0^2 with amplitudes of 0.3, and the rounding of long doubles over h, 1e-15.
STEP, RICHARDSON = np.longdouble(1e-4), 1e-11

CHAIN = Chain(7, alpha="0.3", beta="0.5")
SEEDS = (2, 6, 3)


class State:
    """An equation of three seeds with random coefficients and shifts, and the torus they make."""

    def __init__(self):
        self.equation = InvarianceEquation(CHAIN, SEEDS, ball(3, 2))
        draw = np.random.default_rng(8)
        c = np.where(self.equation.mask, draw.normal(scale=0.03, size=self.equation.mask.shape), 0)
        c[self.equation.seed_rows, self.equation.seed_columns] = 0.3, -0.4, 0.5
        self.cosines, self.shifts = c.astype(np.longdouble), np.array([0.01, -0.02, 0.03], dtype=np.longdouble)
        omega = self.equation.linear[self.equation.seed_columns] + self.shifts
        frequencies = tuple(Fraction(float(w)) for w in omega)
        self.torus = FourierTorus(CHAIN, SEEDS, frequencies, self.equation.harmonics, c, dict.fromkeys(SEEDS, 0.0))

    def value(self, condition, cosines=None, shifts=None):
        return condition.value(self.equation, self.cosines if cosines is None else cosines, self.shifts if shifts is None else shifts)


@pytest.fixture(scope="module")
def state():
    return State()


def met(state):
    """Conditions that the state meets, by quantities of the torus that the package computes elsewhere."""
    torus, A = state.torus, state.cosines[state.equation.seed_rows, state.equation.seed_columns]
    spectrum = torus.average_spectrum()
    rate, linear = float(sum(n * w for n, w in zip((1, -2, 3), torus.frequencies, strict=True))), CHAIN.frequencies()[np.array(SEEDS) - 1]
    scales, tangent = (0.5, 2.0, 1.5), (0.3, -0.5, 0.2, 0.7, -0.4, 0.1)
    return {
        "frequency": FrequencyShift(1, state.shifts[1]),
        "crossing": Crossing((1, -2, 3), np.longdouble(rate - linear @ (1, -2, 3)), 0.7),
        "amplitude": Amplitude(2, A[2]),
        "amplitude ratio": AmplitudeRatio(1, float(A[1] / A[0])),
        "energy ratio": EnergyRatio(2, float(spectrum[2] / spectrum[1])),
        "energy": Energy(np.longdouble(torus.energy()), harmonic=False),
        "harmonic energy": Energy(np.longdouble(torus.harmonic_energies().sum()), harmonic=True),
        "plane": Plane(tuple(plane_variables(state.equation, state.cosines, state.shifts, scales)), tangent, scales, 0.0),
    }


KINDS = ("frequency", "crossing", "amplitude", "amplitude ratio", "energy ratio", "energy", "harmonic energy", "plane")


@pytest.mark.parametrize("kind", KINDS)
def test_a_condition_is_zero_where_it_is_met(state, kind):
    assert abs(state.value(met(state)[kind])) <= ROUNDING


def test_what_a_condition_is_where_it_is_not_met(state):
    """Relative to its own size, so that one number says how far each is from being met."""
    given = met(state)
    Omega = state.equation.linear[state.equation.seed_columns[1]]
    assert state.value(FrequencyShift(1, state.shifts[1] - Omega / 4)) == pytest.approx(0.25, rel=ROUNDING)
    assert state.value(Amplitude(2, given["amplitude"].amplitude / 3)) == pytest.approx(2, rel=ROUNDING)
    assert state.value(AmplitudeRatio(1, 2 * given["amplitude ratio"].ratio)) == pytest.approx(-0.5, rel=ROUNDING)
    assert state.value(EnergyRatio(2, given["energy ratio"].ratio / 2)) == pytest.approx(1, rel=ROUNDING)
    assert state.value(Energy(given["energy"].energy / 2, harmonic=False)) == pytest.approx(1, rel=ROUNDING)
    assert abs(given["energy"].energy / given["harmonic energy"].energy - 1) > 0.01
    plane = given["plane"]
    assert state.value(Plane(plane.start, plane.tangent, plane.scales, 0.2)) == pytest.approx(-0.2, rel=ROUNDING)
    grown = np.where(state.equation.mask, state.cosines * 2, 0)
    assert state.value(plane, cosines=grown) == pytest.approx(sum(plane.tangent[:3]) * np.log(2), abs=ROUNDING)
    moved = state.shifts + np.array([0.5, 0, 0])
    assert state.value(plane, shifts=moved) == pytest.approx(plane.tangent[3], abs=ROUNDING)


def derivative(function):
    """Of a function of one number at zero."""
    one, two = ((function(k * STEP) - function(-k * STEP)) / (2 * k * STEP) for k in (1, 2))
    return float(4 * one - two) / 3


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


@pytest.mark.parametrize("kind", KINDS)
def test_gradients_are_zero_where_there_is_no_unknown(state, kind):
    by_cosine = met(state)[kind].gradient(state.equation, state.cosines, state.shifts)[0]
    assert not by_cosine[~state.equation.mask].any()


def test_ratios_are_to_the_first_seed():
    ratio = {3: 1, 2: 4, 6: "2"}
    assert ratio_conditions(SEEDS, ratio, energies=False) == [AmplitudeRatio(1, 0.5), AmplitudeRatio(2, 0.25)]
    assert ratio_conditions(SEEDS, ratio, energies=True) == [EnergyRatio(1, 0.5), EnergyRatio(2, 0.25)]
    assert ratio_conditions((5,), {5: 2}, energies=True) == []
