"""The file of a theorem for every N."""

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

FORMAT = "symfpu rule for all N certificate"
KEYS = (
    "count digest exceptions flats format model order points schema seeds_number undecided "
    "verdict witnesses"
)


def read_theorem(path: Path) -> Json:
    """The contents, without floats, booleans and minus signs: == and < are exact afterwards."""
    text = text_of(path)
    bare = outside_strings(text)
    strange = re.search(r'[^\s0-9{}\[\],:nul"]|[0-9]{21}', bare)
    need(not strange, "not JSON of plain strings, null and integers of at most 20 digits")
    data = parsed(text)
    need(data["format"] == FORMAT, "not a theorem for all N")
    need(data["schema"] == 2, "schema version unknown: this checker supports version 2")
    once = bare.count(":") == len(data)
    need(
        once and " ".join(sorted(data)) == KEYS, "a key is missing, unknown or there twice"
    )
    check_digest(data)
    return data
