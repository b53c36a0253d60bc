"""Every notebook runs from top to bottom, each in under a minute."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))


def test_there_are_notebooks():
    assert NOTEBOOKS


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_notebook_runs(path):
    notebook = nbformat.read(path, as_version=4)
    stored = [cell for cell in notebook.cells if cell.cell_type == "code" and cell.outputs]
    assert stored, "outputs are kept, so that it reads well unexecuted"
    executed = NotebookClient(notebook, timeout=60, kernel_name="python3").execute()
    assert all(output.output_type != "error" for cell in executed.cells if cell.cell_type == "code" for output in cell.outputs)
