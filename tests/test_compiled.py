"""Compiled loops where nothing can be written beside the source or at home, and where nothing is compiled at all."""

import os
import shutil
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

import symfpu
from symfpu.algebra import uncompiled
from symfpu.compiled import temporary_folder
from tests.tolerances import THOUSAND_ROUNDINGS

ORBIT = """
from symfpu import Chain, integrate
print(*map(repr, integrate(Chain(N=4, alpha="0.3", beta="0.2"), [0.1] * 3, [0.2] * 3, 100, step=0.125, samples=4).Q[-1].tolist()))
"""

EVERYTHING = """
import numpy as np
from symfpu import Chain, alignment_indices, floquet, integrate, lindstedt, periodic_orbit, prove_propagation, solve_amplitudes

chain, beta = Chain(6, alpha="0.3", beta="0.2"), Chain(6, beta="0.3")
near = [repr(1.01 * float(beta.frequencies()[q])) for q in (0, 1)]
for digits in (None, 30):
    torus = solve_amplitudes(lindstedt(beta, (1, 2), near, 4, digits=digits))
    print(*(float(A) for A in torus.amplitudes.values()))
print(*prove_propagation(6, (1, 2), 3).verdict.encode())
for scheme in ("kahan_li8", "aba864_modes"):
    orbit = integrate(chain, [0.1] * 5, [0.2] * 5, 5, step=0.25, samples=4, scheme=scheme, averages=True)
    print(*orbit.Q[-1], *orbit.averages[-1])
print(*alignment_indices(Chain(3, beta=1), [0.1, 0.2], [0.2, 0.1], 100.0, samples=64, vectors=2).log10_gali[-1])
print(*np.abs(floquet(periodic_orbit(Chain(4, beta="0.3"), 1, "0.79")).pairs).ravel())
"""


def run(code, **environment):
    """The numbers it prints, line by line."""
    finished = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | environment,
    )
    return [[float(word) for word in line.split()] for line in finished.stdout.splitlines()]


@pytest.fixture
def installed(tmp_path):
    """A copy of the package beside whose sources no folder can be made, not by root either; and a folder for temporary files."""
    package = tmp_path / "lib" / "symfpu"
    shutil.copytree(Path(symfpu.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    for room in (package, *(path for path in package.rglob("*") if path.is_dir())):
        (room / "__pycache__").touch()
    (tmp_path / "tmp").mkdir()
    return tmp_path


def homeless(installed):
    """Runs the orbit without a home."""
    places = {"PYTHONPATH": str(installed / "lib"), "TMPDIR": str(installed / "tmp")}
    environment = places | {"HOME": os.devnull, "PATH": os.environ["PATH"]}
    return subprocess.run(
        [sys.executable, "-c", ORBIT],
        capture_output=True,
        text=True,
        check=False,
        env=environment,
        cwd=installed,
    )


@pytest.mark.long
def test_a_read_only_installation_without_a_home_keeps_its_code_in_a_temporary_folder(installed):
    first = homeless(installed)
    assert (first.returncode, first.stderr) == (0, "")
    (folder,) = (installed / "tmp").iterdir()
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    made = {path: path.stat().st_mtime_ns for path in folder.rglob("*.nbc")}
    assert made
    assert homeless(installed).stdout == first.stdout
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*.nbc")} == made


@pytest.mark.long
def test_a_temporary_folder_that_others_can_write_to_is_not_used(installed):
    planted = installed / "tmp" / f"symfpu-{os.getuid()}"
    planted.mkdir()
    planted.chmod(0o777)
    finished = homeless(installed)
    assert (finished.returncode, finished.stderr) == (0, "")
    assert list(planted.iterdir()) == []


@pytest.mark.parametrize("mode", [0o700, 0o770, 0o707])
def test_a_temporary_folder_is_of_this_user_alone(tmp_path, monkeypatch, mode):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    folder = tmp_path / f"symfpu-{os.getuid()}"
    folder.mkdir()
    folder.chmod(mode)
    temporary_folder.cache_clear()
    assert temporary_folder() == (str(folder) if mode == 0o700 else None)
    folder.rmdir()
    folder.symlink_to(tmp_path)
    temporary_folder.cache_clear()
    assert temporary_folder() is None
    temporary_folder.cache_clear()


@pytest.mark.long
def test_everything_runs_without_the_compiler():
    """NUMBA_DISABLE_JIT=1: the same numbers to rounding, without a warning."""
    compiled, interpreted = run(EVERYTHING), run(EVERYTHING, NUMBA_DISABLE_JIT="1")
    assert len(compiled) == len(interpreted) == 7
    for line, other in zip(compiled, interpreted, strict=True):
        assert other == pytest.approx(line, rel=THOUSAND_ROUNDINGS, abs=THOUSAND_ROUNDINGS)


def test_interpreted_products_modulo_a_prime_are_exact():
    prime, draws = 2**40 - 87, np.random.default_rng(1)
    a, b = draws.integers(-(prime // 2), prime // 2, size=(2, 2000))
    found = uncompiled.modular_product(a.astype(float), b.astype(float), float(prime), 1.0 / prime)
    assert all((int(x) * int(y) - int(z)) % prime == 0 for x, y, z in zip(a, b, found, strict=True))
    assert np.max(np.abs(found)) <= 1.5 * prime


@pytest.mark.long
def test_the_bits_of_an_orbit_do_not_depend_on_what_was_compiled_before(tmp_path):
    """Two modules compile the bond law, each for itself: neither must be given the code of the other."""
    from_scratch = run(ORBIT, NUMBA_CACHE_DIR=str(tmp_path / "one"))
    tangent = "import numpy as np\nfrom symfpu.chain.chain import Chain\nfrom symfpu.dynamics.tangent import tangent_steps\n"
    tangent += "tangent_steps(Chain(4, alpha='0.3', beta='0.2'), [0.1] * 3, [0.2] * 3, np.eye(3), np.eye(3), 0.25, 4)\n"
    run(tangent, NUMBA_CACHE_DIR=str(tmp_path / "two"))
    assert run(ORBIT, NUMBA_CACHE_DIR=str(tmp_path / "two")) == from_scratch
