"""The file of a certificate of stability."""

from pathlib import Path

from symfpu.checkers.reading import Json, Kind, read_kind

FORMAT = "symfpu stability certificate"
KEYS = {
    "format", "schema", "existence", "claim", "slope_harmonics", "free", "exponents", "digest",
}  # fmt: skip
KIND = Kind(FORMAT, 1, KEYS)


def read_certificate(path: Path) -> Json:
    """A certificate from its file."""
    return read_kind(path, KIND)
