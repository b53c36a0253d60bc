"""Files of another kind than a verb asks for: one line says what the file is and what opens it, and the code is 2."""

import json

import numpy as np
import pytest

from symfpu.breathers.balance import breather_at_amplitude
from symfpu.certified.existence import prove_existence
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.dynamics.orbits import integrate
from symfpu.saved.results import save
from symfpu.sweeps.sweep import sweep
from symfpu.sweeps.this_process import ThisProcess

RUN = (Chain(4, beta=1), [0.1, 0, 0], [0, 0, 0], 10)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    prove_existence(breather_at_amplitude(Chain(3, alpha="0.3"), 1, "0.1")).write(folder / "proof")
    integrate(*RUN, step=0.125, file=folder / "checkpoint")
    save(folder / "orbit", integrate(*RUN, step=0.125))
    sweep(pow, [{"base": 2, "exp": 3}], executor=ThisProcess(), file=folder / "sweep")
    np.savez(folder / "arrays.npz", x=np.zeros(3))
    (folder / "text").write_text("Q = 1")
    (folder / "other").write_text(json.dumps({"x": 1}))
    return folder


OPENED = {
    "proof": "'symfpu existence certificate', no bundle; symfpu verify opens it",
    "sweep": "'symfpu sweep', no bundle; read_sweep reads it",
    "checkpoint": "is a checkpoint of an orbit, which holds no torus",
    "arrays.npz": "is not a symfpu bundle",
    "text": "is not a symfpu bundle",
    "other": "is not a symfpu bundle",
}
LONG = ["--time", "1000"]
VERBS = {"show": [], "refine": [], "actions": [], "stability": [], "certify": [], "orbit": LONG, "gali": LONG, "frequencies": LONG}


def refusal(capsys, verb, file):
    assert main([verb, str(file), *VERBS.get(verb, [])]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert len(err.splitlines()) == 1
    assert "damaged" not in err
    return err


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("kind", OPENED)
def test_what_is_no_bundle_says_what_it_is(verb, kind, files, capsys):
    assert OPENED[kind] in refusal(capsys, verb, files / kind)


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb != "show"])
def test_a_result_that_is_no_solution_says_what_it_is(verb, files, capsys):
    assert "it holds Orbit, which symfpu show opens" in refusal(capsys, verb, files / "orbit")


OF_A_CERTIFICATE = {
    "checkpoint": "its format is 'ZIP archive': symfpu show opens those that symfpu.save wrote",
    "orbit": "its format is 'ZIP archive'",
    "sweep": "its format is 'symfpu sweep': read_sweep reads it",
    "text": "not JSON of plain strings",
    "other": "it names no format",
    "none": "No such file",
}


@pytest.mark.parametrize("kind", OF_A_CERTIFICATE)
def test_what_is_no_certificate_says_what_it_is(kind, files, capsys):
    assert OF_A_CERTIFICATE[kind] in refusal(capsys, "verify", files / kind)
