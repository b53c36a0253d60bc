"""Runs that are stopped on their way and begun again."""


class Stopped(Exception):
    """In place of a kill."""


def stopped_at(count):
    """A listener that stops a run at its look of this number."""

    def progress(label, fraction):
        nonlocal count
        count -= 1
        if count == 0:
            raise Stopped

    return progress


def resumed(run, count):
    """What a run ends with that is stopped at every look of this number, and how often it began."""
    begun = 0
    while True:
        begun += 1
        try:
            return run(progress=stopped_at(count)), begun
        except Stopped:
            continue
