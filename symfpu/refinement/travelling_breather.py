"""Travelling waves of one seed: the periodic orbits of a ring, followed from rest.

Of frequency, amplitude or energy. Newton's method on the one function of the one angle
(symfpu.chain.projections.waves); along the way from rest the amplitude grows with the part gone,
shift and energy with its square.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import numpy as np

from symfpu.chain.chain import Chain, require_any_chain
from symfpu.errors import InputError, NoRealAmplitude, UndeterminedAmplitudes
from symfpu.files.progress import Progress
from symfpu.numbers.long_doubles import long
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, exact
from symfpu.refinement.conditions import Amplitude, Condition, Energy, FrequencyShift
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.refined_torus import Newton, NoTorus, refined_torus
from symfpu.tori.short_waves import plain_waves, shifts_by_squares
from symfpu.tori.torus import Torus

LEAST_FREQUENCY = 1e-9  # of a guess
REACH = 0.3  # relative change of the amplitude from a guess that stays on the family
SMALLEST_PART = 1 / 256  # of the way from rest, in one step
Target = Callable[[float], Condition]  # of the part of the way that is gone


@public
def travelling_breather(
    chain: Chain,
    seed: int,
    *,
    frequency: Number | None = None,
    amplitude: Number | None = None,
    energy: Number | None = None,
    progress: Progress | None = None,
) -> Torus[Newton]:
    """The travelling wave of one seed on a ring, with the given frequency, amplitude or energy.

    It is periodic: x_j(t) = f(omega t - 2 pi q j / N), and goes on by one site after 2 pi q / N
    of its angle. Found by Newton's method, along the family from rest.

    chain : with ends="periodic", of any potential. seed : q, signed; dimensionless.
    frequency : omega. amplitude : A, not 0. energy : H. One of them, an exact number.
    progress : called as (label, NO_FRACTION) on every step.

    Ours: the breathers of section 6.4 on a ring; the phase is 0. More of them, from one nearby:
    `refine`. Raises InputError, also for a chain with fixed
    ends; NoRealAmplitude or UndeterminedAmplitudes if the lowest order has no amplitude of this
    frequency; NoTorus with the best iterate.

    >>> chain = Chain(N=8, potential="toda:1/2", ends="periodic")
    >>> wave = travelling_breather(chain, 1, amplitude="0.5")
    >>> round(float(wave.frequency), 9), wave.residual() < 1e-13
    (0.771423596, True)
    """
    if not require_any_chain(chain).periodic:
        allowed = "a chain with ends='periodic'"
        advice = "fixed ends have periodic_orbit and breather_at_energy"
        raise InputError("chain", chain, allowed, advice)
    (q,) = chain.seeds_of((seed,))
    given = {"frequency": frequency, "amplitude": amplitude, "energy": energy}
    [(name, value)] = _only(given).items()
    guess, target = _SOUGHT[name](chain, q, _nonzero(name, value))
    found = _walk(guess, target, progress)
    return found if name != "frequency" else replace(found, frequencies=guess.frequencies)


def _only(given: dict[str, Number | None]) -> dict[str, Number]:
    """The one argument that was given; InputError for none or more."""
    there = {name: value for name, value in given.items() if value is not None}
    if len(there) != 1:
        allowed = f"exactly one of {', '.join(given)}"
        told = ", ".join(there) or "none"
        raise InputError("frequency, amplitude, energy", told, allowed, "say which it is")
    return there


def _nonzero(name: str, value: Number) -> Fraction:
    number = exact(value, name)
    if number == 0 or (number < 0 and name != "amplitude"):
        kind = "a number that is not 0" if name == "amplitude" else "a positive number"
        raise InputError(name, value, kind, "take a small one")
    return number


def _linear(chain: Chain, q: int) -> float:
    return float(chain.frequencies()[chain.mode_numbers.index(q)])


def _curvature(chain: Chain, q: int) -> float:
    """c of omega = Omega + c A^2 + ..., the lowest order of the series."""
    return float(shifts_by_squares(chain, (q,))[0, 0])


def _plain(chain: Chain, q: int, omega: Fraction, A: float) -> Torus:
    """The wave of the seed alone."""
    return plain_waves(chain, (omega,), {q: A})


def _of_amplitude(chain: Chain, q: int, A: Fraction) -> tuple[Torus, Target]:
    omega = _linear(chain, q) + _curvature(chain, q) * float(A) ** 2
    guess = _plain(chain, q, _positive(omega), float(A))
    return guess, lambda part: Amplitude(0, long(A) * np.longdouble(part))


def _of_frequency(chain: Chain, q: int, omega: Fraction) -> tuple[Torus, Target]:
    guess = _plain(chain, q, omega, 1.0)
    (shift,) = shifts_of(guess)
    curvature = _curvature(chain, q)
    order = 2 // chain.degree_step
    if curvature == 0 or shift == 0:
        raise UndeterminedAmplitudes((q,), order)
    square = float(shift) / curvature
    if square <= 0:
        raise NoRealAmplitude(q, square, order)
    guess = _plain(chain, q, omega, square**0.5)
    return guess, lambda part: FrequencyShift(0, shift * np.longdouble(part) ** 2)


def _of_energy(chain: Chain, q: int, H: Fraction) -> tuple[Torus, Target]:
    """Of a wave of amplitude A the harmonic energy is Omega^2 A^2/2."""
    A = (2 * float(H)) ** 0.5 / _linear(chain, q)
    omega = _linear(chain, q) + _curvature(chain, q) * A**2
    guess = _plain(chain, q, _positive(omega), A)
    return guess, lambda part: Energy(long(H) * np.longdouble(part) ** 2, harmonic=False)


_SOUGHT = {
    "frequency": _of_frequency,
    "amplitude": _of_amplitude,
    "energy": _of_energy,
}


def _positive(omega: float) -> Fraction:
    """A guess of a frequency, which must not be negative."""
    return exact(max(omega, LEAST_FREQUENCY), "frequency")


def _walk(end: Torus, target: Target, progress: Progress | None) -> Torus[Newton]:
    """The member at the end of the way from rest, in one step or in more."""
    gone, step, near = 0.0, 1.0, (1.0, end)
    while True:
        part = min(1.0, gone + step)
        scale, member = near
        guess = _scaled(member, part / scale)
        try:
            found = refined_torus(guess, [target(part)], progress=progress)
            _require_near(found, guess)
        except NoTorus:
            step /= 2
            if step < SMALLEST_PART:
                raise
            continue
        gone, near, step = part, (part, found), 2 * step
        if gone == 1:
            return found


def _scaled(torus: Torus, ratio: float) -> Torus:
    """A guess further on: coefficients by the ratio, the shift by its square."""
    (q,) = torus.seeds
    linear = _linear(torus.chain, q)
    moved = linear + ratio**2 * (float(torus.frequencies[0]) - linear)
    plain = torus.in_doubles()
    return replace(plain, frequencies=(_positive(moved),), cosines=ratio * plain.cosines)


def _require_near(found: Torus[Newton], guess: Torus) -> None:
    """NoTorus where Newton's method went to another family."""
    change = abs(found.amplitude / guess.amplitude - 1)
    if change > REACH or found.frequency <= 0:
        reason = f"the amplitude goes from {guess.amplitude:.4g} to {found.amplitude:.4g}"
        raise NoTorus(reason, found, found.residual())
