"""The file of a certificate of stability: JSON of integers and strings, nothing else."""

import hashlib
import json
import re
from pathlib import Path
from typing import Any

FORMAT = "symfpu stability certificate"
SCHEMA = 1
KEYS = {
    "format", "schema", "existence", "claim", "slope_harmonics", "free", "exponents", "digest",
}  # fmt: skip
LARGEST_FILE = 2**26  # bytes
READING_ERRORS = (
    OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError,
    ZeroDivisionError, OverflowError,
)  # fmt: skip

Json = dict[str, Any]


class StabilityError(ValueError):
    """Why a certificate is refused, in one line."""


def need(condition: object, reason: str) -> None:
    """Refuse the certificate unless the condition holds."""
    if not condition:
        raise StabilityError(reason)


def read_certificate(path: Path) -> Json:
    """The contents of a file, its size bounded first; no floats, no booleans, no null."""
    small = path.is_file() and path.stat().st_size <= LARGEST_FILE
    need(small, "not a regular file of at most 64 MB")
    text = path.read_text("ascii", "replace")
    bare = re.sub(r'"[^"\\]*"', '"', text)  # without what stands in strings
    strange = re.search(r'[^\s0-9{}\[\],:"-]|[0-9]{1300}', bare)
    need(not strange, "not JSON of plain strings and integers of at most 1300 digits")
    data: Json = json.loads(text, object_pairs_hook=without_repeats)
    need(set(data) == KEYS, "a key is missing or unknown")
    need(data["format"] == FORMAT, "not a certificate of stability")
    need(data["schema"] == SCHEMA, f"this checker supports schema {SCHEMA}")
    check_digest(data)
    return data


def without_repeats(pairs: list[tuple[str, Any]]) -> Json:
    """An object whose keys are there once."""
    need(len({key for key, _ in pairs}) == len(pairs), "a key is there twice")
    return dict(pairs)


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
