"""Command line: parses, calls one public function, prints or writes.

Exit code 0 for success, 1 for an honest failure (no root, no convergence), 2 for bad input, files
too, 130 for the interrupt key; errors are one line on standard error, progress goes there too, and
--json leaves standard output machine-readable.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout, suppress
from typing import Annotated, Any, TextIO

import typer

from symfpu.cli.interrupting import INTERRUPTED, INTERRUPTION
from symfpu.cli.terminal import Interrupted
from symfpu.cli.verbs import app
from symfpu.errors import InputError, SymfpuError
from symfpu.files.archive import BundleError

# click's ClickException, which typer may carry inside itself
UsageProblem: Any = typer.BadParameter.__mro__[2]


OUTPUT = "standard output"


class NamedOutput:
    """Standard output; what the system refuses to it has its name."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        with _named():
            return self._stream.write(text)

    def flush(self) -> None:
        with _named():
            self._stream.flush()


@contextmanager
def _named() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror, OUTPUT) from error


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


def answer(arguments: Sequence[str] | None = None) -> int:
    """Do what a command line says; returns the exit code."""
    if sys.stdout is None:
        return _fail("standard output is closed: send it to a file or to /dev/null", 2)
    words = list(sys.argv[1:] if arguments is None else arguments)
    named: Any = NamedOutput(sys.stdout)
    try:
        with redirect_stdout(named):
            return _answer(words or ["--help"])
    except (
        BrokenPipeError,
        SystemExit,
    ):  # whoever reads has heard enough, as click says too
        _forget_output()
        return 1
    except OSError as error:
        return _fail(_refusal(error), 2)
    except (KeyboardInterrupt, EOFError):
        return _fail(INTERRUPTION, INTERRUPTED)
    except RuntimeError as error:
        # Python 3.11 hides the interrupt key behind this one where a class is being made
        if not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        return _fail(INTERRUPTION, INTERRUPTED)


def _answer(words: list[str]) -> int:
    """The same; raises OSError and KeyboardInterrupt."""
    command = typer.main.get_command(app)
    try:
        code = command.main(
            args=words, prog_name="symfpu", standalone_mode=False, obj=words
        )
        sys.stdout.flush()
    except (InputError, BundleError) as error:
        return _fail(str(error), 2)
    except Interrupted as error:
        return _fail(str(error), INTERRUPTED)
    except SymfpuError as error:
        return _fail(str(error), 1)
    except typer.Abort:
        return _fail(INTERRUPTION, INTERRUPTED)
    except UsageProblem as error:
        return _fail(f"{error.format_message()} (see symfpu --help)", int(error.exit_code))
    return _fail(INTERRUPTION, INTERRUPTED) if code == INTERRUPTED else int(code or 0)


def _refusal(error: OSError) -> str:
    """What the system refuses, with the name of the file."""
    reason = error.strerror or str(error)
    if error.filename is None:
        return f"the system refuses: {reason}"
    if error.filename != OUTPUT:
        return f"{error.filename}: {reason}; name another file or folder"
    _forget_output()
    return f"{OUTPUT}: {reason}; send it elsewhere"


def _forget_output() -> None:
    """Standard output takes no more: what is still due to it would be refused at the end again."""
    with suppress(OSError, ValueError):  # where it is no file, as in a notebook
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def _fail(message: str, code: int) -> int:
    print("symfpu: " + " ".join(message.split()), file=sys.stderr)
    return code
