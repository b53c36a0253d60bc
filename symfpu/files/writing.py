"""Writing results: whole or not at all, and into folders that exist."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from symfpu.errors import InputError


def write_text(path: Path, text: str) -> None:
    """Write a file through a temporary one beside it, so that it is never half written."""
    _write(path, lambda draft: draft.write_text(text))


def write_bytes(path: Path, content: bytes) -> None:
    """The same for a file that is no text."""
    _write(path, lambda draft: draft.write_bytes(content))


def _write(path: Path, write: Callable[[Path], object]) -> None:
    if not path.name:
        raise InputError("output", str(path), "the name of a file", "name one")
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        write(draft)
        draft.replace(path)
    except OSError as error:
        draft.unlink(missing_ok=True)
        raise InputError(
            "output",
            str(path),
            "a file that can be written",
            f"choose another ({error.strerror})",
        ) from error


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


def output_file(
    path: Path, argument: str = "output", advice: str = "choose another with -o"
) -> Path:
    """The path, if a file can be written there.

    InputError before anything is computed otherwise.
    """
    folder = path.parent
    writable = folder.is_dir() and os.access(folder, os.W_OK)
    if not path.name or path.is_dir() or not writable:
        allowed = "a file in a folder that exists and can be written"
        raise InputError(argument, str(path), allowed, advice)
    return path
