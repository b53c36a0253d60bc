"""Results that are drawn: tori of several kinds, chains and sizes; each made once."""

from functools import cache

import numpy as np

import symfpu
from symfpu import Chain, amplitude_history, assess, family, fpu_trajectory, integrate, lindstedt, solve_amplitudes

ALPHA = Chain(16, alpha="0.33")
TODA = Chain(7, potential="toda:1/2")
RING = Chain(9, alpha="0.3", ends="periodic")


@cache
def series(order=12):
    return lindstedt(ALPHA, (1, 2), ("0.19626", "0.39046"), order)


@cache
def torus():
    return solve_amplitudes(series())


@cache
def single():
    return lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 20)


@cache
def breather(N=9, seed=2):
    """Of an odd number of bonds, beta."""
    return symfpu.torus(Chain(N, beta=1), (seed,), amplitudes={seed: "0.3"})


@cache
def one_mode():
    return symfpu.torus(Chain(2, beta=1), (1,), amplitudes={1: "0.3"})


@cache
def toda_torus():
    return symfpu.torus(TODA, (1, 2), amplitudes={1: "0.1", 2: "0.05"}, method="series", order=5)


@cache
def three_seeds():
    return symfpu.torus(Chain(9, alpha="0.3"), (1, 2, 3), amplitudes={1: "0.1", 2: "0.1", 3: "0.05"}, method="series", order=3)


@cache
def refined():
    return symfpu.refine(solve_amplitudes(lindstedt(ALPHA, (1, 2), ("0.1961", "0.3904"), 8)))


@cache
def ring():
    return symfpu.solve_amplitudes(symfpu.lindstedt(RING, (1,), ("0.69",), 6))


@cache
def normal():
    return symfpu.normal_modes(one_of_five())


@cache
def one_of_five():
    return symfpu.torus(Chain(N=6, alpha="0.3"), (2,), amplitudes={2: "0.2"})


@cache
def lines_found():
    """Two frequencies and their combinations, some too weak to tell."""
    chain = Chain(N=5, alpha="0.3")
    start = fpu_trajectory(chain, {1: "0.3", 3: "0.2"})
    return symfpu.frequency_analysis(integrate(chain, *start, 1000, step=0.25))


@cache
def orbit(scheme="kahan_li8", samples=60):
    """An FPU-trajectory of mode 1."""
    start = fpu_trajectory(ALPHA, {1: "0.05"})
    return integrate(ALPHA, *start, 1e3, step=0.25, averages=True, scheme=scheme, samples=samples)


@cache
def even_orbit():
    start = fpu_trajectory(TODA, {1: "0.5"})
    return integrate(TODA, *start, 60, step=0.05, samples=np.linspace(0, 60, 121))


@cache
def history(order=12):
    return amplitude_history(series(order))


@cache
def lost():
    """Amplitudes too large for the series: the lower orders have no real root."""
    return amplitude_history(lindstedt(ALPHA, (1, 2), ("0.1970", "0.3905"), 14))


@cache
def assessment():
    return assess(series(), torus())


@cache
def converged():
    return assess(single(), solve_amplitudes(single()))


@cache
def unstable():
    return family(Chain(6, beta=1), (5,), "3", from_energy="0.05", multipliers=True)


@cache
def pair():
    """A fold of omega_2 is on its way."""
    return family(Chain(8, alpha="0.3"), (1, 2), "0.005", from_energy="0.001")


@cache
def stable_floquet():
    return symfpu.floquet(breather())


@cache
def indices():
    """As on a torus of dimension 2: what is drawn is no question of a long run."""
    times = np.geomspace(1, 1e5, 200)
    falls = np.minimum(0, -(np.log10(times) - 2))
    log10_gali = np.stack([-0.05 + 0 * falls, falls, 2 * falls], axis=1)
    lyapunov = np.log(times + 1) / times
    return symfpu.AlignmentIndices(ALPHA, times, log10_gali, lyapunov, 0.4, 1e-12)


@cache
def foretold():
    return symfpu.foretold_indices(one_of_five(), np.geomspace(1, 1e6, 200), vectors=4)


@cache
def integrated():
    """The same frame, for a short time: a picture shows both."""
    return symfpu.alignment_indices(one_of_five().chain, *one_of_five().state(), 300, vectors=4, step=0.2, samples=64, frames=1)


@cache
def short_indices():
    return symfpu.alignment_indices(one_mode().chain, *one_mode().state(), 200, vectors=2, frames=1)


@cache
def sequence():
    return symfpu.excitation_sequence(32, (3, 5), 6)


@cache
def proof():
    return symfpu.prove_propagation(8, (1, 4), 3, model="beta")


@cache
def invariants():
    return symfpu.toda_invariants(TODA, *fpu_trajectory(TODA, {1: "0.5"}))


@cache
def gaps():
    found = even_orbit()
    return symfpu.toda_gaps(found.chain, found.Q, found.P)


@cache
def stable_family():
    return family(Chain(6, beta=1), (5,), "0.05", from_energy="0.03", multipliers=True)


@cache
def single_beta():
    """Odd seeds of beta never feed even modes."""
    return solve_amplitudes(lindstedt(Chain(9, beta=1), (1,), ("0.3495",), 4))
