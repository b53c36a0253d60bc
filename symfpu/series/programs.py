"""Programs as arrays and text that a file keeps, and back without executing anything."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from symfpu.algebra.formulas import Coupling, Multiplier
from symfpu.algebra.program import Program, Terms
from symfpu.errors import InputError
from symfpu.numbers.typed import fraction, fraction_text, integer

Array = NDArray[Any]
Json = dict[str, Any]
MOST = 2**40  # nodes, and terms


def program_entries(program: Program) -> tuple[dict[str, Array], Json]:
    """Its arrays by name; its symbols as text, and the lengths."""
    terms = program.terms
    arrays = {"program_start": program.start}
    for name, values in zip(Terms._fields, terms, strict=True):
        arrays[f"program_{name}"] = values
    symbols = list(map(_symbol_entry, program.symbols))
    layout = {"nodes": program.size, "terms": len(terms.left), "symbols": symbols}
    return arrays, {"program": layout}


def program_lengths(body: Json) -> dict[str, int]:
    """The lengths of the arrays by name. Raises ValueError."""
    layout = body["program"]
    nodes, terms = (
        integer(layout[name], name, least) for name, least in (("nodes", 1), ("terms", 0))
    )
    if max(nodes, terms) > MOST:
        raise ValueError(f"a program of {nodes} nodes and {terms} terms")
    lengths = {"program_start": nodes + 1}
    return lengths | {f"program_{name}": terms for name in Terms._fields}


def program_from(body: Json, members: Mapping[str, Array]) -> Program:
    """The program of these arrays. Raises ValueError where they are none."""
    symbols = [_symbol(entry) for entry in body["program"]["symbols"]]
    terms = Terms(*(members[f"program_{name}"] for name in Terms._fields))
    return Program.of_arrays(symbols, members["program_start"], terms)


def _symbol_entry(symbol: Any) -> list[Any]:
    if isinstance(symbol, Multiplier):
        return ["L", symbol.mode, *symbol.harmonic]
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
        mode, *harmonic = (integer(part, "symbol", -MOST) for part in parts)
        return Multiplier(mode, tuple(harmonic))
    if kind == "coupling":
        power, value = parts
        return Coupling(integer(power, "power", 2), fraction(value))
    if kind == "symbol":
        return str(parts[0])
    raise ValueError(f"no kind of symbol: {kind!r:.40}")
