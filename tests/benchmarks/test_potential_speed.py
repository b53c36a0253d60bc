"""Speed of series of other potentials against alpha + beta, and of differential equations against plain powers.

N = 32. The chains take turns in every round, so that what else the machine does falls on all of them; the least time of each
counts.
"""

import statistics

import pytest

from symfpu import Chain, lindstedt
from symfpu.algebra.float64 import Float64Ring
from tests.benchmarks.history import seconds

CHAINS = {"alpha+beta": "poly:1/4,1/24", "toda": "toda:1/4", "morse": "morse:1/4", "lennard_jones": "lj:12,6"}
FREQUENCIES = ("0.09813690483108113", "0.1960343421", "0.2934612377", "0.3901828193")
CASES = {"one seed, order 80": (1, 80), "four seeds, order 11": (4, 11)}
ROUNDS = 7
DIGIT_CASES = {"one seed, order 40": (1, 40, 30), "four seeds, order 8": (4, 8, 30)}
DIGIT_ROUNDS = 3


def series_seconds(chain, seeds, order, digits=None):
    return seconds(lambda: lindstedt(chain, tuple(range(1, seeds + 1)), FREQUENCIES[:seeds], order, digits=digits))


def in_turns(benchmark, case, rounds):
    """What is said of all chains."""
    chains = {name: Chain(32, potential=text) for name, text in CHAINS.items()}
    runs = {name: [] for name in chains}

    def turn():
        for name, chain in chains.items():
            runs[name].append(series_seconds(chain, *case))

    benchmark.pedantic(turn, rounds=rounds, iterations=1, warmup_rounds=1)
    least = {name: min(times) for name, times in runs.items()}
    ratios = ", ".join(f"{name} {least[name] / least['alpha+beta']:.2f}" for name in least)
    spread = statistics.median(runs["alpha+beta"]) / least["alpha+beta"]
    return f"alpha+beta {least['alpha+beta']:.3f} s; in units of it: {ratios}; median/least {spread:.2f}"


@pytest.mark.parametrize("case", CASES)
def test_potentials(benchmark, record, case):
    note = in_turns(benchmark, CASES[case], ROUNDS)
    record(f"series of N = 32, {case}", note=note)


@pytest.mark.parametrize("case", DIGIT_CASES)
def test_thirty_digits(benchmark, record, case):
    note = in_turns(benchmark, DIGIT_CASES[case], DIGIT_ROUNDS)
    record(f"thirty digits, N = 32, {case}", note=note)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("name", ["toda", "lennard_jones"])
def test_plain_powers(benchmark, record, case, name, monkeypatch):
    chain = Chain(32, potential=CHAINS[name])
    least = min(series_seconds(chain, *CASES[case]) for _ in range(ROUNDS))
    monkeypatch.setattr(Float64Ring, "grows", False)
    benchmark.pedantic(series_seconds, (chain, *CASES[case]), rounds=3, iterations=1, warmup_rounds=1)
    plain = benchmark.stats.stats.min
    record(f"{name} by plain powers, {case}", note=f"{plain / least:.1f} times the differential equation")
