"""Every public result, by one registry (tests/every_result.py): copies, text, files, records, tables and pictures."""

import base64
import json
import re
from collections.abc import Mapping
from pathlib import Path

import flint
import mpmath
import numpy as np
import pytest
from matplotlib.figure import Figure

import symfpu
from symfpu import InputError, load, save, saved_file
from symfpu.cli.main import main
from symfpu.results.pictures import picture_of
from symfpu.results.result import Result
from tests.elements import read
from tests.every_result import CASES, COPIES, WITHOUT, kind_of, public_classes, result
from tests.store.test_saved_file import same

ROOT = Path(__file__).parents[1]
METHODS = {"record": "record", "table": "to_frame"}
RECORDS, TABLES = ((ROOT / "docs" / page).read_text() for page in ("records.md", "tables.md"))
RAW = re.compile(r"array\(|mpf\(|Fraction\(|np\.\w+\(| object at 0x")  # numbers as Python writes them


def those_with(what):
    """Cases whose class has a file, a record or a table."""
    return [name for name in CASES if what not in WITHOUT.get(kind_of(name), ("", ""))[0] and kind_of(name) in public_classes()]


def test_every_public_class_has_a_case():
    assert public_classes() <= {kind_of(name) for name in CASES}
    assert public_classes() >= WITHOUT.keys()


@pytest.mark.parametrize("name", CASES)
def test_a_case_is_of_its_class(name):
    assert type(result(name)).__name__ == kind_of(name)


@pytest.mark.parametrize("what", METHODS)
def test_what_has_no_record_or_table_is_listed_with_a_reason(what):
    without = {name for name in public_classes() if not hasattr(getattr(symfpu, name), METHODS[what])}
    assert without == {name for name, (missing, _) in WITHOUT.items() if what in missing}


# copies and text


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("name", CASES)
def test_a_copy_answers_the_same(name, way):
    """And leaves the working precision as it was."""
    answers, before = CASES[name].answers, repr(result(name))
    precision = mpmath.mp.prec, flint.ctx.prec
    returned = COPIES[way](result(name))
    assert returned is not result(name)
    if name != "Evaluator":  # holds functions
        assert same(returned, result(name))
    assert repr(returned) == before
    assert same(answers(returned), answers(result(name)))
    assert (mpmath.mp.prec, flint.ctx.prec) == precision


def digits_of(value):
    """All mpf of an answer."""
    if isinstance(value, np.ndarray | Mapping):
        value = list(value.ravel() if isinstance(value, np.ndarray) else value.values())
    if isinstance(value, list | tuple):
        return [x for item in value for x in digits_of(item)]
    return [value] if isinstance(value, mpmath.mpf) else []


PRECISE = [name for name in CASES if "digits" in name or kind_of(name) in {"PadeSum", "Torus, IterativeRefinement", "TodaTorus"}]


@pytest.mark.parametrize("name", PRECISE)
def test_numbers_of_many_digits_print_all_of_them(name):
    """Against an mpf that prints 15 of them; the precision of mpmath is not touched."""
    found = digits_of(CASES[name].answers(result(name)))
    assert found
    for x in found:
        plain = mpmath.nstr(mpmath.mp.make_mpf(x._mpf_), x.digits)
        assert str(x) == f"{x}" == repr(x)[5:-2] == plain
        assert x.digits == getattr(result(name), "digits", x.digits)
    assert mpmath.mp.dps == 15


@pytest.mark.parametrize("name", CASES)
def test_a_result_prints_an_answer(name):
    """Not the fields of the dataclass one after another."""
    found = result(name)
    assert not hasattr(type(found).__repr__, "__wrapped__"), "the default of dataclasses"
    assert not RAW.findall(repr(found))
    assert repr(found) == repr(found).strip()


# files


@pytest.mark.parametrize("name", those_with("file"))
def test_a_result_comes_back_from_its_file(name, tmp_path, capsys):
    kept, answers = result(name), CASES[name].answers
    with mpmath.workdps(5):  # the precision of the moment is not the file's
        file = save(tmp_path / "result.symfpu", kept, verdict={"verdict": "good"}, command="a command")
        found, again = saved_file(file), load(file)
    assert type(again) is type(found.result) is type(kept)
    assert same(again, kept)
    assert repr(again) == repr(kept)
    assert same(answers(again), answers(kept))
    assert (found.verdict, found.provenance["command"]) == ({"verdict": "good"}, "a command")
    assert main(["show", str(file)]) == 0
    assert "created" in capsys.readouterr().out
    assert main(["show", str(file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["kind"] == type(kept).__name__


@pytest.mark.parametrize("name", [name for name, (missing, _) in WITHOUT.items() if "file" in missing])
def test_what_has_no_file_is_refused(name, tmp_path):
    with pytest.raises(InputError):
        save(tmp_path / "file", result(name))
    assert not (tmp_path / "file").exists()


# records

FORMS = {
    "frequencies": str,
    "amplitudes": str,
    "energy": str,
    "harmonic_energy": str,
    "average_harmonic_energy": str,
    "residual": float,
    "verdict": str,
    "digits": (int, type(None)),
}


def numbers(value):
    """All numbers of a record that are no whole ones."""
    if isinstance(value, dict):
        return [x for item in value.values() for x in numbers(item)]
    if isinstance(value, list):
        return [x for item in value for x in numbers(item)]
    return [value] if isinstance(value, float) else []


def check_forms(found):
    """Numbers have fifteen digits, values of a key one form."""
    assert all(float(f"{value:.15g}") == value for value in numbers(found))
    for key, form in FORMS.items():
        values = found.get(key)
        inside = values.values() if isinstance(values, dict) else [values] * (values is not None)
        assert all(isinstance(value, form) for value in inside), key


@pytest.mark.parametrize("name", those_with("record"))
def test_a_record_is_json_with_keys_of_the_page_and_the_same_forms(name):
    """As a strict reader gets it: no NaN, no Infinity."""
    kept = result(name)
    found = kept.record()
    assert json.loads(json.dumps(found, allow_nan=False)) == found
    about = kept.result if name == "SavedFile" else kept
    assert (found["kind"], found["symfpu_version"]) == (type(about).__name__, symfpu.__version__)
    assert found.keys() - set(re.findall(r"`(\w+)`", RECORDS)) == set()
    if hasattr(about, "chain"):
        assert {key: found[key] for key in about.chain.typed} == about.chain.typed
        if isinstance(getattr(about, "seeds", None), tuple):
            assert found["seeds"] == list(about.seeds)
    check_forms(found)
    if hasattr(type(about), "verdict"):
        assert found["verdict"] == about.verdict


# tables

REFUSED = {"LindstedtSeries, residue": "of residues", "SeriesForAllN": "N"}


@pytest.mark.parametrize("name", [name for name in those_with("table") if name not in REFUSED])
def test_a_table_says_what_it_is_of_and_its_columns_are_on_the_page(name, tmp_path):
    kept = result(name)
    kind = type(kept).__name__
    table = kept.to_frame()
    assert len(table) > 0
    assert left_out(kind, table) == []
    assert len(set(table)) == len(list(table))
    assert table.attrs["result"] == kind
    assert table.attrs["symfpu_version"] == symfpu.__version__
    assert table.attrs["units"] == "dimensionless"
    if hasattr(kept, "chain"):
        assert table.attrs["chain"] == repr(kept.chain)
    if hasattr(kept, "to_xarray"):
        found = kept.to_xarray()
        assert left_out(kind, found.data_vars) == []
        assert all(re.search(rf"\b{axis}\b", row_of(kind)) for axis in found.dims)
        returns_from_netcdf(found, tmp_path / "file.nc")


@pytest.mark.parametrize("name", REFUSED)
def test_a_table_without_numbers_is_refused_by_name(name):
    with pytest.raises(InputError, match=REFUSED[name]):
        result(name).to_frame()


def row_of(name):
    """What the page says of a result."""
    (row,) = [line for line in TABLES.splitlines() if re.match(rf"\|[^|]*`{kind_of(name)}`", line)]
    return row


def left_out(name, columns):
    """Columns or variables that its row on the page, or one that it refers to, does not name."""
    rows = [row_of(other) for other in re.findall(r"`([A-Z]\w+)`", row_of(name).split("|", 2)[2]) if other != name]
    words = set(re.findall(r"\w+\*?", " ".join([row_of(name), *rows]).replace("**", "")))
    plain = {column: re.sub("_(real|imaginary)$", "", column) for column in columns}
    by_seed = {column: re.sub(r"_-?\d+$", "", base) for column, base in plain.items()}
    return [column for column, base in by_seed.items() if not {plain[column], base, f"{base}_*"} & words]


def returns_from_netcdf(found, path):
    xarray = pytest.importorskip("xarray")
    found.to_netcdf(path, engine="h5netcdf")
    with xarray.open_dataset(path, engine="h5netcdf") as read_back:
        xarray.testing.assert_equal(read_back.load(), found)
        assert {name: read_back[name].attrs for name in read_back.data_vars} == {name: found[name].attrs for name in found.data_vars}
        assert read_back.attrs.keys() == found.attrs.keys()
        for name, value in found.attrs.items():
            assert np.array_equal(read_back.attrs[name], value), name
    assert all(variable.attrs["units"] in ("dimensionless", "radians") for variable in found.data_vars.values())
    assert all(variable.dtype.kind in "fibUOT" for variable in found.data_vars.values())


# pictures

LARGEST_IMAGE = 60_000  # bytes
WITHOUT_PICTURE = {"LindstedtSeries, residue", "LindstedtSeries, symbolic", "LindstedtSeries, nested", "SeriesForAllN"}
CLASSES = {name: getattr(symfpu, kind_of(name), None) for name in CASES}
SHOWN = [name for name, kind in CLASSES.items() if isinstance(kind, type) and issubclass(kind, Result)]
WITH_PICTURE = [name for name in SHOWN if picture_of(CLASSES[name])]
DRAWN = [name for name in WITH_PICTURE if name not in WITHOUT_PICTURE]


def test_most_usual_results_have_a_picture():
    assert len({kind_of(name) for name in WITH_PICTURE}) >= 16


@pytest.mark.parametrize("name", DRAWN)
def test_a_result_draws_its_usual_picture_and_names_its_axes(name):
    ax = Figure().add_subplot()
    assert result(name).plot(ax) is ax
    assert ax.get_lines()
    assert ax.get_xlabel()
    names = [label.get_text() for label in ax.get_yticklabels()]
    assert ax.get_ylabel() or re.search("mode|[a-z]", "".join(names)), "numbers without a name"


@pytest.mark.long
@pytest.mark.parametrize("name", DRAWN)
def test_a_result_answers_in_html(name):
    page = read(result(name)._repr_html_())
    assert page.text.lstrip().startswith(f"{kind_of(name)}: ")
    (image,) = page.images
    content = base64.b64decode(image["src"].removeprefix("data:image/png;base64,"))
    assert content.startswith(b"\x89PNG")
    assert len(content) < LARGEST_IMAGE
    assert image["alt"].endswith(f"of this {kind_of(name)}")


@pytest.mark.parametrize("name", [name for name in SHOWN if name not in DRAWN])
def test_a_result_without_a_picture_still_answers(name):
    page = read(result(name)._repr_html_())
    assert page.text.lstrip().startswith(type(result(name)).__name__)
    assert not page.text.lstrip().partition("\n")[0].endswith(": ")
    assert page.images == []
    with pytest.raises(InputError, match=r"frequencies=|see symfpu\.plots"):
        result(name).plot(Figure().add_subplot())
