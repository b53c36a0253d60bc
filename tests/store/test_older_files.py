"""Files of formats before the one that is written are refused by every reader, in one line that says what to do."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import symfpu
from symfpu import BundleError, Chain, alignment_indices, family, integrate, lindstedt, load, refine, save, solve_amplitudes
from symfpu.checkers.propagation import verify
from symfpu.files.archive import SCHEMA
from tests.cli.running import run
from tests.store.test_damage import forged

DATA = Path(__file__).parents[1] / "data" / "version-0.1"
ALPHA = Chain(8, alpha="0.33")
AT_REST = np.zeros(7)
ONE_MODE = np.array([0.3, 0, 0, 0, 0, 0, 0])
OLDER = rf"is of an older format \(schema \d; this symfpu reads {SCHEMA}\); compute it again, and write another file$"


def orbit_in(file):
    return integrate(ALPHA, ONE_MODE, AT_REST, 20.0, step=0.1, file=file)


def indices_in(file):
    return alignment_indices(ALPHA, ONE_MODE, AT_REST, 200.0, vectors=2, file=file, frames=1)


def digits_in(file):
    return refine(solve_amplitudes(lindstedt(ALPHA, (1,), ("0.3905",), 4)), digits=20, file=file)


def series_in(file):
    return load(file) if file.exists() else save(file, lindstedt(ALPHA, (1,), order=2))


def result_in(file):
    return load(file) if file.exists() else save(file, symfpu.floquet(symfpu.torus(ALPHA, (1,), frequencies=("0.3905",))))


@pytest.mark.parametrize("reader", [orbit_in, indices_in, digits_in, series_in, result_in])
def test_every_reader_refuses_an_older_schema(reader, tmp_path):
    file = tmp_path / "kept"
    reader(file)
    reader(file)
    for schema in (1, SCHEMA - 1):
        forged(file, lambda members, body, schema=schema: body.update(schema=schema))
        content = file.read_bytes()
        with pytest.raises(BundleError, match=OLDER) as caught:
            reader(file)
        assert "\n" not in str(caught.value)
        assert file.read_bytes() == content


@pytest.mark.parametrize(
    ("name", "reader"),
    [("doubles.symfpu", load), ("universal.symfpu", load), ("orbit.npz", orbit_in), ("gali.npz", indices_in)],
)
def test_files_as_they_were_before_the_first_release_are_refused(name, reader, tmp_path):
    with pytest.raises(BundleError, match=OLDER):
        reader(Path(shutil.copy(DATA / name, tmp_path)))


def test_a_member_of_an_older_family_is_refused(tmp_path):
    """Beside a record of today: tests/families/test_folder.py has the record of an older one."""
    family(ALPHA, (1,), "0.0002", from_energy="0.0001", folder=tmp_path)
    shutil.copy(DATA / "family" / "member-0000.symfpu", tmp_path)
    with pytest.raises(BundleError, match=OLDER):
        family(ALPHA, (1,), "0.0002", from_energy="0.0001", folder=tmp_path)


def test_the_command_line_says_it_in_one_line(capsys):
    code, _, told = run(capsys, "show", DATA / "doubles.symfpu")
    assert code == 2
    assert "is of an older format" in told
    assert "Traceback" not in told


@pytest.mark.parametrize("name", ["alpha.json", "beta.json"])
def test_certificates_have_the_same_format_and_are_verified(name):
    assert verify(DATA / name)
