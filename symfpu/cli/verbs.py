"""The verbs by name, and the command they belong to.

A verb's module is imported when it is asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import typer
from typer.core import TyperGroup
from typer.main import get_group

from symfpu.errors import InputError

# In the order of the help. Only reproduce loads the paper, only export the languages.
VERBS = {
    "propagate": "proofs",
    "prove": "proofs",
    "verify": "proofs",
    "sweep": "proofs",
    "term": "term",
    "solve": "solve",
    "show": "tori",
    "breather": "breather",
    "refine": "families",
    "family": "families",
    "atlas": "atlas",
    "actions": "actions",
    "stability": "stability",
    "certify": "certify",
    "orbit": "orbit",
    "frequencies": "frequencies",
    "gali": "gali",
    "export": "export",
    "reproduce": "reproduce",
    "workbench": "workbench",
}


class Verbs(TyperGroup):
    """A group that knows its verbs by the table above.

    It knows each of them from when it is first asked for.

    Contexts and commands are click's, which typer may carry inside itself.
    """

    def list_commands(self, ctx: Any) -> list[str]:
        """All names, in the order of the table."""
        return list(VERBS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The verb, its module imported; InputError for a name that is none."""
        if cmd_name not in VERBS:
            raise InputError("verb", cmd_name, ", ".join(VERBS), "see symfpu --help")
        if cmd_name not in self.commands:
            # registers its verbs with the application
            import_module(f"symfpu.cli.{VERBS[cmd_name]}")
            self.commands.update(get_group(app).commands)
        return self.commands[cmd_name]


app = typer.Typer(
    name="symfpu",
    help="Poincare-Lindstedt series of q-tori in Fermi-Pasta-Ulam chains.",
    cls=Verbs,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
