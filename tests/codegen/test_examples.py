"""The examples of docs/export.md: programs outside the project that use the gallery, compiled and run."""

import re
import shutil
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import pytest

from symfpu import Torus
from symfpu.codegen.gallery import GALLERY
from tests.codegen.compilers import program
from tests.tolerances import HUNDRED_ROUNDINGS, TEN_ROUNDINGS

ROOT = Path(__file__).parents[2]
BLOCKS = re.findall(r"```(c|fortran|python|octave)\n(.*?)```", (ROOT / "docs" / "export.md").read_text(), re.DOTALL)
EXAMPLES = [(language, code) for language, code in BLOCKS if "import symfpu" not in code]  # those run in tests/test_docs.py
BUILD = {
    "c": ("gcc", "use_it.c", ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"], "c"),
    "fortran": ("gfortran", "use_it.f90", ["-std=f2008", "-Wall", "-Werror"], "F90"),
}
OF_SERIES = "two_torus_series"


@pytest.fixture(scope="module")
def torus():
    return GALLERY["two_torus"].torus()


def of_torus(torus):
    moved = replace(torus, phases={1: 0.5, 2: -1.0})
    return [moved.Q(100.0)[0], moved.P(100.0)[0]]


def of_series(torus):
    orders = GALLERY["two_torus"].series_orders
    A = [mpmath.mpf("0.5"), mpmath.mpf("0.25")]
    terms, slopes = torus.origin.series.frequency_terms(np.array(A) ** 2, orders["frequency_order"])
    omega = terms.sum(axis=0)
    free = replace(torus.origin, amplitudes=tuple(A), order=orders["order"]).torus(torus.phases)
    exact = tuple(Fraction(float(w)) for w in omega)
    moved = Torus(torus.chain, torus.seeds, exact, free.harmonics, free.cosines, {1: 0.5, 2: -1.0}, torus.digits)
    return [moved.Q(100.0)[0], omega[1], slopes.sum(axis=0)[0, 1] * 2 * A[1]]


@pytest.mark.long
@pytest.mark.parametrize(("language", "code"), EXAMPLES, ids=lambda x: x if len(x) < 10 else OF_SERIES if OF_SERIES in x else "torus")
def test_a_program_outside_uses_an_exported_file(language, code, torus, tmp_path):
    stem = OF_SERIES if OF_SERIES in code else "two_torus"
    if language == "python":
        shutil.copy(ROOT / "generated" / f"{stem}.py", tmp_path)
        command = [sys.executable, "-c", code]
    elif language == "octave":
        shutil.copy(ROOT / "generated" / f"{stem}.m", tmp_path)
        command = [program("octave-cli"), "--norc", "--eval", code]
    else:
        compiler, name, flags, extension = BUILD[language]
        (tmp_path / name).write_text(code)
        sources = [str(ROOT / "generated" / f"{stem}.{extension}"), name]
        subprocess.run([program(compiler), *flags, "-O2", *sources, "-o", "program", "-lm"], check=True, cwd=tmp_path)
        command = ["./program"]
    run = subprocess.run(command, check=True, capture_output=True, text=True, cwd=tmp_path)
    expected = [float(x) for x in (of_series(torus) if stem == OF_SERIES else of_torus(torus))]
    assert np.allclose([float(x) for x in run.stdout.split()], expected, rtol=HUNDRED_ROUNDINGS, atol=TEN_ROUNDINGS)
