"""The force of a bond beyond the harmonic one, degree by degree, from what a ring can multiply.

With the stretch in units of the small parameter the tension is a power series in it. A ring adds
up its powers; or, where the tension is made of functions that solve (1 + slope r) g' = rate g
(exponentials and powers) and the ring can divide by whole numbers, one product a degree gives each
of them: with the Euler operator, which multiplies degree d by d,

    d g_d = rate d r_d + sum_(0<j<d) (rate j - slope (d - j)) r_j g_(d-j),

where the first term is linear in the unknown r_d and belongs to the linear part.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Protocol

from symfpu.algebra.ring import GrowingRing, Parts, Ring
from symfpu.chain.chain import Chain
from symfpu.chain.potentials.potential import Growth


class Force(Protocol):
    """What the recursion asks for."""

    def parts(self, degree: int) -> Parts:
        """(coefficient, bonds) whose sum is the force of a degree, all lower ones known."""


class PowerForce:
    """The sum of the powers of the stretch."""

    def __init__(self, ring: Ring, chain: Chain, top: int) -> None:
        self.ring = ring
        self.couplings = {}
        for power, coupling in chain.relative_couplings(top).items():
            self.couplings[power] = ring.coupling(power, coupling)

    def parts(self, degree: int) -> Parts:
        return [
            (number, self.ring.power(power, degree))
            for power, number in self.couplings.items()
            if power <= degree
        ]


class GrowthForce:
    """The sum of functions that solve a differential equation."""

    def __init__(self, ring: GrowingRing, growths: tuple[Growth, ...]) -> None:
        self.ring, self.growths = ring, growths
        self.weights = [ring.number(growth.weight / 2) for growth in growths]

    def parts(self, degree: int) -> Parts:
        found = []
        for number, growth in enumerate(self.growths):
            bonds = self.ring.growth(number, growth.slope, growth.rate, degree)
            found.append((self.weights[number], bonds))
        return found


def scaled_growths(chain: Chain) -> tuple[Growth, ...]:
    """Those of the chain's tension in units of the small parameter.

    None of an even V: a growth has all degrees, the series odd ones alone, and the unit of the
    stretch is a square root.
    """
    if chain.potential.even:
        return ()
    return tuple(g.scaled(chain.unit_coupling) for g in chain.potential.growths())


def positive_growths(chain: Chain, top: int) -> bool:
    """Whether the tension is made of growths, and its Taylor coefficients and theirs are positive.

    In units of the small parameter, where that of r^2 is 1. So it is for exponentials of one
    direction, and for negative powers.
    """
    growths = scaled_growths(chain)
    if not growths or any(g.rate < 0 or g.slope > 0 for g in growths):
        return False
    return all(number > 0 for number in chain.relative_couplings(top).values())


def force_numbers(chain: Chain, top: int) -> list[Fraction]:
    """All numbers that the force takes, either way, up to a degree."""
    growths = [number for growth in scaled_growths(chain) for number in growth]
    halves = [growth.weight / 2 for growth in scaled_growths(chain)]
    return [*chain.relative_couplings(top).values(), *growths, *halves]


def stored_powers(chain: Chain, top: int, *, grows: bool) -> int:
    """How many functions on the bonds a ring keeps for a series up to a degree."""
    growths = scaled_growths(chain)
    if grows and growths:
        return len(growths) + 2
    return highest_power(chain, top) - 1


def highest_power(chain: Chain, top: int) -> int:
    """The highest power of a force up to a degree, 2 of none; at least that where V has no end."""
    last = chain.potential.degree
    if last is None:
        return max(top, 2)
    return max(chain.relative_couplings(min(top, last - 1)), default=2)


def force_of(ring: Any, chain: Chain, top: int) -> Force:
    """The cheapest way that the ring has."""
    growths = scaled_growths(chain)
    if growths and ring.grows:
        return GrowthForce(ring, growths)
    return PowerForce(ring, chain, top)
