"""The series by Eqs. moda and modb as printed: mode space, coordinates Q, tensors B and C, trigonometric dictionaries, mpmath.

A function of the angles is {(powers of A, harmonic): coefficient} and means sum c A^powers cos(harmonic . theta), the first
non-zero component of a harmonic being positive. Nothing here uses bonds, the variables u and w, or the package itself.
"""

from collections import defaultdict
from fractions import Fraction

import mpmath
import numpy as np

DIGITS = 40


def tensor(N, rank):
    """{(q, l, m[, n]): B or C} from sums of products of cosines over the bonds (not from a selection rule)."""
    cosines = np.cos(np.pi / N * np.outer(np.arange(1, N), np.arange(N) + 0.5))
    products = cosines
    for _ in range(rank - 1):
        products = products[..., None, :] * cosines
    couplings = np.rint(products.sum(axis=-1) * 2 ** (rank - 1) / N).astype(int)  # they are integers
    return {tuple(int(i) + 1 for i in place): int(couplings[tuple(place)]) for place in np.argwhere(couplings)}


def canonical(harmonic):
    lead = next((n for n in harmonic if n), 0)
    return harmonic if lead >= 0 else tuple(-n for n in harmonic)


def times(f, g):
    """f g, by cos a cos b = (cos(a + b) + cos(a - b)) / 2."""
    result = defaultdict(mpmath.mpf)
    for (e, nu), a in f.items():
        for (d, rho), b in g.items():
            powers = tuple(x + y for x, y in zip(e, d, strict=True))
            for sign in (1, -1):
                harmonic = canonical(tuple(x + sign * y for x, y in zip(nu, rho, strict=True)))
                result[powers, harmonic] += a * b / 2
    return dict(result)


def add(target, f, factor=1):
    for key, value in f.items():
        target[key] = target.get(key, 0) + factor * value


class ModeSpaceSeries:
    """Q[q][k], omega[q][k] and omega_squared[q][k] of a chain, orders 0 .. order, without mu."""

    def __init__(self, N, alpha, beta, seeds, frequencies, order):
        with mpmath.workdps(DIGITS):
            self._prepare(N, Fraction(alpha), Fraction(beta), seeds, frequencies)
            for k in range(1, order + 1):
                self._advance(k)

    def _prepare(self, N, alpha, beta, seeds, frequencies):
        self.N, self.seeds = N, seeds
        self.zero = (0,) * len(seeds)
        self.chosen = [mpmath.mpf(w.numerator) / w.denominator for w in map(Fraction, frequencies)]
        self.linear = {q: 2 * mpmath.sin(q * mpmath.pi / (2 * N)) for q in range(1, N)}
        self.B = tensor(N, 3) if alpha else {}
        self.C = tensor(N, 4) if beta else {}
        ratio = beta / alpha**2 if alpha else Fraction(1)
        self.beta_delay = 2 if alpha else 1  # mu^2 beta / alpha^2 = beta / 2N
        self.beta_factor = mpmath.mpf(ratio.numerator) / ratio.denominator
        self.Q, self._products = {q: [{}] for q in range(1, N)}, {}
        for i, q in enumerate(seeds):
            unit = tuple(int(i == j) for j in range(len(seeds)))
            self.Q[q] = [{(unit, unit): mpmath.mpf(1)}]
        self.omega = {q: [{(self.zero, self.zero): self.linear[q]}] for q in seeds}
        self.omega_squared = {q: [times(self.omega[q][0], self.omega[q][0])] for q in seeds}

    def _force(self, q, k):
        """The couplings of Eqs. moda and modb for mode q at order k."""
        force = {}
        for couplings, factor, delay in ((self.B, 1, 1), (self.C, self.beta_factor, self.beta_delay)):
            for (p, *modes), coupling in couplings.items():
                if p == q:
                    weight = -factor * self.linear[q] * coupling * mpmath.fprod(self.linear[m] for m in modes)
                    add(force, self._product(tuple(sorted(modes)), k - delay), weight)
        return force

    def _product(self, modes, order):
        """The terms of an order of the product of these modes; kept for all that it drives."""
        if (modes, order) not in self._products:
            *first, last = modes
            terms = {}
            for n in range(order + 1):
                left = self._product(tuple(first), n) if first[1:] else self.Q[first[0]][n]
                add(terms, times(left, self.Q[last][order - n]))
            self._products[modes, order] = terms
        return self._products[modes, order]

    def _advance(self, k):
        terms = {q: self._force(q, k) for q in self.Q}
        for i, q in enumerate(self.seeds):
            for n in range(1, k):
                add(terms[q], times(self.omega_squared[q][n], self.Q[q][k - n]))
            known = {}
            for n in range(1, k):
                add(known, times(self.omega[q][n], self.omega[q][k - n]))
            self._remove_secular(q, i, k, terms[q], known)
        for q, right in terms.items():
            self.Q[q].append(self._integrate(q, right))

    def _remove_secular(self, q, i, k, right, known):
        unit = tuple(int(i == j) for j in range(len(self.seeds)))
        squared = {}
        for powers, harmonic in [key for key in right if key[1] == unit]:
            lowered = tuple(e - int(i == j) for j, e in enumerate(powers))
            assert min(lowered) >= 0
            squared[lowered, self.zero] = -right.pop((powers, harmonic))
        omega = dict(squared)
        add(omega, {key: -value for key, value in known.items()})
        self.omega_squared[q].append(squared)
        self.omega[q].append({key: value / (2 * self.linear[q]) for key, value in omega.items()})
        # [omega^2]^(k) multiplies Q^(0) = A cos theta only, which is the secular harmonic itself

    def _integrate(self, q, right):
        base = self.chosen[self.seeds.index(q)] if q in self.seeds else self.linear[q]
        result = {}
        for (powers, harmonic), value in right.items():
            drive = sum(n * w for n, w in zip(harmonic, self.chosen, strict=True))
            result[powers, harmonic] = value / (base**2 - drive**2)
        return result
