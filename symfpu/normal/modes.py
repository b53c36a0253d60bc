"""Normal frequencies of a torus: the linearised flow reduced to constant coefficients.

In the directions normal to a torus of s angles every solution is a sum of N-1-s quasi-periodic
ones, exp(i sigma_q t) p(theta), and their conjugates. Real sigma: elliptic; complex ones, in
pairs sigma, conj(sigma): hyperbolic. sigma_q is told from sigma_q + nu.omega by its continuation
from Omega_q at rest: the largest coefficient of p is that of mode q without any angle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import require_fixed_ends
from symfpu.chain.frequency_shift import shift_coefficients
from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import Progress, unheard
from symfpu.frames.attributes import attributes
from symfpu.frames.grid import Grid, Variable
from symfpu.frames.tabled import Gridded
from symfpu.normal.linearised import LinearisedFlow, coefficients_by_harmonic
from symfpu.normal.reduction import Reduced, reduced
from symfpu.normal.resonances import ParametricResonance, resonances_of
from symfpu.notebook import Shown
from symfpu.numbers.typed import integer, seed_modes
from symfpu.refinement.invariance import Ints
from symfpu.refinement.tori import chosen_harmonics
from symfpu.tori.quasiperiodic import (
    QuasiPeriodic,
    amplitudes_of,
    require_solution,
)

REFINED = 1e-9  # residual of a torus, relative, above which it is refused
# coefficients of the torus above these parts of its largest, and what their harmonics may leave
HEIGHTS, TOLERANCE = (1e-8, 1e-11, 1e-14, 1e-17), 1e-10
SMALLEST_KEPT = (
    1e-18  # coefficients of the torus below this part of its largest are rounding
)
SHOWN_DIVISORS = 5
LENGTH = 12  # sum |nu_i| of the resonances that are listed
ELLIPTIC, HYPERBOLIC = "elliptic", "hyperbolic"


class NoNormalModes(SymfpuError):
    """The linearised flow about a torus could not be reduced to constant coefficients.

    Raised by `normal_modes`. mode : q of the frequency that was sought; guess : of it, from the
    closed second-order shift; nearest : the resonance nearest to it, a ParametricResonance. Ours.
    """

    def __init__(self, mode: int, guess: float, nearest: ParametricResonance) -> None:
        self.mode, self.guess, self.nearest = mode, guess, nearest
        super().__init__(
            f"no normal frequency continues mode {mode} (guess {guess:.10g}): "
            f"nearest resonance {nearest!r}; "
            f"take a torus of another amplitude, or leave the mode out by modes="
        )


@dataclass(frozen=True)
class NormalDivisor:
    """A small divisor Omega_q'^2 - (sigma + nu.omega)^2, and the coefficient p_q'[nu] at it."""

    mode: int
    harmonic: tuple[int, ...]
    divisor: complex
    coefficient: complex

    def __repr__(self) -> str:
        harmonic = ",".join(map(str, self.harmonic))
        place = f"mode {self.mode}, harmonic ({harmonic})"
        size = abs(self.coefficient)
        return f"{abs(self.divisor):.2g} at {place}, coefficient {size:.2g}"


@dataclass(frozen=True, eq=False)
class NormalMode:
    """A solution exp(i sigma t) p(theta) of the linearised equations; its conjugate is another.

    mode : q that it continues. sigma : a float, or complex with a positive imaginary part: then
        conj(sigma) belongs to another, the growing one. Dimensionless.
    harmonics : nu, of both signs, shape (F, s). coefficients : p_q[nu], of norm 1, (F, N-1), real
        for real sigma.
    action : sum (sigma + nu.omega) |p|^2; its sign is Krein's. residual : of the linearised
        equations at all harmonics, over Omega_q^2.
    divisors : the smallest. deflated : how many near-resonant vectors were treated together.
    products : with the linearised force.
    """

    mode: int
    sigma: complex
    harmonics: Ints = field(repr=False)
    coefficients: NDArray[Any] = field(repr=False)
    action: float
    residual: float
    divisors: tuple[NormalDivisor, ...] = field(repr=False)
    deflated: int
    products: int = field(repr=False)

    def __repr__(self) -> str:
        kind = f"{self.kind}, signature {self.signature:+d}"
        if self.kind == HYPERBOLIC:
            kind = f"{self.kind}, growth {self.growth:.10g}"
        return f"NormalMode(sigma_{self.mode}={self.text}, {kind}, residual {self.residual:.1g})"

    @property
    def text(self) -> str:
        """sigma in 13 digits, with its conjugate where there is one."""
        value = complex(self.sigma)
        unreal = f" +- {abs(value.imag):.10g}i" if self.growth else ""
        return f"{value.real:.13g}{unreal}"

    @property
    def kind(self) -> str:
        """ "elliptic" or "hyperbolic"."""
        return HYPERBOLIC if self.growth else ELLIPTIC

    @property
    def growth(self) -> float:
        """The rate at which a perturbation grows, |Im sigma|; exactly 0 if elliptic."""
        return abs(complex(self.sigma).imag)

    @property
    def signature(self) -> int:
        """Krein's: the sign of the action, of what turns with positive sigma; 0 if hyperbolic."""
        return 0 if self.growth else int(np.sign(self.action))

    def variation(self, theta: ArrayLike) -> NDArray[np.complex128]:
        """p at angles (T, s) or (s,), radians, phases included: complex, (T, N-1) or (N-1,)."""
        angles = np.asarray(theta, dtype=float) @ self.harmonics.T
        return np.asarray(np.exp(1j * angles) @ self.coefficients)


@dataclass(frozen=True, eq=False)
class NormalModes(Shown, Gridded):
    """Normal frequencies of a torus, and its resonances. Made by `normal_modes`; ours.

    torus : the torus. modes : NormalMode of each direction, by growing q. guesses : by q, of the
        closed second-order shift.
    resonances : the nearest, by distance. All is dimensionless.

    >>> from symfpu import Chain, breather_at_amplitude, normal_modes
    >>> found = normal_modes(breather_at_amplitude(Chain(N=4, beta=1), 2, "0.1"))
    >>> found
    NormalModes(N=4, beta=1, omega_2=1.42..., stable, sigma_1=0.77..., sigma_3=1.86...,
    residual ...)
    >>> found.to_frame()[["mode", "kind", "signature"]]
       mode      kind  signature
    0     1  elliptic          1
    1     3  elliptic          1
    """

    torus: QuasiPeriodic
    modes: tuple[NormalMode, ...]
    guesses: dict[int, float] = field(repr=False)
    resonances: tuple[ParametricResonance, ...] = field(repr=False)

    def __repr__(self) -> str:
        torus = self.torus
        chain = repr(torus.chain).removeprefix("Chain(").removesuffix(")")
        pairs = zip(torus.seeds, torus.frequencies, strict=True)
        omega = "".join(f", omega_{q}={float(w):.10g}" for q, w in pairs)
        sigma = "".join(f", sigma_{mode.mode}={mode.text}" for mode in self.modes)
        return f"NormalModes({chain}{omega}, {self.verdict}{sigma}, residual {self.residual:.1g})"

    @property
    def frequencies(self) -> dict[int, complex]:
        """sigma by mode: floats, or complex numbers with positive imaginary parts."""
        return {mode.mode: mode.sigma for mode in self.modes}

    @property
    def residual(self) -> float:
        """The largest of all modes; 0 where there is none."""
        return max((mode.residual for mode in self.modes), default=0.0)

    @property
    def growth(self) -> float:
        """The largest rate of growth; exactly 0 if all modes are elliptic."""
        return max((mode.growth for mode in self.modes), default=0.0)

    @property
    def stable(self) -> bool:
        """Whether all modes are elliptic."""
        return self.growth == 0

    @property
    def verdict(self) -> str:
        """In words."""
        if self.stable:
            return "stable"
        unstable = ", ".join(str(mode.mode) for mode in self.modes if mode.growth)
        return f"unstable: modes {unstable}, growth {self.growth:.7g}"

    @cached_property
    def _by_mode(self) -> dict[int, NormalMode]:
        return {mode.mode: mode for mode in self.modes}

    def mode(self, q: int) -> NormalMode:
        """The normal mode that continues q. Raises InputError for a seed, or one left out."""
        if q not in self._by_mode:
            raise InputError("q", q, f"one of {list(self._by_mode)}", "see modes")
        return self._by_mode[q]

    def multipliers(self) -> dict[int, complex]:
        """exp(2 pi i sigma/omega) of a breather: Floquet's, by mode. Raises InputError."""
        omega = float(self.torus.frequency)
        return {
            q: complex(np.exp(2j * np.pi * s / omega)) for q, s in self.frequencies.items()
        }

    def _grid(self) -> Grid:
        rows, torus = ("mode",), self.torus
        sigma = np.array([complex(mode.sigma) for mode in self.modes])
        linear = torus.chain.frequencies()
        columns: dict[str, tuple[Any, str]] = {
            "sigma": (sigma.real, "normal frequency, real part"),
            "growth": (np.abs(sigma.imag), "|Im sigma|: rate of growth"),
            "kind": ([mode.kind for mode in self.modes], "elliptic or hyperbolic"),
            "signature": ([mode.signature for mode in self.modes], "Krein's signature"),
            "linear_frequency": (
                [linear[mode.mode - 1] for mode in self.modes],
                "Omega_q of small oscillations",
            ),
            "second_order": (
                [self.guesses[mode.mode] for mode in self.modes],
                "Omega_q with the closed second-order shift",
            ),
            "residual": ([mode.residual for mode in self.modes], "of L p, over Omega_q^2"),
            "deflated": (
                [mode.deflated for mode in self.modes],
                "vectors treated together",
            ),
        }
        return Grid(
            axes={"mode": [mode.mode for mode in self.modes]},
            variables={
                name: Variable(rows, values, meaning)
                for name, (values, meaning) in columns.items()
            },
            attributes=attributes(
                self,
                torus.chain,
                seeds=torus.seeds,
                frequencies=torus.frequencies,
                stable=self.stable,
            ),
            rows=rows,
        )


def normal_modes(
    solution: QuasiPeriodic,
    *,
    modes: Iterable[int] | None = None,
    resonance_length: int = LENGTH,
    progress: Progress | None = None,
) -> NormalModes:
    """Normal frequencies of a torus or breather, their eigenfunctions, signatures and resonances.

    solution : of any potential with fixed ends and of any number of angles, refined: its residual
        is at most 1e-9. Dimensionless; one of many digits is rounded to doubles.
    modes : which of the N-1-s modes; default all.
    resonance_length : largest sum |nu_i| of the resonances listed.
    progress : called as (label, fraction), once a mode.

    The equations of motion (Eq. eqmo) linearised about the torus are solved by exp(i sigma t)
    p(theta), in harmonics of the angles: Newton's method from Omega_q with its closed shift of
    second order, products on the lattice that `refine` uses. Of a breather, exp(2 pi i
    sigma/omega) are the Floquet multipliers. Ours: the paper has none. Raises InputError, and
    NoNormalModes where a resonance does not let a mode be told from others.

    >>> from symfpu import Chain, refine_at_amplitudes, torus_at_amplitudes
    >>> amplitudes = {1: "0.2", 2: "0.1"}
    >>> guess = torus_at_amplitudes(Chain(N=4, alpha="0.3"), amplitudes, order=4)
    >>> round(normal_modes(refine_at_amplitudes(guess, amplitudes)).frequencies[3], 9)
    1.847...
    """
    torus = _checked(solution)
    chosen = _checked_modes(torus, modes)
    length = integer(resonance_length, "resonance_length", 1)
    tell = progress or unheard
    guesses = _guesses(torus)
    flows = _flows(torus)
    found = []
    for number, q in enumerate(chosen):
        tell(f"normal mode {q}", number / len(chosen))
        mode = _normal_mode(flows, q, guesses[q])
        if mode is None:
            nearest = _resonances(torus, {q: guesses[q]}, length)[0]
            raise NoNormalModes(q, guesses[q], nearest)
        found.append(mode)
    real = {mode.mode: complex(mode.sigma).real for mode in found}
    return NormalModes(
        torus=solution,
        modes=tuple(found),
        guesses={q: guesses[q] for q in chosen},
        resonances=tuple(_resonances(torus, real, length)),
    )


def _checked(solution: object) -> QuasiPeriodic:
    """The solution in doubles; InputError for what is no refined torus of fixed ends."""
    require_solution(solution, "solution")
    assert isinstance(solution, QuasiPeriodic)
    require_fixed_ends(solution.chain)
    torus = solution.in_doubles()
    residual = solution.residual()
    if not residual <= REFINED:
        given = f"a torus whose residual is {residual:.2g}"
        allowed = f"one that solves the equations of motion to {REFINED:.0e}"
        raise InputError("solution", given, allowed, "refine it first: refine(solution)")
    return torus


def _checked_modes(torus: QuasiPeriodic, modes: Iterable[int] | None) -> tuple[int, ...]:
    normal = [q for q in torus.chain.mode_numbers if q not in torus.seeds]
    if modes is None:
        return tuple(normal)
    given = seed_modes(modes, torus.chain.N)
    if set(given) - set(normal):
        allowed = f"modes that are no seeds, of {normal}"
        raise InputError("modes", given, allowed, "leave the seeds out")
    return tuple(sorted(given))


def _guesses(torus: QuasiPeriodic) -> dict[int, float]:
    """Omega_q with the closed shift of second order by the amplitudes of the seeds, by mode."""
    chain = torus.chain
    squares = chain.frequencies() ** 2
    cubic, quartic = (float(chain.potential.coefficient(n)) for n in (3, 4))
    guesses = {}
    for q in chain.mode_numbers:
        shift = 0.0
        for n, A in amplitudes_of(torus).items():
            (a, b), c = shift_coefficients(chain.N, q, n)
            square = float(squares[n - 1])
            by_cubic = cubic**2 * (float(a) + float(b) * square)
            shift += A**2 / (2 * chain.N) * (by_cubic + quartic * float(c) * square)
        guesses[q] = float(np.sqrt(squares[q - 1])) * (1 + shift)
    return guesses


Flows = Callable[[int], LinearisedFlow | None]


def _flows(torus: QuasiPeriodic) -> Flows:
    """Linearised flows with ever more harmonics, by the place in HEIGHTS; None beyond the last."""
    known = coefficients_by_harmonic(torus)
    largest = max(float(np.abs(row).max()) for row in known.values())
    kept = {nu: c for nu, c in known.items() if np.abs(c).max() > SMALLEST_KEPT * largest}
    made: list[LinearisedFlow] = []

    def flow(place: int) -> LinearisedFlow | None:
        if place == len(HEIGHTS):
            return None
        if place == len(made):
            chosen, _ = chosen_harmonics(
                kept, torus.chain, len(torus.seeds), HEIGHTS[place]
            )
            made.append(LinearisedFlow(torus, chosen))
        return made[place]

    return flow


def _normal_mode(flows: Flows, q: int, guess: float) -> NormalMode | None:
    """With as many harmonics as the tolerance needs; the best one met where that cannot be."""
    best: NormalMode | None = None
    place = 0
    while flow := flows(place):
        found = reduced(flow, q, guess)
        if found and (best is None or found.residual < best.residual):
            best = _mode_of(flow, found)
        if best and best.residual < TOLERANCE:
            break
        place += 1
    return best


def _mode_of(flow: LinearisedFlow, found: Reduced) -> NormalMode:
    return NormalMode(
        mode=found.mode,
        sigma=found.sigma,
        harmonics=flow.harmonics,
        coefficients=found.coefficients,
        action=found.action,
        residual=found.residual,
        divisors=_smallest_divisors(flow, found),
        deflated=found.deflated,
        products=found.products,
    )


def _smallest_divisors(flow: LinearisedFlow, found: Reduced) -> tuple[NormalDivisor, ...]:
    every = flow.divisors(found.sigma)
    sizes = np.where(flow.allowed(found.mode), np.abs(every), np.inf)
    sizes[0, found.mode - 1] = np.inf
    order = np.argsort(sizes, axis=None)[:SHOWN_DIVISORS]
    places = zip(*np.unravel_index(order, sizes.shape), strict=True)
    nearest = []
    for row, column in places:
        if np.isfinite(sizes[row, column]):
            harmonic = tuple(flow.harmonics[row].tolist())
            divisor = every[row, column].item()
            coefficient = found.coefficients[row, column].item()
            nearest.append(NormalDivisor(int(column) + 1, harmonic, divisor, coefficient))
    return tuple(nearest)


def _resonances(
    torus: QuasiPeriodic, sigma: dict[int, float], length: int
) -> list[ParametricResonance]:
    omega = tuple(float(w) for w in torus.frequencies)
    return resonances_of(torus.chain, torus.seeds, omega, sigma, length)
