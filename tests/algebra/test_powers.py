"""Powers of the bonds beyond the cube: every ring gives the same ones, and they are those of products of trigonometric polynomials."""

from fractions import Fraction

import numpy as np
import pytest

from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.grading import Grading
from symfpu.algebra.residue import ResidueRing
from symfpu.algebra.selection import CosineModes
from tests.oracles.symbolic_ring import SymbolicRing
from tests.tolerances import COEFFICIENT

N, SEEDS, DEGREE, PRIME = 6, (1, 2), 6, 97  # 97 = 1 mod 4N
ROOT = next(g for g in range(2, PRIME) if pow(g, 2 * N, PRIME) == PRIME - 1)


@pytest.fixture(scope="module")
def space():
    return CosineModes(N, SEEDS, Grading(len(SEEDS), DEGREE), 2)


def second_order(space):
    """Small integers where the selection rules allow a mode."""
    mask = space.mask(2)
    return np.where(mask, 1 + np.arange(mask.size).reshape(mask.shape) % 3, 0)


def projected(ring, space, power, degree):
    ring.put(1, ring.seed_terms())
    values = second_order(space)
    ring.put(2, values.astype(object) if isinstance(ring, SymbolicRing) else values.astype(float))
    return ring.project(degree, [(ring.coupling(power, Fraction(1)), ring.power(power, degree))])


@pytest.mark.parametrize("power", [2, 3, 4, 5])
def test_all_rings_agree(space, power):
    for degree in range(power, min(2 * power, DEGREE) + 1):
        exact = np.array(projected(SymbolicRing(space), space, power, degree), dtype=object).astype(int)
        floats = projected(Float64Ring(space), space, power, degree)
        residues = projected(ResidueRing(space, PRIME, ROOT), space, power, degree)
        assert exact.any()
        assert np.abs(floats - exact).max() <= COEFFICIENT * np.abs(exact).max()
        assert ((residues - exact) % PRIME == 0).all()
