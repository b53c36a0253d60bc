"""The verb export: source code of a saved torus or series."""

from __future__ import annotations

import shlex
from typing import Annotated

import typer

from symfpu.chain.chain import require_fixed_ends
from symfpu.cli.choices import choice
from symfpu.cli.terminal import FileArgument, optional, path_named, progress_bar
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.files.writing import output_file
from symfpu.series.series import LindstedtSeries
from symfpu.store.saved_file import load
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus, comes_from

# known to the help without importing them
LANGUAGES = ("c", "fortran", "numpy", "mpmath", "octave")


@app.command(epilog="Example: symfpu export torus.symfpu --lang c -o my_torus")
def export(
    context: typer.Context,
    file: FileArgument,
    language: Annotated[str, choice("--lang", LANGUAGES, "Language of the source.")],
    output: Annotated[
        str,
        typer.Option(
            "-o",
            "--output",
            help="The source file; its name names the functions.",
            metavar="FILE",
        ),
    ],
    series: Annotated[
        bool,
        typer.Option(
            "--series", help="The series with free amplitudes instead of the torus."
        ),
    ] = False,
    order: Annotated[
        str | None,
        typer.Option(
            help="With --series: order of the coordinates.  Default: all.", metavar="K"
        ),
    ] = None,
    frequency_order: Annotated[
        str | None,
        typer.Option(help="With --series: order of omega(A).  Default: all.", metavar="K"),
    ] = None,
    derivatives: Annotated[
        bool,
        typer.Option(
            "--derivatives",
            help="With --series, in universal form: derivatives by the frequencies too.",
        ),
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Replace an existing file.")
    ] = False,
) -> None:
    """Source code of a torus, or of a series with free amplitudes.

    It needs nothing of symfpu, and tests itself.
    """
    # lazy: printers of SymPy take half of the time of symfpu --help
    from symfpu.codegen.export import export as export_source

    target = output_file(path_named("output", output))
    held = load(path_named("FILE", file))
    if series and comes_from(held, FromSeries):
        held = held.origin.series
    solution = held if isinstance(held, LindstedtSeries if series else Torus) else None
    if solution is None:
        wanted = "series" if series else "torus"
        advice = "write one with symfpu solve -o, or export the --series"
        if series:
            advice = "leave out --series"
        raise InputError("FILE", file, f"a file with a {wanted} in it", advice)
    require_fixed_ends(solution.chain)
    with progress_bar("source code"):
        written = export_source(
            solution,
            language,
            target,
            order=optional("order", order),
            frequency_order=optional("frequency-order", frequency_order),
            derivatives=derivatives,
            force=force,
            command=shlex.join(["symfpu", *context.obj]),
        )
    print(f"written: {written}")
