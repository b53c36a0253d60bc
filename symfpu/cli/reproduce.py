"""The verb of the paper: reproduce."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from contextlib import closing
from pathlib import Path
from typing import Annotated, Any

import typer

from symfpu.cli.terminal import (
    NOTHING_KEPT,
    JsonOption,
    console,
    path_named,
    print_json,
    progress_bar,
    say,
)
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.files.writing import output_folder, write_text
from symfpu.paper.claims import PaperFigure
from symfpu.paper.claims_page import (
    claims_markdown,
    figure_markdown,
    figure_record,
    file_names,
)
from symfpu.paper.side_by_side import TargetsFailed, side_by_side
from symfpu.paper.targets import LONG_TARGETS, TARGETS, full_estimate, full_seconds_of
from symfpu.results.head import headed

AGAIN = 5.0  # seconds between two lines of the same steps


@app.command(epilog="Example: symfpu reproduce table fig1 -o out")
def reproduce(
    targets: Annotated[
        list[str],
        typer.Argument(help=f"{', '.join(TARGETS)}, or all.", metavar="TARGET..."),
    ],
    output: Annotated[
        str,
        typer.Option(
            "-o",
            "--output",
            help="Folder for the report, pictures and data.",
            metavar="FOLDER",
        ),
    ] = "out",
    full: Annotated[
        bool,
        typer.Option(
            "--full",
            help="Alignment indices to 1e9 instead of 1e7, all exact tori: hours; "
            "goes on where it was stopped.",
        ),
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """The paper's table and figures from its printed frequencies, beside the printed numbers.

    Every claim has a verdict. report.md and report.json hold the targets of this run alone.
    """
    for target in targets:
        if target not in (*TARGETS, "all"):
            raise InputError(
                "target",
                target,
                f"{', '.join(TARGETS)} or all",
                "name one or more of these",
            )
    if full and not {*LONG_TARGETS, "all"} & set(targets):
        raise InputError(
            "full",
            " ".join(targets),
            f"--full with {', '.join(LONG_TARGETS)} or all",
            "leave out --full",
        )
    folder = output_folder(path_named("output", output))
    chosen = [target for target in TARGETS if target in targets or "all" in targets]
    added = full_seconds_of(chosen) if full else None
    if added is not None:
        console().print(full_estimate(added, folder), highlight=False)
    figures, failures = _computed(chosen, folder, added)
    if len(chosen) == 1 and failures:
        raise failures[chosen[0]]
    if figures and as_json:
        print_json(_record(figures))
    elif figures:
        _print(figures, folder)
    if failures:
        raise TargetsFailed(failures)


def _computed(
    chosen: list[str], folder: Path, added: Mapping[str, float] | None
) -> tuple[dict[str, PaperFigure], dict[str, Exception]]:
    """Figures in the order of the paper, and errors, by target."""
    figures: dict[str, PaperFigure] = {}
    failures: dict[str, Exception] = {}
    with (
        progress_bar(chosen[0], lambda: _kept(figures, folder), again=AGAIN) as advance,
        closing(side_by_side(chosen, folder, advance, full=added)) as coming,
    ):
        for target, found in coming:
            if isinstance(found, Exception):
                failures[target] = found
                continue
            known = figures | {target: found}
            figures = {name: known[name] for name in chosen if name in known}
            # at once: a run that is stopped, or a later target that fails, loses nothing
            _write(figures, folder)
    return figures, failures


def _print(figures: dict[str, PaperFigure], folder: Path) -> None:
    for figure in figures.values():
        for line in figure.lines:
            say(line)
    _print_claims(figure for figure in figures.values() if figure.claims)
    written = f"{folder / 'report.md'}, report.json"
    pictures = ", ".join(file_names(figure) for figure in figures.values() if figure.panels)
    if pictures:
        written += f", {pictures} as PNG, PDF and CSV"
    print(f"written: {written}")


def _kept(figures: dict[str, PaperFigure], folder: Path) -> str:
    """What stands of a reproduction that was interrupted."""
    parts = (
        [f"{folder}/report.md and report.json hold {', '.join(figures)}"] if figures else []
    )
    if any(folder.glob("*.checkpoint")):
        parts.append(f"the same command goes on from {folder}/*.checkpoint")
    return "; ".join(parts) or NOTHING_KEPT


def _write(figures: dict[str, PaperFigure], folder: Path) -> None:
    """The report as Markdown and JSON."""
    parts = ["# The paper's numbers, computed from its printed frequencies"]
    if any(figure.claims for figure in figures.values()):
        parts.append(claims_markdown(figures.values()))
    parts += [figure_markdown(figure) for figure in figures.values()]
    write_text(folder / "report.md", "\n\n".join(parts))
    write_text(folder / "report.json", json.dumps(_record(figures), indent=1) + "\n")


def _record(figures: dict[str, PaperFigure]) -> dict[str, Any]:
    found = {target: figure_record(figure) for target, figure in figures.items()}
    return headed({"kind": "reproduce", "figures": found})


def _print_claims(figures: Iterable[PaperFigure]) -> None:
    for figure in figures:
        say(figure.title)
        for claim in figure.claims:
            printed = f" (printed {claim.printed})" if claim.printed else ""
            said = f"section {claim.section}, {claim.text}{printed}"
            say(f"  {claim.verdict}: {said}\n    {claim.ours}")
