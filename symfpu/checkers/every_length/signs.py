"""Modes that are excited since all products of couplings in a term have one sign."""

from collections.abc import Iterator
from itertools import product

from symfpu.checkers.every_length.claim import Row, Theorem
from symfpu.checkers.propagation.case import Case
from symfpu.checkers.propagation.couplings import couplings

Powers = tuple[int, ...]


class Signs:
    """Signs of the products of couplings in u_q[p], where all signs of the harmonic p are +."""

    def __init__(self, case: Case) -> None:
        self.case, self.factors = case, case.step + 1
        self.known: dict[Powers, set[tuple[int, int]]] = {}
        self.coupled: dict[Row, list[tuple[int, int]]] = {}

    def of(self, p: Powers) -> set[tuple[int, int]]:
        """Modes with the signs +1 and -1 that occur."""
        if sum(p) == 1:
            return {(self.case.seeds[p.index(1)], 1)}
        if (sum(p) - 1) % self.case.step:
            return set()
        if p not in self.known:
            self.known[p] = set(self.products(p))
        return self.known[p]

    def products(self, p: Powers) -> Iterator[tuple[int, int]]:
        """Of all ways to share p among the factors."""
        for parts in shared(p, self.factors):
            for chosen in product(*map(self.of, parts)):
                modes, sign = [], 1
                for m, s in chosen:
                    modes.append(m)
                    sign *= s
                for q, coupling in self.couplings(tuple(sorted(modes))):
                    yield q, sign if coupling > 0 else -sign

    def couplings(self, modes: Row) -> list[tuple[int, int]]:
        """Eq. transa, remembered."""
        if modes not in self.coupled:
            self.coupled[modes] = couplings(self.case.N, *modes)
        return self.coupled[modes]


def shared(p: Powers, factors: int, least: Powers = ()) -> Iterator[tuple[Powers, ...]]:
    """Ways to write p as a sum of so many powers in ascending order, none of them zero."""
    if factors == 1:
        if any(p) and p >= least:
            yield (p,)
        return
    for part in product(*(range(e + 1) for e in p)):
        if any(part) and part >= least:
            rest = tuple(a - b for a, b in zip(p, part, strict=True))
            for others in shared(rest, factors - 1, part):
                yield (part, *others)


def powers_of_degree(s: int, degree: int) -> list[Powers]:
    """All p with this sum."""
    return [p for p in product(range(degree + 1), repeat=s) if sum(p) == degree]


def one_sign(signs: Signs, claim: Theorem, q: int, k: int) -> bool:
    """Whether all products of some term of order k of the mode have one sign."""
    for p in powers_of_degree(claim.s, claim.degree(k)):
        found = signs.of(p)
        if ((q, 1) in found) != ((q, -1) in found):
            return True
    return False
