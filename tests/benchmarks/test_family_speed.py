"""Breathers: one orbit, many digits, a family with multipliers, and how the time grows with N. Measured, not asserted."""

import csv
import time
from pathlib import Path

import numpy as np
import pytest

import symfpu
from symfpu import Chain, family, floquet, refine, torus

CHAIN, OMEGA = Chain(32, "0.33"), "0.0981410995944860"
LENGTHS = (16, 32, 64, 128, 256)
OUT = Path("out")


def test_breather(benchmark, record):
    benchmark.pedantic(torus, (CHAIN, (1,)), {"frequencies": (OMEGA,)}, rounds=3, iterations=1)
    record("breather N = 32, seed 1, doubles", note=f"residual {symfpu.torus(CHAIN, (1,), frequencies=(OMEGA,)).residual():.1e}")


def test_breather_at_a_hundred_digits(benchmark, record):
    orbit = symfpu.torus(CHAIN, (1,), frequencies=(OMEGA,))
    found = benchmark.pedantic(refine, (orbit,), {"digits": 100}, rounds=1, iterations=1)
    record("breather N = 32, seed 1, 100 digits", note=f"residual bound {float(found.origin.bound):.0e}, {found.origin.sweeps} sweeps")


def test_multipliers(benchmark, record):
    orbit = symfpu.torus(CHAIN, (1,), frequencies=(OMEGA,))
    benchmark.pedantic(floquet, (orbit,), rounds=3, iterations=1)
    record("Floquet multipliers, N = 32, seed 1")


def test_family_of_fifty(benchmark, record):
    options = {"from_energy": "1e-11", "members": 50, "multipliers": True}
    found = benchmark.pedantic(family, (CHAIN, (1,), "1"), options, rounds=1, iterations=1)
    last = found.members[-1]
    note = f"to H = {last.energy:.3g}, {len(last.torus.harmonics)} harmonics"
    record(f"family of {len(found.members)} breathers with multipliers", note=note)


def test_growth_with_the_chain(benchmark, record):
    """Seed 25 N / 32 at one amplitude per root of length; orbit and multipliers; seconds into out/breather-scaling.csv and .png."""
    rows = []

    def all_lengths():
        for N in LENGTHS:
            start = time.perf_counter()
            orbit = symfpu.torus(Chain(N, "0.33"), (25 * N // 32,), amplitudes={25 * N // 32: 0.05 * (N / 32) ** 0.5})
            middle = time.perf_counter()
            floquet(orbit)
            rows.append((N, middle - start, time.perf_counter() - middle, len(orbit.cosines) - 1))

    benchmark.pedantic(all_lengths, rounds=1, iterations=1)
    slopes = [np.polyfit(np.log([r[0] for r in rows[-3:]]), np.log([r[k] for r in rows[-3:]]), 1)[0] for k in (1, 2)]
    note = ", ".join(f"N={N}: {a:.3f} + {b:.3f} s" for N, a, b, _ in rows)
    record("breathers from N = 16 to 256", note=f"orbit + multipliers {note}; exponents {slopes[0]:.1f}, {slopes[1]:.1f} from N = 64 on")
    _written(rows)


def _written(rows):
    import matplotlib.pyplot as plt

    OUT.mkdir(exist_ok=True)
    with (OUT / "breather-scaling.csv").open("w", newline="") as stream:
        csv.writer(stream).writerows([("N", "orbit, s", "multipliers, s", "harmonics"), *rows])
    figure, ax = plt.subplots(figsize=(5, 3.6), layout="constrained")
    N = [r[0] for r in rows]
    ax.loglog(N, [r[1] for r in rows], "o-", label="orbit (harmonic balance, Newton)")
    ax.loglog(N, [r[2] for r in rows], "s-", label="Floquet multipliers")
    ax.loglog(N, [rows[-1][1] * (n / N[-1]) ** 3 for n in N], "k:", lw=0.8, label=r"$N^3$")
    ax.set_xticks(N, [str(n) for n in N])
    ax.minorticks_off()
    ax.set_xlabel(r"$N$")
    ax.set_ylabel("seconds")
    ax.legend()
    figure.savefig(OUT / "breather-scaling.png", dpi=150)
    plt.close(figure)


@pytest.fixture(autouse=True)
def compiled():
    """Loops are compiled once, before anything is timed."""
    floquet(symfpu.torus(Chain(8, "0.33"), (1,), frequencies=("0.3905",)))
