"""Files that verbs take, any saved solution, and files of another kind: one line says what opens those, and the code is 2."""

import json
import os

import numpy as np
import pytest

import symfpu
from symfpu import Chain, integrate, load, prove_existence, prove_propagation, save, sweep
from tests.cli.running import answer, refusal, shown
from tests.tolerances import COARSE_STEP_ERROR, NEWTON_RESIDUAL
from tests.tori.solutions import CASES

RUN = (Chain(4, beta=1), [0.1, 0, 0], [0, 0, 0], 10)


@pytest.fixture(scope="module")
def files(tmp_path_factory, threads):
    folder = tmp_path_factory.mktemp("files")
    prove_existence(symfpu.torus(Chain(3, alpha="0.3"), (1,), amplitudes={1: "0.1"})).write(folder / "proof")
    integrate(*RUN, step=0.125, file=folder / "checkpoint")
    save(folder / "orbit", integrate(*RUN, step=0.125))
    sweep(pow, [{"base": 2, "exp": 3}], executor=threads, file=folder / "sweep")
    np.savez(folder / "arrays.npz", x=np.zeros(3))
    (folder / "text").write_text("Q = 1")
    os.mkfifo(folder / "pipe")  # nobody writes it: opening it would wait for ever
    (folder / "other").write_text(json.dumps({"x": 1}))
    prove_propagation(6, (2, 3), 2, model="beta").write(folder / "altered")
    (folder / "altered").write_text((folder / "altered").read_text().replace('"residue": ', '"residue": 1', 1))
    return folder


OPENED = {
    "proof": "'symfpu existence certificate', no bundle; symfpu verify opens it",
    "sweep": "'symfpu sweep', no bundle; read_sweep reads it",
    "checkpoint": "is a checkpoint of an orbit, which holds no torus",
    "arrays.npz": "is not a symfpu bundle",
    "text": "is not a symfpu bundle",
    "other": "is not a symfpu bundle",
    "pipe": "pipe': allowed is a regular file",
}
LONG = ["--time", "1000"]
VERBS = {"show": [], "refine": [], "actions": [], "stability": [], "certify": [], "orbit": LONG, "gali": LONG, "frequencies": LONG}


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("kind", OPENED)
def test_what_is_no_bundle_says_what_it_is(verb, kind, files, capsys):
    err = refusal(capsys, verb, files / kind, *VERBS[verb])
    assert OPENED[kind] in err
    assert "damaged" not in err


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb != "show"])
def test_a_result_that_is_no_solution_says_what_it_is(verb, files, capsys):
    assert "it holds Orbit, which symfpu show opens" in refusal(capsys, verb, files / "orbit", *VERBS[verb])


OF_A_CERTIFICATE = {
    "checkpoint": "its format is 'ZIP archive': symfpu show opens those that symfpu.save wrote",
    "orbit": "its format is 'ZIP archive'",
    "sweep": "its format is 'symfpu sweep': read_sweep reads it",
    "text": "not JSON of plain strings",
    "other": "it names no format",
    "none": "No such file",
    "pipe": "pipe': allowed is a regular file",
    "altered": "the digest is not",
}


@pytest.mark.parametrize("kind", OF_A_CERTIFICATE)
def test_what_is_no_certificate_says_what_it_is(kind, files, capsys):
    assert OF_A_CERTIFICATE[kind] in refusal(capsys, "verify", files / kind)


@pytest.fixture(scope="module", params=CASES)
def saved(request, tmp_path_factory):
    """A file, and the solution in it."""
    solution = CASES[request.param]()
    return save(tmp_path_factory.mktemp("saved") / "solution.symfpu", solution), solution


def test_refine(capsys, saved, tmp_path):
    file, solution = saved
    found = answer(capsys, "refine", file, "-o", tmp_path / "refined.symfpu")
    assert found["residual"] < NEWTON_RESIDUAL
    assert load(tmp_path / "refined.symfpu").frequencies == solution.frequencies


def test_orbit(capsys, saved):
    file, _ = saved
    assert answer(capsys, "orbit", file, "--time", "10", "--step", "0.05")["largest_deviation"] < COARSE_STEP_ERROR


def test_gali(capsys, saved):
    file, solution = saved
    found = answer(capsys, "gali", file, "--time", "100", "--vectors", "2", "--samples", "64")
    assert found["seeds"] == list(solution.seeds)


def test_export(capsys, saved, tmp_path):
    file, _ = saved
    shown(capsys, "export", file, "--lang", "numpy", "-o", tmp_path / "mode", quiet=False)
    assert "def positions(" in (tmp_path / "mode.py").read_text()
