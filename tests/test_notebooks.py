"""Every notebook runs in under a minute of processor time, and its sliders move, by `make long`; what they import is there."""

import ast
import importlib
import os
import re
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
seconds = time.process_time()
if "sliders" in shell.user_ns:
    moved = shell.user_ns["sliders"].widget
    for slider in [one for one in moved.children if hasattr(one, "max")]:
        moved.result = None  # a widget shows what its function raises, and goes on
        slider.value = slider.max if slider.value != slider.max else slider.min
        assert moved.result is not None, f"nothing is drawn with {slider.description} = {slider.value}"
print("seconds:", seconds)
"""


def test_there_are_notebooks():
    assert NOTEBOOKS


def imported(source):
    """Pairs (module, name) that the import statements of a cell ask for; lines of magics do not count."""
    plain = "\n".join(line for line in source.splitlines() if not line.lstrip().startswith(("%", "!")))
    for statement in ast.walk(ast.parse(plain)):
        if isinstance(statement, ast.ImportFrom):
            yield from ((statement.module, alias.name) for alias in statement.names)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_what_a_notebook_imports_is_there(path):
    cells = nbformat.read(path, as_version=4).cells
    asked = [pair for cell in cells if cell.cell_type == "code" for pair in imported(cell.source)]
    assert asked
    for module, name in asked:
        assert hasattr(importlib.import_module(module), name), f"{module} has no {name}"


def marked(path):
    return pytest.param(path, id=path.name, marks=pytest.mark.long)


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


@pytest.mark.long
def test_an_error_in_a_cell_is_seen(tmp_path):
    cells = [nbformat.v4.new_code_cell("a = 1"), nbformat.v4.new_code_cell("a / 0")]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), tmp_path / "wrong.ipynb")
    run = subprocess.run([sys.executable, "-c", RUN, str(tmp_path / "wrong.ipynb")], capture_output=True, text=True, check=False)
    assert run.returncode != 0
    assert "ZeroDivisionError" in run.stdout + run.stderr


@pytest.mark.long
@pytest.mark.parametrize("body", ["x / 0", "None"])
def test_a_slider_that_draws_nothing_is_seen(body, tmp_path):
    cells = [nbformat.v4.new_code_cell(f"from ipywidgets import interact\nsliders = interact(lambda x: {body}, x=(0, 2))")]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), tmp_path / "still.ipynb")
    run = subprocess.run([sys.executable, "-c", RUN, str(tmp_path / "still.ipynb")], capture_output=True, text=True, check=False)
    assert run.returncode != 0
    assert "nothing is drawn with x = 2" in run.stderr


PLACES = re.compile(r"/(?:home|tmp|work|Users|root)/|[A-Z]:\\\\")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_stored_outputs_name_no_place_of_a_machine(path):
    cells = nbformat.read(path, as_version=4).cells
    shown = [str(cell.outputs) for cell in cells if cell.cell_type == "code"]
    assert [found for text in shown for found in PLACES.findall(text)] == []
