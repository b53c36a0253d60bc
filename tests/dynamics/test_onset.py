"""When orbits are seen to be chaotic: the loop of eight, its verdict, known cases."""

import math

import numpy as np
import pytest

from symfpu import Chain, EscapedOrbit, InputError, UnstableStep, alignment_indices, integrate, packet_state, random_state
from symfpu.dynamics import onset
from symfpu.dynamics.alignment import drawn_frame
from symfpu.dynamics.blanes_moan6 import BLANES_MOAN6
from symfpu.dynamics.dimension import CHAOS_GROWTH, outgrown_powers
from symfpu.dynamics.onset import _Ensemble, _Verdict, chaos_times
from symfpu.dynamics.tangent import tangent_steps
from tests.tolerances import ONSET_STEPS

BETA, ALPHA, TODA = Chain(8, beta=1), Chain(8, alpha=1), Chain(8, potential="toda:1")


def states(chain, energy, count=3):
    return [random_state(chain, energy, seed) for seed in range(count)]


@pytest.mark.parametrize("chain", [BETA, ALPHA, TODA], ids=["beta", "alpha", "toda"])
def test_lanes_are_the_orbits_and_deviations_of_the_tangent_map(chain):
    few = states(chain, "0.1")
    ensemble = _Ensemble(chain, few, 0.4)
    ensemble._move(100)
    dQ, dP = (rows[:1] for rows in drawn_frame(chain, 2, 0))
    for place, state in enumerate(few):
        Q, P, vQ, vP = tangent_steps(chain, *state, dQ, dP, 0.4, 100, scheme=BLANES_MOAN6)
        x, p, dx, dp = (lanes[1:-1, place] for lanes in ensemble.lanes)
        size = math.sqrt(float((vQ**2).sum() + (vP**2).sum()))
        assert chain.modes(x) == pytest.approx(Q, abs=ONSET_STEPS)
        assert chain.modes(p) == pytest.approx(P, abs=ONSET_STEPS)
        assert chain.modes(dx) == pytest.approx(vQ[0] / size, abs=ONSET_STEPS)
        assert chain.modes(dp) == pytest.approx(vP[0] / size, abs=ONSET_STEPS)
        assert math.exp(ensemble.growth[place]) == pytest.approx(size, rel=ONSET_STEPS)


@pytest.mark.parametrize("seed", range(5))
def test_the_verdict_is_that_of_alignment_indices(seed):
    """At every time the same as of the whole past at once."""
    random = np.random.default_rng(seed)
    times = np.geomspace(1, 1e4, 60)
    growth = np.log(times) + np.cumsum(random.exponential(0.7, 60)) * (times > 10 ** (seed / 2))
    outgrown = [outgrown_powers(times[: i + 1], growth[: i + 1]) > CHAOS_GROWTH for i in range(60)]
    none = np.array([math.inf])
    verdict = _Verdict(-none, none.copy(), none.copy())
    for time, grown in zip(times, growth, strict=True):
        verdict.hears(time, np.array([grown]), np.array([False]))
    assert any(outgrown)
    assert verdict.seen[0] == times[outgrown.index(True)]


def test_toda_is_never_chaotic_where_its_neighbours_are():
    assert np.isinf(chaos_times(TODA, states(TODA, "1"), 2e3)).all()
    assert (chaos_times(BETA, states(BETA, "4"), 2e3) < 2e3).all()


def test_what_alignment_indices_call_chaotic_is_seen_and_a_small_packet_is_not():
    strong, weak = (packet_state(BETA, (1, 2), H) for H in ("2", "0.01"))
    seen = chaos_times(BETA, [strong, weak], 1e4)
    said = [alignment_indices(BETA, *state, 1e4, vectors=2, frames=1).verdict for state in (strong, weak)]
    assert (seen[0] < 1e4, said[0]) == (True, "chaotic")
    assert (seen[1], said[1] == "chaotic") == (math.inf, False)


def test_an_orbit_that_leaves_its_well_is_gone_then_and_leaves_others_alone():
    still = packet_state(ALPHA, (1,), "0.001")
    leaving = random_state(ALPHA, "1.5", 0)
    seen = chaos_times(ALPHA, [leaving, still], 1e3)
    with pytest.raises(EscapedOrbit) as caught:
        integrate(ALPHA, *leaving, 1e3, step=onset.STEP / 8)
    assert 0 <= seen[0] - caught.value.time <= onset.STEP + caught.value.time * (10 ** (1 / onset.SAMPLES_A_DECADE) - 1)
    assert seen[1] == math.inf


def test_an_orbit_alone_and_among_others_is_the_same():
    many = states(BETA, "4", 9)
    together = chaos_times(BETA, many, 1e3)
    assert together.shape == (9,)
    assert len(set(together)) > 1
    assert together[[2, 8]].tolist() == [chaos_times(BETA, [many[i]], 1e3)[0] for i in (2, 8)]


def test_a_step_that_loses_the_energy_is_made_finer_and_refused_at_last(monkeypatch):
    fine = chaos_times(BETA, states(BETA, "40"), 1e3)
    monkeypatch.setattr(onset, "LEAST_STEP", onset.STEP)
    with pytest.raises(UnstableStep, match="does not keep the energy"):
        chaos_times(BETA, states(BETA, "40"), 1e3)
    assert (fine < 1e3).all()


@pytest.mark.parametrize(("chain", "T"), [(Chain(8, beta=1, ends="periodic"), 1e3), (BETA, 10.0), (BETA, math.inf)])
def test_rings_and_short_times_are_refused(chain, T):
    with pytest.raises(InputError):
        chaos_times(chain, states(BETA, "1"), T)
