"""Every public result comes back from its file as it was; what is damaged, forged or foreign is refused."""

import json
import tomllib
import zipfile
from pathlib import Path

import numpy as np
import pytest

import symfpu
from symfpu.breathers.balance import breather_at_amplitude
from symfpu.bundles.tree import OWN_FORMAT
from symfpu.certified.existence import prove_existence
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.dynamics.orbits import integrate
from symfpu.errors import InputError
from symfpu.files.archive import BundleError, digest_of, write_archive
from symfpu.proofs.sweeps import Sweep, SweepCase
from symfpu.saved.classes import CLASSES, PARTS, RESULTS
from symfpu.saved.results import load, save
from tests.bundles.test_bundle import same
from tests.test_pickle import RESULTS as CASES
from tests.test_pickle import public_classes

ROOT = Path(symfpu.__file__).parent.parent
WITHOUT = {
    "AtlasBorder": "made of the rows of Atlas",
    "Bundle": "what a file held",
    "Chain": "an argument",
    "Evaluator": "a program",
    "ExistenceProof": "its certificate is its file",
    "ExpandableTerm": "an expression",
    "NamedParts": "an expression",
    "BirkhoffForm": "exact numbers of a field, made anew",
    "NormalFrequencies": "part of Member",
    "NormalFrequencySeries": "a series, made anew",
    "NormalMode": "part of NormalModes",
    "ParametricResonance": "part of NormalModes",
    "StabilityProof": "its certificate is its file",
    "ResidualProof": "its certificate is its file",
    "StayProof": "its certificate is its file",
    "SpectralLine": "part of FrequencyAnalysis",
    "TwistAtRest": "exact numbers of a field, made anew",
}
QUICK = {"QTorus", "Event", "Sweep", "ProfileLine", "ProfileDistance", "PropagationProof", "RuleForAllN", "Recurrence", "ShotOrbit"}
QUICK |= {"Atlas", "BorderLaw"}
SAVED = [name for name in CASES if name.partition(",")[0] in public_classes() - set(WITHOUT)]


def test_every_public_result_is_saved_or_has_a_reason():
    kept = (*(CLASSES[name] for name in RESULTS), *OWN_FORMAT)
    assert {name for name in public_classes() if not issubclass(getattr(symfpu, name), kept)} == set(WITHOUT)


def test_the_list_has_no_class_that_is_not_needed():
    assert len(CLASSES) == len(RESULTS) + len(PARTS)
    assert set(RESULTS) <= public_classes()


def test_a_class_is_named_with_the_module_that_defines_it():
    assert {name: kind.__module__ for name, kind in CLASSES.items()} == {**RESULTS, **PARTS}
    assert all(kind.__name__ == name for name, kind in CLASSES.items())


def test_the_modules_of_the_classes_are_of_floors_below():
    """They are named as text, which the contract of imports does not see."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    floors = [layer.split(" | ") for layer in contracts[0]["layers"]]
    own = next(number for number, rooms in enumerate(floors) if "saved" in rooms)
    below = {room for rooms in floors[own + 1 :] for room in rooms}
    assert {module.split(".")[1] for module in (*RESULTS.values(), *PARTS.values())} <= below


@pytest.mark.parametrize("name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.long) for name in SAVED])
def test_results_come_back_as_they_were(name, tmp_path, capsys):
    make, answers = CASES[name]
    result = make(tmp_path)
    file = save(tmp_path / "result.symfpu", result, verdict={"verdict": "good"}, command="a command")
    found = load(file)
    assert type(found.result) is type(result)
    assert same(found.result, result)
    assert repr(found.result) == repr(result)
    assert same(answers(found.result), answers(result))
    assert (found.verdict, found.provenance["command"]) == ({"verdict": "good"}, "a command")
    assert main(["show", str(file)]) == 0
    assert "created" in capsys.readouterr().out
    assert main(["show", str(file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["kind"] == type(result).__name__


SWEEP = Sweep("beta", 1, (SweepCase(4, (1, 2), "refuted", ((3, 1, None),), True),))


@pytest.fixture(scope="module")
def orbit():
    chain = Chain(4, potential="toda:1/2", ends="periodic")
    Q = chain.modes([0.1, 0.0, -0.1, 0.0])
    return integrate(chain, Q, 0 * Q, 1.0, step=0.25, averages=True)


@pytest.fixture
def file(orbit, tmp_path):
    return save(tmp_path / "orbit.symfpu", orbit)


def test_complex_modes_of_a_ring_and_its_scheme_come_back(orbit, file):
    found = load(file).result
    assert same(found, orbit)
    assert found.scheme is orbit.scheme
    assert "Orbit(N=4, potential=toda(0.5), ends='periodic'" in repr(load(file))


def contents(file):
    with zipfile.ZipFile(file) as archive:
        return json.loads(archive.read("bundle.json")), {
            n.removesuffix(".npy"): archive.read(n) for n in archive.namelist() if n.endswith(".npy")
        }


def forged(file, change):
    """The file with another document, whose digest is right."""
    body, members = contents(file)
    body.pop("digest")
    change(body)
    arrays = {}
    for name, raw in members.items():
        flat = np.frombuffer(raw[raw.index(b"\n") + 1 :], dtype=np.uint8)
        arrays[name] = flat.view("<c16" if b"<c16" in raw[:80] else "<f8")
    write_archive(file, body | {"digest": digest_of(body)}, arrays)
    return file


def test_a_file_that_is_written_again_is_the_same(orbit, file):
    assert same(load(forged(file, lambda body: None)).result, orbit)


def field(name, node):
    def change(body):
        body["result"]["root"]["fields"][name] = node

    return change


def of_root(**changes):
    return lambda body: body["result"]["root"].update(changes)


FORGERIES = {
    "another class": of_root(**{"class": "Path"}),
    "a class that is no result": of_root(**{"class": "Edges", "fields": {}}),
    "a part for the whole": of_root(**{"class": "SweepCase"}),
    "a field too many": field("nothing", 1),
    "a field of another type": field("step", "0.25"),
    "a chain of the other ends": field("chain", {"chain": {"N": 4, "potential": "toda:1/2"}, "ends": "periodic"}),
    "an unknown scheme": field("scheme", {"scheme": "euler"}),
    "times of another length": field("energies", {"objects": [], "shape": [0]}),
    "an array that is not there": field("Q", {"array": "array99", "dtype": "<c16", "shape": [5, 3]}),
    "an array of objects": field("Q", {"array": "array1", "dtype": "|O", "shape": [5, 3]}),
    "an array of a negative shape": field("Q", {"array": "array1", "dtype": "<c16", "shape": [-5, -3]}),
    "a part that is not there": field("Q", {"part": 0}),
    "an unknown node": field("Q", {"eval": "1"}),
    "an empty node": field("Q", {}),
    "no parts": lambda body: body["result"].pop("parts"),
}


@pytest.mark.parametrize("case", FORGERIES)
def test_forgeries_are_refused(case, file):
    with pytest.raises(BundleError, match="is damaged"):
        load(forged(file, FORGERIES[case]))


def test_a_newer_file_is_named(file):
    with pytest.raises(BundleError, match="newer symfpu"):
        load(forged(file, lambda body: body.update(schema=99)))


def test_every_flipped_byte_is_seen(orbit, file):
    """Or changes nothing: the date of a member, say."""
    raw = file.read_bytes()
    for place in range(0, len(raw), 97):
        file.write_bytes(raw[:place] + bytes([raw[place] ^ 0x55]) + raw[place + 1 :])
        try:
            assert same(load(file).result, orbit)
        except BundleError:
            continue


def test_a_cut_file_is_refused(file):
    raw = file.read_bytes()
    for length in (0, 3, 4, 100, len(raw) // 2, len(raw) - 1):
        file.write_bytes(raw[:length])
        with pytest.raises(BundleError):
            load(file)


@pytest.mark.parametrize("thing", [1, "torus", None, Chain(4, alpha=1), [SWEEP], SWEEP.cases[0]])
def test_what_is_no_result_is_refused(thing, tmp_path):
    with pytest.raises(InputError, match="a series, a solution or another result"):
        save(tmp_path / "file", thing)
    assert not (tmp_path / "file").exists()


@pytest.mark.parametrize("notes", [{"verdict": 3}, {"command": 3}, {"created": "today"}])
def test_notes_are_checked(notes, tmp_path):
    with pytest.raises(InputError, match=next(iter(notes))):
        save(tmp_path / "file", SWEEP, **notes)
    with pytest.raises(InputError, match="path"):
        save(3, SWEEP)


def test_other_verbs_name_what_they_need(file, capsys):
    assert main(["refine", str(file)]) == 2
    assert "a file with a torus or a breather in it" in capsys.readouterr().err


def test_a_proof_with_a_certificate_says_how_it_is_kept(tmp_path):
    proof = prove_existence(breather_at_amplitude(Chain(3, alpha="0.3"), 1, "0.1"))
    with pytest.raises(InputError, match=r"its certificate is kept by .write\(path\), and symfpu verify opens it"):
        save(tmp_path / "proof", proof)


def test_a_bundle_says_what_of_it_is_kept(tmp_path):
    bundle = load(save(tmp_path / "breather", breather_at_amplitude(Chain(3, alpha="0.3"), 1, "0.1")))
    with pytest.raises(InputError, match=r"pass what it holds, its \.result"):
        save(tmp_path / "again", bundle)
