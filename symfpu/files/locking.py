"""Locks of files: the system releases them when a process ends, however it ends."""

from __future__ import annotations

import errno
import hashlib
import os
import platform
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import IO, Any

from symfpu.errors import InputError

try:
    import fcntl
except ImportError:  # no locks of this kind: the user sees to it that one process writes
    fcntl = None  # type: ignore[assignment]

LOCKS = fcntl is not None
NO_LOCKS = "this file system has no locks: let one process at a time write there"


def lock(stream: IO[Any]) -> bool:
    """Whether the file is locked for this stream now; False where another one has the lock.

    OSError where the file system knows no locks.
    """
    if fcntl is None:
        return True
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


@contextmanager
def one_run(
    *paths: Path | None, run: str = "run", argument: str = "file"
) -> Iterator[None]:
    """One run at a time has these files or folders; InputError, with who has one, for a second.

    The lock is a hidden file beside a file, in a folder. It goes with the run; one that a killed
    process left does not count. None for nothing to lock.
    """
    with ExitStack() as held:
        for path in paths:
            if path is not None:
                held.enter_context(_locked(path, run, argument))
        yield


@contextmanager
def _locked(path: Path, run: str, argument: str) -> Iterator[None]:
    file = _lock_file(path)
    opened = _opened(file, path, argument)
    if opened is None:  # nothing can be written there, by no run
        yield
        return
    stream, free = opened
    with stream:
        if not free:
            kind = "folder" if path.is_dir() else "file"
            allowed = f"a {kind} that no other run writes"
            who = _owner(stream)
            advice = f"{who} has it: wait for the other {run}, or name another {kind}"
            raise InputError(argument, str(path), allowed, advice)
        stream.truncate(0)
        stream.write(f"process {os.getpid()} on {platform.node()}")
        stream.flush()
        try:
            yield
        finally:
            with suppress(OSError):
                file.unlink()


def _lock_file(path: Path) -> Path:
    """In a folder, or beside a file: the same for all names of one file."""
    if path.is_dir():
        return path / ".symfpu-lock"
    target = Path(os.path.realpath(path))
    name = hashlib.sha256(os.fsencode(target.name)).hexdigest()[:16]
    return target.with_name(f".symfpu-lock-{name}")


def _opened(file: Path, path: Path, argument: str) -> tuple[IO[str], bool] | None:
    """The lock file, and whether it was free and is locked now; None where it cannot be made."""
    try:
        return _taken(file)
    except OSError as error:
        if error.errno in (errno.EACCES, errno.EROFS):
            return None
        advice = f"choose another ({error.strerror})"
        allowed = "a place that can be written"
        raise InputError(argument, str(path), allowed, advice) from error


def _taken(file: Path) -> tuple[IO[str], bool]:
    """The same; not the file that another run removed as it ended in the meantime."""
    while True:
        stream = file.open("a+")
        free = _free(stream)
        with suppress(FileNotFoundError):
            if not free or os.path.samestat(os.fstat(stream.fileno()), file.stat()):
                return stream, free
        stream.close()


def _free(stream: IO[str]) -> bool:
    """Whether this stream has the lock; where the system has no locks, with a warning."""
    try:
        return lock(stream)
    except OSError as error:
        warnings.warn(f"{NO_LOCKS} ({error.strerror})", RuntimeWarning, stacklevel=2)
        return True


def _owner(stream: IO[str]) -> str:
    """What the other run wrote of itself."""
    stream.seek(0)
    said = stream.read(100)
    return said if said.isprintable() and said else "another process"
