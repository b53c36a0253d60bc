"""Exported evaluators of the 4-torus (N = 32, order 11): Q and P at 1e5 times, emission, size, compilation. Measured, not asserted."""

import ctypes
import importlib.util
import shutil
import subprocess

import numpy as np
import pytest

from symfpu import compile_evaluator, export, lindstedt, solve_amplitudes
from symfpu.codegen.languages.c import C
from symfpu.codegen.series_program import series_facts, series_program
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS
from tests.benchmarks.history import seconds

TIMES = 100_000
DRIVER = """#include <stdlib.h>
#include <stddef.h>
void four_torus_orbit(size_t count, const double *t, const double *phases, double *Q, double *P);
int main(void)
{
    size_t i, n = 100000;
    double *t = malloc(n * sizeof *t), *Q = malloc(n * 31 * sizeof *Q), *P = malloc(n * 31 * sizeof *P);
    if (!t || !Q || !P) return 1;
    for (i = 0; i < n; i++) t[i] = (double)i;
    four_torus_orbit(n, t, NULL, Q, P);
    return Q[5] == 0.5;
}
"""


@pytest.fixture(scope="module")
def torus():
    printed = APPENDIX_F[0]
    return solve_amplitudes(lindstedt(printed.chain, printed.seeds, printed.frequencies, 11))


@pytest.fixture
def multiply_adds(torus):
    """Without the coefficients that parity makes zero, Q and P."""
    return 2 * TIMES * int((torus.cosines != 0).sum())


def test_numpy(benchmark, record, torus, tmp_path, multiply_adds):
    path = export(torus, "numpy", tmp_path / "four_torus")
    spec = importlib.util.spec_from_file_location("four_torus", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    benchmark.pedantic(module.orbit, (np.arange(float(TIMES)),), rounds=1, iterations=1)
    record("4-torus, Q and P at 1e5 times, NumPy", multiply_adds=multiply_adds, note=f"{path.stat().st_size / 1e6:.1f} MB of source")


@pytest.mark.skipif(not shutil.which("gcc"), reason="no C compiler")
def test_c(benchmark, record, torus, tmp_path, multiply_adds):
    path = tmp_path / "four_torus.c"
    emitted = seconds(lambda: export(torus, "c", path))
    (tmp_path / "driver.c").write_text(DRIVER)
    command = ["gcc", "-std=c99", "-O2", str(path), "driver.c", "-o", "driver", "-lm"]
    compiled = seconds(lambda: subprocess.run(command, check=True, cwd=tmp_path))
    benchmark.pedantic(subprocess.run, ([str(tmp_path / "driver")],), {"check": True}, rounds=3, iterations=1)
    note = f"emitted in {emitted:.1f} s, {path.stat().st_size / 1e6:.1f} MB, compiled in {compiled:.1f} s"
    record("4-torus, Q and P at 1e5 times, C at -O2, one core", multiply_adds=multiply_adds, note=note)


@pytest.mark.skipif(not shutil.which("gcc"), reason="no C compiler")
def test_evaluator(benchmark, record, torus, multiply_adds):
    evaluator = compile_evaluator(torus)
    times = np.arange(float(TIMES))
    benchmark.pedantic(lambda: (evaluator.Q(times), evaluator.P(times)), rounds=1, iterations=1)
    record("4-torus, positions and momenta at 1e5 times, compile_evaluator", multiply_adds=multiply_adds)


@pytest.mark.skipif(not shutil.which("octave-cli"), reason="no Octave")
def test_octave(benchmark, record, torus, tmp_path, multiply_adds):
    path = export(torus, "octave", tmp_path / "four_torus")
    command = ["octave-cli", "--norc", "--path", str(tmp_path), "--eval", f"[Q, P] = four_torus(0:{TIMES - 1});"]
    benchmark.pedantic(subprocess.run, (command,), {"check": True, "capture_output": True}, rounds=1, iterations=1)
    record("4-torus, Q and P at 1e5 times, Octave", multiply_adds=multiply_adds, note=f"{path.stat().st_size / 1e6:.1f} MB of source")


@pytest.mark.skipif(not shutil.which("gcc"), reason="no C compiler")
@pytest.mark.parametrize("form", ["statements", "tables"])
@pytest.mark.parametrize("order", [2, 3, 4, 6])
def test_series_in_c(benchmark, record, order, form, tmp_path):
    """Where straight-line code ends and tables begin: 2-torus of Fig. 1 with free amplitudes."""
    series = lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, order)
    most = 10**9 if form == "statements" else 0
    path = tmp_path / "free.c"
    program = series_program(series, "free", series_facts(series), straight_line=most)
    path.write_text(C.series(program))
    command = ["gcc", "-std=c99", "-O2", "-shared", "-fPIC", str(path), "-o", str(tmp_path / "free.so"), "-lm"]
    compiled = seconds(lambda: subprocess.run(command, check=True))
    function = ctypes.CDLL(str(tmp_path / "free.so")).free_orbit
    t, A, Q, P = np.arange(float(TIMES)), np.array([0.3, 0.2]), np.empty((TIMES, 15)), np.empty((TIMES, 15))

    def call(count):
        pointers = [ctypes.c_void_p(x.ctypes.data) for x in (t, A)]
        function(ctypes.c_size_t(count), *pointers, None, None, ctypes.c_void_p(Q.ctypes.data), ctypes.c_void_p(P.ctypes.data))

    one = seconds(lambda: [call(1) for _ in range(1000)])
    benchmark.pedantic(call, (TIMES,), rounds=5, iterations=1)
    operations = program.straight
    size = "" if operations is None else f"{operations.operations} operations, "
    record(f"series of order {order}, 1e5 times, C, {form}", note=f"{size}compiled in {compiled:.2f} s, one time {one * 1e3:.1f} us")
