"""What a potential of bonds must say of itself."""

from __future__ import annotations

from abc import ABC, abstractmethod
from fractions import Fraction
from typing import Any, ClassVar, NamedTuple

from symfpu.chain.bonds import Law
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Arithmetic
from symfpu.numbers.typed import Number, decimal, exact

SMALLEST_COUPLING = Fraction(1, 10**50)
COMPARED = (
    12  # the highest power of r at which a potential is held against its own coefficients
)


def checked_coupling(value: Number, name: str, *, zero: bool = True) -> Fraction:
    """An exact number in the range of couplings; InputError for any other."""
    number = exact(value, name)
    inside = SMALLEST_COUPLING <= abs(number) <= 1 / SMALLEST_COUPLING
    if not (inside or (zero and number == 0)):
        allowed = f"{'0, or ' if zero else ''}a number of size 1e-50 to 1e50"
        raise InputError(name, value, allowed, "rescale the amplitudes")
    return number


class Growth(NamedTuple):
    """A function g of the stretch with (1 + slope r) g' = rate g, g(0) = 1, that a tension adds.

    An exponential where slope is 0, else a power of 1 + slope r. The tension is
    sum weight (g - 1), so that sum weight rate = 1.
    """

    weight: Fraction
    slope: Fraction
    rate: Fraction

    def scaled(self, unit: Fraction) -> Growth:
        """The same of the tension times `unit`, as a function of r times `unit`."""
        return Growth(self.weight * unit, self.slope / unit, self.rate / unit)

    def taylor(self, highest: int) -> list[Fraction]:
        """The coefficients of weight g, of r^0 up to the highest power."""
        found = [Fraction(self.weight)]
        for power in range(highest):
            found.append(found[-1] * (self.rate - power * self.slope) / (power + 1))
        return found


class Potential(ABC):
    """V(r) = r^2/2 + c_3 r^3/3 + c_4 r^4/4 + ... of the stretch r of one bond; dimensionless.

    kind : its name, in words and as it is typed ("toda:1/2"), that of its file and of the function
        there that makes it; the file may have OTHER_NAMES to type.
    exact : whether the coefficients are known exactly; else they are rounded to `digits`.
    wall : the stretch where V is infinite, None where there is none; beyond it the functions of
        its law are not numbers.
    """

    kind: ClassVar[str]
    exact: bool = True
    digits: int | None = None
    wall: float | None = None

    @property
    @abstractmethod
    def parameters(self) -> tuple[Fraction, ...]:
        """The numbers that make it one of its kind."""

    @property
    def degree(self) -> int | None:
        """Of V as a polynomial in r; None for a series without end."""
        return None

    @property
    def even(self) -> bool:
        """Whether V(-r) = V(r)."""
        return False

    @abstractmethod
    def coefficient(self, n: int) -> Fraction:
        """c_n of V, n from 3 up."""

    @abstractmethod
    def law(self, numbers: Arithmetic) -> Law:
        """What the functions of symfpu.chain.bonds take, in an arithmetic."""

    @abstractmethod
    def expression(self, r: Any) -> Any:
        """V(r) as an expression of SymPy."""

    def growths(self) -> tuple[Growth, ...]:
        """The tension by functions that solve differential equations; empty where it is not.

        Series of an even V do not use them, whatever an author returns: proofs do.
        """
        return ()

    @property
    def text(self) -> str:
        """As it is typed: potential_of_text(p.text) == p."""
        return f"{self.kind}:{','.join(map(decimal, self.parameters))}"

    def __repr__(self) -> str:
        return f"{self.kind}({', '.join(map(decimal, self.parameters))})"


def require_consistent(potential: Potential) -> None:
    """InputError where `even` or `growths()` contradict exact coefficients, up to r^COMPARED."""
    if not potential.exact:
        return
    numbers = {n: potential.coefficient(n) for n in range(3, COMPARED + 1)}
    odd = [n for n, number in numbers.items() if n % 2 and number]
    if potential.even and odd:
        given = f"coefficient({odd[0]}) = {numbers[odd[0]]}"
        allowed = f"coefficient({odd[0]}) = 0, since V is even"
        raise InputError("potential", given, allowed, "correct even or coefficient")
    growths = [growth.taylor(COMPARED - 1) for growth in potential.growths()]
    for n, number in {2: Fraction(1), **numbers}.items():
        total = sum(taylor[n - 1] for taylor in growths)
        if growths and total != number:
            given = f"growths with c_{n} = {total}"
            allowed = f"growths whose sum has c_{n} = {number}, as the potential has"
            advice = "correct growths or coefficient"
            raise InputError("potential", given, allowed, advice)
