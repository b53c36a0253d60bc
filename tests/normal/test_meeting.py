"""Events of normal frequencies as conditions of Newton's method: derivatives, starts, and digits as the judge."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, Newton, ParametricResonance, normal_modes, refine
from symfpu.action_angle.newton_twist import equation_of
from symfpu.normal.meeting import Crossed, Lost, Meeting
from symfpu.normal.resonances import PARAMETRIC, SUM
from symfpu.refinement.conditions import amplitude
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.tori import refined_torus
from tests.normal import cases
from tests.tolerances import CENTRAL_GRADIENT, EVENT, EVENT_BY_DIGITS

CHAIN = Chain(8, beta=1)
ONSET = ParametricResonance(SUM, (4, 6), (0, 2), 0.0)
TONGUE = ParametricResonance(PARAMETRIC, (4,), (3, 1), 0.0)
EDGES = (0.2042138648937890, 0.2042339109821567)  # where A_1 = 0.1: two events of one narrow tongue


def torus(A):
    return cases.torus(CHAIN, ((1, "0.1"), (5, A)))


def met(condition, guess):
    return refined_torus(guess, [condition, amplitude(0, np.longdouble("0.1"), 2)]).amplitudes[5]


def differences(condition, equation, cosines, shifts):
    """Central ones along a direction of the coefficients, and one of the shifts, beside the gradient."""
    by_cosine, by_shift = condition.gradient(equation, cosines, shifts)
    draw = np.random.default_rng(0)
    along = np.where(equation.mask, draw.normal(size=cosines.shape) * np.abs(cosines), 0)
    turned = draw.normal(size=len(shifts)) * 1e-3
    h = 1e-4
    first = condition.value(equation, cosines + h * along, shifts) - condition.value(equation, cosines - h * along, shifts)
    second = condition.value(equation, cosines + 0, shifts + h * turned) - condition.value(equation, cosines + 0, shifts - h * turned)
    return (float(first / (2 * h)), float((by_cosine * along).sum())), (float(second / (2 * h)), float(by_shift @ turned))


@pytest.mark.parametrize("kind", [Meeting, Crossed])
def test_the_gradient_is_that_of_differences(kind):
    solution = torus("0.41")
    equation, cosines = equation_of(solution)
    condition = kind(normal_modes(solution, modes=[4, 6]), ONSET)
    for difference, slope in differences(condition, equation, cosines.astype(np.longdouble), shifts_of(solution)):
        assert slope == pytest.approx(difference, rel=CENTRAL_GRADIENT)


@pytest.mark.parametrize("potential", ["toda:1/2", "poly:1/3,1/4"])
def test_the_gradient_on_a_ring_is_that_of_differences(potential):
    solution = symfpu.torus(Chain(8, potential=potential, ends="periodic"), (2,), amplitudes={2: "0.4"})
    assert isinstance(solution.origin, Newton)
    condition = Crossed(normal_modes(solution, modes=[1, 3]), ParametricResonance(SUM, (1, 3), (2,), 0.0))
    rows = dict(zip(map(tuple, solution.harmonics.tolist()), solution.cosines[:, 0], strict=True))
    equation = InvarianceEquation(solution.chain, solution.seeds, np.array([[0], *solution.harmonics.tolist()]))
    cosines = np.array([[rows.get(tuple(nu), 0.0)] for nu in equation.harmonics.tolist()])
    for difference, slope in differences(condition, equation, cosines.astype(np.longdouble), shifts_of(solution)):
        assert slope == pytest.approx(difference, rel=CENTRAL_GRADIENT)


@pytest.mark.long
def test_an_onset_is_one_from_everywhere():
    found = [met(Meeting(normal_modes(torus(A), modes=[4, 6]), ONSET), torus(A)) for A in ("0.41", "0.4262438", "0.44")]
    assert max(found) - min(found) < EVENT
    assert found[0] == pytest.approx(0.4262438554576, abs=EVENT_BY_DIGITS)


def test_a_place_without_the_directions_is_lost():
    """The eigenfunctions of another torus far away, at frequencies that are no solutions here."""
    equation, cosines = equation_of(torus("0.41"))
    condition = Crossed(
        normal_modes(symfpu.torus(CHAIN, (5,), amplitudes={5: "0.9"}), modes=[4, 6]), ParametricResonance(SUM, (4, 6), (2,), 0.0)
    )
    with pytest.raises((Lost, ValueError)):
        condition.value(equation, cosines.astype(np.longdouble), shifts_of(torus("0.41")))


def discriminant_in_digits(resonance, A):
    solution = refine(torus("0.41"), amplitudes={1: "0.1", 5: A}, digits=30)
    modes = normal_modes(solution, modes=sorted(set(resonance.modes)))
    with mpmath.workdps(40):
        growth = max(mode.growth for mode in modes.modes)
        if growth:
            return -4 * mpmath.mpf(growth) ** 2
        omega = [mpmath.mpf(w.numerator) / w.denominator for w in solution.frequencies]
        sides = [modes.frequencies[resonance.modes[0]], modes.frequencies[resonance.modes[-1]]]
        return (mpmath.fsum(sides) - mpmath.fdot(resonance.harmonic, omega)) ** 2


@pytest.mark.long
@pytest.mark.parametrize(("resonance", "A", "apart"), [(ONSET, "0.4262", 9), (TONGUE, "0.20421", 12), (TONGUE, "0.20424", 12)], ids=str)
def test_digits_have_the_event_where_newton_has(resonance, A, apart):
    """The zero of the discriminant by two tori of 30 digits, one on either side of the event."""
    near = normal_modes(torus(A), modes=sorted(set(resonance.modes)))
    found = met(Meeting(near, resonance), torus(A))
    h = Fraction(1, 10**apart)
    below, above = (discriminant_in_digits(resonance, Fraction(found) + side * h) for side in (-1, 1))
    assert below * above < 0
    off = float(h) * float((below + above) / (below - above))
    assert abs(off) < EVENT_BY_DIGITS
