"""The projection that the ends of a chain make."""

from __future__ import annotations

from collections.abc import Sequence

from symfpu.chain.chain import Chain
from symfpu.chain.projections.modes import ModeProjection
from symfpu.chain.projections.projection import Ints, Projection
from symfpu.chain.projections.waves import WaveProjection

PROJECTIONS: dict[str, type[ModeProjection] | type[WaveProjection]] = {
    "fixed": ModeProjection,
    "periodic": WaveProjection,
}


def projection(chain: Chain, seeds: Sequence[int], harmonics: Ints) -> Projection:
    """That of the tori of some seeds at harmonics (H, s); of a ring, of travelling waves."""
    return PROJECTIONS[chain.ends](chain, seeds, harmonics)


def count_points(chain: Chain) -> int:
    """How many points it has."""
    return PROJECTIONS[chain.ends].points_of(chain)


def count_columns(chain: Chain) -> int:
    """How many columns a row of coefficients of its tori has."""
    return PROJECTIONS[chain.ends].columns_of(chain)
