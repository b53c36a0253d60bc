"""Every verb with --json prints one vocabulary: head, chain and seeds as everywhere, numbers in one form, keys of the page."""

import ast
import json
import re
from contextlib import redirect_stdout
from functools import cache
from io import StringIO
from pathlib import Path
from shlex import split

import pytest

import symfpu
from symfpu import saved_file
from symfpu.cli.main import main
from symfpu.cli.verbs import VERBS
from tests.cli.running import answer
from tests.test_results import check_forms

ROOT = Path(__file__).parents[2]
ROWS = re.findall(r"^\| ([^|]*) \|", (ROOT / "docs" / "records.md").read_text(), re.MULTILINE)
PAGE = {word for row in ROWS for word in re.findall(r"\w+", row)}
CHAIN = ["-N", "4", "--alpha", "0.3"]
TORUS = [*CHAIN, "--seeds", "1", "--energy", "0.001", "--order", "2"]
RULE = split("-N 6 --seeds 1,2 --order 2")
TODA = ["--potential", "toda:1/2"]
RING = split("-N 8 --beta 0.3 --ends periodic --seeds 1 --omega 0.77 --order 2")
BREATHER = ["solve", *CHAIN, "--seeds", "1", "--energy", "0.001"]
MADE = {"PROOF": ["prove", *RULE, "--model", "beta", "-o"], "TORUS": ["solve", *TORUS, "-o"], "ORBIT": [*BREATHER, "-o"]}
CASES = {
    "propagate": ["propagate", *RULE],
    "verify": ["verify", "PROOF"],
    "term": ["term", *CHAIN, "--seeds", "1", "-q", "2", "--order", "1"],
    "solve": ["solve", *TORUS],
}
LONG = {
    "prove": ["prove", *RULE, "--model", "beta"],
    "propagate, another potential": ["propagate", *RULE, *TODA],
    "propagate, a ring": ["propagate", *RULE, "--model", "alpha+beta", "--ends", "periodic"],
    "term, all N": ["term", "-N", "N", *TODA, "--seeds", "1,N-1", "-q", "2", "--order", "2"],
    "term, numbers": ["term", *CHAIN, "--seeds", "1", "-q", "2", "--order", "1", "--omega", "0.77", "--digits", "20"],
    "show": ["show", "TORUS"],
    "solve, a breather": BREATHER,
    "refine": ["refine", "TORUS"],
    "prove, another potential": ["prove", *RULE, *TODA],
    "sweep": split("sweep --longest 4 --order 2 --model beta"),
    "solve, a ring": ["solve", *RING],
    "solve, multipliers": [*BREATHER, "--multipliers"],
    "family": ["family", *CHAIN, "--seeds", "1", "--to-energy", "0.002", "--from-energy", "0.001"],
    "actions": ["actions", "TORUS"],
    "stability": ["stability", "ORBIT"],
    "certify": ["certify", "ORBIT"],
    "prove, all N": split("prove --all-N --model beta --seeds-number 1 --order 2"),
    "orbit": split("orbit TORUS --time 100 --samples 10"),
    "orbit, a state": ["orbit", *CHAIN, "--packet", "1", "--energy", "0.1", "--time", "100", "--samples", "10"],
    "frequencies": ["frequencies", *CHAIN, "--packet", "1", "--energy", "0.1", "--time", "200", "--step", "0.1"],
    "frequencies, a map": ["frequencies", *CHAIN, "--energies", "0.01,0.1", "--time", "200", "--step", "0.1"],
    "gali": split("gali TORUS --time 1000 --vectors 3"),
    "gali, estimate": split("gali TORUS --time 1000 --vectors 3 --estimate"),
    "atlas": split("atlas --beta 1 --lengths 4 --packets low:1 --order 4 --borders poles"),
    "reproduce": ["reproduce", "fig6", "-o", "out"],
}
EVERY = [*CASES, *(pytest.param(name, marks=pytest.mark.long) for name in LONG)]
LAWS = ({"alpha", "beta"}, {"model"}, {"potential"})


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The file that stands for a word, made once; other words as they are."""
    folder = tmp_path_factory.mktemp("made")

    @cache
    def path_of(word):
        if word not in MADE:
            return word
        with redirect_stdout(StringIO()):
            assert main([*MADE[word], str(folder / word)]) == 0
        return str(next(folder.glob(f"{word}*")))

    return path_of


def test_every_verb_with_json_is_here():
    """Read from the source: to import every verb takes seconds."""
    parsed = [ast.parse((ROOT / "symfpu" / "cli" / f"{module}.py").read_text()) for module in {verb.module for verb in VERBS.values()}]
    functions = [node for tree in parsed for node in tree.body if isinstance(node, ast.FunctionDef) and node.decorator_list]
    with_json = {verb_of(node) for node in functions if any("JsonOption" in ast.unparse(one) for one in node.args.args if one.annotation)}
    assert with_json == {words[0] for words in (CASES | LONG).values()}


def verb_of(function):
    named = [one.value for call in function.decorator_list for one in call.args]
    return named[0] if named else function.name


KEPT = {"solve": "-o", "refine": "-o", "family": "--save", "orbit": "--save", "gali": "--save", "sweep": "--save"}
OF_THE_RUN = {"seconds", "assessment", "verdict", "warnings"}  # clocks; what the verb judges or doubts besides


@pytest.mark.parametrize("name", EVERY)
def test_every_verb_has_the_same_keys_and_number_forms(name, made, capsys, tmp_path, monkeypatch):
    """Of those that keep a result, also the keys and numbers of its record."""
    words = [*map(made, (CASES | LONG)[name])]
    monkeypatch.chdir(tmp_path)
    found = answer(capsys, *words, *([KEPT[name], "kept.symfpu"] if name in KEPT else []), quiet=False)
    assert list(found)[:2] == ["kind", "symfpu_version"]
    assert found["symfpu_version"] == symfpu.__version__
    assert found["kind"] == words[0] or hasattr(symfpu, found["kind"])
    assert set(found) - PAGE == set()
    if "N" in found or "model" in found:
        assert sum(law <= set(found) for law in LAWS) == 1
    assert "ends" not in found or found["ends"] == "periodic"
    if "seeds" in found:
        assert isinstance(found["seeds"], list)
        for key in ("frequencies", "amplitudes", "actions"):
            assert list(found.get(key) or map(str, found["seeds"])) == list(map(str, found["seeds"]))
    check_forms(found)
    for part in found.get("figures", {}).values():
        assert list(part) == ["kind", "title", "remarks", "claims", "panels", "numbers"]
    if name in KEPT:
        held = saved_file("kept.symfpu")
        assert held.provenance["command"].startswith(f"symfpu {name} ")
        kept = held.result.record()
        assert {key: found[key] for key in kept if key not in OF_THE_RUN} == {key: kept[key] for key in kept if key not in OF_THE_RUN}


@pytest.mark.parametrize("name", EVERY)
def test_without_json_a_verb_prints_lines_for_a_reader(name, made, capsys, tmp_path, monkeypatch):
    words = [*map(made, (CASES | LONG)[name])]
    monkeypatch.chdir(tmp_path)
    assert main(words) == 0
    shown = capsys.readouterr().out
    assert shown.strip()
    with pytest.raises(json.JSONDecodeError):
        json.loads(shown)


@pytest.mark.long
def test_verify_says_what_prove_said(made, capsys):
    proved = answer(capsys, "prove", *RULE, "--model", "beta")
    verified = answer(capsys, "verify", made("PROOF"))
    reason = proved.pop("reason")  # of the prover: the checker has its own route
    assert reason
    assert {key: verified[key] for key in proved} == proved
    assert verified["valid"] is True
