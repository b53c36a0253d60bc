"""Where normal frequencies meet or cross: conditions of Newton's method on the torus.

Of two directions that meet: with both deflated together, X^T L(sigma) X = G is a symmetric matrix
of two rows, as smooth in sigma and in the torus where they meet as anywhere else. Its determinant
is, up to a factor, (sigma - sigma_1)(sigma - sigma_2); at the sigma between the two where it is
stationary it is the discriminant (sigma_1 - sigma_2)^2/4, positive of elliptic directions, negative
of hyperbolic ones. G is stationary in X, and the determinant in sigma, so that its derivative by
the torus is p^T (dL) p, with the third derivative of V on the bonds. Of real frequencies that cross
a resonance it is the distance, dsigma = -p^T (dL) p/(p^T L' p). So the torus of such an event is
found by Newton's method like one of given energy. Ours.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np

from symfpu.normal.linearised import Linearised, Values
from symfpu.normal.modes import NormalModes
from symfpu.normal.reduction import FINE, LARGEST_STEP, Block, Bordered, shares_of, steps_of
from symfpu.normal.resonances import DIFFERENCE, ParametricResonance
from symfpu.normal.search import at_harmonics
from symfpu.normal.torus import finest_flow
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Floats, Ints
from symfpu.tori.torus import Torus

STEPS = 8  # of sigma, for one torus
ENOUGH = 1e-9  # relative step of sigma that ends them: what is left is its square
EPS = float(np.finfo(float).eps)
ROUNDED = 4.0  # of EPS, about, in a matrix G over Omega_q^2, and in a distance over sigma


class Lost(Exception):
    """The directions are not found about an iterate of Newton's method."""


class _Part(NamedTuple):
    """A table p of the unknowns of a flow, at a sigma."""

    factor: float
    p: Floats
    sigma: float
    flow: Linearised


class _Found(NamedTuple):
    """What a condition needs of a torus.

    value : of the condition. parts : the sum of their factor p^T (dL) p is its derivative.
    """

    value: float
    parts: list[_Part]


class NormalCondition(ABC):
    """A condition on normal frequencies, relative to their own size.

    near : the normal modes of a torus nearby. resonance : of them.
    """

    _rounding = ROUNDED * EPS  # of the value

    def __init__(self, near: NormalModes, resonance: ParametricResonance) -> None:
        self._q, self._other = resonance.modes[0], resonance.modes[-1]
        # two directions of a narrow tongue feel small coefficients of the torus
        self._flow = finest_flow(near.torus)
        self._harmonic = np.array(resonance.harmonic)
        omega = np.array([float(w) for w in near.torus.frequencies])
        self._rate = float(self._harmonic @ omega)
        self._known: tuple[Floats, Linearised, _Found] | None = None
        self._slope = np.zeros(len(self._harmonic))

    @abstractmethod
    def _of(self, flow: Linearised) -> _Found:
        """Raises Lost."""

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        """What is to be zero; raises Lost."""
        _, found = self._at(equation, cosines, shifts)
        return np.longdouble(found.value)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        """Derivatives of the value by coefficients (H, C) and shifts (s,)."""
        own, found = self._at(equation, cosines, shifts)
        weights, by_shift = np.zeros(own.slopes.shape), self._by_shift()
        for factor, p, sigma, flow in found.parts:
            weights += factor * flow.squares(p)
            rates = sigma + flow.rates.astype(float)
            turned = -2 * rates * (p**2).sum(axis=1)
            by_shift += factor * (turned @ flow.harmonics)
        self._slope = by_shift
        inside, outside = self._rows(equation)
        by_cosine = np.zeros(cosines.shape)
        half = self._half(equation, cosines)
        by_cosine[outside] = own.equation.slope_changes(half, weights)[inside]
        return by_cosine, by_shift

    def error(self, torus: Torus) -> float:
        """Of the value on a torus that was found, about: rounding, and what its residual makes."""
        omega = np.array([abs(float(w)) for w in torus.frequencies])
        return self._rounding + torus.residual() * float(np.abs(self._slope) @ omega)

    def _by_shift(self) -> Floats:
        """What the value has of its own by shifts."""
        return np.zeros(len(self._harmonic))

    def _at(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Linearised, _Found]:
        """The flow about an iterate, and what is known of it."""
        if self._known is None or self._known[0] is not cosines:
            flow = self._flow.moved(self._half(equation, cosines), shifts)
            self._rate = float(self._harmonic @ (equation.seed_frequencies + shifts))
            self._known = cosines, flow, self._of(flow)
        return self._known[1:]

    def _half(self, equation: InvarianceEquation, cosines: Floats) -> Floats:
        """The coefficients of an iterate at the harmonics of the flow; 0 where it has none."""
        inside, outside = self._rows(equation)
        half = np.zeros((len(self._flow.equation.harmonics), cosines.shape[1]))
        half[inside] = cosines[outside]
        return half

    def _rows(self, equation: InvarianceEquation) -> tuple[Ints, Ints]:
        """Rows of the harmonics that the flow and an equation share, in the one and the other."""
        rows = {tuple(nu): i for i, nu in enumerate(equation.harmonics.tolist())}
        own = enumerate(map(tuple, self._flow.equation.harmonics.tolist()))
        pairs = [(i, rows[nu]) for i, nu in own if nu in rows]
        inside, outside = zip(*pairs, strict=True)
        return np.array(inside), np.array(outside)


class Meeting(NormalCondition):
    """The discriminant of two directions over 4 sigma^2: zero where they meet."""

    def __init__(self, near: NormalModes, resonance: ParametricResonance) -> None:
        super().__init__(near, resonance)
        self._flow = self._flow.of(self._q)
        self._tables = _both(self._flow, near, resonance)
        other = self._rate + _sign(resonance) * -_real(near, self._other)
        self._sigma = (_real(near, self._q) + other) / 2
        self._size = 0.0

    def _of(self, flow: Linearised) -> _Found:
        sigma = self._sigma
        system = _system(flow, self._q, sigma, self._tables)
        X: Values = system.start()
        for _ in range(STEPS):
            X, G, by_sigma = _matrices(system, X, sigma)
            step = _to_the_middle(G, by_sigma, X)
            self._require(step)
            if abs(step) < ENOUGH * sigma:
                break
            sigma += step
        else:
            raise Lost
        self._sigma = sigma
        self._size = self._size or abs(float(np.linalg.det(by_sigma))) * sigma**2
        factors, mixing = np.linalg.eigh(_adjugate(G) / self._size)
        tables = map(system.table, (X @ mixing).T)
        pairs = zip(factors, tables, strict=True)
        parts = [_Part(float(factor), p, sigma, flow) for factor, p in pairs]
        entries = float(np.abs(G).max()) * system.block.size / self._size
        self._rounding = ROUNDED * EPS * entries
        return _Found(float(np.linalg.det(G)) / self._size, parts)

    def _require(self, step: float) -> None:
        if not abs(step) < LARGEST_STEP * self._sigma:
            raise Lost


class Crossed(NormalCondition):
    """The distance of a resonance of real frequencies over the first of them."""

    def __init__(self, near: NormalModes, resonance: ParametricResonance) -> None:
        super().__init__(near, resonance)
        self._weights = {self._q: 1.0}
        before = self._weights.get(self._other, 0.0)
        self._weights[self._other] = before + _sign(resonance)
        self._sigma = {q: _real(near, q) for q in self._weights}
        self._size = self._sigma[self._q]
        flows = {q: self._flow.of(q) for q in self._weights}
        self._tables = {q: flow.table(_own(flow, near, q)) for q, flow in flows.items()}

    def _by_shift(self) -> Floats:
        return np.asarray(-self._harmonic / self._size)

    def _of(self, flow: Linearised) -> _Found:
        value, parts = -self._rate / self._size, []
        for q, weight in self._weights.items():
            of_mode = flow.of(q)
            sigma, p, slope = self._solved(of_mode, q)
            factor = weight / self._size
            value += factor * sigma
            parts.append(_Part(-factor / slope, p, sigma, of_mode))
        return _Found(value, parts)

    def _solved(self, flow: Linearised, q: int) -> tuple[float, Floats, float]:
        """sigma of a mode, its table p and p^T L' p; raises Lost."""
        sigma, own = self._sigma[q], self._tables[q]
        system = _system(flow, q, sigma, [own])
        X: Values = system.start()
        like = own[system.mask]
        for _ in range(STEPS):
            X, G, by_sigma = _matrices(system, X, sigma)
            steps, vectors = steps_of(G, by_sigma)
            at = int(np.argmax(shares_of(X, vectors, like)))
            step = complex(steps[at])
            if step.imag or not abs(step.real) < LARGEST_STEP * sigma:
                raise Lost
            sigma += step.real
            if abs(step.real) < ENOUGH * sigma:
                break
        else:
            raise Lost
        self._sigma[q] = sigma
        p = (X @ vectors[:, at]).real
        slope = float(-2 * (sigma + system.rates) @ p**2)
        return sigma, system.table(p), slope


def _system(flow: Linearised, q: int, sigma: float, tables: list[Floats]) -> Bordered:
    """L bordered by tables, as far as they are in its block."""
    block = Block(flow, q, sigma)
    inside = [table[block.mask][block.inside] for table in tables]
    W, _ = np.linalg.qr(np.stack(inside, axis=1))
    return Bordered(block, W)


def _matrices(system: Bordered, X: Values, sigma: float) -> tuple[Values, Floats, Floats]:
    """X, G and its derivative by sigma."""
    system.take(sigma)
    X, images = system.improved(X, FINE)
    slope = -2 * (sigma + system.rates)
    G = X.T @ images
    return X, (G + G.T) / 2, X.T @ (slope[:, None] * X)


def _to_the_middle(G: Floats, by_sigma: Floats, X: Values) -> float:
    """The step of sigma to where det G is stationary, nearly Newton's."""
    adjugate = _adjugate(G)
    first = float(np.trace(adjugate @ by_sigma))
    second = 2 * float(np.linalg.det(by_sigma) - np.trace(adjugate @ X.T @ X))
    return -first / second


def _adjugate(G: Floats) -> Floats:
    return np.array([[G[1, 1], -G[0, 1]], [-G[1, 0], G[0, 0]]])


def _sign(resonance: ParametricResonance) -> int:
    """Of the second frequency of a resonance."""
    return -1 if resonance.kind == DIFFERENCE else 1


def _real(near: NormalModes, q: int) -> float:
    return float(complex(near.mode(q).sigma).real)


def _own(flow: Linearised, near: NormalModes, q: int) -> Values:
    """The eigenfunction of a mode at the harmonics of a flow."""
    return at_harmonics(near.mode(q).in_doubles(), flow.harmonics)


def _both(
    flow: Linearised, near: NormalModes, resonance: ParametricResonance
) -> list[Floats]:
    """Tables of two directions that meet; of hyperbolic ones the real and imaginary part."""
    q, other = resonance.modes[0], resonance.modes[-1]
    moved = -np.array(resonance.harmonic) - flow.harmonics
    partner = near.mode(other).in_doubles()
    pair = [_own(flow, near, q), at_harmonics(partner, _sign(resonance) * moved)]
    for p in map(flow.table, pair):
        if np.iscomplexobj(p):
            return [p.real, p.imag]
    return [flow.table(p) for p in pair]
