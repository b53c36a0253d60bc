"""Benchmarks print what they measured: seconds, multiply-adds, rate, and the ratio to a matrix product timed beside them.

Each run is kept with its machine, and compared with the one before (history.py).
"""

import subprocess
import sys

import numpy as np
import pytest

from tests.benchmarks.history import BESIDE, FOLDER, WHAT, machine, read_runs, seconds, slower_lines

MATRIX = 1500


def pytest_benchmark_generate_machine_info(config):
    return machine()


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config):
    """Runs that are saved go to the history, unless another place is named."""
    if config.getoption("benchmark_autosave", None) and config.option.benchmark_storage == "file://./.benchmarks":
        config.option.benchmark_storage = f"file://{FOLDER}"


def matrix_seconds():
    """Of a float64 matrix product on all threads, the best of five."""
    a = np.random.default_rng(1).random((MATRIX, MATRIX))
    a @ a
    return min(seconds(lambda: a @ a) for _ in range(5))


@pytest.fixture(autouse=True)
def beside(request):
    """After each benchmark a matrix product is timed: what else the machine does falls on both."""
    benchmark = request.getfixturevalue("benchmark") if "benchmark" in request.fixturenames else None
    yield
    if benchmark is not None and benchmark.stats is not None:
        benchmark.extra_info.setdefault(BESIDE, matrix_seconds())


@pytest.fixture
def record(benchmark, request, beside):
    """Keep a line for the summary: seconds, and if given multiply-adds, their rate and ratio to a matrix product.

    plain : multiply-adds of the same result without the symmetries, for their ratio.
    """

    def keep(name, *, multiply_adds=None, plain=None, note=""):
        seconds = benchmark.stats.stats.median
        benchmark.extra_info[WHAT] = name
        line = f"{name:<58} {seconds:9.3f} s"
        if multiply_adds:
            benchmark.extra_info[BESIDE] = matrix_seconds()
            rate, product = multiply_adds / seconds, MATRIX**3 / benchmark.extra_info[BESIDE]
            line += f"  {multiply_adds:.3e} multiply-adds  {rate / 1e9:6.2f} G/s"
            line += f" = {rate / product:5.1%} of a matrix product ({product / 1e9:.1f} G/s)"
            if plain:
                line += f"; the product over all bonds without symmetries has {plain:.2e}, {plain / seconds / product:.0%}"
        request.config.stash.setdefault(LINES, []).append(line + (f"  {note}" if note else ""))

    return keep


PEAK = "\nimport resource\nprint(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"


@pytest.fixture
def in_a_process(benchmark):
    """What lines of Python print in a process of its own, and its peak memory in GB."""

    def run(code, rounds=1):
        command, how = [sys.executable, "-c", code + PEAK], {"check": True, "capture_output": True, "text": True}
        done = benchmark.pedantic(subprocess.run, (command,), how, rounds=rounds, iterations=1)
        *printed, peak = done.stdout.splitlines()
        return "\n".join(printed), int(peak) / 2**20

    return run


LINES = pytest.StashKey()


@pytest.hookimpl(trylast=True)
def pytest_terminal_summary(terminalreporter, config):
    for line in config.stash.get(LINES, []):
        terminalreporter.write_line(line)
    runs = read_runs(FOLDER) if config.getoption("benchmark_autosave", None) else []
    if runs:
        for line in slower_lines(runs, runs[-1]):
            terminalreporter.write_line(line)
