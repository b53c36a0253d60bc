"""Writes the table of docs/performance.md from the runs of `make bench` that are kept.

python docs/make_performance.py
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from tests.benchmarks.history import Run, alike, factors, read_runs  # noqa: E402

PAGE = Path(__file__).with_name("performance.md")
BEGIN, END = "<!-- runs: begin -->", "<!-- runs: end -->"
HEAD = """
## The last runs

Made by `make bench`, a table a machine. A matrix product (1500 x 1500, doubles) is timed beside each benchmark: its time in such products is what is compared, with the last run on a machine with as many
cores, the same vector width, and a clock within a tenth. Runs are kept in `tests/benchmarks/history`.
"""
NONE = """
No run is kept yet.
"""


def section(runs: Sequence[Run]) -> str:
    """The tables of the newest runs, one for each machine."""
    newest: list[Run] = []
    for run in reversed(runs):
        if not any(alike(run.machine, other.machine) for other in newest):
            newest.append(run)
    tables = "".join(table(runs, run) for run in newest) or NONE
    return f"{BEGIN}\n{HEAD}{tables}\n{END}"


def table(runs: Sequence[Run], run: Run) -> str:
    """The benchmarks of a run, with what changed since they ran before."""
    held = run.machine
    width = f"{held['cores']} cores, vectors of {held['vector_bits']} bits, {held['clock_ghz']} GHz"
    lines = [
        f"\n{held['processor']}, {width}, Python {held['python']}; {run.when[:10]}, commit {run.commit}.\n"
    ]
    lines.append(
        "| what | seconds | matrix products | against the run before |\n| --- | --- | --- | --- |"
    )
    changed = factors(runs, run)
    for name, timed in run.timed.items():
        products = f"{timed.least / timed.product:.3g}" if timed.product else ""
        change = f"{changed[name] - 1:+.0%}" if name in changed else ""
        lines.append(f"| {timed.what} | {timed.median:.3g} | {products} | {change} |")
    return "\n".join(lines) + "\n"


def with_section(text: str, runs: Sequence[Run]) -> str:
    """The page with its section made anew."""
    start, _, rest = text.partition(BEGIN)
    _, _, end = rest.partition(END)
    return start + section(runs) + end


if __name__ == "__main__":
    PAGE.write_text(with_section(PAGE.read_text(), read_runs()))
