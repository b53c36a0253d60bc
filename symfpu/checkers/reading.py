"""What checkers read certificates with: the text of a file, its kind and digest, its numbers.

It is a part of every checker and audited with it: it shares no code with the provers and imports
nothing but the standard library.
"""

import hashlib
import json
import re
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

LARGEST_FILE = 2**26  # bytes
LONGEST_NUMBER = 20_000  # characters
LONGEST_LAW = 100_000  # characters of all numbers of a potential, times their powers
MOST_BITS = 8192  # of a mantissa
EXACT = re.compile(r"-?[0-9]+(/[1-9][0-9]*)?")
READING_ERRORS = (
    OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError,
    ZeroDivisionError, OverflowError,
)  # fmt: skip

Json = dict[str, Any]


class CertificateError(ValueError):
    """Why a certificate is refused, in one line."""


class Kind(NamedTuple):
    """How certificates of one kind name themselves, their keys, and the bytes of the largest."""

    format: str
    schema: int
    keys: set[str]
    largest_file: int = LARGEST_FILE


def need(condition: object, reason: str) -> None:
    """Refuse the certificate unless the condition holds."""
    if not condition:
        raise CertificateError(reason)


def verified(
    path: str | Path, read: Callable[[Path], Json], check: Callable[[Json], list[str]]
) -> tuple[Json, list[str]]:
    """A certificate from its file, and lines that say what was checked.

    Raises CertificateError, with the reason, if it is not right.
    """
    try:
        certificate = read(Path(path))
        return certificate, check(certificate)
    except CertificateError:
        raise
    except READING_ERRORS as error:
        raise CertificateError(f"no readable certificate: {error!r:.200}") from None


# --- the file


def read_kind(path: Path, kind: Kind) -> Json:
    """A certificate of a kind; no floats, no booleans, no null, no key twice."""
    text = text_of(path, kind.largest_file)
    strange = re.search(r'[^\s0-9{}\[\],:"-]|[0-9]{3000}', outside_strings(text))
    need(not strange, "not JSON of plain strings and integers of less than 3000 digits")
    data = parsed(text)
    check_kind(data, kind)
    return data


def text_of(path: Path, largest_file: int = LARGEST_FILE) -> str:
    """What a file says, its size bounded first."""
    small = path.stat().st_size <= largest_file and path.is_file()
    need(small, f"not a regular file of at most {largest_file >> 20} MB")
    return path.read_text("ascii", "replace")


def outside_strings(text: str) -> str:
    """JSON without what stands in its strings."""
    return re.sub(r'"[^"\\]*"', '"', text)


def parsed(text: str) -> Json:
    """The object that JSON says, which names its format; no key twice."""
    data = json.loads(text, object_pairs_hook=without_repeats)
    need(type(data) is dict and "format" in data, "it names no format, as certificates do")
    return dict(data)


def without_repeats(pairs: list[tuple[str, Any]]) -> Json:
    """An object whose keys are there once."""
    need(len({key for key, _ in pairs}) == len(pairs), "a key is there twice")
    return dict(pairs)


def check_kind(data: Json, kind: Kind) -> None:
    """Its kind, its version, its keys, its digest."""
    need(data["format"] == kind.format, f"not a {kind.format}")
    need(data["schema"] == kind.schema, f"this checker supports schema {kind.schema}")
    need(set(data) == kind.keys, "a key is missing or unknown")
    check_digest(data)


def check_digest(data: Json) -> None:
    """The digest is that of everything else."""
    contents = {key: data[key] for key in data if key != "digest"}
    text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
    digest = hashlib.sha256(text.encode()).hexdigest()
    need(data["digest"] == digest, "the digest is not that of the contents")


# --- numbers


def whole(value: Any, least: int, most: int, name: str) -> int:
    """An integer in its range."""
    need(type(value) is int and least <= value <= most, f"{name} is out of its range")
    return int(value)


def fraction(text: Any, name: str) -> Fraction:
    """An exact number as it is written."""
    readable = type(text) is str and len(text) <= LONGEST_NUMBER and EXACT.fullmatch(text)
    need(readable, f"{name} is no fraction")
    return Fraction(text)


def fractions(texts: Any, power: int, name: str) -> list[Fraction]:
    """The exact numbers of a potential, whose products have so many factors at most."""
    need(type(texts) is list, f"{name}: no list")
    need(all(type(text) is str for text in texts), f"{name}: no fractions")
    fits = sum(map(len, texts)) * power <= LONGEST_LAW
    need(fits, f"{name}: more than {LONGEST_LAW} characters, times the powers")
    return [fraction(text, name) for text in texts]


def dyadic(pair: Any, name: str) -> Fraction:
    """m 2^-e of a pair [m, e], positive."""
    mantissa, places = pair
    whole(mantissa, 1, 2**MOST_BITS, name)
    whole(places, 0, 2 * MOST_BITS, name)
    return Fraction(mantissa, 1 << places)
