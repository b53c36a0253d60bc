"""Projections of harmonics onto bonds: stretches against those of the chain, transposes, couplings against their sums."""

import mpmath
import numpy as np
import pytest

from symfpu import Chain
from symfpu.chain.projections.by_ends import count_points, projection
from symfpu.chain.projections.standing import SineProjection
from tests.tolerances import ROUNDING

HARMONICS = np.array([[0, 0], [1, 0], [0, 1], [2, -1], [1, 3], [-3, 2]])
FIXED = [(Chain(N, alpha="0.3"), seeds) for N, seeds in ((3, (1, 2)), (8, (1, 6)), (9, (4, 2)))]
RINGS = [(Chain(N, alpha="0.3", ends="periodic"), seeds) for N, seeds in ((5, (1, -2)), (8, (4, 3)))]
CASES = [(chain, seeds, None) for chain, seeds in FIXED + RINGS] + [(chain, seeds, q) for chain, seeds in RINGS for q in (1, -2)]
STANDING = [(Chain(2 * chain.N, alpha="0.3", ends="periodic"), seeds, q) for chain, seeds in FIXED[1:] for q in (5, -3)]
EACH = pytest.mark.parametrize(("chain", "seeds", "deviation"), CASES + STANDING, ids=repr)


def made(chain, seeds, deviation):
    if (chain, seeds, deviation) in STANDING:
        found = SineProjection(chain, Chain(chain.N // 2, alpha="0.3"), seeds, HARMONICS)
    else:
        found = projection(chain, seeds, HARMONICS)
    return found if deviation is None else found.deviating(deviation)


def draw(*shape, seed=1):
    return np.random.default_rng(seed).normal(size=shape)


@pytest.mark.parametrize(("chain", "seeds"), FIXED, ids=repr)
def test_stretches_of_modes_are_those_of_the_chain(chain, seeds):
    """At any angles, of the half of the bonds that is enough; the whole table has all of them."""
    there, c = made(chain, seeds, None), draw(len(HARMONICS), chain.N - 1)
    cosines = np.cos(draw(7, 2, seed=2) @ HARMONICS.T)
    expected = chain.stretches(cosines @ c)
    assert np.abs(cosines @ there.to_points(c) - expected[:, : there.points]).max() < ROUNDING * np.abs(expected).max()
    assert np.abs(cosines @ c @ there.every_bond - expected).max() < ROUNDING * np.abs(expected).max()


@pytest.mark.parametrize(("chain", "seeds"), RINGS, ids=repr)
def test_a_deviation_stretches_the_bonds_in_turn(chain, seeds):
    """x_j = N^(-1/2) sum p exp(i nu.theta - 2 pi i m j/N): bond j has what the one point has, at angles of its own."""
    N, q = chain.N, 2
    there, p = made(chain, seeds, q), draw(len(HARMONICS), 1)
    theta, j = draw(2, seed=2), np.arange(N + 1)
    m = q + HARMONICS @ np.array(seeds)
    x = np.exp(1j * (HARMONICS @ theta)[:, None] - 2j * np.pi / N * np.outer(m, j)).T @ p[:, 0] / N**0.5
    turned = theta - 2 * np.pi / N * np.multiply.outer(j[:-1] + 0.5, seeds)
    own = np.exp(-2j * np.pi * q / N * (j[:-1] + 0.5)) * -1j
    assert np.abs(own * (np.exp(1j * turned @ HARMONICS.T) @ there.to_points(p)[:, 0]) - np.diff(x)).max() < ROUNDING * np.abs(x).max()


@pytest.mark.parametrize(("chain", "seeds", "q"), STANDING, ids=repr)
def test_sines_and_cosines_stretch_the_bonds_of_the_ring(chain, seeds, q):
    """x_j = sum Q_q sin(q pi j/N) or cos; the norm of a cosine q = N is that of the others over sqrt(2)."""
    there, N = made(chain, seeds, q), chain.N // 2
    Q, j = draw(1, there.columns), np.arange(N + 1)
    waves = np.pi / N * np.outer(np.abs(there.modes[0]), j)
    x = np.sqrt(2 / N) * (Q * np.where(there.modes == N, np.sqrt(0.5), 1)) @ (np.sin(waves) if q > 0 else np.cos(waves))
    sign = 1 if q > 0 else -1
    assert np.abs(there.to_points(Q) - sign * np.diff(x)[:, : there.points]).max() < ROUNDING * np.abs(x).max()


@EACH
def test_what_tensions_drive_is_the_transpose(chain, seeds, deviation):
    """With as many bonds as each point stands for; in portions, too."""
    there = made(chain, seeds, deviation)
    c, t = draw(len(HARMONICS), there.columns), draw(len(HARMONICS), there.points, seed=3)
    work = (there.to_points(c) * t * there.images).sum()
    assert (there.from_points(t) * c).sum() == pytest.approx(work, rel=ROUNDING)
    assert (there.transposed(t * there.images) * c).sum() == pytest.approx(work, rel=ROUNDING)
    parts = [slice(0, 1), slice(1, None)] if there.points > 1 else [slice(0, None)]
    portions = sum(there.from_points(t[:, part], part) for part in parts)
    assert np.allclose(portions, there.from_points(t), rtol=ROUNDING, atol=ROUNDING)
    assert np.allclose(np.hstack([there.to_points(c, part) for part in parts]), there.to_points(c), rtol=ROUNDING, atol=ROUNDING)
    assert there.images.sum() == there.chain.N
    assert there.points == count_points(there.chain)
    assert (there.to_points(c.astype(np.longdouble)).dtype, there.to_points(c).dtype) == (np.longdouble, np.float64)


def coupled(there, slope, row, column, other):
    """The sum over the points, by the table, of a column of a row to all columns of another row."""
    table = np.broadcast_to(there.stretch.astype(float), (len(HARMONICS), there.columns, there.points))
    return (table[other] * (there.images * slope)) @ table[row, column]


@EACH
def test_couplings_are_sums_over_the_points(chain, seeds, deviation):
    there, rows = made(chain, seeds, deviation), np.arange(len(HARMONICS))
    slopes = draw(there.points, 9, seed=4)
    table, places = there.coupling_table(slopes), [np.full((1, there.columns), place) for place in (3, 5)]
    every, at = np.arange(there.columns), 4
    scale = there.scales(np.full(there.columns, at), every)
    for column in range(there.columns):
        expected = coupled(there, slopes[:, 3] + slopes[:, 5], at, column, at)
        found = scale[column] * scale * there.between(table, places, np.array([[column]]), every)[0]
        assert np.allclose(found, expected, rtol=0, atol=ROUNDING * there.images.sum())
        found = there.couplings(slopes[:, 0], rows[1:], np.full(5, column), rows[:-1], least=0.0)
        expected = [coupled(there, slopes[:, 0], row, column, row - 1) for row in rows[1:]]
        assert np.allclose(found, expected, rtol=0, atol=ROUNDING * there.images.sum())
    diagonal = np.broadcast_to(there.diagonal(slopes[:, 0]), (len(HARMONICS), there.columns))
    assert diagonal[at, -1] == pytest.approx(coupled(there, slopes[:, 0], at, there.columns - 1, at)[-1], rel=ROUNDING)


@EACH
def test_norms_and_variances_are_those_of_the_transpose(chain, seeds, deviation):
    there = made(chain, seeds, deviation)
    t = draw(len(HARMONICS), there.points, seed=5)
    assert np.linalg.norm(there.from_points(t)) <= there.largest_norm(t.T) * (1 + ROUNDING)
    variances = np.abs(t[0])
    units = np.array([there.from_points(np.tile(unit, (len(HARMONICS), 1))) for unit in np.eye(there.points)])
    expected = np.sqrt(np.tensordot(variances, units**2, axes=1))
    assert np.allclose(np.broadcast_to(there.from_variances(variances), expected.shape), expected, rtol=ROUNDING)


@EACH
def test_exact_rows_are_those_of_the_table(chain, seeds, deviation):
    there = made(chain, seeds, deviation)
    with mpmath.workdps(40):
        linear, rows = there.exact_rows()
    omega, stretch = np.array(linear, dtype=float)[there.entries], np.array(rows, dtype=float)[there.entries]
    assert np.abs(omega - there.omega).max() <= ROUNDING
    assert np.abs(stretch - there.stretch).max() <= ROUNDING


@EACH
def test_other_harmonics_have_their_own_waves(chain, seeds, deviation):
    """Also after the first ones were asked for their masks and places."""
    whole = made(chain, seeds, deviation)
    part = HARMONICS[2:5]
    count = len(HARMONICS)
    every = [np.broadcast_to(x, (count, whole.columns)) for x in (whole.mask, whole.modes, whole.omega)]
    p = draw(count, whole.columns)
    by_mode = whole.by_mode(p)
    there = whole.at(part)
    for found, expected in zip((there.mask, there.modes, there.omega), every, strict=True):
        assert (np.broadcast_to(found, (3, whole.columns)) == expected[2:5]).all()
    assert (there.by_mode(p[2:5]) == by_mode[2:5]).all()
    high, low = whole.omega_in_halves()
    assert (high == whole.omega).all()
    assert (np.abs(low) <= np.finfo(np.longdouble).eps * high).all()


@EACH
def test_modes_of_the_chain_have_the_coefficients(chain, seeds, deviation):
    there = made(chain, seeds, deviation)
    moving = np.broadcast_to(there.modes != 0, (len(HARMONICS), there.columns))
    p = np.where(moving, draw(len(HARMONICS), there.columns), 0)
    every = there.by_mode(p)
    assert (there.from_modes(every) == p).all()
    numbers = np.array(chain.mode_numbers)
    row, column = np.argwhere(moving)[-1]
    mode = np.broadcast_to(there.modes, p.shape)[row, column]
    assert every[row, numbers == mode].tolist() == [p[row, column]]
