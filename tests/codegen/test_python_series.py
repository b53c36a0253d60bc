"""Exported series in NumPy and mpmath: values against the torus at 40 digits at random amplitudes, phases, frequencies, times."""

import importlib.util
import subprocess
import sys

import mpmath
import numpy as np
import pytest

from symfpu.codegen.languages.mpmath import MPMATH
from symfpu.codegen.languages.numpy import NUMPY
from tests.codegen import series_cases
from tests.codegen.series_cases import CASES, DIGITS, UNIVERSAL, assert_close, drawn, expected_orbit, numeric, program_of, universal
from tests.tolerances import LAST_DIGIT

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together

SMALL = ("order 0", "one mode", "wrapped modes")
UNIVERSALS = [(name, "universal") for name in UNIVERSAL]
NUMERIC = [*((name, "tables") for name in CASES), *((name, "statements") for name in SMALL)]


def module(text, path):
    path.write_text(text)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def emitted(emitter, name, form, folder, digits=DIGITS):
    """The module of a case in a form, and the case."""
    case = (UNIVERSAL if form == "universal" else CASES)[name]
    series = universal(case) if form == "universal" else numeric(case, digits=digits)
    program = program_of(series, case, form="default" if form == "universal" else form)
    assert (program.straight is None) == (form == "tables")
    return module(emitter.series(program), folder / "my_series.py"), case


def asked(ours, case, form, number):
    """Amplitudes, phases, frequencies and times, and the functions of these that the module has."""
    A, phases, omega, t = drawn(case)
    if form != "universal":
        return (A, phases, omega, t), lambda at: ours.orbit(at, A, phases, omega), lambda: ours.corrected_frequencies(A)
    omega = [number(float(w)) for w in case[2]]
    return (A, phases, omega, t), lambda at: ours.orbit(at, A, omega, phases), lambda: ours.corrected_frequencies(A, omega)


@pytest.mark.parametrize(("name", "form"), [*NUMERIC, *UNIVERSALS])
def test_numpy_values_are_those_of_the_series(name, form, tmp_path):
    ours, case = emitted(NUMPY, name, form, tmp_path)
    given, orbit, corrected = asked(ours, case, form, float)
    A, _, _, t = given
    for values, exact in zip(orbit(t), expected_orbit(case, *given), strict=True):
        assert_close(values, exact)
    series_cases.assert_frequencies(*corrected(), case, A)
    assert ours.self_test() <= ours.TOLERANCE
    if form != "universal":
        by_default = ours.positions([1.5], A, [0] * len(A), corrected()[0])[0]
        assert np.allclose(ours.positions(1.5, A), by_default, rtol=LAST_DIGIT)


@pytest.mark.parametrize(
    ("name", "form"), [("mixed, three seeds", "tables"), ("wrapped modes", "statements"), ("order 0", "tables"), *UNIVERSALS]
)
def test_mpmath_keeps_the_digits_of_the_series(name, form, tmp_path):
    ours, case = emitted(MPMATH, name, form, tmp_path)
    given, orbit, corrected = asked(ours, case, form, mpmath.mpf)
    A, _, _, t = given
    exact_orbit = expected_orbit(case, *given[:3], t[:3])
    with mpmath.workdps(DIGITS + 5):
        near = mpmath.mpf(10) ** -(DIGITS - 2)
        for time, *exact_parts in zip(t[:3], *exact_orbit, strict=True):
            for values, exact in zip(orbit(time), exact_parts, strict=True):
                assert np.abs(np.array(values) - exact).max() <= near * np.abs(exact).max()
        values, slopes = corrected()
        exact, jacobian = series_cases.expected_frequencies(case, A)
        assert np.abs(np.array(values) - exact).max() <= near
        assert np.abs(np.array(slopes) - jacobian).max() <= near * np.abs(jacobian).max()
    assert ours.self_test() <= ours.TOLERANCE


@pytest.mark.parametrize("emitter", [NUMPY, MPMATH], ids=["numpy", "mpmath"])
def test_the_file_runs_by_itself_and_sees_a_changed_number(emitter, tmp_path):
    case = CASES["wrapped modes"]
    text = emitter.series(program_of(numeric(case, digits=None), case))
    at = text.index("c0_")
    digit = next(i for i in range(at, len(text)) if text[i].isdigit() and text[i - 9 : i].isdigit() and text[i] != "9")
    broken = text[:digit] + str(int(text[digit]) + 1) + text[digit + 1 :]
    for content, code in ((text, 0), (broken, 1)):
        (tmp_path / "my_series.py").write_text(content)
        run = subprocess.run([sys.executable, "-I", "my_series.py"], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert run.returncode == code, run.stdout + run.stderr
        assert "allowed 1" in run.stdout


@pytest.mark.parametrize("emitter", [NUMPY, MPMATH], ids=["numpy", "mpmath"])
def test_wrong_numbers_of_parameters_are_refused(emitter, tmp_path):
    ours, _ = emitted(emitter, "wrapped modes", "statements", tmp_path, digits=None)
    with pytest.raises(ValueError, match=r"amplitudes must be one number for each of the seeds \(2, 3\)"):
        ours.positions(0.0, [0.1])
    with pytest.raises(ValueError, match="phases must be one number"):
        ours.positions(0.0, [0.1, 0.2], phases=[0.0])
    with pytest.raises(ValueError, match="frequencies must be one number"):
        ours.positions(0.0, [0.1, 0.2], frequencies=[0.0, 0.0, 0.0])
