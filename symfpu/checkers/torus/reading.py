"""The file of a certificate of tori."""

from pathlib import Path

from symfpu.checkers.reading import Json, Kind, read_kind

FORMAT = "symfpu torus certificate"
KEYS = {
    "format", "schema", "N", "coefficients", "seeds", "omega", "bits", "torus", "residual",
    "energy",
    "frame_bits", "rate_bits", "directions", "weights", "stay", "digest",
}  # fmt: skip
KIND = Kind(FORMAT, 2, KEYS, largest_file=2**28)


def read_certificate(path: Path) -> Json:
    """A certificate from its file."""
    return read_kind(path, KIND)
