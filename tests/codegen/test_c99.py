"""Exported C against the series at forty digits: what a stranger's compiler makes of the file, and nothing of ours."""

import ctypes
from dataclasses import replace
from fractions import Fraction
from functools import cache

import mpmath
import numpy as np
import pytest

from symfpu import Chain, FromSeries, Torus
from symfpu.codegen.languages.c import C
from symfpu.codegen.torus_program import torus_facts, torus_program
from tests.codegen import series_cases
from tests.codegen.compilers import c_self_test, library_of, pointer
from tests.codegen.series_cases import OF_LARGEST, assert_close  # noqa: F401 (for other languages, too)

# Every amplitude is chosen freely: a sum of cosines need not be a torus to be evaluated.
CASES = {name: case for name, case in series_cases.CASES.items() if name != "high order"}
CASES["lennard-jones"] = Chain(6, potential="lj:13/2,6"), (2,), ("1.0078125",), 3, 0


@cache
def case(name, digits=series_cases.DIGITS):
    """A case with amplitudes and phases drawn once."""
    _, seeds, _, order, _ = CASES[name]
    draw = np.random.default_rng(len(name))
    series = series_cases.numeric(CASES[name], digits=digits)
    number = float if digits is None else mpmath.mpf
    amplitudes = tuple(number(draw.uniform(0.05, 0.3)) for _ in seeds)
    return FromSeries(series, amplitudes, frequency_order=0, order=order).torus(angles(draw, seeds))


def angles(draw, seeds):
    """Random phases with few binary places: a double and its shortest decimal are one number."""
    return {q: float(np.round(draw.uniform(-3, 3) * 64) / 64) for q in seeds}


def random_times(draw, count):
    """Times of all sizes that are exact in double and decimal: 19 is more than a block of sixteen."""
    return np.round(draw.uniform(-1, 1, count) * 10.0 ** draw.integers(0, 7, count) * 64) / 64


def program(torus, name="sample"):
    return torus_program(torus, name, torus_facts(torus))


def call(library, name, t, phases, shape):
    values = np.full(shape, np.nan)
    angles = None if phases is None else np.array(phases, dtype=float)
    getattr(library, name)(ctypes.c_size_t(len(t)), pointer(t), pointer(angles), pointer(values))
    return values


def at_rest():
    """A torus of a chain that does not move."""
    harmonics, cosines = np.zeros((1, 2), dtype=int), np.zeros((1, 4))
    return Torus(Chain(5, alpha=1), (1, 2), (Fraction(5, 8), Fraction(19, 16)), harmonics, cosines, {1: 0.0, 2: 0.0})


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_values_are_those_of_the_series_at_forty_digits(name, tmp_path):
    torus = case(name)
    draw = np.random.default_rng(5)
    t, modes = random_times(draw, 19), torus.chain.N - 1
    library = library_of(tmp_path, C.torus(program(torus)))
    for phases in (None, angles(draw, torus.seeds)):
        exact = torus if phases is None else replace(torus, phases=phases)
        given = None if phases is None else list(phases.values())
        Q, P = exact.Q(t), exact.P(t)
        assert_close(call(library, "sample_positions", t, given, (19, modes)), Q)
        assert_close(call(library, "sample_momenta", t, given, (19, modes)), P)
        assert_close(call(library, "sample_harmonic_energies", t, given, (19, modes)), exact.harmonic_energies(t))
        assert_close(call(library, "sample_energy", t, given, (19,))[:, None], exact.energy(t)[:, None])


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_self_test_of_the_file(name, tmp_path):
    run = c_self_test(tmp_path, C.torus(program(case(name))), "-O0")
    assert run.returncode == 0, run.stdout
    assert "at most 1e-13" in run.stdout


def test_self_test_sees_a_changed_coefficient(tmp_path):
    torus = case("alpha, one seed", digits=None)
    broken = program(torus)
    largest = max((c for block in broken.blocks for c in block.coefficients.flat), key=abs)
    source = C.torus(broken)
    at = source.index("coefficients_")
    assert repr(float(largest)) in source[at:]
    source = source[:at] + source[at:].replace(repr(float(largest)), repr(float(largest) * (1 + 1e-11)))
    run = c_self_test(tmp_path, source)
    assert run.returncode == 1
    assert "ABOVE 1e-13" in run.stdout


def test_a_torus_at_rest(tmp_path):
    assert c_self_test(tmp_path, C.torus(program(at_rest()))).returncode == 0
