"""The file of a certificate of existence: JSON of integers and strings, nothing else."""

import hashlib
import json
import re
from fractions import Fraction
from pathlib import Path
from typing import Any

FORMAT = "symfpu existence certificate"
SCHEMA = 2
KEYS = {
    "format", "schema", "N", "coefficients", "growths", "degree", "seed", "fixed", "value",
    "half_width", "omega", "nu", "bits", "orbit", "scales", "direction", "direction_frequency",
    "slope_harmonics", "free", "block", "inverse_bits", "inverse", "weight_bits", "weights",
    "radius", "unique", "amplitude", "energy", "frequency", "digest",
}  # fmt: skip
LARGEST_FILE = 2**26  # bytes
MOST_BITS = 4096
LONGEST_NUMBER = 2000  # characters
EXACT = re.compile(r"-?[0-9]+(/[1-9][0-9]*)?")
DIGITS = {c: k for k, c in enumerate(chr(k) for k in range(33, 127) if chr(k) not in '"\\')}
BASE = len(DIGITS) // 2
READING_ERRORS = (
    OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError,
    ZeroDivisionError, OverflowError,
)  # fmt: skip

Json = dict[str, Any]


class ExistenceError(ValueError):
    """Why a certificate is refused, in one line."""


def need(condition: object, reason: str) -> None:
    """Refuse the certificate unless the condition holds."""
    if not condition:
        raise ExistenceError(reason)


def read_certificate(path: Path) -> Json:
    """The contents of a file, its size bounded first; no floats, no booleans, no null."""
    small = path.is_file() and path.stat().st_size <= LARGEST_FILE
    need(small, "not a regular file of at most 64 MB")
    text = path.read_text("ascii", "replace")
    bare = re.sub(r'"[^"\\]*"', '"', text)  # without what stands in strings
    strange = re.search(r'[^\s0-9{}\[\],:"-]|[0-9]{1300}', bare)
    need(not strange, "not JSON of plain strings and integers of at most 1300 digits")
    data: Json = json.loads(text)
    need(bare.count(":") == len(KEYS), "a key is missing, unknown or there twice")
    need(set(data) == KEYS, "a key is missing, unknown or there twice")
    need(data["format"] == FORMAT, "not a certificate of existence")
    need(data["schema"] == SCHEMA, f"this checker supports schema {SCHEMA}")
    check_digest(data)
    return data


def check_digest(data: Json) -> None:
    """The digest is that of everything else."""
    contents = {key: data[key] for key in data if key != "digest"}
    text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
    digest = hashlib.sha256(text.encode()).hexdigest()
    need(data["digest"] == digest, "the digest is not that of the contents")


def whole(value: Any, least: int, most: int, name: str) -> int:
    """An integer in its range."""
    need(type(value) is int and least <= value <= most, f"{name} is not in {least}..{most}")
    return int(value)


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


def fraction(text: Any, name: str) -> Fraction:
    """An exact number as it is written."""
    readable = type(text) is str and len(text) <= LONGEST_NUMBER and EXACT.fullmatch(text)
    need(readable, f"{name} is no fraction")
    return Fraction(text)


def dyadic(pair: Any, name: str) -> Fraction:
    """m 2^-e of a pair [m, e], positive."""
    mantissa, places = pair
    whole(mantissa, 1, 2**64, name)
    whole(places, 0, MOST_BITS * 2, name)
    return Fraction(mantissa, 1 << places)


def stated(entry: Any, name: str) -> tuple[Fraction, Fraction]:
    """The ends of an interval [middle, radius, e], units 2^-e."""
    middle, half, places = entry
    whole(middle, -(2**4100), 2**4100, name)
    whole(half, 0, 2**4100, name)
    whole(places, 0, MOST_BITS * 2, name)
    unit = 1 << places
    return Fraction(middle - half, unit), Fraction(middle + half, unit)
