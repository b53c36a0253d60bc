"""Forces in doubles and in long doubles: the numbers of figures in both, and small tori of alpha, which need the long ones."""

from functools import lru_cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, lindstedt, refine, solve_amplitudes
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS
from symfpu.refinement import newton
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.newton import force_precision
from tests.refinement.test_invariance import CASES, equation_and_coefficients
from tests.refinement.test_waves import LAWS, made
from tests.tolerances import FORCES_IN_DOUBLES, LAST_DIGIT, LOST_IN_DOUBLES, PROMISED_RESIDUAL

FIGURES = {row.label: row for row in (TWO_TORUS, *APPENDIX_F)}
SMALL = "1e-4"  # amplitude of a torus whose shifts are 1e-9


@lru_cache
def guess(label):
    printed = FIGURES[label]
    return solve_amplitudes(lindstedt(printed.chain, printed.seeds, printed.frequencies, 6))


def in_kind(kind, torus, monkeypatch):
    """The refined torus with all forces in numbers of one kind."""
    monkeypatch.setattr(newton, "force_precision", lambda *_: kind)
    return refine(torus)


def kind_of(torus):
    equation = InvarianceEquation(torus.chain, torus.seeds, torus.harmonics)
    return force_precision(equation, torus.cosines.astype(np.longdouble), shifts_of(torus))


def deviations(torus, other):
    return [abs(float(torus.amplitudes[q] / other.amplitudes[q]) - 1) for q in torus.seeds]


@pytest.mark.parametrize("label", ["Fig. 1", *(pytest.param(f"Fig. {n}", marks=pytest.mark.long) for n in ("5a", "5c", "2"))])
def test_the_numbers_of_figures_are_those_of_long_doubles(label, monkeypatch):
    long = in_kind(np.longdouble, guess(label), monkeypatch)
    short = in_kind(np.float64, guess(label), monkeypatch)
    monkeypatch.undo()
    assert kind_of(short) is np.float64
    assert max(deviations(short, long)) < FORCES_IN_DOUBLES
    assert np.abs(short.cosines - long.cosines).max() < FORCES_IN_DOUBLES * np.abs(long.cosines).max()
    assert float(short.energy()) == pytest.approx(float(long.energy()), rel=FORCES_IN_DOUBLES)
    assert short.residual() < PROMISED_RESIDUAL


@lru_cache
def small_guess():
    return symfpu.torus(Chain(8, alpha="0.3"), (1, 2), amplitudes={1: SMALL, 2: SMALL}, method="series", order=4)


def test_small_tori_of_alpha_keep_their_digits(monkeypatch):
    """Against 30 digits: in doubles the amplitudes lose three to four, and as `refine` chooses none."""
    exact = refine(small_guess(), digits=30)
    chosen = refine(small_guess())
    assert kind_of(chosen) is np.longdouble
    assert max(deviations(chosen, exact)) < FORCES_IN_DOUBLES
    short = in_kind(np.float64, small_guess(), monkeypatch)
    assert max(deviations(short, exact)) > LOST_IN_DOUBLES


def test_a_torus_without_shifts_has_its_force_in_long_doubles():
    """The divisors of its seeds are zero."""
    torus = small_guess()
    equation = InvarianceEquation(torus.chain, torus.seeds, torus.harmonics)
    assert force_precision(equation, torus.cosines, np.zeros(2, dtype=np.longdouble)) is np.longdouble


def rounded(equation, c):
    """What a force in doubles is off by, and what it is expected to be off by; of all unknowns."""
    exact, short = equation.force(c.astype(np.longdouble)), equation.force(c.astype(float))
    off = np.abs(exact - short).astype(float)
    expected = np.broadcast_to(equation.rounding(c, np.float64), off.shape)
    return off[equation.mask], expected[equation.mask]


ROUNDED = [pytest.param(lambda case=case: equation_and_coefficients(*case, low=3, radius=3), id=repr(case)) for case in CASES]
ROUNDED += [pytest.param(lambda law=law: made(law)[:2], id=f"ring, {law}") for law in LAWS]


@pytest.mark.parametrize("case", ROUNDED)
def test_rounding_is_what_doubles_lose(case):
    """Within a factor of 30 the largest error; sums of a few numbers round less than at random."""
    equation, c = case()
    off, expected = rounded(equation, c.astype(float))
    assert expected.max() / 30 < off.max() < 30 * expected.max()
    long = equation.rounding(c, np.longdouble)
    ratio = float(np.finfo(np.longdouble).eps) / np.finfo(np.float64).eps
    assert long == pytest.approx(ratio * equation.rounding(c, np.float64), rel=LAST_DIGIT)
