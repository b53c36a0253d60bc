"""The linearised flow beside all kinds of waves: K is symmetric, its blocks are its products with unit vectors."""

from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, lindstedt, refine, solve_amplitudes, unfold
from symfpu.normal.linearised import Linearised
from tests.tolerances import ROUNDING

RING = Chain(7, alpha="0.3", beta=1, ends="periodic")
HARMONICS = np.array([[0, 0], [1, 0], [0, 1], [1, 1], [1, -1], [2, 0], [0, 2], [2, 1], [1, 2]])
EACH = pytest.mark.parametrize(
    ("kind", "q"), [("fixed", 3), ("fixed", 4), ("standing", 3), ("standing", -2), ("standing", 5), ("travelling", 3), ("travelling", -1)]
)


@cache
def torus(kind):
    if kind == "travelling":
        return refine(solve_amplitudes(lindstedt(RING, (1, -2), ("0.875", "1.575"), 4)))
    fixed = refine(symfpu.torus(Chain(5, alpha="0.3"), (1, 2), amplitudes={1: "0.3", 2: "0.2"}, method="series", order=4))
    return fixed if kind == "fixed" else unfold(fixed)


def flow_of(kind, q):
    return Linearised(torus(kind), HARMONICS).of(q)


@EACH
def test_products_are_symmetric_and_blocks_are_theirs(kind, q):
    flow, draws = flow_of(kind, q), np.random.default_rng(0)
    mask = flow.allowed(q)
    assert mask[0, flow.column(q)]
    u, v = (np.where(mask, draws.normal(size=mask.shape), 0) for _ in range(2))
    work = np.sum(u * flow.coupling(v))
    assert work == pytest.approx(np.sum(v * flow.coupling(u)), rel=ROUNDING)
    assert abs(work) > 1e-3
    rows, columns = np.nonzero(mask)
    block = flow.block(rows, columns)
    assert np.allclose(block @ v[mask], flow.coupling(v)[mask], rtol=0, atol=ROUNDING)
    means = np.broadcast_to(flow.means, mask.shape)[mask]
    assert np.allclose(block.diagonal(), means, rtol=0, atol=ROUNDING)
    assert (flow.scaled(0.5).block(rows, columns) == block / 2).all()


@EACH
def test_unknowns_are_named_by_the_modes_of_the_chain(kind, q):
    flow, chain = flow_of(kind, q), torus(kind).chain
    mask = flow.allowed(q)
    numbers = np.array(chain.mode_numbers)
    p = np.where(mask, np.random.default_rng(1).normal(size=mask.shape), 0)
    every = flow.by_mode(p)
    assert (flow.table(every) == p).all()
    for row, column in np.argwhere(mask):
        assert every[row, numbers == flow.mode_at(row, column)].tolist() == [p[row, column]]
    assert flow.mode_at(0, flow.column(q)) == q
    assert flow.frequency(q) == pytest.approx(chain.frequencies()[numbers == q][0], rel=ROUNDING)


def test_sines_about_standing_waves_are_deviations_of_the_fixed_ends():
    """And cosines, at rest of the same frequencies, are not."""
    fixed, sines = flow_of("fixed", 3), flow_of("standing", 3)
    p = np.where(fixed.allowed(3), np.random.default_rng(2).normal(size=(len(fixed.harmonics), 4)), 0)
    assert (fixed.coupling(p) == sines.coupling(p)).all()
    cosines = sines.of(-3)
    assert cosines.of(3).projection.modes.tolist() == sines.projection.modes.tolist()
    assert (cosines.linear[0, :4] == sines.linear[0]).all()
    driven, other = sines.coupling(p), cosines.coupling(np.pad(p, ((0, 0), (0, 1))))[:, :4]
    assert np.abs(other - driven).max() > np.abs(driven).max() / 10
