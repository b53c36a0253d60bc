"""Borders of chaos: the search on orbits of a known law, small chains, files that go on, what is refused."""

import math

import numpy as np
import pytest

import symfpu
from symfpu import Atlas, Chain, InputError, SweepRows, alignment_indices, atlas, packet_state, read_atlas
from symfpu.borders import chaos
from symfpu.borders.chaos import COARSE, DRAWS, EARLIER, FACTOR, QUIET, ChaosRay, chaos_borders
from symfpu.borders.column import atlas_column
from symfpu.numbers.lanes import LANES
from symfpu.sweeps.rows import SweepFailure, SweepRow
from symfpu.sweeps.this_process import ThisProcess
from tests.tolerances import SIX_DIGITS

HERE = ThisProcess()
BETA, ALPHA, TODA = Chain(8, beta=1), Chain(8, alpha=1), Chain(8, potential="toda:1")
BOTH = ("chaos", "in-phase")
STEP = FACTOR * (1 + SIX_DIGITS)


@pytest.fixture
def law(monkeypatch):
    """Orbit i, the one with phases 0 first, is seen to be chaotic at t = (thresholds[i]/H)^2, if H is above its floor."""

    def of(thresholds, floors):
        def times(chain, states, T):
            energies = np.array([float(chain.energy(*state)) for state in states])
            seen = (np.array(thresholds) / energies) ** 2
            return np.where((energies >= floors) & (seen <= T), seen, math.inf)

        monkeypatch.setattr(chaos, "chaos_times", times)

    return of


def test_borders_by_three_times_are_located_to_the_factor(law):
    thresholds = np.array([10.0, 30.0, 20.0, 80.0])
    law(thresholds, np.zeros(4))
    orbits = ChaosRay(BETA, (1,), 1e5, draws=3).searched().records()
    for T in (1e5 / part for part in EARLIER):
        found = chaos_borders(orbits, T)
        exact = thresholds / math.sqrt(T)
        for energy, true in ((found["in-phase"]["energy"], exact[0]), (found["chaos"]["energy"], exact[1])):
            assert 1 - SIX_DIGITS <= energy / true < STEP
        lowest, highest = found["chaos"]["between"]
        assert 1 - SIX_DIGITS <= lowest / exact[2] < STEP
        assert 1 - SIX_DIGITS <= highest / exact[3] < STEP
        assert found["in-phase"]["quiet"] == pytest.approx(found["in-phase"]["energy"] / FACTOR, rel=SIX_DIGITS)


def test_a_floor_is_the_border_at_all_late_times(law):
    law([1.0, 1.0], np.array([0.5, 0.5]))
    orbits = ChaosRay(BETA, (1,), 1e6, draws=1).searched().records()
    borders = [chaos_borders(orbits, T)["chaos"]["energy"] for T in (1e4, 1e5, 1e6)]
    assert borders[0] == borders[1] == borders[2]
    assert 1 <= borders[0] / 0.5 < STEP


def test_the_way_down_ends_after_quiet_energies_alone(law):
    law([1.0, 1.0], np.array([0.5, 0.5]))
    found = ChaosRay(BETA, (1,), 1e6, draws=1).searched().found
    lowest = min(k for k, times in found.items() if np.isfinite(times).any())
    assert len([k for k in found if k < lowest - COARSE]) <= QUIET
    assert max(found) == 0


def test_where_most_draws_stay_quiet_there_is_no_border(law):
    law([1.0, 1.0, 1.0, 1.0], np.array([0.5, 0.5, 1e9, 1e9]))
    found = chaos_borders(ChaosRay(BETA, (1,), 1e6, draws=3).searched().records(), 1e6)
    assert found["chaos"]["none"] == "no chaos seen up to H = 8"
    assert found["in-phase"]["energy"] >= 0.5


def test_of_some_quiet_draws_the_highest_is_not_known(law):
    law([1.0, 1.0, 1.0, 1.0], np.array([0.5, 0.5, 0.5, 1e9]))
    found = chaos_borders(ChaosRay(BETA, (1,), 1e6, draws=3).searched().records(), 1e6)["chaos"]
    assert (found["between"][1], found["quiet"]) == (None, 8.0)


def test_phases_are_drawn_once_for_all_energies_and_are_not_those_of_another_draw():
    one, again, other = (chaos._phases((1, 2, 3), draw) for draw in (0, 0, 1))
    assert one == again
    assert set(one) == {1, 2, 3}
    assert not set(one.values()) & set(other.values())
    assert len(set(one.values())) == 3


@pytest.mark.long
def test_above_a_border_an_orbit_is_chaotic_and_below_it_is_not_seen():
    """By alignment indices, with vectors, scheme and step of their own."""
    column = atlas_column(BETA, "low:2", 1, BOTH, time=1e4, draws=1)
    found = column["borders"]["in-phase"]
    verdicts = [
        alignment_indices(BETA, *packet_state(BETA, (1, 2), energy), 1e4, vectors=2, frames=1, step=0.2).verdict
        for energy in (found["energy"] * FACTOR, found["energy"] / FACTOR**2)
    ]
    assert verdicts[0] == "chaotic"
    assert verdicts[1] != "chaotic"
    assert column["points"] == column["newton"] == []


@pytest.mark.long
def test_a_breather_stays_where_the_packet_of_its_seed_is_chaotic():
    """No orbit of alpha leaves its well below H = 1/6; twice the border of the packet by 1e5."""
    chain, H = Chain(16, alpha=1), "0.16"
    breather = symfpu.torus(chain, (1,), energy=symfpu.Energy(H, harmonic=False))
    on_it = [(breather.Q(t), breather.P(t)) for t in (0.0, 5.0)]
    packets = [packet_state(chain, (1,), H, phases={1: phase}) for phase in (0.0, 1.0, 2.0)]
    seen = chaos.chaos_times(chain, [*on_it, *packets], 1e5)
    assert np.isinf(seen[:2]).all()
    assert np.isfinite(seen[2:]).all()


@pytest.mark.long
def test_toda_has_no_border_where_alpha_has_one():
    toda, alpha = (atlas_column(chain, "low:2", 1, ("chaos",), time=1e3, draws=2)["borders"] for chain in (TODA, ALPHA))
    assert toda["chaos"]["none"] == "no chaos seen up to H = 8"
    assert 0 < alpha["chaos"]["energy"] < 8
    assert set(toda) == {"chaos"}


def test_states_beyond_the_well_count_as_no_torus():
    """At H/N = 1 the well of alpha has no such state for some phases; where it has, orbits leave it."""
    ray = ChaosRay(Chain(16, alpha=1), (1, 2), 1e3, draws=5)
    ray._look(0)
    there = []
    for phases in ({1: 0.0, 2: 0.0}, *(chaos._phases((1, 2), draw) for draw in range(5))):
        try:
            packet_state(ray.chain, (1, 2), "16", phases=phases)
            there.append(True)
        except InputError:
            there.append(False)
    assert set(there) == {True, False}
    assert [time > 0 for time in ray.found[0]] == there


CHEAP = {"packets": ["low:1"], "order": 1, "borders": list(BOTH), "time": 3e3, "draws": 1, "executor": HERE}


@pytest.mark.long
def test_a_file_is_gone_on_with_and_has_earlier_times(tmp_path):
    file = tmp_path / "chaos.jsonl"
    atlas([Chain(4, beta=1), Chain(6, beta=1)], **CHEAP, file=file)
    before = file.read_text()
    found = atlas([Chain(N, beta=1) for N in (4, 6, 8)], **CHEAP, file=file)
    assert file.read_text().startswith(before)
    assert read_atlas(file) == found
    assert [b.border for b in found.borders] == list(BOTH) * 3
    earlier = found.by_time(1e3)
    assert all(b.details["time"] == 1e3 for b in earlier.borders)
    assert all(early.energy >= late.energy for early, late in zip(earlier.borders, found.borders, strict=True))
    assert earlier.borders[2].energy > found.borders[2].energy
    assert found.by_time(3e3) == found
    assert list(found.to_frame().time) == [3e3] * 6
    assert found.law("low:1", "chaos").lengths == (4, 6, 8)
    with pytest.raises(InputError, match="at most 3000"):
        found.by_time(1e4)
    with pytest.raises(InputError, match="fixed"):
        atlas([BETA], **CHEAP | {"draws": 2}, file=file)


def test_other_borders_and_failures_are_as_they_were_by_an_earlier_time():
    orbits = [{"place": 1.0, "seen": [None, 900.0]}, {"place": 2.0, "seen": [50.0, 100.0]}]
    borders = {"ratio": {"energy": 5.0}} | {name: chaos_borders(orbits, 1e3)[name] for name in ("chaos",)}
    case = {"chain": {"N": 8, "beta": "1"}, "packet": "1", "order": 2}
    done = SweepRow(case, {"modes": [1], "points": [], "newton": [], "borders": borders, "orbits": orbits})
    failed = SweepRow(case | {"packet": "9"}, None, SweepFailure("InputError", "no mode 9"))
    found = Atlas(SweepRows("a.function", {"time": 1e3}, (done, failed)))
    earlier = found.by_time(200)
    assert [(b.border, b.energy) for b in found.borders] == [("ratio", 5.0), ("chaos", 1.0)]
    assert [(b.border, b.energy) for b in earlier.borders] == [("ratio", 5.0), ("chaos", 2.0)]
    assert earlier.rows.failures == found.rows.failures


def test_without_chaos_the_head_of_a_file_has_no_time(tmp_path):
    file = tmp_path / "atlas.jsonl"
    atlas([Chain(4, beta=1)], ["low:1"], 2, borders=[], places=["0.01"], executor=HERE, file=file)
    assert not {"time", "draws"} & set(read_atlas(file).rows.fixed)


def test_seven_draws_and_phases_0_fill_the_lanes():
    assert DRAWS + 1 == LANES


WRONG = {"time": {"time": 10.0}, "time, none": {"time": "long"}, "draws": {"draws": 0}, "draws, part": {"draws": 1.5}}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_arguments_are_refused(name):
    with pytest.raises(InputError) as caught:
        atlas([BETA], **CHEAP | WRONG[name])
    assert caught.value.argument == {"time": "T"}.get(name.partition(",")[0], "draws")
