"""Lines of orbits against tori whose frequencies, actions and coefficients are known."""

import itertools
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, fpu_trajectory, frequency_analysis, integrate, packet_state, refine
from tests.refusals import each, refused
from tests.tolerances import ACTION_OF_LINES, CHANNEL_LINE, FREQUENCY_OF_LINE

PAIR = Chain(N=8, alpha="0.3")
ANGLES = {1: 0.3, 2: 1.1}


@cache
def torus():
    series = symfpu.lindstedt(PAIR, (1, 2), ("0.391", "0.7663"), 6)
    return refine(symfpu.solve_amplitudes(series, phases=ANGLES))


@cache
def orbit(T):
    return integrate(PAIR, *torus().state(), T, step=0.125)


def errors(analysis):
    """Frequencies of the seeds 1, 2 against the exact ones."""
    by_seed = dict(zip(analysis.seeds, analysis.frequencies, strict=True))
    exact = zip((1, 2), torus().frequencies, strict=True)
    return [abs(by_seed[q] - float(omega)) for q, omega in exact]


def test_two_modes_of_a_chain_without_couplings_are_their_own_lines():
    """N = 2: one mode; a line for it and its odd harmonics, with errors above the spacing of doubles."""
    single = Chain(N=2, beta="1/2")
    found = frequency_analysis(integrate(single, [0.2], [0.0], 500, step=0.1))
    assert found.seeds == (1,)
    assert {line.harmonic[0] % 2 for line in found.lines} == {1}
    assert all(line.error >= np.spacing(line.frequency) / 2 for line in found.lines)


@pytest.mark.long
@pytest.mark.parametrize("T", [12_000, 60_000])
def test_the_frequencies_of_a_torus(T):
    """Once as it is, once through channels."""
    found = frequency_analysis(orbit(T), lines=12, level=1e-8)
    assert sorted(found.seeds) == [1, 2]
    assert max(errors(found)) < FREQUENCY_OF_LINE
    assert all(line.harmonic is not None for line in found.lines)


@pytest.mark.long
def test_channels_give_what_the_whole_signal_gives(monkeypatch):
    """Amplitudes, phases and all."""
    few = orbit(12_000)
    channels = frequency_analysis(few, lines=3)
    monkeypatch.setattr("symfpu.spectral.analysis.SHORT", 10**9)
    whole = frequency_analysis(few, lines=3)
    names = [{(x.mode, x.harmonic): x for x in found.lines} for found in (channels, whole)]
    both = names[0].keys() & names[1].keys()
    assert len(both) > 15
    for name in both:
        waves = [x[name].amplitude * np.exp(1j * x[name].phase) for x in names]
        assert abs(waves[0] - waves[1]) < CHANNEL_LINE


@pytest.mark.long
def test_actions_are_those_of_toda():
    """Sums over lines against the spectral curve, which knows no lines."""
    toda = Chain(N=6, potential="toda:1/2")
    start = fpu_trajectory(toda, {1: "0.3", 2: "0.2"})
    found = frequency_analysis(integrate(toda, *start, 30_000, step=0.1), lines=10, level=1e-9)
    exact = symfpu.toda_invariants(toda, *start)
    for q, action in zip(found.seeds, found.actions, strict=True):
        if q in (1, 2):
            assert action == pytest.approx(float(exact.actions[q - 1]), rel=ACTION_OF_LINES)


@pytest.mark.long
def test_an_orbit_beside_a_torus_has_its_normal_frequencies_too():
    """That of the mode that was pushed; those of the torus are the strongest."""
    Q, P = torus().state()
    P[4] += 1e-3
    found = frequency_analysis(integrate(PAIR, Q, P, 50_000, step=0.125), lines=12, level=1e-9)
    assert set(found.seeds[:2]) == {1, 2}
    assert found.seeds[2] == 5
    assert found.count(1e-2) == 2


@pytest.mark.long
def test_an_error_covers_the_truth_where_lines_are_too_near_for_the_time():
    found = frequency_analysis(orbit(1000))
    real = errors(found)
    claimed = dict(zip(found.seeds, found.errors, strict=True))
    assert max(real) > FREQUENCY_OF_LINE
    assert all(error < claimed[q] for q, error in zip((1, 2), real, strict=True))


def known_lines(torus, found):
    """Of the lines next to a combination of the torus: how far they are off, and what they say of it."""
    s = len(torus.seeds)
    sums = [nu for nu in itertools.product(range(-9, 10), repeat=s) if sum(map(abs, nu)) <= 9]
    known = np.array(sums) @ np.array([float(w) for w in torus.frequencies])
    off = np.array([abs(known - line.frequency).min() for line in found.lines])
    near = off < 2 * np.pi / found.T
    return off[near], np.array([line.error for line in found.lines])[near]


@pytest.mark.parametrize(
    ("N", "law", "energy", "lengths"),
    [
        (16, {"alpha": "0.3"}, "0.01", (5.5, 8, 12)),
        pytest.param(16, {"beta": "0.5"}, "0.05", (5.5, 8, 12), marks=pytest.mark.long),
        (8, {"alpha": "1/3"}, "0.05", (8, 9.3)),
    ],
)
def test_what_an_orbit_is_too_short_to_tell_apart_is_in_every_error(N, law, energy, lengths):
    """2 omega_1 and omega_2 are a tenth to half a turn apart: one line in windows, up to 500 times further off than these said."""
    chain = Chain(N, **law)
    exact = refine(symfpu.torus(chain, (1, 2), energy=energy, method="series", order=4))
    rates = np.abs(exact.harmonics @ np.array([float(w) for w in exact.frequencies]))
    slowest, off = 2 * np.pi / chain.frequencies()[0], []
    for turns in lengths:
        found = frequency_analysis(integrate(chain, *exact.state(), turns * slowest, step=0.1, samples=2))
        assert 0 < found.unresolved < np.pi / found.T
        assert "too short to tell lines" in repr(found)
        for line in found.lines:
            own = np.abs(exact.cosines[:, line.mode - 1]) > 0.3 * line.amplitude
            off.append(np.abs(rates[own] - line.frequency).min() / line.error)
    assert max(off) < 4
    assert np.mean(np.array(off) < 1) > 0.95


def test_a_slow_line_that_climbs_to_zero_has_the_error_of_a_constant():
    """2 omega_1 - omega_2 of mode 2, a tenth of a turn: it was a frequency of 1e-54, off by its whole, with the error 1e-14."""
    chain = Chain(8, beta="0.5")
    exact = refine(symfpu.torus(chain, (1, 2), energy="0.05", method="series", order=4))
    time = 20 * 2 * np.pi / chain.frequencies()[0]
    found = frequency_analysis(integrate(chain, *exact.state(), time, step=0.1, samples=2))
    first, second = map(float, exact.frequencies)
    slow = [line for line in found.lines if line.mode == 2 and line.frequency < 2 * np.pi / time]
    assert len(slow) == 1  # it stood twice, as a constant and as a frequency of its own
    assert abs(2 * first - second) < slow[0].error


def test_a_breather_is_told_from_its_harmonics_at_any_length():
    """Its line in mode 2 is 2 omega_1 to rounding, not a frequency next to it."""
    breather = symfpu.torus(Chain(16, alpha="0.3"), (1,), amplitudes={1: "0.5"})
    found = frequency_analysis(integrate(breather.chain, *breather.state(), 200, step=0.1, samples=2))
    assert (found.seeds, found.unresolved) == ((1,), 0)
    assert found.errors[0] < CHANNEL_LINE


def test_lines_within_four_turns_of_each_other_are_told_and_named():
    """2 omega_1 and omega_2 are 2.5 turns apart in mode 2; an orbit ten times as long has them ten widths apart."""
    chain = Chain(8, alpha="0.33")
    start = packet_state(chain, (1,), "0.004")
    short, long = (frequency_analysis(integrate(chain, *start, T, step=0.2, samples=2)) for T in (1000, 10_000))
    turn = 2 * np.pi / 1000
    assert short.seeds[:2] == long.seeds[:2] == (1, 2)
    assert abs(2 * short.frequencies[0] - short.frequencies[1]) < 4 * turn
    off = np.abs(short.frequencies[:2] - long.frequencies[:2])
    assert (off <= short.errors[:2]).all()
    assert (short.errors[:2] < turn / 100).all()
    names = {line.harmonic[:2] for line in short.lines if line.mode <= 2 and line.harmonic}
    assert {(1, 0), (-1, 1), (2, 0), (0, 1)} <= names


@pytest.mark.parametrize(("scheme", "step"), [("yoshida4", 0.1), ("aba864", 0.2), ("kahan_li8", 0.4)])
def test_errors_are_not_below_the_shift_of_the_scheme(scheme, step):
    """A step of the scheme shifts frequencies by more than two windows differ; the error says so, and not much more."""
    breather = symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.3"})
    found = frequency_analysis(integrate(breather.chain, *breather.state(), 1000, step=step, scheme=scheme))
    real = abs(found.frequencies[0] - float(breather.frequency))
    assert real > FREQUENCY_OF_LINE
    assert real < found.errors[0] < 4 * real
    off, claimed = known_lines(breather, found)
    assert (off <= claimed).all()


def test_a_line_slower_than_a_turn_is_no_constant():
    """omega_2 - 2 omega_1 is 0.36 turns in mode 2: it was said to be 0 to 1e-15, twice; a chain whose V is even has no constant."""
    chain = Chain(8, beta=1)
    found = replace(refine(symfpu.torus(chain, (1, 2), energy="0.05", method="series", order=4)), phases={1: 0.3, 2: 1.1})
    exact = abs(float(found.frequencies[1] - 2 * found.frequencies[0]))
    analysis = frequency_analysis(integrate(chain, *found.state(), 150, step=0.1, scheme="kahan_li8", samples=4))
    turn = 2 * np.pi / 150
    assert exact < turn / 2
    slow = [line for line in analysis.lines if line.frequency == 0]
    assert {line.mode for line in slow} == {2, 4, 6}
    assert len(slow) == 3
    assert all(exact < line.error <= 1.01 * turn and line.harmonic is None for line in slow)


def test_a_constant_is_one():
    """Of V that is not even, over many turns of the slowest sum."""
    chain = Chain(6, alpha="0.3")
    found = refine(symfpu.torus(chain, (1, 2), energy="0.01", method="series", order=4))
    analysis = frequency_analysis(integrate(chain, *found.state(), 3000, step=0.1, scheme="kahan_li8", samples=4))
    constants = [line for line in analysis.lines if line.frequency == 0]
    assert [line.mode for line in constants] == [2, 4]
    assert all(line.harmonic == (0, 0) and line.error < 1e-3 * 2 * np.pi / 3000 for line in constants)


TORI = {
    "alpha": (Chain(8, alpha="0.3"), {1: "0.3", 2: "0.2"}),
    "beta": (Chain(8, beta="0.3"), {1: "0.4", 3: "0.2"}),
    "three": (Chain(12, alpha="0.2", beta="0.1"), {1: "0.1", 3: "0.05", 5: "0.04"}),
    "one, large": (Chain(2, beta=1), {1: "1"}),
}


@pytest.mark.long
def test_errors_hold_for_lines_of_all_strengths_at_all_times():
    ratios = []
    for (chain, amplitudes), T in itertools.product(TORI.values(), (250, 1000, 5000)):
        found = refine(symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=4))
        angles = {q: 0.3 + 0.8 * i for i, q in enumerate(found.seeds)}
        start = replace(found, phases=angles).state()
        for scheme, step in (("kahan_li8", 0.2), ("yoshida4", 0.1), ("aba864_modes", 0.4)):
            analysis = frequency_analysis(integrate(chain, *start, T, step=step, scheme=scheme, samples=4))
            off, claimed = known_lines(found, analysis)
            ratios += list(off / claimed)
    assert len(ratios) > 500
    assert np.mean(np.array(ratios) <= 1) > 0.95
    assert np.median(ratios) > 0.05


@pytest.mark.long
def test_a_chaotic_orbit_drifts():
    chain = Chain(N=8, alpha=1)
    start = fpu_trajectory(chain, {1: 0.6, 5: 0.3})
    found = frequency_analysis(integrate(chain, *start, 3000, step=0.1), lines=2)
    assert found.drift > 1e-3


@each(lines=[0], level=[2], windows=[0])
def test_bad_arguments_are_named(name, value):
    refused(frequency_analysis, name, value, orbit=integrate(Chain(N=2, beta=1), [0.1], [0.0], 200, step=0.1))


def test_orbits_that_cannot_be_analysed_are_refused():
    chain = Chain(N=4, beta=1)
    for T, many, words in ((20, (), "T = 20"), (-300, (), "forward"), (300, (2,), "2 orbits")):
        state = np.full((*many, 3), 0.1)
        with pytest.raises(InputError, match=words):
            frequency_analysis(integrate(chain, state, 0 * state, T, step=0.1))
    with pytest.raises(InputError, match="Orbit"):
        frequency_analysis(3)
    ring = Chain(N=4, beta=1, ends="periodic")
    Q = np.array([0.1, 0.1, 0.0], complex)
    with pytest.raises(InputError, match="fixed"):
        frequency_analysis(integrate(ring, Q, 0 * Q, 300, step=0.1))


def test_an_orbit_shorter_than_its_slowest_mode_is_refused():
    """5.3 turns: with fewer a line and its mirror image at -f are one, and errors of 1e-17 were claimed of numbers 24 % off."""
    chain = Chain(N=64, alpha="0.3")
    for modes, T, words in (
        ((1,), 300, "2.3 turns of mode 1.* at least 683, 5.3 turns"),
        ((3, 1), 682, "turns of mode 1"),
        ((2,), 300, "mode 2"),
    ):
        Q, P = packet_state(chain, modes, "1e-6")
        with pytest.raises(InputError, match=words):
            frequency_analysis(integrate(chain, Q, P, T, step=0.5))


@pytest.mark.long
def test_a_slow_chain_is_analysed_whole_where_channels_have_no_values(monkeypatch):
    """N = 256 to 8.8 turns of mode 1: 9000 samples, where sixteen values of a channel want 12,320."""
    chain = Chain(N=256, alpha="0.3")
    orbit = integrate(chain, *packet_state(chain, (1,), "1e-14"), 4500, step=0.5)
    found = frequency_analysis(orbit, lines=1)
    assert abs(found.omega[1] - chain.frequencies()[0]) < found.errors[0] < CHANNEL_LINE
    monkeypatch.setattr("symfpu.spectral.analysis.WHOLE", 1000)
    with pytest.raises(InputError, match=r"T = 4500.*at least 6160.*so slow"):
        frequency_analysis(orbit, lines=1)


def test_a_mode_at_rest_has_no_lines():
    """Seed 4 of five bonds, beta: modes 1 and 3 hold nothing but rounding, which has lines of its own."""
    breather = symfpu.torus(Chain(N=5, beta=1), (4,), amplitudes={4: "0.7"})
    found = frequency_analysis(integrate(breather.chain, *breather.state(), 400, step=0.1))
    assert {line.mode for line in found.lines} == {2, 4}
    assert found.seeds == (4,)


@pytest.mark.parametrize("level", [0, 1, 2, -0.5, "x"])
def test_a_count_is_above_a_part_of_the_strongest(level):
    found = frequency_analysis(orbit(300.0), lines=2)
    assert found.count(1e-3) >= 1
    with pytest.raises(InputError, match="level"):
        found.count(level)
