"""Travelling waves of one seed: the periodic orbits of a ring, followed from rest.

Of frequency, amplitude or energy. Newton's method on the one function of the one angle
(symfpu.chain.projections.waves); along the way from rest the amplitude grows with the part gone,
shift and energy with its square.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError, NoRealAmplitude, UndeterminedAmplitudes
from symfpu.files.progress import Progress
from symfpu.numbers.long_doubles import long
from symfpu.numbers.typed import Number, exact
from symfpu.refinement.conditions import Amplitude, Condition, Energy, FrequencyShift
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.refined_torus import Newton, NoTorus, refined_torus
from symfpu.refinement.tori import refine
from symfpu.tori.short_series import plain_waves, shifts_by_squares
from symfpu.tori.torus import Torus

LEAST_FREQUENCY = 1e-9  # of a guess
REACH = 0.3  # relative change of the amplitude from a guess that stays on the family
SMALLEST_PART = 1 / 256  # of the way from rest, in one step
Target = Callable[[float], Condition]  # of the part of the way that is gone


def travelling_wave(
    chain: Chain,
    seed: int,
    name: str,
    value: Number,
    guess: object = None,
    *,
    harmonic: bool = False,
) -> Torus[Newton]:
    """The wave of one seed on a ring, of a frequency, amplitude or energy, as `name` says.

    It is periodic: x_j(t) = f(omega t - 2 pi q j / N), and goes on by one site after 2 pi q / N
    of its angle. Found by Newton's method, along the family from rest, or near a guess. Raises
    InputError; NoRealAmplitude or UndeterminedAmplitudes if the lowest order has no amplitude of
    this frequency; NoTorus with the best iterate.
    """
    (q,) = chain.seeds_of((seed,))
    number = _nonzero(name, value)
    if guess is not None:
        return _near(chain, q, guess, {name: number, "harmonic": harmonic})
    if name == "frequency":
        wave, target = _of_frequency(chain, q, number)
        return replace(_walk(wave, target, None), frequencies=wave.frequencies)
    if name == "amplitude":
        return _walk(*_of_amplitude(chain, q, number), None)
    return _walk(*_of_energy(chain, q, number, harmonic), None)


def _near(chain: Chain, q: int, guess: object, wish: dict[str, Any]) -> Torus[Newton]:
    """The wave near a guess of the same chain and seed."""
    if not isinstance(guess, Torus) or (guess.chain, guess.seeds) != (chain, (q,)):
        given = f"{guess!r:.60}" if isinstance(guess, Torus) else type(guess).__name__
        allowed = f"a wave of seed {q} of the same ring"
        raise InputError("guess", given, allowed, "take one nearby, or None")
    frequency, amplitude = wish.get("frequency"), wish.get("amplitude")
    return refine(
        guess,
        frequencies=None if frequency is None else (frequency,),
        amplitudes=None if amplitude is None else {q: amplitude},
        energy=wish.get("energy"),
        harmonic=wish["harmonic"],
    )


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


def _of_energy(chain: Chain, q: int, H: Fraction, harmonic: bool) -> tuple[Torus, Target]:
    """Of a wave of amplitude A the harmonic energy is Omega^2 A^2/2."""
    A = (2 * float(H)) ** 0.5 / _linear(chain, q)
    omega = _linear(chain, q) + _curvature(chain, q) * A**2
    guess = _plain(chain, q, _positive(omega), A)
    return guess, lambda part: Energy(long(H) * np.longdouble(part) ** 2, harmonic)


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
