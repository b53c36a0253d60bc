"""Sliders: they go along what has tori, their numbers are as one would type them, and they are heard at once."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symfpu import Chain, InputError
from symfpu.workbench.choice import GIVEN, Choice
from symfpu.workbench.controls import Controls
from symfpu.workbench.ranges import energies, ranges, typed
from symfpu.workbench.solving import solved

LAWS = [{"alpha": "0.33"}, {"beta": "0.1"}, {"beta": "-1"}, {"potential": "toda:1"}, {"potential": "poly:0,0,1"}]


@settings(max_examples=12)
@given(st.integers(2, 64), st.sampled_from(LAWS), st.sampled_from(["fixed", "periodic"]), st.sampled_from(GIVEN), st.data())
def test_sliders_have_room_and_stand_on_a_step(N, law, ends, kind, data):
    if ends == "periodic" and N == 2:
        N = 3
    chain = Chain(N, **law, ends=ends)
    seeds = tuple(data.draw(st.sets(st.sampled_from(chain.mode_numbers), min_size=1, max_size=3)))
    for limits in ranges(chain, seeds, kind):
        assert limits.start <= limits.value <= limits.end
        assert 0 < limits.step <= (limits.end - limits.start) / 10
        assert float(typed(limits.value)) == limits.value
    least, largest = energies(chain, seeds)
    assert least < largest


@pytest.mark.long
@pytest.mark.parametrize("law", [{"alpha": "0.33"}, {"alpha": "0", "beta": "0.1"}, {"alpha": "0", "potential": "toda:1"}], ids=str)
@pytest.mark.parametrize("kind", GIVEN)
def test_where_sliders_stand_first_there_are_tori(law, kind):
    choice = Choice(**law, given=kind, order="4")
    values = tuple(typed(limits.value) for limits in ranges(choice.chain, choice.seed_modes, kind))
    _, largest = energies(choice.chain, choice.seed_modes)
    found = solved(choice.changed(values=values, energy=typed(10 ** (largest - 1.5))))
    assert min(found.torus.amplitudes.values()) > 0


def test_modes_that_are_none_are_refused():
    with pytest.raises(InputError):
        ranges(Chain(8, beta=1), (9,), "frequencies")


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:Widget.name:PendingDeprecationWarning")  # older Panels know no other word
def test_every_part_of_a_slider_is_heard_at_once():
    pytest.importorskip("panel")
    controls = Controls(Choice(given="energy"), lambda choice: None)
    for slider in (controls.order, *controls.sliders):
        waits = [part._debounce for part in slider.select() if hasattr(part, "_debounce")]
        assert waits
        assert not any(waits)
