"""Exported series in NumPy and mpmath: values against the torus at 40 digits at random amplitudes, phases, frequencies, times."""

import importlib.util
import subprocess
import sys

import mpmath
import numpy as np
import pytest

from symfpu.codegen.languages.mpmath import MPMATH
from symfpu.codegen.languages.numpy import NUMPY
from tests.codegen.series_cases import (
    CASES,
    DIGITS,
    UNIVERSAL,
    assert_close,
    assert_frequencies,
    drawn,
    expected_frequencies,
    expected_orbit,
    numeric,
    program_of,
    universal,
)
from tests.tolerances import LAST_DIGIT

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together

FORMS = {"straight": 10**9, "tables": 0}
NUMERIC = [(name, form) for name in CASES for form in FORMS if form == "tables" or name in ("order 0", "one mode", "wrapped modes")]


def module(text, path):
    path.write_text(text)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def emitted(emitter, series, case, folder):
    program = program_of(series, case)
    return module(emitter.series(program), folder / "my_series.py"), program


@pytest.mark.long
@pytest.mark.parametrize(("name", "form"), NUMERIC)
def test_numpy_values_are_those_of_the_series(name, form, tmp_path, monkeypatch):
    monkeypatch.setattr("symfpu.codegen.series_program.STRAIGHT_LINE", FORMS[form])
    case = CASES[name]
    ours, program = emitted(NUMPY, numeric(case), case, tmp_path)
    assert (program.straight is None) == (form == "tables")
    A, phases, omega, t = drawn(case)
    Q, P = expected_orbit(case, A, phases, omega, t)
    for values, exact in zip(ours.orbit(t, A, phases, omega), (Q, P), strict=True):
        assert_close(values, exact)
    assert_frequencies(*ours.corrected_frequencies(A), case, A)
    assert ours.self_test() <= ours.TOLERANCE
    assert np.allclose(ours.positions(1.5, A), ours.positions([1.5], A, [0] * len(A), ours.corrected_frequencies(A)[0])[0], rtol=LAST_DIGIT)


@pytest.mark.long
@pytest.mark.parametrize("name", UNIVERSAL)
def test_numpy_values_of_a_universal_series(name, tmp_path):
    case = UNIVERSAL[name]
    ours, _ = emitted(NUMPY, universal(case), case, tmp_path)
    A, phases, _, t = drawn(case)
    omega = [float(w) for w in case[2]]
    for values, exact in zip(ours.orbit(t, A, omega, phases), expected_orbit(case, A, phases, omega, t), strict=True):
        assert_close(values, exact)
    assert_frequencies(*ours.corrected_frequencies(A, omega), case, A)
    assert ours.self_test() <= ours.TOLERANCE


@pytest.mark.parametrize(("name", "form"), [("mixed, three seeds", "tables"), ("wrapped modes", "straight"), ("order 0", "tables")])
def test_mpmath_keeps_the_digits_of_the_series(name, form, tmp_path, monkeypatch):
    monkeypatch.setattr("symfpu.codegen.series_program.STRAIGHT_LINE", FORMS[form])
    case = CASES[name]
    ours, _ = emitted(MPMATH, numeric(case), case, tmp_path)
    A, phases, omega, t = drawn(case)
    Q, P = expected_orbit(case, A, phases, omega, t[:3])
    with mpmath.workdps(DIGITS + 5):
        for time, q, p in zip(t, Q, P, strict=False):
            for values, exact in zip(ours.orbit(time, A, phases, omega), (q, p), strict=True):
                assert np.abs(np.array(values) - exact).max() <= mpmath.mpf(10) ** -(DIGITS - 2) * np.abs(exact).max()
        values, slopes = ours.corrected_frequencies(A)
        exact, jacobian = expected_frequencies(case, A)
        assert np.abs(np.array(values) - exact).max() <= mpmath.mpf(10) ** -(DIGITS - 2)
        assert np.abs(np.array(slopes) - jacobian).max() <= mpmath.mpf(10) ** -(DIGITS - 2) * np.abs(jacobian).max()
    assert ours.self_test() <= ours.TOLERANCE


@pytest.mark.long
@pytest.mark.parametrize("name", UNIVERSAL)
def test_mpmath_of_a_universal_series_has_any_digits(name, tmp_path):
    case = UNIVERSAL[name]
    ours, _ = emitted(MPMATH, universal(case), case, tmp_path)
    A, phases, _, t = drawn(case)
    omega = [mpmath.mpf(float(w)) for w in case[2]]
    Q, P = expected_orbit(case, A, phases, omega, t[:2])
    with mpmath.workdps(DIGITS + 5):
        for time, q, p in zip(t, Q, P, strict=False):
            for values, exact in zip(ours.orbit(time, A, omega, phases), (q, p), strict=True):
                assert np.abs(np.array(values) - exact).max() <= mpmath.mpf(10) ** -(DIGITS - 2) * np.abs(exact).max()
    assert ours.self_test() <= ours.TOLERANCE


@pytest.mark.long
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
    case = CASES["wrapped modes"]
    ours, _ = emitted(emitter, numeric(case, digits=None), case, tmp_path)
    with pytest.raises(ValueError, match=r"amplitudes must be one number for each of the seeds \(2, 3\)"):
        ours.positions(0.0, [0.1])
    with pytest.raises(ValueError, match="phases must be one number"):
        ours.positions(0.0, [0.1, 0.2], phases=[0.0])
    with pytest.raises(ValueError, match="frequencies must be one number"):
        ours.positions(0.0, [0.1, 0.2], frequencies=[0.0, 0.0, 0.0])
