"""Lines of tori on rings: onsets by Floquet's multipliers, standing waves by fixed ends, pairs of waves one by one."""

import pytest

import symfpu
from symfpu import Chain, InputError, floquet, lindstedt, normal_family, normal_modes, refine, unfold
from symfpu.errors import RunInterrupted
from symfpu.families.normal_events import STABILITY
from symfpu.normal.resonances import SUM
from tests.tolerances import BESIDE_AN_ONSET, EVENT_BY_DIGITS, NORMAL_CONVERGED

RING = Chain(8, alpha="0.3", beta="0.5", ends="periodic")


def wave(A):
    return symfpu.torus(RING, (2,), amplitudes={2: A})


def test_a_travelling_wave_loses_its_stability_where_a_multiplier_leaves_the_circle():
    """Beside sigma_(-2), hyperbolic from small amplitudes on: two waves that go the other way."""
    [event] = normal_family(wave("1"), {2: "1.3"}, members=2).events
    assert (event.kind, event.begins) == (STABILITY, True)
    assert (event.resonance.kind, event.resonance.modes, event.resonance.harmonic) == (SUM, (-3, -1), (2,))
    counts = []
    for side in (-1, 1):
        A = event.amplitudes[2] + side * BESIDE_AN_ONSET
        counts.append(sum(floquet(wave(repr(A))).instabilities.values()))
    assert counts[1] == counts[0] + 1


@pytest.mark.long
def test_standing_waves_have_the_onset_of_fixed_ends():
    fixed = symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: "0.5"})
    [expected] = normal_family(fixed, {2: "1"}, members=2, modes=[1]).events
    sine, cosine = sorted(normal_family(unfold(fixed), {2: "1"}, members=2, modes=[-1, 1]).events, key=lambda e: -e.resonance.modes[0])
    assert sine.resonance == expected.resonance
    assert sine.amplitudes[2] == pytest.approx(expected.amplitudes[2], abs=EVENT_BY_DIGITS)
    for side in (-1, 1):
        A = cosine.amplitudes[2] + side * BESIDE_AN_ONSET
        ring = normal_modes(unfold(symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: repr(A)})), modes=[-1])
        assert bool(ring.growth) == (side > 0)


def pair():
    series = lindstedt(Chain(8, potential="toda:1/2", ends="periodic"), (1, -3), ("0.7661", "1.8486"), 6)
    return refine(symfpu.solve_amplitudes(series))


@pytest.mark.long
def test_members_of_a_line_of_two_waves_are_those_of_their_tori():
    """Toda: no direction ever leaves the real line."""
    torus = pair()
    end = {q: 1.5 * a for q, a in torus.amplitudes.items()}
    found = normal_family(torus, end, members=3, resonance_length=0)
    assert found.events == ()
    for m in found.members:
        assert m.stable
        assert m.frequencies == pytest.approx(normal_modes(m.torus).frequencies, abs=NORMAL_CONVERGED)
    assert found.members[-1].torus.amplitudes == pytest.approx(end, rel=NORMAL_CONVERGED)
    assert set(found.to_xarray().mode.values) == set(RING.mode_numbers) - {1, -3}


@pytest.mark.parametrize("stands", [False, True])
def test_an_interrupted_line_of_a_ring_goes_on(tmp_path, stands):
    def stop(label, done):
        if label.startswith("torus 3"):
            raise KeyboardInterrupt

    first = unfold(symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: "0.5"})) if stands else wave("1")
    line = {"amplitudes": {2: "0.8" if stands else "1.3"}, "members": 3, "modes": [1]}
    with pytest.raises(RunInterrupted):
        normal_family(first, **line, folder=tmp_path, progress=stop)
    found = normal_family(first, **line, folder=tmp_path)
    expected = normal_family(first, **line)
    assert found.events == expected.events
    assert [m.frequencies for m in found.members] == [m.frequencies for m in expected.members]
    fixed = symfpu.torus(Chain(8, potential=first.chain.potential), (2,), amplitudes={2: repr(float(first.amplitudes[2]))})
    with pytest.raises(InputError, match="its ends differs"):
        normal_family(fixed, **line, folder=tmp_path)
