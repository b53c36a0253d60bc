"""Programs as arrays and text that a file keeps, and back without executing anything."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.formulas import Coupling, Multiplier
from symfpu.algebra.program import Program, Terms
from symfpu.chain.length import label_entry, mode_label
from symfpu.errors import InputError
from symfpu.numbers.typed import fraction, fraction_text, integer

Array = NDArray[Any]
Json = dict[str, Any]
MOST = 2**40  # nodes, and terms
SHORT, LONG = "<i4", "<i8"


class Member(NamedTuple):
    """An array of a file: the type of its entries, and their number."""

    dtype: str
    length: int


def program_entries(program: Program) -> tuple[dict[str, Array], Json]:
    """Its arrays by name; its symbols as text, the lengths, and the integers' type."""
    terms = program.terms
    largest = max(program.size, len(terms.left), int(np.abs(terms.factor).max(initial=0)))
    dtype = SHORT if largest < 2**31 else LONG
    arrays = {"program_start": program.start.astype(dtype)}
    for name, values in zip(Terms._fields, terms, strict=True):
        arrays[f"program_{name}"] = values.astype(dtype)
    symbols = list(map(_symbol_entry, program.symbols))
    sizes = {"nodes": program.size, "terms": len(terms.left), "integers": dtype}
    return arrays, {"program": sizes | {"symbols": symbols}}


def program_members(body: Json) -> dict[str, Member]:
    """The types and lengths of the arrays by name. Raises ValueError."""
    layout = body["program"]
    dtype = layout["integers"]
    if dtype not in (SHORT, LONG):
        raise ValueError(f"no kind of integers: {dtype!r:.40}")
    nodes, terms = (
        integer(layout[name], name, least) for name, least in (("nodes", 1), ("terms", 0))
    )
    if max(nodes, terms) > MOST:
        raise ValueError(f"a program of {nodes} nodes and {terms} terms")
    members = {"program_start": Member(dtype, nodes + 1)}
    return members | {f"program_{name}": Member(dtype, terms) for name in Terms._fields}


def program_from(body: Json, members: Mapping[str, Array]) -> Program:
    """The program of these arrays. Raises ValueError where they are none."""
    symbols = [_symbol(entry) for entry in body["program"]["symbols"]]
    whole = {name: values.astype(np.int64) for name, values in members.items()}
    terms = Terms(*(whole[f"program_{name}"] for name in Terms._fields))
    return Program.of_arrays(symbols, whole["program_start"], terms)


def _symbol_entry(symbol: Any) -> list[Any]:
    if isinstance(symbol, Multiplier):
        return ["L", label_entry(symbol.mode), *symbol.harmonic]
    if isinstance(symbol, Coupling):
        return ["coupling", symbol.power, fraction_text(symbol.value)]
    if isinstance(symbol, str):
        return ["symbol", symbol]
    raise InputError(
        "result", f"{symbol!s:.40}", "multipliers and numbers in it", "compute it again"
    )


def _symbol(entry: Any) -> Any:
    kind, *parts = entry
    if kind == "L":
        mode, *harmonic = parts
        numbers = (integer(part, "symbol", -MOST) for part in harmonic)
        return Multiplier(mode_label(mode, "symbol"), tuple(numbers))
    if kind == "coupling":
        power, value = parts
        return Coupling(integer(power, "power", 2), fraction(value))
    if kind == "symbol":
        return str(parts[0])
    raise ValueError(f"no kind of symbol: {kind!r:.40}")
