"""Orbits of chains of any potential: the order of every scheme, where bonds can be, what stops them, what is refused."""

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np
import pytest
import sympy
from scipy.optimize import brentq

import symfpu
from symfpu import (
    Chain,
    EscapedOrbit,
    InputError,
    UnstableStep,
    alignment_indices,
    integrate,
    random_state,
    refine,
)
from symfpu.chain import bonds
from symfpu.chain.potentials.potential import Potential
from symfpu.dynamics.onset import chaos_times
from symfpu.dynamics.schemes import PARTICLE_SCHEMES, SCHEMES
from symfpu.dynamics.tangent import tangent_steps
from symfpu.dynamics.wells import FACTOR, potential, sides, stretch_bounds
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


def small_waves(chain, size):
    """Displacements and momenta of a ring, their sums zero."""
    x, p = np.random.default_rng(3).normal(scale=size, size=(2, chain.N))
    return chain.modes(x - x.mean()), chain.modes(p - p.mean())


def kicked(chain, momentum):
    """Two neighbours that run into each other."""
    p = np.zeros(chain.N - 1)
    p[1:3] = momentum, -momentum
    return np.zeros(chain.N - 1), chain.modes(p)


@pytest.mark.parametrize("ends", ["fixed", pytest.param("periodic", marks=pytest.mark.long)])
@EVERY_LAW
def test_the_error_of_orbits_falls_as_the_order_of_the_scheme(law, ends):
    chain = Chain(7, potential=law, ends=ends)
    start = small_state(law) if ends == "fixed" else small_waves(chain, LAWS[law])
    exact = integrate(chain, *start, 24.0, step=0.03, samples=1)
    assert exact.energy_error < ENERGY_WALK
    for name in PARTICLE_SCHEMES:
        step = 0.3 if (name, ends) == ("kahan_li8", "periodic") else STEPS[name]
        runs = [integrate(chain, *start, 24.0, step=step / part, scheme=name) for part in (1, 2)]
        coarse, fine = (np.max(np.abs(run.Q[-1] - exact.Q[-1])) for run in runs)
        assert np.log2(coarse / fine) == pytest.approx(SCHEMES[name].order, abs=OBSERVED_ORDER), name
        assert runs[1].energy_error < max(runs[0].energy_error / 2 ** (SCHEMES[name].order - 1), ENERGY_WALK), name


@pytest.mark.long
@pytest.mark.parametrize("law", ["poly:1/3,0,1/5,-1/4", "poly:0,1/2,0,1/3"])
def test_kicks_in_modes_serve_polynomials_of_any_degree(law):
    chain, state = Chain(7, potential=law), small_state(law)
    there = integrate(chain, *state, 24.0, step=0.02, scheme="aba864_modes", samples=1)
    peer = integrate(chain, *state, 24.0, step=0.03, samples=1)
    assert there.Q[-1] == pytest.approx(peer.Q[-1], abs=STEP_ERROR)


@pytest.mark.parametrize(
    ("chain", "words"),
    [
        (Chain(4, potential="toda:1/2"), r"polynomial potentials, not for toda\(0.5\)"),
        (Chain(4, alpha=1, ends="periodic"), "fixed ends, not for ends='periodic'"),
    ],
)
def test_kicks_in_modes_refuse_closed_laws_and_rings_by_name(chain, words):
    with pytest.raises(InputError, match=f"aba864_modes is for {words}"):
        integrate(chain, *random_state(chain, "0.01", 1), 1.0, step=0.1, scheme="aba864_modes")


@pytest.mark.parametrize("N", [8, pytest.param(9, marks=pytest.mark.long)])
@pytest.mark.parametrize("law", ["toda:1/2", "poly:1/3,0,1/5,-1/4", *(pytest.param(law, marks=pytest.mark.long) for law in OTHERS)])
def test_an_orbit_stays_on_its_refined_torus(law, N):
    chain, size = Chain(N, potential=law), 1.5 * LAWS.get(law, 0.1)
    torus = refine(symfpu.torus(chain, (1, 2), amplitudes={1: size, 2: size / 2}, method="series", order=6))
    orbit = integrate(chain, *torus.state(), 300.0, step=0.1)
    there = torus.Q(orbit.times)
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


# laws that numba does not compile


class UncompiledLaw(NamedTuple):
    """Of V = cosh r - 1, by a function that Python knows and numba does not."""

    a: float

    def tension(self, r):
        return eval("np.sinh(r)")

    def stiffness(self, r):
        return np.cosh(r)


class Uncompiled(Potential):
    kind = "uncompiled"
    parameters = ()

    def coefficient(self, n):
        return Fraction((n + 1) % 2, math.factorial(n - 1))

    def law(self, numbers):
        return UncompiledLaw(1.0)

    def expression(self, r):
        return sympy.cosh(r) - 1


DOORS = {
    "integrate": lambda chain, Q: integrate(chain, Q, Q, 1.0, step=0.1),
    "alignment_indices": lambda chain, Q: alignment_indices(chain, Q, Q, 100.0),
    "tangent_steps": lambda chain, Q: tangent_steps(chain, Q, Q, [Q], [Q], 0.1, 1),
    "chaos_times": lambda chain, Q: chaos_times(chain, [(Q, Q)], 100.0),
}


@pytest.mark.parametrize(("ends", "door"), [*(("fixed", door) for door in DOORS), ("periodic", "integrate")])
def test_a_law_that_numba_does_not_compile_is_refused_by_name(door, ends):
    chain = Chain(4, potential=Uncompiled(), ends=ends)
    with pytest.raises(InputError, match=r"^potential = 'UncompiledLaw': .*numba says: Untyped global name 'eval'"):
        DOORS[door](chain, np.eye(3)[2])
