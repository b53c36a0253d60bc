"""A choice: its lines of Python and its command line make the torus that the page shows."""

import json
import shlex
from dataclasses import replace

import pytest

from symfpu import InputError
from symfpu.cli.main import main
from symfpu.workbench.choice import GIVEN, Choice
from symfpu.workbench.solving import judged, solved
from tests.tolerances import ROUNDING

SMALL = Choice(N="8", seeds="1", values=("0.3903",), order="4")
LONG = pytest.mark.long
CHOICES = [
    SMALL,
    pytest.param(SMALL.changed(given="amplitudes", values=("0.2",)), marks=LONG),
    pytest.param(SMALL.changed(given="energy", values=("1",), energy="0.001"), marks=LONG),
    pytest.param(SMALL.changed(seeds="2,1", values=("0.766", "0.3903")), marks=LONG),
    pytest.param(SMALL.changed(seeds="2,1", given="energy", values=("1", "0.5")), marks=LONG),
    pytest.param(SMALL.changed(potential="toda:1/3"), marks=LONG),
    pytest.param(SMALL.changed(alpha="0", beta="1/10"), marks=LONG),
    pytest.param(SMALL.changed(beta="0.1"), marks=LONG),
    pytest.param(SMALL.changed(ends="periodic", values=("0.766",)), marks=LONG),
    pytest.param(replace(SMALL.changed(ends="periodic", values=("0.766",)), refined=True), marks=LONG),
    pytest.param(SMALL.changed(N="2", alpha="0", beta="1", values=("1.5",)), marks=LONG),
    pytest.param(SMALL.changed(refined=True), marks=LONG),
]


def made(choice):
    """The names that the lines of Python make."""
    names = {}
    exec(choice.python(), names)
    return names


@pytest.mark.parametrize("choice", CHOICES, ids=repr)
def test_the_lines_of_python_make_the_same_torus(choice):
    names, found = made(choice), solved(choice)
    torus = names["refined"] if choice.refined else names["torus"]
    assert dict(torus.amplitudes) == dict(found.best.amplitudes)
    assert tuple(torus.frequencies) == tuple(found.best.frequencies)
    assert float(torus.energy()) == float(found.best.energy())
    assert names["verdict"].verdict == judged(found).verdict


@pytest.mark.parametrize("choice", CHOICES, ids=repr)
def test_the_command_line_makes_the_same_torus(choice, capsys):
    found = solved(choice)
    command = choice.command(dict(zip(found.torus.seeds, found.torus.frequencies, strict=True)))
    program, *words = shlex.split(command)
    assert program == "symfpu"
    assert main([*words, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    amplitudes = {int(q): float(a) for q, a in record["amplitudes"].items()}
    assert amplitudes == pytest.approx(dict(found.torus.amplitudes), rel=ROUNDING * 1e3)


def test_what_was_not_chosen_as_frequencies_has_no_command_line_before_it_is_found():
    assert SMALL.changed(given="amplitudes").command() == ""


@pytest.mark.parametrize(
    ("changes", "argument"),
    [
        ({"N": "many"}, "N"),
        ({"N": "1"}, "N"),
        ({"alpha": "x"}, "alpha"),
        ({"alpha": "0"}, "alpha, beta"),
        ({"potential": "todo:1"}, "potential"),
        ({"seeds": ""}, "seeds"),
        ({"seeds": "1,a"}, "seeds"),
        ({"seeds": "9"}, "seeds"),
        ({"order": "x"}, "order"),
        ({"values": ("0.39", "0.4")}, "frequencies"),
        ({"values": ('"); import os; ("',)}, "frequencies, seed 1"),
        ({"given": "energy", "energy": '1"'}, "energy"),
        ({"given": "amplitudes", "ends": "periodic"}, "given"),
        ({"given": "energy", "ends": "periodic"}, "given"),
    ],
    ids=str,
)
def test_what_is_wrong_is_named(changes, argument):
    choice = SMALL.changed(**changes)
    with pytest.raises(InputError) as caught:
        choice.python()
    assert caught.value.argument == argument


def test_a_change_leaves_file_and_newton_behind():
    choice = Choice(refined=True, bundle="a.symfpu").changed(order="4")
    assert (choice.refined, choice.bundle, choice.order) == (False, "", "4")


def test_what_a_file_holds_is_loaded_by_its_name():
    choice = Choice(bundle="/somewhere/two torus.symfpu", refined=True)
    assert 'load("two torus.symfpu")' in choice.python()
    assert "refine(torus)" in choice.python()
    assert shlex.split(choice.command()) == ["symfpu", "show", "two torus.symfpu"]


def test_every_kind_of_choice_has_its_lines():
    assert {SMALL.changed(given=given).python().count("torus = ") for given in GIVEN} == {1}
