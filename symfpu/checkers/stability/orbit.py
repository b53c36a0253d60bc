"""The orbit whose stability is claimed: its own checker proves it, and what its symmetry allows."""

from fractions import Fraction
from typing import NamedTuple

from symfpu.checkers import existence as check_existence
from symfpu.checkers.existence.claim import Claim, Force
from symfpu.checkers.existence.reading import stated
from symfpu.checkers.reading import CertificateError, Json, check_kind, dyadic, need

Place = tuple[int, int]  # harmonic n, mode q


class Orbit(NamedTuple):
    """What the certificate of existence has proved: an orbit within `radius` of these numbers.

    force : phi(r) = V'(r) - r. omega : the frequency, or the middle of an interval that holds it;
    omega_off : above what the frequency is off it. rows : c_q[n] 2^bits by harmonic, all modes.
    """

    N: int
    force: Force
    seed: int
    omega: Fraction
    omega_off: Fraction
    bits: int
    rows: list[list[int]]
    radius: Fraction

    @property
    def even(self) -> bool:
        """Whether V is even."""
        return self.force.even


def check_existence_of(data: Json) -> str:
    """The orbit exists: the sentence of the other checker."""
    check_kind(data, check_existence.KIND)
    try:
        return check_existence.check_certificate(data)[0]
    except CertificateError as error:
        raise CertificateError(f"no orbit is proved: {error}") from error


def orbit_of(data: Json) -> Orbit:
    """The numbers of a certificate of existence that has been checked."""
    claim = check_existence.read_claim(data)
    need(not claim.half_width, "stability is proved of one orbit, not of a segment")
    need(not claim.shape.travelling, "stability is proved with fixed ends")
    rows = [[0] * claim.N for _ in range(claim.harmonics + 1)]
    for (n, q), c in claim.orbit.items():
        rows[n][q] = c
    return Orbit(
        N=claim.N,
        force=claim.force,
        seed=claim.shape.seed,
        omega=claim.omega,
        omega_off=off_of_frequency(claim, data),
        bits=claim.bits,
        rows=rows,
        radius=dyadic(data["radius"], "radius"),
    )


def off_of_frequency(claim: Claim, data: Json) -> Fraction:
    """Above |omega* - omega|: 0 where omega is given, else by the interval that is proved."""
    if not claim.bordered:
        return Fraction(0)
    off = max(abs(end - claim.omega) for end in stated(data["frequency"], "frequency"))
    need(off < claim.omega / 2, "the frequency is not known well enough")
    return off


class Sector(NamedTuple):
    """Places (n, q) with q = first + slope n (mod 2), n = start (mod step).

    folds : exponents count modulo folds omega. trivial : the velocity of the orbit is in it.
    """

    N: int
    first: int
    slope: int
    start: int
    step: int
    folds: int
    trivial: bool

    def allowed(self, n: int) -> range:
        """The modes at a harmonic."""
        if (n - self.start) % self.step:
            return range(0)
        parity = (self.first + self.slope * n) % 2
        return range(1 if parity else 2, self.N, 2)

    @property
    def exponents(self) -> int:
        """How many exponents up to sign there are beside the double multiplier 1."""
        modes = self.N - 1 if self.slope else len(self.allowed(self.start))
        return modes - int(self.trivial)


def sectors_of(orbit: Orbit) -> list[Sector]:
    """The table of docs/stability-proofs.md; none is empty."""
    N, parity = orbit.N, orbit.seed % 2
    if orbit.even:
        own = Sector(N, parity, 0, 1, 2, 2, True)
        other = Sector(N, 1 - parity, 0, 0, 2, 2, False)
    elif parity == 0:
        own = Sector(N, 0, 0, 0, 1, 1, True)
        other = Sector(N, 1, 0, 0, 1, 1, False)
    else:
        return [Sector(N, 0, 1, 0, 1, 2, True)]
    return [own, other] if other.exponents else [own]
