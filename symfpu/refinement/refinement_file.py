"""A refinement to many digits as a file, so that an interrupted one goes on.

Integers of many digits are kept as words of 32 bits, each exact in a double, the lowest first; the
last one has the sign.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.chain.projections.by_ends import count_columns
from symfpu.errors import InputError
from symfpu.files.archive import BundleError, Json
from symfpu.files.checkpoint import (
    ADVICE,
    TORUS_DIGITS,
    read_checkpoint,
    write_checkpoint,
)
from symfpu.numbers.typed import fraction_text
from symfpu.refinement.iterative_refinement import bit_length
from symfpu.refinement.kronecker import Integers
from symfpu.refinement.lattice import Ints

WORD = 32


class Checkpoint(NamedTuple):
    """harmonics (H, s); coefficients (H, C) and omega (s,) times 2^bits; digits; steps made."""

    harmonics: Ints
    coefficients: Integers
    omega: Integers
    bits: int
    digits: int
    steps: int


Save = Callable[[Checkpoint], None]


def no_checkpoint(reached: Checkpoint) -> None:
    """Of a run without a file."""


class RefinementFile:
    """The file of one run: of a chain, seeds, and what fixes their torus, by name."""

    def __init__(
        self,
        path: Path,
        chain: Chain,
        digits: int,
        seeds: tuple[int, ...],
        prescribed: Mapping[str, Sequence[Fraction] | None],
    ) -> None:
        self.path, self.chain = path, chain
        exact = {
            name: None if numbers is None else [fraction_text(x) for x in numbers]
            for name, numbers in prescribed.items()
        }
        self.parameters: Json = {
            **chain.typed,
            "seeds": list(seeds),
            **exact,
            "steps": digits,
        }

    def read(self) -> Checkpoint | None:
        """What the file holds, None where there is none; raises InputError and BundleError."""
        found = read_checkpoint(self.path, self.parameters, TORUS_DIGITS)
        if found is None:
            return None
        steps, arrays = found
        try:
            return self._reached(steps, arrays)
        except (KeyError, ValueError, OverflowError) as error:
            problem = f"is damaged ({type(error).__name__} {error})"
            raise BundleError(self.path, problem, ADVICE) from None

    def _reached(self, steps: int, arrays: dict[str, Any]) -> Checkpoint:
        harmonics = arrays["harmonics"].astype(np.int64)
        coefficients, omega = whole(arrays["coefficients"]), whole(arrays["omega"])
        shapes = harmonics.shape, coefficients.shape, omega.shape
        count, s = len(harmonics), len(self.parameters["seeds"])
        if shapes != ((count, s), (count, count_columns(self.chain)), (s,)):
            raise ValueError(f"arrays of the shapes {shapes}")
        bits, digits = (int(x) for x in arrays["bits and digits"])
        return Checkpoint(harmonics, coefficients, omega, bits, digits, steps)

    def write(self, reached: Checkpoint) -> None:
        """Replaces the file whole."""
        arrays = {
            "harmonics": reached.harmonics.astype(float),
            "coefficients": words(reached.coefficients),
            "omega": words(reached.omega),
            "bits and digits": np.array([reached.bits, reached.digits], dtype=float),
        }
        write_checkpoint(self.path, self.parameters, reached.steps, arrays, TORUS_DIGITS)


def words(values: Integers) -> NDArray[np.float64]:
    """Integers as doubles of WORD bits each, along a last axis."""
    count = bit_length(values) // WORD + 1
    parts = [(values >> (WORD * k)) & ((1 << WORD) - 1) for k in range(count - 1)]
    parts.append(values >> (WORD * (count - 1)))
    return np.stack([np.asarray(part, dtype=float) for part in parts], axis=-1)


def whole(table: NDArray[np.float64]) -> Integers:
    """The integers of such words; ValueError or OverflowError where they are none."""
    if not (np.isfinite(table).all() and np.all(table == np.floor(table))):
        raise ValueError("a word that is no integer")
    integers = np.asarray(np.frompyfunc(int, 1, 1)(table), dtype=object)
    total = 0 * integers[..., 0]
    for k in range(table.shape[-1]):
        total = total + (integers[..., k] << (WORD * k))
    return np.asarray(total, dtype=object)


def require_digits_beside(file: object, digits: int | None) -> None:
    """InputError for a file without digits."""
    if file is not None and digits is None:
        allowed = "nothing without digits: doubles take seconds"
        raise InputError("file", file, allowed, "leave it out, or give digits")
