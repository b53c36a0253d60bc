"""Files of version 0.1 load and mean the same: tests/data/version-0.1, with its numbers in facts.json."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from symfpu.bundles.bundle import load
from symfpu.chain.chain import Chain
from symfpu.dynamics.alignment import alignment_indices
from symfpu.dynamics.orbits import integrate
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import text
from symfpu.proofs.check_propagation import verify
from symfpu.series.lindstedt import lindstedt
from tests.tolerances import AMPLITUDE, COEFFICIENT

DATA = Path(__file__).parents[1] / "data" / "version-0.1"
FACTS = json.loads((DATA / "facts.json").read_text())
ALPHA = Chain(8, alpha="0.33")
AT_REST = np.zeros(7)
ONE_MODE = np.array([0.3, 0, 0, 0, 0, 0, 0])


@pytest.mark.parametrize("name", ["doubles", "digits", "refined"])
def test_tori_are_those_that_were_saved(name):
    torus, facts = load(DATA / f"{name}.symfpu").torus, FACTS[f"{name}.symfpu"]
    amplitudes = {str(q): float(A) for q, A in torus.amplitudes.items()}
    assert amplitudes == {q: float(A) for q, A in facts["amplitudes"].items()}
    assert float(torus.energy()) == pytest.approx(float(facts["energy"]), rel=COEFFICIENT)
    positions = np.array(facts["Q1.5"], dtype=float)
    assert np.abs(torus.positions(1.5).astype(float) - positions).max() <= COEFFICIENT * np.abs(positions).max()


def test_digits_and_verdicts_are_kept():
    torus, facts = load(DATA / "digits.symfpu").torus, FACTS["digits.symfpu"]
    assert {str(q): text(A, 32) for q, A in torus.amplitudes.items()} == facts["text"]
    assert torus.certificate.certified
    assert load(DATA / "doubles.symfpu").verdict["verdict"]


def test_a_universal_series_keeps_its_formulas():
    assert str(load(DATA / "universal.symfpu").series.term(3, 2)) == FACTS["universal.symfpu"]["term"]


def test_a_program_whose_integers_have_one_type_is_read():
    """A file of schema 1, as it was before every array had the shortest integers."""
    kept = load(DATA.parent / "program-schema-1.symfpu").series
    made = lindstedt(kept.chain, kept.seeds, order=kept.order, ring="nested")
    tables = zip(kept.node_tables(), made.node_tables(), strict=True)
    assert all(np.array_equal(a.nodes, b.nodes) for a, b in tables)
    programs = [series.coordinates[0].program for series in (kept, made)]
    assert programs[0].symbols == programs[1].symbols
    parts = zip(*((program.start, *program.terms) for program in programs), strict=True)
    assert all(a.dtype == b.dtype == np.int64 and np.array_equal(a, b) for a, b in parts)


@pytest.mark.parametrize("name", ["alpha.json", "beta.json"])
def test_certificates_are_verified(name):
    checked = verify(DATA / name)
    assert checked
    body = json.loads((DATA / name).read_text())
    assert (body["verdict"], body["actual"]) == (FACTS[name]["verdict"], FACTS[name]["actual"])


def test_a_finished_orbit_is_taken_from_its_file(tmp_path):
    file = shutil.copy(DATA / "orbit.npz", tmp_path)
    orbit = integrate(ALPHA, ONE_MODE, AT_REST, 200.0, step=0.1, file=file)
    assert orbit.Q[-1].tolist() == [float(x) for x in FACTS["orbit.npz"]["last"]]


@pytest.fixture
def same_vectors(monkeypatch):
    """The frame that the file was begun with: another library of linear algebra rounds it otherwise."""
    vectors = tuple(np.load(DATA / "first_vectors.npy"))
    monkeypatch.setattr("symfpu.dynamics.alignment.random_frame", lambda count, n, seed: vectors)


@pytest.mark.usefixtures("same_vectors")
def test_finished_indices_are_taken_from_their_file(tmp_path):
    file = shutil.copy(DATA / "gali.npz", tmp_path)
    found = alignment_indices(ALPHA, ONE_MODE, AT_REST, 500.0, vectors=3, file=file, frames=1)
    assert found.times[-1] == 500.0
    assert found.log10_gali[-1, -1] == pytest.approx(float(FACTS["gali.npz"]["last"]), rel=AMPLITUDE)


@pytest.mark.usefixtures("same_vectors")
def test_indices_of_a_file_without_a_scheme_are_of_the_default(tmp_path):
    """Nor does it hold where its samples are: it is not gone on from to a longer time."""
    file = shutil.copy(DATA / "gali.npz", tmp_path)
    with pytest.raises(InputError, match=r"scheme is blanes_moan6 in it, kahan_li8 here"):
        alignment_indices(ALPHA, ONE_MODE, AT_REST, 500.0, vectors=3, scheme="kahan_li8", file=file, frames=1)
    with pytest.raises(InputError, match=r"of version 0\.1, and goes on to its own end only"):
        alignment_indices(ALPHA, ONE_MODE, AT_REST, 600.0, vectors=3, file=file, frames=1)
    named = alignment_indices(ALPHA, ONE_MODE, AT_REST, 500.0, vectors=3, scheme="blanes_moan6", file=file, frames=1)
    assert named.times[-1] == 500.0


def test_indices_from_a_machine_that_rounds_otherwise_are_refused(tmp_path, monkeypatch):
    vectors = np.nextafter(np.load(DATA / "first_vectors.npy"), 1)
    monkeypatch.setattr("symfpu.dynamics.alignment.random_frame", lambda count, n, seed: tuple(vectors))
    file = shutil.copy(DATA / "gali.npz", tmp_path)
    with pytest.raises(InputError, match=r"from a machine that rounds alike, as it is of version 0\.1 \(first vectors is"):
        alignment_indices(ALPHA, ONE_MODE, AT_REST, 500.0, vectors=3, file=file, frames=1)


def test_members_of_a_family_load():
    files = sorted((DATA / "family").glob("member-*.symfpu"))
    energies = [float(load(file).torus.energy()) for file in files]
    assert energies == pytest.approx([float(E) for E in FACTS["family"]["energies"]], rel=COEFFICIENT)
