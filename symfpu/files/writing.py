"""Files written whole or not at all, and folders that can be written.

A regular file is replaced by a draft that was written beside it. A pipe or a device is written to
as it is, and a link leads to its target.
"""

from __future__ import annotations

import csv
import errno
import io
import os
import re
import secrets
import shutil
import stat
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

from symfpu.errors import InputError
from symfpu.files.locking import LOCKS, lock

DRAFT = re.compile(r"\.symfpu-[0-9]+-[0-9a-f]{16}")  # process id, random digits
STANDARD = (1, 2)  # descriptors of standard output and standard error


def write_text(path: Path, text: str) -> None:
    """A text as a file, whole or not at all."""
    write_bytes(path, text.encode())


def write_bytes(path: Path, content: bytes) -> None:
    """The same for a file that is no text."""
    write_file(path, lambda stream: stream.write(content))


def write_rows(path: Path, rows: Iterable[Sequence[Any]]) -> None:
    """A table as comma-separated values, whole or not at all."""
    text = io.StringIO(newline="")
    csv.writer(text).writerows(rows)
    write_text(path, text.getvalue())


def write_file(
    path: Path, write: Callable[[BinaryIO], object], argument: str = "output"
) -> None:
    """What `write` gives to a stream becomes the file; if it fails, the file stays as it was.

    A file that was there keeps its permissions. InputError, with the name and the reason, where
    the system refuses.
    """
    require_name(path, argument)
    try:
        if _is_stream(path):
            with _opened_stream(path) as stream:
                write(stream)
        else:
            _replace(Path(os.path.realpath(path)), write)
    except OSError as error:
        advice = f"choose another ({error.strerror or error})"
        raise InputError(
            argument, str(path), "a file that can be written", advice
        ) from error


def _is_stream(path: Path) -> bool:
    """Whether a path is a pipe, a character device or our own standard output.

    False for a regular file and for a new one; OSError for everything else, and for a file that
    may not be written.
    """
    try:
        found = path.stat()
    except FileNotFoundError:
        return False
    if not os.access(path, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    if stat.S_ISREG(found.st_mode):
        return _standard(found) is not None
    if stat.S_ISDIR(found.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not (stat.S_ISCHR(found.st_mode) or stat.S_ISFIFO(found.st_mode)):
        raise OSError(errno.EINVAL, "neither a file, a pipe nor a character device")
    return True


def _standard(found: os.stat_result) -> int | None:
    """The descriptor of our own standard output or error that a path names, as /dev/stdout does."""
    for descriptor in STANDARD:
        with suppress(OSError):
            if os.path.samestat(os.fstat(descriptor), found):
                return descriptor
    return None


class _OneWay(io.FileIO):
    """A file that is written from its beginning to its end only."""

    def seekable(self) -> bool:
        return False

    def seek(self, *_: Any) -> int:
        raise io.UnsupportedOperation("seek")

    def tell(self) -> int:
        raise io.UnsupportedOperation("tell")


def _opened_stream(path: Path) -> BinaryIO:
    """A pipe or a device as a stream: not created, not cut, and of standard output its own."""
    descriptor = _standard(path.stat())
    if descriptor is None:
        opened = os.open(path, os.O_WRONLY | os.O_NOCTTY)
    else:
        for shown in (sys.stdout, sys.stderr):
            shown.flush()
        opened = os.dup(descriptor)
    return io.BufferedWriter(_OneWay(opened, "wb"))


def _replace(target: Path, write: Callable[[BinaryIO], object]) -> None:
    remove_dead_drafts(target.parent)
    with _draft(target.parent) as (draft, stream):
        write(stream)
        stream.flush()
        _keep_permissions(target, draft)
        os.fsync(stream.fileno())
        if not LOCKS:  # such a system renames no open file
            stream.close()
        os.replace(draft, target)


@contextmanager
def _draft(folder: Path) -> Iterator[tuple[Path, BinaryIO]]:
    """A new file in a folder, locked while it is open: so nobody takes it for a dead one's."""
    while True:
        draft = folder / f".symfpu-{os.getpid()}-{secrets.token_hex(8)}"
        stream = draft.open("xb")
        with suppress(OSError):
            lock(stream)
        if os.fstat(stream.fileno()).st_nlink:  # else removed before it was locked
            break
        stream.close()
    try:
        with stream:
            yield draft, stream
    finally:
        with suppress(OSError):
            draft.unlink(missing_ok=True)


def _keep_permissions(target: Path, draft: Path) -> None:
    """Those of the file that is replaced, and its owner where the system allows it."""
    with suppress(FileNotFoundError):
        found = target.stat()
        with suppress(PermissionError):
            os.chown(draft, found.st_uid, found.st_gid)
        shutil.copymode(target, draft)


def remove_dead_drafts(folder: Path) -> None:
    """Remove what killed processes left half written; those of living ones are locked."""
    if not LOCKS:
        return
    with suppress(OSError), os.scandir(folder) as entries:
        drafts = [folder / entry.name for entry in entries if DRAFT.fullmatch(entry.name)]
        for draft in drafts:
            _remove_if_dead(draft)


def _remove_if_dead(draft: Path) -> None:
    with suppress(OSError):
        if draft.is_symlink() or not draft.is_file():
            return
        with draft.open("r+b") as stream:
            if lock(stream):
                draft.unlink()


def output_folder(path: Path) -> Path:
    """The folder, made if missing; InputError if it cannot be written."""
    try:
        path.mkdir(parents=True, exist_ok=True)
        if not os.access(path, os.W_OK):
            raise PermissionError("no permission to write")
    except OSError as error:
        raise InputError(
            "output",
            str(path),
            "a folder that can be written",
            f"choose another with -o ({error.strerror or error})",
        ) from error
    return path


def made_folder(path: Path, argument: str) -> Path:
    """A folder of a run, made if missing; InputError if it cannot be."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        advice = f"choose another ({getattr(error, 'strerror', None) or error})"
        allowed = "a folder that can be written"
        raise InputError(argument, str(path), allowed, advice) from error
    return path


def output_file(
    path: Path, argument: str = "output", advice: str = "choose another with -o"
) -> Path:
    """The path, if a file can be written there, or if it is a pipe or a character device.

    InputError before anything is computed otherwise.
    """
    allowed = "a file in a folder that exists and can be written"
    try:
        if not path.name:
            raise IsADirectoryError
        if _is_stream(path):
            return path
        folder = Path(os.path.realpath(path)).parent
        if not (folder.is_dir() and os.access(folder, os.W_OK)):
            raise PermissionError
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None)
        told = f"{advice} ({reason})" if reason else advice
        raise InputError(argument, str(path), allowed, told) from error
    return path


def regular_file(path: Path, argument: str, advice: str) -> Path:
    """The same for a file that is read again: a new one, or a regular one."""
    require_regular(path, argument)
    return output_file(path, argument, advice)


def require_regular(path: Path, argument: str = "file") -> None:
    """InputError for a pipe or a device; folders and missing files are left to the system."""
    require_name(path, argument)
    try:
        mode = path.stat().st_mode
    except OSError:
        return
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        advice = "copy what it holds to one"
        raise InputError(argument, str(path), "a regular file", advice)


def require_name(path: Path, argument: str) -> None:
    """InputError for a null byte in a path, and for letters that names of files cannot have."""
    try:
        encoded = os.fsencode(path)
    except UnicodeEncodeError as error:
        advice = f"choose another ({error.reason})"
        raise InputError(argument, str(path), "the name of a file", advice) from error
    if b"\0" in encoded:
        advice = "choose another without null bytes"
        raise InputError(argument, str(path), "the name of a file", advice)


def open_to_read(path: Path, argument: str = "file") -> BinaryIO:
    """A regular file to read, in bytes; InputError for any other, which might never end."""
    require_regular(path, argument)
    return path.open("rb")
