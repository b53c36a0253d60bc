"""What every record has in common: its kind, the version that made it, no number JSON lacks."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from symfpu import __version__

Json = dict[str, Any]


def headed(record: Mapping[str, Any]) -> Json:
    """A record as every reader of JSON takes it: `kind` and `symfpu_version` first."""
    head = {"kind": None, "symfpu_version": __version__}
    found: Json = finite(head | dict(record))
    return found


def finite(value: Any) -> Any:
    """The same without NaN and Infinity, which JSON does not know: they are text.

    >>> finite({"residual": [0.5, float("inf")], "growth": float("nan")})
    {'residual': [0.5, 'inf'], 'growth': 'nan'}
    """
    if isinstance(value, Mapping):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value
