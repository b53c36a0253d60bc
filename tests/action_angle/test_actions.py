"""Actions against the spectral curve of Toda's chain, the integral of P dQ, and themselves in other coordinates."""

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, actions, refine, toda_torus, unfold
from tests.tolerances import NEWTON_TWIST, QUADRATURE, ROUNDING

SEEDS = (1, 3)


def refined_toda():
    """The torus of Toda's chain with these frequencies, by Newton's method."""
    chain = Chain(4, potential="toda:1/2")
    guess = symfpu.torus(chain, (1, 3), amplitudes={1: "0.1", 3: "0.1"}, method="series", order=2)
    return refine(guess)


def test_toda_by_its_spectral_curve():
    torus = refined_toda()
    exact = toda_torus(torus.chain, SEEDS, frequencies=torus.frequencies, digits=20).actions
    found = actions(torus)
    assert [found[q] for q in SEEDS] == pytest.approx([float(exact[q]) for q in SEEDS], rel=NEWTON_TWIST)


def test_the_integral_along_an_angle():
    """Of P dQ, where the other angle stands still; the momenta are those of the full motion."""
    torus = refine(symfpu.torus(Chain(4, alpha="0.3", beta="0.2"), (1, 2), amplitudes={1: "0.3", 2: "0.2"}, method="series", order=4))
    omega = np.array([float(w) for w in torus.frequencies])
    around = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    for place, q in enumerate(torus.seeds):
        theta = np.full((64, 2), 0.7)
        theta[:, place] = around
        sines = np.sin(theta @ torus.harmonics.T)
        P = -sines @ ((torus.harmonics @ omega)[:, None] * torus.cosines)
        slope = -sines @ (torus.harmonics[:, [place]] * torus.cosines)
        assert (P * slope).sum(axis=1).mean() == pytest.approx(actions(torus)[q], rel=QUADRATURE)


def test_digits_of_the_solution():
    orbit = symfpu.torus(Chain(4, alpha="0.3"), (1,), amplitudes={1: "0.3"})
    precise = actions(refine(orbit, digits=40))[1]
    assert precise.digits == 40
    assert float(precise) == pytest.approx(actions(orbit)[1], rel=NEWTON_TWIST)


def test_a_ring_of_twice_the_length_has_twice_the_action():
    orbit = symfpu.torus(Chain(8, beta=1), (1,), amplitudes={1: "0.4"})
    assert actions(unfold(orbit))[1] == pytest.approx(2 * actions(orbit)[1], rel=ROUNDING)


def test_what_is_no_solution_is_refused():
    with pytest.raises(InputError, match="solution"):
        actions(3)
