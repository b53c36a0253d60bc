"""A state of particles from a file: columns of text, or arrays of NumPy."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain, require_any_chain
from symfpu.dynamics.starts import State, particle_state
from symfpu.errors import InputError
from symfpu.files.writing import open_to_read
from symfpu.numbers.public import public

Floats = NDArray[np.float64]

NAMES = ("x", "p")  # of the columns and of the arrays
FORMATS = "two columns x and p of text, or an .npz with the arrays x and p"


@public
def read_state(chain: Chain, path: Path | str) -> State:
    """The state (Q, P) of particles in a file, as `particle_state` makes it.

    chain : the model, of any potential and ends. path : of a text file with one line for each
        particle that moves, x_1 .. x_(N-1) (on a ring x_0 .. x_(N-1)): its displacement and its
        momentum, with spaces, tabs or a comma between them; a first line `x,p` and what follows
        a # are left out. Or of a NumPy archive, `.npz`, with the arrays x and p. Dimensionless;
        the format is ours.

    Raises InputError for other files, naming the line, and OSError for one that is missing.

    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder, "state.csv")
    ...     _ = file.write_text("x,p\\n0.1,0\\n0,0\\n0,0.2\\n")
    ...     Q, P = read_state(Chain(N=4, alpha=1), file)
    >>> Q.shape
    (3,)
    """
    chain = require_any_chain(chain)
    file = Path(path)
    x, p = _arrays(file) if file.suffix == ".npz" else _columns(file)
    particles = chain.kind_of_ends.particles
    if {x.shape, p.shape} != {(particles,)}:
        given = f"{file} with {len(x)} and {len(p)} numbers"
        if x.ndim != 1 or p.ndim != 1:
            given = f"{file} with arrays of shapes {x.shape} and {p.shape}"
        allowed = f"a displacement and a momentum of each of {particles} particles"
        raise InputError("state", given, allowed, f"write one line for each: {FORMATS}")
    return particle_state(chain, x, p)


def _arrays(file: Path) -> tuple[Floats, Floats]:
    """Those of an archive of NumPy; nothing in it is executed."""
    with open_to_read(file, "state") as stream:
        content = io.BytesIO(stream.read())
    try:
        with np.load(content, allow_pickle=False) as archive:
            x, p = (np.asarray(archive[name], dtype=np.float64) for name in NAMES)
    except (KeyError, ValueError, TypeError, EOFError, zipfile.BadZipFile) as error:
        reason = " ".join(str(error).split())[:80]
        raise _refused(file, f"that is none ({reason})") from error
    return x, p


def _columns(file: Path) -> tuple[Floats, Floats]:
    try:
        with open_to_read(file, "state") as stream:
            lines = stream.read().decode("utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise _refused(file, "that is no text") from error
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(lines, start=1):
        cells = line.partition("#")[0].replace(",", " ").split()
        if not cells or (not rows and tuple(cells) == NAMES):
            continue
        rows.append(_row(file, number, cells))
    table = np.array(rows, dtype=np.float64).reshape(-1, len(NAMES))
    return table[:, 0], table[:, 1]


def _row(file: Path, number: int, cells: list[str]) -> tuple[float, float]:
    try:
        x, p = map(float, cells)
    except ValueError as error:
        raise _refused(file, f"whose line {number} is {' '.join(cells)[:60]!r}") from error
    return x, p


def _refused(file: Path, what: str) -> InputError:
    return InputError("state", f"{file} {what}", FORMATS, "see read_state")
