"""Families of travelling waves: members by other routes, Toda's spectral curve, events, folders, what is refused."""

from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, actions, family, floquet, load, member_at_energy, save, toda, toda_torus
from symfpu.families.beginnings import returned
from symfpu.families.normal_events import STABILITY
from symfpu.refinement.guesses import shifts_of
from symfpu.tori.short_series import shifts_by_squares
from tests import tolerances
from tests.families.test_folder import alike
from tests.tolerances import EVENT_BY_DIGITS, FIXED_ENERGY, LINEAR_LIMIT, NEWTON_TWIST, SAME_FREQUENCY, SLOPE

RING = Chain(8, alpha="0.3", beta="0.5", ends="periodic")
TODA = Chain(8, potential=toda("1/2"), ends="periodic")


@cache
def wave():
    """Of a seed that loses its stability further on."""
    return family(RING, (2,), "1.8", from_energy="1.4", multipliers=True, normal=True)


@cache
def pair():
    """Two waves of opposite directions."""
    return family(TODA, (1, -3), "1", from_energy="0.01")


@pytest.mark.parametrize("found", [wave, pair])
def test_every_member_is_a_torus_and_the_ends_have_their_energies(found):
    members = found().members
    assert all(m.verdict == "torus" for m in members)
    assert max(m.residual for m in members) < tolerances.PROMISED_RESIDUAL
    ends = [1.4, 1.8] if found is wave else [0.01, 1.0]
    assert [members[0].energy, members[-1].energy] == pytest.approx(ends, rel=FIXED_ENERGY)
    assert found().ending == "reached the energy asked for"


def test_members_of_one_seed_are_the_waves_followed_from_rest():
    for m in wave().members:
        expected = symfpu.torus(RING, (2,), amplitudes={2: m.amplitudes[2]})
        assert float(m.torus.frequency) == pytest.approx(float(expected.frequency), rel=SAME_FREQUENCY)
        assert m.energy == pytest.approx(expected.energy(), rel=FIXED_ENERGY)


def test_members_of_two_seeds_are_tori_of_todas_ring():
    """Its actions at their frequencies, and the mean energies of both seeds equal."""
    for m in pair().members[::5]:
        exact = toda_torus(TODA, m.torus.seeds, frequencies=m.torus.frequencies, digits=20).actions
        found = actions(m.torus)
        assert [found[q] for q in m.torus.seeds] == pytest.approx([float(exact[q]) for q in m.torus.seeds], rel=NEWTON_TWIST)
        spectrum = dict(zip(TODA.mode_numbers, m.torus.average_spectrum(), strict=True))
        assert spectrum[1] == pytest.approx(spectrum[-3], rel=FIXED_ENERGY)


def test_it_begins_at_the_linear_limit():
    """Shifts over the closed lowest ones fall to 1 as the energy."""
    off = []
    for energy in ("4e-4", "1e-4"):
        first = family(Chain(9, beta=1, ends="periodic"), (1, -3), "1e-3", from_energy=energy, members=1).members[0]
        squares = np.array(list(first.amplitudes.values())) ** 2
        lowest = shifts_by_squares(first.torus.chain, first.torus.seeds) @ squares
        off.append(np.abs(shifts_of(first.torus).astype(float) / lowest - 1).max())
    assert np.log2(off[0] / off[1]) == pytest.approx(2, abs=SLOPE)
    assert off[1] < 10 * LINEAR_LIMIT


@pytest.mark.parametrize("ratio", [{"amplitude_ratio": {1: 2, -3: "1/2"}}, {"energy_ratio": {1: 2, -3: 1}}])
def test_ratios_and_harmonic_energies_are_kept(ratio):
    found = family(TODA, (1, -3), "0.02", from_energy="0.01", harmonic=True, **ratio)
    assert found.members[-1].harmonic_energy == pytest.approx(0.02, rel=FIXED_ENERGY)
    for m in found.members:
        spectrum = dict(zip(TODA.mode_numbers, m.torus.average_spectrum(), strict=True))
        kept = m.amplitudes[1] / m.amplitudes[-3] if "amplitude_ratio" in ratio else spectrum[1] / spectrum[-3]
        assert kept == pytest.approx(4 if "amplitude_ratio" in ratio else 2, rel=FIXED_ENERGY)
        assert sum(spectrum.values()) == pytest.approx(m.harmonic_energy, rel=FIXED_ENERGY)


def test_a_mode_that_is_its_own_opposite_has_its_whole_energy():
    found = family(Chain(8, beta=1, ends="periodic"), (1, 4), "0.01", members=1).members[0].torus
    spectrum = dict(zip(found.chain.mode_numbers, found.average_spectrum(), strict=True))
    assert spectrum[1] == pytest.approx(spectrum[4], rel=FIXED_ENERGY)


def test_resonances_are_where_a_divisor_is_zero():
    """Of the harmonic and the one mode that it lives in."""
    events = pair().events
    assert {(e.mode, e.harmonic) for e in events} >= {(3, (2, -7)), (-1, (3, -8))}
    linear = dict(zip(TODA.mode_numbers, TODA.frequencies(), strict=True))
    for event in events:
        assert (np.array(event.harmonic) @ np.array([-3, 1]) - event.mode) % 8 == 0
        torus = member_at_energy(pair(), repr(event.energy), harmonic=False)
        rate = np.array(event.harmonic) @ np.array([float(w) for w in torus.frequencies])
        assert abs(rate) == pytest.approx(linear[event.mode], rel=tolerances.RESONANCE_ENERGY)


def test_an_onset_is_that_of_the_line():
    """Where a multiplier leaves the circle: test_normal_line_rings.py."""
    [event] = wave().normal_events
    [expected] = symfpu.normal_family(symfpu.torus(RING, (2,), amplitudes={2: "1"}), {2: "1.3"}, members=2).events
    assert (event.kind, event.resonance.modes) == (STABILITY, expected.resonance.modes)
    assert event.amplitudes[2] == pytest.approx(expected.amplitudes[2], rel=EVENT_BY_DIGITS)


def test_members_carry_multipliers_and_normal_frequencies():
    m = wave().members[-1]
    assert m.multipliers.pairs == pytest.approx(floquet(m.torus).pairs)
    assert m.normal.frequencies == pytest.approx(symfpu.normal_modes(m.torus).frequencies, abs=tolerances.NORMAL_CONVERGED)


def test_members_at_an_energy_and_at_a_frequency():
    torus = member_at_energy(pair(), "0.3", harmonic=False)
    assert torus.energy() == pytest.approx(0.3, rel=FIXED_ENERGY)
    [again] = symfpu.member_at_frequency(pair(), 1, torus.omega[1])
    assert again.energy() == pytest.approx(0.3, rel=FIXED_ENERGY)
    assert again.amplitudes == pytest.approx(torus.amplitudes, rel=FIXED_ENERGY)


def test_a_way_back_to_rest_is_seen():
    """The same tori with the lowest one last."""
    first, *others = pair().members[:4]
    assert returned([*others, first], tolerance=1e-13)
    assert not returned([first, *others], tolerance=1e-13)


@pytest.mark.long
def test_a_folder_goes_on_and_a_file_keeps_it(tmp_path):
    goes = {"from_energy": "0.01", "normal": True}
    expected = family(TODA, (1, -3), "0.03", **goes)
    family(TODA, (1, -3), "0.03", **goes, members=3, folder=tmp_path / "out")
    found = family(TODA, (1, -3), "0.03", **goes, folder=tmp_path / "out")
    alike(found, expected)
    assert [m.normal.frequencies for m in found.members] == [m.normal.frequencies for m in expected.members]
    kept = load(save(tmp_path / "kept", found))
    assert repr(kept) == repr(found)
    fixed = Chain(8, potential=toda("1/2"))
    with pytest.raises(InputError, match="the same family"):
        family(fixed, (1, 3), "0.03", **goes, folder=tmp_path / "out")


REFUSED = {
    "standing": (((2, -2), "0.1"), {"amplitude_ratio": {2: 1, -2: 1}}, r"^amplitude_ratio = .*they stand"),
    "opposite": (((2, -2), "0.1"), {}, r"^energy_ratio = None.*give amplitude_ratio"),
    "mode 0": (((0,), "0.1"), {}, r"^seeds = "),
    "appendix-a": (((1,), "0.1"), {"method": "appendix-a", "order": 4}, "'periodic'"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_family_of_waves_is_refused(case):
    arguments, options, message = REFUSED[case]
    with pytest.raises(InputError, match=message):
        family(TODA, *arguments, **options)


def test_waves_that_drive_each_other_at_the_lowest_order_are_refused():
    with pytest.raises(symfpu.ResonantDivisor, match="driven in resonance"):
        family(TODA, (2, -2), "0.1", amplitude_ratio={2: 2, -2: 1})
