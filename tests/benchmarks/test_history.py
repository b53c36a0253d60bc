"""The history of benchmarks: like machines, what became slower, and the page that is made from it."""

import json
import runpy
from pathlib import Path

import pytest

from tests.benchmarks.history import FOLDER, alike, factors, machine, read_run, read_runs, slower_lines

ROOT = Path(__file__).parents[2]
page = runpy.run_path(str(ROOT / "docs" / "make_performance.py"))
HERE = {"processor": "P", "cores": 2, "vector_bits": 512, "clock_ghz": 2.6, "python": "3.11.7"}


def write(folder, day, times, held=HERE):
    """A run as pytest-benchmark saves it: by name the least seconds and those of the product beside."""
    benchmarks = []
    for name, (seconds, product) in times.items():
        more = {"what": f"the {name}"} | ({"matrix_product_seconds": product} if product else {})
        benchmarks.append({"fullname": name, "name": name, "extra_info": more, "stats": {"median": 1.5 * seconds, "min": seconds}})
    body = {"machine_info": held, "commit_info": {"id": "0123456789"}, "datetime": f"2026-11-{day:02}T00:00:00", "benchmarks": benchmarks}
    path = folder / f"{day:04}.json"
    path.write_text(json.dumps(body))
    return read_run(path)


def test_what_became_slower_is_printed(tmp_path):
    write(tmp_path, 1, {"series": (1.0, 0.1), "start": (0.2, None), "kernel": (3.0, 0.1)})
    last = write(tmp_path, 2, {"series": (1.2, 0.1), "start": (0.25, None), "kernel": (3.2, 0.1), "new": (1.0, 0.1)})
    first, *others = slower_lines(read_runs(tmp_path), last)
    assert first == "3 compared with the last run on a like machine, 2 slower by more than 10 %"
    assert others == ["slower by 25% in seconds: start, 0.2 s to 0.25 s", "slower by 20% in matrix products beside: series, 1 s to 1.2 s"]


def test_a_busy_machine_is_not_slower(tmp_path):
    write(tmp_path, 1, {"series": (1.0, 0.1)})
    busy = write(tmp_path, 2, {"series": (3.0, 0.3)})
    assert factors(read_runs(tmp_path), busy) == {"series": pytest.approx(1)}


@pytest.mark.parametrize(
    ("held", "like"), [({"cores": 4}, False), ({"vector_bits": 256}, False), ({"clock_ghz": 3.5}, False), ({"clock_ghz": 2.5}, True)]
)
def test_runs_on_other_machines_are_not_compared(tmp_path, held, like):
    write(tmp_path, 1, {"series": (1.0, 0.1)}, HERE | held)
    last = write(tmp_path, 2, {"series": (2.0, 0.1)})
    assert alike(HERE, HERE | held) == like
    assert (factors(read_runs(tmp_path), last) == {"series": 2}) == like
    assert slower_lines(read_runs(tmp_path), last)[0].startswith("1 compared" if like else "no earlier run")


def test_each_benchmark_is_compared_with_its_own_last_run(tmp_path):
    write(tmp_path, 1, {"series": (1.0, None), "kernel": (1.0, None)})
    write(tmp_path, 2, {"kernel": (2.0, None)})
    last = write(tmp_path, 3, {"series": (2.0, None), "kernel": (2.0, None)})
    assert factors(read_runs(tmp_path), last) == {"series": 2, "kernel": 1}


def test_this_machine_has_a_record_and_no_name():
    held = machine()
    assert held["cores"] >= 1
    assert held["vector_bits"] in (64, 128, 256, 512)
    assert held.keys() == HERE.keys()


def test_the_page_is_made_from_the_runs_that_are_kept():
    text = (ROOT / "docs" / "performance.md").read_text()
    assert text == page["with_section"](text, read_runs(FOLDER))
