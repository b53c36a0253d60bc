"""symfpu gali: keys of the JSON, table and pictures, and bad input."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
import zipfile
from shlex import split

import pytest

import symfpu
from symfpu import Chain, lindstedt, save, solve_amplitudes
from symfpu.normal.search import _Search
from tests.cli.running import answer, refusal, run, shown
from tests.tolerances import COMMANDED_SECONDS, FORETOLD, GALI_SLOPE, VOLUME_BY_SCHEME

PRESSED = """
import os, pathlib, sys
from symfpu.dynamics import motion, frame_run
from symfpu.cli.main import main

def marked(inner):
    def outer(*given):
        pathlib.Path(os.environ["BEGUN"]).touch()
        return inner(*given)
    return outer

motion.Motion.look, frame_run.carried = marked(motion.Motion.look), marked(frame_run.carried)
sys.exit(main(sys.argv[1:]))
"""


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """A breather of mode 4 in a beta chain of eight bonds."""
    series = lindstedt(Chain(8, beta=1), (4,), ("1.44",), 6)
    return save(tmp_path_factory.mktemp("gali") / "breather.symfpu", solve_amplitudes(series))


def test_json_has_slopes_and_dimension(capsys, kept):
    record = answer(capsys, "gali", str(kept), "--time", "5e4", "--vectors", "4", "--frames", "1")
    assert list(record["slopes"]) == ["2", "3", "4"]
    for k, slope in record["slopes"].items():
        assert slope["value"] == pytest.approx(1 - int(k), abs=GALI_SLOPE)
        assert 0 < slope["error"] < 0.25
    assert (record["dimension"], record["verdict"]) == (1, "regular, dimension 1")
    assert (record["N"], record["beta"], record["seeds"], record["time"]) == (8, "1", [4], 50000.0)


def test_a_scheme_is_chosen_by_name(capsys, kept):
    words = ("gali", str(kept), "--time", "200", "--samples", "64", "--vectors", "3")
    records = {name: answer(capsys, *words, "--scheme", name) for name in ("blanes_moan6", "kahan_li8")}
    assert answer(capsys, *words) == records["blanes_moan6"]
    assert [record["scheme"] for record in records.values()] == list(records)
    ends = [list(record["log10_gali"].values()) for record in records.values()]
    assert ends[0] == pytest.approx(ends[1], abs=VOLUME_BY_SCHEME)
    assert ends[0] != ends[1]
    err = refusal(capsys, *words, "--scheme", "aba864_modes")
    assert "scheme" in err
    assert "yoshida4, aba864, blanes_moan6, kahan_li8" in err


@pytest.mark.long
def test_a_folder_gets_the_table_and_the_pictures(capsys, kept, tmp_path):
    out_folder = tmp_path / "out"
    out = shown(capsys, "gali", str(kept), "--time", "1000", "--samples", "64", "-o", str(out_folder))
    assert out.startswith("verdict: ")
    assert "Lyapunov exponent" in out
    named = out.splitlines()[-1].removeprefix(f"written: {out_folder}: ").split(", ")
    assert sorted(named) == sorted(path.name for path in out_folder.iterdir())
    assert all(path.stat().st_size > 1000 for path in out_folder.iterdir())
    with (out_folder / "gali.csv").open() as stream:
        head, *rows = csv.reader(stream)
    assert head == ["t", *(f"log10 GALI_{k}" for k in range(2, 8)), "lyapunov"]
    assert float(rows[-1][0]) == 1000.0
    assert all(len(row) == 8 for row in rows)


# of what, two times with their steps, and options
CHECKPOINTS = {
    "gali": ("alignment indices", (200, 500), (300, 750), ["--samples", "64", "--vectors", "3"]),
    "orbit": ("orbit", (50, 250), (60, 300), ["--samples", "9"]),
}


@pytest.mark.parametrize("verb", CHECKPOINTS)
def test_a_checkpoint_is_taken_up_and_refused_for_another_run(verb, capsys, kept, tmp_path):
    kind, (time, here), (longer, there), options = CHECKPOINTS[verb]
    file = tmp_path / "run"
    words = (verb, kept, *options, "--checkpoint", file, "--time")
    first, second, on = (answer(capsys, *words, t) for t in (time, time, longer))
    assert first | {"seconds": 0} == second | {"seconds": 0}
    assert (on["time"], on.get("energy")) == (longer, first.get("energy"))
    begun = file.stat().st_mtime_ns
    assert f"a checkpoint of the same {kind} (steps is {there} in it, {here} here)" in refusal(capsys, *words, time)
    assert file.stat().st_mtime_ns == begun
    assert re.search(f"is a checkpoint of (an )?{kind}", refusal(capsys, verb, file, "--time", time))


@pytest.mark.long
@pytest.mark.parametrize(("verb", "samples"), [("gali", "64"), ("orbit", "9")])
def test_the_interrupt_key_keeps_a_run_that_was_not_written_yet(kept, tmp_path, verb, samples):
    """Pressed in a process of its own, while the first checkpoint is seconds away; then the run is gone on with."""
    file, begun = tmp_path / "run", tmp_path / "begun"
    process = subprocess.Popen(
        [sys.executable, "-c", PRESSED, verb, str(kept), "--time", "1e9", "--samples", samples, "--checkpoint", str(file)],
        env=os.environ | {"BEGUN": str(begun)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    while process.poll() is None and not begun.exists():
        time.sleep(0.01)
    assert not file.exists()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (130, "")
    message = rf"symfpu: interrupted: at t = \S+ of 1e\+09; kept in {file}: the same call, or command, goes on from there"
    assert re.fullmatch(message, err.splitlines()[-1])
    body = json.loads(zipfile.ZipFile(file).read("bundle.json"))
    assert 0 < body["steps"] < body["parameters"]["steps"]


def test_an_estimate_grows_with_the_time_and_computes_nothing(capsys, kept, tmp_path):
    words = ("gali", str(kept), "--estimate", "-o", str(tmp_path / "out"))
    out = shown(capsys, *words, "--time", "1e11")
    assert out.startswith("about ")
    assert "hours" in out
    short, long = (json.loads(run(capsys, *words, "--json", "--time", time)[1])["seconds"] for time in ("1e6", "1e9"))
    assert long / short == pytest.approx(1000, rel=COMMANDED_SECONDS)
    assert not (tmp_path / "out").exists()
    assert run(capsys, *words, "--time", "5")[0] == 2


@pytest.mark.long
def test_what_the_torus_foretells_stands_beside(capsys, tmp_path):
    """The closed form and the integrated frame of the same random vectors."""
    file, picture = save(tmp_path / "breather", symfpu.torus(Chain(4, beta=1), (2,), amplitudes={2: "0.4"})), tmp_path / "gali.png"
    arguments = ["gali", file, *split("--time 100 --vectors 3 --frames 1 --step 0.05 --foretold")]
    record = answer(capsys, *arguments, "--plot", picture, "-o", tmp_path / "out")["foretold"]
    assert record["asymptotic_slopes"] == {"2": -1, "3": -2}
    assert record["largest_difference"] < FORETOLD
    assert picture.exists()
    with (tmp_path / "out" / "gali.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    apart = [abs(float(row["log10 GALI_3"]) - float(row["foretold log10 GALI_3"])) for row in rows]
    assert max(apart) < FORETOLD


def test_waves_of_a_ring_foretell(capsys, tmp_path):
    file = save(tmp_path / "wave", symfpu.torus(Chain(5, beta=1, ends="periodic"), (1,), amplitudes={1: "0.4"}))
    words = split("--time 100 --vectors 3 --frames 1 --step 0.05 --foretold")
    assert answer(capsys, "gali", file, *words)["foretold"]["largest_difference"] < FORETOLD


def test_only_tori_foretell(capsys, kept):
    packet = split("gali -N 4 --beta 1 --packet 1 --energy 0.1 --time 300 --foretold")
    assert "leave --foretold out" in refusal(capsys, *packet)
    rough = save(kept.parent / "rough.symfpu", solve_amplitudes(lindstedt(Chain(8, beta=1), (4,), ("1.44",), 1)))
    assert "refine" in refusal(capsys, "gali", rough, "--time", "300", "--foretold")


def test_it_foretells_by_all_normal_modes(capsys, tmp_path, monkeypatch):
    """One that cannot be told from others is named."""
    file, found = tmp_path / "breather", _Search.mode
    save(file, symfpu.torus(Chain(4, beta=1), (2,), amplitudes={2: "0.4"}))
    monkeypatch.setattr(_Search, "mode", lambda search, q, *rest: None if q == 3 else found(search, q, *rest))
    assert "continues mode 3" in refusal(capsys, "gali", file, "--time", "300", "--foretold", code=1)
