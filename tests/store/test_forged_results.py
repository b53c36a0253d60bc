"""Files of results: what is damaged, forged or foreign is refused. That every result comes back: tests/test_results.py."""

import pytest

import symfpu
from symfpu import BundleError, Chain, InputError, integrate, load, prove_existence, save, saved_file
from symfpu.results.result import Result
from symfpu.store.tree import _with_subclasses, class_name
from tests.every_result import result
from tests.store.test_damage import forged
from tests.store.test_saved_file import same


@pytest.fixture(scope="module")
def orbit():
    chain = Chain(4, potential="toda:1/2", ends="periodic")
    Q = chain.modes([0.1, 0.0, -0.1, 0.0])
    return integrate(chain, Q, 0 * Q, 1.0, step=0.25, averages=True)


@pytest.fixture
def file(orbit, tmp_path):
    return save(tmp_path / "orbit.symfpu", orbit)


def test_complex_modes_of_a_ring_and_its_scheme_come_back(orbit, file):
    found = load(file)
    assert same(found, orbit)
    assert found.scheme is orbit.scheme
    assert "Orbit(N=4, potential=toda(0.5), ends='periodic'" in repr(found)


def field(name, node):
    def change(members, body):
        body["result"]["fields"][name] = node

    return change


def of_root(**changes):
    return lambda members, body: body["result"].update(changes)


FORGERIES = {
    "another class": of_root(**{"class": "pathlib:Path"}),
    "a class of nobody": of_root(**{"class": "Nothing"}),
    "a name with a module of ours": of_root(**{"class": "symfpu.dynamics.orbits:Orbit"}),
    "a public function": of_root(**{"class": "integrate"}),
    "an argument": of_root(**{"class": "Chain"}),
    "a class that is no result": of_root(**{"class": "Edges", "fields": {}}),
    "a part for the whole": of_root(**{"class": "SweepCase"}),
    "a result that has no file": of_root(**{"class": "SavedFile"}),
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
    "no parts": lambda members, body: body.pop("parts"),
}


def test_a_name_in_a_file_is_of_one_class():
    """Among results, and among origins of tori: files have their names alone."""
    for name in symfpu.__all__:
        getattr(symfpu, name)
    for base in (Result, symfpu.Origin):
        names = [class_name(kind) for kind in _with_subclasses(base)]
        assert len(names) == len(set(names))
        assert len(names) > 5


@pytest.mark.parametrize("case", FORGERIES)
def test_forgeries_are_refused(case, file):
    with pytest.raises(BundleError, match="is damaged"):
        load(forged(file, FORGERIES[case]))


@pytest.mark.parametrize("thing", [1, "torus", None, Chain(4, alpha=1), [result("Sweep")], result("Sweep").cases[0]])
def test_what_is_no_result_is_refused(thing, tmp_path):
    with pytest.raises(InputError, match="a result that symfpu computed"):
        save(tmp_path / "file", thing)
    assert not (tmp_path / "file").exists()


def test_a_proof_with_a_certificate_says_how_it_is_kept(tmp_path):
    proof = prove_existence(symfpu.torus(Chain(3, alpha="0.3"), (1,), amplitudes={1: "0.1"}))
    with pytest.raises(InputError, match=r"its certificate is kept by .write\(path\), and symfpu verify opens it"):
        save(tmp_path / "proof", proof)


def test_what_a_file_held_says_what_of_it_is_kept(tmp_path):
    held = saved_file(save(tmp_path / "breather", symfpu.torus(Chain(3, alpha="0.3"), (1,), amplitudes={1: "0.1"})))
    with pytest.raises(InputError, match=r"pass what it holds, its \.result"):
        save(tmp_path / "again", held)
