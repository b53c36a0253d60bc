"""The table of doors in docs/chains.md: complete, and true of every chain."""

import inspect

import pytest

import symfpu
from symfpu.cli.verbs import VERBS
from tests.scripts import DOCS, loaded

doors = loaded("make_doors")
EVERY = {name: door for group in doors.DOORS.values() for name, door in group.items()}


def rows():
    """The table on the page: by door the answers, by chain."""
    section = (DOCS / "chains.md").read_text().partition(doors.BEGIN)[2].partition(doors.END)[0]
    cells = [[cell.strip().strip("`") for cell in line.strip("|").split("|")] for line in section.splitlines() if line.startswith("|")]
    return {name: dict(zip(doors.CHAINS, answers, strict=True)) for name, *answers in cells if name in EVERY}


def called(name):
    """The functions that a door's name names."""
    return {word.removesuffix(",") for word in name.split(" and ")[0].split() if "." not in word} | {name.split(" and ")[-1]}


def test_every_public_function_is_a_door_or_takes_no_chain():
    public = {name for name in symfpu.__all__ if inspect.isfunction(getattr(symfpu, name))}
    named = set().union(*map(called, EVERY))
    assert public - named == doors.OTHERS
    assert not doors.OTHERS & named


def test_every_verb_is_a_door():
    named = " ".join(name for name in EVERY if name.startswith("symfpu "))
    assert {verb for verb in VERBS if verb not in named} == {"reproduce", "workbench"}  # the paper's own chains; any that is typed


def test_the_page_has_every_door():
    assert rows().keys() == EVERY.keys()


@pytest.mark.long
@pytest.mark.parametrize("chain", doors.CHAINS)
def test_the_table_is_true(chain, tmp_path):
    """An answer is yes, or an InputError that names the chain; anything else comes up here."""
    case = doors.Case(tmp_path, **doors.CHAINS[chain])
    assert {name: doors.answer(door, case) for name, door in EVERY.items()} == {name: row[chain] for name, row in rows().items()}


def test_a_hole_is_no_answer(tmp_path):
    """Neither another error nor a refusal that names something else passes for an answer."""
    case = doors.Case(tmp_path, **doors.CHAINS["toda"])
    with pytest.raises(ZeroDivisionError):
        doors.answer(lambda c: 1 / 0, case)
    with pytest.raises(symfpu.InputError, match="seed"):
        doors.answer(lambda c: symfpu.torus(c.chain, (99,), frequencies=("0.4",)), case)
    assert doors.answer(lambda c: symfpu.breather_law(c.chain, 0.01), case) == "no"
