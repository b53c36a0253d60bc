"""Coefficients of the force that certificates of version 2 name, and those of named potentials."""

import re
from fractions import Fraction
from math import factorial
from typing import Any

from symfpu.checkers.reading import EXACT, Json, need

LONGEST_COEFFICIENTS = 10**5  # characters, the longest times the order
NAMED = re.compile(
    r"([a-z_]+):(-?[0-9.]+(?:/[1-9][0-9]*)?(?:,-?[0-9.]+(?:/[1-9][0-9]*)?)*)"
)


def of_polynomial(n: int, *coefficients: Fraction) -> Fraction:
    """c_n as it stands in the name."""
    return coefficients[n - 3] if n - 3 < len(coefficients) else Fraction(0)


def of_toda(n: int, a: Fraction) -> Fraction:
    """V = (e^(2ar) - 1 - 2ar)/(4a^2)."""
    return Fraction((2 * a) ** (n - 2), factorial(n - 1))


def of_lennard_jones(n: int, p: Fraction, q: Fraction) -> Fraction:
    """V = [((1+r)^-p - 1)/p - ((1+r)^-q - 1)/q]/(p - q)."""
    steep, flat = Fraction(binomial(-p, n), p), Fraction(binomial(-q, n), q)
    return Fraction(n * (steep - flat), p - q)


def binomial(power: Fraction, n: int) -> Fraction:
    """The coefficient of r^n in (1 + r)^power."""
    value = Fraction(1)
    for i in range(n):
        value *= Fraction(power - i, i + 1)
    return value


NAMED_POTENTIALS: dict[str, Any] = {
    "polynomial": of_polynomial,
    "toda": of_toda,
    "lennard_jones": of_lennard_jones,
}


def read_potential(data: Json, order: int) -> tuple[int, dict[int, Any]]:
    """The step of the degree, and g_n = c_(n+1) / unit^((n-1)/step), the unit being the first of
    the coefficients c_(2 + step), c_(2 + 2 step), ..., or 1 where that is zero.
    """
    step, texts = data["step"], data["coefficients"]
    need(step in (1, 2) and len(texts) == step * order, "step or number of coefficients")
    longest = max(map(len, texts), default=0)
    readable = all(map(EXACT.fullmatch, texts)) and longest * order <= LONGEST_COEFFICIENTS
    need(readable, "coefficients are no fractions, or too long")
    coefficients = list(map(Fraction, texts))  # c_3, c_4, ...
    check_name(data["potential"], coefficients)
    need(step == 1 or not any(coefficients[::2]), "step 2, and a coefficient of odd n")
    ordered = coefficients[step - 1 :: step]
    unit = ordered[0] if ordered and ordered[0] else Fraction(1)
    force = {1 + step * k: Fraction(c, unit**k) for k, c in enumerate(ordered, 1) if c}
    return step, force


def check_name(name: str, coefficients: list[Fraction]) -> None:
    """The coefficients are those of the potential named, if it is one of NAMED_POTENTIALS."""
    need(type(name) is str and "\n" not in name, "the potential has no name")
    if is_known(name):
        kind, numbers = parts_of(name)
        for n, c in enumerate(coefficients, 3):
            need(
                c == NAMED_POTENTIALS[kind](n, *numbers), f"c_{n} is not that of {name:.80}"
            )


def is_known(name: str) -> bool:
    """Whether the checker knows the coefficients of a potential of this name by itself."""
    return name.partition(":")[0] in NAMED_POTENTIALS


def parts_of(name: str) -> tuple[str, list[Fraction]]:
    """The kind and the numbers of a name such as toda:1/2."""
    found = NAMED.fullmatch(name)
    need(
        found and len(name) <= LONGEST_COEFFICIENTS,
        "the potential is not named as kind:p,q",
    )
    assert found is not None
    return found[1], [Fraction(number) for number in found[2].split(",")]
