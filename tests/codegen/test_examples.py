"""The examples of docs/export.md: programs outside the project that use the gallery, compiled and run."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from symfpu.codegen.gallery import GALLERY

ROOT = Path(__file__).parents[2]
EXAMPLES = dict(re.findall(r"```(c|fortran|python)\n(.*?)```", (ROOT / "docs" / "export.md").read_text(), re.DOTALL))
BUILD = {
    "c": ("gcc", "use_torus.c", ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"], "two_torus.c"),
    "fortran": ("gfortran", "use_torus.f90", ["-std=f2008", "-Wall", "-Werror"], "two_torus.F90"),
}


@pytest.fixture(scope="module")
def expected():
    torus = GALLERY["two_torus"].torus()
    object.__setattr__(torus, "phases", {1: 0.5, 2: -1.0})
    return [float(torus.positions(100.0)[0]), float(torus.momenta(100.0)[0])]


@pytest.mark.parametrize("language", ["c", "fortran", "python"])
def test_a_program_outside_reproduces_the_torus(language, expected, tmp_path):
    if language == "python":
        shutil.copy(ROOT / "generated" / "two_torus.py", tmp_path)
        command = [sys.executable, "-c", EXAMPLES["python"]]
    else:
        compiler, name, flags, gallery = BUILD[language]
        if not shutil.which(compiler) and not os.environ.get("SYMFPU_REQUIRE_COMPILERS"):
            pytest.skip(f"{compiler} is not installed")
        (tmp_path / name).write_text(EXAMPLES[language])
        command = [compiler, *flags, "-O2", str(ROOT / "generated" / gallery), name, "-o", "program", "-lm"]
        subprocess.run(command, check=True, cwd=tmp_path)
        command = ["./program"]
    run = subprocess.run(command, check=True, capture_output=True, text=True, cwd=tmp_path)
    assert np.allclose([float(x) for x in run.stdout.split()], expected, rtol=1e-13, atol=1e-14)
