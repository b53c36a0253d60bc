"""The coefficients of a series as rows of a table."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Ints
from symfpu.results.attributes import Attributes
from symfpu.results.table import Column, Table, by_seed

Array = NDArray[Any]

COORDINATE = "coordinate"
FREQUENCY, SQUARE = "frequency", "squared frequency"


class Part(NamedTuple):
    """Coefficients of prod A_i^power_i cos(nu.theta) in one order of one mode, without mu^k.

    quantity : whose they are. harmonics, powers : (count, s). values : (count,).
    """

    quantity: str
    order: int
    mode: Any
    harmonics: Ints
    powers: Ints
    values: Array


def harmonics_and_powers(exponents: Ints) -> tuple[Ints, Ints]:
    """nu and the powers of the amplitudes, from the exponents (count, 2s) of z and conj z."""
    plus, minus = exponents[:, 0::2], exponents[:, 1::2]
    return plus - minus, plus + minus


def of_amplitudes(values: Array, harmonics: Ints, degree: int) -> Array:
    """Coefficients of prod A^power cos(nu.theta), from those of z = (A/2) exp(i theta).

    A monomial stands for its conjugate too.
    """
    pairs = np.where((harmonics != 0).any(axis=1), 2, 1)
    if values.dtype == object:
        return np.asarray(values * pairs.astype(object) / 2**degree)
    return np.asarray(np.ldexp(values * pairs, -degree))


def of_frequency(
    order: int, mode: Any, exponents: Ints, values: Array, *, squared: bool = False
) -> Part:
    """Part of a frequency; exponents (count, s) are those of the amplitudes."""
    quantity = SQUARE if squared else FREQUENCY
    return Part(quantity, order, mode, np.zeros_like(exponents), exponents, values)


def coefficient_table(
    parts: Iterable[Part], seeds: Sequence[Any], attributes: Attributes
) -> Table:
    """All parts below each other."""
    found = list(parts)
    counts = [len(part.values) for part in found]
    columns: dict[str, Column] = {
        "quantity": np.repeat([part.quantity for part in found], counts),
        "order": np.repeat([part.order for part in found], counts),
        "mode": np.repeat([part.mode for part in found], counts),
    }
    columns |= by_seed("nu", seeds, np.concatenate([part.harmonics for part in found]))
    columns |= by_seed("power", seeds, np.concatenate([part.powers for part in found]))
    columns["value"] = np.concatenate([part.values for part in found])
    return Table(columns, attributes)
