"""The hypotheses of the theorem, one a function, and what it then says."""

from fractions import Fraction

from symfpu.checkers.existence.bonds import Bonds
from symfpu.checkers.existence.bounds import Bounds
from symfpu.checkers.existence.claim import AMPLITUDE, Claim, read_claim
from symfpu.checkers.existence.condition import energy_between, mean_energy_between
from symfpu.checkers.existence.inverse import BORDER, Inverse, read_inverse
from symfpu.checkers.existence.reading import stated
from symfpu.checkers.existence.wording import elsewhere, theorem_text
from symfpu.checkers.reading import Json, dyadic, need
from symfpu.checkers.rounding import scientific

MOST_STEPS = 10**9


def check_certificate(data: Json) -> list[str]:
    """The hypotheses of the theorem, and what it then says of the orbit."""
    claim = read_claim(data)
    inverse = read_inverse(data, claim)
    check_cost(claim, inverse)
    radius, unique = dyadic(data["radius"], "radius"), dyadic(data["unique"], "unique")
    highest = inverse.last + inverse.slope_harmonics
    bounds = Bounds(claim, Bonds(claim, highest), inverse)
    Y, linear, length = bounds.residual(), bounds.linear(), bounds.length()
    check_contraction(bounds, Y, linear, radius, unique)
    check_seed(claim, radius)
    check_amplitude(claim, bounds.bonds, stated(data["amplitude"], "amplitude"), radius)
    check_energy(claim, bounds.bonds, stated(data["energy"], "energy"), radius)
    if claim.bordered:
        check_frequency(claim, inverse, stated(data["frequency"], "frequency"), radius)
    return [
        theorem_text(claim, data, radius, unique),
        f"Y = {scientific(Y)}, Z0 + Z1 = {scientific(linear)}, "
        f"Z2 = {scientific(bounds.curvature(unique + length))}: recomputed with integers",
        elsewhere(claim),
    ]


def check_cost(claim: Claim, inverse: Inverse) -> None:
    """Checking takes minutes at most: products of series, and entries of I - A DF."""
    modes = len(claim.shape.allowed(1))
    products = claim.shape.bonds * max(claim.force.couplings) ** 2 * claim.harmonics**2
    width = 2 * inverse.slope_harmonics + 1
    entries = (inverse.last + 1) * width * modes**2 * 4
    need(max(products, entries) <= MOST_STEPS, "checking it would take too many steps")


def check_contraction(
    bounds: Bounds, Y: Fraction, linear: Fraction, radius: Fraction, unique: Fraction
) -> None:
    """At every orbit of the line x - A F(x) takes the ball of the radius into itself and
    contracts the larger one.
    """
    need(radius <= unique, "the radius of existence is above that of uniqueness")
    length = bounds.length()
    far, near = unique + length, radius + length
    rate = linear + bounds.curvature(far) * far
    need(rate < 1, f"Z0 + Z1 + Z2 R = {scientific(rate)} is not below 1")
    reached = Y + (linear + bounds.curvature(near) * near) * radius
    text = (
        f"Y + (Z0 + Z1 + Z2 r) r = {scientific(reached)} exceeds r = {scientific(radius)}"
    )
    need(reached <= radius, text)


def check_seed(claim: Claim, radius: Fraction) -> None:
    """The orbit is not at rest: its seed moves with the frequency itself."""
    place = claim.shape.place
    size, moved = abs(claim.orbit[place]), abs(claim.direction.get(place, 0))
    need(Fraction(size - moved, 1 << claim.bits) > radius, "the amplitude may be zero")


def check_amplitude(
    claim: Claim, bonds: Bonds, ends: tuple[Fraction, Fraction], radius: Fraction
) -> None:
    """A = sqrt(N/2) c / Omega of the seed, on a ring sqrt(N) c / Omega; compared by squares.

    c has one sign.
    """
    low, high = ends
    place = claim.shape.place
    c = Fraction(claim.orbit[place], 1 << claim.bits)
    radius += Fraction(abs(claim.direction.get(place, 0)), 1 << claim.bits)
    if c < 0:
        c, low, high = -c, -high, -low
    least, most = (x * claim.shape.of_amplitude for x in bonds.linear(place[1]))
    smallest, largest = (c - radius) ** 2 / most, (c + radius) ** 2 / least
    inside = low > 0 and low**2 <= smallest and largest <= high**2
    need(inside, "the amplitude of the orbit may be outside the stated interval")
    if claim.fixed == AMPLITUDE:
        need((claim.value > 0) == (claim.orbit[place] > 0), "the value has the other sign")


def check_energy(
    claim: Claim, bonds: Bonds, ends: tuple[Fraction, Fraction], radius: Fraction
) -> None:
    """H = sum_j V(r_j) at t = 0, where all momenta vanish; of a wave by its mean."""
    directions = bonds.on_bonds(claim.direction) if claim.direction else []
    if claim.shape.travelling:
        radius += sum(map(bonds.size, directions))
        least, most = mean_energy_between(claim, bonds, radius)
    else:
        radii = [radius] * claim.N
        for j, stretch in enumerate(directions):
            moved, error = bonds.at_rest(stretch)
            radii[j] += abs(moved) + error
        least, most = energy_between(claim, bonds, radii)
    need(ends[0] <= least and most <= ends[1], "H may be outside the stated interval")


def check_frequency(
    claim: Claim, inverse: Inverse, ends: tuple[Fraction, Fraction], radius: Fraction
) -> None:
    """omega^2 is within the radius over the weight of the unknown, and positive."""
    low, high = ends
    weight = Fraction(inverse.weights[BORDER], 1 << inverse.weight_bits)
    moved = Fraction(abs(claim.of_frequency), 1 << claim.bits)
    off = (radius / weight + moved) * claim.unit
    least, most = claim.omega**2 - off, claim.omega**2 + off
    inside = low > 0 and low**2 <= least and most <= high**2
    need(inside, "the frequency may be outside the stated interval")
