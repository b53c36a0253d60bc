"""FPU-trajectories, packets, normalised averages and distances of profiles."""

import numpy as np
import pytest

from symfpu import Chain, InputError, fpu_trajectory, integrate, normalised_averages, packet_amplitudes, profile_distance
from tests.localization.refusals import refused
from tests.tolerances import HARMONIC_SHARE, HUNDRED_ROUNDINGS, ROUNDING

CHAIN = Chain(4, alpha=1)


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
    assert orbit.harmonic_energies() == pytest.approx(
        np.broadcast_to(start, orbit.Q.shape), abs=HUNDRED_ROUNDINGS
    )  # 400 exact rotations, each rounded


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
    assert spectra.sum(axis=-1) == pytest.approx(1, abs=HARMONIC_SHARE)
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
    refused("chain", fpu_trajectory, "chain", {1: 1})
    refused("chain", packet_amplitudes, None, (1,), 1)
    refused("orbit", normalised_averages, "orbit")
