"""The frequency of one mode to the fourth power of its amplitude, in closed form.

With W = Omega_q^2 and c_n of V = r^2/2 + sum c_n r^n/n, what follows the lowest correction is

    Omega_q (A_q^2/2N)^2 (c_3^4 f_1 + c_3^2 c_4 f_2 + c_4^2 f_3 + c_3 c_5 f_4 + c_6 f_5),
    f_1 = 1/W - 21/2 + 87/8 W - 255/64 W^2 - 3/4/(2-W) + 12/(4-W) + 9/4/(6-W),
    f_2 = 63/4 - 357/16 W + 645/64 W^2 + 9/4/(2-W) - 18/(4-W) - 27/4/(6-W),
    f_3 = -27/16 - 375/256 W^2 - 27/16/(2-W) + 27/4/(4-W) + 81/16/(6-W),
    f_4 = 12 W - 15/2 W^2,
    f_5 = 25/8 W^2.

The modes N/2, N/3 and 2N/3 are special: harmonics of theirs are missing, or fold back, and the f
are numbers. Ours, from the universal recursion (`frequency_expansion`) for every N at once, by
five potentials with whole numbers for c_n; tests derive it again, for the special modes too.

In Toda's chain all but f = 1/W - 3/4 + 3/(4-W) cancels, in units of c_3^4.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from symfpu.chain.potentials.potential import Potential

Row = tuple[Fraction, ...]


def _row(*numbers: str | int) -> Row:
    return tuple(map(Fraction, numbers))


# f_1 .. f_5 in 1/W, 1, W, W^2, 1/(2-W), 1/(4-W), 1/(6-W)
_GENERIC = (
    _row(1, "-21/2", "87/8", "-255/64", "-3/4", 12, "9/4"),
    _row(0, "63/4", "-357/16", "645/64", "9/4", -18, "-27/4"),
    _row(0, "-27/16", 0, "-375/256", "-27/16", "27/4", "81/16"),
    _row(0, 0, 12, "-15/2", 0, 0, 0),
    _row(0, 0, 0, "25/8", 0, 0, 0),
)
# f_1 .. f_5 by q/N
_SPECIAL = {
    Fraction(1, 2): _row(0, 0, "-15/16", 0, 5),
    Fraction(1, 3): _row("161/64", "-243/64", "-135/256", "27/8", "45/16"),
    Fraction(2, 3): _row("-485/192", "1557/64", "-1215/256", "-315/8", "495/16"),
}


def fourth_products(potential: Potential) -> Row:
    """c_3^4, c_3^2 c_4, c_4^2, c_3 c_5, c_6."""
    c3, c4, c5, c6 = (potential.coefficient(n) for n in (3, 4, 5, 6))
    return c3**4, c3**2 * c4, c4**2, c3 * c5, c6


def fourth_factor(
    potential: Potential, ratio: Fraction | None, square: Any, number: Any
) -> Any:
    """The sum in brackets above: c_3^4 f_1 + ... + c_6 f_5.

    ratio : q/N, None where N is a symbol. square : W, a number or a symbol. number : makes one of
    its kind of a fraction.
    """
    products = fourth_products(potential)
    special = _SPECIAL.get(ratio) if ratio is not None else None
    if special:
        return number(sum(map(Fraction.__mul__, products, special), Fraction(0)))
    W = square
    terms = (1 / W, 1, W, W**2, 1 / (2 - W), 1 / (4 - W), 1 / (6 - W))
    columns = zip(*_GENERIC, strict=True)
    total = number(Fraction(0))
    for term, column in zip(terms, columns, strict=True):
        weight = sum(map(Fraction.__mul__, products, column), Fraction(0))
        if weight:
            total += number(weight) * term
    return total
