"""Every notebook runs from top to bottom in under a minute of processor time; but for the first one, run by `make long`."""

import os
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
MINUTE = 60.0
PATIENCE = 600  # seconds by the clock for a notebook, where others use the processors too

# Cells in a shell of a process of its own: a kernel's messages can get lost, and then a client waits for good.
RUN = """
import sys, time
import nbformat
from IPython.core.interactiveshell import InteractiveShell

shell = InteractiveShell.instance()
for cell in nbformat.read(sys.argv[1], as_version=4).cells:
    if cell.cell_type == "code":
        shell.run_cell(cell.source).raise_error()
print("seconds:", time.process_time())
"""


def test_there_are_notebooks():
    assert NOTEBOOKS


def marked(path):
    return pytest.param(path, id=path.name, marks=[pytest.mark.long] * (path != NOTEBOOKS[0]))


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("path", [marked(path) for path in NOTEBOOKS])
def test_notebook_runs(path, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    stored = [cell for cell in notebook.cells if cell.cell_type == "code" and cell.outputs]
    assert stored, "outputs are kept, so that it reads well unexecuted"
    shell = {**os.environ, "MPLBACKEND": "agg", "IPYTHONDIR": str(tmp_path)}
    run = subprocess.run([sys.executable, "-c", RUN, str(path)], capture_output=True, text=True, timeout=PATIENCE, check=False, env=shell)
    assert run.returncode == 0, run.stdout[-2000:] + run.stderr[-2000:]
    _, seconds = run.stdout.rsplit("seconds:", 1)
    assert float(seconds) < MINUTE


def test_an_error_in_a_cell_is_seen(tmp_path):
    cells = [nbformat.v4.new_code_cell("a = 1"), nbformat.v4.new_code_cell("a / 0")]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), tmp_path / "wrong.ipynb")
    run = subprocess.run([sys.executable, "-c", RUN, str(tmp_path / "wrong.ipynb")], capture_output=True, text=True, check=False)
    assert run.returncode != 0
    assert "ZeroDivisionError" in run.stdout + run.stderr
