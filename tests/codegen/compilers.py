"""Programs that exported code needs: their path, or a test that is skipped with the package to install; and strict C."""

import os
import shutil
import subprocess

import pytest

COMMANDS = {"gcc": ("gcc", "cc", "clang"), "gfortran": ("gfortran",), "octave-cli": ("octave-cli", "octave")}
PACKAGES = {"gcc": "gcc libc6-dev", "gfortran": "gfortran", "octave-cli": "octave"}
REQUIRED = "SYMFPU_REQUIRE_COMPILERS"  # in the environment: a missing program is a failure
STRICT_C = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O2")


def program(name):
    """The path of a program that is called by one of COMMANDS[name]; the test ends here if there is none."""
    found = next((path for command in COMMANDS[name] if (path := shutil.which(command))), None)
    if found is None:
        missing = f"{name} is not installed (Debian: apt-get install {PACKAGES[name]})"
        end = pytest.fail if REQUIRED in os.environ else pytest.skip
        end(missing)
    return found


def compile_c(folder, sources, *options, output="a.out"):
    """Compiled by a strict compiler without a word, by the path of what came out."""
    for name, text in sources.items():
        (folder / name).write_text(text)
    command = [program("gcc"), *STRICT_C, *options, "-o", output, *sources, "-lm"]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (0, "")
    return folder / output
