"""Terms of the harmonic whose signs are all +: their signs, and their residues.

The coefficient of w_1^p_1 ... w_s^p_s has no frequency correction, as each of those brings some
|w_i|^2. So it is a sum of products of couplings and of factors -L_m(p') alone,

    u_q[p] = -L_q(p) sum B_qlm u_l[p'] u_m[p''],    p' + p'' = p,

or with C and three factors. For 1 <= omega_i and max omega < 2 min omega every -L is positive, so
a product has the sign of its couplings: where all those of a mode agree, nothing cancels.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import permutations, product
from typing import Any

from symfpu.chain.propagation import product_couplings
from symfpu.series.coefficients import ResiduePoint

Powers = tuple[int, ...]
PLUS, MINUS, BOTH = 1, 2, 3  # signs that occur among the products
OPPOSITE = (0, MINUS, PLUS, BOTH)


def sign_product(signs: Sequence[int]) -> int:
    """The signs of products of factors with these signs."""
    result, *others = signs
    for other in others:
        keeps = result if other & PLUS else 0
        turns = OPPOSITE[result] if other & MINUS else 0
        result = keeps | turns
    return result


class PlusTerms:
    """The products in u_q[p], by the powers p of the seeds, for one N, model and seeds."""

    def __init__(self, N: int, model: str, seeds: Sequence[int]) -> None:
        self.N, self.seeds = N, tuple(seeds)
        self.factors = 2 if model == "alpha" else 3
        self._signs: dict[Powers, dict[int, int]] = {}

    def of_degree(self, degree: int) -> list[Powers]:
        """All powers of this degree, the most even ones last."""
        return list(powers_of_degree(len(self.seeds), degree))

    def signs(self, p: Powers) -> dict[int, int]:
        """By mode: PLUS, MINUS or BOTH; a mode without products is not there."""
        if sum(p) == 1:
            return {self.seeds[p.index(1)]: PLUS}
        if p not in self._signs:
            self._signs[p] = self._combined(p)
        return self._signs[p]

    def _combined(self, p: Powers) -> dict[int, int]:
        found: dict[int, int] = {}
        for parts in splits(p, self.factors):
            tables = [self.signs(part) for part in parts]
            for modes in product(*tables):
                signs = [table[m] for table, m in zip(tables, modes, strict=True)]
                sign = sign_product(signs)
                for q, coupling in product_couplings(self.N, tuple(sorted(modes))):
                    occurring = sign if coupling > 0 else OPPOSITE[sign]
                    found[q] = found.get(q, 0) | occurring
        return found

    def decided_by_sign(self, q: int, degree: int) -> Powers | None:
        """Powers whose products of mode q all have one sign."""
        for p in self.of_degree(degree):
            if self.signs(p).get(q, 0) in (PLUS, MINUS):
                return p
        return None


class PlusResidues:
    """u_q[p] modulo a prime, with the frequencies Omega_q of this N and random seed frequencies.

    Raises ZeroDivisionError where a divisor vanishes modulo the prime.
    """

    def __init__(self, terms: PlusTerms, point: ResiduePoint) -> None:
        self.terms, self.point = terms, point
        self._values: dict[Powers, dict[int, int]] = {}

    def values(self, p: Powers) -> dict[int, int]:
        """By mode, zeros left out."""
        if sum(p) == 1:
            return {self.terms.seeds[p.index(1)]: 1}
        if p not in self._values:
            sums = self._sums(p)
            known = {
                q: self._multiplier(q, p) * c % self.point.prime for q, c in sums.items()
            }
            self._values[p] = {q: c for q, c in known.items() if c}
        return self._values[p]

    def _sums(self, p: Powers) -> dict[int, int]:
        """- sum B u u, or - sum C u u u."""
        prime = self.point.prime
        sums: dict[int, int] = {}
        for parts in splits(p, self.terms.factors):
            tables = [self.values(part) for part in parts]
            orderings = len(set(permutations(parts)))
            for modes in product(*tables):
                value = orderings
                for table, m in zip(tables, modes, strict=True):
                    value = value * table[m] % prime
                for q, coupling in product_couplings(self.terms.N, tuple(sorted(modes))):
                    sums[q] = (sums.get(q, 0) - coupling * value) % prime
        return sums

    def _multiplier(self, q: int, p: Powers) -> int:
        """L_q(p) = Omega_q^2 / (lambda_q - (p.omega)^2)."""
        prime, root, omega = self.point.prime, self.point.root, self.point.frequencies
        linear = 2 - pow(root, 2 * q, prime) - pow(root, -2 * q, prime)
        seeds = self.terms.seeds
        own = omega[seeds.index(q)] ** 2 if q in seeds else linear
        drive = sum(n * w for n, w in zip(p, omega, strict=True))
        divisor = (own - drive**2) % prime
        if not divisor:
            raise ZeroDivisionError(f"the divisor of mode {q} vanishes modulo {prime}")
        return linear * pow(divisor, -1, prime) % prime


@lru_cache(maxsize=1 << 12)
def splits(p: Powers, factors: int) -> tuple[tuple[Powers, ...], ...]:
    """Ways to write p as an unordered sum of so many powers that are not zero."""
    return tuple(_splits(p, factors, p))


def _splits(p: Powers, factors: int, most: Powers) -> Iterator[tuple[Powers, ...]]:
    if factors == 1:
        if any(p) and p <= most:
            yield (p,)
        return
    for part in product(*(range(e + 1) for e in p)):
        if any(part) and part <= most:
            rest = tuple(a - b for a, b in zip(p, part, strict=True))
            for others in _splits(rest, factors - 1, part):
                yield (part, *others)


@lru_cache(maxsize=256)
def powers_of_degree(s: int, degree: int) -> tuple[Powers, ...]:
    """All powers of so many seeds with this sum, the most even ones last."""
    found: list[Any] = [p for p in product(range(degree + 1), repeat=s) if sum(p) == degree]
    return tuple(sorted(found, key=max, reverse=True))
