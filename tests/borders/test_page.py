"""The tables of docs/atlas.md are those of its data."""

import importlib.util
from pathlib import Path

import pytest

from symfpu import read_atlas

DOCS = Path(__file__).parents[2] / "docs"
SCRIPT = DOCS / "make_atlas.py"


@pytest.fixture(scope="module")
def module():
    if not SCRIPT.exists():
        pytest.skip("no pages beside an installed package")
    made = importlib.util.spec_from_file_location("make_atlas", SCRIPT)
    module = importlib.util.module_from_spec(made)
    made.loader.exec_module(module)
    return module


@pytest.mark.long
def test_the_page_has_the_tables_of_the_data(module):
    text = module.PAGE.read_text()
    found = read_atlas(module.FILE)
    assert module.with_tables(text, found) == text
    files = (module.NEWTON_FILE, module.ONE_SEED_FILE, *module.CHAOS_FILES.values())
    rows = [row for atlas_of in (found, *map(read_atlas, files)) for row in atlas_of.rows.rows]
    assert all(row.failure is None for row in rows)


def test_all_rows_are_of_its_grids(module):
    asked = {(c.N, p, K) for g in module.grids() for c in g["chains"] for p in g["packets"] for K in g["order"]}
    rows = read_atlas(module.FILE).rows.rows
    assert {(row.case["chain"]["N"], row.case["packet"], row.case["order"]) for row in rows} <= asked


@pytest.mark.long
def test_all_orbits_and_tori_are_of_its_grids(module):
    grids = (*module.chaos_grids(), *module.newton_grids(), *module.one_seed_grids())
    asked = {(g["file"], c.typed["N"], p) for g in grids for c in g["chains"] for p in g["packets"]}
    files = (module.NEWTON_FILE, module.ONE_SEED_FILE, *module.CHAOS_FILES.values())
    held = {(file, str(row.case["chain"]["N"]), row.case["packet"]) for file in files for row in read_atlas(file).rows.rows}
    assert held == {(file, str(N), packet) for file, N, packet in asked}
    for T, file in module.CHAOS_FILES.items():
        assert float(read_atlas(file).rows.fixed["time"]) == T
