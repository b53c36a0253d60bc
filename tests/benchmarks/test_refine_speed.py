"""Refinement of tori: seconds, memory and products beside one transform there and back of all bonds. Measured, not asserted.

Allowed: 5 s for the 2-torus of Fig. 1 with its series, 300 s and 4 GB for the 4-torus of Fig. 2.
"""

import json

import numpy as np

import symfpu
from symfpu import lindstedt, refine, solve_amplitudes
from symfpu.paper.printed import APPENDIX_F, FIG9_BREATHER, TWO_TORUS
from symfpu.refinement.invariance import InvarianceEquation
from tests.benchmarks.history import seconds


def guess_of(torus, order):
    return solve_amplitudes(lindstedt(torus.chain, torus.seeds, torus.frequencies, order))


def transform_pair(refined):
    """Seconds of one transform of half of the bonds to the angles of the final harmonics and back, the best of three; and the lattice."""
    equation = InvarianceEquation(refined.chain, refined.seeds, refined.harmonics)
    bonds = (refined.chain.N + 1) // 2
    columns = np.random.default_rng(1).normal(size=(len(refined.harmonics), bonds))
    least = min(seconds(lambda: equation.grid.coefficients(equation.grid.values(columns))) for _ in range(3))
    return least, f"{bonds} bonds x {equation.grid.points} points"


def summary(refined):
    """Of the final harmonics, what the line says."""
    pair, lattice = transform_pair(refined)
    products = [step.krylov for step in refined.origin.steps]
    return {
        "text": f"{len(refined.harmonics)} harmonics, residual {refined.residual():.1e}, {len(products)} last steps, products {products}",
        "lattice": lattice,
        "pair": pair,
    }


def note_of(made, taken):
    return f"{made['text']}; = {taken / made['pair']:.0f} transforms there and back ({made['pair']:.4f} s, {made['lattice']})"


def test_two_torus(benchmark, record):
    """Series of order 12, its amplitudes, and Newton's method; allowed 5 s."""
    refine(guess_of(TWO_TORUS, 4), tolerance=1e-6)  # kernels
    refined = benchmark.pedantic(lambda: refine(guess_of(TWO_TORUS, 12)), rounds=3, iterations=1)
    record("2-torus of Fig. 1, series of order 12 and refinement", note=note_of(summary(refined), benchmark.stats.stats.median))


FOUR_TORUS = """
import json
import time
from symfpu.paper.printed import APPENDIX_F
from tests.benchmarks.test_refine_speed import guess_of, refine, summary
guess = guess_of(APPENDIX_F[0], 6)
start = time.perf_counter()
refined = refine(guess)
seconds = time.perf_counter() - start
print(json.dumps(summary(refined) | {"seconds": seconds, "warnings": refined.warnings}))
"""


def test_four_torus(in_a_process, record):
    """In a process of its own, whose peak memory counts; allowed 300 s and 4 GB."""
    printed, peak = in_a_process(FOUR_TORUS)
    made = json.loads(printed)
    doubts = "".join(f"; {warning}" for warning in made["warnings"])
    note = f"refinement alone {made['seconds']:.1f} s, peak memory {peak:.2f} GB; {note_of(made, made['seconds'])}{doubts}"
    record(f"4-torus of {APPENDIX_F[0].label}, series of order 6 and refinement", note=note)


def test_breather(benchmark, record):
    """The one of Fig. 7, beside the method for breathers alone."""
    torus = APPENDIX_F[5]
    guess = guess_of(torus, 20)
    refined = benchmark.pedantic(refine, (guess,), rounds=3, iterations=1, warmup_rounds=1)
    alone = seconds(lambda: symfpu.torus(torus.chain, (torus.seeds[0],), frequencies=(torus.frequencies[0],)))
    note = f"{note_of(summary(refined), benchmark.stats.stats.median)}; harmonic balance {alone:.3f} s"
    record(f"breather N = 32 of {torus.label}, from order 20", note=note)


def test_large_breather(benchmark, record):
    """The one of Fig. 9, of which low orders of the series are far."""
    guess = guess_of(FIG9_BREATHER, 60)
    refined = benchmark.pedantic(refine, (guess,), rounds=3, iterations=1, warmup_rounds=1)
    record(f"breather N = 32 of {FIG9_BREATHER.label}, from order 60", note=note_of(summary(refined), benchmark.stats.stats.median))
