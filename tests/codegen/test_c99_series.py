"""Exported C of series with free amplitudes against the series at forty digits, through a compiler and nothing of ours."""

import ctypes
import functools
import re
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from symfpu.codegen.languages.c import C
from tests.codegen import series_cases, test_c99
from tests.codegen.compilers import c_self_test, compile_c, library_of, pointer
from tests.codegen.series_cases import CASES, OF_TAIL, UNIVERSAL, assert_close, drawn, expected_orbit, numeric, program_of, universal

TOO_SLOW_AS_STATEMENTS = {"high order", "beta, four seeds", "alpha, five seeds"}  # seconds of SymPy each

NUMERIC = [*(("tables", name) for name in CASES), *(("statements", name) for name in CASES if name not in TOO_SLOW_AS_STATEMENTS)]
EVERY = [*NUMERIC, *(("universal", name) for name in UNIVERSAL)]
FEW = [("tables", "wrapped modes"), ("statements", "wrapped modes"), ("universal", "mixed, one mode")]


def case_of(form, name):
    return UNIVERSAL[name] if form == "universal" else CASES[name]


def made(form, name, called="sample"):
    """The program of a case in this form."""
    if form == "universal":
        return program_of(universal(UNIVERSAL[name]), UNIVERSAL[name], called)
    program = program_of(numeric(CASES[name]), CASES[name], called, form)
    assert (program.tables is None) == (form == "statements")
    return program


@functools.cache
def source_of(form, name):
    return C.series(made(form, name))


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """The library of a case in a form, compiled once."""

    @functools.cache
    def shared(form, name):
        return library_of(tmp_path_factory.mktemp("shared"), source_of(form, name))

    return shared


def orbit(library, case, times, amplitudes, phases, frequencies):
    """Q and P, which the two functions for one of them give too."""
    t, shape = np.array(times, dtype=float), (len(times), case[0].N - 1)
    given = [ctypes.c_size_t(len(t)), *map(pointer, (t, amplitudes, phases, frequencies))]
    Q, P, alone_Q, alone_P = (np.full(shape, np.nan) for _ in range(4))
    assert library.sample_orbit(*given, pointer(Q), pointer(P)) == 0
    assert library.sample_positions(*given, pointer(alone_Q)) == 0
    assert library.sample_momenta(*given, pointer(alone_P)) == 0
    assert np.array_equal(Q, alone_Q)
    assert np.array_equal(P, alone_P)
    return Q, P


def corrected(library, form, case, amplitudes, frequencies):
    s = len(case[1])
    given = (amplitudes, frequencies) if form == "universal" else (amplitudes,)
    omega, alone, jacobian = np.full(s, np.nan), np.full(s, np.nan), np.full((s, s), np.nan)
    library.sample_corrected_frequencies(*map(pointer, given), pointer(omega), pointer(jacobian))
    library.sample_corrected_frequencies(*map(pointer, given), pointer(alone), None)
    assert np.array_equal(omega, alone)
    return omega, jacobian


@pytest.mark.long
@pytest.mark.parametrize(("form", "name"), EVERY)
def test_values_are_those_of_the_series_at_forty_digits(form, name, shared):
    case = case_of(form, name)
    library = shared(form, name)
    amplitudes, phases, others, times = drawn(case)
    divisors = np.array(case[2], dtype=float)
    frequencies = divisors if form == "universal" else others
    Q, P = orbit(library, case, times, amplitudes, phases, frequencies)
    exact_Q, exact_P = expected_orbit(case, amplitudes, phases, frequencies, times)
    assert_close(Q, exact_Q)
    assert_close(P, exact_P)
    series_cases.assert_frequencies(*corrected(library, form, case, amplitudes, divisors), case, amplitudes)


@pytest.mark.parametrize(("form", "name"), FEW)
def test_phases_are_zero_by_default_and_far_times_keep_their_digits(form, name, shared):
    case = case_of(form, name)
    library = shared(form, name)
    amplitudes, _, _, _ = drawn(case)
    frequencies, times = np.array(case[2], dtype=float), [0.0, 1e15, -123456789012345.0]
    exact = expected_orbit(case, amplitudes, [0.0] * len(case[1]), frequencies, times)
    for values, expected in zip(orbit(library, case, times, amplitudes, None, frequencies), exact, strict=True):
        assert_close(values, expected)


@pytest.mark.long
@pytest.mark.parametrize(("form", "name"), NUMERIC)
def test_frequencies_are_the_corrected_ones_by_default(form, name, shared):
    case = case_of(form, name)
    library = shared(form, name)
    amplitudes, phases, _, _ = drawn(case)
    times = [0.0, 0.5, -3.0]
    omega = np.array(series_cases.expected_frequencies(case, amplitudes)[0], dtype=float)
    exact_Q, exact_P = expected_orbit(case, amplitudes, phases, omega, times)
    Q, P = orbit(library, case, times, amplitudes, phases, None)
    assert_close(Q, exact_Q)
    assert_close(P, exact_P)


def test_divisors_need_frequencies(shared):
    library = shared("universal", "mixed, one mode")
    t, A, Q = np.zeros(1), np.full(1, 0.1), np.full(1, 7.0)
    assert library.sample_positions(ctypes.c_size_t(1), pointer(t), pointer(A), None, None, pointer(Q)) == 2
    assert Q[0] == 7


@pytest.mark.long
@pytest.mark.parametrize(("form", "name"), EVERY)
def test_self_test_of_the_file(form, name, tmp_path):
    run = c_self_test(tmp_path, source_of(form, name), "-O0")
    assert run.returncode == 0, run.stdout
    assert "at most 1e-13" in run.stdout


@pytest.mark.parametrize(
    ("form", "after"), [("tables", " coefficients_0["), ("tables", " frequency_coefficients["), ("statements", " c1_3 =")]
)
def test_self_test_sees_a_changed_coefficient(form, after, tmp_path):
    source = source_of(form, "wrapped modes")
    at = source.index(after) + len(after)
    first = re.compile(r"\d\.\d+(e-\d+)?").search(source, at)
    broken = source[: first.start()] + repr(float(first.group()) * (1 + 1e-9)) + source[first.end() :]
    run = c_self_test(tmp_path, broken)
    assert run.returncode == 1
    assert "ABOVE 1e-13" in run.stdout


MAIN = """
#include <stdio.h>
#include <stddef.h>
int first_orbit(size_t, const double *, const double *, const double *, const double *, double *, double *);
int second_orbit(size_t, const double *, const double *, const double *, const double *, double *, double *);
int third_orbit(size_t, const double *, const double *, const double *, const double *, double *, double *);
void torus_orbit(size_t, const double *, const double *, double *, double *);
int main(void)
{
    const double t[1] = {2.5}, A[2] = {0.125, 0.0625}, omega[2] = {1.421875, 1.859375};
    double Q[3], P[3], q[3], p[3], u[1], v[1], x[7], y[7];
    int bad = first_orbit(1, t, A, NULL, omega, Q, P) + second_orbit(1, t, A, NULL, omega, q, p)
              + third_orbit(1, t, A, NULL, omega, u, v);
    torus_orbit(1, t, NULL, x, y);
    printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\\n", Q[0], P[2], q[0], p[2], u[0], v[0], x[0], y[6]);
    return bad;
}
"""


def test_files_of_every_form_in_one_program(tmp_path):
    """Series and a torus."""
    torus = test_c99.case("alpha, one seed")
    programs = {called: made(form, name, called) for called, (form, name) in zip(("first", "second", "third"), FEW, strict=True)}
    sources = {f"{called}.c": C.series(program) for called, program in programs.items()}
    sources["torus.c"] = C.torus(test_c99.program(torus, "torus"))
    run = subprocess.run([compile_c(tmp_path, {**sources, "main.c": MAIN})], capture_output=True, text=True, check=True)
    two = expected_orbit(CASES["wrapped modes"], [0.125, 0.0625], [0.0, 0.0], [1.421875, 1.859375], [2.5])
    one = expected_orbit(UNIVERSAL["mixed, one mode"], [0.125], [0.0], [1.421875], [2.5])
    expected = [two[0][0, 0], two[1][0, 2]] * 2 + [one[0][0, 0], one[1][0, 0], torus.Q(2.5)[0], torus.P(2.5)[6]]
    assert np.array(run.stdout.split(), dtype=float) == pytest.approx(np.array(expected, dtype=float), rel=OF_TAIL)


def test_more_threads_than_one_see_the_same(tmp_path):
    """Nothing outside of what the caller gives is written: no writable data in the object file."""
    if not shutil.which("size"):
        pytest.skip("no size command")
    for form, name in FEW:
        compile_c(tmp_path, {"sample.c": source_of(form, name)}, "-c", output="sample.o")
        run = subprocess.run(["size", "-A", "sample.o"], cwd=tmp_path, capture_output=True, text=True, check=True)
        sizes = {words[0]: int(words[1]) for words in map(str.split, run.stdout.splitlines()) if words and words[0] in (".data", ".bss")}
        assert sizes == {".data": 0, ".bss": 0}


@pytest.mark.parametrize(("form", "name"), FEW)
def test_facts_stay_in_their_comment_and_lines_are_short(form, name, tmp_path):
    called = "n" * 40  # the longest name that export allows
    program = made(form, name, called)
    facts = {"command": "export */ #error here /* ??/ \\", "title": "x" * 300, **program.facts}
    source = C.series(replace(program, facts=facts))
    compile_c(tmp_path, {"sample.c": source}, f"-D{called}_SELF_TEST")
    assert max(map(len, source.splitlines())) < 120
    assert source.isascii()
    assert "#error here" in source
    assert "hash of the series" in source
