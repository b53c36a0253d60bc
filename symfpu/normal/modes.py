"""Normal frequencies of a torus, as results.

In the directions normal to a torus of s angles every solution is a sum of N-1-s quasi-periodic
ones, exp(i sigma_q t) p(theta), and their conjugates. Real sigma: elliptic; complex ones, in
pairs sigma, conj(sigma): hyperbolic. sigma_q is told from sigma_q + nu.omega by its continuation
from Omega_q at rest: the largest coefficient of p is that of mode q without any angle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import mpmath
import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.errors import InputError, SymfpuError
from symfpu.normal.resonances import ParametricResonance
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION, text, with_digits
from symfpu.numbers.public import public
from symfpu.refinement.lattice import Floats, Ints
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, chain_fields, exact_by_seed, seeds_field
from symfpu.results.grid import Grid, Variable
from symfpu.results.numbers import fifteen_digits, number_text
from symfpu.results.result import Gridded
from symfpu.tori.torus import Torus

ELLIPTIC, HYPERBOLIC = "elliptic", "hyperbolic"
SIGMA_DIGITS, GROWTH_DIGITS = 13, 10  # that are shown of doubles


class NoNormalModes(SymfpuError):
    """The linearised flow about a torus could not be reduced to constant coefficients.

    Raised by `normal_modes`. mode : q of the frequency that was sought; guess : of it, from the
    closed second-order shift; nearest : the resonance nearest to it, a ParametricResonance, or None
    where no low one lets it couple. reason : why digits fail where doubles do not, or why it was
    lost on the way from another torus; empty where no frequency was found. Ours.
    """

    def __init__(
        self,
        mode: int,
        guess: float,
        nearest: ParametricResonance | None,
        reason: str = "",
        advice: str = "take normal_modes(torus.in_doubles())",
    ) -> None:
        self.mode, self.guess, self.nearest, self.reason = mode, guess, nearest, reason
        place = f"mode {mode} (guess {guess:.10g})"
        known = f"nearest resonance {nearest!r}" if nearest else "no resonance is near"
        problem = f"{place}: {reason}"
        if not reason:
            problem = f"no normal frequency continues {place}"
            advice = "take a torus of another amplitude, or leave the mode out by modes="
        super().__init__(f"{problem}: {known}; {advice}")


@dataclass(frozen=True)
class NormalDivisor:
    """A small divisor Omega_q'^2 - (sigma + nu.omega)^2, and the coefficient p_q'[nu] at it."""

    mode: int
    harmonic: tuple[int, ...]
    divisor: float | complex
    coefficient: float | complex

    def __repr__(self) -> str:
        harmonic = ",".join(map(str, self.harmonic))
        place = f"mode {self.mode}, harmonic ({harmonic})"
        size = abs(self.coefficient)
        return f"{abs(self.divisor):.2g} at {place}, coefficient {size:.2g}"


@public
@dataclass(frozen=True, eq=False)
class NormalMode:
    """A solution exp(i sigma t) p(theta) of the linearised equations; its conjugate is another.

    mode : q that it continues. sigma : a float, or complex with a positive imaginary part: then
        conj(sigma) belongs to another, the growing one. Dimensionless.
    harmonics : nu, of both signs, shape (F, s). rates : nu.omega, shape (F,), doubles.
    coefficients : p_q[nu], shape (F, N-1), of norm 1, real for real sigma.
    action : sum (sigma + nu.omega) |p|^2; its sign is Krein's. residual : of the linearised
        equations at all harmonics, over Omega_q^2.
    divisors : the smallest, doubles. deflated : how many near-resonant vectors were treated
        together. products : with the linearised force.
    digits : of sigma, coefficients and action that are mpf or mpc; None for doubles.
    error : with digits, of sigma, relative, and of a coefficient: an estimate, what one more step
        of Newton's method would change, at harmonics that were left out too, and what the error of
        the torus makes of sigma. No proof.
    rounding : of sigma, about: much where two directions nearly collide. Ours.

    >>> import symfpu
    >>> from symfpu import Chain, normal_modes
    >>> found = normal_modes(symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.1"}))
    >>> found.mode(3)
    NormalMode(sigma_3=1.854..., elliptic, signature +1, residual ...)
    """

    mode: int
    sigma: Any
    harmonics: Ints = field(repr=False)
    rates: Floats = field(repr=False)
    coefficients: NDArray[Any] = field(repr=False)
    action: Any
    residual: Any
    divisors: tuple[NormalDivisor, ...] = field(repr=False)
    deflated: int
    products: int = field(repr=False)
    digits: int | None = None
    error: Any = None
    rounding: float = field(default=0.0, repr=False)

    def __repr__(self) -> str:
        kind = f"{self.kind}, signature {self.signature:+d}"
        if self.kind == HYPERBOLIC:
            kind = f"{self.kind}, growth {text(self.growth, GROWTH_DIGITS)}"
        quality = f"residual {text(self.residual, 1)}"
        if self.digits is not None:
            quality += f", error about {text(self.error, 1)}"
        return f"NormalMode(sigma_{self.mode}={self.text}, {kind}, {quality})"

    @property
    def text(self) -> str:
        """sigma in 13 digits, or in all of more, with its conjugate where there is one."""
        unreal = ""
        if self.growth:
            unreal = f" +- {text(self.growth, self.digits or GROWTH_DIGITS)}i"
        return f"{text(self.sigma.real, self.digits or SIGMA_DIGITS)}{unreal}"

    @property
    def kind(self) -> str:
        """ "elliptic" or "hyperbolic"."""
        return HYPERBOLIC if self.growth else ELLIPTIC

    @property
    def growth(self) -> Any:
        """The rate at which a perturbation grows, |Im sigma|; exactly 0 if elliptic."""
        if self.digits is None:
            return abs(self.sigma.imag)
        with MULTIPRECISION.context(self.digits):
            return with_digits(abs(self.sigma.imag), self.digits)

    @property
    def signature(self) -> int:
        """Krein's: the sign of the action, of what turns with positive sigma; 0 if hyperbolic."""
        return 0 if self.growth else int(np.sign(float(self.action)))

    def in_doubles(self) -> NormalMode:
        """The same without digits: sigma, p and sizes rounded to doubles."""
        if self.digits is None:
            return self
        kind = complex if self.growth else float
        return replace(
            self,
            sigma=kind(self.sigma),
            coefficients=self.coefficients.astype(kind),
            action=float(self.action),
            residual=float(self.residual),
            digits=None,
            error=None,
        )

    def rate(self, row: int) -> float:
        """sigma + nu.omega of a harmonic, its real part; row : its place among the harmonics."""
        return complex(self.sigma).real + float(self.rates[row])

    def variation(self, theta: ArrayLike) -> NDArray[np.complex128]:
        """p at angles (T, s) or (s,), radians, phases included: complex, (T, N-1) or (N-1,)."""
        angles = DOUBLES.array(theta) @ self.harmonics.T
        return np.asarray(np.exp(1j * angles) @ self.in_doubles().coefficients)


MOST_SHOWN = 8  # normal frequencies that readers see beside a picture
NEAREST = 10  # resonances in a record


def sigma_entry(sigma: Any, digits: int | None = None) -> str | list[str]:
    """A normal frequency in a record: a real one as text, a complex one as [re, im]."""
    real = number_text(sigma.real, digits)
    return [real, number_text(sigma.imag, digits)] if sigma.imag else real


@public
@dataclass(frozen=True, eq=False)
class NormalModes(Gridded):
    """Normal frequencies of a torus, and its resonances. Made by `normal_modes`; ours.

    torus : the torus. modes : NormalMode of each direction, by growing q. guesses : by q, of the
        closed second-order shift.
    resonances : the nearest, by distance. undecided : modes so near to a collision with another
        that rounding hides whether they are stable. All is dimensionless.
    missing : by mode, why one could not be told from others.

    >>> import symfpu
    >>> from symfpu import Chain, normal_modes
    >>> found = normal_modes(symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.1"}))
    >>> found
    NormalModes(N=4, beta=1, omega_2=1.41..., stable, sigma_1=0.768..., sigma_3=1.854...,
    residual ...)
    >>> found.to_frame()[["mode", "kind", "signature"]]
       mode      kind  signature
    0     1  elliptic          1
    1     3  elliptic          1
    """

    torus: Torus
    modes: tuple[NormalMode, ...]
    guesses: dict[int, float] = field(repr=False)
    resonances: tuple[ParametricResonance, ...] = field(repr=False)
    undecided: tuple[int, ...] = field(default=(), repr=False)
    missing: dict[int, str] = field(default_factory=dict, repr=False)

    def _lines(self, width: int | None) -> Iterator[str]:
        """The verdict, a line a mode, and the nearest resonances."""
        chain, seeds = self.torus.chain, ",".join(map(str, self.torus.seeds))
        linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
        yield f"{chain.label}, seeds {seeds}: {self.verdict}"
        yield "  mode  normal frequency                   shift        kind, residual"
        for mode in self.modes:
            shift = complex(mode.sigma).real - linear[mode.mode]
            kind = f"{mode.kind}, {float(mode.residual):.0e}"
            yield f"  {mode.mode:4d}  {mode.text:33}  {shift:+.4e}  {kind}"
        yield from (f"  {q:4d}  {why}" for q, why in self.missing.items())
        if self.resonances:
            yield "nearest resonances:"
        yield from (f"  {one!r}" for one in self.resonances[:NEAREST])

    def _fields(self) -> Iterator[Field]:
        """Real frequencies are texts, complex ones [re, im]."""
        torus, digits = self.torus, self.digits
        yield from chain_fields(torus.chain)
        yield seeds_field(torus.seeds)
        yield Field("frequencies", exact_by_seed(torus.omega))
        yield Field("verdict", self.verdict)
        yield Field("stable", self.stable)
        yield Field("undecided", list(self.undecided))
        yield Field("missing", {str(q): why for q, why in self.missing.items()})
        yield Field("growth", fifteen_digits(float(self.growth)))
        sigma = {str(q): sigma_entry(w, digits) for q, w in self.frequencies.items()}
        yield Field("normal_frequencies", sigma)
        for mode in self.modes[:MOST_SHOWN]:
            name = f"\N{GREEK SMALL LETTER SIGMA} of mode {mode.mode}"
            yield Field("", label=name, shown=mode.text)
        signatures = {str(mode.mode): mode.signature for mode in self.modes}
        yield Field("signatures", signatures)
        nearest = self.resonances[:NEAREST]
        yield Field("resonances", [one.entry() for one in nearest])
        for one in nearest[:1]:
            yield Field("", label="nearest resonance", shown=repr(one))
        residual = float(self.residual)
        yield Field("residual", fifteen_digits(residual), "residual", f"{residual:.2g}")
        yield Field("digits", digits)
        if digits is not None:
            yield Field("frequency_error", number_text(self.error, 3))

    def __repr__(self) -> str:
        torus = self.torus
        chain = torus.chain.label
        pairs = zip(torus.seeds, torus.frequencies, strict=True)
        omega = "".join(f", omega_{q}={float(w):.10g}" for q, w in pairs)
        sigma = "".join(f", sigma_{mode.mode}={mode.text}" for mode in self.modes)
        none = "".join(f", no sigma_{q}" for q in self.missing)
        residual = f"residual {text(self.residual, 1)}"
        return f"NormalModes({chain}{omega}, {self.verdict}{sigma}{none}, {residual})"

    @property
    def digits(self) -> int | None:
        """Of sigma and eigenfunctions; None for doubles."""
        return next((mode.digits for mode in self.modes), None)

    @property
    def frequencies(self) -> dict[int, Any]:
        """sigma by mode: floats, or complex numbers with positive imaginary parts; or mpf, mpc."""
        return {mode.mode: mode.sigma for mode in self.modes}

    @property
    def residual(self) -> Any:
        """The largest of all modes; 0 where there is none."""
        return max((mode.residual for mode in self.modes), default=0.0)

    @property
    def error(self) -> Any:
        """The largest of all modes with digits; None of doubles."""
        if self.digits is None:
            return None
        return max(mode.error for mode in self.modes)

    @property
    def growth(self) -> Any:
        """The largest rate of growth; exactly 0 if all modes are elliptic."""
        return max((mode.growth for mode in self.modes), default=0.0)

    @property
    def stable(self) -> bool | None:
        """Whether all modes are elliptic; None where rounding hides it, or one is missing."""
        if self._unstable:
            return False
        return None if self.undecided or self.missing else True

    @property
    def _unstable(self) -> list[NormalMode]:
        """Those that are hyperbolic beyond doubt."""
        return [
            mode for mode in self.modes if mode.growth and mode.mode not in self.undecided
        ]

    @property
    def verdict(self) -> str:
        """In words."""
        if self.stable:
            return "stable"
        unstable = ", ".join(str(mode.mode) for mode in self._unstable)
        if unstable:
            return f"unstable: modes {unstable}, growth {float(self.growth):.7g}"
        if not self.undecided:
            none = ", ".join(map(str, self.missing))
            return f"undecided: no normal frequency of modes {none}"
        hidden = ", ".join(map(str, self.undecided))
        level = max(self.mode(q).rounding for q in self.undecided)
        nearness = f"nearer to a collision than {level:.1g}"
        return f"undecided: modes {hidden}, {nearness}; refine the torus with digits"

    @cached_property
    def _by_mode(self) -> dict[int, NormalMode]:
        return {mode.mode: mode for mode in self.modes}

    def mode(self, q: int) -> NormalMode:
        """The normal mode that continues q. Raises InputError for a seed, or one left out."""
        if q not in self._by_mode:
            advice = "see missing" if q in self.missing else "see modes"
            raise InputError("q", q, f"one of {list(self._by_mode)}", advice)
        return self._by_mode[q]

    def multipliers(self) -> dict[int, Any]:
        """exp(2 pi i sigma/omega) of a breather: Floquet's, by mode. Raises InputError."""
        exact = self.torus.frequency
        if self.digits is not None:
            with MULTIPRECISION.context(self.digits):
                turn = 2 / MULTIPRECISION.number(exact)
                found = {q: mpmath.expjpi(turn * s) for q, s in self.frequencies.items()}
                return with_digits(found, self.digits)
        omega = float(exact)
        return {
            q: complex(np.exp(2j * np.pi * s / omega)) for q, s in self.frequencies.items()
        }

    def _grid(self) -> Grid:
        rows, torus = ("mode",), self.torus
        sigma = np.array([complex(mode.sigma) for mode in self.modes])
        pairs = zip(torus.chain.mode_numbers, torus.chain.frequencies(), strict=True)
        linear = dict(pairs)
        columns: dict[str, tuple[Any, str]] = {
            "sigma": (sigma.real, "normal frequency, real part"),
            "growth": (np.abs(sigma.imag), "|Im sigma|: rate of growth"),
            "kind": ([mode.kind for mode in self.modes], "elliptic or hyperbolic"),
            "signature": ([mode.signature for mode in self.modes], "Krein's signature"),
            "linear_frequency": (
                [linear[mode.mode] for mode in self.modes],
                "Omega_q of small oscillations",
            ),
            "second_order": (
                [self.guesses[mode.mode] for mode in self.modes],
                "Omega_q with the closed second-order shift",
            ),
            "residual": (
                [float(mode.residual) for mode in self.modes],
                "of L p, over Omega_q^2",
            ),
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
                digits=self.digits,
            ),
            rows=rows,
        )
