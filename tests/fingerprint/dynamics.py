"""Orbits, alignment indices, frequency analysis, localization, recurrence, the Toda chain."""

import math
from functools import cache

import numpy as np

import symfpu
from symfpu import Chain, fpu_trajectory, integrate, packet_state, random_state, slope_by_energy, toda_invariants, toda_torus
from tests.fingerprint.cases import case
from tests.fingerprint.entries import noise, sampled, solver

SCHEMES = ("kahan_li8", "blanes_moan6", "yoshida4", "aba864", "aba864_modes")
CHAIN = Chain(16, alpha="0.33")


@cache
def orbit():
    return integrate(CHAIN, *fpu_trajectory(CHAIN, {1: "0.1"}), 200.0, step=0.25, samples=50, averages=True)


@case
def orbits():
    start = fpu_trajectory(CHAIN, {1: "0.3", 2: "0.1"})
    for scheme in SCHEMES:
        found = integrate(CHAIN, *start, 20.0, step=0.25, samples=4, scheme=scheme)
        yield f"{scheme}, Q", solver(found.Q[-1])
        yield f"{scheme}, energy error", noise(found.energy_error)
    yield "record", solver(orbit().record())
    yield "averages", solver(symfpu.normalised_averages(orbit())[-1])
    for law in ("toda:1/2", "morse:1/3", "lennard_jones:12,6", "polynomial:0.3,0.2,0,0.1"):
        chain = Chain(7, potential=law)
        found = integrate(chain, *packet_state(chain, (2,), "0.1"), 20.0, step=0.1, samples=4)
        yield f"{law}, Q", solver(found.Q[-1])
    chain = Chain(9, beta=1, ends="periodic")
    found = integrate(chain, *packet_state(chain, (2,), "0.1"), 20.0, step=0.1, samples=4, averages=True)
    yield "ring", solver(found.record())
    yield "ring, Q", solver(np.abs(found.Q[-1]))


@case
def starts():
    yield "packet", packet_state(CHAIN, (1, 2), "0.01", shares={1: 2, 2: 1}, phases={1: "0.3"})
    yield "random", random_state(Chain(8, beta=1), "0.5", 3)
    yield "particles", symfpu.particle_state(Chain(5, alpha=1), [0.1, 0, 0, 0.2], [0, 0.1, 0, 0])
    yield "amplitudes", symfpu.packet_amplitudes(CHAIN, (1, 2, 3), "0.01")
    yield "FPU", fpu_trajectory(CHAIN, {1: "0.1", 2: "0.05"}, {1: "0.4"})


@case
def indices():
    regular = Chain(8, alpha="0.3")
    found = symfpu.alignment_indices(regular, *fpu_trajectory(regular, {1: "0.1"}), 200.0, vectors=3, samples=64, frames=2)
    yield "regular", sampled(found.record())
    wild = Chain(4, beta=10)
    yield (
        "chaotic",
        sampled(symfpu.alignment_indices(wild, *random_state(wild, "5", 1), 100.0, vectors=2, samples=64, frames=1, step=0.05).record()),
    )


@case
def spectra():
    short = Chain(3, beta=1)
    yield "one chain", sampled(symfpu.frequency_analysis(integrate(short, [0.1, 0.2], [0, 0], 300, step=0.25)).record())
    chain = Chain(5, alpha="0.3")
    found = symfpu.frequency_analysis(integrate(chain, *fpu_trajectory(chain, {1: "0.3", 3: "0.2"}), 1000, step=0.25))
    yield "two frequencies", sampled(found.record())
    near = symfpu.torus_near(found)
    yield "torus near", sampled({"frequencies": list(map(float, near.frequencies)), "amplitudes": list(near.amplitudes.values())})
    yield "torus near, record", noise(near.record())
    yield "map", sampled(symfpu.frequency_map(chain, ("0.001", "0.01"), T=300, step=0.25).record())


@case
def localization():
    yield "group energies", symfpu.group_energy(CHAIN, 2, 1e-4, [0, 1, 2, 3])
    yield "packet energies", symfpu.packet_energies(Chain(24, alpha="0.33"), 2, 1e-4)
    yield "packet groups", [list(group) for group in symfpu.packet_groups(CHAIN, 3)]
    yield "packets", [symfpu.natural_packet(CHAIN, 1e-4), symfpu.least_packet(CHAIN, 1e-4), symfpu.packet_parameter(CHAIN, 2, 1e-4)]
    yield "middle modes", symfpu.middle_modes(CHAIN, 2)
    beta = Chain(32, beta="0.3")
    law = symfpu.profile_law(beta, 4, 1e-6)
    yield "law", law.record()
    spectrum = 10 ** law(np.arange(1, 32) / 32) * (1 + 0.01 * np.cos(np.arange(31)))
    yield "fit", sampled(symfpu.fit_profile(beta, spectrum, 4, floor=0.0).record())
    yield "distance", symfpu.profile_distance([1, 1e-2, 1e-4], [1, 1e-3, 1e-4], 1e-12).record()
    yield "floor", solver(symfpu.rounding_floor(CHAIN, orbit().averages[-1], 200.0, step=0.25))
    series = symfpu.torus(Chain(8, alpha="0.3"), (1,), amplitudes={1: "0.1"}, method="series", order=5)
    yield "floor of a torus", noise(symfpu.spectrum_floor(series))
    yield "errors of coefficients", noise(symfpu.coefficient_errors(series).max())
    yield "slopes", sampled(slope_by_energy(beta, 4, [1e-6, 2e-6, 4e-6], [spectrum, spectrum**0.98, spectrum**0.96], floor=0.0).record())
    yield "invariance", sampled(symfpu.profile_invariance(Chain(16, alpha="0.33"), "1/8", 1e-4, (16, 32, 48), 50.0).record())


@case
def growth():
    found = orbit()
    groups = symfpu.excitation_sequence(16, (1,), 2, model="alpha")
    yield "exponents", sampled(symfpu.growth_exponents(CHAIN, found.times[1:], found.averages[1:], groups).record())
    t = np.linspace(0, 15, 151)
    times = symfpu.recurrence(t, np.stack([1 + np.cos(t), 1 - np.cos(t)], axis=-1))
    yield "recurrence", sampled(times.record())
    yield "first return", sampled([found / math.pi for found in times.first])


@case
def toda():
    chain = Chain(6, potential="toda:1/2")
    state = fpu_trajectory(chain, {1: "0.5", 3: "0.2"})
    yield "invariants", solver(toda_invariants(chain, *state).record())
    yield "invariants in digits", toda_invariants(chain, *state, digits=25).record()
    yield "gaps", solver(symfpu.toda_gaps(chain, *state))
    found = toda_torus(Chain(4, alpha="1/2"), (1, 3), actions=("0.1", "0.2"), digits=20)
    yield "torus by actions", found.record()
    yield "state", found.state({3: 1})
    low = toda_torus(Chain(4, alpha="1/2"), (1, 2), actions=("0.01", "0.005"), digits=20)
    yield "torus by frequencies", toda_torus(Chain(4, alpha="1/2"), (1, 2), frequencies=list(low.frequencies.values())).record()
    ring = Chain(5, potential="toda:1", ends="periodic")
    yield "ring", solver(toda_invariants(ring, *packet_state(ring, (1,), "0.1")).record())
