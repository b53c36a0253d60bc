"""What is given away: a source distribution holds the whole repository, a wheel works alone, every requirement has a lowest version."""

import runpy
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import venv
import zipfile
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NEEDED = "77"  # the build backend that pyproject.toml asks for
BUILD = "import sys; from setuptools.build_meta import build_sdist; build_sdist(sys.argv[1])"


def backend():
    try:
        return tuple(map(int, version("setuptools").split(".")[:1])) >= (int(NEEDED),)
    except PackageNotFoundError:
        return False


BUILDS = pytest.mark.skipif(not backend(), reason=f"setuptools {NEEDED} or later is not installed: pip install '.[dev]'")


@pytest.fixture
def tracked():
    if not (ROOT / ".git").exists():
        pytest.skip("not a checkout: git knows which files belong to the repository")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in listed.stdout.split("\0") if name and (ROOT / name).exists()]


@pytest.fixture
def copy(tracked, tmp_path):
    """The tracked files alone, in another folder."""
    folder = tmp_path / "copy"
    for name in tracked:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    return folder


@pytest.mark.long
@BUILDS
def test_every_tracked_file_is_in_the_sdist(copy, tracked, tmp_path):
    subprocess.run([sys.executable, "-c", BUILD, str(tmp_path)], cwd=copy, capture_output=True, check=True)
    (archive,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as contents:
        inside = {member.name.partition("/")[2] for member in contents.getmembers() if member.isfile()}
    assert set(tracked) <= inside


def test_the_manifest_names_every_tracked_file(tracked):
    lines = [line.split() for line in (ROOT / "MANIFEST.in").read_text().splitlines() if not line.startswith("#")]
    grafted = {folder for command, *folders in lines if command == "graft" for folder in folders}
    included = {file for command, *files in lines if command == "include" for file in files}
    by_backend = {"LICENSE", "MANIFEST.in", "README.md", "pyproject.toml"}
    left = [name for name in tracked if name.split("/")[0] not in grafted and name not in included | by_backend]
    assert left == []


WHEEL = BUILD.replace("build_sdist", "build_wheel")
WORDS = ["-N", "4", "--alpha", "0.3", "--seeds", "1", "--energy", "0.01", "--order", "2", "-o", "torus.symfpu", "--plot", "torus.png"]
CITED = "import symfpu; print(symfpu.__file__); print(symfpu.cite())"


def run(command, folder):
    """What a command prints, without the surroundings of this process."""
    clean = {"PATH": "/usr/bin:/bin", "HOME": str(folder), "OPENBLAS_NUM_THREADS": "1"}
    finished = subprocess.run(list(map(str, command)), cwd=folder, capture_output=True, text=True, check=False, env=clean)
    assert finished.returncode == 0, finished.stderr
    return finished.stdout


@pytest.mark.long
@BUILDS
@pytest.mark.skipif(sys.platform == "win32", reason="folders of environments have other names there")
def test_a_wheel_works_in_an_empty_environment(copy, tracked, tmp_path):
    run([sys.executable, "-c", WHEEL, tmp_path], copy)
    (wheel,) = tmp_path.glob("*.whl")
    inside = set(zipfile.ZipFile(wheel).namelist())
    kept = {name for name in tracked if name.startswith("symfpu/")}
    assert kept <= inside
    assert not any(name.startswith("tests/") for name in inside)
    environment = tmp_path / "environment"
    venv.create(environment, with_pip=True)
    python = environment / "bin" / "python"
    run([python, "-m", "pip", "install", "--no-deps", "--no-index", wheel], tmp_path)
    site = Path(run([python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], tmp_path).strip())
    (site / "dependencies.pth").write_text(sysconfig.get_path("purelib"))  # those of this environment, but not its symfpu
    home, *cited = run([python, "-c", CITED], tmp_path).splitlines()
    assert Path(home).is_relative_to(site)
    assert cited[0].startswith("The symfpu developers.")
    symfpu = environment / "bin" / "symfpu"
    assert "energy shared" in run([symfpu, "solve", *WORDS], tmp_path)
    assert "verdict: " in run([symfpu, "refine", "torus.symfpu"], tmp_path)
    run([symfpu, "export", "torus.symfpu", "--lang", "numpy", "-o", "torus"], tmp_path)
    run([python, "torus.py"], tmp_path)
    assert (tmp_path / "torus.png").stat().st_size > 0


lowest = runpy.run_path(str(ROOT / ".ci" / "lowest.py"))["lowest"]


def test_the_constraints_are_the_bounds_of_the_project(tmp_path):
    project = tmp_path / "pyproject.toml"
    project.write_text('[project]\ndependencies = ["b-c>=1.5", "a>=2"]\n[project.optional-dependencies]\nx = ["d>=0.1rc1", "a>=2"]\n')
    assert list(lowest(project)) == ["a==2", "b-c==1.5", "d==0.1rc1"]


@pytest.mark.parametrize("requirement", ["a", "a==1", "a>=1,<2", "a>1"])
def test_a_requirement_without_a_lowest_version_is_refused(requirement, tmp_path):
    project = tmp_path / "pyproject.toml"
    project.write_text(f'[project]\ndependencies = ["{requirement}"]\n[project.optional-dependencies]\n')
    with pytest.raises(ValueError, match="not of the form"):
        list(lowest(project))


def test_our_own_requirements_have_one():
    names = [line.split("==")[0] for line in lowest()]
    assert {"numpy", "scipy", "numba", "pytest"} <= set(names)
    assert len(names) == len(set(names))
