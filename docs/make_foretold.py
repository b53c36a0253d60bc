"""The picture of docs/dynamics.md of alignment indices foretold, beside integrated ones.

python docs/make_foretold.py
"""

from __future__ import annotations

from pathlib import Path

import symfpu
from symfpu import Chain, alignment_indices, foretold_indices, normal_modes, refine

PICTURE = Path(__file__).with_name("foretold.png")
VECTORS = 6
LAST_TIME = 1e9
INTEGRATED_TO, STEP = 1e6, 0.1


def main() -> None:
    """The torus of the example on the page, its indices by both routes, and the picture."""
    import matplotlib as mpl

    mpl.use("Agg")
    from symfpu import plots

    torus = refine(
        symfpu.torus(
            Chain(8, alpha="0.3"),
            (1, 2),
            amplitudes={1: "0.3", 2: "0.2"},
            method="series",
            order=6,
        )
    )
    foretold = foretold_indices(
        torus, LAST_TIME, vectors=VECTORS, normal=normal_modes(torus)
    )
    observed = alignment_indices(
        torus.chain, *torus.state(0.0), INTEGRATED_TO, vectors=VECTORS, step=STEP, frames=1
    )
    print(foretold, observed, sep="\n")
    axes = plots.foretold(foretold, observed=observed)
    axes.figure.savefig(PICTURE, dpi=110, bbox_inches="tight", metadata={"Software": None})


if __name__ == "__main__":
    main()
