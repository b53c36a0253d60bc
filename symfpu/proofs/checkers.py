"""Which checker reads which kind of certificate: one line a kind.

The checkers share no code with the provers, and none with each other.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from symfpu.proofs import check_existence, verify, verify_theorem
from symfpu.proofs.verify import CertificateError

Checker = Callable[[Path], list[str]]

CHECKERS: dict[str, Checker] = {
    "symfpu propagation certificate": verify.verify,
    "symfpu existence certificate": check_existence.verify,
    verify_theorem.FORMAT: verify_theorem.verify,
}
PROPAGATION = "symfpu propagation certificate"
KIND = re.compile(r'"format":\s*"([^"\\]*)"')
LONGEST_HEAD = 4096  # characters in which a file names its kind


def verify_certificate(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file, whichever kind it is.

    Raises CertificateError, with the reason, if it is not right.
    """
    path = Path(path)
    checker = CHECKERS.get(kind_of(path), CHECKERS[PROPAGATION])
    try:
        return checker(path)
    except CertificateError:
        raise
    except check_existence.ExistenceError as error:
        raise CertificateError(str(error)) from error


def kind_of(path: Path) -> str:
    """The kind that the head of a file names; each checker reads it again for itself."""
    try:
        with path.open(encoding="ascii", errors="replace") as file:
            found = KIND.search(file.read(LONGEST_HEAD))
    except OSError:
        return ""
    return found[1] if found else ""
