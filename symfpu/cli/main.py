"""Command line: parses, calls one public function, prints or writes.

Exit code 0 for success, 1 for an honest failure (no root, no convergence), 2 for bad input, files
too, 130 for the interrupt key; errors are one line on standard error, progress goes there too, and
--json leaves standard output machine-readable.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Annotated, Any

import typer

from symfpu.cli.terminal import Interrupted
from symfpu.cli.verbs import app
from symfpu.errors import InputError, SymfpuError
from symfpu.files.archive import BundleError

INTERRUPTION = "interrupted: nothing is kept but what was already written"

# click's ClickException, which typer may carry inside itself
UsageProblem: Any = typer.BadParameter.__mro__[2]


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"symfpu {version('symfpu')}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option(
            "--version",
            callback=_print_version,
            is_eager=True,
            help="Print the version and stop.",
        ),
    ] = False,
) -> None:
    """Options that come before the verb."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    command = typer.main.get_command(app)
    words = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    try:
        code = command.main(
            args=words, prog_name="symfpu", standalone_mode=False, obj=words
        )
    except (InputError, BundleError) as error:
        return _fail(str(error), 2)
    except Interrupted as error:
        return _fail(str(error), 130)
    except SymfpuError as error:
        return _fail(str(error), 1)
    except OSError as error:
        return _fail(f"{error.filename}: {error.strerror}; name another file or folder", 2)
    except (KeyboardInterrupt, EOFError, typer.Abort):
        return _fail(INTERRUPTION, 130)
    except UsageProblem as error:
        return _fail(f"{error.format_message()} (see symfpu --help)", int(error.exit_code))
    return _fail(INTERRUPTION, 130) if code == 130 else int(code or 0)


def _fail(message: str, code: int) -> int:
    print("symfpu: " + " ".join(message.split()), file=sys.stderr)
    return code


def run() -> None:
    """Entry point of the console script."""
    sys.exit(main())
