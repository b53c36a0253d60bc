"""What can go wrong, as one tree of exceptions.

Every message is one line: what, where, next step. The plain numbers behind it are attributes of
the exception.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

LONGEST_SHOWN = 300  # characters of a value in a message


class SymfpuError(Exception):
    """Base of every error that this package raises on purpose.

    Raised itself where no more precise one exists. Ours. The message is one line: what, where,
    next step. Pickled and copied it stays whole, so that one failed case does not break a pool of
    processes.
    """

    def __reduce__(self) -> tuple[Any, ...]:
        """By arguments and attributes; Python's own way passes the message alone to the class."""
        return _rebuilt, (type(self), self.args), self.__dict__


def _rebuilt(kind: type[SymfpuError], args: tuple[Any, ...]) -> SymfpuError:
    """An error of this class with these arguments of `Exception`.

    Its own constructor is not called.
    """
    return kind.__new__(kind, *args)


class RunInterrupted(KeyboardInterrupt):
    """The interrupt key in a run that is kept on disk.

    Raised by `integrate`, `alignment_indices` and `family`.

    No SymfpuError: what catches errors lets it pass. place : how far the run is, in words.
    path : where it is kept; the same call goes on from there. Ours.
    """

    def __init__(self, place: str, path: str) -> None:
        self.place = place
        self.path = path
        super().__init__(
            f"{place}; kept in {path}: the same call, or command, goes on from there"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.place, self.path)


class InputError(SymfpuError, ValueError):
    """An argument outside its range.

    Raised by public functions, which check what they are given first.

    argument : its name; value : as given; allowed : what is; advice : what to do. The message
        says all four. A ValueError too. Ours.
    """

    def __init__(self, argument: str, value: object, allowed: str, advice: str) -> None:
        self.argument = argument
        self.value = value
        self.allowed = allowed
        self.advice = advice
        super().__init__(f"{argument} = {shown(value)}: allowed is {allowed}; {advice}")


def shown(value: object) -> str:
    """A value on one line of at most LONGEST_SHOWN characters."""
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # an integer of more digits than Python prints
        text = f"{type(value).__name__} of many digits"
    if len(text) <= LONGEST_SHOWN:
        return text
    return f"{text[:LONGEST_SHOWN]}... ({len(text)} characters)"


def what_fits(needed: int, free: int) -> str:
    return f"what fits into the {free:,} bytes of free memory ({needed:,} are needed)"


class TooLarge(InputError):
    """A series whose arrays would not fit into the free memory.

    Raised by `lindstedt` and its users, before anything is allocated. Ours.

    order : asked for; needed, free : bytes; largest : order that fits, negative if none does.
    """

    def __init__(self, order: int, needed: int, free: int, largest: int) -> None:
        self.order = order
        self.needed = needed
        self.free = free
        self.largest = largest
        allowed = what_fits(needed, free)
        advice = "take fewer seeds or a shorter chain"
        if largest >= 0:
            advice = f"take order {largest} or less, or fewer seeds"
        InputError.__init__(self, "order", order, allowed, advice)


class TorusTooLarge(InputError):
    """A torus whose refinement would not fit into the free memory.

    Raised by `refine`, its sisters and what uses them, before its equations are made. Ours.

    N : of the chain; harmonics : that it asks for; needed, free : bytes; largest : number of
        harmonics that fits, 0 if none does.
    """

    def __init__(
        self, N: int, harmonics: int, needed: int, free: int, largest: int
    ) -> None:
        self.N = N
        self.harmonics = harmonics
        self.needed = needed
        self.free = free
        self.largest = largest
        allowed = what_fits(needed, free)
        advice = "take a shorter chain"
        if largest:
            advice = f"take most_harmonics={largest} or less, or a larger tolerance"
        count = f"{harmonics:,} of N = {N}"
        InputError.__init__(self, "harmonics", count, allowed, advice)


class ExpansionTooLarge(InputError):
    """An expanded polynomial that would not fit into the free memory, or into integers of 64 bits.

    Raised by what expands coefficients of a universal series, before anything is allocated. Ours.

    terms : at most; needed, free : bytes.
    """

    def __init__(self, terms: float, needed: float, free: int) -> None:
        self.terms = terms
        self.needed = needed
        self.free = free
        size = f"{terms:.3g} terms, {needed:.3g} bytes"
        allowed = (
            f"what fits into the {free:.3g} bytes of free memory, and integers of 64 bits"
        )
        advice = 'ask for form="factored" or "cse", or for a lower order'
        InputError.__init__(self, "expansion", size, allowed, advice)


class ResonantDivisor(InputError):
    """A divisor lambda_q - (nu.omega)^2 that is zero, or cannot be told from zero.

    Raised by `lindstedt` at the first one.

    mode, harmonic, order : q, nu and k of Eqs. moda, modb. exact : whether it is exactly zero, or
        too small to tell from zero in the ring at hand. All dimensionless integers. way_out : what
        to do where the linear frequencies themselves are resonant, as on a ring; else empty.
    """

    def __init__(
        self,
        mode: int,
        harmonic: Sequence[int],
        seeds: Sequence[int],
        order: int,
        *,
        exact: bool,
        way_out: str = "",
    ) -> None:
        self.mode = mode
        self.harmonic = tuple(harmonic)
        self.order = order
        self.exact = exact
        self.way_out = way_out
        if way_out:
            Exception.__init__(self, self._of_linear_frequencies(seeds))
            return
        present = [(n, q) for n, q in zip(harmonic, seeds, strict=True) if n]
        combination = " ".join(f"{n:+d} omega_{q}" for n, q in present)
        own = "omega" if mode in seeds else "Omega"
        size = "= 0" if exact else "is below the resolution of doubles"
        _, last = present[-1] if present else (0, seeds[-1])
        place = f"order {order}, mode {mode}, harmonic {self.harmonic}"
        resonance = f"{own}_{mode}^2 - ({combination})^2 {size} at {place}"
        advice = f"the frequencies are commensurable; change omega_{last}"
        Exception.__init__(self, f"{resonance}: {advice}")

    def _of_linear_frequencies(self, seeds: Sequence[int]) -> str:
        """A resonance of the chain itself, whatever frequencies are chosen."""
        present = [(n, q) for n, q in zip(self.harmonic, seeds, strict=True) if n]
        combination = " ".join(f"{n:+d} Omega_{q}" for n, q in present)
        place = f"order {self.order}, mode {self.mode}, harmonic {self.harmonic}"
        return f"Omega_{self.mode}^2 - ({combination})^2 = 0 at {place}: {self.way_out}"


class NoRealAmplitude(SymfpuError):
    """The frequencies ask for a negative squared amplitude in Eq. omeser.

    Raised by `solve_amplitudes` and its sisters.

    seed : the mode; squared : its A^2, dimensionless; frequency_order : K of the truncation.
    """

    def __init__(self, seed: int, squared: float, frequency_order: int) -> None:
        self.seed = seed
        self.squared = squared
        self.frequency_order = frequency_order
        if squared == 0:
            need = "= 0, no oscillation"
            side = f"omega_{seed} is the linear frequency"
            advice = "choose a frequency off it"
        else:
            need = f"= {squared:.6g} < 0"
            side = f"move omega_{seed} to the other side of its linear value"
            advice = "or choose frequencies nearer to the linear ones"
        demand = (
            f"at frequency order {frequency_order} the frequencies need A_{seed}^2 {need}"
        )
        super().__init__(f"no real amplitude: {demand}; {side}, {advice}")


class DidNotConverge(SymfpuError):
    """Root finding of Eq. omeser ended without a root.

    Raised by `solve_amplitudes` and `pade_amplitudes`.

    frequency_order : K of the truncation. iterate : the last amplitudes by seed;
        residual : |omega - series| there; both dimensionless.
    """

    def __init__(
        self, frequency_order: int, iterate: Mapping[int, float], residual: float
    ) -> None:
        self.frequency_order = frequency_order
        self.iterate = dict(iterate)
        self.residual = residual
        last = ", ".join(f"A_{q} = {a:.6g}" for q, a in self.iterate.items())
        where = f"no root of the frequency series truncated at order {frequency_order}"
        left = f"the last iterate {last} leaves |omega - series| = {residual:.3g}"
        super().__init__(f"{where}: {left}; take a lower frequency_order or pass guess=")


class UndeterminedAmplitudes(SymfpuError):
    """The lowest frequency correction does not determine the squared amplitudes.

    Its matrix is singular.

    Of Eq. omeser. Raised by `solve_amplitudes` and its sisters.

    seeds : the modes; frequency_order : of the correction, an integer.
    """

    def __init__(self, seeds: Sequence[int], frequency_order: int) -> None:
        self.seeds = tuple(seeds)
        self.frequency_order = frequency_order
        corrections = f"the frequency corrections of order {frequency_order}"
        undetermined = f"do not determine the amplitudes of the seeds {self.seeds}"
        matrix = (
            "their matrix is singular, as for modes that stay harmonic at every amplitude"
        )
        advice = "choose other seeds or add a coupling"
        super().__init__(f"{corrections} {undetermined}: {matrix}; {advice}")


class VanishingResidue(SymfpuError):
    """A divisor is zero modulo the chosen prime: nothing can be concluded at this point."""

    def __init__(self, prime: int, order: int) -> None:
        self.prime = prime
        self.order = order
        super().__init__(
            f"a divisor vanishes modulo {prime} at order {order}; take another point"
        )
