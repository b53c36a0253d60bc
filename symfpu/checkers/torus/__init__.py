"""Independent checker of certificates of tori: Python integers and fractions alone.

A certificate names a chain, frequencies and finitely many numbers x_j[nu]; the first claim is how
well the torus of these numbers solves the equations of motion, at all angles. If it names a frame
beside it, the second is how near to the torus an orbit stays that starts on it, and for how long.
docs/tori-proofs.md states the theorems and proves them; here every bound is computed anew, each
in a function: `theorem.py` has them in order.

A series is sum a[nu] exp(i nu.theta) with real a[nu], integers times 2^-places, and a bound of
what it is off by in the norm sum |a[nu]|, in units of the last place. With p = i y a state of the
chain has real series x_j, y_j. Bounds are rounded up. The folder shares no code with the prover and
imports nothing but the standard library and what checkers read and round with.
"""

from pathlib import Path

from symfpu.checkers.reading import verified
from symfpu.checkers.torus.reading import FORMAT as FORMAT
from symfpu.checkers.torus.reading import read_certificate as read_certificate
from symfpu.checkers.torus.series import Packing as Packing
from symfpu.checkers.torus.series import Series as Series
from symfpu.checkers.torus.series import product as product
from symfpu.checkers.torus.theorem import check_certificate as check_certificate


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file.

    Raises CertificateError, with the reason, if it is not right.
    """
    return verified(path, read_certificate, check_certificate)[1]
