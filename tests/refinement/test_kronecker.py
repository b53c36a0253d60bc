"""Forces by Kronecker products against the closed law at angles of their own, within the bound that they state."""

import mpmath
import numpy as np
import pytest

from symfpu.chain.chain import Chain
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
        force = KroneckerForce(chain, box, BITS, reach)
        c = np.array([[force.fixed(mpmath.mpf(x)) for x in row] for row in doubles], dtype=object)
        wanted = box.harmonics
        values, off = force.force(harmonics, c, wanted)
        allowed = InvarianceEquation(chain, seeds, harmonics).allowed(wanted)
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


@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.parametrize("highest", [(3,), (2, 4), (2, 1, 3)])
def test_harmonics_of_a_product_in_the_box_are_apart(highest, whole):
    """Of two functions in the box, against the convolution."""
    box = Box(highest, whole=whole)
    random = np.random.default_rng(1)
    rows = box.harmonics
    functions = []
    for _ in range(2):
        half = {tuple(nu): int(x) for nu, x in zip(rows.tolist(), random.integers(-9, 9, len(rows)), strict=True)}
        functions.append({**half, **{tuple(-n for n in nu): x for nu, x in half.items()}})
    one, two = (box.packed(np.array([2 * f[tuple(nu)] for nu in rows.tolist()], dtype=object)) for f in functions)
    product, _ = box.product(one, two, 2)
    for nu, value in zip(rows.tolist(), product, strict=True):
        pairs = ((mu, tuple(n - m for n, m in zip(nu, mu, strict=True))) for mu in functions[0])
        expected = sum(functions[0][mu] * functions[1].get(rest, 0) for mu, rest in pairs)
        assert value == expected
        assert box.rows(np.array([nu]))[0] == rows.tolist().index(nu)


def test_what_is_cut_off_is_counted():
    """A square of cos(theta) in a box that has no place for cos(2 theta)."""
    chain = Chain(2, alpha=1)
    harmonics = np.array([[1]])
    with mpmath.workprec(2 * BITS):
        force = KroneckerForce(chain, Box([1], whole=True), BITS, 1)
        _, off = force.force(harmonics, np.array([[force.fixed(mpmath.mpf("0.1"))]], dtype=object), harmonics)
        stretch = mpmath.mpf("0.1") * chain.linear_frequency(1) * mpmath.cospi(mpmath.mpf(1) / 4)
        back = 2 * chain.linear_frequency(1) * mpmath.cospi(mpmath.mpf(1) / 4)
        assert back * stretch**2 / 2 < mpmath.ldexp(int(off[0]), -BITS) < back * stretch**2
