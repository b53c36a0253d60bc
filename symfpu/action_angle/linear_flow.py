"""The linearised flow about a torus, in closed form.

The solutions of the linearised equations are spanned by
    E_i = dz/dtheta_i, s of them, along the torus,
    F_j + t sum_i Lambda_ij E_i, F_j = dz/dI_j: neighbouring tori turn against each other,
    Re and Im of exp(i sigma_q t) p_q(theta), 2(n-s) of them, normal to the torus,
z = (Q, P), all at theta = omega t + phi. The changes of action of a deviation v are dI = Omega(E,
v) with the symplectic form Omega(a, b) = a_Q.b_P - a_P.b_Q; they stay as they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.newton_twist import ActionChanges
from symfpu.normal.modes import NormalMode
from symfpu.refinement.equation import Floats, Ints

Complex = NDArray[np.complex128]


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


def direction_at_rest(q: int, sigma: float, n: int, s: int) -> NormalDirection:
    """The mode q alone, turning with sigma: what a normal mode is for small amplitudes."""
    alone = np.zeros((1, n))
    alone[0, q - 1] = 1.0
    return NormalDirection(sigma, np.zeros((1, s), dtype=np.int64), np.zeros(1), alone)


def symplectic(a: Floats, b: Floats) -> Floats:
    """Omega of the columns of a (..., 2n, k) with those of b (..., 2n, m); (..., k, m)."""
    n = a.shape[-2] // 2
    left = np.swapaxes(a, -1, -2)
    return np.asarray(left[..., :n] @ b[..., n:, :] - left[..., n:] @ b[..., :n, :])


class LinearFlow:
    """The closed form of one torus.

    changes : of the torus with its actions. omega, phases : of its angles, (s,). normal : its
    directions, all N-1-s of them. exact : whether these are solutions, or modes at rest.
    """

    def __init__(
        self,
        changes: ActionChanges,
        omega: Floats,
        phases: Floats,
        normal: Sequence[NormalDirection],
        *,
        exact: bool,
    ) -> None:
        self.changes, self.omega, self.phases = changes, omega, phases
        self.normal, self.exact = normal, exact
        self.twist = changes.twist

    def basis(self, times: Floats) -> tuple[Floats, Floats, Floats]:
        """E, F and the normal directions without exp(i sigma t), as columns; (T, 2n, .)."""
        theta = times[:, None] * self.omega + self.phases
        along, across = self._along(theta)
        return along, across, self._across(theta, along, across)

    def _along(self, theta: Floats) -> tuple[Floats, Floats]:
        """E and F at angles (T, s)."""
        made = self.changes
        nu, c = made.harmonics, made.cosines
        rates = nu @ self.omega
        angles = theta @ nu.T
        cosines, sines = np.cos(angles), np.sin(angles)
        along, across = [], []
        for i, changed in enumerate(made.by_cosine):
            turned = nu @ made.twist[:, i]
            along.append(
                _state(-(sines * nu[:, i]) @ c, -(cosines * (nu[:, i] * rates)) @ c)
            )
            momenta = -(sines * rates) @ changed - (sines * turned) @ c
            across.append(_state(cosines @ changed, momenta))
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
            Q = waves[known] @ direction.coefficients
            P = (waves[known] * rates) @ direction.coefficients
            found[:, :, 2 * place] = _state(Q.real, P.real)
            found[:, :, 2 * place + 1] = _state(Q.imag, P.imag)
        if self.exact:
            return found
        inwards, outwards = symplectic(across, found), symplectic(along, found)
        return np.asarray(found + along @ inwards - across @ outwards)

    def coordinates(self, deviations: Floats) -> Floats:
        """Of deviations (2n, k) at t = 0, by the columns of the basis; (2n, k)."""
        basis = np.concatenate(self.basis(np.zeros(1)), axis=2)[0]
        return np.asarray(np.linalg.solve(basis, deviations))

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
        made = self.changes
        nu = made.harmonics
        squares = (made.cosines**2).sum(axis=1) * (1 + (nu @ self.omega) ** 2)
        return np.asarray((nu * squares[:, None]).T @ nu / 2)


def _state(Q: Floats, P: Floats) -> Floats:
    return np.concatenate([Q, P], axis=1)
