"""The file of a certificate of existence: JSON of integers and strings, nothing else."""

from fractions import Fraction
from pathlib import Path
from typing import Any

from symfpu.checkers.reading import Json, Kind, need, read_kind, whole

FORMAT = "symfpu existence certificate"
KEYS = {
    "format", "schema", "ends", "N", "coefficients", "growths", "degree", "seed", "fixed", "value",
    "half_width", "omega", "nu", "bits", "orbit", "scales", "direction", "direction_frequency",
    "slope_harmonics", "free", "block", "inverse_bits", "inverse", "weight_bits", "weights",
    "radius", "unique", "amplitude", "energy", "frequency", "digest",
}  # fmt: skip
KIND = Kind(FORMAT, 3, KEYS)
MOST_BITS = 4096
DIGITS = {c: k for k, c in enumerate(chr(k) for k in range(33, 127) if chr(k) not in '"\\')}
BASE = len(DIGITS) // 2


def read_certificate(path: Path) -> Json:
    """A certificate from its file."""
    return read_kind(path, KIND)


def unpacked(text: Any, name: str) -> list[int]:
    """The integers of a text: digits of base 46, lowest first, all but the last 46 higher.

    An even number 2x is x, an odd 2x+1 is -x-1.
    """
    need(type(text) is str, f"{name} is no text")
    found, total, unit = [], 0, 1
    for character in text:
        need(character in DIGITS, f"{name} has a character that is no digit")
        value = DIGITS[character]
        total += value % BASE * unit
        unit *= BASE
        if value < BASE:
            need(value or unit == BASE, f"{name} has a number that begins with zeros")
            found.append(-(total >> 1) - 1 if total % 2 else total >> 1)
            total, unit = 0, 1
    need(unit == 1, f"{name} ends within a number")
    return found


def stated(entry: Any, name: str) -> tuple[Fraction, Fraction]:
    """The ends of an interval [middle, radius, e], units 2^-e."""
    middle, half, places = entry
    whole(middle, -(2**4100), 2**4100, name)
    whole(half, 0, 2**4100, name)
    whole(places, 0, MOST_BITS * 2, name)
    unit = 1 << places
    return Fraction(middle - half, unit), Fraction(middle + half, unit)
