"""Every public result has a table, and what has axes is written to netCDF and read back the same."""

import inspect
import re
from pathlib import Path

import numpy as np
import pytest

import symfpu
from symfpu.frames.tabled import Gridded, Tabled
from tests.test_pickle import RESULTS, public_classes

# single numbers, arguments, programs, and what holds results that have tables
WITHOUT = {
    "AtlasBorder": "a row of Atlas",
    "BorderLaw": "numbers of one line",
    "Bundle": "holds a series and a torus",
    "Chain": "an argument",
    "Evaluator": "a program",
    "Event": "one row of a family's data set",
    "ExpandableTerm": "an expression",
    "NamedParts": "an expression",
    "NormalEvent": "a line of NormalFamily",
    "NormalFrequencies": "rows of a family's data set",
    "NormalMode": "a row of NormalModes",
    "ParametricResonance": "a line of NormalModes",
    "ProfileDistance": "one number and its mode",
    "ProfileLine": "three numbers",
    "SpectralLine": "a row of FrequencyAnalysis",
}
CASES = {name: make for name, (make, _) in RESULTS.items() if issubclass(getattr(symfpu, name.partition(",")[0], object), Tabled)}
PAGE = (Path(__file__).parents[2] / "docs" / "tables.md").read_text()
RESIDUES = "LindstedtSeries, residue"
WITH_NUMBERS = [name for name in CASES if not name.startswith(RESIDUES)]


def test_every_public_result_has_a_table_or_a_reason():
    with_table = {name for name in public_classes() if issubclass(getattr(symfpu, name), Tabled)}
    assert public_classes() - with_table == set(WITHOUT)


def test_what_has_a_method_of_its_own_inherits_the_public_ones():
    for name in public_classes():
        kind = getattr(symfpu, name)
        for own, base in (("_table", Tabled), ("_grid", Gridded)):
            if own in vars(kind):
                assert issubclass(kind, base), name
    assert [name for name, _ in inspect.getmembers(Gridded) if name.startswith("to_")] == ["to_frame", "to_xarray"]


def test_every_result_with_a_table_is_looked_at():
    names = {name.partition(",")[0] for name in CASES}
    assert names == public_classes() - set(WITHOUT)


@pytest.mark.parametrize("name", WITH_NUMBERS)
def test_the_table_says_what_it_is_of(name, tmp_path):
    result = CASES[name](tmp_path)
    table = result.to_frame()
    assert len(table) > 0
    assert left_out(type(result).__name__, table) == []
    assert len(set(table)) == len(list(table))
    assert table.attrs["result"] == type(result).__name__
    assert table.attrs["symfpu_version"] == symfpu.__version__
    assert table.attrs["units"] == "dimensionless"
    if hasattr(result, "chain"):
        assert table.attrs["chain"] == repr(result.chain)
    if isinstance(result, Gridded):
        found = result.to_xarray()
        assert left_out(type(result).__name__, found.data_vars) == []
        assert all(re.search(rf"\b{axis}\b", row_of(type(result).__name__)) for axis in found.dims)
        returns_from_netcdf(found, tmp_path / "file.nc")


def row_of(name):
    """What the page says of a result."""
    (row,) = [line for line in PAGE.splitlines() if re.match(rf"\|[^|]*`{name}`", line)]
    return row


def left_out(name, columns):
    """Columns or variables that its row on the page, or one that it refers to, does not name."""
    rows = [row_of(other) for other in re.findall(r"`([A-Z]\w+)`", row_of(name).split("|", 2)[2]) if other != name]
    words = set(re.findall(r"\w+\*?", " ".join([row_of(name), *rows]).replace("**", "")))
    plain = {column: re.sub("_(real|imaginary)$", "", column) for column in columns}
    by_seed = {column: re.sub(r"_-?\d+$", "", base) for column, base in plain.items()}
    return [column for column, base in by_seed.items() if not {plain[column], base, f"{base}_*"} & words]


def test_residues_are_refused_by_name(tmp_path):
    with pytest.raises(symfpu.InputError, match="of residues"):
        CASES[RESIDUES](tmp_path).to_frame()


def returns_from_netcdf(found, path):
    xarray = pytest.importorskip("xarray")
    found.to_netcdf(path, engine="h5netcdf")
    with xarray.open_dataset(path, engine="h5netcdf") as read:
        xarray.testing.assert_equal(read.load(), found)
        assert {name: read[name].attrs for name in read.data_vars} == {name: found[name].attrs for name in found.data_vars}
        assert read.attrs.keys() == found.attrs.keys()
        for name, value in found.attrs.items():
            assert np.array_equal(read.attrs[name], value), name
    assert all(variable.attrs["units"] in ("dimensionless", "radians") for variable in found.data_vars.values())
    assert all(variable.dtype.kind in "fibUOT" for variable in found.data_vars.values())
