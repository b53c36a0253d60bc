"""Modes that are excited: coefficients that are not zero modulo a prime, computed again."""

from symfpu.checkers.propagation.case import Case
from symfpu.checkers.propagation.couplings import Budget
from symfpu.checkers.propagation.recursion import Point, Recursion
from symfpu.checkers.reading import Json, need

MOST_POINTS = 256
# with these Miller-Rabin is a proof below 3.3e24
BASES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41)


def check_points(data: Json, case: Case) -> None:
    """Points are few, distinct, and each is one at which residues prove something."""
    points = data["points"]
    distinct = all(points.count(e) == 1 for e in points)
    named = all(e["point"] < len(points) for e in data["excited"])
    need(len(points) <= MOST_POINTS and distinct and named, "points")
    for e in points:
        check_point(case, Point(e["prime"], e["root"], e["frequencies"]))


def check_point(case: Case, point: Point) -> None:
    """p is a prime = 1 mod 4N, the root has order 4N, the frequencies are residues."""
    p, g, omega = point
    useful = 2**16 < p < 2**64 and p % (4 * case.N) == 1
    need(useful and is_prime(p), f"{p} is no prime of use")
    divisors = [d for d in range(1, 4 * case.N + 1) if 4 * case.N % d == 0]
    need(
        g < p and [d for d in divisors if pow(g, d, p) == 1] == [4 * case.N],
        f"{g} is not of order 4N",
    )
    residues = [w for w in omega if w < p]
    need(
        omega == residues and len(omega) == len(case.seeds),
        f"frequencies are not residues modulo {p}",
    )


def is_prime(p: int) -> bool:
    """By Miller and Rabin's test with bases that decide every odd number below 3.3e24."""
    twos = ((p - 1) & (1 - p)).bit_length() - 1  # p - 1 = 2^twos times an odd number
    for base in BASES:
        powers = [pow(base, p - 1 >> h, p) for h in range(1, twos + 1)]
        if powers[-1] != 1 and p - 1 not in powers:
            return False
    return True


def check_witnesses(data: Json, case: Case, budget: Budget) -> None:
    """Each excited mode has a coefficient that is not zero modulo its prime: it is computed
    again.
    """
    for i, e in enumerate(data["points"]):
        point = Point(e["prime"], e["root"], e["frequencies"])
        recursion = Recursion(case, point, budget)
        for witness in data["excited"]:
            if witness["point"] == i:
                check_witness(recursion, witness)


def check_witness(recursion: Recursion, witness: Json) -> None:
    """The monomial belongs to the order, and its coefficient is the stated residue, which is not
    zero.
    """
    q, k, residue = witness["mode"], witness["order"], witness["residue"]
    m, case = tuple(witness["monomial"]), recursion.case
    fits = len(m) == 2 * len(case.seeds) and sum(m) == case.degree(k)
    need(fits, f"mode {q}: the monomial has not the degree of order {k}")
    computed = recursion.coefficients(m).get(q, {}).get(())
    need(0 < residue == computed, f"mode {q}: the residue is not {residue}")
