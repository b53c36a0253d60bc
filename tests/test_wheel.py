"""A wheel, installed into an empty environment, solves a torus, refines, exports, draws and cites itself."""

import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest

from tests.test_sdist import BUILD, NEEDED, ROOT, backend, tracked

__all__ = ["tracked"]  # the fixture
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
@pytest.mark.skipif(not backend(), reason=f"setuptools {NEEDED} or later is not installed: pip install '.[dev]'")
@pytest.mark.skipif(sys.platform == "win32", reason="folders of environments have other names there")
def test_a_wheel_works_in_an_empty_environment(tracked, tmp_path):
    copy = tmp_path / "copy"
    for name in tracked:
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_bytes((ROOT / name).read_bytes())
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
