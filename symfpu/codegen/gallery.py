"""The gallery `generated/`: a few tori in every language, each with the commands that make it and a hash. `make generated` rebuilds it.

Tori are solved with digits to spare and rounded once, so the same commands give the same bytes on any machine.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from symfpu.chain.chain import Chain
from symfpu.codegen.export import LANGUAGES, export
from symfpu.files.writing import write_text
from symfpu.numbers.typed import decimal
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.torus import QTorus

DIGITS = 30  # of the series; doubles have 17


class Example(NamedTuple):
    """One torus of the gallery. series_orders : where its series with free amplitudes is cut; empty where it is not shown."""

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[str, ...]
    order: int
    series_orders: dict[str, int] = {}  # noqa: RUF012 - never changed

    def solve_command(self, name: str) -> str:
        """The command that writes it as name.symfpu."""
        couplings = " ".join(
            f"--{key} {decimal(value)}" for key, value in (("alpha", self.chain.alpha), ("beta", self.chain.beta)) if value
        )
        seeds, omega = ",".join(map(str, self.seeds)), ",".join(self.frequencies)
        return (
            f"symfpu solve -N {self.chain.N} {couplings} --seeds {seeds} --omega {omega} --order {self.order} "
            f"--digits {DIGITS} -o {name}.symfpu"
        )

    def torus(self) -> QTorus:
        """The torus itself."""
        return solve_amplitudes(lindstedt(self.chain, self.seeds, self.frequencies, self.order, digits=DIGITS))


GALLERY = {
    "two_torus": Example(Chain(16, "0.33"), (1, 2), ("0.19626", "0.39046"), 12, {"order": 3, "frequency_order": 4}),
    "four_torus": Example(
        Chain(32, "0.33"),
        (1, 2, 3, 4),
        ("0.09813690483108113", "0.19603499627351076", "0.29346131418681830", "0.39018079936090050"),
        4,
    ),
    "breather_25": Example(Chain(32, "0.33"), (25,), ("1.8830741847088537",), 12),
    "beta_torus": Example(Chain(16, beta="0.6"), (2, 3), ("0.3925", "0.5845"), 4, {"order": 3, "frequency_order": 4}),
}


def build(folder: Path) -> Path:
    """Write every example in every language, and the manifest; returns its path. Existing files are replaced."""
    folder.mkdir(parents=True, exist_ok=True)
    manifest: dict[str, dict[str, object]] = {}
    for name, example in GALLERY.items():
        torus = example.torus()
        for language in LANGUAGES:
            stem = f"{name}_mp" if language == "mpmath" else name
            for solution, file, orders in ((torus, stem, {}), (torus.series, f"{stem}_series", example.series_orders)):
                if solution is torus or orders:
                    words = ["", *(["--series"] if orders else []), *(f"--{key.replace('_', '-')} {k}" for key, k in orders.items())]
                    command = f"symfpu export {name}.symfpu --lang {language} -o {file}{' '.join(words)}"
                    path = export(solution, language, folder / file, **orders, force=True, command=command)
                    digest = hashlib.sha256(path.read_bytes()).hexdigest()
                    manifest[path.name] = {"commands": [example.solve_command(name), command], "sha256": digest}
    return write_manifest(folder, manifest)


def write_manifest(folder: Path, manifest: dict[str, dict[str, object]]) -> Path:
    """The list of files with their commands and hashes."""
    path = folder / "manifest.json"
    write_text(path, json.dumps(manifest, indent=1) + "\n")
    return path


if __name__ == "__main__":
    print(build(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(tempfile.mkdtemp())))
