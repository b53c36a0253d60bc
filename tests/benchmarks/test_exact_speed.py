"""Speed and memory of the exact layer, on two cores. Measured and printed, not asserted."""

import random

from symfpu import Chain, prove_propagation, sweep_propagation
from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.grading import Grading
from symfpu.algebra.residue import ResidueRing
from symfpu.algebra.selection import CosineModes
from symfpu.proofs.certificates import random_point
from symfpu.series.residues import residue_series
from tests.benchmarks.history import seconds

SEEDS = (94, 95, 96, 97, 98)


def test_proof(benchmark, record):
    proof = benchmark.pedantic(prove_propagation, (128, SEEDS, 9), rounds=3, iterations=1, warmup_rounds=1)
    record(f"N = 128, seeds 94..98, alpha, order 9: {proof.verdict}")


def test_memory_of_a_proof(in_a_process, record):
    code = f"from symfpu.proofs.certificates import prove_propagation\nprove_propagation(128, {SEEDS}, 9)"
    _, peak = in_a_process(code, rounds=2)
    record("the same in a process of its own", note=f"peak memory {peak:.2f} GB")


def test_residue_kernel(benchmark, record):
    """The bond products of the N = 128 series to order 9, modulo a prime; beside them the same products in doubles."""
    point = random_point(128, 5, 10, random.Random(1))
    series = residue_series(Chain(128, alpha=1), SEEDS, point, 9)
    space = CosineModes(128, SEEDS, Grading(5, 10))
    rings = [ResidueRing(space, point.prime, point.root), Float64Ring(space)]
    for ring in rings:
        for k, modes in enumerate(series.coordinates):
            ring.put(k + 1, modes.copy() if ring is rings[0] else modes / point.prime)

    def products(ring):
        ring.multiply_adds = 0
        for degree in range(2, 11):
            ring.power(2, degree)

    products(rings[1])
    doubles = seconds(lambda: products(rings[1]))
    benchmark.pedantic(products, (rings[0],), rounds=3, iterations=1, warmup_rounds=1)
    ratio = doubles / benchmark.stats.stats.median
    record("residue kernel, N = 128, order 9", multiply_adds=rings[0].multiply_adds, note=f"{ratio:.0%} of the rate in doubles")


def test_sweeps(benchmark, record):
    def both():
        return [sweep_propagation(range(2, 13), 3, order, model=model) for model, order in (("alpha", 5), ("beta", 3))]

    sweeps = benchmark.pedantic(both, rounds=1, iterations=1)
    record(f"both sweeps, {sum(len(s.cases) for s in sweeps)} seed sets")
