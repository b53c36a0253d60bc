"""Numbers are what was typed.

"0.33" and Fraction(33, 100) are exact, a float is read by its shortest decimal.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from numbers import Integral, Rational, Real
from typing import Any

import mpmath
import symengine as se

from symfpu.errors import InputError

# bits; longer fractions are written in hexadecimal, which no limit of Python concerns
LONGEST_DECIMAL = 3000
LONGEST_NUMBER = 1000  # characters of a number, and the largest power of ten in it
LARGEST_LENGTH = 10**6  # bonds; a list of all modes still fits into any memory
LARGEST_INTEGER = 2**63 - 1  # what machines count with
HIGHEST_ORDER = 10_000  # of any series or set of modes
SMALLEST_ENERGY = Fraction(1, 10**50)
Number = int | float | str | Fraction | Decimal


def exact(value: object, argument: str) -> Fraction:
    """The rational number that `value` denotes; InputError naming `argument` if it denotes none.

    >>> exact("0.33", "alpha"), exact(0.1, "alpha"), exact("1/3", "alpha")
    (Fraction(33, 100), Fraction(1, 10), Fraction(1, 3))
    """
    try:
        if isinstance(value, bool):
            raise TypeError("a truth value is no number")
        if isinstance(value, str):
            exponent = re.search(r"[eE]([+-]?\d+)", value)
            if len(value) > LONGEST_NUMBER or (
                exponent and abs(int(exponent[1])) > LONGEST_NUMBER
            ):
                raise ValueError("too long")
            return Fraction(value.strip())
        if isinstance(value, Rational):
            return Fraction(int(value.numerator), int(value.denominator))
        if isinstance(value, Decimal):
            return Fraction(value)
        if isinstance(value, mpmath.mpf):
            return _of_binary(value)
        if isinstance(value, Real):
            return Fraction(Decimal(repr(float(value))))
        raise TypeError("not a real number")
    except (
        TypeError,
        ValueError,
        OverflowError,
        ZeroDivisionError,
        InvalidOperation,
    ) as error:
        raise InputError(
            argument,
            value,
            "a finite number such as 0.33, '1/3' or Fraction(1, 3)",
            "write it as a decimal or a fraction",
        ) from error


def _of_binary(value: Any) -> Fraction:
    """The exact value of an mpf; ValueError where it is not finite."""
    if not mpmath.isfinite(value):
        raise ValueError("not finite")
    sign, mantissa, exponent, _ = value._mpf_
    size = Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
    return -size if sign else size


def integer(value: object, argument: str, least: int) -> int:
    """`value` as an int from `least` to LARGEST_INTEGER; InputError naming `argument` otherwise."""
    allowed = f"an integer from {least} up"
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise InputError(argument, value, allowed, "pass a whole number")
    number = int(value)
    if number < least:
        raise InputError(argument, number, allowed, f"take {least} or more")
    if number > LARGEST_INTEGER:
        raise InputError(argument, number, f"{allowed} to 2^63 - 1", "take a smaller one")
    return number


def random_seed(value: object, argument: str = "seed") -> int:
    """Any whole number from 0 up: NumPy's generators take seeds of every length."""
    if isinstance(value, Integral) and int(value) > LARGEST_INTEGER:
        return int(value)
    return integer(value, argument, 0)


def length_of(N: object, least: int = 2) -> int:
    """A number of bonds from `least` to LARGEST_LENGTH; InputError for any other."""
    return integer_between(N, "N", least, LARGEST_LENGTH, "a shorter chain")


def order_of(order: object, least: int = 0, *, argument: str = "order") -> int:
    """An order from `least` to HIGHEST_ORDER; InputError for any other.

    What a series of that order needs is another question: `check_size` says the highest that fits.
    """
    return integer_between(order, argument, least, HIGHEST_ORDER, "a lower order")


def integer_between(
    value: object, argument: str, least: int, most: int, advice: str
) -> int:
    """An integer from `least` to `most`; InputError for any other."""
    number = integer(value, argument, least)
    if number > most:
        allowed = f"an integer from {least} to {most}"
        raise InputError(argument, number, allowed, f"take {advice}")
    return number


def seed_modes(seeds: Iterable[object], N: int) -> tuple[int, ...]:
    """The seeds as integers in 1 .. N-1, in the given order.

    InputError if empty, repeated, outside or not integers.
    """
    allowed = f"distinct integers in 1..{N - 1} (N = {N})"
    return distinct_modes(seeds, range(1, N), allowed)


def distinct_modes(
    seeds: Iterable[object], existing: Container[int], allowed: str
) -> tuple[int, ...]:
    """Modes of a chain, of those that exist; InputError as of seed_modes."""
    modes: list[int] = []
    try:
        listed = list(seeds)
    except TypeError as error:
        raise InputError(
            "seeds", seeds, allowed, "pass a sequence such as (1, 2)"
        ) from error
    for seed in listed:
        if isinstance(seed, bool) or not isinstance(seed, Integral):
            raise InputError("seeds", seed, allowed, "pass whole numbers")
        modes.append(int(seed))
        if modes[-1] not in existing:
            raise InputError(
                "seeds", modes[-1], allowed, "name a mode of the chain or take a longer one"
            )
    if not modes:
        raise InputError("seeds", (), allowed, "name at least one seed mode")
    if len(set(modes)) < len(modes):
        raise InputError("seeds", tuple(modes), allowed, "name every seed once")
    return tuple(modes)


def rational(value: Fraction) -> Any:
    """The SymEngine number equal to an exact fraction."""
    return se.Integer(value.numerator) / se.Integer(value.denominator)


def decimal(value: Fraction) -> str:
    """The shortest text that gives the exact number back: a finite decimal, or p/q.

    >>> decimal(Fraction(33, 100)), decimal(Fraction(1, 3))
    ('0.33', '1/3')
    """
    power, rest = 0, value.denominator
    for prime in (2, 5):
        count = 0
        while rest % prime == 0:
            rest, count = rest // prime, count + 1
        power = max(power, count)
    if rest != 1:
        return str(value)
    digits = f"{abs(value.numerator) * 10**power // value.denominator:0{power + 1}d}"
    text = (
        f"{digits[: len(digits) - power]}.{digits[len(digits) - power :]}"
        if power
        else digits
    )
    return f"-{text}" if value < 0 else text


def double(value: Number, name: str) -> float:
    try:
        return float(exact(value, name))
    except OverflowError as error:
        raise InputError(
            name, value, "a number within the range of doubles", "take a smaller one"
        ) from error


def part(value: Number, name: str) -> float:
    """A number between 0 and 1, neither of them; InputError for any other."""
    found = double(value, name)
    if not 0 < found < 1:
        allowed = "a number between 0 and 1"
        raise InputError(name, value, allowed, "take a part of the whole such as 1e-3")
    return found


def energy_of(value: Number, argument: str = "energy") -> Fraction:
    """An energy H > 0 that doubles can hold, with its powers; InputError for any other."""
    energy = exact(value, argument)
    if not SMALLEST_ENERGY <= energy <= 1 / SMALLEST_ENERGY:
        allowed = "a positive number of size 1e-50 to 1e50"
        raise InputError(argument, value, allowed, "rescale the amplitudes")
    return energy


def fraction_text(value: Fraction) -> str:
    """The exact number as text that `fraction` reads: a decimal or p/q.

    It is hexadecimal where it is long.
    """
    if value.numerator.bit_length() + value.denominator.bit_length() <= LONGEST_DECIMAL:
        return decimal(value)
    return f"{value.numerator:#x}/{value.denominator:#x}"


def fraction(written: str) -> Fraction:
    """The exact number that `fraction_text` wrote; ValueError for anything else."""
    if re.fullmatch(r"-?0x[0-9a-f]+/0x[0-9a-f]+", written, re.ASCII):
        numerator, denominator = written.split("/")
        return Fraction(int(numerator, 16), int(denominator, 16))
    if re.fullmatch(r"-?\d+(\.\d+|/\d+)?", written, re.ASCII):
        return Fraction(written)
    raise ValueError(f"{written!r:.40} is no exact number")
