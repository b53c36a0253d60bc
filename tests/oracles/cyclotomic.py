"""Exact arithmetic with the linear frequencies: polynomials in a primitive 4N-th root of unity.

Omega_q = 2 sin(q pi / 2N) = -i (x^q - x^-q) with x = exp(i pi / 2N), i = x^N. Elements are lists of 2N rational
coefficients of 1, x, ..., x^(2N-1), with x^(2N) = -1; an element is zero as a number iff the cyclotomic polynomial Phi_4N
divides it.
"""

from fractions import Fraction

from sympy import QQ, Poly, cyclotomic_poly, symbols

X = symbols("x")


class Cyclotomic:
    def __init__(self, N, terms):
        self.N = N
        self.terms = {}
        for power, value in terms.items():
            turns, place = divmod(power, 2 * N)
            self.terms[place] = self.terms.get(place, 0) + (-value if turns % 2 else value)

    def __add__(self, other):
        return Cyclotomic(self.N, {k: self.terms.get(k, 0) + other.terms.get(k, 0) for k in {*self.terms, *other.terms}})

    def __mul__(self, other):
        if not isinstance(other, Cyclotomic):
            return Cyclotomic(self.N, {k: v * other for k, v in self.terms.items()})
        total = Cyclotomic(self.N, {})
        for j, a in self.terms.items():
            total = total + Cyclotomic(self.N, {j + k: a * b for k, b in other.terms.items()})
        return total

    __rmul__ = __mul__

    def __sub__(self, other):
        return self + other * -1

    def is_zero(self):
        if not any(self.terms.values()):
            return True
        polynomial = Poly.from_dict({(k,): Fraction(v) for k, v in self.terms.items() if v}, X, domain=QQ)
        return polynomial.rem(Poly(cyclotomic_poly(4 * self.N, X), X, domain=QQ)).is_zero


def omega(N, q):
    """Omega_q as an exact number."""
    return Cyclotomic(N, {N + q: -1, N - q: 1})


def vanishes(N, fractions, constant):
    """Whether sum c num / den = constant exactly; fractions is a list of (c, num, den) with numbers that are not zero."""
    total = Cyclotomic(N, {0: -constant})
    for _, _, den in fractions:
        total = total * den
    for i, (c, num, _) in enumerate(fractions):
        term = num * c
        for j, (_, _, den) in enumerate(fractions):
            if j != i:
                term = term * den
        total = total + term
    return total.is_zero()
