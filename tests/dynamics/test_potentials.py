"""Orbits of chains of any potential: the order of every scheme, where bonds can be, what stops them, checkpoints, alignment indices."""

import json
import zipfile

import numpy as np
import pytest
from scipy.optimize import brentq

from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.dynamics.alignment import alignment_indices
from symfpu.dynamics.frame_run import OrbitLost
from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.schemes import PARTICLE_SCHEMES, SCHEMES
from symfpu.dynamics.stopping import EscapedOrbit, UnstableStep
from symfpu.dynamics.wells import FACTOR, potential, sides, stretch_bounds
from symfpu.errors import InputError
from symfpu.refinement.tori import refine
from symfpu.tori.frequencies import torus_at_amplitudes
from tests.tolerances import ENERGY_WALK, HUNDRED_ROUNDINGS, LAST_DIGIT, OBSERVED_ORDER, STEP_ERROR

# laws with the size of a state at which they are far from harmonic
LAWS = {"toda:1/2": 0.1, "lj:12,6": 0.02, "poly:1/3,0,1/5,-1/4": 0.1, "poly:0,1/2,0,1/3": 0.1}
STEPS = {"yoshida4": 0.05, "aba864": 0.1, "blanes_moan6": 0.2, "kahan_li8": 0.4}
OTHERS = ("lj:12,6", "poly:0,1/2,0,1/3", "morse:1/2", "expr:cosh(r)-1")
EVERY_LAW = pytest.mark.parametrize("law", LAWS)
LJ = Chain(6, potential="lj:12,6")


def small_state(law, N=7):
    draws = np.random.default_rng(3)
    size = LAWS[law]
    return draws.normal(scale=size, size=N - 1), draws.normal(scale=size, size=N - 1)


def kicked(chain, momentum):
    """Two neighbours that run into each other."""
    p = np.zeros(chain.N - 1)
    p[1:3] = momentum, -momentum
    return np.zeros(chain.N - 1), chain.modes(p)


@EVERY_LAW
def test_the_error_of_orbits_falls_as_the_order_of_the_scheme(law):
    chain, state = Chain(7, potential=law), small_state(law)
    exact = integrate(chain, *state, 24.0, step=0.03, samples=1).Q[-1]
    for name in PARTICLE_SCHEMES:
        runs = [integrate(chain, *state, 24.0, step=STEPS[name] / part, scheme=name) for part in (1, 2)]
        coarse, fine = (np.max(np.abs(run.Q[-1] - exact)) for run in runs)
        assert np.log2(coarse / fine) == pytest.approx(SCHEMES[name].order, abs=OBSERVED_ORDER), name
        assert runs[1].energy_error < max(runs[0].energy_error / 2 ** (SCHEMES[name].order - 1), ENERGY_WALK), name


@pytest.mark.long
@pytest.mark.parametrize("law", ["poly:1/3,0,1/5,-1/4", "poly:0,1/2,0,1/3"])
def test_kicks_in_modes_serve_polynomials_of_any_degree(law):
    chain, state = Chain(7, potential=law), small_state(law)
    there = integrate(chain, *state, 24.0, step=0.02, scheme="aba864_modes", samples=1)
    peer = integrate(chain, *state, 24.0, step=0.03, samples=1)
    assert there.Q[-1] == pytest.approx(peer.Q[-1], abs=STEP_ERROR)


def test_kicks_in_modes_refuse_a_closed_law_by_name():
    with pytest.raises(InputError, match=r"aba864_modes is for polynomial potentials, not for toda\(0.5\)"):
        integrate(Chain(4, potential="toda:1/2"), [0.1, 0, 0], [0, 0, 0], 1.0, step=0.1, scheme="aba864_modes")


@pytest.mark.parametrize("N", [8, pytest.param(9, marks=pytest.mark.long)])
@pytest.mark.parametrize("law", ["toda:1/2", "poly:1/3,0,1/5,-1/4", *(pytest.param(law, marks=pytest.mark.long) for law in OTHERS)])
def test_an_orbit_stays_on_its_refined_torus(law, N):
    chain, size = Chain(N, potential=law), 1.5 * LAWS.get(law, 0.1)
    torus = refine(torus_at_amplitudes(chain, {1: size, 2: size / 2}, order=6))
    orbit = integrate(chain, *torus.state(), 300.0, step=0.1)
    there = torus.positions(orbit.times)
    assert np.max(np.abs(orbit.Q - there)) < STEP_ERROR * np.max(np.abs(there))
    assert orbit.energy_error < ENERGY_WALK


# where bonds can be


@pytest.mark.parametrize("law", [*LAWS, "toda:-1/3", "lj:2,1", "poly:-2,0,0,1/7", "poly:1/3,0,1/5"])
def test_turning_points_are_where_the_force_vanishes(law):
    """Against a scan of V for its extrema."""
    chain = Chain(4, potential=law)
    r = np.linspace(-0.9 if law.startswith("lj") else -4, 4, 4001)
    values = bonds.potential(chain.law(), r)
    turned = np.flatnonzero(np.diff(np.sign(np.diff(values)))) + 1
    seen = [x for x in r[turned] if abs(x) > 0.01]
    found = [side.sign * turn for side in sides(chain.potential) for turn in side.turns]
    assert sorted(x for x in found if abs(x) < 4) == pytest.approx(seen, abs=r[1] - r[0])


def test_the_well_of_toda_is_bounded_by_its_energy():
    """V = FACTOR times the energy on both sides: linear on one, exponential on the other."""
    chain = Chain(6, potential="toda:1/2")
    least, most, escapes = stretch_bounds(chain, 2.0)
    for bound, guess in ((least, (-20, -1)), (most, (1, 5))):
        assert bound == pytest.approx(brentq(lambda r: potential(chain, r) - FACTOR * 2.0, *guess), rel=HUNDRED_ROUNDINGS)
    assert not escapes


def test_a_broken_bond_is_bounded_by_the_length_of_the_chain():
    """V of Lennard and Jones ends at 1/72: above it a bond may break, and the others hold it by their walls."""
    assert stretch_bounds(LJ, 1 / 72 / 5)[1] < 1
    least, most, escapes = stretch_bounds(LJ, 0.1)
    assert -1 < least < 0
    assert most == -5 * least
    assert not escapes
    broken = integrate(LJ, *kicked(LJ, 0.4), 300.0, step=0.02)
    assert LJ.stretches(broken.Q).max() > 0.3
    assert broken.energy_error < STEP_ERROR


@pytest.mark.parametrize("samples", [1, 200])
def test_an_odd_polynomial_is_escaped_from(samples):
    """Bond 2 is pressed together, beyond r = -1.93 between 0.5 and 0.55, whether or not each step is sampled."""
    chain = Chain(6, potential="poly:1/3,0,1/5")
    Q, P = kicked(chain, 2.0)
    with pytest.raises(EscapedOrbit, match=r"bond 2 passes the barrier of its potential at time") as caught:
        integrate(chain, Q, P, 100.0, step=0.05, samples=samples)
    assert caught.value.bond == 2
    assert caught.value.time == pytest.approx(0.5, rel=LAST_DIGIT)
    assert caught.value.energy == pytest.approx(float(chain.energy(Q, P)), rel=STEP_ERROR)


@pytest.mark.parametrize("run", [integrate, alignment_indices])
def test_a_start_beyond_the_wall_is_refused(run):
    Q = LJ.modes([0, 0, -1.2, 0, 0])
    with pytest.raises(InputError, match=r"stretch r_2 = -1.2 of bond 2.*above -1, where lennard_jones\(12, 6\) is infinite"):
        run(LJ, Q, 0 * Q, 200.0, step=0.01)


def test_a_bond_that_is_stretched_is_not_the_one_at_the_wall():
    """From rest no bond moves yet: the one nearest to a wall is named, not the first."""
    chain, Q = Chain(8, potential="lj:12,6"), np.zeros(7)
    Q[0] = 1.2
    with pytest.raises(UnstableStep, match=r"takes bond 7 across the wall r = -1 of"):
        integrate(chain, Q, 0 * Q, 100.0, step=1.0)


def test_a_step_across_the_wall_is_stopped_with_time_and_bond():
    """Kicked so hard that the first step of a particle is longer than its bond."""
    with pytest.raises(UnstableStep, match=r"takes bond 2 across the wall r = -1 of its potential at time 0 .*shorter step") as caught:
        integrate(LJ, *kicked(LJ, 5.0), 100.0, step=0.3)
    assert (caught.value.bond, caught.value.time) == (2, 0.0)
    assert integrate(LJ, *kicked(LJ, 5.0), 1.0, step=0.001).energy_error < STEP_ERROR


@pytest.mark.long
def test_an_alignment_index_across_the_wall_is_lost_with_time_and_bond():
    with pytest.raises(OrbitLost, match="in bond 2") as caught:
        alignment_indices(LJ, *kicked(LJ, 5.0), 1000.0, step=0.3, frames=1)
    assert (caught.value.bond, caught.value.time) == (2, 0.3)


# files


def test_checkpoints_know_the_potential(tmp_path):
    chain, state, path = Chain(7, potential="toda:1/2"), small_state("toda:1/2"), tmp_path / "run"
    marks = np.array([10.0, 20.0])
    integrate(chain, *state, 20.0, step=0.125, samples=marks, file=path)
    longer = np.append(marks, 40.0)
    resumed = integrate(chain, *state, 40.0, step=0.125, samples=longer, file=path)
    assert np.array_equal(resumed.Q, integrate(chain, *state, 40.0, step=0.125, samples=longer).Q)
    other = Chain(7, potential="toda:1/3")
    with pytest.raises(InputError, match=r"potential is toda:0.5 in it, toda:1/3 here"):
        integrate(other, *state, 40.0, step=0.125, file=path)
    with pytest.raises(InputError, match=r"alpha is None in it, 0.5 here"):
        integrate(Chain(7, alpha="1/2"), *state, 40.0, step=0.125, file=path)


def test_checkpoints_of_the_papers_chains_name_alpha_and_beta_alone(tmp_path):
    path = tmp_path / "run"
    integrate(Chain(4, alpha="0.3"), [0.1, 0, 0], [0, 0, 0], 1.0, step=0.125, file=path)
    with zipfile.ZipFile(path) as archive:
        [body] = [json.loads(archive.read(name)) for name in archive.namelist() if name.endswith(".json")]
    assert (body["parameters"]["alpha"], body["parameters"]["beta"]) == ("0.3", "0")
    assert "potential" not in body["parameters"]


# alignment indices


@pytest.mark.long
def test_a_toda_chain_is_regular_where_that_of_alpha_is_chaotic():
    """The same state at the same c_3; |v| of the integrable chain grows as the time."""
    draws = np.random.default_rng(0)
    state = draws.normal(scale=1.6, size=5), draws.normal(scale=1.6 / 3, size=5)
    run = {"T": 1e4, "vectors": 2, "step": 0.125}
    regular = alignment_indices(Chain(6, potential="toda:1/4"), *state, **run, frames=1)
    chaotic = alignment_indices(Chain(6, alpha="1/4"), *state, **run, frames=1)
    assert chaotic.dimension().verdict == "chaotic"
    assert chaotic.lyapunov[-1] * run["T"] > 2 * np.log(run["T"])
    assert regular.lyapunov[-1] * run["T"] < np.log(run["T"])
    assert regular.energy_error < STEP_ERROR
