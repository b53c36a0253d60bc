"""Numbers for the symbols L_q(nu) and Omega_q of the universal form, and a term-by-term evaluation of its polynomials."""

from fractions import Fraction

import mpmath
import symengine as se

from symfpu.algebra.formulas import multiplier_symbol

DIGITS = 40


def multiplier(N, seeds, frequencies, q, harmonic):
    """L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2) with mpmath, from its definition."""
    chosen = [mpmath.mpf(Fraction(w).numerator) / Fraction(w).denominator for w in frequencies]
    linear = 2 * mpmath.sin(q * mpmath.pi / (2 * N))
    base = chosen[seeds.index(q)] if q in seeds else linear
    drive = sum(n * w for n, w in zip(harmonic, chosen, strict=True))
    return linear**2 / (base**2 - drive**2)


class Numbers(dict):
    """{symbol name: number} for L_q(nu) of the given harmonics and for Omega_q; a number is made when first asked for."""

    def __init__(self, case, harmonics):
        super().__init__()
        self._case = case
        modes = range(1, case.N)
        self._harmonics = {multiplier_symbol(q, nu).name: (q, tuple(nu)) for q in modes for nu in harmonics}

    def __missing__(self, name):
        case = self._case
        if name.startswith("Omega_"):
            self[name] = 2 * mpmath.sin(int(name.removeprefix("Omega_")) * mpmath.pi / (2 * case.N))
        else:
            self[name] = multiplier(case.N, case.seeds, case.frequencies, *self._harmonics[name])
        return self[name]


def evaluate(expression, numbers):
    """An expanded polynomial in the symbols as an mpf: sums, products, integer powers and rationals only."""
    if isinstance(expression, se.Symbol):
        return numbers[expression.name]
    if expression.is_Number:
        return mpmath.mpf(int(expression.get_num_den()[0])) / int(expression.get_num_den()[1])
    parts = [evaluate(part, numbers) for part in expression.args]
    if isinstance(expression, se.Add):
        return mpmath.fsum(parts)
    if isinstance(expression, se.Mul):
        return mpmath.fprod(parts)
    assert isinstance(expression, se.Pow), expression
    return parts[0] ** int(expression.args[1])
