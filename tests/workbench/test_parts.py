"""What the page shows of a choice: every picture where the package has one, a reason elsewhere."""

from dataclasses import replace

import pytest

from symfpu.workbench.choice import Choice
from symfpu.workbench.parts import PICTURES, RESIDUALS, Bench, Numbers, Picture, Problem, Verdict

pytestmark = pytest.mark.long
RING = Choice(N="8", ends="periodic", seeds="1", values=("0.7656",), order="4")
TWO = RING.changed(N="9", seeds="1,-2", values=("0.6845", "1.2862"))
RINGS = (RING, replace(RING, refined=True), TWO, replace(TWO, refined=True))
PARTS = [Numbers, Picture, Verdict, Picture, Picture, Picture, Picture]


@pytest.mark.parametrize("choice", RINGS, ids=repr)
def test_of_a_ring_everything_is_shown(choice):
    bench = Bench()
    parts = list(bench.parts(choice))
    assert [type(part) for part in parts] == PARTS
    pictures = {part.name: part for part in parts if isinstance(part, Picture)}
    assert {name: picture.problem for name, picture in pictures.items()} == dict.fromkeys(PICTURES, "")
    assert isinstance(bench.file(choice, "c"), Problem)
    assert bench.file(choice).name == "torus.symfpu"


@pytest.mark.parametrize(("refined", "left_out"), [(False, set()), (True, {RESIDUALS})])
def test_of_a_ring_from_a_file_what_needs_a_series_is_shown_or_says_so(refined, left_out, tmp_path):
    file = tmp_path / "ring.symfpu"
    file.write_bytes(Bench().file(replace(RING, refined=refined)).content)
    numbers, *others = Bench().parts(Choice(bundle=str(file)))
    assert (numbers.choice.seeds, numbers.choice.ends) == ("1", "periodic")
    assert {part.name for part in others if isinstance(part, Picture) and part.problem} == left_out


def test_what_was_prepared_changes_no_picture():
    choice = Choice(N="8", values=("0.3903", "0.7657"), order="4")
    bench = Bench()
    plain = list(bench.parts(choice))
    bench.prepare()
    assert list(bench.parts(choice)) == plain
