"""The step with deviation vectors by every scheme on T + V: orders, exact derivative, symplecticity, work that grows as N."""

import os
import subprocess
import sys

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symfpu import Chain, InputError
from symfpu.dynamics.kahan_li8 import KAHAN_LI8
from symfpu.dynamics.schemes import PARTICLE_SCHEMES, SCHEMES, particle_scheme
from symfpu.dynamics.tangent import tangent_map_along, tangent_steps
from tests.refusals import each, refused
from tests.tolerances import HUNDRED_ROUNDINGS, ORBIT, PEER_ABSOLUTE, PEER_RELATIVE, TANGENT_MAP

MIXED = Chain(7, alpha="0.3", beta="0.2")
EYE = np.eye(12)

NONE = np.zeros((0, 6))
EVERY = pytest.mark.parametrize("scheme", PARTICLE_SCHEMES.values(), ids=PARTICLE_SCHEMES)

# Steps of a time of 4 over which the error of a scheme is between rounding and a few per cent.
STEPS = {
    "yoshida4": (80, 100, 130, 160, 200),
    "aba864": (32, 40, 52, 64, 80),
    "blanes_moan6": (16, 20, 26, 32, 40),
    "kahan_li8": (8, 10, 13, 16, 20),
}

# Slopes of errors over a few halvings: the next order changes them by less.
ORDER_SLOPE = 0.2

# The same over half the time, with steps cut to whole numbers.
ALONG_SLOPE = 0.4


@pytest.fixture(scope="module")
def state():
    random = np.random.default_rng(3)
    return random.normal(scale=0.3, size=6), random.normal(scale=0.3, size=6)


def tangent_map(state, step, steps, **scheme):
    return np.hstack(tangent_steps(MIXED, *state, EYE[:, :6], EYE[:, 6:], step, steps, **scheme)[2:]).T


def moved(state, step, steps, **scheme):
    return np.append(*tangent_steps(MIXED, *state, NONE, NONE, step, steps, **scheme)[:2])


def order_of(errors, steps):
    return -np.polyfit(np.log(steps), np.log(errors), 1)[0]


def dop853(state):
    """The orbit as a function of time."""
    motion = solve_ivp(
        lambda t, y: np.append(y[6:], MIXED.accelerations(y[:6])),
        (0, 4.1),
        np.append(*state),
        "DOP853",
        rtol=PEER_RELATIVE,
        atol=PEER_ABSOLUTE,
        dense_output=True,
    )
    return motion.sol


@EVERY
def test_the_observed_order_of_orbit_and_deviations_is_that_of_the_scheme(state, scheme):
    """Against steps of the scheme of order 8 so short that only rounding is left."""
    orbit, deviations = (f(state, 0.02, 200, scheme=KAHAN_LI8) for f in (moved, tangent_map))
    steps = np.array(STEPS[scheme.name])
    for f, exact in ((moved, orbit), (tangent_map, deviations)):
        errors = [np.max(np.abs(f(state, 4.0 / n, int(n), scheme=scheme) - exact)) for n in steps]
        assert order_of(errors, steps) == pytest.approx(scheme.order, abs=ORDER_SLOPE)
    assert orbit == pytest.approx(dop853(state)(4.0), abs=ORBIT)


@EVERY
def test_the_step_is_reversible(state, scheme):
    there = tangent_steps(MIXED, *state, EYE[:, :6], EYE[:, 6:], 0.3, 20, scheme=scheme)
    back = np.hstack(tangent_steps(MIXED, *there, -0.3, 20, scheme=scheme)[2:])
    assert back == pytest.approx(EYE, abs=HUNDRED_ROUNDINGS)


@EVERY
def test_the_tangent_map_along_an_orbit_is_that_of_the_motion(state, scheme, monkeypatch):
    """Deviations that do not see the orbit move, only its stretches at the times of the kicks."""
    track = dop853(state)

    def stretches(t):
        return MIXED.stretches(track(t)[:6].T)

    exact = tangent_map(state, 0.01, 200, scheme=KAHAN_LI8)
    # the dense output of DOP853 is of order 7
    along = tangent_map_along(MIXED, stretches, 2.0, 60, scheme=KAHAN_LI8)
    assert along == pytest.approx(exact, abs=ORBIT)
    steps = np.array(STEPS[scheme.name]) // 2
    errors = [np.max(np.abs(tangent_map_along(MIXED, stretches, 2.0, int(n), scheme=scheme) - exact)) for n in steps]
    assert order_of(errors, steps) == pytest.approx(scheme.order, abs=ALONG_SLOPE)
    whole = tangent_map_along(MIXED, stretches, 2.0, 60, scheme=scheme)
    monkeypatch.setattr("symfpu.dynamics.tangent.TABLE", scheme.stages * 7 * 7)  # portions of seven steps
    assert np.array_equal(tangent_map_along(MIXED, stretches, 2.0, 60, scheme=scheme), whole)


@pytest.mark.parametrize("steps", [1, 7])
def test_the_tangent_map_is_the_derivative_of_the_step(state, steps):
    """Central differences of a coarse step err by h^2, down to where rounding begins."""
    M, point = tangent_map(state, 0.4, steps), np.append(*state)

    def slopes(h):
        return np.array(
            [(moved(np.split(point + h * e, 2), 0.4, steps) - moved(np.split(point - h * e, 2), 0.4, steps)) for e in EYE]
        ).T / (2 * h)

    sizes = np.array([0.04, 0.02, 0.01, 0.005])
    errors = [np.max(np.abs(slopes(h) - M)) for h in sizes]
    assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] == pytest.approx(2, abs=ORDER_SLOPE)
    assert np.max(np.abs((4 * slopes(0.005) - slopes(0.01)) / 3 - M)) < 1e-3 * errors[-1]


@EVERY
@pytest.mark.parametrize("share", [0.03, 0.15, 0.4])
def test_the_tangent_map_is_symplectic(state, share, scheme):
    """At small shares of the longest step that is stable, and at large ones."""
    step = share * scheme.stable_phase / MIXED.frequencies()[-1]
    J = np.kron([[0, 1], [-1, 0]], np.eye(6))
    M = tangent_map(state, step, 5, scheme=scheme)
    assert np.max(np.abs(M.T @ J @ M - J)) < TANGENT_MAP


def test_vectors_do_not_know_of_each_other(state):
    """Twelve vectors lie in two blocks of lanes; one by one they move the same, and the same with another way to count steps."""
    whole = tangent_map(state, 0.25, 6)
    for i, e in enumerate(EYE):
        alone = tangent_steps(MIXED, *state, e[None, :6], e[None, 6:], 0.25, 6)
        assert np.hstack(alone[2:])[0] == pytest.approx(whole[:, i], abs=HUNDRED_ROUNDINGS)
    first = tangent_steps(MIXED, *state, EYE[:, :6], EYE[:, 6:], 0.25, 2)
    both = np.hstack(tangent_steps(MIXED, *first, 0.25, 4)[2:]).T
    assert both == pytest.approx(whole, abs=HUNDRED_ROUNDINGS)
    assert tangent_map(state, 0.25, 0) == pytest.approx(EYE, abs=HUNDRED_ROUNDINGS)


COUNT = """
import sys
import numpy as np
from symfpu import Chain
from symfpu.dynamics.tangent import moving_frame
from symfpu.dynamics.tangent_loops import advance

def count(frame, event, argument):
    global lines
    lines += event == "line"
    return count

for N in (16, 32, 64):
    zero, lines = np.zeros((7, N - 1)), 0
    frame = moving_frame(Chain(N, beta=1), zero[0] + 1e-3, zero[0], zero + 1e-3, zero, 0.1)
    sys.settrace(count)
    advance(*frame.arguments(), 3)
    sys.settrace(None)
    print(lines)
"""


def test_the_work_grows_as_the_chain():
    """Statements of three steps, where loops run as Python: as many more for twice the particles."""
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    out = subprocess.run([sys.executable, "-c", COUNT], env=environment, capture_output=True, text=True, check=True).stdout
    few, some, many = map(int, out.split())
    assert some > few > 1000
    assert many - some == 2 * (some - few)


@each(Q=[[0.1], [np.nan] * 6], P=[[[0.1] * 6]], dP=[[[0.1] * 6]], dQ=[[0.1] * 6], step=[0, np.inf], steps=[1.5])
def test_bad_input_is_refused(state, name, value):
    given = {"Q": state[0], "P": state[1], "dQ": EYE[:2, :6], "dP": EYE[:2, 6:], "step": 0.1, "steps": 3}
    refused(tangent_steps, name, value, chain=MIXED, **given)


def test_bad_times_along_an_orbit_are_refused():
    for duration, steps, name in ((np.nan, 4, "duration"), ("1", 4, "duration"), (1.0, 0, "steps"), (1.0, 2.5, "steps")):
        with pytest.raises(InputError, match=rf"^{name} = "):
            tangent_map_along(MIXED, lambda t: np.zeros((len(t), 7)), duration, steps)


def test_deviations_move_on_particles_only():
    assert [particle_scheme(name).name for name in PARTICLE_SCHEMES] == [*STEPS]
    assert [name for name in SCHEMES if name not in PARTICLE_SCHEMES] == ["aba864_modes"]
    with pytest.raises(InputError, match=r"^scheme = .*aba864_modes.*yoshida4, .*choose one of them.*integrate"):
        particle_scheme("aba864_modes")
    for name in ("verlet", 8, None, KAHAN_LI8):
        with pytest.raises(InputError, match=r"^scheme = .*choose one of them"):
            particle_scheme(name)
