"""The file of a propagation certificate: JSON of plain strings, null and small integers."""

import re
from pathlib import Path

from symfpu.checkers.reading import (
    Json,
    check_digest,
    need,
    outside_strings,
    parsed,
    text_of,
)

FORMAT = "symfpu propagation certificate"
MOST_VALUES = 10**6


def read_certificate(path: Path) -> Json:
    """The contents of a file, its size bounded first.

    As neither floats nor booleans nor minus signs are let in, == and < are exact afterwards.
    """
    text = text_of(path)
    bare = outside_strings(text)
    values = sum(map(bare.count, ',[{"'))
    need(values <= MOST_VALUES, "the file has more than 10^6 values")
    strange = re.search(r'[^\s0-9{}\[\],:nul"]|[0-9]{21}', bare)
    need(not strange, "not JSON of plain strings, null and integers of at most 20 digits")
    data = parsed(text)
    check_header(data)
    check_digest(data)
    check_keys(data, bare.count(":"))
    return data


def check_header(data: Json) -> None:
    """It is a certificate of this kind, of the version that this checker knows."""
    need(data["format"] == FORMAT, "not a propagation certificate")
    schema = data["schema"]
    need(
        schema in (1, 2),
        f"schema version {schema!r:.40} is unknown: this checker supports versions 1, 2",
    )


def check_keys(data: Json, colons: int) -> None:
    """No key is missing, unknown or there twice: those we read are as many as the file has."""
    of_three = data["exceptions"] + data["undecided"] + data["points"] + data["vanishing"]
    of_five = data["excited"]
    expected = 13 + 2 * data["schema"] + 3 * len(of_three) + 5 * len(of_five)
    need(colons == expected, "a key is missing, unknown or there twice")
