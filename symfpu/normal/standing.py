"""Standing waves on a ring: which of its modes are sines.

A torus of standing waves on a ring of 2N is one of fixed ends on N bonds, unfolded: odd about site
0. Deviations from it are sines and cosines apart (`symfpu.chain.projections.standing`).
"""

from __future__ import annotations

from collections.abc import Mapping

from symfpu.chain.chain import Chain
from symfpu.chain.projections.standing import is_sine
from symfpu.tori.columns import half_of
from symfpu.tori.torus import Torus


def coupled_groups(
    torus: Torus, sigma: Mapping[int, float]
) -> list[tuple[Chain, dict[int, float]]]:
    """Frequencies that may couple, by mode, with the chain whose selection rules they have.

    All of them, but about standing waves sines and cosines apart, by the rules of fixed ends.
    """
    ring = torus.chain
    if not torus.stands:
        return [(ring, dict(sigma))]
    fixed = half_of(ring)
    sines = {q: w for q, w in sigma.items() if is_sine(ring, q)}
    cosines = {q: w for q, w in sigma.items() if q not in sines}
    return [(fixed, sines), (fixed, cosines)]
