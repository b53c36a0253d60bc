"""What the system does to files: it fails, has no room, and hands them through pipes."""

import os
import resource
import threading
from contextlib import contextmanager


def raising(error):
    """A function that raises the error, whatever it is given."""

    def function(*given, **options):
        raise error

    return function


def of_system(number):
    """The error that the system tells by this number of `errno`."""
    return OSError(number, os.strerror(number))


@contextmanager
def files_up_to(size):
    """Files of so many bytes at most; the system tells this limit as it tells a full disk."""
    usual = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, usual[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, usual)


@contextmanager
def read_from(pipe):
    """A list that holds, at the end, what was written to a new pipe of this name."""
    heard = []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: heard.append(pipe.read_bytes()))
    reader.start()
    yield heard
    reader.join()
