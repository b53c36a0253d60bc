"""The linearised flow about tori of rings, in closed form: against integration, Toda's spectral curve, and fixed ends."""

from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, actions, foretold_indices, lindstedt, refine, solve_amplitudes, twist, unfold
from symfpu.action_angle.foretold import flow_of
from symfpu.action_angle.linear_flow import symplectic
from tests.tolerances import CANONICAL, FORETOLD, FORETOLD_AT_REST, NEWTON_TWIST, SLOPE, TWIST_DIFFERENCE

TIMES = np.geomspace(1, 1e12, 600)
TODA = Chain(8, potential=symfpu.toda("1/2"), ends="periodic")


@cache
def travelling(s):
    """One wave through the modes N/2 and -q, or two of opposite directions with phases."""
    if s == 1:
        return symfpu.torus(Chain(6, alpha="0.4", ends="periodic"), (-2,), amplitudes={-2: "0.3"})
    chain = Chain(7, alpha="0.4", beta="0.2", ends="periodic")
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    omega = [f"{linear[q] * 1.0003:.14f}" for q in (1, -3)]
    guess = solve_amplitudes(lindstedt(chain, (1, -3), omega, 6), phases={1: 0.3, -3: 1.1})
    return symfpu.refine(refine(guess), amplitudes={1: "0.3", -3: "0.2"})


@cache
def standing(s):
    if s == 1:
        return unfold(symfpu.torus(Chain(4, alpha="0.3", beta="0.4"), (2,), amplitudes={2: "0.4"}))
    amplitudes = {1: "0.3", 3: "0.2"}
    guess = symfpu.torus(Chain(5, beta=1), tuple(amplitudes), amplitudes=amplitudes, method="series", order=6)
    return unfold(symfpu.refine(guess, amplitudes=amplitudes))


@cache
def fixed(s):
    return symfpu.refine(symfpu.torus(Chain(6, alpha="0.3", beta="0.2"), (1, 2), amplitudes={1: "0.3", 2: "0.2"}, method="series", order=4))


@cache
def normal(waves, s):
    return symfpu.normal_modes(waves(s))


def integrated(torus, T, seed, start):
    """All indices there are."""
    state = torus.Q(start), torus.P(start)
    vectors = 2 * (torus.chain.N - 1)
    return symfpu.alignment_indices(torus.chain, *state, T, vectors=vectors, step=0.1, seed=seed, frames=1)


CASES = [(travelling, 1), (travelling, 2), (standing, 1), (standing, 2)]


SHORT = [(travelling, 2, 1e3), (standing, 1, 1e3)]
WHOLE = [pytest.param(*case, 1e4, marks=pytest.mark.long) for case in CASES]


@pytest.mark.parametrize(("waves", "s", "T"), SHORT + WHOLE)
def test_the_closed_form_is_the_integrated_one(waves, s, T):
    """All indices at all times, and the length of the first vector; from another state and frame too."""
    torus, start = waves(s), 0.0 if s == 1 else 2.5
    seen = integrated(torus, T, s, start)
    given = {"vectors": seen.vectors, "seed": s, "start": start}
    found = foretold_indices(torus, seen.times, **given, normal=normal(waves, s))
    assert found.log10_gali == pytest.approx(seen.log10_gali, abs=FORETOLD)
    assert found.growth == pytest.approx(seen.lyapunov * seen.times, abs=FORETOLD)


@pytest.mark.parametrize("s", [1, 2])
def test_modes_at_rest_are_near(s):
    torus = travelling(s)
    given = {"vectors": 2 * (torus.chain.N - 1)}
    found = foretold_indices(torus, TIMES[:200], **given, normal=normal(travelling, s))
    near = foretold_indices(torus, TIMES[:200], **given)
    assert near.log10_gali == pytest.approx(found.log10_gali, abs=FORETOLD_AT_REST)


@pytest.mark.parametrize("s", [1, 2])
def test_slopes_become_those_of_the_theory(s):
    n = travelling(s).chain.N - 1
    found = foretold_indices(travelling(s), TIMES, vectors=2 * n, normal=normal(travelling, s))
    theory = {k: 0 if k <= s else s - k if k <= 2 * n - s else -2 * (k - n) for k in range(2, 2 * n + 1)}
    assert found.asymptotic_slopes == theory
    assert [slope.value for slope in found.slopes()] == pytest.approx(list(theory.values()), abs=2 * SLOPE)


@pytest.mark.parametrize(("waves", "s"), [*CASES, (fixed, 2)])
def test_the_basis_is_canonical(waves, s):
    """Omega(E, F) = 1, none of E with E and F with F, nor of these with the normal directions; on a ring of all its bonds."""
    along, across, beside = flow_of(waves(s), normal(waves, s)).basis(np.array([0.7, 31.0]))
    assert symplectic(along, across) == pytest.approx(np.broadcast_to(np.eye(s), (2, s, s)), abs=CANONICAL)
    pairs = [(along, along), (across, across), (along, beside), (across, beside)]
    assert max(np.abs(symplectic(*pair)).max() for pair in pairs) < CANONICAL


@pytest.mark.parametrize("waves", [travelling, standing, fixed])
def test_the_mean_metric_is_the_mean(waves):
    flow = flow_of(waves(2), normal(waves, 2))
    around = np.linspace(0, 2 * np.pi, 32, endpoint=False)
    theta = np.stack(np.meshgrid(around, around), axis=-1).reshape(-1, 2)
    along = flow._along(theta)[0]
    mean = (np.swapaxes(along, 1, 2) @ along).mean(axis=0)
    assert flow.mean_metric() == pytest.approx(mean, rel=CANONICAL)


@pytest.mark.long
def test_todas_twist_by_its_spectral_curve():
    """Two waves of opposite directions: central differences of its frequencies in the actions."""
    torus = refine(solve_amplitudes(lindstedt(TODA, (1, -3), ("0.7661", "1.8486"), 8)))
    found, exact, step = twist(torus), actions(torus), 1e-6
    for column, q in enumerate(torus.seeds):
        ends = []
        for sign in (1, -1):
            typed = [repr(exact[n] + sign * step * (n == q)) for n in torus.seeds]
            ends.append(symfpu.toda_torus(TODA, torus.seeds, actions=typed, digits=30).frequencies)
        slopes = [float(ends[0][n] - ends[1][n]) / (2 * step) for n in torus.seeds]
        assert found.matrix[:, column] == pytest.approx(slopes, rel=TWIST_DIFFERENCE)
    assert found.asymmetry < NEWTON_TWIST
    assert found.definiteness == "positive definite"


def test_unfolded_tori_have_half_the_twist():
    """Their actions are twice those of the fixed ends."""
    breather = symfpu.torus(Chain(5, alpha="0.3"), (2,), amplitudes={2: "0.4"})
    assert twist(unfold(breather)).matrix == pytest.approx(twist(breather).matrix / 2, rel=NEWTON_TWIST)


def test_standing_waves_want_their_normal_modes():
    with pytest.raises(InputError, match="normal modes, of standing waves"):
        foretold_indices(standing(1), 1e3)


def test_standing_waves_that_can_be_displaced_are_refused():
    """Hyperbolic by Umklapp; in Toda's ring there is none of it, and a frequency of the cosine is missing."""
    for law, reason in (({"alpha": "0.5"}, "shrink exponentially"), ({"potential": symfpu.toda("1/2")}, "none is missing")):
        waves = unfold(symfpu.torus(Chain(4, **law), (1,), amplitudes={1: "0.4"}))
        with pytest.raises(InputError, match=reason):
            foretold_indices(waves, 1e3, normal=symfpu.normal_modes(waves))


def test_waves_that_are_not_refined_have_no_twist():
    rough = solve_amplitudes(lindstedt(TODA, (1, -3), ("0.77", "1.86"), 2))
    with pytest.raises(InputError, match="refine"):
        twist(rough)
    with pytest.raises(InputError, match="refine it first"):
        foretold_indices(rough, 1e3)
