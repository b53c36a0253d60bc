"""What can go wrong, as one tree of exceptions.

Every message is one line: what, where, next step. The plain numbers behind it are attributes of the exception.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


class SymfpuError(Exception):
    """Base of every error that this package raises on purpose.

    Raised itself where no more precise one exists. Ours. The message is one line: what, where, next step.
    Pickled and copied it stays whole, so that one failed case does not break a pool of processes.
    """

    def __reduce__(self) -> tuple[Any, ...]:
        """By arguments and attributes; Python's own way passes the message alone to the class."""
        return _rebuilt, (type(self), self.args), self.__dict__


def _rebuilt(kind: type[SymfpuError], args: tuple[Any, ...]) -> SymfpuError:
    """An error of this class with these arguments of `Exception`, without calling its own constructor."""
    return kind.__new__(kind, *args)


class RunInterrupted(KeyboardInterrupt):
    """The interrupt key in a run that is kept on disk. No SymfpuError: what catches errors lets it pass."""

    def __init__(self, place: str, path: str) -> None:
        self.place, self.path = place, path
        super().__init__(f"{place}; kept in {path}: the same call, or command, goes on from there")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.place, self.path)


class InputError(SymfpuError, ValueError):
    """An argument outside its range; raised by public functions, which check what they are given first.

    argument : its name; value : as given; allowed : what is; advice : what to do. The message says all four.
        A ValueError too. Ours.
    """

    def __init__(self, argument: str, value: object, allowed: str, advice: str) -> None:
        self.argument, self.value, self.allowed, self.advice = argument, value, allowed, advice
        super().__init__(f"{argument} = {value!r}: allowed is {allowed}; {advice}")


class TooLarge(InputError):
    """A series whose arrays would not fit into the free memory; raised before anything is allocated.

    Raised by `lindstedt` and its users. Ours.

    order : asked for; needed, free : bytes; largest : order that fits, negative if none does.
    """

    def __init__(self, order: int, needed: int, free: int, largest: int) -> None:
        self.order, self.needed, self.free, self.largest = order, needed, free, largest
        advice = f"take order {largest} or less, or fewer seeds" if largest >= 0 else "take fewer seeds or a shorter chain"
        InputError.__init__(self, "order", order, f"what fits into the {free:,} bytes of free memory ({needed:,} are needed)", advice)


class ResonantDivisor(InputError):
    """A divisor lambda_q - (nu.omega)^2 that is zero, or cannot be told from zero.

    Raised by `lindstedt` at the first one.

    mode, harmonic, order : q, nu and k of Eqs. moda, modb. exact : whether it is exactly zero, or too small
        to tell from zero in the ring at hand. All dimensionless integers.
    """

    def __init__(self, mode: int, harmonic: Sequence[int], seeds: Sequence[int], order: int, *, exact: bool) -> None:
        self.mode, self.harmonic, self.order, self.exact = mode, tuple(harmonic), order, exact
        combination = " ".join(f"{n:+d} omega_{q}" for n, q in zip(harmonic, seeds, strict=True) if n)
        own = "omega" if mode in seeds else "Omega"
        size = "= 0" if exact else "is below the resolution of doubles"
        last = [q for n, q in zip(harmonic, seeds, strict=True) if n]
        Exception.__init__(
            self,
            f"{own}_{mode}^2 - ({combination})^2 {size} at order {order}, mode {mode}, harmonic {self.harmonic}: "
            f"the frequencies are commensurable; change omega_{last[-1] if last else seeds[-1]}",
        )


class NoRealAmplitude(SymfpuError):
    """The frequencies ask for a negative squared amplitude in Eq. omeser.

    Raised by `solve_amplitudes` and its sisters.

    seed : the mode; squared : its A^2, dimensionless; frequency_order : K of the truncation.
    """

    def __init__(self, seed: int, squared: float, frequency_order: int) -> None:
        self.seed, self.squared, self.frequency_order = seed, squared, frequency_order
        need = "= 0, no oscillation" if squared == 0 else f"= {squared:.6g} < 0"
        advice = "choose a frequency off it" if squared == 0 else "or choose frequencies nearer to the linear ones"
        side = f"omega_{seed} is the linear frequency" if squared == 0 else f"move omega_{seed} to the other side of its linear value"
        super().__init__(
            f"no real amplitude: at frequency order {frequency_order} the frequencies need A_{seed}^2 {need}; {side}, {advice}"
        )


class DidNotConverge(SymfpuError):
    """Root finding of Eq. omeser ended without a root; raised by `solve_amplitudes` and `pade_amplitudes`.

    frequency_order : K of the truncation. iterate : the last amplitudes by seed; residual : |omega - series|
        there; both dimensionless.
    """

    def __init__(self, frequency_order: int, iterate: Mapping[int, float], residual: float) -> None:
        self.frequency_order, self.iterate, self.residual = frequency_order, dict(iterate), residual
        last = ", ".join(f"A_{q} = {a:.6g}" for q, a in self.iterate.items())
        super().__init__(
            f"no root of the frequency series truncated at order {frequency_order}: the last iterate {last} leaves "
            f"|omega - series| = {residual:.3g}; take a lower frequency_order or pass guess="
        )


class UndeterminedAmplitudes(SymfpuError):
    """The lowest frequency correction does not determine the squared amplitudes: its matrix is singular.

    Of Eq. omeser. Raised by `solve_amplitudes` and its sisters.

    seeds : the modes; frequency_order : of the correction, an integer.
    """

    def __init__(self, seeds: Sequence[int], frequency_order: int) -> None:
        self.seeds, self.frequency_order = tuple(seeds), frequency_order
        super().__init__(
            f"the frequency corrections of order {frequency_order} do not determine the amplitudes of the seeds {self.seeds}: "
            f"their matrix is singular, as for modes that stay harmonic at every amplitude; choose other seeds or add a coupling"
        )


class VanishingResidue(SymfpuError):
    """A divisor is zero modulo the chosen prime: nothing can be concluded at this point."""

    def __init__(self, prime: int, order: int) -> None:
        self.prime, self.order = prime, order
        super().__init__(f"a divisor vanishes modulo {prime} at order {order}; take another point")
