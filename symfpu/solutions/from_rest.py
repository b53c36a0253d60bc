"""Tori that continue the linear modes: guesses of short series, and the walk from rest.

Newton's method is tried at the end of the way first, from a short series. Where it fails, or leads
to another family, the end is reached in steps: amplitudes grow with the part of the way that is
gone, energies and shifts of frequencies with its square. A torus is kept if its amplitudes are near
those of its guess.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import (
    DidNotConverge,
    NoRealAmplitude,
    ResonantDivisor,
    SymfpuError,
)
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.typed import exact
from symfpu.refinement.guesses import extrapolated, frequency_shifts
from symfpu.refinement.newton import Newton
from symfpu.refinement.prescribed import Prescribed
from symfpu.refinement.tori import REFINED_RESIDUAL, NoTorus, refined_in_doubles
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.at_energy import seed_weights, squares_of_linear_modes
from symfpu.tori.best_order import best_order
from symfpu.tori.energy import Energy
from symfpu.tori.frequencies import listed
from symfpu.tori.short_series import (
    plain_waves,
    shifted_frequencies,
    shifts_by_squares,
    short_series,
)
from symfpu.tori.torus import Torus

GUESS_DEGREES = (4, 8, 12)  # of the amplitudes in the series that are guesses, less 1
GOOD_GUESS = 1e-2  # residual of a series that needs not be longer
LEAST_FREQUENCY = 1e-6  # of a guess
REACH = 0.3  # relative change of the amplitudes from a guess that stays on the family
SMALLEST_PART = 1 / 4096  # of the way from rest, in the first step
SHORTEST = 1 / 32  # of the way that is gone, in a further step
GROWTH = 2.0  # of an amplitude from its guess while Newton's method looks for the torus
ON_THE_WAY = 1e-8  # residual of a torus from which a step is made
LARGEST_RESIDUAL = 0.1  # of a guess that is tried, relative to the largest acceleration
SMALLER = "ask for a torus of smaller amplitude"


def guess_of_frequencies(
    chain: Chain, seeds: tuple[int, ...], frequencies: tuple[Fraction, ...]
) -> Torus:
    """The series of these frequencies, longer while it is no guess; or that of the lowest shifts.

    Raises NoRealAmplitude or UndeterminedAmplitudes where the lowest order has no amplitudes.
    """
    best: Torus | None = None
    failure: SymfpuError | None = None
    for degree in GUESS_DEGREES:
        order = degree // chain.degree_step
        try:
            torus = solve_amplitudes(lindstedt(chain, seeds, frequencies, order))
        except (NoRealAmplitude, DidNotConverge) as error:
            failure = failure or error
            continue
        best = torus.origin.cut_at(best_order(torus)).torus()
        if best.residual() < GOOD_GUESS:
            return best
    if failure is None:
        assert best is not None
        return best
    amplitudes = _lowest_amplitudes(chain, seeds, frequencies, failure)
    return replace(guess_of_amplitudes(chain, amplitudes), frequencies=frequencies)


def _lowest_amplitudes(
    chain: Chain,
    seeds: tuple[int, ...],
    frequencies: tuple[Fraction, ...],
    failure: SymfpuError,
) -> dict[int, float]:
    """Those whose lowest shifts lead to the frequencies; raises the failure without any."""
    shifts = frequency_shifts(chain, seeds, frequencies).astype(float)
    matrix = shifts_by_squares(chain, seeds)
    if np.linalg.matrix_rank(matrix) < len(seeds):
        raise failure
    squares = np.linalg.solve(matrix, shifts)
    for q, square in zip(seeds, squares.tolist(), strict=True):
        if square <= 0:
            raise NoRealAmplitude(q, square, 2 // chain.degree_step)
    return dict(zip(seeds, np.sqrt(squares).tolist(), strict=True))


def guess_of_amplitudes(chain: Chain, amplitudes: Mapping[int, float]) -> Torus:
    """The short series with these amplitudes, or where there is none the waves alone."""
    omega = shifted_frequencies(chain, amplitudes)
    try:
        if min(omega) > LEAST_FREQUENCY:
            order = GUESS_DEGREES[0] // chain.degree_step
            return short_series(chain, amplitudes, order)
    except ResonantDivisor:
        pass
    return plain_waves(chain, _positive(omega), amplitudes)


def amplitudes_of_energy(
    chain: Chain, seeds: tuple[int, ...], energy: Energy
) -> dict[int, float]:
    """A of the modes of the linear chain that share an energy as is asked."""
    linear = np.array([float(chain.linear_frequency(q)) for q in seeds])
    weights = np.array([float(w) for w in seed_weights(chain, seeds, energy)])
    by_amplitude = energy.amplitude_ratio is not None
    squares = squares_of_linear_modes(
        linear, float(energy.exact), weights, by_amplitude=by_amplitude
    )
    return dict(zip(seeds, np.sqrt(squares).tolist(), strict=True))


def from_rest(
    begin: Callable[[float], Torus],
    prescribed: Prescribed,
    progress: Progress | None = None,
) -> Torus[Newton]:
    """The torus at the end of the way from rest, in one step or in more.

    begin : a guess of the torus at a part of the way, for the first step. A guess that leaves too
    much of the equations of motion is not tried. Raises NoTorus, which says how far the way was
    followed.
    """
    tell = progress or unheard
    way: list[tuple[float, Torus[Newton]]] = []
    gone, step = 0.0, 1.0
    while gone < 1:
        part = min(1.0, gone + step)
        guess = _guess(way, part) if way else begin(part)
        near = {"tolerance": ON_THE_WAY} if part < 1 else {}
        try:
            _require_good(guess)
            found = refined_in_doubles(
                guess, prescribed, part, **near, growth=GROWTH, progress=progress
            )
            _require_near(found, guess, way)
        except NoTorus as failure:
            step = (part - gone) / 2
            if step < max(SHORTEST * gone, SMALLEST_PART):
                raise _ended(failure, way) from failure
            continue
        way.append((part, found))
        gone, step = part, 2 * (part - gone)
        tell("way from rest", gone)
    _, last = way[-1]
    return _require_solved(last)


def _guess(way: list[tuple[float, Torus[Newton]]], part: float) -> Torus:
    """On the line through the last two tori of the way, or the last one scaled."""
    gone, last = way[-1]
    if len(way) == 1:
        return _scaled(last, part / gone)
    earlier, before = way[-2]
    guess = extrapolated(before, last, (part - gone) / (gone - earlier))
    return replace(guess, frequencies=_positive(guess.frequencies))


def _ended(failure: NoTorus, way: list[tuple[float, Torus[Newton]]]) -> NoTorus:
    """With what was reached on the way."""
    if not way:
        return failure
    _, last = way[-1]
    sizes = listed("A", {q: float(A) for q, A in last.amplitudes.items()})
    energy = float(last.energy())
    reached = f"its family was followed from rest to H = {energy:.6g} ({sizes})"
    reason = f"{reached}, then: {failure.reason}"
    advice = f"ask for less, such as energy={energy:.3g}"
    return NoTorus(reason, failure.iterate, failure.residual, advice)


def at_part(end: Torus, part: float) -> Torus:
    """The short series with a part of the amplitudes of a guess, at a part of its shifts."""
    if part == 1:
        return end
    amplitudes = {q: part * float(A) for q, A in end.amplitudes.items()}
    return replace(
        guess_of_amplitudes(end.chain, amplitudes), frequencies=_moved(end, part)
    )


def _moved(torus: Torus, ratio: float) -> tuple[Fraction, ...]:
    """Its frequencies with shifts by the square of a ratio."""
    linear = [float(torus.chain.linear_frequency(q)) for q in torus.seeds]
    pairs = zip(linear, torus.frequencies, strict=True)
    moved = [exact(x + ratio**2 * (float(w) - x), "frequency") for x, w in pairs]
    return _positive(tuple(moved))


def _scaled(torus: Torus, ratio: float) -> Torus:
    """A guess further on: coefficients by the power of the ratio that is their harmonic's order."""
    plain = torus.in_doubles()
    powers = np.abs(torus.harmonics).sum(axis=1)
    powers = np.where(powers == 0, 2, powers)
    cosines = plain.cosines * (float(ratio) ** powers)[:, None]
    return replace(plain, frequencies=_moved(torus, ratio), cosines=cosines)


def _positive(frequencies: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """Of a guess, which must not be negative."""
    return tuple(max(w, Fraction(LEAST_FREQUENCY)) for w in frequencies)


def _require_good(guess: Torus) -> None:
    """NoTorus for a guess from which Newton's method would not converge."""
    left = guess.residual()
    if not left <= LARGEST_RESIDUAL:
        raise NoTorus("the guess is no torus", guess, left, SMALLER)


def _require_solved(torus: Torus[Newton]) -> Torus[Newton]:
    """NoTorus for one that does not solve the equations of motion to REFINED_RESIDUAL."""
    left = torus.residual()
    if left <= REFINED_RESIDUAL:
        return torus
    reason = "; ".join(torus.warnings) or "the equations of motion are not solved"
    advice = "ask for less, or take refine(error.iterate, most_harmonics=...)"
    raise NoTorus(reason, torus, left, advice)


def _require_near(
    found: Torus[Newton], guess: Torus, way: list[tuple[float, Torus[Newton]]]
) -> None:
    """NoTorus where Newton's method went to another family: farther off than the step is long."""
    for q, A in found.amplitudes.items():
        expected = float(guess.amplitudes[q])
        allowed = REACH * abs(expected)
        if way:
            _, last = way[-1]
            allowed = min(allowed, abs(expected - float(last.amplitudes[q])))
        if abs(float(A) - expected) > allowed or found.omega[q] <= 0:
            reason = f"the amplitude of mode {q} is {float(A):.4g}, expected {expected:.4g}"
            raise NoTorus(reason, found, found.residual())
