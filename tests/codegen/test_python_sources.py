"""Exported Python: values against the torus at 40 digits, in a process that does not have symfpu, and in this one."""

import importlib.util
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.codegen.languages.mpmath import MPMATH
from symfpu.codegen.languages.numpy import NUMPY
from symfpu.codegen.nested import nest
from symfpu.codegen.torus_program import replace_digits, torus_facts, torus_program
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.quasiperiodic import FourierTorus
from tests.tolerances import HUNDRED_ROUNDINGS, SOURCE_OF_THIRTY

LARGEST, TAIL = 1e-13, 1e-12  # of the largest coordinate, and of each mode's own largest: sums of some thousand rounded terms

CASES = {  # amplitudes whose lowest shift gives the frequencies
    "one mode": (Chain(2, beta="0.5"), {1: 0.3}, 4),
    "one seed": (Chain(8, "0.3"), {1: 0.2}, 2),
    "two seeds, alpha": (Chain(16, "0.33"), {1: 0.3, 2: 0.2}, 8),
    "beta, wrapped": (Chain(11, beta="0.3"), {9: 0.05, 10: 0.06}, 3),
    "mixed": (Chain(9, "0.25", "0.1"), {2: 0.1}, 5),
    "three seeds": (Chain(12, "0.2"), {1: 0.05, 2: 0.04, 3: 0.03}, 4),
    "five seeds": (Chain(16, beta="0.2"), {1: 0.02, 2: 0.03, 3: 0.02, 4: 0.03, 5: 0.02}, 2),
}


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES.keys())
def torus(request):
    chain, amplitudes, order = request.param
    shifts, linear = frequency_shift(chain, amplitudes), chain.frequencies()
    frequencies = [float(linear[q - 1] + shifts[q]) for q in amplitudes]
    found = solve_amplitudes(lindstedt(chain, tuple(amplitudes), frequencies, order))
    return replace(found, phases={q: 0.3 * i - 0.5 for i, q in enumerate(amplitudes)})


def source(torus, emitter, name="my_torus"):
    return emitter.torus(torus_program(torus, name, torus_facts(torus)))


def module(text, path):
    path.write_text(text)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def check(ours, exact):
    """Relative to the largest coordinate, and each mode relative to itself."""
    exact = np.array(exact)
    error = np.abs(np.array([[mpmath.mpf(float(x)) for x in row] for row in ours], dtype=object) - exact)
    own = np.abs(exact).max(axis=0)
    assert error.max() <= LARGEST * own.max()
    assert all(e <= TAIL * o for e, o in zip(error.max(axis=0), own, strict=True))


@pytest.mark.long
def test_numpy_agrees_with_40_digits(torus, tmp_path):
    loaded = module(source(torus, NUMPY), tmp_path / "my_torus.py")
    times = np.concatenate([np.random.default_rng(3).uniform(0, 2000, 12), [0.0, 98765.4321]])
    phases = np.random.default_rng(4).uniform(-3, 3, len(torus.seeds))
    exact = replace_digits(replace(torus, phases=dict(zip(torus.seeds, phases, strict=True))), 40)
    with mpmath.workdps(40):
        at = np.array([mpmath.mpf(float(t)) for t in times], dtype=object)
        check(loaded.positions(times, phases), exact.positions(at))
        check(loaded.momenta(times, phases), exact.momenta(at))
        energies = exact.energy(at)
        assert max(abs(mpmath.mpf(float(a)) / b - 1) for a, b in zip(loaded.energy(times, phases), energies, strict=True)) < LARGEST
    assert loaded.harmonic_energies(times).shape == (len(times), torus.chain.N - 1)


def test_numbers_and_arrays_of_times_have_the_shapes_of_the_torus(torus, tmp_path):
    loaded = module(source(torus, NUMPY), tmp_path / "my_torus.py")
    assert loaded.positions(1.5).shape == torus.positions(1.5).shape
    assert loaded.positions([1.5]).shape == torus.positions([1.5]).shape
    assert loaded.positions([]).shape == (0, torus.chain.N - 1)
    assert np.allclose(loaded.positions(1.5), torus.positions(1.5), rtol=0, atol=HUNDRED_ROUNDINGS)  # the default phases
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
        exact = torus.positions(mpmath.mpf("123.25"))
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
    seeds, frequencies = (1, 2), (Fraction(5, 8), Fraction(19, 16))
    rest = FourierTorus(Chain(5, alpha=1), seeds, frequencies, np.zeros((1, 2), dtype=int), np.zeros((1, 4)), {1: 0.0, 2: 0.0})
    loaded = module(source(rest, emitter), tmp_path / "my_torus.py")
    assert [list(values) for values in loaded.orbit(2.5)] == [[0, 0, 0, 0]] * 2
    assert loaded.energy(2.5) == 0


@pytest.mark.long
@pytest.mark.parametrize("emitter", [NUMPY, MPMATH], ids=["numpy", "mpmath"])
def test_the_same_program_gives_the_same_bytes_in_short_lines(torus, emitter):
    first, second = source(torus, emitter), source(torus, emitter)
    assert first == second
    assert max(map(len, first.splitlines())) <= 140
    assert "written by a machine" in first.lower()
