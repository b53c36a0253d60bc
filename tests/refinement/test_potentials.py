"""Tori of chains of any potential: series against Newton's method, frequencies by order, energies, certificates, families."""

import itertools
import math

import numpy as np
import pytest

import symfpu
from symfpu import Chain, assess, refine, resum
from symfpu.refinement.invariance import InvarianceEquation
from tests.tolerances import FIXED_ENERGY, PROMISED_RESIDUAL, SLOPE

# laws with an amplitude at which series converge
LAWS = {"toda:1/2": 0.2, "lj:12,6": 0.01, "poly:1/3,0,1/5,-1/4": 0.2, "poly:0,1/2,0,1/3": 0.4}
EVERY_LAW = pytest.mark.parametrize("law", LAWS)


@EVERY_LAW
@pytest.mark.parametrize(("N", "seeds"), [(2, (1,)), (8, (1, 2)), (9, (2, 5))])
def test_refined_tori_solve_the_closed_equations_of_motion(law, N, seeds):
    chain = Chain(N, potential=law)
    guess = symfpu.torus(
        chain, tuple({q: LAWS[law] / q for q in seeds}), amplitudes={q: LAWS[law] / q for q in seeds}, method="series", order=4
    )
    torus = refine(guess)
    assert torus.residual() < PROMISED_RESIDUAL
    assert guess.residual() > 1e3 * torus.residual()
    assert not torus.warnings


@pytest.mark.long
@EVERY_LAW
def test_frequencies_of_series_err_by_the_next_order(law):
    """As A^(K+2), or A^(2K+2) where V is even: omega goes by squares of the amplitudes."""
    chain = Chain(8, potential=law)
    errors = {}
    for K, part in itertools.product((2, 4), (1, 0.5)):
        amplitudes = {1: part * LAWS[law], 2: part * LAWS[law] / 2}
        series = symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=K)
        exact = symfpu.refine(series, amplitudes=amplitudes)
        off = [float(a - b) for a, b in zip(series.frequencies, exact.frequencies, strict=True)]
        errors[K, part] = max(map(abs, off))
    for K in (2, 4):
        rate = math.log2(errors[K, 1] / errors[K, 0.5])
        due = 2 * K + 2 if chain.potential.even else K + 2
        # the even one falls by 2^10 at K = 4, to some rounding of omega - Omega
        assert rate == pytest.approx(due, abs=5 * SLOPE), K


@EVERY_LAW
def test_a_torus_has_the_energy_asked_for_and_its_verdict(law):
    chain = Chain(8, potential=law)
    energy = "1e-6" if law == "lj:12,6" else "3e-4"
    torus = symfpu.torus(chain, (1, 2), energy=energy, method="series", order=6)
    assert float(torus.energy()) == pytest.approx(float(energy), rel=FIXED_ENERGY)
    assert assess(torus.origin.series, torus).word == "converged"
    assert resum(torus).residual() < 10 * torus.residual()
    refined = refine(torus, energy=energy)
    assert float(refined.energy()) == pytest.approx(float(energy), rel=FIXED_ENERGY)


@pytest.mark.parametrize(("law", "odd_alone"), [("poly:0,1/2,0,1/3", True), ("poly:0,0,1/5", False), ("toda:1", False)])
def test_even_potentials_leave_harmonics_of_even_length_out(law, odd_alone):
    harmonics = np.array([[1, 0], [0, 1], [1, 1], [2, 0], [2, 1]])
    mask = InvarianceEquation(Chain(6, potential=law), (1, 2), harmonics).mask
    assert mask.any(axis=1).tolist() == [True, True, not odd_alone, not odd_alone, True]
