"""The chain, its potentials and what the couplings alone decide."""

import symfpu
from symfpu import Chain, excitation_sequence, frequency_rank, frequency_shift, from_expression, particle_state, reachable_modes
from tests.fingerprint.cases import case

LAWS = ("toda:1/2", "morse:1/3", "lennard_jones:12,6", "polynomial:0.3,0.2,0,0.1")


@case
def fixed_ends():
    for N in (2, 7, 16):
        yield f"Omega, N = {N}", Chain(N, alpha="0.33").frequencies()
    chain = Chain(5, alpha="0.3", beta="1/7")
    Q = [0.2, -0.1, 0.05, 0.02]
    yield "accelerations", chain.accelerations(Q)
    yield "positions", chain.positions(Q)
    yield "stretches", chain.stretches(Q)
    yield "energy", chain.energy(Q, Q)
    yield "harmonic energies", chain.harmonic_energies(Q, Q)
    yield "mu", Chain(16, alpha="0.33").small_parameter()
    yield "mu, beta", Chain(9, beta=1).small_parameter()
    yield "Omega_3 in digits", Chain(16, alpha=1).linear_frequency(3)
    yield "Hamiltonian", str(Chain(3, alpha="1/3", beta="1/7").hamiltonian())
    yield "typed", chain.typed


@case
def rings():
    for N in (8, 9):
        chain = Chain(N, alpha="0.3", ends="periodic")
        yield f"mode numbers, N = {N}", list(chain.mode_numbers)
        yield f"Omega, N = {N}", chain.frequencies()
        state = particle_state(chain, [0.1, *[0.0] * (N - 3), 0.02, -0.12], [0.0] * N)
        yield f"modes, N = {N}", state[0]
        yield f"energy, N = {N}", chain.energy(*state)


@case
def potentials():
    for law in LAWS:
        chain = Chain(6, potential=law)
        yield f"{law}, couplings", chain.relative_couplings(6)
        yield f"{law}, accelerations", chain.accelerations([0.2, -0.1, 0.05, 0.02, 0.01])
        yield f"{law}, energy", chain.energy([0.2, -0.1, 0.05, 0.02, 0.01], [0.0] * 5)
    chain = Chain(5, potential=from_expression("cosh(r) - 1"))
    yield "cosh r - 1, couplings", chain.relative_couplings(6)
    yield "cosh r - 1, accelerations", chain.accelerations([0.2, -0.1, 0.05, 0.02])


@case
def couplings():
    for N, seeds, model in ((8, (1, 4), "beta"), (16, (1, 2), "alpha"), (15, (3, 5), "beta"), (12, (11,), "alpha"), (2, (1,), "beta")):
        yield f"{model}, N = {N}, {seeds}, rule", excitation_sequence(N, seeds, 4, model=model)
        yield f"{model}, N = {N}, {seeds}, couplings", symfpu.coupling_sequence(N, seeds, 4, model=model)
        yield f"{model}, N = {N}, {seeds}, reachable", reachable_modes(N, seeds, 4, model=model)
    yield "ring", excitation_sequence(9, (1,), 4, model="alpha", ends="periodic")
    yield "Toda", excitation_sequence(8, (3,), 4, potential="toda:1/2")
    chain = Chain(8, alpha="0.3")
    yield "coupled to 1, 2", sorted(chain.coupled(1, 2))
    yield "B", [chain.B(1, 2, q) for q in range(1, 8)]
    yield "C", [chain.C(1, 2, 3, q) for q in range(1, 8)]
    yield "rank of the frequencies", [frequency_rank(N) for N in range(2, 31)]


@case
def frequency_shifts():
    chains = {"alpha": Chain(12, alpha=1), "both": Chain(12, alpha=1, beta="2/3"), "beta": Chain(7, beta="1/5")}
    for name, chain in chains.items():
        yield f"{name}", frequency_shift(chain, {1: 0.1, 5: 0.2})
        yield f"{name}, formula", {q: str(shift) for q, shift in symfpu.frequency_shift_formula(chain, (1, 5)).items()}
