"""The gallery `generated/`: a few tori in every language, with commands and hashes.

`make generated` rebuilds it. Tori are solved with digits to spare and rounded once, so the
same commands give the same bytes on any machine.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from symfpu.chain.chain import Chain
from symfpu.codegen.export import LANGUAGES, export
from symfpu.files.writing import write_text
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

DIGITS = 30  # of the series; doubles have 17


class Example(NamedTuple):
    """One torus of the gallery.

    series_orders : where its series with free amplitudes is cut; empty where it is not shown.
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[str, ...]
    order: int
    series_orders: dict[str, int] = {}  # noqa: RUF012 - never changed

    def solve_command(self, name: str) -> str:
        """The command that writes it as name.symfpu."""
        law = self.chain.typed_law
        words = [f"symfpu solve -N {self.chain.N}"]
        words += [f"--{key} {value}" for key, value in law.items() if value != "0"]
        words.append(f"--seeds {','.join(map(str, self.seeds))}")
        words.append(f"--omega {','.join(self.frequencies)}")
        words.append(f"--order {self.order} --digits {DIGITS} -o {name}.symfpu")
        return " ".join(words)

    def torus(self) -> Torus[FromSeries]:
        """The torus itself."""
        series = lindstedt(
            self.chain,
            self.seeds,
            self.frequencies,
            self.order,
            digits=DIGITS,
        )
        return solve_amplitudes(series)


FOUR_FREQUENCIES = (
    "0.09813690483108113",
    "0.19603499627351076",
    "0.29346131418681830",
    "0.39018079936090050",
)
SERIES_ORDERS = {"order": 3, "frequency_order": 4}

GALLERY = {
    "two_torus": Example(
        Chain(16, "0.33"),
        seeds=(1, 2),
        frequencies=("0.19626", "0.39046"),
        order=12,
        series_orders=SERIES_ORDERS,
    ),
    "four_torus": Example(
        Chain(32, "0.33"),
        seeds=(1, 2, 3, 4),
        frequencies=FOUR_FREQUENCIES,
        order=4,
    ),
    "breather_25": Example(
        Chain(32, "0.33"),
        seeds=(25,),
        frequencies=("1.8830741847088537",),
        order=12,
    ),
    "beta_torus": Example(
        Chain(16, beta="0.6"),
        seeds=(2, 3),
        frequencies=("0.3925", "0.5845"),
        order=4,
        series_orders=SERIES_ORDERS,
    ),
    "toda_torus": Example(
        Chain(16, potential="toda:0.33"),
        seeds=(1, 2),
        frequencies=("0.19626", "0.39046"),
        order=8,
    ),
}

Manifest = dict[str, dict[str, object]]  # file -> its commands and hash


def build(folder: Path) -> Path:
    """Write every example in every language, and the manifest; existing files are replaced."""
    folder.mkdir(parents=True, exist_ok=True)
    manifest: Manifest = {}
    for name, example in GALLERY.items():
        torus = example.torus()
        for language in LANGUAGES:
            manifest |= _written(folder, name, torus, language, {})
            if example.series_orders:
                manifest |= _written(
                    folder, name, torus.origin.series, language, example.series_orders
                )
    return write_manifest(folder, manifest)


def _written(
    folder: Path,
    name: str,
    solution: Torus[FromSeries] | LindstedtSeries,
    language: str,
    orders: Mapping[str, Any],
) -> Manifest:
    """Write one file; its entry of the manifest. orders : of a series."""
    file = f"{name}_mp" if language == "mpmath" else name  # NumPy has the same extension
    words = []
    if orders:
        file = f"{file}_series"
        words.append("--series")
        words += [f"--{key.replace('_', '-')} {k}" for key, k in orders.items()]
    begin = f"symfpu export {name}.symfpu --lang {language} -o {file}"
    command = " ".join([begin, *words])
    path = export(solution, language, folder / file, **orders, force=True, command=command)
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    commands = [GALLERY[name].solve_command(name), command]
    return {path.name: {"commands": commands, "sha256": digest}}


def write_manifest(folder: Path, manifest: Manifest) -> Path:
    """The list of files with their commands and hashes."""
    path = folder / "manifest.json"
    text = json.dumps(manifest, indent=1)
    write_text(path, text + "\n")
    return path


if __name__ == "__main__":
    print(build(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(tempfile.mkdtemp())))
