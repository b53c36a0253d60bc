"""Lines that keep their numbers, progress on standard error, and the interrupt key."""

import io
import json
import math
import os
import re
import signal
import subprocess
import sys
import threading
from shlex import split

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from symfpu.cli import terminal
from symfpu.cli.main import main
from symfpu.cli.terminal import Bar, Interrupted, Lines, folded, progress_bar
from symfpu.paper import targets
from symfpu.paper.claims import PaperFigure
from tests.cli.running import refusal, run, shown

SOLVE = split("solve -N 16 --alpha 0.33 --seeds 1,2 --omega 0.19626,0.39046 --order 12")
NUMBER = re.compile(r"[-+]?\d[\d.,]*(?:e[-+]?\d+)?")


def words(text):
    return text.split()


@given(st.lists(st.text("0123456789.e-+, (x)", min_size=0, max_size=120), max_size=5), st.integers(20, 100))
def test_folding_keeps_every_word(lines, width):
    text = "\n".join(lines)
    shown = folded(text, width)
    assert words(shown) == words(text)
    assert all(len(line) <= width or len(line.split()) == 1 for line in shown.splitlines())
    assert folded(text, None) == text


@pytest.mark.parametrize("columns", ["80", "40"])
def test_solve_breaks_no_number(columns, monkeypatch, capsys):
    """As printed in a terminal of so many columns, with the words of the unbroken lines."""
    monkeypatch.delenv("COLUMNS", raising=False)
    monkeypatch.setenv("NO_COLOR", "1")
    _, whole, told = run(capsys, *SOLVE, "--frequency-order", "4")
    monkeypatch.setenv("COLUMNS", columns)
    _, narrow, _ = run(capsys, *SOLVE, "--frequency-order", "4")
    assert max(map(len, narrow.splitlines())) <= int(columns)
    assert set(NUMBER.findall(whole)) == set(NUMBER.findall(narrow))
    assert "\x1b" not in narrow
    assert told == ""
    assert "0.5980737407432" in narrow
    assert sum(line.startswith("  order ") for line in narrow.splitlines()) > 1
    assert max(map(len, whole.splitlines())) > 80


def test_json_is_the_same_in_every_terminal(monkeypatch, capsys):
    outputs = set()
    for columns in (None, "80", "40"):
        monkeypatch.delenv("COLUMNS", raising=False)
        if columns:
            monkeypatch.setenv("COLUMNS", columns)
        outputs.add(shown(capsys, *SOLVE, "--json"))
    [output] = outputs
    assert json.loads(output)["order"] == 12


class Clock:
    """Time that goes when it is told to."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock(monkeypatch):
    """Time by hand, for lines without a thread that looks on."""
    clock = Clock()
    monkeypatch.setattr(terminal, "monotonic", clock)
    monkeypatch.setattr(terminal, "PATIENCE", 2.0)
    return clock


def test_lines_have_patience_and_pauses(clock, capsys):
    tell = Lines("series")
    for now, done in ((0.5, 0.1), (1.5, 0.3), (2.5, 0.5), (3.0, 0.6), (3.4, 0.7), (3.6, 0.75)):
        clock.now = now
        tell("series", done)
    assert capsys.readouterr().err.splitlines() == [
        "symfpu: 0:00:02 series, 50%, 0:00:02 left",
        "symfpu: 0:00:04 series, 75%, 0:00:01 left",
    ]


def test_pauses_grow_and_silence_ends(clock, capsys):
    tell = Lines("series")
    clock.now = 1000.0
    tell("verdict", math.nan)
    for clock.now in (1005.0, 1009.0):
        tell(f"step at {clock.now:g}", math.nan)
    assert len(capsys.readouterr().err.splitlines()) == 1
    clock.now = 1010.5
    tell("step at the end", math.nan)
    for clock.now in (1030.0, 1045.0):
        tell("step at the end", math.nan)
    assert capsys.readouterr().err.splitlines() == [
        "symfpu: 0:16:50 step at the end",
        "symfpu: 0:17:25 step at the end",
    ]


def test_a_step_whose_numbers_change_waits_longer_than_another(clock, capsys):
    tell = Lines("first", again=5.0)
    clock.now = 2.5
    tell("fig2: GALI, t = 1e+03 of 1e+07 (1%)", 0.1)
    clock.now = 5.0
    tell("fig2: GALI, t = 2e+03 of 1e+07 (2%)", 0.2)  # the same words, too soon
    tell("fig3: GALI, t = 2e+03 of 1e+07 (2%)", 0.2)
    clock.now = 9.0
    tell("fig2: GALI, t = 3e+03 of 1e+07 (3%)", 0.3)
    clock.now = 10.5
    tell("fig2: GALI, t = 4e+03 of 1e+07 (4%)", 0.4)
    told = [line.split(maxsplit=2)[-1].split(" of")[0] for line in capsys.readouterr().err.splitlines()]
    assert told == ["fig2: GALI, t = 1e+03", "fig3: GALI, t = 2e+03", "fig2: GALI, t = 4e+03"]


def test_a_step_that_is_silent_has_its_line(monkeypatch, capsys):
    """Told within a pause, shown after it by the thread that looks on, which ends with the bar."""
    monkeypatch.setattr(terminal, "PATIENCE", 0.0)
    monkeypatch.setattr(terminal, "PAUSE", 0.05)
    shown = threading.Event()
    threads = threading.active_count()
    with progress_bar("first") as advance:
        advance("first", math.nan)
        advance("second", math.nan)
        shown.wait(1.0)
    assert [line.split()[-1] for line in capsys.readouterr().err.splitlines()] == ["first", "second"]
    assert threading.active_count() == threads


def test_standard_output_hears_nothing_of_progress(monkeypatch, capsys):
    monkeypatch.setattr(terminal, "PATIENCE", 0.0)
    monkeypatch.setattr(terminal, "PAUSE", 0.0)
    assert main([*SOLVE, "--json"]) == 0
    captured = capsys.readouterr()
    assert json.loads(captured.out)["verdict"] == "undecided"
    told = captured.err.splitlines()
    assert all(line.startswith("symfpu: 0:00:") for line in told)
    for step in ("series", "amplitudes", "verdict"):
        assert any(step in line for line in told)


def test_the_interrupt_key_says_what_is_kept():
    half = lambda: "half of it"  # noqa: E731
    for keeps, said, kept in (((), (), "nothing is kept"), ((half,), (), "half of it"), ((half,), ("the checkpoint",), "the checkpoint")):
        with pytest.raises(Interrupted, match=f"^interrupted: {kept}$"), progress_bar("series", *keeps):
            raise KeyboardInterrupt(*said)


# what is typed, the function that is interrupted, and what the line says
MEMBERS = "members found so far are kept in out; the same command goes on"
INTERRUPTED = {
    "prove -N 6 --seeds 1,2 --order 2": ("proofs.prove_propagation", "nothing is kept"),
    " ".join(SOLVE): ("solve.series_torus", "nothing is kept"),
    "sweep --order 1 --file cases": ("proofs.sweep_propagation", "cases decided so far are kept in cases"),
    "sweep --order 1": ("proofs.sweep_propagation", "nothing is kept"),
    "family -N 8 --alpha 0.4 --seeds 3 --to-energy 0.05 -o out": ("families.family", MEMBERS),
    "reproduce section5 fig6 -o out": ("reproduce.TARGETS", "out/report.md and report.json hold fig6"),
    "propagate -N 8 --seeds 1 --order 2": ("proofs.excitation_sequence", "nothing is kept but"),
}


@pytest.mark.parametrize("typed", INTERRUPTED)
def test_an_interrupted_verb_is_one_line_and_code_130(typed, monkeypatch, capsys, tmp_path):
    function, kept = INTERRUPTED[typed]

    def interrupted(*given, **options):
        (tmp_path / "cases").write_text("")
        (tmp_path / "out").mkdir(exist_ok=True)
        (tmp_path / "out" / "member-0001.symfpu").write_text("")
        raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    if function.endswith("TARGETS"):
        page = PaperFigure("fig0", "Page", (), ())
        monkeypatch.setattr("symfpu.paper.side_by_side.available_cores", lambda: 1)
        monkeypatch.setitem(targets.TARGETS, "fig6", lambda folder, progress, *, full=False: page)
        monkeypatch.setitem(targets.TARGETS, "section5", interrupted)
    else:
        monkeypatch.setattr(f"symfpu.cli.{function}", interrupted)
    err = refusal(capsys, *typed.split(), code=130)
    assert err.startswith("symfpu: interrupted: ")
    assert kept in err


@pytest.mark.parametrize("verb", ["orbit", "gali"])
def test_an_interrupted_run_names_its_checkpoint(verb, monkeypatch, capsys, tmp_path):
    file, checkpoint = str(tmp_path / "torus.symfpu"), tmp_path / "run"
    shown(capsys, *split("solve -N 8 --alpha 0.3 --seeds 1 --omega 0.3905 --order 4 -o"), file, quiet=False)

    def interrupted(*given, **options):
        raise KeyboardInterrupt

    name = {"orbit": "orbit.integrate", "gali": "gali.alignment_indices"}[verb]
    monkeypatch.setattr(f"symfpu.cli.{name}", interrupted)
    command = [verb, file, "--time", "1000", "--checkpoint", str(checkpoint)]
    assert refusal(capsys, *command, code=130) == "symfpu: interrupted: nothing is kept\n"
    checkpoint.write_text("a checkpoint")
    assert str(checkpoint) in refusal(capsys, *command, code=130)


@pytest.mark.long
def test_the_key_itself(tmp_path):
    """A real interruption of a real process, while a worker of it, if there are cores, follows an orbit."""
    command = [sys.executable, "-m", "symfpu", "reproduce", "fig6", "fig7", "-o", str(tmp_path)]
    surroundings = os.environ | {"COLUMNS": ""}
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=surroundings) as process:
        heard = []
        for line in process.stderr:
            heard.append(line)
            if "1 of 2 done; fig7" in line:
                process.send_signal(signal.SIGINT)
                break
        heard += process.stderr.readlines()
        output = process.stdout.read()
        code = process.wait(timeout=60)
    assert (code, output) == (130, "")
    assert heard[-1] == f"symfpu: interrupted: {tmp_path}/report.md and report.json hold fig6\n"
    assert all(line.startswith("symfpu: 0:") for line in heard[:-1])


def test_a_bar_has_percentage_and_time_left():
    stream = io.StringIO()
    bar = Bar(Console(file=stream, force_terminal=True, width=80, color_system=None), "series")
    with_bar = stream.getvalue
    with bar:
        for done in (0.1, 0.2, 0.5):
            bar("series", done)
            bar._progress.refresh()
        shown = with_bar()
        bar("a label that is longer than what is left of the line, with [brackets] in it, and so on and on", math.nan)
        bar._progress.refresh()
    assert "50%" in shown
    assert " left" in shown
    lines = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", with_bar()).replace("\r", "\n").splitlines()
    assert max(map(len, lines)) <= 80
    last = [line for line in lines if "a label" in line][-1]
    assert "0:00:0" in last
    assert "left" not in last.split("0:00:0")[1]
