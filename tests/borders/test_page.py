"""The tables of docs/atlas.md are those of its data."""

import importlib.util
from pathlib import Path

import pytest

from symfpu import read_atlas

DOCS = Path(__file__).parents[2] / "docs"
SCRIPT = DOCS / "make_atlas.py"


@pytest.mark.skipif(not SCRIPT.exists(), reason="no pages beside an installed package")
def test_the_page_has_the_tables_of_the_data():
    made = importlib.util.spec_from_file_location("make_atlas", SCRIPT)
    module = importlib.util.module_from_spec(made)
    made.loader.exec_module(module)
    text = module.PAGE.read_text()
    found = read_atlas(module.FILE)
    assert module.with_tables(text, found) == text
    rows = (*found.rows.rows, *read_atlas(module.NEWTON_FILE).rows.rows)
    assert all(row.failure is None for row in rows)


@pytest.mark.skipif(not SCRIPT.exists(), reason="no pages beside an installed package")
def test_all_rows_are_of_its_grids():
    made = importlib.util.spec_from_file_location("make_atlas", SCRIPT)
    module = importlib.util.module_from_spec(made)
    made.loader.exec_module(module)
    asked = {(c.N, p, K) for g in module.grids() for c in g["chains"] for p in g["packets"] for K in g["order"]}
    rows = read_atlas(module.FILE).rows.rows
    assert {(row.case["chain"]["N"], row.case["packet"], row.case["order"]) for row in rows} <= asked
