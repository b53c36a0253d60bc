"""Normal frequencies against Floquet's multipliers, integrated variations, Toda's exact ones, and closed forms."""

from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, floquet, integrate, lindstedt, normal_modes, refine, toda, toda_torus
from symfpu.dynamics.tangent import tangent_map_along
from symfpu.normal.resonances import DIFFERENCE, PARAMETRIC, SUM, resonances_of
from symfpu.normal.torus import second_order
from symfpu.paper.starts import printed_row, printed_torus
from tests import tolerances
from tests.normal.cases import assert_multipliers, torus
from tests.tolerances import GROWTH_OF_ORBIT, LAST_DIGIT, NORMAL_CONVERGED, NORMAL_VARIATION, OBSERVED_ORDER, ROUNDING, SIX_PLACES

TODA = Chain(6, potential=toda("1/2"))
HYPERBOLIC = (Chain(8, beta=1), {1: "0.1", 5: "0.7"})


def small():
    return torus(Chain(5, alpha="0.3", beta="0.2"), ((1, "0.2"), (3, "0.15")))


@cache
def hyperbolic():
    chain, amplitudes = HYPERBOLIC
    return normal_modes(torus(chain, tuple(amplitudes.items())), modes=(4, 6))


STABLE = ((Chain(4, beta=1), 2, "0.1"), (Chain(6, potential=toda(1)), 2, "0.3"))
UNSTABLE = (
    (Chain(4, alpha="0.5"), 2, "1"),
    (Chain(6, beta=1), 5, "1"),
    (Chain(6, alpha="0.5"), 3, "1"),
    (Chain(8, alpha="0.5", beta="0.25"), 2, "1.5"),
)


@pytest.mark.parametrize(
    ("chain", "seed", "amplitude"),
    [*STABLE, UNSTABLE[0], *(pytest.param(*case, marks=pytest.mark.long) for case in UNSTABLE[1:])],
    ids=repr,
)
def test_of_a_breather_they_are_the_multipliers(chain, seed, amplitude):
    breather = symfpu.torus(chain, (seed,), amplitudes={seed: amplitude})
    assert_multipliers(normal_modes(breather), floquet(breather))


def carried(solution, found, T):
    """How much exp(i sigma T) p(theta(T)) misses what the integrated variations make of p, over the latter; by mode."""
    omega = np.array([float(w) for w in solution.frequencies])
    stretches = solution.chain.stretches(solution.cosines)
    rates = solution.harmonics @ omega

    def along(t):
        return np.cos(np.multiply.outer(t, rates)) @ stretches

    M = tangent_map_along(solution.chain, along, T, int(20 * T))
    for mode in found.modes:
        inner = 1j * (mode.sigma + mode.rates)

        def state(t, inner=inner, mode=mode):
            turned = np.exp(inner * t)
            return np.concatenate([turned @ mode.coefficients, (inner * turned) @ mode.coefficients])

        yield np.abs(M @ state(0.0) - state(T)).max()


def test_variations_turn_with_them():
    found = normal_modes(small())
    assert [mode.mode for mode in found.modes] == [2, 4]
    assert all(error < NORMAL_VARIATION for error in carried(small(), found, 100.0))


def test_todas_are_those_of_its_spectral_curve():
    solution = torus(TODA, ((1, "0.2"), (3, "0.15")))
    exact = toda_torus(TODA, (1, 3), frequencies=solution.frequencies, digits=18).normal_frequencies
    found = normal_modes(solution).frequencies
    assert found.keys() == exact.keys()
    assert all(abs(found[q] - float(w)) < tolerances.NORMAL_CONVERGED for q, w in exact.items())


def test_what_follows_the_closed_shift_is_of_fourth_order():
    chain = Chain(5, alpha="0.3", beta="0.2")
    left = []
    for scale in (1, 2):
        solution = torus(chain, ((1, f"{scale * 0.02}"), (3, f"{scale * 0.03}")), 4)
        closed = second_order(solution)
        found = normal_modes(solution).frequencies
        left.append([abs(found[q] - closed[q]) for q in found])
    assert np.log2(np.divide(left[1], left[0])) == pytest.approx(4, abs=OBSERVED_ORDER)


@pytest.mark.long
def test_a_hyperbolic_torus_is_found_with_its_quartet():
    found = hyperbolic()
    assert not found.stable
    by_mode = {mode.mode: mode for mode in found.modes}
    assert [q for q, mode in by_mode.items() if mode.growth] == [4, 6]
    assert complex(by_mode[4].sigma) == pytest.approx(1.577380 + 0.035136j, abs=SIX_PLACES)
    assert by_mode[6].growth == pytest.approx(by_mode[4].growth, rel=tolerances.NORMAL_MULTIPLIER)
    for mode in found.modes:  # Krein's form of an eigenvector whose conjugate is no partner vanishes
        assert mode.signature == 0
        assert abs(mode.action) < NORMAL_VARIATION
    pair = found.resonances[0]
    assert (pair.kind, pair.modes, pair.harmonic) == (SUM, (4, 6), (0, 2))
    assert abs(pair.distance) < ROUNDING


@pytest.mark.long
def test_variations_of_a_hyperbolic_torus_shrink_with_its_rate():
    found = hyperbolic()
    assert all(error < NORMAL_VARIATION for error in carried(found.torus, found, 30.0))


@pytest.mark.long
def test_an_orbit_beside_a_hyperbolic_torus_leaves_it_at_its_rate():
    """Nonlinear, from the torus and 1e-8 along the growing eigenfunction, while that grows to 1e-4."""
    found = hyperbolic()
    solution, mode = found.torus, found.mode(4)
    turning = 1j * (complex(mode.sigma).real + mode.rates)

    def eigenfunction(t):
        """Q and P of the growing solution, without its growth."""
        p = np.exp(np.multiply.outer(t, turning)) @ mode.coefficients.conj()
        rate = turning + mode.growth
        dp = (np.exp(np.multiply.outer(t, turning)) * rate) @ mode.coefficients.conj()
        return np.concatenate([p.real, dp.real], axis=-1)

    start = 1e-8 * eigenfunction(0.0)
    Q, P = np.split(start, 2)
    times = np.arange(70.0, 260.0, 2.0)
    orbit = integrate(solution.chain, solution.Q(0.0) + Q, solution.P(0.0) + P, 260.0, step=0.05, samples=times)
    off = np.concatenate([orbit.Q - solution.Q(orbit.times), orbit.P - solution.P(orbit.times)], axis=-1)
    sizes = np.linalg.norm(off, axis=-1) / np.linalg.norm(eigenfunction(orbit.times), axis=-1)
    rate, _ = np.polyfit(orbit.times, np.log(sizes), 1)
    assert rate == pytest.approx(mode.growth, rel=GROWTH_OF_ORBIT)


def test_resonances_are_the_nearest_and_keep_the_selection_rules():
    chain, omega, sigma = Chain(6, beta=1), (0.5,), {2: 0.99, 4: 1.7}
    found = {(r.kind, r.modes): r for r in resonances_of(chain, (1,), omega, sigma, 8)}
    parametric = found[PARAMETRIC, (2,)]
    assert parametric.harmonic == (4,)
    assert parametric.distance == pytest.approx(-0.02)
    assert found[SUM, (2, 4)].harmonic in {(6,), (4,)}
    assert found[DIFFERENCE, (2, 4)].distance == pytest.approx(-0.71 + 1.0)
    assert all(sum(r.harmonic) % 2 == (r.kind == "own") for r in found.values())


def test_a_torus_that_is_not_refined_is_refused():
    rough = symfpu.solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 3))
    with pytest.raises(InputError, match=r"residual.*refine\(solution\)"):
        normal_modes(rough)


@pytest.mark.parametrize(
    ("options", "message"),
    [({"modes": [1]}, "no seeds"), ({"modes": [9]}, "^modes"), ({"resonance_length": 0}, "resonance_length")],
)
def test_arguments_out_of_range_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        normal_modes(small(), **options)


def test_what_is_no_solution_is_refused():
    with pytest.raises(InputError, match="a solution"):
        normal_modes(3)


def test_a_mode_is_asked_for_by_its_number():
    found = normal_modes(small(), modes=[4])
    assert list(found.frequencies) == [4]
    assert found.mode(4) is found.modes[0]
    with pytest.raises(InputError, match="q = 2"):
        found.mode(2)


def test_two_particles_have_one_and_one_has_none():
    assert list(normal_modes(symfpu.torus(Chain(3, alpha=1), (1,), amplitudes={1: "0.1"})).frequencies) == [2]
    alone = normal_modes(symfpu.torus(Chain(2, beta=1), (1,), amplitudes={1: "0.5"}))
    assert alone.frequencies == {}
    assert alone.stable
    assert alone.residual == 0


@pytest.mark.long
def test_frequencies_of_fig1_are_good_to_1e_12():
    """Of doubles against 20 digits: residuals of 4e-11 leave errors of about their square. Mode 3 has the smallest divisor."""
    torus = refine(printed_torus(printed_row("Fig. 1")))
    modes = [3, 4, 14]
    doubles, precise = (normal_modes(each, modes=modes) for each in (torus, refine(torus, digits=20)))
    for q in modes:
        mode = precise.mode(q)
        assert mode.error < LAST_DIGIT
        assert abs(float(doubles.frequencies[q] / mode.sigma - 1)) < NORMAL_CONVERGED


@pytest.mark.long
def test_fig1_all_thirteen():
    """By integrated variations; the harmonics that are left out do not count."""
    solution = refine(printed_torus(printed_row("Fig. 1")))
    found = normal_modes(solution)
    assert len(found.modes) == 13
    assert found.stable
    assert all(error < NORMAL_VARIATION for error in carried(solution, found, 100.0))
