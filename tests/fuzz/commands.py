"""Verbs of the command line with odd words: exit code 0, 1 or 2, one line of complaint, no traceback."""

from functools import cache

import typer

from symfpu.cli.application import app
from symfpu.cli.main import main
from symfpu.cli.verbs import VERBS
from tests.fuzz.values import ODD_NUMBERS, ODD_TEXTS

SOUND = {
    "propagate": "-N 8 --model alpha --seeds 3,5 --order 2",
    "prove": "-N 8 --model beta --seeds 1,4 --order 2",
    "verify": "certificate.json",
    "sweep": "--model beta --longest 4 --order 1",
    "term": "-N N --alpha 1 --seeds 1,2 -q 3 --order 2",
    "solve": "-N 8 --alpha 0.3 --seeds 1,2 --omega 0.3903,0.7655 --order 3",
    "show": "torus.symfpu",
    "refine": "torus.symfpu",
    "family": "-N 8 --alpha 0.3 --seeds 1 --to-energy 0.0003 --members 3",
    "actions": "torus.symfpu",
    "stability": "torus.symfpu",
    "certify": "torus.symfpu",
    "orbit": "torus.symfpu --time 20 --samples 4",
    "frequencies": "torus.symfpu --time 300",
    "gali": "torus.symfpu --time 200 --samples 64",
    "export": "torus.symfpu --lang numpy -o exported",
}
LEFT_OUT = {"atlas", "reproduce", "workbench"}  # long by their nature, and a server
RARELY = {"family", "sweep", "certify"}
assert SOUND.keys() | LEFT_OUT == VERBS.keys()


@cache
def options(verb):
    """Names of the options of a verb that take a value."""
    group = typer.main.get_command(app)
    context = group.make_context("symfpu", [verb], resilient_parsing=True)
    _, command, _ = group.resolve_command(context, [verb])
    return sorted(part.opts[0] for part in command.params if part.opts[0].startswith("-") and not getattr(part, "is_flag", False))


def chosen(draw):
    """A verb and its words: sound ones, some of them replaced or added with an odd value."""
    verb = draw.choice(sorted(SOUND))
    if verb in RARELY and draw.random() < 0.8:
        verb = "solve"
    words = SOUND[verb].split()
    for _ in range(draw.choice((0, 1, 1, 2))):
        option, value = draw.choice(options(verb) or ["--json"]), odd(draw)
        if not is_long(option, value):
            words = changed(words, option, value, draw)
    if draw.random() < 0.3:
        words.append("--json")
    return verb, words


def is_long(option, value):
    """Whether an orbit of this time is a run of hours, which nobody refuses."""
    return option == "--time" and value.isdecimal() and 10**6 < int(value) < 2**52


def changed(words, option, value, draw):
    """Words with another value of an option, or of the file that comes first."""
    if not words[0].startswith("-") and draw.random() < 0.2:
        return [value, *words[1:]]
    if option in words:
        place = words.index(option) + 1
        return [*words[:place], value, *words[place + 1 :]]
    return [*words, option, value]


def odd(draw):
    """A word that is odd; never the name of a file outside this folder."""
    if draw.random() < 0.3:
        return draw.choice(ODD_TEXTS)
    number = draw.choice(ODD_NUMBERS)
    return f"10{'0' * 400}" if isinstance(number, int) and abs(number) > 10**30 else str(number)


def run(verb, words):
    """The exit code."""
    return main([verb, *words])
