"""Which checker a certificate belongs to: one for each kind, found by its format."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from symfpu.proofs import verify, verify_theorem

Checker = Callable[[Path], list[str]]
CHECKERS: dict[str, Checker] = {
    "symfpu propagation certificate": verify.verify,
    verify_theorem.FORMAT: verify_theorem.verify,
}
BEGINNING = 200  # bytes in which the format stands


def check(path: Path) -> list[str]:
    """Lines that say what was checked, by the checker of this kind.

    A file whose kind is not known goes to the first, which says what is wrong. Raises
    CertificateError.
    """
    return CHECKERS.get(_format(path), verify.verify)(path)


def _format(path: Path) -> str:
    try:
        with path.open("rb") as file:
            text = file.read(BEGINNING).decode("ascii", "replace")
    except OSError:
        return ""
    found = re.search(r'"format": ?"([^"]*)"', text)
    return found[1] if found else ""
