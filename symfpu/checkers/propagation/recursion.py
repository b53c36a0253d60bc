"""The recursion for u_q^(k)[m] (Eqs. moda, modb), with residues or with symbols for the L_q(nu)."""

from collections.abc import Iterator
from itertools import product
from operator import mul, sub
from typing import Any, NamedTuple

from symfpu.checkers.propagation.case import Case
from symfpu.checkers.propagation.couplings import Budget, coupling_steps, couplings
from symfpu.checkers.reading import need

Monomial = tuple[int, ...]
# sorted symbols -> coefficient; a residue is a constant
Polynomial = dict[tuple[Any, ...], int]
ByMode = dict[int, Polynomial]


class Point(NamedTuple):
    """A prime, an element of order 4N and frequencies modulo it.

    Prime 0 stands for symbols instead of residues.
    """

    prime: int
    root: int
    frequencies: list[int]


SYMBOLS = Point(0, 0, [])


class Recursion:
    """Coefficients u_q[m] at a point, each computed where it is first asked for."""

    def __init__(self, case: Case, point: Point, budget: Budget) -> None:
        self.case, self.point, self.budget = case, point, budget
        self.known: dict[Monomial, tuple[ByMode, ByMode]] = {}

    def coefficients(self, m: Monomial) -> ByMode:
        """u_q[m] by mode, zeros left out."""
        return self.term(m)[0]

    def term(self, m: Monomial) -> tuple[ByMode, ByMode]:
        """By mode, u[m] and its bracket, which is -W at the harmonic of a seed itself."""
        degree = sum(m)
        if degree == 1:
            seed = self.case.seeds[m.index(1) // 2]
            return {seed: {(): 1}}, {}
        if degree < 1 or (degree - 1) % self.case.step:
            return {}, {}
        if m not in self.known:
            self.known[m] = {}, {}
            self.fill(m, *self.known[m])
        return self.known[m]

    def fill(self, m: Monomial, u: ByMode, bracket: ByMode) -> None:
        """The recursion: forces and frequency corrections, times the multiplier L_q(nu)."""
        self.add_forces(m, bracket)
        self.add_corrections(m, bracket)
        nu = harmonic(m)
        secular = {
            q
            for q, e in zip(self.case.seeds, nu, strict=True)
            if abs(e) == 1 == sum(map(abs, nu))
        }
        for q in bracket.keys() - secular:
            self.add(u, q, self.multiplier(q, nu), bracket[q])

    def add_forces(self, m: Monomial, bracket: ByMode) -> None:
        """- sum B u u, or - sum C u u u; of other potentials, - g_n sum T u .. u of all n."""
        for n, g in self.case.force.items():
            if n > sum(m):
                continue
            number = self.number(g)
            for modes, value in self.products(n, m):
                self.budget.spend(coupling_steps(self.case.N, n))
                for q, coupling in couplings(self.case.N, *modes):
                    self.add(bracket, q, {(): number}, value, -coupling)

    def number(self, g: Any) -> Any:
        """A coefficient of the force, as a residue or exactly."""
        p = self.point.prime
        if not p:
            return g
        need(g.denominator % p, f"a coefficient of the force has no residue modulo {p}")
        return g.numerator * pow(g.denominator, -1, p) % p

    def add_corrections(self, m: Monomial, bracket: ByMode) -> None:
        """+ sum W_q u_q over the monomials f = |w|^(2e) that divide m, neither of them trivial."""
        for f in self.budget.counted(divisors_of(m)):
            diagonal = f[::2] == f[1::2]
            if not diagonal or not 0 < sum(f) < sum(m) - 1:
                continue
            rest = self.coefficients(quotient(m, f))
            for i, q in enumerate(self.case.seeds):
                if rest.get(q):
                    secular = self.term(raised(f, i))[1].get(q, {})
                    self.add(bracket, q, secular, rest[q], -1)

    def products(
        self, factors: int, m: Monomial
    ) -> Iterator[tuple[tuple[int, ...], Polynomial]]:
        """Modes l1 .. lr and value of each product u_l1 .. u_lr at monomial m.

        Its degree fixes the sum of the orders.
        """
        if factors == 1:
            for q, value in self.coefficients(m).items():
                yield (q,), value
            return
        for f in self.budget.counted(divisors_of(m)):
            if not 0 < sum(f) < sum(m):
                continue
            for q, value in self.coefficients(f).items():
                for modes, others in self.products(factors - 1, quotient(m, f)):
                    yield (q, *modes), self.add({}, q, value, others)

    def add(
        self, total: ByMode, q: int, x: Polynomial, y: Polynomial, sign: int = 1
    ) -> Polynomial:
        """total[q] += sign x y; returns total[q]."""
        value, prime = total.setdefault(q, {}), self.point.prime
        for (a, s), (b, t) in self.budget.counted(product(x.items(), y.items())):
            symbols = tuple(sorted(a + b))
            c = value.get(symbols, 0) + sign * s * t
            value[symbols] = c % prime if prime else c
        return value

    def multiplier(self, q: int, nu: tuple[int, ...]) -> Polynomial:
        """L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2), as a residue or as a symbol.

        L_q(-nu) is the same.
        """
        p, g, omega = self.point
        if not p:
            opposite = tuple(-n for n in nu)
            return {((q, max(nu, opposite)),): 1}
        linear = 2 - pow(g, 2 * q, p) - pow(g, -2 * q, p)  # Omega_q^2 = 2 - 2 cos(q pi / N)
        seeds = self.case.seeds
        own = omega[seeds.index(q)] ** 2 if q in seeds else linear
        divisor = own - sum(map(mul, nu, omega)) ** 2
        need(divisor % p, f"the divisor of mode {q} at harmonic {nu} is zero modulo {p}")
        return {(): linear * pow(divisor, -1, p)}


def harmonic(m: Monomial) -> tuple[int, ...]:
    """nu = p - n."""
    return tuple(map(sub, m[::2], m[1::2]))


def divisors_of(m: Monomial) -> Iterator[Monomial]:
    """All monomials that divide m, 1 and m among them."""
    return product(*(range(e + 1) for e in m))


def quotient(m: Monomial, f: Monomial) -> Monomial:
    """m / f."""
    return tuple(map(sub, m, f))


def raised(f: Monomial, i: int) -> Monomial:
    """f w_i."""
    return (*f[: 2 * i], f[2 * i] + 1, *f[2 * i + 1 :])
