"""Where an orbit starts: on a saved torus, or in a state of the user's own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import typer

from symfpu.chain.chain import Chain
from symfpu.cli.chains import ENDS, chain_of, solution_of
from symfpu.cli.choices import choice
from symfpu.cli.terminal import SAVED_SOLUTION, path_named, whole, whole_numbers
from symfpu.dynamics.starts import packet_state, random_state
from symfpu.dynamics.state_files import read_state
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Numbers
from symfpu.store.saved_file import load
from symfpu.tori.torus import Torus

StartArgument = Annotated[str | None, typer.Argument(help=SAVED_SOLUTION, metavar="[FILE]")]
OwnBonds = Annotated[
    str | None,
    typer.Option("-N", help="Without FILE: number of bonds of the chain.", metavar="N"),
]
OwnAlpha = Annotated[
    str | None, typer.Option("--alpha", help="Without FILE: cubic coupling.", metavar="X")
]
OwnBeta = Annotated[
    str | None, typer.Option("--beta", help="Without FILE: quartic coupling.", metavar="X")
]
OwnPotential = Annotated[
    str | None,
    typer.Option("--potential", help="Without FILE: another law of a bond.", metavar="V"),
]
OwnEnds = Annotated[
    str | None,
    choice("--ends", ENDS, "Without FILE: ends of the chain."),
]
StateOption = Annotated[
    str | None,
    typer.Option(
        "--state",
        help="Start from displacements and momenta of the particles: two columns, or .npz.",
        metavar="FILE",
    ),
]
PacketOption = Annotated[
    str | None,
    typer.Option(
        "--packet",
        help="Start with these modes alone moving, of equal harmonic energy.",
        metavar="Q,Q,...",
    ),
]
RandomOption = Annotated[
    str | None,
    typer.Option("--random", help="Start from a random state.", metavar="SEED"),
]
EnergyOption = Annotated[
    str | None,
    typer.Option("--energy", help="With --packet or --random: its H.", metavar="E"),
]


@dataclass(frozen=True)
class Start:
    """The state an orbit starts from. torus : it is on, or None. record : how it was asked for."""

    chain: Chain
    Q: Numbers
    P: Numbers
    torus: Torus | None
    record: dict[str, Any]


def start_of(
    file: str | None,
    typed_chain: dict[str, str | None],
    states: dict[str, str | None],
    energy: str | None,
) -> Start:
    """The start that these options name; InputError unless they name exactly one.

    typed_chain : bonds, alpha, beta, potential and ends. states : state, packet and random.
    """
    given = {name: value for name, value in states.items() if value is not None}
    if (file is not None) + len(given) != 1:
        allowed = "exactly one of FILE, --state, --packet and --random"
        named = given | ({} if file is None else {"FILE": file})
        advice = "leave the others out" if named else "give one of them"
        raise InputError("start", named or None, allowed, advice)
    if file is not None:
        _refuse_beside_a_file(typed_chain | {"energy": energy})
        return _on_a_torus(file)
    (kind,) = given
    _require_energy(kind, energy)
    chain = _chain(typed_chain)
    Q, P = _state(chain, kind, str(given[kind]), energy)
    record = {"kind": kind, kind: given[kind]}
    return Start(chain, Q, P, None, record)


def _on_a_torus(file: str) -> Start:
    saved = solution_of(load(path_named("FILE", file)), file)
    torus = saved.in_doubles()
    Q, P = torus.state()
    return Start(torus.chain, Q, P, torus, {"kind": "torus", "file": file})


def _refuse_beside_a_file(options: dict[str, str | None]) -> None:
    for name, value in options.items():
        if value is not None:
            allowed = "nothing beside FILE, which has its chain and its energy"
            raise InputError(name, value, allowed, "leave it out, or leave out FILE")


def _require_energy(kind: str, energy: str | None) -> None:
    if kind == "state" and energy is not None:
        allowed = "nothing beside --state, whose energy it has"
        raise InputError("energy", energy, allowed, "leave it out")
    if kind != "state" and energy is None:
        raise InputError("energy", None, f"the energy H beside --{kind}", "give --energy E")


def _chain(typed: dict[str, str | None]) -> Chain:
    bonds = typed["N"]
    if bonds is None:
        allowed = "the chain of a state of your own"
        raise InputError("N", None, allowed, "give -N, and --alpha, --beta or --potential")
    couplings = typed["alpha"] or "0", typed["beta"] or "0"
    return chain_of(bonds, *couplings, typed["potential"], typed["ends"] or "fixed")


def _state(
    chain: Chain, kind: str, value: str, energy: str | None
) -> tuple[Numbers, Numbers]:
    if kind == "state":
        return read_state(chain, path_named("state", value))
    assert energy is not None
    if kind == "packet":
        return packet_state(chain, whole_numbers("packet", value), energy)
    return random_state(chain, energy, whole("random", value))
