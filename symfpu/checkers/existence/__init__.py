"""Independent checker of certificates of existence: Python integers and fractions alone.

A certificate names a chain, a frequency and finitely many numbers c_q[n]; the claim is that the
chain has a periodic orbit near them, of exactly this frequency, amplitude or energy, or one for
each value of an interval. docs/existence.md states the theorem and proves it; here its bounds are
computed anew, each in a function: `theorem.py` has the hypotheses, in order.

Fixed point: a number is an integer times 2^-P, FINE places for the residual and COARSE for all
else. A series is its cosine coefficients and the bound of their error in the norm
sum |a_n| nu^n, in units of the last place. Bounds are rounded up, divisors down. The folder shares
no code with the prover and imports nothing but the standard library and what checkers read and
round with, `reading.py` and `rounding.py`.
"""

from pathlib import Path

from symfpu.checkers.existence.bonds import Bonds as Bonds
from symfpu.checkers.existence.bounds import Bounds as Bounds
from symfpu.checkers.existence.claim import read_claim as read_claim
from symfpu.checkers.existence.fixed_point import COSINE_UNITS as COSINE_UNITS
from symfpu.checkers.existence.fixed_point import Cosines as Cosines
from symfpu.checkers.existence.inverse import Packed as Packed
from symfpu.checkers.existence.inverse import read_inverse as read_inverse
from symfpu.checkers.existence.reading import FORMAT as FORMAT
from symfpu.checkers.existence.reading import KIND as KIND
from symfpu.checkers.existence.reading import read_certificate as read_certificate
from symfpu.checkers.existence.theorem import check_certificate as check_certificate
from symfpu.checkers.reading import verified


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file.

    Raises CertificateError, with the reason, if it is not right.
    """
    return verified(path, read_certificate, check_certificate)[1]
