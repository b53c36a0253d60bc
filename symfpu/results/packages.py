"""The packages that tables need: an extra, imported when the first one is asked for."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from symfpu.errors import SymfpuError


def package(name: str) -> Any:
    """A package of the extra `data`. Raises SymfpuError where it is not installed."""
    try:
        return import_module(name)
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
        advice = "pip install 'symfpu[data]'"
        raise SymfpuError(f"{name} is not installed; {advice}") from error
