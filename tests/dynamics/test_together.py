"""Several orbits at once, as lanes: each in the bits that it has alone, whatever stops one of them or interrupts all."""

import numpy as np
import pytest

from symfpu import Chain, EscapedOrbit, integrate, random_state
from symfpu.dynamics.motion import FEWEST_SINGLY, Motion
from symfpu.dynamics.schemes import SCHEMES
from symfpu.numbers.lanes import LANES
from tests.tolerances import ENERGY_WALK

LAWS = ("poly:1/3,1/5", "poly:1/3,0,1/5,-1/4", "toda:1/2", "morse:1/2", "lj:12,6", "expr:cosh(r)-1")
RUN = {"step": 0.1, "samples": 5}


def states(chain, count):
    """Of energies that grow from one to the next."""
    energies = [f"{0.001 * (i + 1):.4f}" for i in range(count)]
    drawn = [random_state(chain, energy, seed=i) for i, energy in enumerate(energies)]
    return tuple(np.array(part) for part in zip(*drawn, strict=True))


def require_equal(many, alone, place):
    for name in ("Q", "P", "energies", "averages"):
        together, one = getattr(many, name), getattr(alone, name)
        assert (together is None) == (one is None)
        assert one is None or np.array_equal(together[:, place], one), name


@pytest.mark.parametrize("ends", ["fixed", "periodic"])
@pytest.mark.parametrize("law", LAWS)
def test_each_has_the_bits_that_it_has_alone(law, ends):
    """A part full of lanes, and one that is filled up; laws of all lanes at once, and one of an expression, lane after lane."""
    chain = Chain(7, potential=law, ends=ends)
    Q, P = states(chain, LANES + FEWEST_SINGLY)
    many = integrate(chain, Q, P, 12.0, **RUN)
    assert many.Q.shape == (len(many.times), LANES + FEWEST_SINGLY, 6)
    for place in (0, LANES - 1, LANES, LANES + FEWEST_SINGLY - 1):
        require_equal(many, integrate(chain, Q[place], P[place], 12.0, **RUN), place)


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("averages", [False, True])
def test_by_every_scheme_with_and_without_averages(name, averages):
    chain = Chain(9, alpha="0.3", beta="0.2")
    Q, P = states(chain, LANES)
    run = RUN | {"scheme": name, "averages": averages}
    many = integrate(chain, Q, P, -12.0, **run)
    for place in (0, LANES - 1):
        require_equal(many, integrate(chain, Q[place], P[place], -12.0, **run), place)


def test_states_that_differ_in_the_last_bit_alone_are_told_apart():
    chain = Chain(6, alpha="0.3")
    Q, P = (np.repeat(part[None], LANES, axis=0) for part in random_state(chain, "0.01", seed=1))
    Q[3, 0] = np.nextafter(Q[3, 0], 1.0)
    found = integrate(chain, Q, P, 100.0, **RUN).Q[-1]
    differ = [not np.array_equal(found[0], row) for row in found]
    assert differ == [place == 3 for place in range(LANES)]


def test_workers_share_orbits_out_without_changing_bits():
    chain = Chain(7, alpha="0.3")
    Q, P = states(chain, 2 * LANES + 3)
    alone = integrate(chain, Q, P, 12.0, **RUN)
    for workers in (2, 3, 40):
        shared = integrate(chain, Q, P, 12.0, **RUN, workers=workers)
        assert np.array_equal(shared.Q, alone.Q), workers


def test_every_orbit_has_its_energy_error():
    chain = Chain(8, alpha="0.3")
    Q, P = states(chain, 6)
    many = integrate(chain, Q.reshape(2, 3, 7), P.reshape(2, 3, 7), 50.0, step=0.5, samples=20)
    assert many.energy_errors.shape == (2, 3)
    for place in np.ndindex(2, 3):
        row = 3 * place[0] + place[1]
        alone = integrate(chain, Q[row], P[row], 50.0, step=0.5, samples=20)
        assert many.energy_errors[place] == alone.energy_error == float(alone.energy_errors)
    assert many.energy_error == many.energy_errors.max() > 0
    fine = integrate(chain, Q, P, 50.0, step=0.1)
    assert (fine.energy_errors < ENERGY_WALK).all()


@pytest.mark.parametrize(("averages", "step"), [(False, 0.01), (True, 0.01), (True, 0.5)])
def test_an_orbit_that_escapes_is_named_as_it_is_alone(averages, step):
    """The first to go over, at the step at which it does so alone; the lanes beside it stay where they are."""
    chain = Chain(8, alpha=1)
    momenta = np.linspace(0.1, 1.3, LANES)[:, None] * np.eye(7)[4]
    run = {"step": step, "samples": 3, "averages": averages}
    stops = {}
    for place, P in enumerate(momenta):
        try:
            integrate(chain, 0 * P, P, 60.0, **run)
        except EscapedOrbit as stopped:
            stops[place] = stopped
    assert 1 <= len(stops) < LANES
    with pytest.raises(EscapedOrbit) as caught:
        integrate(chain, 0 * momenta, momenta, 60.0, **run)
    (place,) = caught.value.orbit
    alone = stops[place]
    assert alone.time == min(stop.time for stop in stops.values())
    assert (caught.value.time, caught.value.bond, caught.value.mode) == (alone.time, alone.bond, alone.mode)
    assert caught.value.energy == alone.energy


@pytest.mark.parametrize("place", [0, 3, LANES - 1])
@pytest.mark.parametrize("side", [0, 1])
def test_each_orbit_stops_at_its_own_bounds(place, side):
    """One of them after some steps, as it does alone, and the others not at all."""
    chain, steps = Chain(7, alpha="0.3"), 200
    bounds = np.tile([-9.0, 9.0], (LANES, 1))
    motion = Motion(chain, SCHEMES["kahan_li8"], 0.1, bounds)
    state = motion.coordinates(*states(chain, LANES))
    row = state[place].copy()
    motion.move(row, bounds[place], 40)
    bounds[place, side] = (1.0 - 1e-9) * (np.diff(row[0]).min() if side == 0 else np.diff(row[0]).max())
    alone = [motion.move(row.copy(), limits, steps) for row, limits in zip(state, bounds, strict=True)]
    assert alone[place] < 40
    assert alone == [alone[place] if i == place else steps for i in range(LANES)]
    moved = state.copy()
    assert motion.advance(moved, steps, map) == alone
    done, _, _ = motion.look(state, steps, 1, map)
    assert done == alone
