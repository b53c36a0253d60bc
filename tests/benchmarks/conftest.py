"""Benchmarks print what they measured: seconds, multiply-adds, rate, and the ratio to a matrix product timed beside them."""

import time

import numpy as np
import pytest

MATRIX = 1500


def matrix_rate():
    """Multiply-adds a second of a float64 matrix product on all threads, the best of five."""
    a = np.random.default_rng(1).random((MATRIX, MATRIX))
    a @ a
    seconds = []
    for _ in range(5):
        start = time.perf_counter()
        a @ a
        seconds.append(time.perf_counter() - start)
    return MATRIX**3 / min(seconds)


@pytest.fixture
def record(benchmark, request):
    """Keep a line for the summary: seconds, and if given multiply-adds, their rate and ratio to a matrix product.

    plain : multiply-adds of the same result without the symmetries, for their ratio.
    """

    def keep(name, *, multiply_adds=None, plain=None, note=""):
        seconds = benchmark.stats.stats.median
        line = f"{name:<58} {seconds:9.3f} s"
        if multiply_adds:
            rate, product = multiply_adds / seconds, matrix_rate()
            line += f"  {multiply_adds:.3e} multiply-adds  {rate / 1e9:6.2f} G/s"
            line += f" = {rate / product:5.1%} of a matrix product ({product / 1e9:.1f} G/s)"
            if plain:
                line += f"; the product over all bonds without symmetries has {plain:.2e}, {plain / seconds / product:.0%}"
        request.config.stash.setdefault(LINES, []).append(line + (f"  {note}" if note else ""))

    return keep


LINES = pytest.StashKey()


def pytest_terminal_summary(terminalreporter, config):
    for line in config.stash.get(LINES, []):
        terminalreporter.write_line(line)
