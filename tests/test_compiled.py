"""Compiled loops where nothing can be written beside the source or at home, and where nothing is compiled at all."""

import os
import shutil
import stat
import subprocess
import sys
import tempfile
import types
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import symfpu
from symfpu import compiled as loops
from symfpu.algebra import uncompiled
from symfpu.compiled import LoopCache, class_digest, kept_folder, temporary_folder
from tests.tolerances import THOUSAND_ROUNDINGS

ORBIT = """
from symfpu import Chain, integrate
print(*map(repr, integrate(Chain(N=4, alpha="0.3", beta="0.2"), [0.1] * 3, [0.2] * 3, 100, step=0.125, samples=4).Q[-1].tolist()))
"""

EVERYTHING = """
import numpy as np
import symfpu
from symfpu import Chain, alignment_indices, floquet, integrate, lindstedt, prove_propagation, solve_amplitudes

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
print(*np.abs(floquet(symfpu.torus(Chain(4, beta="0.3"), (1,), frequencies=("0.79",))).pairs).ravel())
"""


def run(code, folder=None, **environment):
    """The numbers it prints, line by line. folder : from which Python imports before all others."""
    command, surroundings = [sys.executable, "-W", "error", "-c", code], os.environ | environment
    finished = subprocess.run(command, capture_output=True, text=True, check=True, env=surroundings, cwd=folder)
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
    environment, command = places | {"HOME": os.devnull, "PATH": os.environ["PATH"]}, [sys.executable, "-c", ORBIT]
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment, cwd=installed)


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


LAW = """
from typing import NamedTuple

UNIT = 1.0

def cube(r):
    return UNIT * r**3

class Law(NamedTuple):
    a: float

    def tension(self, r):
        return r + self.a * cube(r)

    def stiffness(self, r):
        return 1 + 3 * self.a * r**2
"""


def law_of(source):
    """The class of laws of a module with this source."""
    module = types.ModuleType("of_a_user")
    exec(source, module.__dict__)  # as an import of the user's file would
    return module.Law


@pytest.mark.parametrize("change", [("r**3", "r**5"), ("self.a *", "2 * self.a *"), ("UNIT = 1.0", "UNIT = 2.0")])
def test_machine_code_is_found_by_what_a_law_does(change):
    assert class_digest(law_of(LAW)) == class_digest(law_of("# moved by a line" + LAW))
    assert class_digest(law_of(LAW)) != class_digest(law_of(LAW.replace(*change)))


class Law(NamedTuple):
    a: float


def test_an_index_of_machine_code_whose_classes_are_gone_counts_as_empty(tmp_path, monkeypatch):
    monkeypatch.setattr("symfpu.compiled.CONFIG.CACHE_DIR", str(tmp_path))
    file = LoopCache(run)._cache_file
    file.save("key", Law(1.0))
    assert file.load("key") == Law(1.0)
    file.save(Law(1.0), "code")
    monkeypatch.delattr(sys.modules[__name__], "Law")
    assert file.load("key") is None
    file.save("key", "other code")
    assert file.load("key") == "other code"


POTENTIAL = """
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple
from symfpu.chain.potentials.potential import Potential

def quartic(r):
    return r**3

class OwnLaw(NamedTuple):
    beta: Any

    def potential(self, r):
        return r**2 / 2 + self.beta * r**4 / 4

    def tension(self, r):
        return r + self.anharmonic_tension(r)

    def stiffness(self, r):
        return 1 + self.anharmonic_stiffness(r)

    def anharmonic_tension(self, r):
        return self.beta * quartic(r)

    def anharmonic_stiffness(self, r):
        return 3 * self.beta * r**2

@dataclass(frozen=True, repr=False)
class Own(Potential):
    kind = "own"
    even = True
    parameters = ()

    def coefficient(self, n):
        return Fraction(n == 4)

    def law(self, numbers):
        return OwnLaw(numbers.number(Fraction(1)))

    def expression(self, r):
        return r**2 / 2 + r**4 / 4
"""

OF_A_USER = """
from symfpu import Chain, alignment_indices, integrate, packet_state
{}
start = packet_state(chain, (1,), "0.3")
print(*map(repr, integrate(chain, *start, 20, step=0.1).Q[-1].tolist()))
print(*alignment_indices(chain, *start, 100).log10_gali[-1])
"""


@pytest.mark.long
def test_the_file_of_a_law_may_change_and_go(tmp_path):
    """Orbits are of the law as it is now, and those of other chains do not need it."""
    file = tmp_path / "potential_of_a_user.py"
    own = OF_A_USER.format("from potential_of_a_user import Own\nchain = Chain(6, potential=Own())")
    beta, places = OF_A_USER.format("chain = Chain(6, beta=1)"), {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    paths = os.pathsep.join([str(tmp_path), *sys.path])
    file.write_text(POTENTIAL)
    found, expected = (run(code, PYTHONPATH=paths, **places) for code in (own, beta))
    for line, other in zip(found, expected, strict=True):
        assert line == pytest.approx(other, abs=THOUSAND_ROUNDINGS * 10)
    file.write_text(POTENTIAL.replace("return r**3", "return 2 * r**3"))
    changed = run(own, PYTHONPATH=paths, **places)
    assert max(abs(a - b) for a, b in zip(changed[0], found[0], strict=True)) > 0.01
    file.unlink()
    assert run(beta, PYTHONPATH=paths, **places) == expected


@pytest.fixture
def package(tmp_path):
    """Loops with a constant of another file, and a file that is compiled into none."""
    files = {
        "__init__.py": "",
        "loops.py": "from symfpu.compiled import compiled\nfrom symfpu.room import (\n    sizes,\n)\n",
        "room/__init__.py": "",
        "room/sizes.py": "from symfpu.room.words import WORD\n\nSIZE = 3\n",
        "room/words.py": "WORD = 1\n",
        "reports.py": "from symfpu.loops import loop\n",
    }
    for name, text in files.items():
        path = tmp_path / "symfpu" / name
        path.parent.mkdir(exist_ok=True, parents=True)
        path.write_text(text)
    return tmp_path / "symfpu"


def test_machine_code_is_of_all_files_that_loops_import_from(package):
    assert list(loops.loop_sources(package)) == ["loops.py", "room/__init__.py", "room/sizes.py", "room/words.py"]


@pytest.mark.parametrize(("name", "other"), [("room/words.py", True), ("loops.py", True), ("reports.py", False)])
def test_another_source_has_another_digest(package, monkeypatch, name, other):
    monkeypatch.setattr(loops, "PACKAGE", package)
    before = loops.loops_digest.__wrapped__()
    os.utime(package / name, (0, 0))
    assert loops.loops_digest.__wrapped__() == before
    (package / name).write_text("WORD = 2\nfrom symfpu.compiled import compiled\n" if other else "# a comment\n")
    assert (loops.loops_digest.__wrapped__() != before) is other


def test_the_sources_of_the_package_are_all_that_compile():
    found = loops.loop_sources(loops.PACKAGE)
    assert {"compiled.py", "chain/bond_loops.py", "numbers/lanes.py"} <= set(found)
    assert "cli/main.py" not in found


@pytest.fixture
def caches(tmp_path, monkeypatch):
    """The user's folder of caches."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(loops.CONFIG, "CACHE_DIR", "")
    kept_folder.cache_clear()
    yield tmp_path
    kept_folder.cache_clear()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have other folders")
def test_machine_code_lies_in_the_cache_of_the_user(caches):
    folder = Path(kept_folder())
    assert folder.parent == caches / "symfpu" / "loops"
    assert stat.S_IMODE(folder.parent.stat().st_mode) == 0o700
    cache = LoopCache(uncompiled.modular_product)
    assert Path(cache.cache_path) == folder / "symfpu.algebra.uncompiled"


@pytest.mark.parametrize("mode", [0o770, 0o707])
def test_a_cache_that_others_can_write_to_is_not_used(caches, mode):
    folder = caches / "symfpu" / "loops"
    folder.mkdir(parents=True)
    folder.chmod(mode)
    assert kept_folder() is None
    assert not str(LoopCache(uncompiled.modular_product).cache_path).startswith(str(caches / "symfpu"))


def test_a_cache_that_the_user_names_wins_and_other_files_are_left_to_the_compiler(caches, monkeypatch):
    assert not LoopCache(run).cache_path.startswith(str(caches))
    monkeypatch.setattr(loops.CONFIG, "CACHE_DIR", str(caches / "mine"))
    assert LoopCache(uncompiled.modular_product).cache_path.startswith(str(caches / "mine"))


def test_the_machine_code_of_old_sources_goes(caches):
    top = caches / "symfpu" / "loops"
    top.mkdir(parents=True, mode=0o700)
    for age in range(loops.MOST_KEPT + 3):
        (top / f"old{age}").mkdir()
        (top / f"old{age}" / "code.nbc").touch()
        os.utime(top / f"old{age}", (1e9 - age, 1e9 - age))
    own = Path(kept_folder())
    assert {room.name for room in top.iterdir()} == {own.name, *(f"old{age}" for age in range(loops.MOST_KEPT - 1))}


def test_two_that_keep_code_at_once_lose_none(caches):
    """Each would read an index without the other's code, and give its own the same number."""

    def keep(first):
        cache = LoopCache(uncompiled.modular_product)
        cache._impl.locator.ensure_cache_path()
        for number in range(first, 60, 3):
            cache._cache_file.save(number, f"code {number}")

    with ThreadPoolExecutor(3) as pool:
        list(pool.map(keep, range(3)))
    kept = LoopCache(uncompiled.modular_product)._cache_file
    assert [kept.load(number) for number in range(60)] == [f"code {number}" for number in range(60)]


@pytest.mark.long
def test_another_clone_finds_machine_code(tmp_path):
    """By what its sources say, not by their place and time."""
    kept = {}
    for name in ("one", "two", "other"):
        package = tmp_path / name / "symfpu"
        shutil.copytree(Path(symfpu.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"), copy_function=shutil.copy)
        if name == "other":
            changed = package / "numbers" / "functions.py"
            changed.write_text(changed.read_text() + "\nNOTHING = 0\n")
        run(ORBIT, tmp_path / name, XDG_CACHE_HOME=str(tmp_path / "caches"), NUMBA_CACHE_DIR="")
        kept[name] = {path: path.stat().st_mtime_ns for path in (tmp_path / "caches").rglob("*.nbc")}
        assert not list(package.rglob("*.nbc"))
    assert kept["one"]
    assert kept["two"] == kept["one"]
    assert len(kept["other"]) == 2 * len(kept["one"])
