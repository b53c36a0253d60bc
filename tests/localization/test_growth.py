"""Growth of the groups of modes against power laws, first-order theory and the paper."""

import numpy as np
import pytest

from symfpu import Chain, excitation_sequence, fpu_trajectory, growth_exponents, integrate, packet_amplitudes
from symfpu.paper.printed import APPENDIX_F
from tests.localization.refusals import refused
from tests.tolerances import FIRST_ORDER_THEORY, GROWTH_EXPONENT, LEAST_SQUARES, SLOPE, THOUSAND_ROUNDINGS, TWO_DIGITS

FIG2 = APPENDIX_F[0]

LOW = (1, 2, 3, 4)

CHAIN = Chain(4, alpha=1)


def first_order(chain, A, q, t):
    """E_q(t) at first order in alpha: Q'' + Omega^2 Q = -mu Omega_q sum B Omega_l Omega_m A_l A_m cos(Omega_l t) cos(Omega_m t)."""
    Omega = dict(enumerate(chain.frequencies(), 1))
    Q, P = np.zeros_like(t), np.zeros_like(t)
    for l, m in ((l, m) for l in A for m in A):
        force = -chain.mu * Omega[q] * chain.B(q, l, m) * Omega[l] * Omega[m] * A[l] * A[m] / 2
        for w in (Omega[l] + Omega[m], Omega[l] - Omega[m]):
            Q += force / (Omega[q] ** 2 - w**2) * (np.cos(w * t) - np.cos(Omega[q] * t))
            P += force / (Omega[q] ** 2 - w**2) * (Omega[q] * np.sin(Omega[q] * t) - w * np.sin(w * t))
    return (P**2 + Omega[q] ** 2 * Q**2) / 2


def test_exponents_of_power_laws_with_saturation():
    chain, groups = Chain(16, alpha=1), [(1, 2), (3, 4), (5, 6, 7)]
    t = np.concatenate([[0.0], np.geomspace(0.5, 1e6, 500)])
    slope = {3: 2.0, 4: 2.3, 5: 3.9, 6: 4.1, 7: 4.3}
    knee = {3: 2e3, 4: 1e3, 5: 3e2, 6: 1e9, 7: 2e2}
    Ebar = np.zeros((len(t), 15))
    for q, c in slope.items():
        Ebar[:, q - 1] = 10.0**-q * np.minimum(t / knee[q], 1.0) ** c
    found = growth_exponents(chain, t, Ebar, groups)
    assert found.modes.tolist() == [3, 4, 5, 6, 7]
    assert found.orders.tolist() == [1, 1, 2, 2, 2]
    assert found.exponents == pytest.approx(list(slope.values()), abs=THOUSAND_ROUNDINGS)
    assert found.halves == pytest.approx(np.array(list(slope.values()))[:, None] * [1, 1], abs=LEAST_SQUARES)
    assert (found.errors < THOUSAND_ROUNDINGS).all()
    spacing = t[2] / t[1]
    expected = [knee[q] * 0.9 ** (1 / slope[q]) for q in (3, 4, 5, 7)]
    late = found.saturation[[0, 1, 2, 4]] / expected
    assert (late >= 1).all()
    assert (late <= spacing).all()
    assert np.isnan(found.saturation[3])  # still growing
    # from half a period of the slowest seed to a quarter of the last value
    assert found.windows[:, 0] == pytest.approx(np.pi / chain.frequencies()[0])
    assert found.windows[0, 1] == pytest.approx(knee[3] / 2, rel=spacing - 1)
    first, second = found.groups
    assert (first.order, first.modes, second.modes) == (1, (3, 4), (5, 6, 7))
    assert (first.mean, first.spread) == pytest.approx((2.15, 0.15), abs=THOUSAND_ROUNDINGS)
    assert (second.mean, second.spread) == pytest.approx((4.1, 0.2), abs=THOUSAND_ROUNDINGS)
    assert first.saturation == (found.saturation[1], found.saturation[0])
    assert "D_1 (2 modes): c = 2.15, spread 0.15, saturated at" in repr(found)


def test_error_of_an_exponent_is_that_of_least_squares():
    t = np.geomspace(1.0, 1e3, 200)
    Ebar = np.zeros((200, 3))
    scatter = np.random.default_rng(5).normal(scale=0.3, size=(400, 200))
    found = []
    for noise in scatter:
        Ebar[:, 1] = t**2 * np.exp(noise)
        found.append(growth_exponents(Chain(4, alpha=1), t, Ebar, [(1,), (2,)], window=(1.0, 1e3)))
    exponents, errors = (np.array([getattr(g, name)[0] for g in found]) for name in ("exponents", "errors"))
    # a standard deviation from n samples is known to 1/sqrt(2n)
    assert errors.mean() == pytest.approx(exponents.std(), rel=4 / (2 * len(found)) ** 0.5)
    assert exponents.mean() == pytest.approx(2.0, abs=4 * exponents.std() / 20)


def test_modes_without_a_stage_of_growth_have_no_exponent():
    t = np.geomspace(0.1, 1e4, 100)
    Ebar = np.ones((100, 3))
    Ebar[:, 2] = 0
    found = growth_exponents(Chain(4, alpha=1), t, Ebar, [(1,), (2,), (3,), ()])
    assert np.isnan(found.exponents).all()
    assert "D_1 (1 mode): no stage of growth, saturated at 0.1 .. 0.1; D_2 (1 mode): no stage of growth, not saturated" in repr(found)


def test_modes_of_D_1_grow_as_first_order_theory_says():
    """And with the exponent 2 over both stages, but for what happens between them."""
    chain, A = Chain(16, alpha="0.33"), {1: 1e-5, 2: 2e-5}
    groups = excitation_sequence(16, (1, 2), 1)
    orbit = integrate(chain, *fpu_trajectory(chain, A), 4000.0, step=0.25, samples=300, averages=True)
    t = np.arange(0, 4000.25, 0.5)
    theory = np.zeros((len(orbit.times), 15))
    for q in groups[1]:
        E = first_order(chain, A, q, t)
        whole = np.concatenate([[0], np.cumsum(E[1:] + E[:-1]) / 2])  # the rule of the averages
        looks = np.rint(orbit.times / 0.5).astype(int)
        theory[1:, q - 1] = whole[looks[1:]] / looks[1:]
    # the next order is smaller by mu A over the detuning of 0.006
    assert orbit.averages[1:, 2:4] == pytest.approx(theory[1:, 2:4], rel=FIRST_ORDER_THEORY)
    measured, exact = (growth_exponents(chain, orbit.times, values, groups) for values in (orbit.averages, theory))
    assert measured.exponents == pytest.approx(exact.exponents, abs=FIRST_ORDER_THEORY)
    assert measured.saturation == pytest.approx(exact.saturation)
    assert measured.exponents == pytest.approx(2.0, abs=GROWTH_EXPONENT)


def test_groups_start_with_the_power_4k_minus_2():
    """Forces that keep their sign: Q_q ~ t^(2k), P_q ~ t^(2k-1); corrections (Omega t)^2 with Omega_16 = 0.77."""
    chain = Chain(64, alpha="0.33")
    Q, P = fpu_trajectory(chain, packet_amplitudes(chain, LOW, "1e-6"))
    orbit = integrate(chain, Q, P, 0.6, step=0.005, scheme="aba864_modes", samples=np.linspace(0, 0.6, 121))
    E, t = orbit.harmonic_energies(), orbit.times
    sums = np.cumsum(E[1:] + E[:-1], axis=0) / 2 / np.arange(1, len(t))[:, None]
    found = growth_exponents(chain, t[1:], sums, excitation_sequence(64, LOW, 4), window=(0.2, 0.6))
    assert [g.mean for g in found.groups] == pytest.approx([2, 6, 10, 14], rel=TWO_DIGITS)


def test_groups_of_a_long_chain_grow_with_the_power_2k():
    """N = 256: between pi / Omega_1 = 256 and one over the detuning, 2e4 for D_1 to D_3. Not with (3/2) k (section 4.1)."""
    chain = Chain(256, alpha="0.33")
    groups = excitation_sequence(256, LOW, 3)
    Q, P = fpu_trajectory(chain, packet_amplitudes(chain, LOW, "5.12e-8"))
    orbit = integrate(chain, Q, P, 5000.0, step=0.5, samples=300, averages=True)
    found = growth_exponents(chain, orbit.times, orbit.averages, groups, window=(1000, 5000))
    # the sinc of the detuning bends D_3 by some k (t delta)^2 / 6
    for group, expected, within in zip(found.groups, (2, 4, 6), (0.01, 0.02, 0.06), strict=True):
        assert abs(group.mean - expected) + group.spread < within


def test_the_exponents_of_the_paper_are_those_of_a_window_over_both_stages():
    """Fig. 3(a): (3/2) k from a line through t = 1 .. 100; from half a period of mode 1 on, D_1 has the exponent 2 of theory."""
    groups = excitation_sequence(32, LOW, 3)
    Q, P = fpu_trajectory(FIG2.chain, dict(zip(FIG2.seeds, FIG2.amplitudes, strict=True)))
    orbit = integrate(FIG2.chain, Q, P, 1e4, step=0.25, samples=400, averages=True)
    read = growth_exponents(FIG2.chain, orbit.times, orbit.averages, groups, window=(1, 100))
    assert [g.mean for g in read.groups] == pytest.approx([1.5, 3.0, 4.5], abs=GROWTH_EXPONENT)
    own = growth_exponents(FIG2.chain, orbit.times, orbit.averages, groups)
    first, second, third = own.groups
    assert first.mean - first.spread > 1.85
    assert second.mean == pytest.approx(3.5, abs=SLOPE)
    # no power law: the window is over before it is reached
    assert (own.halves[own.orders == 3] @ [1, -1] > 1.3).all()
    # "of order 1e3 for the modes 5 .. 8, and 1e2 for the remaining ones"
    assert 150 < first.saturation[0] < 200 < 800 < first.saturation[1] < 900
    assert all(150 < g.saturation[0] <= g.saturation[1] < 450 for g in (second, third))


def test_bad_records_of_growth_are_refused():
    t, E = np.arange(1.0, 11.0), np.ones((10, 3))
    groups = [(1,), (2,), (3,)]
    refused("chain", growth_exponents, 7, t, E, groups)
    refused("averages", growth_exponents, CHAIN, t, None, groups)
    refused("averages", growth_exponents, CHAIN, t, E[:, :2], groups)
    refused("averages", growth_exponents, CHAIN, t, E[:9], groups)
    refused("averages", growth_exponents, CHAIN, t, E[:, None], groups)
    refused("times", growth_exponents, CHAIN, t[::-1], E, groups)
    refused("times", growth_exponents, CHAIN, t * float("nan"), E, groups)
    for seeds in (None, [1, 2], []):
        refused("groups", growth_exponents, CHAIN, t, E, seeds)
    refused("groups", growth_exponents, CHAIN, t, E, [(1,), (1, 2)])
    for seeds in ([(1,)], [(), (2,)], [(1,), (2,), (2,)], [(1,), (4,)]):
        refused("seeds", growth_exponents, CHAIN, t, E, seeds)
    for window in (3, (1,), (0, 5), (4, 7), (5, 2), (20, 80), (1, float("inf")), "ab"):
        refused("window", growth_exponents, CHAIN, t, E, groups, window=window)
