"""The command line in this process: what it prints, and its refusals of one line."""

import json

from symfpu.cli.main import main


def run(capsys, *argv):
    """The exit code, standard output and standard error."""
    code = main(list(map(str, argv)))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def shown(capsys, *argv, quiet=True):
    """What a command prints that succeeds; quiet : without a word on standard error."""
    code, out, err = run(capsys, *argv)
    assert (code, err if quiet else "") == (0, ""), err
    return out


def answer(capsys, *argv, quiet=True):
    """The record that a command prints with --json, as a strict reader takes it."""
    return strict(shown(capsys, *argv, "--json", quiet=quiet))


def strict(text):
    """JSON without NaN and Infinity."""

    def refuse(word):
        raise AssertionError(word)

    return json.loads(text, parse_constant=refuse)


def refusal(capsys, *argv, code=2):
    """The one line on standard error; nothing on the other."""
    found, out, err = run(capsys, *argv)
    assert (found, out) == (code, ""), err
    assert len(err.splitlines()) == 1
    assert err.startswith("symfpu: ")
    assert "Traceback" not in err
    return err
