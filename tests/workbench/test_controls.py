"""The widgets of the page: sliders are heard at once."""

import pytest

from symfpu.workbench.choice import Choice
from symfpu.workbench.controls import Controls


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:Widget.name:PendingDeprecationWarning")  # older Panels know no other word
def test_every_part_of_a_slider_is_heard_at_once():
    pytest.importorskip("panel")
    controls = Controls(Choice(given="energy"), lambda choice: None)
    for slider in (controls.order, *controls.sliders):
        waits = [part._debounce for part in slider.select() if hasattr(part, "_debounce")]
        assert waits
        assert not any(waits)
