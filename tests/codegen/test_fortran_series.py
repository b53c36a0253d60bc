"""Emitted Fortran of series with free amplitudes against forty digits: compiled without a warning, run, linked with a second one."""

import re
import subprocess

import numpy as np
import pytest

from symfpu import Chain, InputError, lindstedt
from symfpu.codegen.languages.fortran import FORTRAN
from symfpu.codegen.series_program import series_facts, series_program
from tests.codegen import series_cases, test_c99, test_fortran, universal_cases
from tests.codegen.compilers import program
from tests.codegen.series_cases import CASES, OF_LARGEST, UNIVERSAL, assert_close, expected_orbit, numeric, program_of, universal

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together

build, numbers = test_fortran.build, test_fortran.numbers  # a fixture and a function

TABLES_BY_DEFAULT = {"alpha, two seeds", "toda, two seeds", "mixed, three seeds", "beta, four seeds", "alpha, five seeds", "high order"}
SLOW_AS_STATEMENTS = ("alpha, two seeds", "mixed, three seeds")  # seconds of SymPy each
FORMS = {  # of a case: statements or tables
    **{f"{name}, tables": (name, "tables") for name in CASES},
    **{f"{name}, straight": (name, "default") for name in CASES if name not in TABLES_BY_DEFAULT},
    **{f"{name}, long": (name, "statements") for name in SLOW_AS_STATEMENTS},
    **{f"{name}, universal": (name, "default") for name in UNIVERSAL},
}
FAR = (123456789.125, -98765432109876.5)

DRIVER = """\
program driver
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use sample, only: positions, momenta, orbit, corrected_frequencies
  implicit none
  integer :: n
  real(rk) :: amplitudes(SEEDS), phases(SEEDS), frequencies(SEEDS), omega(SEEDS), jacobian(SEEDS, SEEDS)
  real(rk), allocatable :: t(:), Q(:, :), P(:, :)
  read *, n
  allocate (t(n), Q(MODES, n), P(MODES, n))
  read *, amplitudes, phases, frequencies, t
  call corrected_frequencies(amplitudes, BEFORE omega)
  print '(es26.17e3)', omega
  call corrected_frequencies(amplitudes, BEFORE omega, jacobian)
  print '(es26.17e3)', omega, transpose(jacobian)
  call orbit(t, amplitudes, BEFORE Q, P, phases AFTER)
  print '(es26.17e3)', Q, P
  call positions(t, amplitudes, BEFORE Q, phases AFTER)
  call momenta(t, amplitudes, BEFORE P, phases AFTER)
  print '(es26.17e3)', Q, P
  call positions(t, amplitudes, BEFORE Q)
  call momenta(t, amplitudes, BEFORE P)
  print '(es26.17e3)', Q, P
end program driver
"""

PAIR = """\
program pair
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use alone, only: first_orbit => orbit, first_frequencies => corrected_frequencies
  use other, only: second_orbit => orbit, second_frequencies => corrected_frequencies
  implicit none
  real(rk) :: Q(1, 1), P(1, 1), R(4, 1), S(4, 1), v(1), w(1)
  call first_orbit([12.5_rk], [0.25_rk], Q, P)
  call first_frequencies([0.25_rk], v)
  call second_orbit([12.5_rk], [0.25_rk], [1.1796875_rk], R, S)
  call second_frequencies([0.25_rk], [1.1796875_rk], w)
  print '(es26.17e3)', Q, P, v, R, S, w
end program pair
"""


@pytest.fixture(scope="module", params=FORMS)
def form(request):
    """A case, the program of its series, its source, and whether the frequencies are a required argument."""
    name, kind = FORMS[request.param]
    required = request.param.endswith("universal")
    case = (UNIVERSAL if required else CASES)[name]
    program = program_of((universal if required else numeric)(case), case, form=kind)
    assert (program.straight is None) == request.param.endswith("tables")
    return case, program, FORTRAN.series(program), required


def source(name, form="numeric", called="sample"):
    if form == "universal":
        return FORTRAN.series(program_of(universal(UNIVERSAL[name]), UNIVERSAL[name], called))
    return FORTRAN.series(program_of(numeric(CASES[name]), CASES[name], called))


def driver(case, required):
    words = {"SEEDS": str(len(case[1])), "MODES": str(case[0].N - 1)}
    words |= {"BEFORE": "frequencies,", " AFTER": ""} if required else {"BEFORE ": "", "AFTER": ", frequencies"}
    text = DRIVER
    for word, value in words.items():
        text = text.replace(word, value)
    return text


def test_values_are_those_of_forty_digits(build, form):
    case, _, text, required = form
    amplitudes, phases, frequencies, times = series_cases.drawn(case)
    if required:
        frequencies = np.array([float(w) for w in case[2]])
    times = np.array([0.0, *times, *FAR, *np.linspace(-20, 20, 65)])  # more than one block of times
    given = "\n".join(map(repr, [len(times), *(float(x) for x in (*amplitudes, *phases, *frequencies, *times))]))
    s, n = len(phases), len(times) * (case[0].N - 1)
    found = np.split(numbers(build(text, driver(case, required))(given)), np.cumsum([s, s, s * s, n, n, n, n, n]))
    omega, again, jacobian, *orbits = found
    series_cases.assert_frequencies(omega, jacobian.reshape(s, s), case, amplitudes)
    assert np.array_equal(omega, again)
    Q, P, Q_alone, P_alone, Q_default, P_default = (values.reshape(len(times), -1) for values in orbits)
    assert np.array_equal(Q, Q_alone)
    assert np.array_equal(P, P_alone)
    few = np.r_[0:20:3, 20, 21, 63, 64, 86]  # many digits take long
    near = np.flatnonzero(np.abs(times) < 25)[::9]  # rounded omega(A) turn the angles off at late times
    exact_Q, exact_P = expected_orbit(case, amplitudes, phases, frequencies, times[few])
    assert_close(Q[few], exact_Q)
    assert_close(P[few], exact_P)
    rates = frequencies if required else series_cases.expected_frequencies(case, amplitudes)[0]
    exact_Q, exact_P = expected_orbit(case, amplitudes, np.zeros(s), rates, times[near])
    assert_close(Q_default[near], exact_Q)
    assert_close(P_default[near], exact_P)


def test_the_self_test_passes(build, form):
    test_fortran.check_deviations(build(form[2], flags=["-DSAMPLE_SELF_TEST", "-O0"])(), 4)


@pytest.mark.parametrize(
    ("name", "form", "coefficient"),
    [
        ("one mode", "numeric", r"(?<=c1_1 = )"),
        ("one mode", "numeric", r"(?<=omega\(1\) = )(?!freq|ampl)"),
        ("one mode", "numeric", r"(?<=jacobian\(1, 1\) = )"),
        ("order 0", "universal", r"(?<=linear2 = )"),
        ("high order", "numeric", r"(?<=data \(a_odd\(i, 2\), i = 1, 496\) / &\n    )"),
        ("high order", "numeric", r"(?<=data \(correction\(i, 1\), i = 1, 30\) / &\n    )"),
    ],
)
def test_the_self_test_fails_for_a_wrong_coefficient(build, name, form, coefficient):
    text = source(name, form)
    wrong, changes = re.subn(coefficient, "1.0000001d0*" if "data" not in coefficient else "1", text, count=1)
    assert changes == 1
    done = build(wrong, flags=["-DSAMPLE_SELF_TEST", "-O0"])()
    assert done.returncode != 0
    assert "above" in done.stderr


def test_two_modules_in_one_program(build):
    first, second = CASES["one mode"], UNIVERSAL["order 0"]
    values = numbers(build(source("one mode", called="alone"), source("order 0", "universal", "other"), PAIR)())
    expected = []
    for case, given in ((first, None), (second, (1.1796875,))):
        omega, _ = series_cases.expected_frequencies(case, (0.25,))
        expected += [*np.ravel(expected_orbit(case, (0.25,), (0.0,), given or omega, [12.5])), *omega]
    assert len(values) == len(expected) == 12
    assert np.abs(values - np.array(expected)).max() <= OF_LARGEST


MODULES = {  # with the variables of a call
    "torus": (lambda: test_fortran.source(test_c99.case("alpha, one seed"), "sample"), "x(2) = 1, y(6, 2) = 1"),
    "series": (lambda: source("one mode"), "x(2) = 1, y(2, 2) = 1"),
    "operations": (lambda: FORTRAN.series(universal_cases.program("wrapped, cut")), "x(2) = 1, z(3, 2, 2) = 1"),
}
STOPPED = [
    ("torus", "positions(x, y)", "Q must have shape (7, size(t))"),
    ("series", "positions(x, x(1:1), y)", "Q must have shape (1, size(t))"),
    ("series", "momenta(x, x(1:1), y(:, 1:1))", "P must have shape (1, size(t))"),
    ("series", "positions(x, x, y(1:1, :))", "amplitudes must have size 1"),
    ("series", "positions(x, x(1:1), y(1:1, :), phases=x)", "phases must have size 1"),
    ("series", "positions(x, x(1:1), y(1:1, :), frequencies=x)", "frequencies must have size 1"),
    ("series", "corrected_frequencies(x, x(1:1))", "amplitudes must have size 1"),
    ("series", "corrected_frequencies(y(1, 1:1), x)", "omega must have size 1"),
    ("series", "corrected_frequencies(y(1, 1:1), x(1:1), y)", "jacobian must have shape (1, 1)"),
    ("operations", "orbit_by_frequencies(x, x, x(1:1), z, z)", "frequencies must have size 2"),
    ("operations", "orbit_by_frequencies(x, x, x, z(:, 1:1, :), z)", "dQ must have shape (3, size(t), 2)"),
    ("operations", "orbit_by_frequencies(x, x, x, z, z(:, :, 1:1))", "dP must have shape (3, size(t), 2)"),
    ("operations", "corrected_by_frequencies(x, x, z(1:2, 1:1, 1))", "slopes must have shape (2, 2)"),
    ("operations", "positions(x, x(1:1), x, z(:, :, 1))", "amplitudes must have size 2"),
    ("operations", "corrected_frequencies(x, x, x(1:1))", "omega must have size 2"),
]


@pytest.fixture(scope="module", params=MODULES)
def module(request, tmp_path_factory):
    """Its name, and what a program with one call of it says when it stops; the module is compiled once."""
    gfortran, folder = program("gfortran"), tmp_path_factory.mktemp("shapes")
    text, variables = MODULES[request.param]
    (folder / "sample.F90").write_text(text())
    subprocess.run([gfortran, "-c", "sample.F90"], cwd=folder, check=True)

    def stopped(call):
        (folder / "call.f90").write_text(f"program p\nuse sample\ndouble precision :: {variables}\ncall {call}\nend program\n")
        subprocess.run([gfortran, "call.f90", "sample.o", "-o", "call"], cwd=folder, check=True)
        done = subprocess.run([folder / "call"], capture_output=True, text=True)
        assert done.returncode != 0
        return done.stderr

    return request.param, stopped


def test_arrays_of_other_shapes_stop_the_program(module):
    name, stopped = module
    for of, call, message in STOPPED:
        assert of != name or message in stopped(call), call


def test_order_250_compiles_and_stays_finite(build):
    chain = Chain(2, alpha="0.2", beta="0.3")
    series = lindstedt(chain, (1,), ("1.421875",), 250)
    text = FORTRAN.series(series_program(series, "sample", series_facts(series)))
    assert "starts_odd" in text
    assert not re.search(r"\binf|nan\b", text.split("contains")[0])
    test_fortran.check_deviations(build(text, flags=["-DSAMPLE_SELF_TEST", "-O0"])(), 4)


@pytest.mark.parametrize("name", ["orbit", "t", "Real64", "corrected_frequencies", "c0_1", "a1", "cos0", "2torus", "a b", "x" * 51])
def test_names_that_the_module_needs_are_refused(name):
    with pytest.raises(InputError, match=r"^path = "):
        source("one mode", called=name)
