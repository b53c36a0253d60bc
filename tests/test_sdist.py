"""A source distribution holds the whole repository, so that its tests and pages can be run and read."""

import shutil
import subprocess
import sys
import tarfile
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


@pytest.fixture
def tracked():
    if not (ROOT / ".git").exists():
        pytest.skip("not a checkout: git knows which files belong to the repository")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in listed.stdout.split("\0") if name and (ROOT / name).exists()]


@pytest.mark.long
@pytest.mark.skipif(not backend(), reason=f"setuptools {NEEDED} or later is not installed: pip install '.[dev]'")
def test_every_tracked_file_is_in_the_sdist(tracked, tmp_path):
    copy, built = tmp_path / "copy", tmp_path / "built"
    built.mkdir()
    for name in tracked:
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, copy / name)
    subprocess.run([sys.executable, "-c", BUILD, str(built)], cwd=copy, capture_output=True, check=True)
    (archive,) = built.glob("*.tar.gz")
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
