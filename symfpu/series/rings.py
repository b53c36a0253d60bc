"""The rings of a series in one list: each with its divisors and its tables.

A new ring is a file in symfpu/algebra with the methods of `Ring`, its divisors and its tables,
and one line here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.program_ring import ProgramRing
from symfpu.algebra.ring import Ring
from symfpu.algebra.selection import CosineModes, Modes
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.series.divisors import Divisors, Float64Divisors, UniversalDivisors
from symfpu.series.tables import DoubleTables, ExpressionTables, FixedPointTables, Tables

Frequencies = tuple[Fraction, ...] | None


@dataclass(frozen=True)
class RingKind:
    """A ring that series are made over.

    tables : of its coefficients, from digits and bits. ring, divisors : how they are made, from the
    modes of fixed ends (doubles: of a ring, too); None where that takes more than a name: residues
    want a point, fixed-point numbers their precision.
    numeric, exact_point : whether a series has frequencies, or a point where its residues were
        taken. program : whether it keeps coefficients as a program. grows : whether it is a
        GrowingRing.
    """

    name: str
    tables: Callable[[int | None, int], Tables]
    ring: Callable[[Any], Ring] | None = None
    divisors: Callable[[Chain, Any, Frequencies], Divisors] | None = None
    numeric: bool = False
    exact_point: bool = False
    program: bool = False
    grows: bool = False


def _double_divisors(chain: Chain, space: Modes, frequencies: Frequencies) -> Divisors:
    chosen = chosen_frequencies(frequencies, "float64")
    return Float64Divisors(chain, space, chosen)


def _universal_divisors(chain: Chain, space: CosineModes, _: Frequencies) -> Divisors:
    return UniversalDivisors(space)


FLOAT64 = RingKind(
    "float64", DoubleTables, Float64Ring, _double_divisors, numeric=True, grows=True
)
SYMBOLIC = RingKind(
    "symbolic",
    partial(ExpressionTables, expanded=True),
    partial(ProgramRing, expanded=True),
    _universal_divisors,
    program=True,
)
NESTED = RingKind(
    "nested",
    partial(ExpressionTables, expanded=False),
    partial(ProgramRing, expanded=False),
    _universal_divisors,
    program=True,
)
FIXED_POINT = RingKind("fixedpoint", FixedPointTables, numeric=True, grows=True)
RESIDUE = RingKind("residue", DoubleTables, exact_point=True, grows=True)

RINGS = {kind.name: kind for kind in (FLOAT64, SYMBOLIC, NESTED, FIXED_POINT, RESIDUE)}
# those that a series can be asked for by name
BY_NAME = tuple(name for name, kind in RINGS.items() if kind.ring)


def chosen_frequencies(frequencies: Frequencies, ring: str) -> tuple[Fraction, ...]:
    """The frequencies; InputError where there are none."""
    if frequencies is None:
        advice = "give frequencies=, or ring='symbolic'"
        raise InputError(
            "frequencies", None, f"one number for each seed in the {ring} ring", advice
        )
    return frequencies
