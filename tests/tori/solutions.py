"""One cheap case of each kind of solution, N = 8; test_solutions.py says what each has to do."""

from functools import cache

import symfpu
from symfpu import Chain, lindstedt, refine, resum, solve_amplitudes, unfold

CHAIN = Chain(8, alpha="0.3", beta="0.1")
PHASES = {1: 0.4, 2: -1.3}
SEED, FREQUENCY = 3, "1.1140"
TIMES = [0.0, 1.7, 40.0]


@cache
def series_torus():
    series = lindstedt(CHAIN, (1, 2), ("0.3904", "0.7658"), 8)
    return solve_amplitudes(series, phases=PHASES)


@cache
def breather():
    return symfpu.torus(CHAIN, (SEED,), frequencies=(FREQUENCY,))


@cache
def digits_torus():
    series = lindstedt(CHAIN, (SEED,), (FREQUENCY,), 9, digits=20)
    return solve_amplitudes(series, phases={SEED: 0.5})


# by name: how to make one
CASES = {
    "FromSeries": series_torus,
    "FromSeries, digits": digits_torus,
    "Newton": cache(lambda: refine(series_torus())),
    "Newton, one angle": cache(lambda: refine(digits_torus())),
    "Resummed": cache(lambda: resum(series_torus())),
    "Resummed, digits": cache(lambda: resum(digits_torus())),
    "Origin": cache(lambda: refine(series_torus()).in_doubles()),
    "HarmonicBalance": breather,
    "IterativeRefinement, breather": cache(lambda: refine(breather(), digits=25)),
    "IterativeRefinement": cache(lambda: refine(digits_torus(), digits=20)),
}


RING = Chain(8, alpha="0.3", beta="0.1", ends="periodic")


@cache
def waves():
    """Two waves, one of them downwards, with phases."""
    series = lindstedt(RING, (1, -2), ("0.7660", "1.4150"), 8)
    return solve_amplitudes(series, phases={1: 0.4, -2: -1.3})


@cache
def precise_waves():
    return refine(waves(), digits=20)


# the same of a ring: travelling waves, and standing ones
ON_A_RING = {
    "FromSeries, waves": waves,
    "Newton, waves": cache(lambda: refine(waves())),
    "Origin, waves": cache(lambda: refine(waves()).in_doubles()),
    "IterativeRefinement, waves": precise_waves,
    "Origin, standing": cache(lambda: unfold(CASES["Origin"]())),
    "Origin, standing, digits": cache(lambda: unfold(CASES["IterativeRefinement"]())),
}
