"""`save` and `load` of every result: one file, one format, one way back."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np

from symfpu.bundles.bundle import Bundle, load_with, named_path, require_notes
from symfpu.bundles.bundle import save as save_solution
from symfpu.bundles.tree import OWN_FORMAT, value_of, write_tree
from symfpu.errors import InputError
from symfpu.files.archive import Archive, Json
from symfpu.numbers.public import public
from symfpu.results.result import Gridded, Tabled
from symfpu.saved.classes import CLASSES, is_result


@public
def save(
    path: Path | str,
    result: Any,
    *,
    verdict: Json | None = None,
    command: str | None = None,
    created: datetime | None = None,
) -> Path:
    """Write any result as one file; returns its path.

    path : of the file, which is written whole or not at all.
    result : a series, a torus with its series, any other solution, or any other result: families,
        orbits, alignment indices, multipliers, verdicts, sweeps, ...; with all its digits.
    verdict : any dictionary that JSON gives back unchanged. command : what made the result.
        created : default now.

    A solution is evaluated at a few times, which go into the file as test vectors. Dimensionless;
    the format is ours (docs/precision.md). Raises InputError for other arguments and for a file
    that cannot be written; an existing file stays as it was then.

    >>> import tempfile
    >>> from symfpu import Chain, integrate
    >>> orbit = integrate(Chain(N=4, beta=1), [0.1, 0, 0], [0, 0, 0], 100, step=0.125)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     load(save(f"{folder}/orbit.symfpu", orbit)).result
    Orbit(N=4, beta=1, T=100, kahan_li8, step 0.125, 129 samples, H=0.00293214917955,
    energy error ...)
    """
    if isinstance(result, OWN_FORMAT):
        notes: dict[str, Any] = {"verdict": verdict, "command": command}
        return save_solution(path, result, **notes, created=created)
    if not is_result(result):
        allowed = "a series, a solution or another result"
        raise InputError("result", type(result).__name__, allowed, _advice(result))
    file = named_path(path)
    require_notes(verdict, command, created)
    write_tree(file, result, CLASSES, verdict=verdict, command=command, created=created)
    return file


def _advice(result: object) -> str:
    """What to do with what is no result of those that are kept."""
    if isinstance(result, Bundle):
        return "pass what it holds, its .result"
    if hasattr(result, "certificate"):
        return "its certificate is kept by .write(path), and symfpu verify opens it"
    return "pass what symfpu computed"


@public
def load(path: Path | str) -> Bundle:
    """What `save` wrote, exactly as it was: `Bundle.result`. Executes nothing.

    path : of the file. Everything in it is dimensionless but for the date. The format is ours.

    Series and solutions are the `series` and the `torus` of the Bundle, too. Raises BundleError for
    a file that is damaged, foreign, newer than this symfpu or too large for the free memory;
    OSError for one that is missing or not to be read.

    >>> import tempfile
    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(N=8, beta="0.1"), (3,), ("1.12",), 2)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     kept = load(save(f"{folder}/breather", series))
    >>> all((a == b).all() for a, b in zip(kept.result.coordinates, series.coordinates))
    True
    """
    return load_with(path, _other_result)


def _other_result(archive: Archive, body: Json) -> Any:
    """The result of a document; ValueError and the like where it is none."""
    result = value_of(archive, body, CLASSES)
    if not is_result(result):
        raise ValueError(f"{type(result).__name__} is no result")
    _require_consistent(result)
    return result


def _require_consistent(result: Any) -> None:
    """ValueError where arrays do not fit together: its own table could not be made."""
    repr(result)
    if isinstance(result, Gridded):
        grid = result._grid()
        lengths = {name: len(np.asarray(labels)) for name, labels in grid.axes.items()}
        for name, variable in grid.variables.items():
            due = tuple(lengths[axis] for axis in variable.axes)
            if np.shape(variable.values) != due:
                raise ValueError(
                    f"{name} is of the shape {np.shape(variable.values)}, not {due}"
                )
    elif isinstance(result, Tabled):
        columns = {len(values) for values in result._table().columns.values()}
        if len(columns) > 1:
            raise ValueError(f"columns of the lengths {sorted(columns)} in one table")
