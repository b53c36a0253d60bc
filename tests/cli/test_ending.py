"""How the command line ends: the interrupt key at any moment, standard output that is closed or full."""

import errno
import os
import signal
import subprocess
import sys
import time
from shlex import split

import pytest

from symfpu.cli.main import main
from tests.system import of_system, raising

VERB = split("propagate -N 8 --seeds 1 --order 2")
SOLVE = split("solve -N 16 --alpha 0.33 --seeds 1,2 --omega 0.19626,0.39046 --order 30")
BEGUN = "print('begun', flush=True)"
RUN = "import sys; sys.argv = ['symfpu', *{verb}]; from symfpu.cli.main import run; {before}; run()"
AT_IMPORT = """
import os, signal
def look(event, given):
    if event == "import" and given[0] == "{module}":
        os.kill(os.getpid(), signal.SIGINT)
sys.addaudithook(look)
"""
LINE = "symfpu: interrupted: nothing is kept but what was already written\n"


def program(verb, before="pass"):
    return [sys.executable, "-c", RUN.format(verb=verb, before=before)]


def ended(command):
    """The code, standard output and standard error of a process."""
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    return process.returncode, process.stdout, process.stderr


def interrupted_at_import(verb, module):
    return ended(program(verb, f"exec({AT_IMPORT.format(module=module)!r})"))


@pytest.mark.parametrize("module", ["symfpu.cli.application", pytest.param("rich.progress", marks=pytest.mark.long)])
def test_the_interrupt_key_while_modules_are_loaded(module):
    assert interrupted_at_import(VERB, module) == (130, "", LINE)


@pytest.mark.long
@pytest.mark.parametrize("module", ["typer", "numpy", "symfpu.series.lindstedt", "scipy.special", "numba.core"])
def test_the_interrupt_key_while_a_verb_is_loaded(module):
    code, out, err = interrupted_at_import(SOLVE, module)
    assert (code, out) == (130, "")
    *told, last = err.splitlines()
    assert last.startswith("symfpu: interrupted: nothing is kept")
    assert all("series" in line for line in told)  # progress


AT_A_CLASS = """
import dataclasses, sys
def interrupt(*given):
    raise KeyboardInterrupt
def look(event, given):
    if event == "import" and given[0] == "symfpu.cli.chains":
        dataclasses.Field.__set_name__ = interrupt
sys.addaudithook(look)
"""


def test_the_interrupt_key_while_a_class_is_made():
    """Python 3.11 turns it into a RuntimeError there."""
    assert ended(program(SOLVE, f"exec({AT_A_CLASS!r})")) == (130, "", LINE)


@pytest.mark.long
@pytest.mark.parametrize("delay", [0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.5])
def test_the_interrupt_key_after_a_while(delay):
    begun = program(SOLVE, BEGUN)
    with subprocess.Popen(begun, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        assert running.stdout.readline() == "begun\n"
        time.sleep(delay)
        running.send_signal(signal.SIGINT)
        out, err = running.communicate()
    assert "Traceback" not in err
    if running.returncode == 0:  # it was done before
        assert "verdict" in out
    else:
        assert (running.returncode, out) == (130, "")
        assert err.splitlines()[-1].startswith("symfpu: interrupted: nothing is kept")


@pytest.mark.long
def test_a_command_that_was_begun_without_the_interrupt_key_does_not_hear_it():
    """As behind nohup, or in the background of a script."""
    before = f"import signal; signal.signal(signal.SIGINT, signal.SIG_IGN); {BEGUN}"
    with subprocess.Popen(program(VERB, before), stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout.readline() == "begun\n"
        running.send_signal(signal.SIGINT)
        out, _ = running.communicate()
    assert running.returncode == 0
    assert out.strip()


def test_closed_standard_output_is_refused_before_anything_is_computed(capsys, monkeypatch):
    with monkeypatch.context() as patched:
        patched.setattr(sys, "stdout", None)
        assert main(VERB) == 2
    assert capsys.readouterr().err == "symfpu: standard output is closed: send it to a file or to /dev/null\n"


@pytest.mark.long
def test_closed_streams_of_a_process():
    def with_closed(streams, verb):
        return ended(["sh", "-c", f'exec "$@" {streams}', "sh", *program(verb)])

    code, _, err = with_closed(">&-", VERB)
    assert (code, len(err.splitlines())) == (2, 1)
    assert "standard output is closed" in err
    assert with_closed("2>&-", ["conquer"]) == (2, "", "")
    assert with_closed(">&- 2>&-", VERB)[0] == 2


@pytest.mark.parametrize("many", [1, 1000])
def test_a_full_disk_under_standard_output_is_named(many, capsys, monkeypatch):
    """At the end, where little was printed, and in the middle, where more was than waits."""
    with open("/dev/full", "w") as full, monkeypatch.context() as patched:
        patched.setattr(sys, "stdout", full)
        patched.setattr("symfpu.cli.terminal.folded", lambda text, width: many * text)
        assert main(VERB) == 2
    assert capsys.readouterr().err == "symfpu: standard output: No space left on device; send it elsewhere\n"


@pytest.mark.parametrize("many", [1, 1000])
def test_a_reader_that_has_heard_enough_ends_the_command_in_silence(many, capsys, monkeypatch):
    there, here = os.pipe()
    os.close(there)
    with open(here, "w") as pipe, monkeypatch.context() as patched:
        patched.setattr(sys, "stdout", pipe)
        patched.setattr("symfpu.cli.terminal.folded", lambda text, width: many * text)
        assert main(VERB) == 1
    assert capsys.readouterr().err == ""


def test_an_error_of_the_system_without_a_name_is_told(capsys, monkeypatch):
    monkeypatch.setattr("symfpu.cli.proofs.excitation_sequence", raising(of_system(errno.EIO)))
    assert main(VERB) == 2
    assert capsys.readouterr().err == "symfpu: the system refuses: Input/output error\n"
