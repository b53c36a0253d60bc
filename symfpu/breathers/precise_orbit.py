"""Periodic orbits to any number of digits: tori of one angle, by iterative refinement.

The residual is taken in integers, the correction with a Jacobian in doubles
(`symfpu.refinement.digits`).
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from symfpu.breathers.balance import (
    HarmonicBalance,
    as_periodic_orbit,
    breather_at_amplitude,
    periodic_orbit,
)
from symfpu.breathers.equations import NEARER, Balance, Floats, NoPeriodicOrbit
from symfpu.errors import InputError
from symfpu.files.checkpoint import checkpoint_path
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.arithmetic import GUARD_DIGITS
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, exact
from symfpu.refinement.digits import (
    IterativeRefinement,
    guess_of,
    require_digits,
    torus_to_digits,
)
from symfpu.refinement.iterative_refinement import Failure
from symfpu.refinement.prescribed import Amplitudes, Frequencies, Prescribed
from symfpu.tori.torus import Torus, comes_from

MORE_ANGLES = "for tori of more angles call refine(torus, digits=...)"
CARRIED_DIGITS = GUARD_DIGITS // 2  # of coefficients, beyond those asked for
# dlnomega/dlnA below which a frequency in doubles does not tell the amplitude
FLAT = 1e-7


@public
def periodic_orbit_digits(
    orbit: Torus,
    digits: int,
    *,
    frequency: Number | None = None,
    amplitude: Number | None = None,
    file: Path | str | None = None,
    progress: Progress | None = None,
) -> Torus[IterativeRefinement]:
    """The periodic orbit near `orbit` with so many digits, of the largest coefficient.

    orbit : a solution of one angle to start from, in doubles or refined to fewer digits; its
        phase (radians) is kept. Dimensionless; the potential a polynomial, or not even and made of
        exponentials and powers with rational numbers.
    digits : 1 .. 1000.
    frequency, amplitude : what the orbit has, exactly; at most one of them. Neither: the frequency
        of the orbit.
    file : a checkpoint written after every refinement step; a run that finds one goes on from it,
        one to more digits, too.
    progress : called as (label, NO_FRACTION) on every step.

    A torus of one angle by iterative refinement, Eq. eqmo; ours: the breathers of section 6.4
    beyond doubles. Its `digits` are those of the largest coefficient. Raises InputError, and
    NoPeriodicOrbit if the steps gain no digits, as where omega does not change with the amplitude:
    give that.

    >>> from symfpu.chain.chain import Chain
    >>> orbit = periodic_orbit(Chain(N=32, alpha="0.33"), 25, "1.8830741847088537")
    >>> precise = periodic_orbit_digits(orbit, 30)
    >>> print(precise.amplitude)
    0.0512121591740189630941015617011
    """
    near = as_periodic_orbit(orbit, "orbit", MORE_ANGLES)
    require_digits(near.chain, digits, "orbit")
    if frequency is not None and amplitude is not None:
        both = (frequency, amplitude)
        raise InputError("frequency, amplitude", both, "one of them", "leave the other out")
    path = None if file is None else checkpoint_path(file)
    start = orbit if comes_from(orbit, IterativeRefinement) else near
    if amplitude is not None:
        start = near = breather_at_amplitude(near.chain, near.seed, amplitude, near.cosines)
    elif frequency is not None:
        start = near = periodic_orbit(near.chain, near.seed, frequency, near.cosines)
    prescribed = _prescribed(near, amplitude)
    guess = guess_of(start, prescribed)._replace(phases=dict(orbit.phases))
    try:
        wanted = digits + CARRIED_DIGITS
        torus = torus_to_digits(guess, wanted, path, progress or unheard)
    except Failure as failure:
        balance = Balance(near.chain, near.seed, len(near.cosines) - 1)
        z = balance.vector(near.cosines, near.origin.sigma)
        advice = NEARER if amplitude is not None else _advice(balance, z)
        raise NoPeriodicOrbit(balance, str(failure), z, advice) from None
    return replace(torus, digits=digits)


def _prescribed(near: Torus[HarmonicBalance], amplitude: Number | None) -> Prescribed:
    """The amplitude, if one was given, else the frequency of the orbit in doubles."""
    if amplitude is not None:
        return Amplitudes((exact(amplitude, "amplitude"),))
    return Frequencies(near.chain, near.seeds, near.frequencies)


def _advice(balance: Balance, z: Floats) -> str:
    """What to do where refinement at a held frequency gains nothing.

    z : of the orbit in doubles that it began with.
    """
    slope = _slope(balance, z)
    if not abs(slope) < FLAT:
        return NEARER
    flat = f"omega hardly changes with A here, dln(omega)/dln(A) = {slope:.1g}"
    A = float(z[balance.first])
    return f"{flat}, and does not tell it: hold the amplitude, amplitude={A:.15g}"


def _slope(balance: Balance, z: Floats) -> float:
    """dln(omega)/dln(A) along the family at the orbit in doubles; nan at a fold in A."""
    first = balance.first
    _, jacobian = balance.system(z)
    others = np.delete(np.arange(len(z)), first)
    try:
        changes = np.linalg.solve(jacobian[:, others], -jacobian[:, first])
    except np.linalg.LinAlgError:
        return math.nan
    return float(changes[-1] * z[first]) / (2 * balance.frequency(z) ** 2)
