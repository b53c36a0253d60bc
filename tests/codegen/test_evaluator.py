"""The loader: the same values and shapes as the torus, whichever backend, and no backend that was not asked for."""

from dataclasses import replace

import numpy as np
import pytest

from symfpu.codegen.evaluator import compile_evaluator, find_compiler
from symfpu.errors import InputError, SymfpuError
from tests.codegen.compilers import program
from tests.codegen.test_c99 import OF_LARGEST, angles, assert_close, case, random_times

LARGEST_TIME = 100  # NumPy rounds omega t: half a last place of it is 1e-14


@pytest.fixture(scope="module")
def torus():
    return case("mixed, three seeds")


@pytest.fixture
def backend(request):
    """Its name, where it can run."""
    if request.param == "c":
        program("gcc")
    return request.param


@pytest.mark.parametrize("backend", ["c", "numpy"], indirect=True)
def test_values_are_those_of_the_torus(torus, backend):
    evaluator, draw = compile_evaluator(torus, backend=backend), np.random.default_rng(3)
    t = random_times(draw, 21) % LARGEST_TIME
    other = angles(draw, torus.seeds)
    for phases, exact in ((None, torus), (other, replace(torus, phases=other)), (list(other.values()), replace(torus, phases=other))):
        assert_close(evaluator.positions(t, phases), exact.positions(t))
        assert_close(evaluator.momenta(t, phases), exact.momenta(t))
        assert_close(evaluator.harmonic_energies(t, phases=phases), exact.harmonic_energies(t))
        assert_close(evaluator.energy(t, phases)[:, None], exact.energy(t)[:, None])


@pytest.mark.parametrize("backend", ["c", "numpy"], indirect=True)
def test_shapes_follow_the_times(torus, backend):
    evaluator = compile_evaluator(torus, backend=backend)
    for along in (evaluator.positions, evaluator.momenta, evaluator.harmonic_energies):
        assert along(1.0).shape == (7,)
        assert along([0.0, 1.0, 2.0]).shape == (3, 7)
        assert along([]).shape == (0, 7)
        assert along([0.0, 1.0])[1].tolist() == pytest.approx(along(1.0).tolist(), rel=OF_LARGEST)
    assert evaluator.energy().shape == ()
    assert evaluator.energy([0.0, 1.0]).shape == (2,)
    assert f"backend='{backend}'" in repr(evaluator)


@pytest.mark.parametrize("backend", ["c", "numpy"], indirect=True)
def test_a_phase_left_out_is_that_of_the_torus(torus, backend):
    evaluator = compile_evaluator(torus, backend=backend)
    moved = evaluator.positions(3.0, {2: 0.5})
    assert moved == pytest.approx(evaluator.positions(3.0, torus.phases | {2: 0.5}), rel=OF_LARGEST)
    assert np.abs(moved - evaluator.positions(3.0)).max() > 0.01


@pytest.mark.parametrize("backend", ["c", "numpy"], indirect=True)
@pytest.mark.parametrize(
    ("argument", "t", "phases"),
    [
        ("t", [[0.0]], None),
        ("t", float("nan"), None),
        ("t", "soon", None),
        ("phases", 0.0, [0.1]),
        ("phases", 0.0, {7: 0.1}),
        ("phases", 0.0, [0.1, 0.2, float("inf")]),
        ("phases", 0.0, "none"),
    ],
)
def test_bad_arguments_are_refused(torus, backend, argument, t, phases):
    with pytest.raises(InputError, match=rf"^{argument} = "):
        compile_evaluator(torus, backend=backend).positions(t, phases)


def test_unknown_backend(torus):
    with pytest.raises(InputError, match=r"^backend = 'fortran': allowed is one of c, numpy"):
        compile_evaluator(torus, backend="fortran")


def test_a_compiler_that_fails_says_why(torus, monkeypatch, tmp_path):
    bad = tmp_path / "bad"
    bad.write_text("#!/bin/sh\necho 'no such target' >&2\necho 'second line' >&2\nexit 3\n")
    bad.chmod(0o755)
    monkeypatch.setenv("CC", str(bad))
    for backend in ("c", None):
        with pytest.raises(SymfpuError, match=r"failed: no such target; set CC"):
            compile_evaluator(torus, backend=backend)


def test_a_compiler_that_is_not_there(torus, monkeypatch):
    monkeypatch.setenv("CC", "/nowhere/cc")
    with pytest.raises(SymfpuError, match=r"/nowhere/cc does not start: No such file"):
        compile_evaluator(torus, backend="c")


def test_without_a_compiler_numpy_is_the_default_and_c_is_refused(torus, monkeypatch, tmp_path):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert find_compiler() is None
    assert compile_evaluator(torus).backend == "numpy"
    with pytest.raises(SymfpuError, match="no C compiler"):
        compile_evaluator(torus, backend="c")


def test_with_a_compiler_c_is_the_default(torus):
    program("gcc")
    assert compile_evaluator(torus).backend == "c"
