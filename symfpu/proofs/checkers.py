"""Which checker reads which kind of certificate: one line a kind.

The checkers share no code with the provers; that of stability asks that of existence.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from symfpu.files.formats import format_of, opened_by
from symfpu.proofs import (
    check_every_length,
    check_existence,
    check_propagation,
    check_stability,
    check_torus,
)
from symfpu.proofs.reading import CertificateError, Json, verified


class Checker(NamedTuple):
    """What reads a certificate from a file, and what checks it and says so in lines."""

    read: Callable[[Path], Json]
    check: Callable[[Json], list[str]]


CHECKERS: dict[str, Checker] = {
    check_propagation.FORMAT: Checker(
        check_propagation.read_certificate, check_propagation.check_certificate
    ),
    check_existence.FORMAT: Checker(
        check_existence.read_certificate, check_existence.check_certificate
    ),
    check_torus.FORMAT: Checker(
        check_torus.read_certificate, check_torus.check_certificate
    ),
    check_stability.FORMAT: Checker(
        check_stability.read_certificate, check_stability.check_certificate
    ),
    check_every_length.FORMAT: Checker(
        check_every_length.read_theorem, check_every_length.check_theorem
    ),
}


def verify_certificate(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file, whichever kind it is.

    Raises CertificateError, with the reason, if it is not right.
    """
    return verified_certificate(path)[1]


def verified_certificate(path: str | Path) -> tuple[Json, list[str]]:
    """The same with the certificate, which is read once."""
    path = Path(path)
    checker = checker_of(path)
    return verified(path, checker.read, checker.check)


def checker_of(path: Path) -> Checker:
    """That of the kind which the head of a file names; each checker reads it again for itself."""
    try:
        kind = format_of(path)
    except OSError as error:
        raise CertificateError(f"{error.strerror}: {path}") from error
    advice = opened_by(kind)
    if kind in CHECKERS or advice is None:
        return CHECKERS.get(kind, CHECKERS[check_propagation.FORMAT])
    raise CertificateError(f"its format is {kind!r}: {advice}")
