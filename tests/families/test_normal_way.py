"""Families that carry normal frequencies: the same as of each torus alone, events on the family's own curve."""

from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, NormalEvent, family, floquet, normal_family, refine
from symfpu.errors import RunInterrupted
from symfpu.families.normal_zeros import Bracket, located
from tests.tolerances import BESIDE_AN_ONSET, FIXED_ENERGY, GROWTH_BY_FLOQUET, NORMAL_CONVERGED, ONSET

UNSTABLE = Chain(4, alpha="0.5")
ARGUMENTS = (UNSTABLE, (2,), "1")
OPTIONS = {"from_energy": "0.3", "normal": True}


@cache
def breathers():
    return family(*ARGUMENTS, **OPTIONS)


def test_members_carry_the_normal_frequencies_of_their_tori():
    """Sought anew on each torus, from its closed shift."""
    for m in breathers().members:
        alone = symfpu.normal_modes(m.torus)
        assert m.normal.frequencies == pytest.approx(alone.frequencies, abs=NORMAL_CONVERGED)
        assert m.normal.signatures == {mode.mode: mode.signature for mode in alone.modes}
        assert m.normal.stable == floquet(m.torus).stable
        assert m.normal.missing == {}
    assert "stable" in repr(breathers().members[0])


def test_the_event_of_a_family_is_that_of_the_line():
    """Breathers of one seed are one curve, by energies here and by amplitudes there."""
    [event] = breathers().normal_events
    line = normal_family(symfpu.torus(UNSTABLE, (2,), amplitudes={2: "0.5"}), {2: "1"}, members=2, modes=[1])
    [expected] = line.events
    assert event.resonance.condition == expected.resonance.condition == "2 sigma_1 = (1).omega"
    assert event.begins
    assert event.amplitudes[2] == pytest.approx(expected.amplitudes[2], abs=ONSET)
    assert event.energy == pytest.approx(expected.energy, abs=ONSET)
    stable = [m.normal.stable for m in breathers().members]
    assert stable[event.after]
    assert not stable[event.after + 1]


@pytest.mark.long
def test_the_event_of_a_family_of_tori_is_that_of_the_line():
    """Of two seeds, with the ratio of amplitudes that the family keeps."""
    ratio = {1: "0.2", 5: "0.8"}
    found = family(Chain(8, beta=1), (1, 5), "0.3", from_energy="0.19", amplitude_ratio=ratio, normal=True)
    [event] = found.normal_events
    end = {q: repr(a) for q, a in found.members[-1].amplitudes.items()}
    [expected] = normal_family(found.members[0].torus, end, members=2, modes=[4, 6]).events
    assert (event.resonance.modes, event.resonance.harmonic) == ((4, 6), (0, 2))
    assert event.amplitudes == pytest.approx(expected.amplitudes, abs=ONSET)


def zero_by_floquet(near, A):
    """Off A_1 = A, where the logarithm of the pair of multipliers next to the trivial one is zero: its square is linear there, and the
    curvature is taken out by two distances."""

    def squared(a):
        multipliers = floquet(refine(near, amplitudes={1: repr(a)}, tolerance=1e-10)).multipliers
        logarithms = np.log(multipliers[np.argsort(np.abs(multipliers - 1))][2:4])
        return float((logarithms**2).real.mean())

    off = []
    for h in (1e-3, 5e-4):
        below, above = squared(A - h), squared(A + h)
        off.append(h * (below + above) / (below - above))
    return (4 * off[1] - off[0]) / 3


@pytest.mark.long
def test_normal_frequencies_go_through_a_fold_of_the_energy():
    """N = 16, beta = 1, seed 1, whose energy turns at 0.8127149. Floquet's multipliers count the same hyperbolic directions on every
    member, one of them at a frequency of the orbit beyond the fold, and change their count at every event. On the last member the
    pair is 1 +- 5.9e-6; nearer to where the branch of harmonic 9 began, doubles do not tell mode 11 from a shift of the angles."""
    found = family(Chain(16, beta=1), (1,), "5", from_energy="0.5", tolerance=1e-10, members=28, normal=True, resonance_length=0)
    [fold] = [e for e in found.events if (e.kind, e.what) == ("fold", "H")]
    for number, m in enumerate(found.members):
        hyperbolic = {q for q, w in m.normal.frequencies.items() if complex(w).imag}
        of_the_orbit = floquet(m.torus)
        kinds = of_the_orbit.instabilities
        assert m.normal.missing == {}
        assert len(hyperbolic) == 2 * kinds.get("complex quadruple", 0) + kinds.get("real > 0", 0)
        assert (11 in hyperbolic) == (number > fold.after)
        if 11 in hyperbolic:
            locked = complex(m.normal.frequencies[11])
            assert locked.real == pytest.approx(9 * float(m.torus.frequency), abs=NORMAL_CONVERGED)
            growth = np.log(of_the_orbit.multipliers[np.isclose(of_the_orbit.multipliers.imag, 0)].real.max())
            assert locked.imag == pytest.approx(growth * float(m.torus.frequency) / (2 * np.pi), rel=GROWTH_BY_FLOQUET)
    located = [e for e in found.normal_events if e.resonance.modes != (11,)]
    [locked_on] = [e for e in found.normal_events if e.resonance.modes == (11,)]
    assert locked_on.after == fold.after
    assert locked_on.energy == pytest.approx(fold.energy, rel=FIXED_ENERGY)
    assert abs(zero_by_floquet(found.members[fold.after].torus, locked_on.amplitudes[1])) < ONSET
    assert [e.begins for e in located] == [True, True, False, False]
    assert located[-1].after > fold.after
    for event in located:
        near, counts = found.members[event.after].torus, []
        for side in (-1, 1):
            A = event.amplitudes[1] + side * 10 * BESIDE_AN_ONSET
            counts.append(floquet(refine(near, amplitudes={1: repr(A)}, tolerance=1e-10)).instabilities.get("complex quadruple", 0))
        assert counts[1] == counts[0] + 1


@pytest.mark.long
def test_a_narrow_tongue_has_both_ends():
    """2 sigma_3 = 4 omega of N = 4, alpha = 1, beta = 1/2, between two members."""
    chain = Chain(4, alpha=1, beta="1/2")
    found = family(chain, (1,), "1.5", from_energy="1", normal=True)
    begins, ends = found.normal_events
    assert (begins.begins, ends.begins) == (True, False)
    for event in (begins, ends):
        for side in (-1, 1):
            A = event.amplitudes[1] + side * 10 * BESIDE_AN_ONSET
            inside = begins.amplitudes[1] < A < ends.amplitudes[1]
            assert floquet(symfpu.torus(chain, (1,), amplitudes={1: repr(A)})).stable != inside


def test_a_zero_of_what_is_too_small_to_interpolate_is_halved():
    found, error = located(lambda x: 1e-6 * (0.3 - x), Bracket(0.0, 1.0, 0.3e-6, -0.7e-6), 1e-3)
    assert abs(found - 0.3) <= error < 1e-3


def stop_at(member):
    def stop(label, done):
        if label.startswith(f"member {member}: normal"):
            raise KeyboardInterrupt

    return stop


def test_an_interrupted_family_goes_on_with_its_eigenfunctions(tmp_path):
    with pytest.raises(RunInterrupted):
        family(*ARGUMENTS, **OPTIONS, folder=tmp_path, progress=stop_at(3))
    assert [file.name for file in tmp_path.glob("normal-*")] == ["normal-0001.symfpu"]
    found = family(*ARGUMENTS, **OPTIONS, folder=tmp_path)
    assert found.normal_events == breathers().normal_events
    for m, expected in zip(found.members, breathers().members, strict=True):
        assert (m.normal.frequencies, m.normal.residual) == (expected.normal.frequencies, expected.normal.residual)
        assert m.normal.resonances == expected.normal.resonances
    with pytest.raises(InputError, match="its normal differs"):
        family(*ARGUMENTS, from_energy="0.3", folder=tmp_path)
    for file in tmp_path.glob("normal-*"):
        file.write_bytes(b"PK\x03\x04")
    with pytest.raises(symfpu.BundleError, match="is damaged"):
        family(*ARGUMENTS, **OPTIONS, folder=tmp_path)


def test_series_and_bad_lengths_have_no_normal_frequencies():
    with pytest.raises(InputError, match=r"^normal"):
        family(UNSTABLE, (1,), "0.1", normal=True, method="appendix-a", order=3)
    with pytest.raises(InputError, match=r"^resonance_length"):
        family(UNSTABLE, (1,), "0.1", normal=True, resonance_length=-1)


LINE = {"members": 3, "modes": [1]}


def test_an_interrupted_line_goes_on(tmp_path):
    def stop(label, done):
        if label.startswith("torus 3"):
            with pytest.raises(InputError, match=r"^folder = .*process [0-9]+ on .*the other line of tori"):
                normal_family(breather, {2: "1"}, **LINE, folder=tmp_path)
            raise KeyboardInterrupt

    breather = symfpu.torus(UNSTABLE, (2,), amplitudes={2: "0.5"})
    with pytest.raises(RunInterrupted, match="after 2 tori"):
        normal_family(breather, {2: "1"}, **LINE, folder=tmp_path, progress=stop)
    found = normal_family(breather, {2: "1"}, **LINE, folder=tmp_path)
    expected = normal_family(breather, {2: "1"}, **LINE)
    assert found.events == expected.events
    assert isinstance(found.events[0], NormalEvent)
    assert [m.frequencies for m in found.members] == [m.frequencies for m in expected.members]
    again = normal_family(breather, {2: "1"}, **LINE, folder=tmp_path)
    assert again.events == expected.events
    with pytest.raises(InputError, match="its amplitudes differs"):
        normal_family(breather, {2: "0.9"}, **LINE, folder=tmp_path)
    (tmp_path / "normal-0001.symfpu").unlink()
    with pytest.raises(InputError, match=r"restore normal-0001\.symfpu"):
        normal_family(breather, {2: "1"}, **LINE, folder=tmp_path)
    (tmp_path / "line.json").write_text("{")
    with pytest.raises(InputError, match="is damaged"):
        normal_family(breather, {2: "1"}, **LINE, folder=tmp_path)
