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
INTEGERS = "|i1", "<i2", "<i4", "<i8"


class Member(NamedTuple):
    """An array of a file: the type of its entries, and their number."""

    dtype: str
    length: int


def program_entries(program: Program) -> tuple[dict[str, Array], Json]:
    """Its arrays by name; its symbols as text, the lengths, and the integers' types by array."""
    terms = program.terms
    arrays = {"program_start": _narrowed(program.start)}
    for name, values in zip(Terms._fields, terms, strict=True):
        arrays[f"program_{name}"] = _narrowed(values)
    symbols = list(map(_symbol_entry, program.symbols))
    types = {name: values.dtype.str for name, values in arrays.items()}
    sizes = {"nodes": program.size, "terms": len(terms.left), "integers": types}
    return arrays, {"program": sizes | {"symbols": symbols}}


def _narrowed(values: Array) -> Array:
    """In the shortest integers that hold all values: there is less to read, check and inflate."""
    least, largest = int(values.min(initial=0)), int(values.max(initial=0))
    fits = (t for t in INTEGERS if np.iinfo(t).min <= least <= largest <= np.iinfo(t).max)
    return values.astype(next(fits))


def program_members(body: Json) -> dict[str, Member]:
    """The types and lengths of the arrays by name. Raises ValueError."""
    layout = body["program"]
    nodes, terms = (
        integer(layout[name], name, least) for name, least in (("nodes", 1), ("terms", 0))
    )
    if max(nodes, terms) > MOST:
        raise ValueError(f"a program of {nodes} nodes and {terms} terms")
    lengths = {"program_start": nodes + 1}
    lengths |= {f"program_{name}": terms for name in Terms._fields}
    types = layout["integers"]
    if not isinstance(types, dict):
        raise ValueError(f"no kind of integers for each array: {types!r:.40}")
    for dtype in types.values():
        if dtype not in INTEGERS:
            raise ValueError(f"no kind of integers: {dtype!r:.40}")
    return {name: Member(types[name], length) for name, length in lengths.items()}


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
        if any(type(n) is not int or abs(n) > MOST for n in harmonic):
            raise ValueError(f"no harmonic: {harmonic!r:.40}")
        label = mode if type(mode) is int and mode > 0 else mode_label(mode, "symbol")
        return Multiplier(label, tuple(harmonic))
    if kind == "coupling":
        power, value = parts
        return Coupling(integer(power, "power", 2), fraction(value))
    if kind == "symbol":
        return str(parts[0])
    raise ValueError(f"no kind of symbol: {kind!r:.40}")
