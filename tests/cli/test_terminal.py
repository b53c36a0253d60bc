"""Lines that keep their numbers, progress on standard error, and the interrupt key."""

import io
import json
import os
import re
import signal
import subprocess
import sys
import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from symfpu.cli import terminal
from symfpu.cli.main import main
from symfpu.cli.terminal import Bar, Interrupted, Lines, folded, progress_bar
from symfpu.files.progress import NO_FRACTION
from symfpu.paper import targets
from symfpu.paper.claims import PaperFigure
from symfpu.reports.tables import text_table

SOLVE = [
    "solve",
    "-N",
    "16",
    "--alpha",
    "0.33",
    "--seeds",
    "1,2",
    "--omega",
    "0.19626,0.39046",
    "--order",
    "12",
]
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


def test_a_line_that_fits_stays_as_it_is():
    assert folded("seed 1    omega 0.19626", 23) == "seed 1    omega 0.19626"
    digits = "amplitude 0." + 60 * "7"
    assert folded(digits, 40).split() == digits.split()
    assert folded("  residual of the motion 1.2e-05", 22).splitlines() == [
        "  residual of the",
        "      motion 1.2e-05",
    ]


@pytest.mark.parametrize("columns", ["80", "40"])
def test_solve_breaks_no_number(columns, monkeypatch, capsys):
    """As printed in a terminal of so many columns, with the words of the unbroken lines."""
    monkeypatch.delenv("COLUMNS", raising=False)
    monkeypatch.setenv("NO_COLOR", "1")
    assert main([*SOLVE, "--frequency-order", "4"]) == 0
    whole = capsys.readouterr()
    monkeypatch.setenv("COLUMNS", columns)
    assert main([*SOLVE, "--frequency-order", "4"]) == 0
    narrow = capsys.readouterr()
    for before, after in ((whole.out, narrow.out), (whole.err, narrow.err)):
        assert max(map(len, after.splitlines())) <= int(columns)
        assert set(NUMBER.findall(before)) == set(NUMBER.findall(after))
        assert "\x1b" not in after
    assert "0.5980737407432" in narrow.out
    assert sum(line.startswith("  order ") for line in narrow.out.splitlines()) > 1
    assert max(map(len, whole.out.splitlines())) > 80


def test_json_is_the_same_in_every_terminal(monkeypatch, capsys):
    outputs = set()
    for columns in (None, "80", "40"):
        monkeypatch.delenv("COLUMNS", raising=False)
        if columns:
            monkeypatch.setenv("COLUMNS", columns)
        assert main([*SOLVE, "--json"]) == 0
        outputs.add(capsys.readouterr().out)
    [output] = outputs
    assert json.loads(output)["order"] == 12


def test_columns_beyond_the_width_follow_below():
    head, rows = ("k", "first", "second"), [("0", "1.5", "2.25"), ("1", "10.5", "3")]
    assert text_table(head, rows) == ["k  first  second", "0  1.5    2.25", "1  10.5   3"]
    parts = ["k  first", "0  1.5", "1  10.5", "k  second", "0  2.25", "1  3"]
    assert text_table(head, rows, 15) == text_table(head, rows, 3) == parts
    assert text_table(head, rows, 16) == text_table(head, rows)


class Clock:
    """Time that goes when it is told to."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def lines(monkeypatch):
    """Lines by hand: a clock, and no thread that looks on."""
    clock = Clock()
    monkeypatch.setattr(terminal, "monotonic", clock)
    monkeypatch.setattr(terminal, "PATIENCE", 2.0)
    return clock, Lines("series")


def test_lines_have_patience_and_pauses(lines, capsys):
    clock, tell = lines
    for now, done in ((0.5, 0.1), (1.5, 0.3), (2.5, 0.5), (3.0, 0.6), (3.4, 0.7), (3.6, 0.75)):
        clock.now = now
        tell("series", done)
    assert capsys.readouterr().err.splitlines() == [
        "symfpu: 0:00:02 series, 50%, 0:00:02 left",
        "symfpu: 0:00:04 series, 75%, 0:00:01 left",
    ]


def test_pauses_grow_and_silence_ends(lines, capsys):
    clock, tell = lines
    clock.now = 1000.0
    tell("verdict", NO_FRACTION)
    for clock.now in (1005.0, 1009.0):
        tell(f"step at {clock.now:g}", NO_FRACTION)
    assert len(capsys.readouterr().err.splitlines()) == 1
    clock.now = 1010.5
    tell("step at the end", NO_FRACTION)
    for clock.now in (1030.0, 1045.0):
        tell("step at the end", NO_FRACTION)
    assert capsys.readouterr().err.splitlines() == [
        "symfpu: 0:16:50 step at the end",
        "symfpu: 0:17:25 step at the end",
    ]


def test_a_step_whose_numbers_change_waits_longer_than_another(monkeypatch, capsys):
    clock = Clock()
    monkeypatch.setattr(terminal, "monotonic", clock)
    monkeypatch.setattr(terminal, "PATIENCE", 2.0)
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
    assert told == [
        "fig2: GALI, t = 1e+03",
        "fig3: GALI, t = 2e+03",
        "fig2: GALI, t = 4e+03",
    ]


def test_a_step_that_is_silent_has_its_line(monkeypatch, capsys):
    """Told within a pause, shown after it by the thread that looks on, which ends with the bar."""
    monkeypatch.setattr(terminal, "PATIENCE", 0.0)
    monkeypatch.setattr(terminal, "PAUSE", 0.05)
    shown = threading.Event()
    threads = threading.active_count()
    with progress_bar("first") as advance:
        advance("first", NO_FRACTION)
        advance("second", NO_FRACTION)
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


def test_reproduce_tells_its_steps(monkeypatch, capsys, tmp_path):
    def target(folder, progress, *, full=False):
        progress("fig6: patterns", NO_FRACTION)
        progress("fig6: orbit", 0.25)
        return PaperFigure("fig0", "Page", (), ())

    monkeypatch.setitem(targets.TARGETS, "fig6", target)
    monkeypatch.setattr(terminal, "PATIENCE", 0.0)
    monkeypatch.setattr(terminal, "PAUSE", 0.0)
    monkeypatch.setattr(terminal, "SHARE", 0.0)  # every step, however soon it comes after the last one
    assert main(["reproduce", "fig6", "-o", str(tmp_path)]) == 0
    captured = capsys.readouterr()
    told = [line.split(maxsplit=2)[-1] for line in captured.err.splitlines()]
    steps = [re.sub(r", [0-9]+%.*", "", line) for line in told]
    assert steps[-3:] == ["fig6: patterns", "fig6: orbit (25%)", "fig6: pictures"]
    assert all(re.search(r", [0-9]+%", line) for line in told[-3:])
    assert "patterns" not in captured.out


def test_a_bar_has_percentage_and_time_left():
    stream = io.StringIO()
    bar = Bar(Console(file=stream, force_terminal=True, width=80, color_system=None), "series")
    with_bar = stream.getvalue
    with bar:
        for done in (0.1, 0.2, 0.5):
            bar("series", done)
            bar._progress.refresh()
        shown = with_bar()
        bar(
            "a label that is longer than what is left of the line, with [brackets] in it, and so on and on",
            NO_FRACTION,
        )
        bar._progress.refresh()
    assert "50%" in shown
    assert " left" in shown
    lines = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", with_bar()).replace("\r", "\n").splitlines()
    assert max(map(len, lines)) <= 80
    last = [line for line in lines if "a label" in line][-1]
    assert "0:00:0" in last
    assert "left" not in last.split("0:00:0")[1]


def test_the_interrupt_key_says_what_is_kept():
    with pytest.raises(Interrupted, match=r"^interrupted: nothing is kept$"), progress_bar("series"):
        raise KeyboardInterrupt
    with (
        pytest.raises(Interrupted, match=r"^interrupted: half of it$"),
        progress_bar("series", lambda: "half of it"),
    ):
        raise KeyboardInterrupt
    with (
        pytest.raises(Interrupted, match=r"^interrupted: the checkpoint$"),
        progress_bar("series", lambda: "half of it"),
    ):
        raise KeyboardInterrupt("the checkpoint")


@pytest.mark.parametrize(
    ("verb", "function", "kept"),
    [
        (
            ["prove", "-N", "6", "--seeds", "1,2", "--order", "2"],
            "proofs.prove_propagation",
            "nothing is kept",
        ),
        (SOLVE, "solve.lindstedt", "nothing is kept"),
        (
            ["sweep", "--order", "1", "--file", "cases"],
            "proofs.sweep_propagation",
            "cases decided so far are kept in cases",
        ),
        (["sweep", "--order", "1"], "proofs.sweep_propagation", "nothing is kept"),
        (
            ["family", "-N", "8", "--alpha", "0.4", "--seeds", "3", "--to-energy", "0.05", "-o", "out"],
            "families.family",
            "members found so far are kept in out; the same command goes on",
        ),
        (
            ["reproduce", "section5", "fig6", "-o", "out"],
            "reproduce.TARGETS",
            "out/report.md and report.json hold fig6",
        ),
        (
            ["propagate", "-N", "8", "--seeds", "1", "--order", "2"],
            "proofs.excitation_sequence",
            "nothing is kept but",
        ),
    ],
    ids=["prove", "solve", "sweep", "sweep without a file", "family", "reproduce", "propagate"],
)
def test_an_interrupted_verb_is_one_line_and_code_130(verb, function, kept, monkeypatch, capsys, tmp_path):
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
    assert main(verb) == 130
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("symfpu: interrupted: ")
    assert len(captured.err.splitlines()) == 1
    assert kept in captured.err


@pytest.mark.parametrize("verb", ["orbit", "gali"])
def test_an_interrupted_run_names_its_checkpoint(verb, monkeypatch, capsys, tmp_path):
    file, run = str(tmp_path / "torus.symfpu"), tmp_path / "run"
    small = ["-N", "8", "--alpha", "0.3", "--seeds", "1", "--omega", "0.3905", "--order", "4"]
    assert main(["solve", *small, "-o", file]) == 0
    capsys.readouterr()

    def interrupted(*given, **options):
        raise KeyboardInterrupt

    name = {"orbit": "orbit.integrate", "gali": "gali.alignment_indices"}[verb]
    monkeypatch.setattr(f"symfpu.cli.{name}", interrupted)
    command = [verb, file, "--time", "1000", "--checkpoint", str(run)]
    assert main(command) == 130
    assert capsys.readouterr().err == "symfpu: interrupted: nothing is kept\n"
    run.write_text("a checkpoint")
    assert main(command) == 130
    assert str(run) in capsys.readouterr().err


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
