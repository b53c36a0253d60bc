"""Programs that exported code needs: their path, or a test that is skipped with the package to install; strict compilers."""

import ctypes
import os
import shutil
import subprocess
import sys

import pytest

COMMANDS = {"gcc": ("gcc", "cc", "clang"), "gfortran": ("gfortran",), "octave-cli": ("octave-cli", "octave")}
PACKAGES = {"gcc": "gcc libc6-dev", "gfortran": "gfortran", "octave-cli": "octave"}
REQUIRED = "SYMFPU_REQUIRE_COMPILERS"  # in the environment: a missing program is a failure
STRICT_C = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O2")
STRICT_FORTRAN = ("-std=f2008", "-Wall", "-Werror", "-O2")


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


def library_of(folder, text):
    """A file of C as a library for ctypes."""
    return ctypes.CDLL(str(compile_c(folder, {"sample.c": text}, "-shared", "-fPIC", output="sample.so")))


def pointer(values):
    """What a function of C is given for an array, or for none."""
    return None if values is None else ctypes.c_void_p(values.ctypes.data)


def c_self_test(folder, text, *options, name="sample"):
    """The run of the test that stands in a file of C; the file is strict."""
    return subprocess.run(
        [compile_c(folder, {f"{name}.c": text}, f"-D{name}_SELF_TEST", *options)], capture_output=True, text=True, check=False
    )


def self_test(path, folder):
    """The run of a file that tests itself, of any language, by the ending of its name."""
    if path.suffix == ".py":
        command = [sys.executable, "-I", str(path)]
    elif path.suffix == ".m":
        command = [program("octave-cli"), "--norc", "--path", str(path.parent), "--eval", f"{path.stem}('self_test');"]
    else:
        c = path.suffix == ".c"
        flags = [*STRICT_C, f"-D{path.stem}_SELF_TEST"] if c else [*STRICT_FORTRAN, f"-D{path.stem.upper()}_SELF_TEST"]
        compiler = program("gcc" if c else "gfortran")
        subprocess.run([compiler, *flags, str(path), "-o", "self_test", "-lm"], check=True, cwd=folder)
        command = ["./self_test"]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
