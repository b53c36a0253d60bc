"""The first theorem: how well a torus solves the equations of motion, at all angles."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from symfpu.checkers.reading import need
from symfpu.checkers.rounding import scientific
from symfpu.checkers.torus.budget import Budget, fraction_steps
from symfpu.checkers.torus.claim import Claim
from symfpu.checkers.torus.series import Row, Series, combined, product, shifted, turned

GUARD = 40  # places of the residual beyond those of the torus


def stretches(particles: Sequence[Series]) -> list[Series]:
    """r_j = x_(j+1) - x_j of the N bonds, j = 0 .. N-1."""
    still = Series({}, particles[0].places)
    ends = [still, *particles, still]
    return [combined([(1, b), (-1, a)]) for a, b in pairwise(ends)]


def forces(tensions: Sequence[Series]) -> list[Series]:
    """On the N-1 particles, of the tensions of bonds."""
    return [combined([(1, b), (-1, a)]) for a, b in pairwise(tensions)]


def polynomial(r: Series, terms: dict[int, Fraction], budget: Budget) -> Series:
    """sum terms[k] r^k, k >= 1."""
    power, parts = r, []
    for k in range(1, max(terms) + 1):
        power = power if k == 1 else product(power, r, budget)
        if k in terms:
            steps = fraction_steps(terms[k], power.size.bit_length())
            budget.spend(len(power.values) * steps)
            parts.append((terms[k], power))
    return combined(parts)


def residuals(claim: Claim) -> Row:
    """Above |x_j'' - force| of every particle at all angles."""
    places = claim.torus[0].places + GUARD
    fine = [shifted(x, places) for x in claim.torus]
    terms = {1: Fraction(1), **claim.couplings}
    pushed = forces([polynomial(r, terms, claim.budget) for r in stretches(fine)])
    norms = []
    for x, force in zip(fine, pushed, strict=True):
        moved = turned(x, claim.omega, Fraction(0), 2, claim.budget)
        norms.append(combined([(-1, moved), (-1, force)]).norm)
    return norms


def check_residual(found: Row, stated: Fraction) -> None:
    """No particle's residual exceeds the stated one."""
    most = max(found)
    text = f"the residual may be {scientific(most)}, above {scientific(stated)}"
    need(most <= stated, text)
