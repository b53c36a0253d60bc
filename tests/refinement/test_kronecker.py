"""Forces by Kronecker products against the closed law at angles of their own, within the bound that they state."""

import mpmath
import numpy as np
import pytest

from symfpu import Chain
from symfpu.numbers.arithmetic import MULTIPRECISION
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.kronecker import Box, KroneckerForce
from tests.tolerances import KRONECKER_BOUND

BITS = 120
CHAINS = {
    "alpha": (Chain(4, alpha="0.3"), (1, 2)),
    "beta": (Chain(5, beta="-0.4"), (1, 2)),
    "both, three angles": (Chain(4, alpha="0.3", beta="0.2"), (1, 2, 3)),
    "fifth power": (Chain(3, potential="poly:0,0,0,1"), (1, 2)),
    "toda": (Chain(4, potential="toda:1/2"), (1, 3)),
    "lennard-jones": (Chain(3, potential="lj:2,1"), (1,)),
}


def small_torus(chain, seeds):
    """Harmonics up to length 2, coefficients (H, N-1) of some hundredths where the rules allow them."""
    axes = np.meshgrid(*[np.arange(-2, 3)] * len(seeds), indexing="ij")
    rows = np.stack(axes, axis=-1).reshape(-1, len(seeds))
    lead = rows[np.arange(len(rows)), np.argmax(rows != 0, axis=1)]
    harmonics = rows[(np.abs(rows).sum(axis=1) <= 2) & (lead >= 0)]
    mask = InvarianceEquation(chain, seeds, harmonics).mask
    random = np.random.default_rng(3).uniform(-0.02, 0.02, mask.shape)
    return harmonics, np.where(mask, np.round(random * 2**20) / 2**20, 0)


def at(values, harmonics, theta):
    """Of coefficients, at one point of the angles, as mpf (N-1,)."""
    cosines = [mpmath.cos(mpmath.fdot(nu, theta)) for nu in harmonics.tolist()]
    return np.array([mpmath.fdot(cosines, column) for column in values.T])


@pytest.mark.parametrize("name", CHAINS)
def test_the_force_is_that_of_the_closed_law_within_its_bound(name):
    chain, seeds = CHAINS[name]
    harmonics, doubles = small_torus(chain, seeds)
    angles = range(1, len(seeds) + 1)
    box = Box([4 if len(seeds) > 2 else 8] * len(seeds), whole=True)
    reach = 0.25
    with mpmath.workprec(2 * BITS):
        force = KroneckerForce(InvarianceEquation(chain, seeds, harmonics).projection, box, BITS, reach)
        c = np.array([[force.fixed(mpmath.mpf(x)) for x in row] for row in doubles], dtype=object)
        wanted = box.harmonics
        values, off = force.force(harmonics, c, wanted)
        allowed = InvarianceEquation(chain, seeds, wanted).mask
        found = np.array([[mpmath.ldexp(int(x), -BITS) for x in row] for row in np.where(allowed, values, 0)], dtype=object)
        limit = [mpmath.ldexp(int(x), -BITS) for x in off]
        exact = np.array([[mpmath.mpf(x) for x in row] for row in doubles], dtype=object)
        squares = [chain.linear_frequency(q) ** 2 for q in range(1, chain.N)]
        for theta in ([mpmath.mpf("0.3") * i for i in angles], [mpmath.mpf(3 - i) for i in angles]):
            Q = at(exact, harmonics, theta)
            anharmonic = -(chain.accelerations(MULTIPRECISION.array(Q)) + squares * Q)
            left = np.abs(at(found, wanted, theta) - anharmonic)
            assert all(left <= limit)
            assert max(left) < KRONECKER_BOUND * max(abs(anharmonic))


def test_the_force_on_travelling_waves_is_that_of_their_one_function():
    """N^(1/2) Omega_m times the tension alpha r^2, but for its mean, which drives nothing: at angles of its own."""
    chain, harmonics = Chain(7, alpha="3/10", ends="periodic"), np.array([[1], [2]])
    with mpmath.workprec(2 * BITS):
        there = InvarianceEquation(chain, (2,), harmonics).projection
        force = KroneckerForce(there, Box([4], whole=True), BITS, 0.25)
        exact = [mpmath.mpf("0.25"), mpmath.mpf("-0.03125")]
        c = np.array([[force.fixed(x)] for x in exact], dtype=object)
        wanted = np.arange(5)[:, None]
        values, off = force.force(harmonics, c, wanted)
        linear = [chain.linear_frequency(2 * nu % 7) for nu in range(5)]
        heights = [Omega * x / mpmath.sqrt(7) for Omega, x in zip(linear[1:3], exact, strict=True)]
        mean = sum(x**2 for x in heights) / 2
        assert values[0, 0] == 0
        for theta in (mpmath.mpf("0.3"), mpmath.mpf(2)):
            cosines = [mpmath.cos(nu * theta) for nu in range(5)]
            r = mpmath.fdot(heights, cosines[1:3])
            pairs = zip(values[1:, 0], linear[1:], cosines[1:], strict=True)
            found = sum(mpmath.ldexp(int(x), -BITS) / (mpmath.sqrt(7) * Omega) * y for x, Omega, y in pairs)
            assert abs(found - 3 * (r**2 - mean) / 10) < mpmath.ldexp(int(off[0]), -BITS)
        doubled = np.concatenate([harmonics, harmonics + 2])
        table = np.concatenate([c, 0 * c])
        squares = force.squares(doubled)[:, 0]
        assert [mpmath.ldexp(int(x), -BITS) for x in squares] == pytest.approx([float(w) ** 2 for w in linear[1:]])
        assert (force.force(doubled, table, wanted)[0] == values).all()


def test_what_is_cut_off_is_counted():
    """A square of cos(theta) in a box that has no place for cos(2 theta)."""
    chain = Chain(2, alpha=1)
    harmonics = np.array([[1]])
    with mpmath.workprec(2 * BITS):
        force = KroneckerForce(InvarianceEquation(chain, (1,), harmonics).projection, Box([1], whole=True), BITS, 1)
        _, off = force.force(harmonics, np.array([[force.fixed(mpmath.mpf("0.1"))]], dtype=object), harmonics)
        stretch = mpmath.mpf("0.1") * chain.linear_frequency(1) * mpmath.cospi(mpmath.mpf(1) / 4)
        back = 2 * chain.linear_frequency(1) * mpmath.cospi(mpmath.mpf(1) / 4)
        assert back * stretch**2 / 2 < mpmath.ldexp(int(off[0]), -BITS) < back * stretch**2


def test_the_bound_counts_the_rounding_of_what_takes_modes_to_bonds():
    """A long wave has larger amplitudes than stretches: the table of its stretches in 80 bits, rounded, is what the force is off by."""
    N, amplitude = 64, 50_000
    chain, harmonics = Chain(N, alpha="1/3"), np.array([[1]])
    wanted = np.arange(3)[:, None]
    there = InvarianceEquation(chain, (1,), harmonics).projection
    values = []
    for bits in (80, 200):
        with mpmath.workprec(2 * bits):
            force = KroneckerForce(there, Box([2], whole=True), bits, 256.0)
            c = np.zeros((1, N - 1), dtype=object)
            c[0, 0] = amplitude << bits
            found, off = force.force(harmonics, c, wanted)
            values.append([found >> (bits - 80), off])
    (coarse, limit), (fine, _) = values
    allowed = InvarianceEquation(chain, (1,), wanted).mask
    differences = np.where(allowed, abs(coarse - fine), 0).max(axis=0)
    assert (differences <= limit).all()
    assert differences.max() > 0
