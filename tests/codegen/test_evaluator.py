"""The loader: the same values and shapes as the torus, whichever backend, and no backend that was not asked for."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from symfpu import Chain, InputError, SymfpuError, compile_evaluator, lindstedt, refine, solve_amplitudes
from symfpu.codegen import evaluator as module
from symfpu.codegen.evaluator import CompiledFunctions, find_compiler
from tests.codegen.compilers import program
from tests.codegen.test_c99 import OF_LARGEST, angles, assert_close, case, random_times
from tests.every_result import COPIES
from tests.system import files_up_to

LARGEST_TIME = 100  # NumPy rounds omega t: half a last place of it is 1e-14


@pytest.fixture(scope="module")
def torus():
    return case("mixed, three seeds")


@pytest.fixture(scope="module")
def refined():
    """By Newton's method: no series."""
    series = lindstedt(Chain(8, alpha="1/3", beta="0.2"), (1, 3), ("0.3904", "1.1118"), 4)
    return refine(solve_amplitudes(series, phases={1: 0.4, 3: -1.3}), tolerance=1e-9)


@pytest.fixture
def backend(request):
    """Its name, where it can run."""
    if request.param == "c":
        program("gcc")
    return request.param


@pytest.mark.parametrize("solution", ["torus", "refined"])
@pytest.mark.parametrize("backend", ["c", "numpy"], indirect=True)
def test_values_are_those_of_the_torus(solution, backend, request):
    torus = request.getfixturevalue(solution)
    evaluator, draw = compile_evaluator(torus, backend=backend), np.random.default_rng(3)
    t = random_times(draw, 5) % LARGEST_TIME
    other = angles(draw, torus.seeds)
    assert np.array_equal(evaluator.Q(t, other), evaluator.Q(t, list(other.values())))
    for phases, exact in ((None, torus), (other, replace(torus, phases=other))):
        assert_close(evaluator.Q(t, phases), exact.Q(t))
        assert_close(evaluator.P(t, phases), exact.P(t))
        assert_close(evaluator.harmonic_energies(t, phases=phases), exact.harmonic_energies(t))
        assert_close(evaluator.energy(t, phases)[:, None], exact.energy(t)[:, None])


@pytest.mark.parametrize("backend", ["c", "numpy"], indirect=True)
def test_shapes_follow_the_times(torus, backend):
    evaluator = compile_evaluator(torus, backend=backend)
    for along in (evaluator.Q, evaluator.P, evaluator.harmonic_energies):
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
    moved = evaluator.Q(3.0, {2: 0.5})
    assert moved == pytest.approx(evaluator.Q(3.0, torus.phases | {2: 0.5}), rel=OF_LARGEST)
    assert np.abs(moved - evaluator.Q(3.0)).max() > 0.01


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
        compile_evaluator(torus, backend=backend).Q(t, phases)


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


def test_a_full_disk_is_told_with_the_file_that_finds_no_room(torus, monkeypatch):
    """The limit of the size of a file, which the system tells as it tells a full disk."""
    monkeypatch.setenv("CC", "true")
    with files_up_to(100), pytest.raises(SymfpuError, match=r"/symfpu-.*\.c: File too large; make room there"):
        compile_evaluator(torus, backend="c")


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


@pytest.mark.parametrize("way", COPIES)
def test_a_compiled_evaluator_comes_back_and_answers_the_same(way):
    program("gcc")
    evaluator = compile_evaluator(case("alpha, one seed", digits=None), backend="c")
    returned = COPIES[way](evaluator)
    t = [0.0, 1.7, 100.0]
    assert repr(returned) == repr(evaluator)
    assert np.array_equal(returned.Q(t, {1: 0.5}), evaluator.Q(t, {1: 0.5}))
    assert np.array_equal(returned.energy(), evaluator.energy())


def test_an_evaluator_that_arrives_where_no_compiler_is_says_so(monkeypatch):
    sent = pickle.dumps(CompiledFunctions("int nothing;\n", 7, None))
    monkeypatch.setattr(module, "find_compiler", lambda: None)
    with pytest.raises(SymfpuError, match="no C compiler"):
        pickle.loads(sent)
