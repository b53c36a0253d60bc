"""Emitted Fortran against the torus at forty digits: compiled without a warning, run, and linked with a second one."""

import re
import subprocess
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from symfpu import Chain, FromSeries, lindstedt
from symfpu.codegen.languages.fortran import FORTRAN
from symfpu.codegen.torus_program import torus_facts, torus_program
from tests.codegen.compilers import STRICT_FORTRAN, program
from tests.codegen.test_c99 import CASES, assert_close, case
from tests.tolerances import OF_LARGEST

LONGEST_LINE, CONTINUATIONS = 132, 255  # limits of Fortran 2008
BLOCK = 64  # times that are summed together


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


@pytest.fixture(scope="module")
def large():
    """A torus of doubles whose tables need several statements a column."""
    series = lindstedt(Chain(4, alpha="0.25"), (1, 2, 3), ("0.7671", "1.4187", "1.8541"), 16)
    return FromSeries(series, (0.1, 0.07, 0.05), 16, 16).torus({1: 0.3, 2: -1.0, 3: 2.5})


def source(torus, name):
    return FORTRAN.torus(torus_program(torus, name, torus_facts(torus)))


@pytest.fixture(scope="module", params=CASES)
def torus(request):
    return case(request.param)


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
        command = [program("gfortran"), *STRICT_FORTRAN, *flags, *files, "-o", "program"]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        assert (done.returncode, done.stdout + done.stderr) == (0, "")
        return lambda given="": subprocess.run([tmp_path / "program"], input=given, capture_output=True, text=True)

    return build


def numbers(done):
    assert done.returncode == 0, done.stderr
    return np.array(done.stdout.split(), dtype=float)


def check_deviations(done, count):
    """Those that a self-test prints."""
    assert done.returncode == 0, done.stderr
    deviations = [float(x) for x in re.findall(r"\d\.\d+E[+-]\d+", done.stdout)]
    assert len(deviations) == count
    assert max(deviations) <= OF_LARGEST


@pytest.mark.long
def test_the_self_test_passes(build, text):
    check_deviations(build(text, flags=["-DEXAMPLE_SELF_TEST"])(), 3)


@pytest.mark.long
def test_the_self_test_fails_for_a_wrong_coefficient(build):
    text = source(case("mixed, three seeds"), "example")
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
    turned = replace(torus, phases={q: mpmath.mpf(phi) for q, phi in zip(torus.seeds, phases, strict=True)})
    exact = np.array([mpmath.mpf(times[i]) for i in picked])  # the doubles themselves, not their shortest decimals
    expected_Q, expected_P = turned.Q(exact), turned.P(exact)
    for found, expected in ((Q, expected_Q), (P, expected_P), (Q_orbit, expected_Q), (P_orbit, expected_P)):
        assert_close(found, expected)
    assert_close(E, turned.harmonic_energies(exact))
    assert_close(H, turned.energy(exact)[:, None])
    assert_close(Q_default, torus.Q(exact))


def test_no_times_no_values(build):
    driver = DRIVER.replace("NAME", "example").replace("SEEDS", "1").replace("MODES", "7")
    assert numbers(build(source(case("alpha, one seed"), "example"), driver)("0\n0.5\n")).size == 0


@pytest.mark.long
def test_tables_in_several_statements_are_whole(build, large):
    text = source(large, "example")
    assert "data (c_odd(i, 1), i = 1, " in text
    assert text.count("data (c_odd(i, 1), i = ") > 1
    check_deviations(build(text, flags=["-DEXAMPLE_SELF_TEST"])(), 3)


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
