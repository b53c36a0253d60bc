"""Universal series of any size: files with tables of operations in every language, against the series and its derivatives."""

import ctypes
import re
import subprocess
import sys

import numpy as np
import pytest

from symfpu import Chain, InputError, export, lindstedt, save, solve_amplitudes
from symfpu.cli.main import main
from symfpu.codegen.export import LANGUAGES
from tests.codegen import test_fortran
from tests.codegen.compilers import c_self_test, library_of, pointer
from tests.codegen.test_octave import arrays, listed, octave
from tests.codegen.test_python_series import module
from tests.codegen.universal_cases import CASES, TIMES, expected, given, program, series
from tests.tolerances import OF_LARGEST

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together

build = test_fortran.build  # a fixture
KINDS = ("Q", "P", "omega", "jacobian", "dQ", "dP", "slopes")

DRIVER = """\
program driver
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use sample
  implicit none
  real(rk) :: t(TIMES), A(SEEDS), phi(SEEDS), w(SEEDS), Q(MODES, TIMES), P(MODES, TIMES), omega(SEEDS)
  real(rk) :: jacobian(SEEDS, SEEDS), slopes(SEEDS, SEEDS), dQ(MODES, TIMES, SEEDS), dP(MODES, TIMES, SEEDS)
  read *, t, A, phi, w
  call orbit(t, A, w, Q, P, phi)
  call corrected_frequencies(A, w, omega, jacobian)
  call orbit_by_frequencies(t, A, w, dQ, dP, phi)
  call corrected_by_frequencies(A, w, slopes)
  print '(es26.17e3)', Q, P, omega, transpose(jacobian), dQ, dP, transpose(slopes)
  call positions(t, A, w, Q, phi)
  call momenta(t, A, w, P, phi)
  print '(es26.17e3)', Q, P
end program driver
"""


def source(language, name):
    return LANGUAGES[language].series(program(name))


def from_numpy(name, folder):
    ours, (A, phases, omega) = module(source("numpy", name), folder / "sample.py"), given(name)
    assert 0 <= ours.self_test() <= ours.TOLERANCE
    one = ours.orbit_by_frequencies(TIMES[1], A, omega, phases)
    every = ours.orbit_by_frequencies(TIMES, A, omega, phases)
    for alone, together in zip(one, every, strict=True):
        assert np.abs(alone - together[:, 1]).max() <= OF_LARGEST * np.abs(together).max()
    corrected = ours.corrected_frequencies(A, omega)
    return *ours.orbit(TIMES, A, omega, phases), *corrected, *every, ours.corrected_by_frequencies(A, omega)


def from_mpmath(name, folder):
    ours, (A, phases, omega) = module(source("mpmath", name), folder / "sample.py"), given(name)
    assert 0 <= ours.self_test() <= ours.TOLERANCE
    orbits = [ours.orbit(t, A, omega, phases) for t in TIMES]
    moved = [ours.orbit_by_frequencies(t, A, omega, phases) for t in TIMES]
    by_time = [np.array(part, dtype=float) for part in zip(*moved, strict=True)]
    found = [np.array(part, dtype=float) for part in zip(*orbits, strict=True)]
    found += [np.array(x, dtype=float) for x in ours.corrected_frequencies(A, omega)]
    found += [part.transpose(1, 0, 2) for part in by_time]
    return *found, np.array(ours.corrected_by_frequencies(A, omega), dtype=float)


def checked_library(name, folder):
    """The library of a case, whose file has passed its own test."""
    text = source("c", name)
    run = c_self_test(folder, text)
    assert run.returncode == 0, run.stdout
    return library_of(folder, text)


def from_c(name, folder):
    library = checked_library(name, folder)
    A, phases, omega = given(name)
    Q, P, corrected, jacobian, dQ, dP, slopes = found = [np.full(x.shape, np.nan) for x in expected(name)]
    arguments = [ctypes.c_size_t(len(TIMES)), *map(pointer, (TIMES, A, phases, omega))]
    assert library.sample_orbit(*arguments, pointer(Q), pointer(P)) == 0
    assert library.sample_orbit_by_frequencies(*arguments, pointer(dQ), pointer(dP)) == 0
    given_frequencies = (pointer(A), pointer(omega))
    assert library.sample_corrected_frequencies(*given_frequencies, pointer(corrected), pointer(jacobian)) == 0
    assert library.sample_corrected_by_frequencies(*given_frequencies, pointer(slopes)) == 0
    alone = np.full_like(Q, np.nan)
    assert library.sample_positions(*arguments, pointer(alone)) == 0
    assert np.array_equal(alone, Q)
    assert library.sample_momenta(*arguments, pointer(alone)) == 0
    assert np.array_equal(alone, P)
    return found


def from_fortran(name, folder, build):
    text = source("fortran", name)
    done = build(text, flags=["-DSAMPLE_SELF_TEST", "-O0"])()
    assert done.returncode == 0, done.stderr
    shapes = [x.shape for x in expected(name)]
    sizes = {"TIMES": len(TIMES), "SEEDS": len(CASES[name][1]), "MODES": CASES[name][0].N - 1}
    driver = re.sub("|".join(sizes), lambda word: str(sizes[word.group()]), DRIVER)
    numbers = " ".join(repr(float(x)) for part in (TIMES, *given(name)) for x in part)
    values = test_fortran.numbers(build(text, driver)(numbers))
    ends = np.cumsum([int(np.prod(shape)) for shape in shapes])
    *found, alone = np.split(values, ends)
    assert np.array_equal(alone, np.concatenate(found[:2]))
    return [x.reshape(shape) for x, shape in zip(found, shapes, strict=True)]


def from_octave(name, folder):
    (folder / "sample.m").write_text(source("octave", name))
    A, phases, omega = map(listed, given(name))
    script = [f"show(sample('self_test')); t = {listed(TIMES)}; A = {A}; phi = {phases}; w = {omega};"]
    script.append("[Q, P] = sample(t, A, phi, w); [omega, jacobian] = sample('corrected_frequencies', A, w);")
    script.append("[dQ, dP] = sample('orbit_by_frequencies', t.', A.', phi, w); slopes = sample('corrected_by_frequencies', A, w);")
    script.append("show(Q, P, omega, jacobian, reshape(dQ, numel(t), []), reshape(dP, numel(t), []), slopes, sample(t, A, phi, w) - Q)")
    lines = [line for line in octave(folder, script) if not line.startswith("largest deviation")]
    deviation, *found, difference = arrays(lines)
    assert 0 <= deviation[0, 0] <= OF_LARGEST
    assert not difference.any()
    found[2] = found[2][0]
    for k in (4, 5):
        s, T, modes = expected(name)[k].shape
        found[k] = found[k].reshape(T, s, modes).transpose(1, 0, 2)
    return found


RUNS = {"c": from_c, "fortran": from_fortran, "numpy": from_numpy, "mpmath": from_mpmath, "octave": from_octave}


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", CASES)
def test_values_and_derivatives_are_those_of_the_series(language, name, tmp_path, request):
    more = [request.getfixturevalue("build")] if language == "fortran" else []
    found = RUNS[language](name, tmp_path, *more)
    for kind, values, exact in zip(KINDS, found, expected(name), strict=True):
        assert np.shape(values) == exact.shape, kind
        error = np.abs(np.asarray(values) - exact).max()
        assert error <= OF_LARGEST * np.abs(exact).max(), kind


def broken(language, pattern):
    """The source of a case with one number of a table changed, a factor of a sum."""
    text = source(language, "one seed")
    wrong, changes = re.subn(pattern, r"\g<1>7", text, count=1)
    assert changes == 1
    return wrong


def test_self_tests_see_a_changed_operation(tmp_path, build):
    assert c_self_test(tmp_path, broken("c", r"(factor\[\d+\] = \{\n)-?\d+")).returncode == 1
    done = build(broken("fortran", r"(data \(factor\(i\).*\n *)-?\d+"), flags=["-DSAMPLE_SELF_TEST", "-O0"])()
    assert "above" in done.stderr
    for language in ("numpy", "mpmath"):
        (tmp_path / "sample.py").write_text(broken(language, r'(_FACTOR = """\n)-?\d+'))
        assert subprocess.run([sys.executable, "-I", "sample.py"], cwd=tmp_path, capture_output=True, check=False).returncode == 1
    (tmp_path / "sample.m").write_text(broken("octave", r"(factorTable\(\)\n.*\n.*\n')-?\d+"))
    assert "sample:self_test" in octave(tmp_path, ["refused('sample', 'self_test')"])[-1]


def test_wrong_arguments_in_python(tmp_path):
    for language in ("numpy", "mpmath"):
        ours = module(source(language, "wrapped, cut"), tmp_path / "sample.py")
        for call, word in (
            (lambda ours=ours: ours.orbit_by_frequencies(0.0, [0.1], [1.4, 1.8]), "amplitudes"),
            (lambda ours=ours: ours.orbit_by_frequencies(0.0, [0.1, 0.1], [1.4]), "frequencies"),
            (lambda ours=ours: ours.orbit(0.0, [0.1, 0.1], [1.4, 1.8], [0.0]), "phases"),
            (lambda ours=ours: ours.corrected_by_frequencies([0.1, 0.1], [1.4]), "frequencies"),
            (lambda ours=ours: ours.corrected_frequencies([0.1], [1.4, 1.8]), "amplitudes"),
        ):
            with pytest.raises(ValueError, match=f"{word} must be one number for each of the seeds"):
                call()


def test_wrong_arguments_in_c(tmp_path):
    library = checked_library("wrapped, cut", tmp_path)
    A, found = np.full(2, 0.1), np.full(6, 7.0)
    count = ctypes.c_size_t(1)
    assert library.sample_orbit_by_frequencies(count, pointer(A), pointer(A), None, None, pointer(found), pointer(found)) == 2
    assert library.sample_positions(count, pointer(A), pointer(A), None, None, pointer(found)) == 2
    assert library.sample_corrected_frequencies(pointer(A), None, pointer(found), None) == 2
    assert library.sample_corrected_by_frequencies(pointer(A), None, pointer(found)) == 2
    assert (found == 7).all()


def test_wrong_arguments_in_octave(tmp_path):
    (tmp_path / "sample.m").write_text(source("octave", "wrapped, cut"))
    calls = ["'sample'", "'sample', 1, [1 1]", "'sample', 'orbit_by_frequencies', 1, [1 1], []"]
    calls += ["'sample', 'corrected_by_frequencies', [1 1]", "'sample', 'derivatives'"]
    calls += ["'sample', 'orbit_by_frequencies', 1, 1, [], [1 1]", "'sample', 'corrected_by_frequencies', [1 1], 1"]
    kinds = [line.split(" | ")[0] for line in octave(tmp_path, [f"refused({call})" for call in calls])]
    assert kinds == [*["sample:arguments"] * 4, "sample:word", *["sample:shape"] * 2]


def test_what_cannot_be_exported_says_so(tmp_path, monkeypatch):
    numeric = lindstedt(Chain(8, "0.3"), (1,), ("0.3905",), 4)
    with pytest.raises(InputError, match=r"^derivatives = True: allowed is a series in universal form"):
        export(numeric, "c", tmp_path / "x", derivatives=True)
    with pytest.raises(InputError, match=r"^derivatives = True: allowed is none for a torus"):
        export(solve_amplitudes(numeric), "c", tmp_path / "x", derivatives=True)
    monkeypatch.setattr("symfpu.codegen.operation_tables.LARGEST_FILE", 1000)
    with pytest.raises(InputError, match=r"MB of operations': allowed is .*; lower the orders, or give lindstedt frequencies"):
        export(series("one seed"), "c", tmp_path / "x", derivatives=True)
    assert not list(tmp_path.iterdir())


def test_command_line(tmp_path, capsys):
    file = str(save(tmp_path / "universal.symfpu", lindstedt(Chain(8, "0.3"), (1, 2), order=5)))
    assert main(["export", file, "--series", "--lang", "numpy", "-o", str(tmp_path / "large")]) == 0
    large = (tmp_path / "large.py").read_text()
    assert "orbit_by_frequencies" in large
    assert re.search(r"program: [\d,]+ nodes, [\d,]+ terms, [\d,]+ bytes of tables", large)
    words = ["export", file, "--series", "--lang", "numpy", "--order", "2", "--frequency-order", "2"]
    assert main([*words, "-o", str(tmp_path / "small")]) == 0
    assert "orbit_by_frequencies" not in (tmp_path / "small.py").read_text()
    assert main([*words, "-o", str(tmp_path / "slopes"), "--derivatives"]) == 0
    assert "orbit_by_frequencies" in (tmp_path / "slopes.py").read_text()
    for name in ("large", "small", "slopes"):
        assert subprocess.run([sys.executable, "-I", f"{name}.py"], cwd=tmp_path, capture_output=True, check=False).returncode == 0
    capsys.readouterr()
