"""Finite-gap tori: exact values, limits, dH/dI = omega, orbits that return, Floquet exponents, both ends the same."""

from functools import cache

import mpmath
import numpy as np
import pytest

from symfpu import Chain, InputError, toda, toda_gaps, toda_invariants, toda_torus
from tests.integrable.chains import orbit, ring_of, tangent_map
from tests.refusals import each, refused
from tests.tolerances import FLOQUET_OF_TODA, FORTY_DIGITS, GAP, LAST_OF_TWELVE, RETURN_OF_TODA, SMALL_ACTION, THIRTY_DIGITS, TODA_LINEAR

CHAIN, SMALL = (Chain(N, potential=toda("1/2")) for N in (8, 5))
GIVEN_ENERGY = 0.024682999677  # N = 8, a = 1/2, seed 1, omega = 0.392; source: issue, computed independently


def numbers(mapping):
    return np.array(list(mapping.values()), dtype=object)


def test_the_printed_energy():
    torus = toda_torus(CHAIN, (1,), frequencies=("0.392",))
    assert abs(torus.energy - GIVEN_ENERGY) < LAST_OF_TWELVE
    assert repr(torus).startswith("TodaTorus(N=8, a=0.5, fixed ends, seeds=1, H = 0.02468299967712")


@pytest.mark.parametrize("seeds", [(1,), (1, 2, 3, 4)])
def test_frequencies_and_actions_ask_for_the_same_torus(seeds):
    asked = [f"0.0{q}" for q in range(1, len(seeds) + 1)]
    torus = toda_torus(CHAIN, seeds, actions=asked, digits=40)
    assert max(abs(numbers(torus.actions) - [mpmath.mpf(x) for x in map(float, asked)])) < GAP
    again = toda_torus(CHAIN, seeds, frequencies=list(torus.frequencies.values()), digits=40)
    assert abs(again.energy - torus.energy) < FORTY_DIGITS
    assert max(abs(numbers(again.actions) - numbers(torus.actions))) < FORTY_DIGITS


def test_more_digits_give_the_same_numbers():
    forty, seventy = (toda_torus(SMALL, (1, 3), actions=("0.1", "0.1"), digits=digits) for digits in (40, 70))
    assert abs(forty.energy - seventy.energy) < FORTY_DIGITS
    assert max(abs(numbers(forty.normal_frequencies) - numbers(seventy.normal_frequencies))) < FORTY_DIGITS


@pytest.mark.parametrize("ends", ["fixed", "periodic"])
def test_small_actions_give_the_harmonic_chain_and_the_normal_form(ends):
    """omega_q = Omega_q + (2 a^2 / n) I_q, and H = sum Omega_q I_q + (a^2 / n) sum I_q^2; n = 2N or N."""
    fast = 5 if ends == "fixed" else -3
    torus = toda_torus(Chain(8, potential=toda("1/2"), ends=ends), (1, fast), actions=("1e-12", "2e-12"), digits=20)
    with mpmath.workdps(50):
        n = 16 if ends == "fixed" else 8
        linear = {q: 2 * mpmath.sinpi(mpmath.mpf(abs(q)) / n) for q in range(-4, 8)}
        actions = {1: mpmath.mpf("1e-12"), fast: mpmath.mpf("2e-12")}
        for q, action in actions.items():
            assert abs((torus.frequencies[q] - linear[q]) / (action / (2 * n)) - 1) < TODA_LINEAR
        for q, omega in torus.normal_frequencies.items():
            assert abs(omega - linear[q]) < TODA_LINEAR * actions[1]
        first = sum(linear[q] * actions[q] for q in actions)
        second = sum(action**2 for action in actions.values()) / (4 * n)
        assert abs((torus.energy - first) / second - 1) < TODA_LINEAR


@pytest.mark.long
@pytest.mark.parametrize("ends", ["fixed", "periodic"])
def test_frequencies_are_derivatives_of_the_energy_by_the_actions(ends):
    step, chain = mpmath.mpf("1e-16"), Chain(4, potential=toda("1/2"), ends=ends)
    with mpmath.workdps(60):
        actions = [mpmath.mpf("0.03"), mpmath.mpf("0.02")]
        torus = toda_torus(chain, (1, 2), actions=actions, digits=45)
        for k, q in enumerate(torus.seeds):
            moved = [[x + sign * step * (i == k) for i, x in enumerate(actions)] for sign in (1, -1)]
            up, down = (toda_torus(chain, (1, 2), actions=x, digits=45).energy for x in moved)
            assert abs((up - down) / (2 * step) - torus.frequencies[q]) < THIRTY_DIGITS


@pytest.mark.long
def test_normal_frequencies_are_the_limit_of_an_open_gap():
    torus = toda_torus(SMALL, (1,), actions=("0.1",), digits=20)
    nearly = toda_torus(SMALL, (1, 3), actions=("0.1", "1e-12"), digits=20)
    assert abs(nearly.frequencies[3] - torus.normal_frequencies[3]) < SMALL_ACTION
    assert abs(nearly.normal_frequencies[2] - torus.normal_frequencies[2]) < SMALL_ACTION


@pytest.mark.parametrize("N", [3, 4])
def test_fixed_ends_are_the_odd_part_of_the_ring(N):
    chain, ring = Chain(N, potential=toda("1/2")), Chain(2 * N, potential=toda("1/2"), ends="periodic")
    fixed = toda_torus(chain, (1, 2), actions=("0.03", "0.02"), digits=30)
    seeds, actions = (1, 2, -2, -1), ("0.03", "0.02", "0.02", "0.03")
    whole = toda_torus(ring, seeds, actions=actions, digits=30)
    with mpmath.workdps(40):
        assert abs(whole.energy - 2 * fixed.energy) < THIRTY_DIGITS
    for q in (1, 2):
        for place in (q, -q):
            assert abs(whole.frequencies[place] - fixed.frequencies[q]) < THIRTY_DIGITS
            assert abs(whole.gaps[place] - fixed.gaps[q]) < THIRTY_DIGITS
    x, p = whole.particles({-1: 1, -2: 1})  # sin of the mirrored wave has the other sign
    with mpmath.workdps(40):
        odd, _ = ring_of(*fixed.particles())
        assert max(abs(x - odd)) < THIRTY_DIGITS
        assert max(abs(p)) < THIRTY_DIGITS


@cache
def torus_of_two(a):
    return toda_torus(Chain(5, potential=toda(a)), (1, 3), actions=("0.02", "0.01"), digits=30)


@pytest.mark.parametrize("a", ["1/2", "-2"])
@pytest.mark.parametrize("phases", [{}, {1: 1}, {3: 1}])
def test_a_state_lies_on_the_torus(a, phases):
    chain, torus = Chain(5, potential=toda(a)), torus_of_two(a)
    Q, P = torus.state(phases)
    with mpmath.workdps(45):
        assert abs(chain.energy(Q, P) - torus.energy) < THIRTY_DIGITS
    assert [Q[q - 1] > 0 for q in (1, 3)] == [not phases.get(q) for q in (1, 3)]
    found = toda_invariants(chain, Q, P, digits=30)
    expected = np.array([torus.gaps.get(q, mpmath.mpf(0)) for q in range(1, 5)])
    assert max(abs(found.gaps - expected)) < THIRTY_DIGITS
    exact = torus.frequencies | torus.normal_frequencies
    assert max(abs(found.frequencies[q - 1] - exact[q]) for q in exact) < THIRTY_DIGITS
    assert max(abs(found.actions[q - 1] - torus.actions[q]) for q in torus.seeds) < THIRTY_DIGITS


@pytest.mark.parametrize("q", [2, -3])
def test_a_ring_of_the_package_has_the_gap_of_its_wave(q):
    """The state of a one-wave torus, read in modes: the gap, action and frequencies of that mode; x_j ~ sin(2 pi q j/N - omega t)."""
    chain = Chain(9, potential=toda("1/2"), ends="periodic")
    torus = toda_torus(chain, (q,), actions=("0.01",))
    x, p = (y.astype(float) for y in torus.particles())
    found = toda_invariants(chain, chain.modes(x), chain.modes(p))
    place = chain.mode_numbers.index(q)
    assert found.gaps[place] == pytest.approx(float(torus.gaps[q]), abs=GAP)
    assert found.actions[place] == pytest.approx(0.01, abs=GAP)
    assert abs(np.delete(found.gaps, place)).max() < GAP
    exact = torus.frequencies | torus.normal_frequencies
    assert found.frequencies == pytest.approx([float(exact[m]) for m in chain.mode_numbers], abs=GAP)
    angles = 2 * np.pi * q * np.arange(9) / 9
    assert x @ np.sin(angles) > 0
    assert p @ np.cos(angles) < 0
    with pytest.raises(InputError, match="None on a ring"):
        toda_gaps(chain, chain.modes(x), chain.modes(p), digits=20)


@pytest.mark.parametrize("frequencies", [("1.13",), ("1.12", "1.68")])
@pytest.mark.parametrize("ends", ["fixed", "periodic"])
def test_orbits_return_after_the_common_period(frequencies, ends):
    """Frequencies in the ratio 2 : 3 make every orbit periodic: the period is measured by the orbit itself."""
    chain = Chain(8 if ends == "fixed" else 16, potential=toda("1/2"), ends=ends)
    seeds, basic = (3, 5)[: len(frequencies)], float(frequencies[0]) / len(frequencies)
    torus = toda_torus(chain, seeds, frequencies=frequencies)
    x, p = torus.particles()
    x, p = ring_of(x, p) if ends == "fixed" else (x, p)
    x, p = x.astype(float), p.astype(float)
    period = 2 * np.pi / basic
    states = orbit(x, p, 0.5, [0, period / 3, period])
    assert abs(states[-1] - states[0]).max() < RETURN_OF_TODA
    assert abs(states[1] - states[0]).max() > 0.1


@pytest.mark.parametrize(("N", "seed", "ends"), [(5, 1, "fixed"), (4, 3, "fixed"), (5, 1, "periodic"), (6, -2, "periodic")])
def test_normal_frequencies_are_floquet_exponents_of_breathers(N, seed, ends):
    torus = toda_torus(Chain(N, potential=toda("1/2"), ends=ends), (seed,), actions=("0.5",))
    x, p = torus.particles()
    period = 2 * np.pi / float(torus.frequencies[seed])
    if ends == "fixed":
        x, p = ring_of(x, p)
    multipliers = np.linalg.eigvals(tangent_map(x.astype(float), p.astype(float), 0.5, period))
    for omega in torus.normal_frequencies.values():
        expected = np.exp(1j * float(omega) * period)
        for value in (expected, expected.conjugate()):
            assert abs(multipliers - value).min() < FLOQUET_OF_TODA


@pytest.mark.parametrize("action", ["1e-30", "8"])
def test_from_tiny_to_large_actions(action):
    torus = toda_torus(SMALL, (1,), actions=(action,), digits=20)
    Q, P = torus.state()
    with mpmath.workdps(60):
        assert abs(SMALL.energy(Q, P) / torus.energy - 1) < TODA_LINEAR


@pytest.mark.long
def test_four_seeds_of_a_long_chain():
    chain = Chain(32, potential=toda("0.33"))
    asked = ("0.0982", "0.1962", "0.2939", "0.3911")
    torus = toda_torus(chain, (1, 2, 3, 4), frequencies=asked, digits=40)
    Q, P = torus.state()
    with mpmath.workdps(60):
        assert abs(chain.energy(Q, P) - torus.energy) < FORTY_DIGITS
    found = toda_invariants(chain, Q, P, digits=40)
    assert max(abs(found.frequencies[q - 1] - torus.frequencies[q]) for q in torus.seeds) < FORTY_DIGITS


@each(actions=["1", (0,), ("x",), ("0.1", "0.2")], seeds=[(1, 1), (8,)], a=[0], digits=[0, 10**6])
def test_bad_input_is_refused_by_name(name, value):
    refused(toda_torus, name, value, chain=CHAIN, seeds=(1,), actions=(1,))


@pytest.mark.parametrize("options", [{}, {"frequencies": ("0.4",), "actions": ("1",)}, {"frequencies": ("0.39",)}])
def test_frequencies_or_actions_are_asked_for(options):
    with pytest.raises(InputError, match=r"^frequencies, "):
        toda_torus(CHAIN, (1,), **options)


def test_a_ring_of_two_and_states_that_are_not_there_are_refused():
    with pytest.raises(InputError, match="at least 3 on a ring"):
        toda_torus(Chain(2, alpha=1, ends="periodic"), (1,), actions=(1,))
    ring = toda_torus(Chain(4, alpha=1, ends="periodic"), (1,), actions=(1,))
    with pytest.raises(InputError, match="particles"):
        ring.state()
    with pytest.raises(InputError, match="name seeds of the torus"):
        ring.particles({2: 1})
    with pytest.raises(InputError, match="half turns"):
        ring.particles({1: 0.5})
