"""The verb of the paper: reproduce."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from symfpu.certificates import write_text
from symfpu.errors import InputError
from symfpu.report import output_folder
from symfpu.targets import FULL, TARGETS
from symfpu.verbs.terminal import (
    JsonOption,
    app,
    print_json,
    progress_bar,
)


@app.command(epilog="Example: symfpu reproduce table fig1 -o out")
def reproduce(
    targets: Annotated[list[str], typer.Argument(help="table, fig1, fig6, convergence, or all.", metavar="TARGET...")],
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for the report, pictures and data.")] = Path("out"),
    full: Annotated[bool, typer.Option("--full", help="With the exact tori of the table that take many minutes.")] = False,
    as_json: JsonOption = False,
) -> None:
    """The paper's numbers from its printed frequencies, beside the printed ones."""
    for target in targets:
        if target not in (*TARGETS, "all"):
            raise InputError("target", target, f"{', '.join(TARGETS)} or all", "name one or more of these")
    if full and not {*FULL, "all"} & set(targets):
        raise InputError("full", " ".join(targets), f"--full with {', '.join(FULL)} or all", "leave out --full")
    folder = output_folder(output)
    pages = {}
    with progress_bar() as advance:
        for target in TARGETS:
            if target in targets or "all" in targets:
                pages[target] = (FULL if full and target in FULL else TARGETS)[target](folder, lambda label: advance(label, None))
    record = {target: page.record for target, page in pages.items()}
    title = "# The paper's numbers, computed from its printed frequencies"
    write_text(folder / "report.md", "\n\n".join([title, *(page.markdown for page in pages.values())]))
    write_text(folder / "report.json", json.dumps(record, indent=1) + "\n")
    if as_json:
        print_json(record)
        return
    _print_rows(record.get("table", []), pages["table"].lines if "table" in pages else ())
    for key, claim in record.get("fig1", {}).get("claims", {}).items():
        print(f"Fig. 1, {key.replace('_', ' ')}: printed {claim['printed']}; computed {claim['computed']}")
    pictures = [page.files for page in pages.values() if page.files]
    print(f"written: {folder / 'report.md'}, report.json" + (f", {', '.join(pictures)} as PNG, PDF and CSV" if pictures else ""))


def _print_rows(rows: Sequence[dict[str, Any]], corrected: Sequence[str]) -> None:
    for row, exact in zip(rows, corrected, strict=True):
        print(f"{row['label']}  (Appendix F: {row['printed_label']})")
        for q, printed in row["printed_amplitudes"].items():
            print(f"  A_{q:<3} printed {printed:<24} computed {row['torus']['amplitudes'][q]}")
        energies = ", ".join(f"{name} {float(value):.9g}" for name, value in row["energies"].items())
        print(f"  E    printed {row['printed_energy']:<24} computed {energies}")
        print(f"  {row['verdict']}\n{exact}\n")
