"""The linearised flow about a torus, in closed form.

The solutions of the linearised equations are spanned by
    E_i = dz/dtheta_i, s of them, along the torus,
    F_j + t sum_i Lambda_ij E_i, F_j = dz/dI_j: neighbouring tori turn against each other,
    Re and Im of exp(i sigma_q t) p_q(theta), 2(n-s) of them, normal to the torus,
z = (x, p), all at theta = omega t + phi. The changes of action of a deviation v are dI = Omega(E,
v) with the symplectic form Omega(a, b) = a_x.b_p - a_p.b_x; they stay as they are. Coordinates x
are the D of `mode_shapes`: n = N - 1 modes of fixed ends, N particles of a ring,
which does not move as a whole. Travelling waves are sums of N^(-1/2) exp(-2 pi i q j/N),
standing ones of the sines of the fixed ends that they unfold and of cosines, sqrt(2/N')
cos(q pi j/N') on the ring of N = 2 N'. So x(theta) = Re sum over nu of (c[nu] shapes)
exp(i nu.theta), with fixed ends and on a ring.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.newton_twist import ActionChanges
from symfpu.chain.chain import Chain
from symfpu.chain.projections.standing import is_sine
from symfpu.normal.modes import NormalMode
from symfpu.refinement.lattice import Floats, Ints
from symfpu.tori.torus import Torus

Complex = NDArray[np.complex128]
Values = NDArray[Any]  # doubles or complex doubles
Sum = tuple[Complex, Values]  # weights of harmonics (T, H) and their coefficients (H, n)


def mode_shapes(torus: Torus) -> Values:
    """What each mode displaces, in the order of chain.mode_numbers; (N-1, coordinates)."""
    if not torus.chain.periodic:
        return np.eye(torus.chain.N - 1)
    if torus.stands:
        return _standing(torus.chain)
    return _travelling(torus.chain)


def _travelling(ring: Chain) -> Values:
    turns = np.outer(ring.mode_numbers, np.arange(ring.N)) / ring.N
    return np.asarray(np.exp(-2j * np.pi * turns) / np.sqrt(ring.N))


def _standing(ring: Chain) -> Floats:
    half, sites = ring.N // 2, np.arange(ring.N)
    rows = []
    for q in ring.mode_numbers:
        wave = np.sin if is_sine(ring, q) else np.cos
        norm = np.sqrt((1 if q == half else 2) / half)
        rows.append(norm * wave(np.pi * abs(q) * sites / half))
    return np.array(rows)


def by_mode(torus: Torus, harmonics: Ints, coefficients: Floats) -> Values:
    """Coefficients (..., H, C) of a torus, or of its changes, by all modes; (..., H, N-1).

    harmonics : (H, s). C as in `ActionChanges`: complex of travelling waves, whose
    sin(a - nu.theta) is the real part of i exp(i (nu.theta - a)).
    """
    if not torus.chain.periodic:
        return coefficients
    numbers = np.array(torus.chain.mode_numbers)
    every = np.zeros((*coefficients.shape[:-1], len(numbers)), dtype=complex)
    if torus.stands:
        sines = [is_sine(torus.chain, q) for q in numbers.tolist()]
        every[..., sines] = coefficients
        return every.real
    N = torus.chain.N
    waves = harmonics @ np.array(torus.seeds)
    place = np.full(N, -1)
    place[numbers % N] = np.arange(N - 1)
    columns = place[waves % N]
    moving = np.flatnonzero(columns >= 0)
    signs = np.where(waves // N % 2 == 0, 1j, -1j)
    every[..., moving, columns[moving]] = (signs * coefficients[..., 0])[..., moving]
    return every


@dataclass(frozen=True, eq=False)
class NormalDirection:
    """exp(i sigma t) p(theta): harmonics (F, s), coefficients (F, N-1), sigma real."""

    sigma: float
    harmonics: Ints
    rates: Floats
    coefficients: Floats


def exact_direction(mode: NormalMode) -> NormalDirection:
    """A normal mode, elliptic."""
    sigma, p = float(mode.sigma.real), mode.in_doubles().coefficients.real
    return NormalDirection(sigma, mode.harmonics, mode.rates, p)


def direction_at_rest(place: int, sigma: float, n: int, s: int) -> NormalDirection:
    """One of the n modes alone, turning with sigma: a normal mode for small amplitudes."""
    alone = np.zeros((1, n))
    alone[0, place] = 1.0
    return NormalDirection(sigma, np.zeros((1, s), dtype=np.int64), np.zeros(1), alone)


def symplectic(a: Floats, b: Floats) -> Floats:
    """Omega of the columns of a (..., 2D, k) with those of b (..., 2D, m); (..., k, m)."""
    n = a.shape[-2] // 2
    left = np.swapaxes(a, -1, -2)
    return np.asarray(left[..., :n] @ b[..., n:, :] - left[..., n:] @ b[..., :n, :])


class LinearFlow:
    """The closed form of one torus.

    torus : in doubles. changes : of it with its actions. phases : of its angles where the frame is
    drawn, (s,). normal : its directions, all N-1-s of them. exact : whether these are solutions,
    or modes at rest.
    """

    def __init__(
        self,
        torus: Torus,
        changes: ActionChanges,
        phases: Floats,
        normal: Sequence[NormalDirection],
        *,
        exact: bool,
    ) -> None:
        self.harmonics, self.twist = changes.harmonics, changes.twist
        self.omega = np.array([float(w) for w in torus.frequencies])
        self.phases, self.normal, self.exact = phases, normal, exact
        self._shapes = mode_shapes(torus)
        self._modes = by_mode(torus, self.harmonics, changes.cosines)
        self._by_action = by_mode(torus, self.harmonics, changes.by_cosine)

    def basis(self, times: Floats) -> tuple[Floats, Floats, Floats]:
        """E, F and the normal directions without exp(i sigma t), as columns; (T, 2D, .)."""
        theta = times[:, None] * self.omega + self.phases
        along, across = self._along(theta)
        return along, across, self._across(theta, along, across)

    def _along(self, theta: Floats) -> tuple[Floats, Floats]:
        """E and F at angles (T, s)."""
        nu, c = self.harmonics, self._modes
        waves = np.exp(1j * (theta @ nu.T))
        rates = 1j * (nu @ self.omega)
        along, across = [], []
        for i, changed in enumerate(self._by_action):
            moved = waves * (1j * nu[:, i])
            along.append(self._state([(moved, c)], [(moved * rates, c)]))
            turned = waves * (1j * (nu @ self.twist[:, i]))
            momenta = [(waves * rates, changed), (turned, c)]
            across.append(self._state([(waves, changed)], momenta))
        return np.stack(along, axis=2), np.stack(across, axis=2)

    def _across(self, theta: Floats, along: Floats, across: Floats) -> Floats:
        """Re and Im of each normal direction; what is none exactly is made normal."""
        points, size, _ = along.shape
        found = np.zeros((points, size, 2 * len(self.normal)))
        waves: dict[int, Complex] = {}
        for place, direction in enumerate(self.normal):
            known = id(direction.harmonics)
            if known not in waves:
                waves = {known: np.exp(1j * (theta @ direction.harmonics.T))}
            rates = 1j * (direction.sigma + direction.rates)
            p = direction.coefficients
            for part, turn in enumerate((1, -1j)):
                turned = turn * waves[known]
                found[:, :, 2 * place + part] = self._state(
                    [(turned, p)], [(turned * rates, p)]
                )
        if self.exact:
            return found
        inwards, outwards = symplectic(across, found), symplectic(along, found)
        return np.asarray(found + along @ inwards - across @ outwards)

    def _state(self, positions: Sequence[Sum], momenta: Sequence[Sum]) -> Floats:
        """Displacements and momenta of sums over harmonics; (T, 2D)."""
        parts = [sum(map(self._displaced, sums)) for sums in (positions, momenta)]
        return np.concatenate(parts, axis=1)

    def _displaced(self, one: Sum) -> Floats:
        """The real part of a sum over harmonics, displaced by its modes; (T, D)."""
        weights, table = one
        if np.isrealobj(table) and np.isrealobj(self._shapes):
            return np.asarray(weights.real @ table @ self._shapes)
        return np.asarray((weights @ table @ self._shapes).real)

    def coordinates(self, deviations: Floats) -> Floats:
        """Of deviations (2D, k) at t = 0, by the columns of the basis; (2n, k)."""
        basis = np.concatenate(self.basis(np.zeros(1)), axis=2)[0]
        orthonormal, factor = np.linalg.qr(basis)
        return np.asarray(np.linalg.solve(factor, orthonormal.T @ deviations))

    def moved(self, start: Floats, times: Floats) -> Floats:
        """Those of the same deviations at times; (T, 2n, k)."""
        s = len(self.omega)
        angles, actions, normal = start[:s], start[s : 2 * s], start[2 * s :]
        turned = angles + times[:, None, None] * (self.twist @ actions)
        still = np.broadcast_to(actions, (len(times), *actions.shape))
        sigma = np.array([direction.sigma for direction in self.normal])
        phase = np.exp(1j * times[:, None] * sigma)[:, :, None]
        wave = (normal[0::2] - 1j * normal[1::2]) * phase
        rotated = np.empty((len(times), *normal.shape))
        rotated[:, 0::2], rotated[:, 1::2] = wave.real, -wave.imag
        return np.concatenate([turned, still, rotated], axis=1)

    def mean_metric(self) -> Floats:
        """The average of E_i.E_j over the torus, in closed form; (s, s)."""
        nu = self.harmonics
        sizes = (np.abs(self._modes @ self._shapes) ** 2).sum(axis=1)
        squares = sizes * (1 + (nu @ self.omega) ** 2)
        return np.asarray((nu * squares[:, None]).T @ nu / 2)
