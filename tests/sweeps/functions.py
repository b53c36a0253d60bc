"""Functions for sweeps in other processes: they work, fail, eat memory and die."""

import os
import resource
import signal
import sys
import time
from pathlib import Path

from symfpu import InputError


def square(n, *, shift=0):
    if n < 0:
        raise InputError("n", n, "0 or more", "take its size")
    return {"square": n * n + shift, "root": n**0.5}


def slow_square(n, seconds):
    time.sleep(seconds)
    return {"square": n * n}


def deadly_square(n):
    """Cases 3 and 5 end their process, by exit and by signal."""
    if n == 3:
        os._exit(7)
    if n == 5:
        os.kill(os.getpid(), signal.SIGKILL)
    return n * n


def told_square(n, *, progress, deadly=False):
    progress("begun", 0.0)
    if deadly:
        os._exit(7)
    progress("squared", 0.5)
    return n * n


def square_in_little_memory(n, numbers):
    """So many doubles in a process that may take 600 MB more than it has."""
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + 600_000_000, resource.RLIM_INFINITY))
    held = bytearray(8 * numbers)
    return n * n + held[0]


def rows_so_far(n, file=None):
    """How many rows a file has when a case is at work."""
    return len(Path(file).read_text().splitlines()) - 1


def mark_and_sleep(file):
    Path(file).write_text(str(os.getpid()))
    time.sleep(60)


def coupling_of(chain, mode=1):
    return {"alpha": chain.alpha, "omega": chain.frequencies()[mode - 1]}


def lists(modes, length):
    numbers = list(range(length))
    return {"short": modes, "long": numbers, "nested": [modes], "sum": sum(numbers)}


def strange(n):
    return [object(), float("nan"), 1j, n][n]


if __name__ == "__main__":  # the driver of the kill tests: FILE CASES SECONDS
    from symfpu import sweep
    from tests.sweeps import functions

    cases = [{"n": n} for n in range(int(sys.argv[2]))]
    sweep(functions.slow_square, cases, fixed={"seconds": float(sys.argv[3])}, file=sys.argv[1])
