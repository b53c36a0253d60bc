"""Every notebook runs from top to bottom in under a minute of processor time; but for the first one, run by `make long`."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
MINUTE = 60.0
PATIENCE = 600  # seconds by the clock for a cell, where others use the processors too
CLOCK = "import time; print(time.process_time())"


def test_there_are_notebooks():
    assert NOTEBOOKS


def marked(path):
    return pytest.param(path, id=path.name, marks=[pytest.mark.long] * (path != NOTEBOOKS[0]))


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("path", [marked(path) for path in NOTEBOOKS])
def test_notebook_runs(path):
    notebook = nbformat.read(path, as_version=4)
    stored = [cell for cell in notebook.cells if cell.cell_type == "code" and cell.outputs]
    assert stored, "outputs are kept, so that it reads well unexecuted"
    notebook.cells.append(nbformat.v4.new_code_cell(CLOCK))
    executed = NotebookClient(notebook, timeout=PATIENCE, kernel_name="python3").execute()
    *cells, clock = executed.cells
    assert all(output.output_type != "error" for cell in cells if cell.cell_type == "code" for output in cell.outputs)
    assert float(clock.outputs[0].text) < MINUTE
