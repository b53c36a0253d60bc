"""The verbs by name, and the command they belong to.

A verb's module is imported when it is run, not for the list of all.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, NamedTuple

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_group

from symfpu.errors import InputError


class Verb(NamedTuple):
    """Where a verb is, and what the help of all verbs says of it.

    module : of this room. line : the first of its own help, known without importing it.
    """

    module: str
    line: str


# In the order of the help. Only reproduce loads the paper, only export the languages.
VERBS = {
    "propagate": Verb(
        "proofs",
        "Which modes the propagation rule D_k excites at each order.",
    ),
    "prove": Verb(
        "proofs",
        "Prove or refute the propagation rule by exact arithmetic, for one N or for all.",
    ),
    "verify": Verb("proofs", "Check a certificate by another route."),
    "sweep": Verb(
        "proofs",
        "Decide the propagation rule for all seed sets of a range of chains.",
    ),
    "term": Verb(
        "term",
        "One term of a series, Q_q^(k) or omega_q^(k), as a formula, for one N or for all.",
    ),
    "solve": Verb(
        "solve",
        "The q-torus of exactly one of --omega, --energy and --amplitudes.",
    ),
    "show": Verb(
        "tori",
        "What a result file holds: any result, its verdict, and what made it.",
    ),
    "refine": Verb(
        "families",
        "The torus that solves the equations of motion, by Newton's method.",
    ),
    "family": Verb(
        "families",
        "A family of tori from small energy on, past folds and past the end of its series.",
    ),
    "atlas": Verb(
        "atlas",
        "Where q-tori end as their energy grows, by chain and packet, and the power laws in N.",
    ),
    "actions": Verb(
        "actions",
        "Actions I of a torus or breather, and the twist d omega / d I with its signature.",
    ),
    "stability": Verb(
        "stability",
        "Normal frequencies of a refined torus or breather: is it stable, what is it near?",
    ),
    "certify": Verb(
        "certify",
        "Prove that a periodic orbit exists near a breather, or how long orbits stay near a torus.",
    ),
    "orbit": Verb(
        "orbit",
        "Integrates the orbit from a saved torus, or from a state of your own.",
    ),
    "frequencies": Verb(
        "frequencies",
        "Frequencies of an orbit, its strongest lines and its drift; with --energies a map.",
    ),
    "gali": Verb(
        "gali",
        "Alignment indices of the orbit from a torus or a state, and the dimension they show.",
    ),
    "export": Verb(
        "export",
        "Source code of a torus, or of a series with free amplitudes.",
    ),
    "reproduce": Verb(
        "reproduce",
        "The paper's table and figures from its printed frequencies, beside the printed numbers.",
    ),
    "workbench": Verb(
        "workbench",
        "A page of this machine's browser: choose a torus by sliders, see it at once.",
    ),
}


class Verbs(TyperGroup):
    """A group that knows its verbs by the table above.

    The help of all is made of the table; a verb that runs is imported with its options.

    Contexts and commands are click's, which typer may carry inside itself.
    """

    def list_commands(self, ctx: Any) -> list[str]:
        """All names, in the order of the table."""
        return list(VERBS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The verb with its line, nothing imported; InputError for a name that is none."""
        if cmd_name not in VERBS:
            raise InputError("verb", cmd_name, ", ".join(VERBS), "see symfpu --help")
        return TyperCommand(cmd_name, help=VERBS[cmd_name].line)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The verb that comes first in what was typed, its module imported, and the rest."""
        name, _, rest = super().resolve_command(ctx, args)
        assert name is not None
        if name not in self.commands:
            # registers its verbs with the application
            import_module(f"symfpu.cli.{VERBS[name].module}")
            self.commands.update(get_group(app).commands)
        return name, self.commands[name], rest


app = typer.Typer(
    name="symfpu",
    help="Poincare-Lindstedt series of q-tori in Fermi-Pasta-Ulam chains.",
    cls=Verbs,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
