"""Poincare-Lindstedt series of q-tori and q-breathers in Fermi-Pasta-Ulam chains, symbolic first.

The public names are those of __init__.pyi; each is loaded from its module when it is first used.
So is the room of pictures, symfpu.plots.
"""

import ast
import sys
from importlib import import_module
from typing import Any

__version__ = "0.1.0"


def _homes() -> dict[str, str]:
    """The module of every public name, as the stub beside this file imports it."""
    stub = __spec__.loader.get_data(
        f"{__path__[0]}/__init__.pyi"
    )  # wherever it is, an archive too
    imports = [line for line in ast.parse(stub).body if isinstance(line, ast.ImportFrom)]
    named = [line for line in imports if line.module != __name__]  # rooms are no names
    return {alias.name: str(line.module) for line in named for alias in line.names}


_HOMES = _homes()
__all__ = sorted([*_HOMES, "plots"])


def __getattr__(name: str) -> Any:
    if name == "plots":
        return import_module("symfpu.plots")
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOMES[name]), name)
    return value


def _load_pictures() -> None:
    """Makes known what `plot()` of results draws: pictures stand above all results."""
    import_module("symfpu.plots.usual")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


if (
    "IPython" in sys.modules
):  # a notebook shows terms as formulas; elsewhere importing does nothing
    from symfpu.notebook import init_printing

    init_printing()
