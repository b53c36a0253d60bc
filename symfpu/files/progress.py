"""What a long run tells while it works: one shape of callback for the whole package."""

from __future__ import annotations

import math
from collections.abc import Callable

Progress = Callable[[str, float], None]
"""Called as progress(label, fraction).

label : what is being done. fraction : of the work under this label that is done, 0 to 1, or
NO_FRACTION where it cannot be told.
"""

NO_FRACTION = math.nan


def unheard(label: str, fraction: float) -> None:
    """Progress that nobody hears of."""


def labelled(progress: Progress, before: str) -> Progress:
    """Progress whose labels begin with these words."""
    return lambda label, fraction: progress(f"{before}: {label}", fraction)
