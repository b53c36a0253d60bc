"""The door to the series: what was typed is checked, and a ring chosen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from symfpu.chain.chain import Chain, require_any_chain
from symfpu.errors import InputError
from symfpu.files.progress import Progress
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, order_of, seed_modes
from symfpu.series.all_lengths import series_for_all_lengths
from symfpu.series.arguments import digits_of, frequencies_of
from symfpu.series.fixed_point import fixed_point_series
from symfpu.series.memory import check_size
from symfpu.series.monomials import monomial_space, wave_space
from symfpu.series.recursion import named_series
from symfpu.series.rings import BY_NAME, FLOAT64, RINGS
from symfpu.series.series import LindstedtSeries

Chosen = Sequence[Number] | Mapping[int, Number]
UNIVERSAL = tuple(name for name in BY_NAME if not RINGS[name].numeric)
ADVICE = "put a number for N: chain.at(N=32)"


@public
def lindstedt(
    chain: Chain,
    seeds: Sequence[int | str],
    frequencies: Chosen | None = None,
    order: int = 0,
    *,
    ring: str | None = None,
    digits: int | None = None,
    progress: Progress | None = None,
) -> LindstedtSeries:
    """The Poincare-Lindstedt series of a q-torus with free seed amplitudes (section 3.1).

    The series are those of Eqs. qser and omeser. On a ring they are of travelling waves.

    chain : the model; frequencies, amplitudes and times are in its units, dimensionless. With
        Chain("N", ...) the universal series of every N at once: valid_from is the N from which it
        holds, at_length(N) that of one chain. With ends="periodic" the series of travelling waves,
        ours, in doubles.
    seeds : distinct modes D_0; where N is a symbol also 'N-1', 'N-2', ... On a ring they are
        signed, and q and -q are two waves. The series of fixed ends has them ascending, that of a
        ring as given.
    frequencies : omega_q of each seed, exact numbers, shape (s,) or by seed; a float is read by
        its shortest decimal, so 0.33 is exactly 33/100. None gives the universal form with symbols
        L_q(nu).
    order : K of the coordinates and of the frequency corrections, from 0 up; order k has degree
        k+1 in the amplitudes (2k+1 if alpha = 0, and with both couplings beta enters two orders
        up).
    ring : 'float64', or in universal form 'symbolic' (expanded) or 'nested'; default by whether
        frequencies are given.
    digits : every coefficient to so many digits of the largest one of its order, proved
        (fixed-point numbers); None for doubles.
    progress : called as (label, fraction done).

    Differs from the paper: both couplings may act, mu is then alpha/sqrt(2N), and omega^(k) has
    degree k (alpha), 2k (beta) in the amplitudes, one less than printed.
    Raises InputError for arguments out of range, TooLarge before allocating what would not fit
    into memory, ResonantDivisor at the first divisor that is zero. On a ring it may be zero for the
    linear frequencies too, as 2 omega_(-q) - omega_q with mode q at q = N/4. What to do then is in
    the message and in docs/chains.md.

    >>> series = lindstedt(Chain(N=8, alpha="0.25"), seeds=(1,), order=1)
    >>> series.coordinates[1][-1, 1], series.coordinates[1][-1, 0]
    (-L_{2}(2), 0)
    >>> waves = lindstedt(Chain(N=8, beta=1, ends="periodic"), (1,), ("0.8",), 1)
    >>> waves.corrections[1].round(12).tolist()  # omega^2 = Omega^2 (1 + 3 mu |w|^2)
    [[3.0]]
    """
    if require_any_chain(chain).periodic:
        known = _known_on_ring(frequencies, ring, digits)
        modes = chain.seeds_of(seeds)
        omega = frequencies_of(known, modes)
        return series_of_waves(chain, modes, omega, order_of(order), progress)
    if chain.symbolic:
        ring = ring or "symbolic"
        _refuse_numbers(frequencies, digits, ring)
        return series_for_all_lengths(chain, seeds, order, ring, progress)
    given = seed_modes(seeds, chain.N)
    modes, order = tuple(sorted(given)), order_of(order)
    exact_frequencies = None
    if frequencies is not None:
        by_seed = dict(zip(given, frequencies_of(frequencies, given), strict=True))
        exact_frequencies = tuple(by_seed[q] for q in modes)
    if digits is not None:
        _require_no_ring(ring)
        return fixed_point_series(
            chain, modes, exact_frequencies, order, digits_of(digits), progress
        )
    ring = ring or ("symbolic" if frequencies is None else "float64")
    if ring not in BY_NAME:
        raise InputError(
            "ring", ring, f"one of {', '.join(BY_NAME)}", "name a ring or leave it out"
        )
    check_size(chain, modes, order, ring)
    space = monomial_space(chain, modes, order)
    return named_series(RINGS[ring], chain, space, exact_frequencies, order, progress)


def series_of_waves(
    chain: Chain,
    modes: tuple[int, ...],
    omega: tuple[Fraction, ...],
    order: int,
    progress: Progress | None,
    *,
    phantom: bool = False,
) -> LindstedtSeries:
    """The series on a ring, of checked arguments.

    phantom : whether the first seed's amplitude is needed to its first power only.
    """
    check_size(chain, modes, order, FLOAT64.name, phantom=phantom)
    space = wave_space(chain, modes, order, phantom=phantom)
    return named_series(FLOAT64, chain, space, omega, order, progress)


def _known_on_ring(
    frequencies: Chosen | None, ring: str | None, digits: int | None
) -> Chosen:
    """The frequencies; InputError for what travelling waves do not have."""
    if frequencies is None:
        allowed = "one number for each seed where ends='periodic': no universal form"
        advice = "give frequencies= near the linear ones"
        raise InputError("frequencies", None, allowed, advice)
    if ring not in {None, FLOAT64.name}:
        allowed = f"{FLOAT64.name!r} where ends='periodic'"
        raise InputError("ring", ring, allowed, "leave it out")
    if digits is not None:
        advice = "leave it out; standing waves have digits: Chain(N/2, ...) with fixed ends"
        allowed = "none where ends='periodic': doubles"
        raise InputError("digits", digits, allowed, advice)
    return frequencies


def _refuse_numbers(frequencies: object, digits: int | None, ring: str) -> None:
    """What has no meaning while N is a symbol."""
    given = {"frequencies": frequencies, "digits": digits}
    for name, value in given.items():
        if value is not None:
            raise InputError(name, value, "none while N is a symbol", ADVICE)
    if ring not in UNIVERSAL:
        raise InputError(
            "ring", ring, f"one of {', '.join(UNIVERSAL)} while N is a symbol", ADVICE
        )


def _require_no_ring(ring: str | None) -> None:
    if ring is not None:
        allowed = "none where digits are given: they have their own, of fixed-point numbers"
        raise InputError("ring", ring, allowed, "leave one of them out")
