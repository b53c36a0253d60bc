"""Alignment indices foretold: against integration, against a hundred digits, and what they refuse."""

from dataclasses import replace
from functools import cache

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, alignment_indices, foretold_indices, normal_modes, refine
from symfpu.action_angle.foretold import flow_of, settled_text
from symfpu.dynamics.alignment import random_frame
from symfpu.dynamics.dimension import ODDNESS
from tests.refusals import each, refused
from tests.tolerances import FORETOLD, FORETOLD_AT_REST, SLOPE

CHAIN = Chain(8, alpha="0.3")
SEEDS = {1: {2: "0.3"}, 2: {1: "0.3", 2: "0.2"}}
TIMES = np.geomspace(1, 1e12, 600)
FAST = pytest.param(1e3, 6)
WHOLE = pytest.param(3e4, 14, marks=pytest.mark.long)


@cache
def torus(s):
    return refine(symfpu.torus(CHAIN, tuple(SEEDS[s]), amplitudes=SEEDS[s], method="series", order=6))


@cache
def normal(s):
    return normal_modes(torus(s))


@pytest.mark.parametrize("s", [1, 2])
@pytest.mark.parametrize(("T", "vectors"), [FAST, WHOLE])
def test_the_closed_form_is_the_integrated_one(s, T, vectors):
    """All indices at all times, and the length of the first vector; from another state and frame too."""
    start = 0.0 if s == 1 else 2.5
    seen = alignment_indices(CHAIN, *torus(s).state(start), T, vectors=vectors, step=0.1, seed=s, frames=1)
    given = {"vectors": vectors, "seed": s, "start": start}
    found = foretold_indices(torus(s), seen.times, **given, normal=normal(s))
    assert found.log10_gali == pytest.approx(seen.log10_gali, abs=FORETOLD)
    assert found.growth == pytest.approx(seen.lyapunov * seen.times, abs=FORETOLD)
    near = foretold_indices(torus(s), seen.times, **given)
    assert near.log10_gali == pytest.approx(seen.log10_gali, abs=FORETOLD_AT_REST)


@pytest.mark.parametrize("s", [1, 2])
def test_slopes_become_those_of_the_theory(s):
    """Skokos, Bountis, Antonopoulos 2008; over twelve decades, for all fourteen vectors."""
    found = foretold_indices(torus(s), TIMES, vectors=14, normal=normal(s))
    theory = {k: 0 if k <= s else s - k if k <= 14 - s else -2 * (k - 7) for k in range(2, 15)}
    assert found.asymptotic_slopes == theory
    assert [slope.value for slope in found.slopes()] == pytest.approx(list(theory.values()), abs=2 * SLOPE)
    assert found.verdict == f"regular, dimension {s}"


def test_volumes_far_out_are_those_of_fifty_digits():
    """At t = 1e9, where GALI_14 of the 2-torus is below 1e-60."""
    flow = flow_of(torus(2), normal(2))
    t = np.array([1e9])
    frame = np.concatenate(random_frame(14, 7, 0), axis=1).T
    basis = np.concatenate(flow.basis(t), axis=2)[0]
    start = flow.coordinates(frame)
    with mpmath.workdps(50):
        moved = mpmath.matrix(flow.moved(start, t)[0].tolist())
        angles = mpmath.matrix(start[:2].tolist()) + mpmath.mpf(10) ** 9 * (
            mpmath.matrix(flow.twist.tolist()) * mpmath.matrix(start[2:4].tolist())
        )
        moved[:2, :] = angles
        V = mpmath.matrix(basis.tolist()) * moved
        for j in range(14):
            V[:, j] = V[:, j] / mpmath.norm(V[:, j])
        volumes = [mpmath.log10(mpmath.det(V[:, :k].T * V[:, :k])) / 2 for k in range(2, 15)]
    times = np.concatenate([np.geomspace(1, 1e8, 63), t])
    found = foretold_indices(torus(2), times, vectors=14, normal=normal(2)).log10_gali[-1]
    assert volumes[-1] < -30
    assert found[:9] == pytest.approx([float(v) for v in volumes[:9]], abs=FORETOLD)


def test_what_a_time_can_show():
    """Nothing before the twist has made vectors grow, the dimension after that; settled means that slopes stay."""
    found = foretold_indices(torus(2), TIMES, vectors=4)
    settled = found.settling()
    due = found.asymptotic_slopes
    assert found.dimension(1e3).value is None
    assert found.dimension(1e9).value == 2
    for k, time in settled.items():
        after = [s.value for T in TIMES[time <= TIMES][::37] for s in found.slopes(T) if s.k == k]
        assert np.abs(np.array(after) - due[k]).max() < ODDNESS + SLOPE
    early = foretold_indices(torus(2), 1e3, vectors=4)
    assert early.settling()[3] == np.inf
    assert settled[3] > 1 / found.rates[0]


@pytest.mark.long
def test_full_tori_and_two_particles():
    """No normal directions at all."""
    full = refine(symfpu.torus(Chain(3, beta=1), (1, 2), amplitudes={1: "0.2", 2: "0.3"}, method="series", order=4))
    assert foretold_indices(full, 1e8).asymptotic_slopes == {2: 0, 3: -2, 4: -4}
    alone = refine(symfpu.torus(Chain(2, beta=1), (1,), amplitudes={1: "0.3"}, method="series", order=4))
    assert foretold_indices(alone, 1e8).verdict == "regular, dimension 1"


@each(T=[10.0, 1e16, "long", -TIMES], samples=[3], vectors=[15], seed=[-1], start=["soon"], normal=[3], solution=[3])
def test_bad_input_is_refused(name, value):
    refused(foretold_indices, name, value, solution=torus(1), T=1e3)


def test_few_times_are_refused():
    with pytest.raises(InputError, match=r"^samples = "):
        foretold_indices(torus(1), TIMES[:20])


def test_what_is_no_refined_torus_is_refused():
    series = symfpu.torus(CHAIN, (2,), amplitudes={2: "0.5"}, method="series", order=2)
    with pytest.raises(InputError, match="refine it first"):
        foretold_indices(series, 1e3)


def test_normal_modes_of_another_torus_some_of_them_or_hyperbolic_ones_are_refused():
    some = replace(normal(2), modes=normal(2).modes[1:])
    for wrong in (normal(1), some):
        with pytest.raises(InputError, match="all 5 normal modes of this solution"):
            foretold_indices(torus(2), 1e3, normal=wrong)
    first = normal(2).modes[0]
    hyperbolic = replace(normal(2), modes=(replace(first, sigma=first.sigma + 0.01j), *normal(2).modes[1:]))
    with pytest.raises(InputError, match="shrink exponentially"):
        foretold_indices(torus(2), 1e3, normal=hyperbolic)


def test_too_early_a_time_is_refused():
    found = foretold_indices(torus(2), TIMES, vectors=4)
    with pytest.raises(InputError, match=r"^T = "):
        found.slopes(2.0)


def test_what_has_not_settled_says_so():
    early, late = (foretold_indices(torus(1), T, vectors=3) for T in (1e3, 1e9))
    assert "none settled by then" in repr(early)
    assert "settled from t = " in repr(late)
    assert "inf" not in repr(early) + repr(late)
    assert settled_text(np.inf, 1e3) == "not settled by t = 1e+03"
    assert settled_text(12.3, 1e3) == "settled from t = 12.3"
