"""Which checker reads which kind of certificate: one line a kind."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from symfpu.checkers import every_length, existence, propagation, stability, torus
from symfpu.checkers.reading import CertificateError, Json, verified

NAMED = re.compile(r'"format":\s*"([^"\\]*)"')
LONGEST_HEAD = 4096  # bytes in which a file names its format


class Checker(NamedTuple):
    """What reads a certificate from a file, and what checks it and says so in lines."""

    read: Callable[[Path], Json]
    check: Callable[[Json], list[str]]


CHECKERS: dict[str, Checker] = {
    propagation.FORMAT: Checker(
        propagation.read_certificate, propagation.check_certificate
    ),
    existence.FORMAT: Checker(existence.read_certificate, existence.check_certificate),
    torus.FORMAT: Checker(torus.read_certificate, torus.check_certificate),
    stability.FORMAT: Checker(stability.read_certificate, stability.check_certificate),
    every_length.FORMAT: Checker(every_length.read_theorem, every_length.check_theorem),
}


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file, whichever kind it is.

    Raises CertificateError, with the reason, if it is not right.
    """
    return verified_certificate(path)[1]


def verified_certificate(path: str | Path) -> tuple[Json, list[str]]:
    """The same with the certificate, which is read once."""
    path = Path(path)
    checker = CHECKERS.get(_named_format(path), CHECKERS[propagation.FORMAT])
    return verified(path, checker.read, checker.check)


def _named_format(path: Path) -> str:
    """That which the head of a file names; each checker reads it again for itself."""
    try:
        if not path.is_file():  # a pipe would wait
            return ""
        with path.open("rb") as file:
            head = file.read(LONGEST_HEAD)
    except OSError as error:
        raise CertificateError(f"{error.strerror}: {path}") from error
    found = NAMED.search(head.decode("ascii", "replace"))
    return found[1] if found else ""
