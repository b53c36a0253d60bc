"""The door: a torus of a chain by its seeds and frequencies, amplitudes, energy or start."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, Literal, overload

from symfpu.breathers.balance import (
    HarmonicBalance,
    breather_of_amplitude,
    breather_of_energy,
    breather_of_frequency,
)
from symfpu.chain.chain import Chain, require_any_chain
from symfpu.errors import InputError
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number
from symfpu.refinement.digits import IterativeRefinement
from symfpu.refinement.guesses import moderate_by_seed
from symfpu.refinement.newton import Newton
from symfpu.refinement.prescribed import prescribed_by
from symfpu.refinement.tori import refine
from symfpu.series.arguments import frequencies_of
from symfpu.solutions.from_rest import (
    amplitudes_of_energy,
    at_part,
    from_rest,
    guess_of_amplitudes,
    guess_of_frequencies,
)
from symfpu.solutions.series import series_torus
from symfpu.tori.energy import Energy, asked_energy
from symfpu.tori.from_series import FromSeries
from symfpu.tori.orders import Orders
from symfpu.tori.torus import Torus

Frequencies = Sequence[Number] | Mapping[int, Number]
NEWTON, SERIES = "newton", "series"
ONE_OF = "frequencies, amplitudes, energy, start"


@overload
def torus(
    chain: Chain,
    seeds: Sequence[int],
    *,
    frequencies: Frequencies | None = ...,
    amplitudes: Mapping[int, Number] | None = ...,
    energy: Number | Energy | None = ...,
    method: Literal["series"],
    order: int | Orders | None = ...,
    digits: int | None = ...,
    progress: Progress | None = ...,
) -> Torus[FromSeries]: ...
@overload
def torus(
    chain: Chain,
    seeds: Sequence[int],
    *,
    frequencies: Frequencies | None = ...,
    amplitudes: Mapping[int, Number] | None = ...,
    energy: Number | Energy | None = ...,
    start: Mapping[int, Number] | None = ...,
    digits: int,
    progress: Progress | None = ...,
) -> Torus[IterativeRefinement]: ...
@overload
def torus(
    chain: Chain,
    seeds: Sequence[int],
    *,
    frequencies: Frequencies | None = ...,
    amplitudes: Mapping[int, Number] | None = ...,
    energy: Number | Energy | None = ...,
    start: Mapping[int, Number] | None = ...,
    progress: Progress | None = ...,
) -> Torus[Newton | HarmonicBalance]: ...
@public
def torus(
    chain: Chain,
    seeds: Sequence[int],
    *,
    frequencies: Frequencies | None = None,
    amplitudes: Mapping[int, Number] | None = None,
    energy: Number | Energy | None = None,
    start: Mapping[int, Number] | None = None,
    method: str = NEWTON,
    order: int | Orders | None = None,
    digits: int | None = None,
    progress: Progress | None = None,
) -> Torus[Any]:
    """The torus of a chain with given seeds and frequencies, amplitudes, energy or start.

    By default it solves the equations of motion to rounding. One seed: a q-breather.

    chain : with fixed ends or a ring, whose seeds are travelling waves, signed. All quantities are
        dimensionless. seeds : the distinct modes D_0.
    Exactly one of the following, exact numbers.
    frequencies : omega of every seed, in their order or by seed.
    amplitudes : A_q by seed, the coefficient of cos(theta_q) in Q_q; not Q_q(0).
    energy : H, or an `Energy`: the harmonic one, a ratio of amplitudes or of mode energies. Without
        a ratio the averages of E_q of the seeds are equal.
    start : Q_q(0) by seed, not 0, of an orbit at rest, which is on the torus but for the modes
        that are no seeds. With fixed ends; `refine(guess, start=...)` takes 0, too.
    method : "newton", Newton's method on the equations of motion, near a short series or on the way
        from rest; "series", the truncated series of the paper, which only approximates them.
    order : of the series with method="series", a number or `Orders`. None: orders are added until
        the residual no longer falls.
    digits : of all results, 1 to 1000; None for doubles.
    progress : called as (label, fraction).

    There may be several tori of one energy or frequency. This is one on the family that continues
    the linear modes; `refine(torus, energy=...)` finds others near a guess. With one seed and fixed
    ends the family is followed in steps that do not change to another one; where a wide gap has
    turned it before the energy, and the energy is passed again, a UserWarning says so. With several
    seeds it has a gap at every resonance: steps go over these, and `family` lists them.
    Raises InputError; NoRealAmplitude or UndeterminedAmplitudes where the lowest order has no such
    frequencies; NoTorus, for one seed NoPeriodicOrbit or NoBreatherAtEnergy, with what was reached;
    with method="series" also NoTorusAtEnergy and NoSelfConsistentFrequencies.

    >>> chain = Chain(N=16, alpha="0.33")
    >>> found = torus(chain, (1, 2), energy="0.01")
    >>> found
    Torus(N=16, alpha=0.33, ...)
    >>> round(float(found.energy()), 12), found.residual() < 1e-12
    (0.01, True)
    >>> series = torus(chain, (1, 2), energy="0.01", method="series", order=8)
    >>> series.origin, 1e-6 < series.residual() < 1e-4
    (FromSeries(frequency order 8, order 8), True)
    """
    require_any_chain(chain)
    modes = chain.seeds_of(seeds)
    given = {
        "frequencies": frequencies,
        "amplitudes": amplitudes,
        "energy": energy,
        "start": start,
    }
    wish = {name: value for name, value in given.items() if value is not None}
    if len(wish) != 1:
        typed = ", ".join(wish) or "none of them"
        advice = 'say what fixes the torus, such as energy="0.01"'
        raise InputError(ONE_OF, typed, "exactly one of them", advice)
    if not chain.periodic:
        wish, modes = _ascending(wish, modes)
    tell = progress or unheard
    if method == SERIES:
        return series_torus(chain, modes, wish, order, digits, tell)
    if method != NEWTON:
        allowed = f"{NEWTON!r} or {SERIES!r}"
        raise InputError("method", method, allowed, f"leave it out for {NEWTON!r}")
    if order is not None:
        allowed = f"none without method={SERIES!r}"
        raise InputError("order", order, allowed, "Newton's method needs no order")
    tell("Newton's method", NO_FRACTION)
    found = _by_newton(chain, modes, wish, progress)
    if digits is None:
        return found
    return refine(found, **_with_ratio(wish, modes), digits=digits, progress=progress)


def _ascending(
    wish: dict[str, Any], modes: tuple[int, ...]
) -> tuple[dict[str, Any], tuple[int, ...]]:
    """Seeds in ascending order, each with its own frequency."""
    if "frequencies" in wish:
        values = frequencies_of(wish["frequencies"], modes)
        wish = {"frequencies": dict(zip(modes, values, strict=True))}
    return wish, tuple(sorted(modes))


def _with_ratio(wish: dict[str, Any], modes: tuple[int, ...]) -> dict[str, Any]:
    """What was asked, an energy with its ratio."""
    if "energy" not in wish:
        return wish
    energy = asked_energy(wish["energy"])
    if energy.amplitude_ratio is None and energy.energy_ratio is None and len(modes) > 1:
        equal: dict[int, Number] = dict.fromkeys(modes, 1)
        opposite = any(-q in modes for q in modes)
        name = "amplitude_ratio" if opposite else "energy_ratio"
        ratio: dict[str, Any] = {name: equal}
        energy = Energy(energy.value, harmonic=energy.harmonic, **ratio)
    return {"energy": energy}


def _by_newton(
    chain: Chain, modes: tuple[int, ...], wish: dict[str, Any], progress: Progress | None
) -> Torus[Newton | HarmonicBalance]:
    if len(modes) == 1 and not chain.periodic and "start" not in wish:
        return _breather(chain, modes[0], wish)
    wish = _with_ratio(wish, modes)
    guess = _guess(chain, modes, wish)
    begin = partial(at_part, guess)
    return from_rest(begin, prescribed_by(guess, wish), progress)


def _breather(chain: Chain, seed: int, wish: dict[str, Any]) -> Torus[HarmonicBalance]:
    """With fixed ends: the family from rest, which does not change to another one."""
    if "frequencies" in wish:
        (omega,) = frequencies_of(wish["frequencies"], (seed,))
        return breather_of_frequency(chain, seed, omega)
    if "amplitudes" in wish:
        signed = moderate_by_seed("amplitudes", wish["amplitudes"], (seed,), signed=True)
        return breather_of_amplitude(chain, seed, signed[seed])
    energy = asked_energy(wish["energy"])
    return breather_of_energy(chain, seed, energy)


def _guess(chain: Chain, modes: tuple[int, ...], wish: dict[str, Any]) -> Torus:
    """A short series near what is asked."""
    if "frequencies" in wish:
        return guess_of_frequencies(
            chain, modes, frequencies_of(wish["frequencies"], modes)
        )
    if "energy" in wish:
        return guess_of_amplitudes(
            chain, amplitudes_of_energy(chain, modes, wish["energy"])
        )
    name = "amplitudes" if "amplitudes" in wish else "start"
    numbers = moderate_by_seed(name, wish[name], modes, signed=True)
    return guess_of_amplitudes(chain, {q: float(numbers[q]) for q in modes})
