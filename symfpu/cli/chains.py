"""The chain on the command line: its options, and the chain that they name."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from symfpu.chain.chain import Chain
from symfpu.cli.choices import choice
from symfpu.cli.terminal import whole
from symfpu.errors import InputError
from symfpu.tori.torus import Torus

ENDS = ("fixed", "periodic")
BONDS = typer.Option(
    "-N", help="Number of bonds; the chain has N-1 moving particles.", metavar="N"
)

BondsOption = Annotated[str, BONDS]
BondsIfGiven = Annotated[str | None, BONDS]
AlphaOption = Annotated[str, typer.Option("--alpha", help="Cubic coupling.", metavar="X")]
BetaOption = Annotated[str, typer.Option("--beta", help="Quartic coupling.", metavar="X")]
PotentialOption = Annotated[
    str | None,
    typer.Option(
        "--potential",
        help="Any other law of a bond, such as toda:0.33, poly:0.33,0,1/5 or lj:12,6.",
        metavar="V",
    ),
]
EndsOption = Annotated[
    str,
    choice("--ends", ENDS, "Periodic: a ring of N particles, seeds such as --seeds=1,-3."),
]


def chain_of(
    bonds: str,
    alpha: str,
    beta: str,
    potential: str | None,
    ends: str = "fixed",
    *,
    symbolic: bool = False,
) -> Chain:
    """The chain that these options name; InputError for what is none.

    symbolic : whether -N N may leave its length open.
    """
    N = "N" if symbolic and bonds == "N" else whole("N", bonds)
    return Chain(N, alpha, beta, potential=potential, ends=ends)


def solution_of(result: Any, file: str) -> Torus:
    """The solution that a file holds; InputError, with what it holds, for another result."""
    if not isinstance(result, Torus):
        kind = type(result).__name__
        allowed = "a file with a torus or a breather in it"
        opened = f"it holds {kind}, which symfpu show opens"
        advice = f"{opened}; write one with symfpu solve -o"
        raise InputError("FILE", file, allowed, advice)
    return result
