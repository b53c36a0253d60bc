"""What `make bench` measured before: runs as JSON, each with its machine; what became slower since.

pytest-benchmark writes the runs. A time is compared in units of a matrix product that was timed beside it, where there is one:
what else the machine does then falls on both.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cpuinfo

FOLDER = Path(__file__).parent / "history"
SLOWER = 1.10  # times the least time of the run before
CLOCK = 0.1  # relative difference of two clocks that are alike
VECTORS = (("avx512f", 512), ("avx2", 256), ("avx", 256), ("asimd", 128), ("sse2", 128))
BESIDE = "matrix_product_seconds"
WHAT = "what"

Json = dict[str, Any]


def seconds(work: Callable[[], Any]) -> float:
    """Of one call, by the clock."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def machine() -> Json:
    """This machine: processor, cores, vector width in bits, clock in GHz; no name of it."""
    known = cpuinfo.get_cpu_info()
    flags = set(known.get("flags", ()))
    hertz = known.get("hz_advertised", known.get("hz_actual", (0, 0)))[0]
    return {
        "processor": known.get("brand_raw", known.get("arch", "unknown")),
        "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count(),
        "vector_bits": next((bits for flag, bits in VECTORS if flag in flags), 64),
        "clock_ghz": round(hertz / 1e9, 2),
        "python": known["python_version"].split(".final")[0],
    }


def alike(one: Json, other: Json) -> bool:
    """Whether times on two machines may be compared: cores, vector width, and the clock within a tenth."""
    same = all(one[name] == other[name] for name in ("cores", "vector_bits"))
    fastest = max(one["clock_ghz"], other["clock_ghz"])
    return same and abs(one["clock_ghz"] - other["clock_ghz"]) <= CLOCK * fastest


@dataclass(frozen=True)
class Timed:
    """One benchmark of a run: what it is, median and least seconds, and the product beside it, if it was timed."""

    name: str
    what: str
    median: float
    least: float
    product: float | None

    def units(self, other: Timed) -> tuple[float, float]:
        """The least times of both, in products beside them where both have one, else in seconds."""
        if self.product and other.product:
            return self.least / self.product, other.least / other.product
        return self.least, other.least


@dataclass(frozen=True)
class Run:
    """A run: its machine, when it was, and its benchmarks by name."""

    machine: Json
    when: str
    commit: str
    timed: Mapping[str, Timed]


def read_run(path: Path) -> Run:
    held = json.loads(path.read_text())
    timed = [_timed(entry) for entry in held["benchmarks"]]
    commit = held.get("commit_info", {}).get("id") or "unknown"
    return Run(held["machine_info"], held["datetime"], commit[:7], {each.name: each for each in timed})


def _timed(entry: Json) -> Timed:
    more = entry.get("extra_info", {})
    stats = entry["stats"]
    return Timed(entry["fullname"], more.get(WHAT, entry["name"]), stats["median"], stats["min"], more.get(BESIDE))


def read_runs(folder: Path = FOLDER) -> list[Run]:
    """All runs, the oldest first."""
    return sorted(map(read_run, folder.rglob("*.json")), key=lambda run: run.when)


def before(runs: Iterable[Run], run: Run) -> dict[str, Timed]:
    """Every benchmark of a run as it was when it ran last on a like machine."""
    found: dict[str, Timed] = {}
    for earlier in runs:
        if earlier.when < run.when and alike(earlier.machine, run.machine):
            found |= earlier.timed
    return found


def factors(runs: Iterable[Run], run: Run) -> dict[str, float]:
    """By how much each benchmark takes longer than before, as a factor; of those that ran before."""
    known = before(runs, run)
    found = {}
    for name, timed in run.timed.items():
        if name in known:
            now, then = timed.units(known[name])
            found[name] = now / then
    return found


def slower_lines(runs: Iterable[Run], run: Run) -> list[str]:
    """What to print of a run beside those before it."""
    runs = list(runs)
    known, changed = before(runs, run), factors(runs, run)
    if not changed:
        return ["no earlier run on a like machine: nothing to compare with"]
    slow = {name: factor for name, factor in changed.items() if factor > SLOWER}
    lines = [f"{len(changed)} compared with the last run on a like machine, {len(slow)} slower by more than 10 %"]
    for name, factor in sorted(slow.items(), key=lambda item: -item[1]):
        now, then = run.timed[name], known[name]
        unit = "in matrix products beside" if now.product and then.product else "in seconds"
        lines.append(f"slower by {factor - 1:.0%} {unit}: {name}, {then.least:.3g} s to {now.least:.3g} s")
    return lines
