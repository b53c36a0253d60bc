"""Orbits of rings: the order of every scheme, tori of travelling waves, standing waves of fixed ends, momentum, checkpoints."""

import json
import zipfile

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symfpu.chain.chain import Chain
from symfpu.dynamics.motion import Motion
from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.schemes import PARTICLE_SCHEMES, SCHEMES
from symfpu.dynamics.stopping import EscapedOrbit, UnstableStep
from symfpu.errors import InputError
from symfpu.integrable.invariants import toda_gaps
from symfpu.series.travelling import travelling_waves
from symfpu.tori.ring_torus import travelling_torus
from tests.tolerances import (
    ENERGY_WALK,
    HUNDRED_ROUNDINGS,
    OBSERVED_ORDER,
    ORBIT,
    PEER_ABSOLUTE,
    PEER_RELATIVE,
    ROUNDING,
    STEP_ERROR,
)

# laws with the size of a state at which they are far from harmonic
LAWS = {"toda:1/2": 0.1, "lj:12,6": 0.02, "poly:1/3,0,1/5,-1/4": 0.1, "poly:0,1": 0.1}
STEPS = {"yoshida4": 0.05, "aba864": 0.1, "blanes_moan6": 0.2, "kahan_li8": 0.3}


def ring(N, **law):
    return Chain(N, **law, ends="periodic")


def centred(values):
    return values - values.mean(axis=-1, keepdims=True)


def state(chain, size, count=()):
    draws = np.random.default_rng(3)
    shape = (*count, chain.N)
    x, p = draws.normal(scale=size, size=shape), draws.normal(scale=size, size=shape)
    return chain.modes(centred(x)), chain.modes(centred(p))


@pytest.mark.long
@pytest.mark.parametrize("law", LAWS)
def test_the_error_of_orbits_falls_as_the_order_of_the_scheme(law):
    chain = ring(7, potential=law)
    start = state(chain, LAWS[law])
    exact = integrate(chain, *start, 24.0, step=0.03, samples=1)
    assert exact.energy_error < ENERGY_WALK
    for name in PARTICLE_SCHEMES:
        runs = [integrate(chain, *start, 24.0, step=STEPS[name] / part, scheme=name) for part in (1, 2)]
        coarse, fine = (np.max(np.abs(run.Q[-1] - exact.Q[-1])) for run in runs)
        assert np.log2(coarse / fine) == pytest.approx(SCHEMES[name].order, abs=OBSERVED_ORDER), name
        assert runs[1].energy_error < max(runs[0].energy_error / 2 ** (SCHEMES[name].order - 1), ENERGY_WALK), name


@pytest.mark.parametrize("N", [2, 3, 4, 9])
def test_the_shortest_rings_and_their_fields(N):
    """Against another program and the equations of motion in modes, which know nothing of sites."""
    chain = ring(N, alpha="0.3", beta="0.2")
    Q, P = state(chain, 0.2)
    orbit = integrate(chain, Q, P, 10.0, step=0.05, samples=1, averages=True)
    assert (orbit.Q.dtype, orbit.Q.shape, orbit.averages.shape) == (complex, (2, N - 1), (2, N - 1))

    def motion(t, together):
        return np.concatenate([together[N - 1 :], chain.accelerations(together[: N - 1])])

    peer = solve_ivp(motion, (0, 10), np.concatenate([Q, P]), "DOP853", rtol=PEER_RELATIVE, atol=PEER_ABSOLUTE)
    assert np.abs(np.concatenate([orbit.Q[-1], orbit.P[-1]]) - peer.y[:, -1]).max() < STEP_ERROR
    assert np.allclose(orbit.energies, chain.energy(orbit.Q, orbit.P), rtol=ROUNDING)
    assert np.array_equal(orbit.harmonic_energies(), chain.harmonic_energies(orbit.Q, orbit.P))


WAVES = [
    ({"potential": "toda:1/2"}, 8, (1, -3), ("0.7661", "1.8486")),
    ({"beta": "0.5"}, 9, (1, 4), ("0.684143", "1.97001")),
    ({"beta": "1"}, 6, (-2,), ("1.7326",)),
]


@pytest.mark.long
@pytest.mark.parametrize(("law", "N", "seeds", "omega"), WAVES)
def test_an_orbit_stays_on_the_torus_of_its_waves(law, N, seeds, omega):
    chain = ring(N, **law)
    torus = travelling_torus(travelling_waves(chain, seeds, omega, 12))
    orbit = integrate(chain, torus.mode_coordinates(0.0), torus.mode_momenta(0.0), 300.0, step=0.1, averages=True)
    there = torus.mode_coordinates(orbit.times)
    assert np.abs(orbit.Q - there).max() < ORBIT * np.abs(there).max()
    assert orbit.energy_error < ENERGY_WALK
    assert np.allclose(orbit.energies, torus.energy(), rtol=ORBIT)


def test_averages_go_to_those_of_the_torus():
    law, N, seeds, omega = WAVES[2]
    torus = travelling_torus(travelling_waves(ring(N, **law), seeds, omega, 12))
    orbit = integrate(torus.chain, torus.mode_coordinates(0.0), torus.mode_momenta(0.0), 20.0, step=0.1, averages=True)
    # one wave: its energies do not change
    assert np.allclose(orbit.averages, torus.average_spectrum(), rtol=0, atol=ORBIT)


@pytest.mark.parametrize("N", [2, 5, 8])
def test_the_odd_orbit_of_a_ring_is_that_of_fixed_ends(N):
    fixed, whole = Chain(N, alpha="0.4", beta="0.1"), ring(2 * N, alpha="0.4", beta="0.1")
    draws = np.random.default_rng(N)
    x, p = draws.normal(scale=0.3, size=(2, N - 1))
    odd = [whole.modes([0, *values, 0, *-values[::-1]]) for values in (x, p)]
    run = {"T": 50.0, "step": 0.05, "samples": 20}
    between_walls = integrate(fixed, fixed.modes(x), fixed.modes(p), **run)
    around = integrate(whole, *odd, **run)
    there = fixed.positions(between_walls.Q)
    assert np.abs(whole.positions(around.Q)[:, 1:N] - there).max() < STEP_ERROR
    assert np.allclose(around.energies, 2 * between_walls.energies, rtol=ENERGY_WALK)


def test_the_momentum_is_kept_to_rounding():
    """A ring that moves as a whole is no state of its modes; particles keep their sums."""
    chain = ring(16, potential="toda:1/2")
    Q, P = state(chain, 0.3)
    motion = Motion(chain, SCHEMES["kahan_li8"], 0.25, np.array([[-9.0, 9.0]]))
    moved = motion.coordinates(Q[None], P[None])
    motion.advance(moved, 40_000, map)
    assert np.array_equal(moved[:, :, 0], moved[:, :, -1])
    assert abs(moved[0, 1, :-1].sum()) < HUNDRED_ROUNDINGS * 10
    assert abs(moved[0, 0, :-1].sum()) < 10_000 * HUNDRED_ROUNDINGS * 10  # for the time it took


@pytest.mark.long
def test_many_orbits_and_the_way_back():
    chain = ring(6, potential="lj:12,6")
    Q, P = state(chain, 0.02, count=(2, 3))
    there = integrate(chain, Q, P, 20.0, step=0.05, samples=3, workers=2)
    assert there.Q.shape == (len(there.times), 2, 3, 5)
    alone = integrate(chain, Q[1, 2], P[1, 2], 20.0, step=0.05, samples=3)
    assert np.array_equal(there.Q[:, 1, 2], alone.Q)
    back = integrate(chain, there.Q[-1], there.P[-1], -20.0, step=0.05, samples=1)
    assert np.abs(back.Q[-1] - Q).max() < ENERGY_WALK


def test_gaps_of_toda_do_not_change_along_its_orbits():
    chain = ring(6, potential="toda:1/2")
    orbit = integrate(chain, *state(chain, 0.3), 100.0, step=0.05, samples=5)
    gaps = toda_gaps(chain, orbit.Q, orbit.P)
    assert np.abs(gaps - gaps[0]).max() < STEP_ERROR
    assert gaps[0].min() > STEP_ERROR * 1000


def test_kicks_in_modes_refuse_a_ring_by_name():
    chain = ring(4, alpha=1)
    with pytest.raises(InputError, match="aba864_modes is for fixed ends, not for ends='periodic'"):
        integrate(chain, *state(chain, 0.1), 1.0, step=0.1, scheme="aba864_modes")


def test_what_stops_an_orbit_names_mode_and_bond():
    chain = ring(6, alpha="1/4")
    p = np.array([5.0, 0, 0, 0, 0, -5.0])
    rest = np.zeros(5)
    with pytest.raises(EscapedOrbit, match="bond 5 passes the barrier") as caught:
        integrate(chain, rest, chain.modes(-0.6 * p), 10.0, step=0.05)
    assert caught.value.bond == 5
    with pytest.raises(UnstableStep) as coarse:
        integrate(chain, *state(chain, 0.1), 10.0, step=5.0, scheme="yoshida4")
    assert coarse.value.mode in chain.mode_numbers
    crossing = ring(6, potential="lj:12,6")
    with pytest.raises(UnstableStep, match="bond 5 across the wall r = -1") as crossed:
        integrate(crossing, rest, crossing.modes(-p), 10.0, step=0.3)
    assert crossed.value.bond == 5


def test_a_state_that_is_none_of_a_ring_is_refused():
    chain = ring(6, alpha="1/4")
    with pytest.raises(InputError, match=r"Q_\(-q\) = conj Q_q"):
        integrate(chain, np.arange(5.0), np.zeros(5), 1.0, step=0.1)
    with pytest.raises(InputError, match="N-1 = 5"):
        integrate(chain, np.zeros(6), np.zeros(6), 1.0, step=0.1)


@pytest.mark.parametrize("averages", [False, True])
def test_a_run_goes_on_to_the_last_bit(averages, tmp_path):
    chain, path = ring(7, potential="toda:1/2"), tmp_path / "run"
    start, marks = state(chain, 0.2), np.array([10.0, 20.0])
    run = {"step": 0.125, "averages": averages}
    integrate(chain, *start, 20.0, samples=marks, file=path, **run)
    longer = np.append(marks, 40.0)
    resumed = integrate(chain, *start, 40.0, samples=longer, file=path, **run)
    at_once = integrate(chain, *start, 40.0, samples=longer, **run)
    assert np.array_equal(resumed.Q, at_once.Q)
    assert np.array_equal(resumed.P, at_once.P)
    assert not averages or np.array_equal(resumed.averages, at_once.averages)


def test_checkpoints_name_the_ends_of_a_ring_alone(tmp_path):
    chains = Chain(4, alpha="0.3"), ring(4, alpha="0.3")
    zeros = np.zeros(3)
    for chain, Q in zip(chains, ([0.1, 0, 0], [0.1, 0.1, 0]), strict=True):
        integrate(chain, Q, zeros, 1.0, step=0.125, file=tmp_path / chain.ends)
    named = []
    for chain in chains:
        with zipfile.ZipFile(tmp_path / chain.ends) as archive:
            [body] = [json.loads(archive.read(name)) for name in archive.namelist() if name.endswith(".json")]
        named.append(body["parameters"].get("ends"))
    assert named == [None, "periodic"]
    with pytest.raises(InputError, match=r"ends is periodic in it, fixed here"):
        integrate(chains[0], [0.1, 0, 0], zeros, 1.0, step=0.125, file=tmp_path / "periodic")
    with pytest.raises(InputError, match=r"ends is fixed in it, periodic here"):
        integrate(chains[1], [0.1, 0.1, 0], zeros, 1.0, step=0.125, file=tmp_path / "fixed")
