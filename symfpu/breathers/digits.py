"""Periodic orbits to any number of digits: harmonic balance in fixed point.

A factored matrix of doubles corrects them.

One sweep takes the residual in fixed point, solves Newton's equations for it in doubles with the
matrix at the orbit in doubles, and gains about as many digits as that orbit has. Harmonics beyond
a block of the matrix have a diagonal n^2 omega^2 - Omega^2 far above the rest of their rows and
are divided by it; then a sweep gains fewer digits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import (
    NEARER,
    Balance,
    NoPeriodicOrbit,
    PeriodicOrbit,
    as_periodic_orbit,
    breather_at_amplitude,
    periodic_orbit,
    relative_heights,
    unknowns,
)
from symfpu.breathers.fixed_force import FixedForce, Integers
from symfpu.chain.tension_terms import has_terms
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import (
    GUARD_DIGITS,
    doubles_as_integers,
    fraction_of,
    from_integers,
)
from symfpu.numbers.counted import counted
from symfpu.numbers.typed import Number, exact, integer
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic, show

Floats = NDArray[np.float64]

MORE_ANGLES = "for tori of more angles call refine(torus, digits=...)"
NO_TERMS = (
    "take as potential the polynomial of its first coefficients, or digits= of lindstedt"
)
LARGEST_BLOCK = 2500  # unknowns in the matrix that is factored
MOST_DIGITS = 1000
MOST_HARMONICS = 4096
NEAR_REACH = 1.01  # times the largest stretch
SWEEPS = 400
STALL_SWEEPS = 4  # sweeps without a smaller residual that end the search
# of a residual in units of the last place that is rounding, before the last correction
ROUNDING_BITS = 24
CHECK_BITS = 64  # more than those of the orbit, in the check of its residual
DOUBLE_BITS = 1000  # of an integer that goes into a double
# dlnomega/dlnA below which a frequency in doubles does not tell the amplitude
FLAT = 1e-7


@dataclass(frozen=True, eq=False, kw_only=True)
class PreciseOrbit(FourierTorus):
    """A periodic orbit with many digits: a torus of one frequency; dimensionless.

    Made by `periodic_orbit_digits`. Ours: the breathers of section 6.4 beyond doubles.

    chain, seeds : the model and its one seed. frequencies : omega, exact, shape (1,).
    harmonics : 0 .. H, shape (H+1, 1). cosines : mpf, shape (H+1, N-1), harmonic 0 first.
        phases : 0 of the seed, radians.
    digits : of the largest coefficient.
    bound : above |Q'' - force| of every mode at every time, relative to the largest acceleration:
        the sum of the sizes of all Fourier coefficients of the residual, taken with 64 bits more
        than the orbit has.
    sweeps : corrections made.

    >>> from symfpu import Chain, periodic_orbit, periodic_orbit_digits
    >>> periodic_orbit_digits(periodic_orbit(Chain(N=8, alpha="0.3"), 1, "0.3905"), 30)
    PreciseOrbit(N=8, alpha=0.3, seed 1, omega=0.3905.., A=0.405158623041734.., 30 digits,
    46 harmonics, residual below ...)
    """

    bound: Any = field(default=mpmath.inf)
    sweeps: int = 0

    def __post_init__(self) -> None:
        super().__post_init__()
        show(self, "bound")

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        exact_omega = mpmath.mpf(self.frequency.numerator) / self.frequency.denominator
        omega, A = mpmath.nstr(exact_omega, 15), mpmath.nstr(self.amplitude, 15)
        which = f"seed {self.seed}, omega={omega}.., A={A}.., {self.digits} digits"
        count = counted(len(self.cosines) - 1, "harmonic")
        quality = f"{count}, residual below {mpmath.nstr(self.bound, 2)}"
        return f"PreciseOrbit({chain}, {which}, {quality})"


def periodic_orbit_digits(
    orbit: QuasiPeriodic,
    digits: int,
    *,
    frequency: Number | None = None,
    amplitude: Number | None = None,
) -> PreciseOrbit:
    """A periodic orbit refined to so many digits of its largest coefficient.

    orbit : a solution of one angle, whose phase (radians) is kept; all else is dimensionless. Of
        a polynomial potential, or of one whose tension is made of exponentials and powers.
    digits : 1 .. 1000.
    frequency, amplitude : exact numbers, at most one of them; the member with that omega or that
        A near the orbit. Neither: the frequency of the orbit.

    Newton-like sweeps on harmonic balance, Eq. eqmo; ours. Raises InputError, and NoPeriodicOrbit
    if the sweeps gain no digits, as where omega does not change with the amplitude: give that.

    >>> from symfpu.chain.chain import Chain
    >>> orbit = periodic_orbit(Chain(N=32, alpha="0.33"), 25, "1.8830741847088537")
    >>> precise = periodic_orbit_digits(orbit, 30)
    >>> print(mpmath.nstr(precise.amplitude, 30))
    0.0512121591740189630941015617011
    """
    near = as_periodic_orbit(orbit, "orbit", MORE_ANGLES)
    if not has_terms(near.chain):
        allowed = "an orbit of a chain whose V is a polynomial, or not even and made of "
        allowed += "exponentials and powers, with rational numbers"
        raise InputError("orbit", f"one of {near.chain!r}", allowed, NO_TERMS)
    if integer(digits, "digits", 1) > MOST_DIGITS:
        raise InputError("digits", digits, f"1..{MOST_DIGITS}", "take fewer")
    if frequency is not None and amplitude is not None:
        both = (frequency, amplitude)
        raise InputError("frequency, amplitude", both, "one of them", "leave the other out")
    held = None
    if amplitude is not None:
        held = exact(amplitude, "amplitude")
        near = breather_at_amplitude(near.chain, near.seed, amplitude, near.cosines)
    elif frequency is not None:
        near = periodic_orbit(near.chain, near.seed, frequency, near.cosines)
    with mpmath.workdps(digits + 2 * GUARD_DIGITS):
        return replace(_refine(near, digits, held), phases=dict(orbit.phases))


def _refine(orbit: PeriodicOrbit, digits: int, amplitude: Fraction | None) -> PreciseOrbit:
    """With as many harmonics as the digits need; at the working precision of mpmath."""
    heights = relative_heights(orbit.cosines)
    last = int(np.flatnonzero(heights)[-1])
    decades = max(-math.log10(heights[last]), 1.0) / max(last, 1)
    harmonics = max(8, last, math.ceil(1.1 * (digits + GUARD_DIGITS) / decades) + 2)
    while True:
        if harmonics > MOST_HARMONICS:
            allowed = f"what {MOST_HARMONICS} harmonics can give"
            advice = "take fewer digits or a smaller amplitude"
            raise InputError("digits", digits, allowed, advice)
        sweeps = Sweeps(orbit, harmonics, amplitude)
        number = sweeps.converge()
        bits = math.floor((digits + GUARD_DIGITS / 2) * math.log2(10))
        if sweeps.tail() <= sweeps.size >> bits:
            return sweeps.result(digits, number)
        harmonics += max(8, harmonics // 3)


class Sweeps:
    """An orbit in fixed point, c and omega^2, and the factored matrix that corrects it.

    Made at the working precision of mpmath.
    """

    def __init__(
        self, orbit: PeriodicOrbit, harmonics: int, amplitude: Fraction | None
    ) -> None:
        self.orbit, self.chain = orbit, orbit.chain
        self.by_amplitude = amplitude is not None
        largest = float(np.max(np.abs(orbit.cosines)))
        _, exponent = math.frexp(largest)
        self.force = FixedForce(self.chain, int(mpmath.mp.prec) - exponent, _reach(orbit))
        fixed, seed = self.force.fixed, orbit.seed
        self.size = fixed(mpmath.mpf(largest))
        self.n, self.q = unknowns(self.chain, seed, harmonics)
        # what the symmetry forbids, rounding if any, stays zero
        known = self.n < len(orbit.cosines)
        n, q = self.n[known], self.q[known]
        each_fixed = np.frompyfunc(lambda x: fixed(mpmath.mpf(x)), 1, 1)
        self.c: Integers = np.zeros((harmonics + 1, self.chain.N - 1), dtype=object)
        self.c[n, q] = each_fixed(orbit.cosines[n, q])
        if amplitude is None:
            self.squared = fixed(orbit.frequency**2)
        else:
            linear = int(self.force.squares[seed - 1])
            self.squared = linear + fixed(mpmath.mpf(orbit.sigma))
            self.c[1, seed - 1] = fixed(amplitude)
        self._factor()

    def _factor(self) -> None:
        """The matrix of the low harmonics, and the diagonal of the high ones.

        Both at the orbit in doubles.
        """
        from scipy.linalg import lu_factor

        orbit, harmonics = self.orbit, len(self.c) - 1
        affordable = LARGEST_BLOCK * harmonics // len(self.n)
        block = min(harmonics, max(len(orbit.cosines) - 1, affordable))
        self.balance = Balance(self.chain, orbit.seed, block)
        self.z = self.balance.vector(orbit.cosines, orbit.sigma)
        held = self.balance.first if self.by_amplitude else len(self.z) - 1
        self.free = np.delete(np.arange(len(self.z)), held)
        _, jacobian = self.balance.system(self.z)
        self.matrix = lu_factor(jacobian[:, self.free])
        linear = self.chain.frequencies()[self.q]
        diagonal = self.n**2 * float(orbit.frequency) ** 2 - linear**2
        # unknowns go by harmonic: those of the block come first
        self.diagonal = diagonal[len(self.balance.n) :]

    def converge(self) -> int:
        """Sweep until the residual is rounding; the number of sweeps. Raises NoPeriodicOrbit."""
        least, stalled = math.inf, 0
        for sweep in range(1, SWEEPS + 1):
            equations = self.force.equations(self.c, self.squared, len(self.c) - 1)
            values = equations[self.n, self.q]
            bits = max(abs(x) for x in values).bit_length()
            self._correct(values, bits)
            if bits <= ROUNDING_BITS:
                return sweep
            least, stalled = min(least, bits), 0 if bits < least else stalled + 1
            if stalled >= STALL_SWEEPS:
                break
        digits = (self.size.bit_length() - least) * math.log10(2)
        reason = f"the sweeps in fixed point stop at a residual of 1e-{digits:.0f}"
        raise NoPeriodicOrbit(self.balance, reason, self.z, self._advice())

    def _advice(self) -> str:
        """What to do where the sweeps gain nothing."""
        if self.by_amplitude:
            return NEARER
        slope = self._slope()
        if not abs(slope) < FLAT:
            return NEARER
        flat = f"omega hardly changes with A here, dln(omega)/dln(A) = {slope:.1g}"
        A = float(self.z[self.balance.first])
        return f"{flat}, and does not tell it: hold the amplitude, amplitude={A:.15g}"

    def _slope(self) -> float:
        """dln(omega)/dln(A) along the family at the orbit in doubles; nan at a fold in A."""
        first, z = self.balance.first, self.z
        _, jacobian = self.balance.system(z)
        others = np.delete(np.arange(len(z)), first)
        try:
            changes = np.linalg.solve(jacobian[:, others], -jacobian[:, first])
        except np.linalg.LinAlgError:
            return math.nan
        return float(changes[-1] * z[first]) / (2 * float(self.orbit.frequency) ** 2)

    def _correct(self, values: Integers, bits: int) -> None:
        from scipy.linalg import lu_solve

        dropped = max(bits - DOUBLE_BITS, 0)
        kept = min(bits, DOUBLE_BITS)
        scaled = np.array([math.ldexp(float(x >> dropped), -kept) for x in values])
        block = len(self.balance.n)
        changes = np.zeros(len(scaled) + 1)
        changes[self.free] = lu_solve(self.matrix, scaled[:block])
        sigma = changes[
            block : block + 1
        ].copy()  # its place is the end of the block for now
        changes[block:-1] = scaled[block:] / self.diagonal
        self.c[self.n, self.q] -= doubles_as_integers(changes[:-1], bits)
        self.squared -= int(doubles_as_integers(sigma, bits)[0])

    def tail(self) -> int:
        """Largest coefficient of the last harmonics."""
        length = max(2, len(self.c) // 16)
        return max(abs(int(x)) for x in self.c[-length:].flat)

    def result(self, digits: int, sweeps: int) -> PreciseOrbit:
        """The orbit with its bound, without harmonics that are zero in fixed point."""
        seed, bits = self.orbit.seed, self.force.bits
        omega = self.orbit.frequency
        if self.by_amplitude:
            omega = fraction_of(mpmath.sqrt(mpmath.ldexp(self.squared, -bits)))
        last = max(n for n, row in enumerate(self.c) if any(row))
        c = self.c[: last + 1]
        return PreciseOrbit(
            chain=self.chain,
            seeds=(seed,),
            frequencies=(omega,),
            harmonics=np.arange(len(c))[:, None],
            cosines=from_integers(c, np.full(c.shape[1], -bits)),
            phases={seed: 0},
            digits=digits,
            bound=self._bound(c, omega),
            sweeps=sweeps,
        )

    def _bound(self, c: Integers, omega: Fraction) -> Any:
        bits = self.force.bits + CHECK_BITS
        finer = FixedForce(self.chain, bits, self.force.reach(c))
        squared = finer.fixed(omega**2)
        equations = finer.equations(c << CHECK_BITS, squared)
        # one last place of the orbit; what is beyond the terms is less
        rounding = 1 << CHECK_BITS
        total = max(np.abs(equations).sum(axis=0)) + rounding
        t = np.linspace(0, np.pi / float(omega), 4 * len(self.orbit.cosines))
        forces = self.chain.accelerations(self.orbit.positions(t))
        largest = float(np.max(np.abs(forces)))
        return mpmath.ldexp(total, -finer.bits) / largest


def _reach(orbit: PeriodicOrbit) -> Any:
    """What no stretch of the orbit exceeds, nor of one near to it."""
    chain = orbit.chain
    bonds = Balance(chain, orbit.seed, 1).stretch
    return mpmath.mpf(NEAR_REACH * np.abs(orbit.cosines @ bonds).sum(axis=0).max())
