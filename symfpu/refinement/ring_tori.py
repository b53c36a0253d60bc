"""Tori of travelling waves by Newton's method, and what a torus has to be for it."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from math import lcm

import numpy as np

from symfpu.errors import InputError
from symfpu.numbers.counted import counted
from symfpu.refinement.conditions import seed_amplitudes
from symfpu.refinement.lattice import low_harmonics
from symfpu.refinement.newton import Iterate, NewtonStep
from symfpu.refinement.resonances import NearResonance, near_resonances
from symfpu.refinement.waves import WaveEquation
from symfpu.series.travelling_divisors import resonant
from symfpu.tori.ring_torus import RingTorus
from symfpu.tori.travelling import signs_of

SUSPECT = 1e-9  # of nu.omega, below which it is decided exactly
STANDING = (
    "opposite waves of one frequency stand: refine the solution of Chain(N // 2, ...) with "
    "fixed ends and unfold it; else change a frequency"
)


@dataclass(frozen=True, eq=False)
class RefinedRingTorus(RingTorus):
    """A torus of travelling waves on a ring, found by Newton's method; dimensionless.

    A `RingTorus` that solves the equations of motion to rounding: x_j(t) = N^(-1/2) sum
    b sin(2 pi m j / N - nu.theta). Made by `refine` and its sisters. Ours.

    chain : with ends="periodic". seeds, frequencies, phases, amplitudes : of the s angles,
        frequencies exact, the others by seed. harmonics : nu of every wave, shape (W, s).
        modes : its m = nu.seeds, shape (W,). sines : its b, shape (W,).
    frequency_order, order : None, there is no series. warnings : reasons to doubt it.
    steps : of Newton's method with the final harmonics.
    near_resonances : the smallest divisors (nu.omega)^2 - Omega_q^2, q = nu.seeds modulo N, with
        the amplitudes of the waves under them.

    >>> from symfpu import Chain, refine, travelling_torus, travelling_waves
    >>> chain = Chain(N=8, alpha="0.3", ends="periodic")
    >>> refine(travelling_torus(travelling_waves(chain, (1,), ("0.766",), 4)))
    RefinedRingTorus(N=8, alpha=0.3, ends='periodic', omega_1=0.766, A_1=0.2938896094153,
    H=0.02547126..., 10 waves, residual ..., smallest divisor 0.35 at mode 2, ...)
    """

    steps: tuple[NewtonStep, ...] = field(default=(), repr=False)
    near_resonances: tuple[NearResonance, ...] = field(default=(), repr=False)

    @property
    def verdict(self) -> str:
        """'torus', or 'doubtful' with the reasons in `warnings`."""
        return "doubtful" if self.warnings else "torus"

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        by_seed = zip(self.seeds, self.frequencies, strict=True)
        rates = ", ".join(f"omega_{q}={float(w):.16g}" for q, w in by_seed)
        found = ", ".join(f"A_{q}={a:.13g}" for q, a in self.amplitudes.items())
        quality = f"H={float(self.energy()):.12g}, {counted(len(self.sines), 'wave')}"
        near = self.near_resonances[:1]
        nearest = "".join(f", smallest divisor {divisor}" for divisor in near)
        doubts = "".join(f"; {warning}" for warning in self.warnings)
        left = f"residual {self.residual():.2g}{nearest}{doubts}"
        return f"RefinedRingTorus({chain}, {rates}, {found}, {quality}, {left})"


def require_independent(torus: RingTorus) -> None:
    """InputError where nu.omega = 0 for a low harmonic: the angles are not independent then."""
    frequencies = torus.frequencies
    harmonics = np.concatenate([low_harmonics(len(frequencies)), torus.harmonics])
    shared = lcm(*(w.denominator for w in frequencies))
    whole = [int(w * shared) for w in frequencies]
    near = np.abs(harmonics @ np.array([float(w) for w in frequencies])) < SUSPECT
    for nu in sorted(harmonics[near].tolist(), key=_size):
        if any(nu) and not sum(n * w for n, w in zip(nu, whole, strict=True)):
            terms = zip(nu, torus.seeds, strict=True)
            relation = " ".join(f"{n:+d} omega_{q}" for n, q in terms if n)
            allowed = "frequencies without an integer relation among the harmonics"
            raise InputError("torus", f"{relation} = 0", allowed, STANDING)


def _size(nu: list[int]) -> tuple[int, list[int]]:
    """The sum of |nu_i|, and of equal ones those first whose first number is positive."""
    return sum(map(abs, nu)), [-n for n in nu]


def driven_in_resonance(torus: RefinedRingTorus) -> str:
    """The lowest of the small divisors that are zero at the linear frequencies, in words.

    Empty where there is none.
    """
    chain, seeds = torus.chain, torus.seeds
    for found in sorted(torus.near_resonances, key=lambda d: _size(list(d.harmonic))):
        if resonant(chain, seeds, found.harmonic, found.mode):
            harmonic = ",".join(map(str, found.harmonic))
            drive = f"the harmonic ({harmonic}) drives mode {found.mode} in resonance"
            return f"{drive} at any frequencies near the linear ones (Umklapp)"
    return ""


def refined_waves(
    torus: RingTorus,
    equation: WaveEquation,
    found: Iterate,
    frequencies: tuple[Fraction, ...],
) -> RefinedRingTorus:
    """The torus of an iterate of Newton's method."""
    seeds, N = torus.seeds, torus.chain.N
    moving = equation.mask[:, 0]
    harmonics = equation.harmonics[moving]
    modes = harmonics @ np.array(seeds)
    amplitudes = map(float, seed_amplitudes(equation, found.cosines))
    signed = np.where(2 * equation.waves > N, equation.waves - N, equation.waves)
    near = near_resonances(equation, found.cosines, found.shifts, signed[:, None])
    return RefinedRingTorus(
        chain=torus.chain,
        seeds=seeds,
        frequencies=frequencies,
        phases={q: float(phi) for q, phi in torus.phases.items()},
        amplitudes=dict(zip(seeds, amplitudes, strict=True)),
        harmonics=harmonics,
        modes=modes,
        sines=signs_of(modes, N) * found.cosines[moving, 0].astype(float),
        steps=found.steps,
        near_resonances=near,
    )
