"""Spectra: FPU-trajectories, packets, profiles; growth of the groups against first-order theory and the paper; recurrences."""

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.chain.propagation import excitation_sequence
from symfpu.dynamics.orbits import integrate
from symfpu.errors import InputError
from symfpu.localization.growth import growth_exponents
from symfpu.localization.laws import fit_profile, profile_law
from symfpu.localization.profiles import fpu_trajectory, normalised_averages, packet_amplitudes, profile_distance
from symfpu.localization.recurrence import NoRecurrence, recurrence
from symfpu.paper.printed import APPENDIX_F, FIG9_BREATHER
from tests.tolerances import ROUNDING

FIG2 = APPENDIX_F[0]
LOW = (1, 2, 3, 4)


def test_fpu_trajectory_is_definition_4():
    chain = Chain(8, alpha=1, beta="1/3")
    A, phi = {2: 0.3, 5: "-0.1"}, {5: 0.7}
    Q, P = fpu_trajectory(chain, A, phi)
    expected_Q, expected_P = np.zeros(7), np.zeros(7)
    expected_Q[[1, 4]] = 0.3, -0.1 * np.cos(0.7)
    expected_P[4] = 0.1 * chain.frequencies()[4] * np.sin(0.7)
    assert np.array_equal(Q, expected_Q)
    assert pytest.approx(expected_P, rel=ROUNDING) == P
    assert not np.signbit(P[[0, 1, 2, 3, 5, 6]]).any()


def test_a_nearly_harmonic_chain_keeps_the_energies_of_the_modes():
    chain = Chain(8, alpha="1e-20")
    Q, P = fpu_trajectory(chain, {2: 0.3, 5: 0.1}, {2: 1.0, 5: 2.0})
    orbit = integrate(chain, Q, P, 100.0, step=0.25, scheme="aba864_modes", samples=20)
    start = chain.harmonic_energies(Q, P)
    assert orbit.harmonic_energies() == pytest.approx(np.broadcast_to(start, orbit.Q.shape), abs=1e-13)  # 400 exact rotations, each rounded


@pytest.mark.parametrize("share", ["energy", "amplitude"])
def test_packets_have_the_harmonic_energy_asked_for(share):
    chain = Chain(32, alpha="0.33")
    A = packet_amplitudes(chain, (3, 4, 7), "0.125", share=share)
    E = chain.harmonic_energies(*fpu_trajectory(chain, A, {3: 1, 4: 2.5, 7: 4}))
    assert E.sum() == pytest.approx(0.125, rel=ROUNDING)
    alike = [E[2], E[3], E[6]] if share == "energy" else list(A.values())
    assert alike == pytest.approx([alike[0]] * 3, rel=ROUNDING)
    assert list(A) == [3, 4, 7]


def test_normalised_averages_are_those_of_the_paper():
    chain = Chain(16, alpha="0.33")
    starts = [fpu_trajectory(chain, {1: 0.5}), fpu_trajectory(chain, {1: 0.2, 2: 0.1})]
    Q, P = (np.stack(part) for part in zip(*starts, strict=True))
    orbits = integrate(chain, Q, P, 50.0, step=0.25, samples=5, averages=True)
    spectra = normalised_averages(orbits)
    assert spectra.shape == orbits.Q.shape
    # H counts the anharmonic energy, a few per cent, which is no E_q
    assert spectra.sum(axis=-1) == pytest.approx(1, abs=0.03)
    assert spectra * orbits.energies[0][:, None] == pytest.approx(orbits.averages, rel=ROUNDING)
    with pytest.raises(InputError, match="averages=True"):
        normalised_averages(integrate(chain, Q, P, 50.0, step=0.25, samples=5))
    with pytest.raises(InputError, match="positive energy"):
        normalised_averages(integrate(chain, 0 * Q, 0 * P, 50.0, step=0.25, samples=5, averages=True))


def test_distance_of_profiles():
    a = np.array([1.0, 1e-3, 1e-9, 0.0, 1e-26])
    b = np.array([1.0, 5e-3, 1e-13, 1e-20, 1e-24])
    near = profile_distance(a, b, 1e-8)
    assert (near.mode, near.modes) == (2, 2)
    assert near.distance == pytest.approx(np.log10(5), rel=ROUNDING)
    far = profile_distance(b, a, 1e-12)  # the smaller one counts as the floor
    assert (far.mode, far.modes) == (3, 3)
    assert far.distance == pytest.approx(3.0, rel=ROUNDING)
    assert profile_distance(a, b, 2.0).distance == 0


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
    assert found.exponents == pytest.approx(list(slope.values()), abs=1e-12)
    assert found.halves == pytest.approx(np.array(list(slope.values()))[:, None] * [1, 1], abs=1e-10)
    assert (found.errors < 1e-12).all()
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
    assert (first.mean, first.spread) == pytest.approx((2.15, 0.15), abs=1e-12)
    assert (second.mean, second.spread) == pytest.approx((4.1, 0.2), abs=1e-12)
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
    # a standard deviation from 400 samples is known to 1/sqrt(800)
    assert errors.mean() == pytest.approx(exponents.std(), rel=4 / 800**0.5)
    assert exponents.mean() == pytest.approx(2.0, abs=4 * exponents.std() / 20)


def test_modes_without_a_stage_of_growth_have_no_exponent():
    t = np.geomspace(0.1, 1e4, 100)
    Ebar = np.ones((100, 3))
    Ebar[:, 2] = 0
    found = growth_exponents(Chain(4, alpha=1), t, Ebar, [(1,), (2,), (3,), ()])
    assert np.isnan(found.exponents).all()
    assert "D_1 (1 modes): no stage of growth, saturated at 0.1 .. 0.1; D_2 (1 modes): no stage of growth, not saturated" in repr(found)


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
    assert orbit.averages[1:, 2:4] == pytest.approx(theory[1:, 2:4], rel=1e-4)
    measured, exact = (growth_exponents(chain, orbit.times, values, groups) for values in (orbit.averages, theory))
    assert measured.exponents == pytest.approx(exact.exponents, abs=1e-4)
    assert measured.saturation == pytest.approx(exact.saturation)
    assert measured.exponents == pytest.approx(2.0, abs=0.15)


def test_groups_start_with_the_power_4k_minus_2():
    """Forces that keep their sign: Q_q ~ t^(2k), P_q ~ t^(2k-1); corrections (Omega t)^2 with Omega_16 = 0.77."""
    chain = Chain(64, alpha="0.33")
    Q, P = fpu_trajectory(chain, packet_amplitudes(chain, LOW, "1e-6"))
    orbit = integrate(chain, Q, P, 0.6, step=0.005, scheme="aba864_modes", samples=np.linspace(0, 0.6, 121))
    E, t = orbit.harmonic_energies(), orbit.times
    sums = np.cumsum(E[1:] + E[:-1], axis=0) / 2 / np.arange(1, len(t))[:, None]
    found = growth_exponents(chain, t[1:], sums, excitation_sequence(64, LOW, 4), window=(0.2, 0.6))
    assert [g.mean for g in found.groups] == pytest.approx([2, 6, 10, 14], rel=0.02)


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
    assert [g.mean for g in read.groups] == pytest.approx([1.5, 3.0, 4.5], abs=0.15)
    own = growth_exponents(FIG2.chain, orbit.times, orbit.averages, groups)
    first, second, third = own.groups
    assert first.mean - first.spread > 1.85
    assert second.mean == pytest.approx(3.5, abs=0.1)
    # no power law: the window is over before it is reached
    assert (own.halves[own.orders == 3] @ [1, -1] > 1.3).all()
    # "of order 1e3 for the modes 5 .. 8, and 1e2 for the remaining ones"
    assert 150 < first.saturation[0] < 200 < 800 < first.saturation[1] < 900
    assert all(150 < g.saturation[0] <= g.saturation[1] < 450 for g in (second, third))


def test_recurrence_of_commensurable_signals():
    t = np.arange(0, 20.0, 0.05)
    a, b = 0.4 * (1 - np.cos(2 * t)), 0.1 * (1 - np.cos(t))  # away from mode 1, in modes 2 and 3
    found = recurrence(t, np.stack([1 - a - b, a, b], axis=-1))
    # symmetric to every multiple of pi, so the vertex is exact but for the fourth order in the spacing
    assert found.times == pytest.approx(np.pi * np.arange(1, 7), abs=1e-4)
    assert found.returned == pytest.approx([0.8, 1, 0.8, 1, 0.8, 1], abs=1e-6)
    assert found.first == (found.times[0], found.returned[0])
    assert found.best[1] == pytest.approx(1, abs=1e-6)
    assert found.excursion == pytest.approx(np.max(a + b), rel=ROUNDING)
    assert repr(found).startswith("Recurrence(6 returns, first at t=3.1416 of 80.000")


def test_the_vertex_of_unequal_samples():
    t = np.array([0.0, 1.0, 5.0, 9.0, 9.7, 11.0, 15.0])
    moved = np.where(abs(t - 10) < 2, (t - 10.3) ** 2 / 25, 0.9)
    moved[0] = 0.0
    found = recurrence(t, np.stack([1 - moved, moved], axis=-1))
    assert (found.times[0], found.returned[0]) == pytest.approx((10.3, 1.0), rel=ROUNDING)


def test_wiggles_make_no_returns():
    t = np.arange(0, 100.0, 0.05)
    moved = 0.4 * (1 - np.cos(2 * np.pi * t / 40)) * (1 + 0.2 * np.sin(7 * t))
    found = recurrence(t, np.stack([1 - moved, moved], axis=-1))
    assert found.times == pytest.approx([40, 80], abs=1)


@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_recurrence_of_two_modes_that_beat(shift):
    """A linear pair: energies cos^2, sin^2 of half the difference of frequencies; the parabola finds the top between samples."""
    rate, part = 0.013, 0.8
    t = np.concatenate([[0.0], np.arange(1.0, 1300.0, 2.0) + shift])
    moved = part * np.sin(rate * t / 2) ** 2
    found = recurrence(t, np.stack([3 * (1 - moved), 3 * moved], axis=-1))
    assert found.times == pytest.approx([2 * np.pi / rate, 4 * np.pi / rate], rel=1e-5)
    assert found.returned == pytest.approx(1, abs=1e-7)
    assert found.excursion == pytest.approx(part, abs=1e-4)
    assert found.first[0] == found.times[0]


def test_a_record_that_ends_on_its_way_back_has_no_recurrence():
    t = np.linspace(0, 6.0, 50)  # a period is 2 pi
    with pytest.raises(NoRecurrence, match="until t = 6: the energies move 1 of the whole away") as raised:
        recurrence(t, np.stack([1 + np.cos(t), 1 - np.cos(t)], axis=-1))
    assert raised.value.T == 6.0
    with pytest.raises(NoRecurrence, match="move 0 of the whole"):
        recurrence(t, np.ones((50, 3)))
    with pytest.raises(NoRecurrence):
        recurrence(t, np.stack([1 - t / 10, t / 10], axis=-1))


@pytest.mark.parametrize(("energy", "time", "returned"), [(None, 14004.3, 0.98626), ("0.014915", 12172.3, 0.98423)])
def test_recurrence_of_the_original_fpu_trajectory(energy, time, returned):
    """Fig. 9(b), "nearly complete return at t = 12000": so for the printed E = 0.014915, not for the printed A_1, where E = 0.00815."""
    chain = FIG9_BREATHER.chain
    A = {1: FIG9_BREATHER.amplitudes[0]} if energy is None else packet_amplitudes(chain, (1,), energy)
    orbit = integrate(chain, *fpu_trajectory(chain, A), 15000.0, step=0.25, samples=np.arange(0, 15000.5, 2.0))
    found = recurrence(orbit.times, orbit.harmonic_energies())
    assert found.first[0] == pytest.approx(time, abs=1)  # fast wiggles of the energies move a minimum by less than their period
    assert found.first[1] == pytest.approx(returned, abs=1e-4)
    assert found.excursion > 0.75


def refused(argument, call, *arguments, **options):
    with pytest.raises(InputError) as raised:
        call(*arguments, **options)
    assert raised.value.argument == argument


CHAIN = Chain(4, alpha=1)


@pytest.mark.parametrize(
    ("argument", "amplitudes", "phases"),
    [
        ("seeds", {}, None),
        ("seeds", {0: 1}, None),
        ("seeds", {4: 1}, None),
        ("seeds", {1.5: 1}, None),
        ("amplitudes", [1.0], None),
        ("amplitudes[2]", {2: float("nan")}, None),
        ("amplitudes[2]", {2: float("inf")}, None),
        ("amplitudes[2]", {2: "1e400"}, None),
        ("amplitudes[2]", {2: "loud"}, None),
        ("phases", {2: 1}, {1: 0.0}),
        ("phases", {2: 1}, 0.3),
        ("phases[2]", {2: 1}, {2: float("nan")}),
    ],
)
def test_bad_trajectories_are_refused(argument, amplitudes, phases):
    refused(argument, fpu_trajectory, CHAIN, amplitudes, phases)


def test_bad_packets_and_profiles_are_refused():
    refused("seeds", packet_amplitudes, CHAIN, (), 1)
    refused("seeds", packet_amplitudes, CHAIN, (1, 1), 1)
    for energy in (0, -1, float("nan")):
        refused("energy", packet_amplitudes, CHAIN, (1,), energy)
    refused("share", packet_amplitudes, CHAIN, (1,), 1, share="phase")
    refused("a, b", profile_distance, [1.0], [1.0, 2.0], 1e-3)
    refused("a, b", profile_distance, [], [], 1e-3)
    refused("b", profile_distance, [1.0], [-1.0], 1e-3)
    refused("a", profile_distance, [float("nan")], [1.0], 1e-3)
    refused("floor", profile_distance, [1.0], [1.0], 0)


def test_bad_records_are_refused():
    t, E = np.arange(1.0, 11.0), np.ones((10, 3))
    groups = [(1,), (2,), (3,)]
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
    refused("energies", recurrence, t, 0 * E)
    refused("energies", recurrence, t, -E)
    refused("energies", recurrence, t, E[0])
    refused("times", recurrence, t[:2], E[:2])
    refused("times", recurrence, "now", E)


@pytest.mark.parametrize(
    "call",
    [
        lambda: fpu_trajectory("chain", {1: 1}),
        lambda: packet_amplitudes(None, (1,), 1),
        lambda: growth_exponents(7, [1.0], [[1.0]], [(1,), (2,)]),
        lambda: profile_law("chain", 1, 1e-8),
        lambda: fit_profile(None, [1.0], 1),
    ],
)
def test_what_is_no_chain_is_named(call):
    with pytest.raises(InputError, match=r"^chain = .* allowed is a Chain"):
        call()


def test_what_is_no_orbit_is_named():
    with pytest.raises(InputError, match=r"^orbit = .*integrate with averages=True"):
        normalised_averages("orbit")
