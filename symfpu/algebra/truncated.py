"""Power series in several variables, cut at a total degree, over any coefficients.

The coefficients need to add and multiply, and to divide 1 where a series is inverted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

Exponents = tuple[int, ...]
Part = dict[Exponents, Any]  # homogeneous, by exponents


class Truncated:
    """sum over e of c_e x^e, |e| <= top, plus what is of higher degree.

    parts : the homogeneous parts of degrees 0 .. top, each {exponents: coefficient}. size : number
    of variables.

    Numbers may stand on the other side of + and *; exact zeros are not kept. A sum or a product is
    known as far as both of its series are.

    >>> from fractions import Fraction
    >>> x, y = variables([Fraction(0), Fraction(0)], 2)
    >>> 1 / (1 + x + y)
    Truncated({(0, 0): 1, (1, 0): -1, (0, 1): -1, (2, 0): 1, (1, 1): 2, (0, 2): 1})
    """

    __slots__ = ("parts", "size")

    def __init__(self, parts: Sequence[Part], size: int) -> None:
        self.parts, self.size = list(parts), size

    def _with(self, parts: Sequence[Part]) -> Truncated:
        return Truncated(parts, self.size)

    @property
    def origin(self) -> Exponents:
        """The exponents of 1."""
        return (0,) * self.size

    def __repr__(self) -> str:
        listed = ", ".join(f"{e}: {c}" for e, c in self.items())
        return f"Truncated({{{listed}}})"

    @property
    def top(self) -> int:
        """The highest degree that is kept."""
        return len(self.parts) - 1

    def items(self) -> Iterator[tuple[Exponents, Any]]:
        """Exponents and coefficients, the lowest degree first."""
        for part in self.parts:
            yield from part.items()

    def coefficient(self, exponents: Exponents) -> Any:
        """Of one monomial; the integer 0 where it is none."""
        return self.parts[sum(exponents)].get(exponents, 0)

    def coefficients(self) -> list[Any]:
        """c_0, c_1, ... of a series in one variable."""
        return [part.get((n,), 0) for n, part in enumerate(self.parts)]

    def __bool__(self) -> bool:
        return any(self.parts)

    def __add__(self, other: Any) -> Truncated:
        if isinstance(other, Truncated):
            pairs = zip(self.parts, other.parts, strict=False)
            return self._with([_sum(a, b) for a, b in pairs])
        constant = _sum(self.parts[0], {self.origin: other})
        return self._with([constant, *self.parts[1:]])

    __radd__ = __add__

    def __neg__(self) -> Truncated:
        return self.__mul__(-1)

    def __sub__(self, other: Any) -> Truncated:
        return self.__add__(other * -1)

    def __rsub__(self, other: Any) -> Truncated:
        return self.__mul__(-1).__add__(other)

    def __mul__(self, other: Any) -> Truncated:
        if not isinstance(other, Truncated):
            return self._with([_times(part, other) for part in self.parts])
        known = min(len(self.parts), len(other.parts))
        found: list[Part] = [{} for _ in range(known)]
        for i, left in enumerate(self.parts[:known]):
            if not left:
                continue
            for j, right in enumerate(other.parts[: known - i]):
                _add_products(found[i + j], left, right)
        return self._with([_without_zeros(part) for part in found])

    __rmul__ = __mul__

    def __rtruediv__(self, number: Any) -> Truncated:
        return self.inverse().__mul__(number)

    def inverse(self) -> Truncated:
        """1 / series, degree by degree; ZeroDivisionError where the constant is zero."""
        if not self.parts[0]:
            raise ZeroDivisionError("the series has no constant")
        constant = self.parts[0][self.origin]
        head = Fraction(1, constant) if isinstance(constant, int) else 1 / constant
        found: list[Part] = [{self.origin: head}]
        for degree in range(1, len(self.parts)):
            part: Part = {}
            for j in range(1, degree + 1):
                _add_products(part, self.parts[j], found[degree - j])
            found.append(_without_zeros(_times(part, head * -1)))
        return self._with(found)

    def root(self) -> Truncated:
        """The square root that begins with 1, of a series that begins with 1."""
        found: list[Part] = [self.parts[0]]
        for degree in range(1, len(self.parts)):
            products: Part = {}
            for j in range(1, degree):
                _add_products(products, found[j], found[degree - j])
            left = _sum(self.parts[degree], _times(products, -1))
            found.append({e: c / 2 for e, c in left.items()})
        return self._with(found)

    def cut(self, top: int) -> Truncated:
        """Up to another degree; nothing is there beyond the one it has."""
        more: list[Part] = [{} for _ in range(top - self.top)]
        return self._with([*self.parts[: top + 1], *more])

    def composed(self, inner: Sequence[Truncated]) -> Truncated:
        """The series of series without constants, one for each variable."""
        total = inner[0] * 0
        for exponents, c in self.items():
            product: Any = c
            for n, series in zip(exponents, inner, strict=True):
                for _ in range(n):
                    product = series * product
            total = total + product
        return total


def in_one_variable(coefficients: Sequence[Any]) -> Truncated:
    """c_0 + c_1 x + ... + c_top x^top.

    >>> (1 / in_one_variable([1, -1, 0])).coefficients()
    [Fraction(1, 1), Fraction(1, 1), Fraction(1, 1)]
    """
    return Truncated([{(n,): c} if c else {} for n, c in enumerate(coefficients)], 1)


def variables(point: Sequence[Any], top: int, one: Any = 1) -> list[Truncated]:
    """point_i + (the variable i), cut at a degree of 1 or more; one : of the coefficients."""
    size = len(point)
    found = []
    for place, value in enumerate(point):
        head = {(0,) * size: value} if value else {}
        found.append(Truncated([head, *_linear(place, one, size, top)], size))
    return found


def inverted(series: Sequence[Truncated]) -> list[Truncated]:
    """The variables x_i as series in y_i = c_i x_i + (degrees 2 and more), no c_i zero.

    The linear part is diagonal. By iteration: each pass is right to one degree more.
    """
    size, top = len(series), series[0].top
    linear, curved = [], []
    for place, y in enumerate(series):
        head = 1 / y.coefficient(_raised((0,) * size, place, 1))
        linear.append(Truncated([{}, *_linear(place, head, size, top)], size))
        curved.append(Truncated([{}, {}, *y.parts[2:]], size) * (head * -1))
    found = linear
    for _ in range(top - 1):
        found = [x + part.composed(found) for x, part in zip(linear, curved, strict=True)]
    return found


def _linear(place: int, coefficient: Any, size: int, top: int) -> list[Part]:
    """The parts of degrees 1 .. top of a multiple of one variable."""
    unit = _raised((0,) * size, place, 1)
    return [{unit: coefficient}, *({} for _ in range(top - 1))]


def _raised(exponents: Exponents, place: int, by: int) -> Exponents:
    return (*exponents[:place], exponents[place] + by, *exponents[place + 1 :])


def _sum(a: Part, b: Part) -> Part:
    found = dict(a)
    for e, c in b.items():
        found[e] = found[e] + c if e in found else c
    return _without_zeros(found)


def _times(part: Part, number: Any) -> Part:
    return {e: c * number for e, c in part.items()} if number else {}


def _add_products(found: Part, left: Part, right: Part) -> None:
    for e, a in left.items():
        for f, b in right.items():
            key = tuple(map(int.__add__, e, f))
            found[key] = found[key] + a * b if key in found else a * b


def _without_zeros(part: Part) -> Part:
    return {e: c for e, c in part.items() if c}
