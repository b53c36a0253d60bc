"""Independent checker of certificates of stability: Python integers and fractions alone.

A certificate holds one of existence, which its own checker checks, and for every exponent finitely
many numbers: sigma, the coefficients v of a Floquet solution, a block of places, weights, a radius.
docs/stability-proofs.md states the theorems and proves them; here their hypotheses are computed
anew, each in a function: `theorem.py` has them in order, first the slopes of the bonds, then Y, Z
and Z2 of every exponent, then the count.

Fixed point: an integer times 2^-PLACES unless said. Bounds are rounded up, divisors down; of a
complex number |Re| + |Im| is the norm. The folder shares no code with the prover and imports
nothing but the standard library, the checker of existence and what checkers read and round with.
"""

from pathlib import Path

from symfpu.checkers.reading import verified
from symfpu.checkers.stability.bounds import Bounds as Bounds
from symfpu.checkers.stability.exponent import read_exponent as read_exponent
from symfpu.checkers.stability.orbit import orbit_of as orbit_of
from symfpu.checkers.stability.reading import FORMAT as FORMAT
from symfpu.checkers.stability.reading import read_certificate as read_certificate
from symfpu.checkers.stability.slopes import Slopes as Slopes
from symfpu.checkers.stability.theorem import check_certificate as check_certificate


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file.

    Raises CertificateError, with the reason, if it is not right.
    """
    return verified(path, read_certificate, check_certificate)[1]
