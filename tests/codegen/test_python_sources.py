"""Exported Python: values against the torus at 40 digits, in a process that does not have symfpu, and in this one."""

import subprocess
import sys
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from symfpu import Chain, lindstedt, solve_amplitudes
from symfpu.codegen.languages.mpmath import MPMATH
from symfpu.codegen.languages.numpy import NUMPY
from symfpu.codegen.nested import nest
from symfpu.codegen.torus_program import torus_facts, torus_program
from tests.codegen.test_c99 import assert_close, at_rest, case
from tests.codegen.test_python_series import module
from tests.tolerances import HUNDRED_ROUNDINGS, SOURCE_OF_THIRTY

NAMES = ["one mode", "alpha, one seed", "alpha, two seeds", "mixed, three seeds", "wrapped modes", "beta, four seeds", "alpha, five seeds"]


@pytest.fixture(scope="module", params=NAMES)
def torus(request):
    return case(request.param)


def source(torus, emitter, name="my_torus"):
    return emitter.torus(torus_program(torus, name, torus_facts(torus)))


@pytest.mark.long
def test_numpy_agrees_with_40_digits(torus, tmp_path):
    loaded = module(source(torus, NUMPY), tmp_path / "my_torus.py")
    times = np.concatenate([np.random.default_rng(3).uniform(0, 2000, 12), [0.0, 98765.4321]])
    phases = np.random.default_rng(4).uniform(-3, 3, len(torus.seeds))
    exact = replace(torus, phases={q: mpmath.mpf(phi) for q, phi in zip(torus.seeds, phases, strict=True)})
    at = np.array([mpmath.mpf(t) for t in times], dtype=object)
    assert_close(loaded.positions(times, phases), exact.Q(at))
    assert_close(loaded.momenta(times, phases), exact.P(at))
    assert_close(loaded.energy(times, phases)[:, None], exact.energy(at)[:, None])
    assert loaded.harmonic_energies(times).shape == (len(times), torus.chain.N - 1)


def test_numbers_and_arrays_of_times_have_the_shapes_of_the_torus(torus, tmp_path):
    loaded = module(source(torus, NUMPY), tmp_path / "my_torus.py")
    assert loaded.positions(1.5).shape == torus.Q(1.5).shape
    assert loaded.positions([1.5]).shape == torus.Q([1.5]).shape
    assert loaded.positions([]).shape == (0, torus.chain.N - 1)
    assert np.allclose(loaded.positions(1.5), torus.Q(1.5).astype(float), rtol=0, atol=HUNDRED_ROUNDINGS)  # the default phases
    with pytest.raises(ValueError, match="phases"):
        loaded.positions(1.0, [0.0] * (len(torus.seeds) + 1))


@pytest.mark.long
@pytest.mark.parametrize("emitter", [NUMPY, MPMATH], ids=["numpy", "mpmath"])
def test_a_file_tests_itself_without_symfpu(torus, emitter, tmp_path):
    path = tmp_path / "my_torus.py"
    text = source(torus, emitter)
    path.write_text(text)
    blocked = f"import sys, runpy; sys.modules['symfpu'] = None; runpy.run_path({str(path)!r}, run_name='__main__')"
    run = subprocess.run([sys.executable, "-c", blocked], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stdout.startswith("largest deviation")
    digits = next(i for i, line in enumerate(text.splitlines()) if line.startswith('_COEFFICIENTS_0 = """'))
    lines = text.splitlines()
    largest = max((abs(float(w)), w) for w in lines[digits + 1].split())[1]
    lines[digits + 1] = lines[digits + 1].replace(largest, repr(float(largest) * 1.01), 1)
    path.write_text("\n".join(lines))
    assert subprocess.run([sys.executable, str(path)], capture_output=True, check=False).returncode == 1


def test_mpmath_carries_the_digits_of_the_series(tmp_path):
    series = lindstedt(Chain(16, "0.33"), (1, 2), ("0.19626", "0.39046"), 5, digits=30)
    torus = solve_amplitudes(series)
    loaded = module(source(torus, MPMATH), tmp_path / "my_torus.py")
    with mpmath.workdps(30):
        exact = torus.Q(mpmath.mpf("123.25"))
        ours = loaded.positions("123.25")
        assert max(abs(a - b) for a, b in zip(ours, exact, strict=True)) < mpmath.mpf(10) ** -29
        assert abs(loaded.energy("123.25") - torus.energy(mpmath.mpf("123.25"))) < mpmath.mpf(10) ** -28
    with mpmath.workdps(60):
        more = loaded.positions("123.25")
    assert max(abs(a - b) for a, b in zip(ours, more, strict=True)) < SOURCE_OF_THIRTY  # at any mp.dps


def test_nesting_keeps_every_coefficient(torus):
    program = torus_program(torus, "my_torus", {})
    nested = nest(program.blocks, program.seeds)
    for block, slices in zip(program.blocks, nested.slices, strict=True):
        found = {}
        for part in slices:
            for n, row in enumerate(part.coefficients):
                harmonic = (*nested.leading[part.leading].tolist(), *nested.trailing[part.start + n].tolist())
                assert harmonic not in found
                found[harmonic] = row
        for harmonic, row in zip(block.harmonics.tolist(), block.coefficients, strict=True):
            assert (found.pop(tuple(harmonic)) == row).all()
        assert not any(row.any() for row in found.values())


@pytest.mark.parametrize("emitter", [NUMPY, MPMATH], ids=["numpy", "mpmath"])
def test_a_torus_at_rest_stays_there(emitter, tmp_path):
    loaded = module(source(at_rest(), emitter), tmp_path / "my_torus.py")
    assert [list(values) for values in loaded.orbit(2.5)] == [[0, 0, 0, 0]] * 2
    assert loaded.energy(2.5) == 0
