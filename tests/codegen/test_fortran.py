"""Emitted Fortran against the torus at forty digits: compiled without a warning, run, and linked with a second one."""

import re
import subprocess

import mpmath
import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.codegen.languages.fortran import FORTRAN
from symfpu.codegen.torus_program import torus_facts, torus_program
from symfpu.errors import InputError
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.torus import QTorus
from tests.codegen.compilers import program
from tests.tolerances import OF_LARGEST, OF_TAIL

FLAGS = ("-std=f2008", "-Wall", "-Werror", "-O2")
LONGEST_LINE, CONTINUATIONS = 132, 255  # limits of Fortran 2008
DIGITS = 40
BLOCK = 64  # times that are summed together

CASES = {  # chain, seeds, order: one to five seeds, each coupling and both
    "one seed, alpha": (Chain(8, alpha="0.33"), (1,), 7),
    "one parity": (Chain(9, alpha="1/3"), (4,), 5),
    "two seeds, mixed": (Chain(8, alpha="0.3", beta="1/7"), (1, 2), 4),
    "three seeds, wrapped": (Chain(5, alpha="0.25"), (2, 3, 4), 6),
    "four seeds, beta": (Chain(10, beta="0.7"), (1, 2, 3, 4), 2),
    "five seeds": (Chain(12, alpha="-0.4"), (1, 3, 5, 8, 11), 2),
    "one mode": (Chain(2, beta="0.5"), (1,), 4),
    "order 0": (Chain(6, alpha="0.1"), (2, 5), 0),
    "many harmonics": (Chain(16, alpha="0.33"), (1, 2), 16),
}

DRIVER = """\
program driver
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use NAME, only: positions, momenta, orbit, harmonic_energies, energy
  implicit none
  integer :: n
  real(rk), allocatable :: t(:), phases(:), Q(:, :), P(:, :), E(:, :), H(:)
  read *, n
  allocate (t(n), phases(SEEDS), Q(MODES, n), P(MODES, n), E(MODES, n), H(n))
  read *, t, phases
  call positions(t, Q, phases)
  call momenta(t, P, phases)
  call show(Q)
  call show(P)
  call orbit(t, Q, P, phases)
  call show(Q)
  call show(P)
  call harmonic_energies(t, E, phases)
  call show(E)
  call energy(t, H, phases)
  call show(reshape(H, [1, n]))
  call positions(t, Q)
  call show(Q)
contains
  subroutine show(values)
    real(rk), intent(in) :: values(:, :)
    print '(es26.17e3)', values
  end subroutine show
end program driver
"""

PAIR = """\
program pair
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use alone, only: first_orbit => orbit
  use other, only: second_orbit => orbit
  implicit none
  real(rk) :: Q(7, 1), P(7, 1), R(1, 1), S(1, 1)
  call first_orbit([12.5_rk], Q, P)
  call second_orbit([12.5_rk], R, S)
  print '(es26.17e3)', Q, P, R, S
end program pair
"""


def made(case):
    """A torus of forty digits with amplitudes and phases chosen here, not solved for."""
    chain, seeds, order = CASES[case]
    linear = dict(enumerate(chain.frequencies(), 1))
    frequencies = [f"{linear[q] * (1.003 + 0.0007 * i):.9f}" for i, q in enumerate(seeds)]
    series = lindstedt(chain, seeds, frequencies, order, digits=DIGITS)
    with mpmath.workdps(DIGITS):
        amplitudes = {q: mpmath.mpf(1) / (7 + 3 * i) for i, q in enumerate(seeds)}
        phases = {q: mpmath.mpf(2 * i - 1) / 3 for i, q in enumerate(seeds)}
    return QTorus(series, amplitudes, phases, order, order)


@pytest.fixture(scope="module")
def large():
    """A torus of doubles whose tables need several statements a column."""
    series = lindstedt(Chain(4, alpha="0.25"), (1, 2, 3), ("0.7671", "1.4187", "1.8541"), 16)
    return QTorus(series, {1: 0.1, 2: 0.07, 3: 0.05}, {1: 0.3, 2: -1.0, 3: 2.5}, 16, 16)


def source(torus, name):
    return FORTRAN.torus(torus_program(torus, name, torus_facts(torus)))


SHORT = tuple(CASES)[:3]  # the compiler takes its time: the others are run by `make long`, and in C by `make test`


@pytest.fixture(scope="module", params=[pytest.param(name, marks=[pytest.mark.long] * (name not in SHORT)) for name in CASES])
def torus(request):
    return made(request.param)


@pytest.fixture(scope="module")
def text(torus):
    return source(torus, "example")


@pytest.fixture
def build(tmp_path):
    """Compiles texts, in order, without a word from the compiler; gives a function that runs the program."""

    def build(*texts, flags=()):
        for i, text in enumerate(texts):
            (tmp_path / f"{i}.{FORTRAN.extension}").write_text(text)
        files = [f"{i}.{FORTRAN.extension}" for i in range(len(texts))]
        command = [program("gfortran"), *FLAGS, *flags, *files, "-o", "program"]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        assert (done.returncode, done.stdout + done.stderr) == (0, "")
        return lambda given="": subprocess.run([tmp_path / "program"], input=given, capture_output=True, text=True)

    return build


def numbers(done):
    assert done.returncode == 0, done.stderr
    return np.array(done.stdout.split(), dtype=float)


@pytest.mark.long
def test_the_self_test_passes(build, text):
    done = build(text, flags=["-DEXAMPLE_SELF_TEST"])()
    assert done.returncode == 0, done.stderr
    deviations = [float(x) for x in re.findall(r"\d\.\d+E[+-]\d+", done.stdout)]
    assert len(deviations) == 3
    assert max(deviations) <= OF_LARGEST


@pytest.mark.long
def test_the_self_test_fails_for_a_wrong_coefficient(build):
    text = source(made("two seeds, mixed"), "example")
    wrong = re.sub(r"(data \(c_odd\(i, 1\).*\n *)", r"\g<1>1d-3+0*", text).replace("1d-3+0*", "1d-3,", 1)
    wrong = re.sub(r"(data \(c_odd\(i, 1\).*\n *1d-3,)[^,]*,", r"\1", wrong)
    assert wrong != text
    done = build(wrong, flags=["-DEXAMPLE_SELF_TEST"])()
    assert done.returncode != 0
    assert "above" in done.stderr


@pytest.mark.long
def test_values_are_those_of_forty_digits(build, torus, text):
    rng = np.random.default_rng(5)
    times = [0.0, *rng.uniform(-2000, 2000, BLOCK + 4).tolist(), 123456789.125]
    picked = [0, 1, 31, BLOCK - 1, BLOCK, BLOCK + 1, len(times) - 1]  # many digits take long
    phases = rng.uniform(-4, 4, len(torus.seeds)).tolist()
    modes = torus.chain.N - 1
    driver = DRIVER.replace("NAME", "example").replace("SEEDS", str(len(phases))).replace("MODES", str(modes))
    given = "\n".join([str(len(times)), *map(repr, times), *map(repr, phases)])
    values = numbers(build(text, driver)(given))
    sizes = [modes * len(times)] * 5 + [len(times)] + [modes * len(times)]
    by_time = (part.reshape(len(times), -1)[picked] for part in np.split(values, np.cumsum(sizes)[:-1]))
    Q, P, Q_orbit, P_orbit, E, H, Q_default = by_time
    turned = QTorus(torus.series, torus.amplitudes, exact_phases(torus, phases), torus.order, torus.order)
    exact = np.array([mpmath.mpf(times[i]) for i in picked])  # the doubles themselves, not their shortest decimals
    expected_Q, expected_P = turned.positions(exact), turned.momenta(exact)
    for found, expected in ((Q, expected_Q), (P, expected_P), (Q_orbit, expected_Q), (P_orbit, expected_P)):
        agree(found, expected)
    agree(E, turned.harmonic_energies(exact))
    agree(H, turned.energy(exact)[:, None])
    agree(Q_default, torus.positions(exact))


def exact_phases(torus, phases):
    return {q: mpmath.mpf(phi) for q, phi in zip(torus.seeds, phases, strict=True)}


def agree(found, expected):
    """Time is slowest in memory; every mode keeps its digits, however small."""
    off = np.abs(found - expected.astype(object))
    largest = np.abs(expected).max(axis=0)
    assert off.max() <= OF_LARGEST * largest.max()
    assert (off.max(axis=0) <= OF_TAIL * largest).all()


@pytest.mark.long
def test_two_modules_in_one_program(build):
    tori = made("one seed, alpha"), made("one mode")
    values = numbers(build(source(tori[0], "alone"), source(tori[1], "other"), PAIR)())
    expected = [x for torus in tori for x in (*torus.positions(12.5), *torus.momenta(12.5))]
    assert len(values) == len(expected) == 16
    assert np.abs(values - np.array(expected)).max() <= OF_LARGEST * max(abs(x) for x in expected)


@pytest.mark.long
def test_arrays_of_other_shapes_stop_the_program(build):
    driver = "program p\nuse example, only: positions\ndouble precision :: Q(6, 2)\ncall positions([0d0, 1d0], Q)\nend program\n"
    done = build(source(made("one seed, alpha"), "example"), driver)()
    assert done.returncode != 0
    assert "Q must have shape (7, size(t))" in done.stderr


def test_no_times_no_values(build):
    driver = DRIVER.replace("NAME", "example").replace("SEEDS", "1").replace("MODES", "7")
    assert numbers(build(source(made("one seed, alpha"), "example"), driver)("0\n0.5\n")).size == 0


def test_same_bytes_twice(torus, text):
    assert text == source(QTorus(torus.series, torus.amplitudes, torus.phases, torus.order, torus.order), "example")


@pytest.mark.long
def test_tables_in_several_statements_are_whole(build, large):
    text = source(large, "example")
    assert "data (c_odd(i, 1), i = 1, " in text
    assert text.count("data (c_odd(i, 1), i = ") > 1
    done = build(text, flags=["-DEXAMPLE_SELF_TEST"])()
    assert done.returncode == 0, done.stderr


@pytest.mark.long
def test_lines_respect_the_limits_of_the_standard(large):
    facts = {"made by": "a long command " * 20 + "out/*.F90 \\", "tricky": "first\ncall exit() é"}
    lines = FORTRAN.torus(torus_program(large, "example", facts)).splitlines()
    assert max(map(len, lines)) <= LONGEST_LINE
    longest = run = 0
    for line in lines:
        run = run + 1 if line.endswith("&") else 0
        longest = max(longest, run)
    assert 100 < longest <= CONTINUATIONS
    header = [line for line in lines[: lines.index("module example")] if line]
    assert all(line.startswith("!") and line.isascii() and "/*" not in line and not line.endswith("\\") for line in header)


def test_the_header_carries_all_facts():
    torus = made("three seeds, wrapped")
    program = torus_program(torus, "example", {"made by": "a test", **torus_facts(torus)})
    header = FORTRAN.torus(program).split("module example")[0]
    for key, value in program.facts.items():
        assert f"{key}: {value}" in " ".join(header.replace("\n!", " ").split())


@pytest.mark.parametrize("name", ["orbit", "t", "Real64", "first", "2torus", "c_even", "a b", "x" * 51])
def test_names_that_the_module_needs_are_refused(name):
    torus = made("one mode")
    with pytest.raises(InputError, match=r"^path = "):
        source(torus, name)
