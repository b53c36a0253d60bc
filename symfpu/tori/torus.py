"""Quasi-periodic solutions by their cosine coefficients.

They give the orbit, its energies, their averages, and residuals.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from numbers import Real
from typing import Any, ClassVar, Generic, Self, TypeGuard

import mpmath
import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import TypeVar

from symfpu.algebra.grading import Ints
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import (
    DOUBLES,
    MULTIPRECISION,
    Arithmetic,
    Numbers,
    text,
    with_digits,
)
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer
from symfpu.results.attributes import RADIANS, attributes
from symfpu.results.field import (
    Field,
    chain_fields,
    exact_by_seed,
    numbers_by_seed,
    seeds_field,
    shown_frequency,
    shown_number,
)
from symfpu.results.grid import Grid, Variable
from symfpu.results.numbers import fifteen_digits, number_text
from symfpu.results.result import Gridded
from symfpu.results.table import joined
from symfpu.tori.columns import CHUNK, Columns, ModeColumns, columns_of, require_columns

Floats = NDArray[np.float64]
Value = TypeVar("Value")

GRID_POINTS = 4096  # angles at which a residual is taken, about
MOST_ANGLES = 10**8  # angles of a grid that is asked for; minutes
TRANSFORMED = 4 * GRID_POINTS  # angles whose sums are held at once, at most
DOUBLES_RESIDUAL = 1e-10  # relative residuals above it need no more digits
GRID_POINTS_DIGITS = 16  # the same for numbers of many digits
SHOWN_DIGITS = 40  # of amplitudes, at most, in print


@dataclass(frozen=True, repr=False)
class Origin:
    """How a torus was made. Classes of it keep what only that way of making one knows.

    >>> Origin()
    Origin()
    """

    name: ClassVar[str] = "torus"

    def facts(self) -> tuple[str, ...]:
        """What the torus says of it in print, besides what all tori say."""
        return ()

    def quality(self, torus: Torus) -> str:
        """How well it solves the equations of motion, in print."""
        return f"residual {torus.residual():.2g}"

    def variables(self) -> dict[str, Variable]:
        """Arrays of its own for the data set of the torus."""
        return {}

    def chosen_amplitudes(self) -> tuple[Any, ...] | None:
        """A in the order of the seeds, where they were chosen before the coefficients."""
        return None

    def require_whole(self, torus: Torus) -> None:
        """ValueError where it cannot be the origin of the torus: of what a file held."""

    def fields(self, torus: Torus) -> Iterator[Field]:
        """What only this way of making a torus knows of it."""
        yield from ()

    def lines(self, known: Mapping[str, Any]) -> Iterator[str]:
        """The same for a reader. known : the record of the torus."""
        yield from ()

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(self.facts())})"


Made = TypeVar("Made", bound=Origin, default=Origin, covariant=True)
Kind = TypeVar("Kind", bound=Origin)
GIVEN = Origin()


@public
@dataclass(frozen=True, eq=False, repr=False)
class Torus(Gridded, Generic[Made]):
    """A solution Q_q(t) = sum over harmonics of c_q[nu] cos(nu.(omega t + phi)).

    Every torus and breather is one, with fixed ends and on a ring: what a series, Newton's method
    or harmonic balance finds, or what is given.

    chain : the model; all quantities are dimensionless, phases in radians. seeds : the s modes
        that name the angles.
    frequencies : omega of every seed, exact, shape (s,). harmonics : the nu, integers, one of each
        pair +-nu, shape (H, s).
    cosines : their coefficients, shape (H, C): c_q[nu] of the modes with fixed ends. On a ring
        those of travelling waves, C = 1, or of standing waves, whose columns are the modes of half
        of it (`symfpu.tori.columns`).
    phases : phi by seed, 0 where left out. digits : of the cosines in mpf; None for doubles.
    travels : True for travelling waves of a ring. warnings : reasons to doubt that this is a torus.
    origin : how it was made, with what only that way knows: `FromSeries`, `Resummed`, `Newton`,
        `IterativeRefinement` or `HarmonicBalance`; `Origin()` of coefficients that were given.

    On a ring mode coordinates are complex, Q_(-q) = conj Q_q. With digits, results are mpf or
    arrays of them, evaluated with that many digits and more, which print that many; else doubles.

    Eqs. qser and serabs1 with the amplitudes put in. Whether it solves the equations of motion is
    what `residual` measures. Raises InputError for coefficients of another shape.

    >>> from symfpu import Chain
    >>> half = (Fraction(1, 2),)
    >>> harmonics, cosines = np.array([[1]]), np.array([[1.0, 0, 0]])
    >>> mode = Torus(Chain(4, alpha=1), (1,), half, harmonics, cosines, {1: 0.0})
    >>> mode
    Torus(N=4, alpha=1, omega_1=0.5, A_1=1, H=..., 1 harmonic, residual ...)
    >>> mode.Q(0.0)
    array([1., 0., 0.])
    >>> mode.to_frame()
      harmonic  mode  nu_1  cosine  average_energy  linear_frequency
    0        1     1     1     1.0        0.208947          0.765367
    1        1     2     1     0.0        0.000000          1.414214
    2        1     3     1     0.0        0.000000          1.847759
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    harmonics: Ints
    cosines: Numbers
    phases: Mapping[int, Any] = field(default_factory=dict)
    digits: int | None = None
    travels: bool = False
    warnings: tuple[str, ...] = ()
    origin: Made = GIVEN  # type: ignore[assignment]

    def __post_init__(self) -> None:
        require_columns(
            self.chain, self.seeds, self.harmonics, self.cosines, travels=self.travels
        )
        phases = {q: self.phases.get(q, 0.0) for q in self.seeds}
        object.__setattr__(self, "phases", phases)
        show(self, "cosines", "phases")

    def _answer(self) -> str:
        return "; ".join(self.warnings) or f"residual {self.residual():.2g}"

    def _fields(self) -> Iterator[Field]:
        yield Field("origin", type(self.origin).__name__)
        yield from chain_fields(self.chain)
        yield seeds_field(self.seeds)
        yield Field("frequencies", exact_by_seed(self.omega))
        yield Field("digits", self.digits)
        yield Field("amplitudes", numbers_by_seed(self.amplitudes, self.digits))
        for q, omega in self.omega.items():
            size = shown_number(self.amplitudes[q], self.digits)
            shown = f"\N{GREEK SMALL LETTER OMEGA} = {shown_frequency(omega)}, A = {size}"
            yield Field("", label=f"seed {q}", shown=shown)
        yield from self._energy_fields()
        yield Field("residual", fifteen_digits(self.residual()))
        yield Field("harmonics", len(self.harmonics), "harmonics")
        yield Field("warnings", list(self.warnings))
        yield from self.origin.fields(self)

    def _lines(self, width: int | None) -> Iterator[str]:
        """Angles, energies, residual, what its origin knows, and warnings."""
        known = {field.key: field.value for field in self._fields()}
        if "verdict" in known:
            yield f"verdict: {known['verdict']}"
        yield self.chain.label
        for q, omega in self.omega.items():
            A = known["amplitudes"][str(q)]
            yield f"seed {q:<4} omega {shown_frequency(omega):<20} amplitude {A}"
        average = f"time average {known['average_harmonic_energy']}"
        relative = "equations of motion, relative to the largest acceleration"
        digits = "doubles" if self.digits is None else counted(self.digits, "digit")
        yield f"energy H           {known['energy']}   (at t = 0)"
        yield f"harmonic energy    {known['harmonic_energy']}   (at t = 0; {average})"
        yield f"residual           {known['residual']:.2g}   ({relative})"
        yield f"harmonics          {known['harmonics']}, in {digits}"
        yield from self.origin.lines(known)
        yield from (f"warning: {warning}" for warning in self.warnings)

    def _energy_fields(self) -> Iterator[Field]:
        """H and sum E_q at t = 0, and the time average of the latter, with all digits."""
        with self._context():
            H, harmonic = self.energy(), self.harmonic_energies().sum()
            average = self.average_spectrum().sum()
        text_of_H = number_text(H, self.digits)
        yield Field("energy", text_of_H, "energy H", shown_number(H, self.digits))
        yield Field("harmonic_energy", number_text(harmonic, self.digits))
        yield Field("average_harmonic_energy", number_text(average, self.digits))

    def __repr__(self) -> str:
        chain = self.chain.label
        by_seed = zip(self.seeds, self.frequencies, strict=True)
        rates = [f"omega_{q}={float(w):.13g}" for q, w in by_seed]
        places = min(self.digits or 13, SHOWN_DIGITS)
        more = ".." if (self.digits or 0) > SHOWN_DIGITS else ""
        amplitudes = [f"A_{q}={text(A, places)}{more}" for q, A in self.amplitudes.items()]
        digits = [] if self.digits is None else [counted(self.digits, "digit")]
        energy, harmonics = float(self.energy()), counted(len(self.harmonics), "harmonic")
        quality = [f"H={energy:.12g}", harmonics, self.origin.quality(self)]
        known = [chain, *rates, *amplitudes, *digits, *quality, *self.origin.facts()]
        doubts = "".join(f"; {warning}" for warning in self.warnings)
        return f"Torus({', '.join(known)}{doubts})"

    def require_finite(self) -> None:
        """ValueError where a coefficient or a phase is not finite."""
        finite = (
            np.isfinite if self.digits is None else np.vectorize(mpmath.isfinite, [bool])
        )
        if not np.all(finite(self.cosines)):
            raise ValueError("a coefficient that is not finite")
        if not all(map(mpmath.isfinite, self.phases.values())):
            raise ValueError("a phase that is not finite")

    def _require_whole(self) -> None:
        self.require_finite()
        s, shape = len(self.seeds), np.shape(self.harmonics)
        self.chain.seeds_of(self.seeds)
        if len(self.frequencies) != s or min(self.frequencies) <= 0:
            raise ValueError(f"frequencies do not fit the seeds {self.seeds}")
        if len(shape) != 2 or shape[1] != s or not shape[0]:
            raise ValueError(f"harmonics of the shape {shape} for {s} seeds")
        if (self.digits is None) != (self.cosines.dtype == np.float64):
            raise ValueError(
                f"coefficients of {self.cosines.dtype} for digits {self.digits}"
            )
        self.origin.require_whole(self)

    def doubted(self, warnings: Sequence[str]) -> Self:
        """The same torus with these warnings; its residual is kept where it is known."""
        torus = replace(self, warnings=tuple(warnings))
        if "_residual" in self.__dict__:
            torus.__dict__["_residual"] = self.__dict__["_residual"]
        return torus

    @cached_property
    def amplitudes(self) -> Mapping[int, Any]:
        """A_q by seed, the coefficient of cos(theta_q) in Q_q, or of the wave of the seed.

        Zero where there is no such coefficient.
        """
        chosen = self.origin.chosen_amplitudes()
        if chosen is not None:
            return dict(zip(self.seeds, chosen, strict=True))
        units = np.eye(len(self.seeds), dtype=np.int64)
        found = {}
        for q, unit in zip(self.seeds, units, strict=True):
            own = (self.harmonics == unit).all(axis=1) | (self.harmonics == -unit).all(
                axis=1
            )
            value = self.cosines[own, self.column(q)].sum()
            found[q] = (
                float(value) if self.digits is None else with_digits(value, self.digits)
            )
        return found

    @property
    def stands(self) -> bool:
        """Whether it is one of standing waves on a ring, as `unfold` makes them."""
        return self.chain.periodic and not self.travels

    @property
    def numbers(self) -> Arithmetic:
        """The arithmetic of the results."""
        return DOUBLES if self.digits is None else MULTIPRECISION

    def _context(self) -> Any:
        return self.numbers.context(self.digits)

    @cached_property
    def _omega(self) -> Numbers:
        return np.array([self.numbers.number(w) for w in self.frequencies])

    @cached_property
    def _columns(self) -> Columns:
        """What its coefficients stand for."""
        return columns_of(self.chain, self.seeds, self.harmonics, travels=self.travels)

    @cached_property
    def _rates(self) -> Numbers:
        """nu.omega of every harmonic; shape (H,)."""
        return np.asarray(self.harmonics @ self._omega)

    # solutions of one angle

    @property
    def omega(self) -> dict[int, Fraction]:
        """The frequencies by seed, as the amplitudes are; exact."""
        return dict(zip(self.seeds, self.frequencies, strict=True))

    @property
    def seed(self) -> int:
        """The seed mode of a solution of one angle; raises InputError for more."""
        return self._only("seed", self.seeds)

    @property
    def frequency(self) -> Fraction:
        """omega of a solution of one angle, exact; raises InputError for more."""
        return self._only("frequency", self.frequencies)

    @property
    def amplitude(self) -> Any:
        """A of a solution of one angle, the coefficient of cos(omega t + phi) in Q_seed.

        Raises InputError for more.
        """
        return self._only("amplitude", tuple(self.amplitudes.values()))

    def by_harmonic(self) -> Numbers:
        """Coefficients of a solution of one angle by the number n of the harmonic, 0 .. H.

        Row n belongs to cos(n (omega t + phi)); shape (H+1, C). Raises InputError for more
        angles.
        """
        self._only("harmonics", self.seeds)
        n = np.abs(self.harmonics[:, 0])
        table = self.numbers.zeros((max(int(n.max()), 1) + 1, self.cosines.shape[1]))
        table[n] = self.cosines
        return table

    def column(self, q: int) -> int:
        """Which of the columns of coefficients belongs to the mode q at its own harmonic."""
        return self._columns.column(q)

    def _only(self, name: str, values: tuple[Value, ...]) -> Value:
        if len(self.seeds) == 1:
            return values[0]
        advice = "use seeds, frequencies, amplitudes, harmonics and cosines"
        raise InputError(
            name, f"of {len(self.seeds)} angles", "that of a solution of one angle", advice
        )

    # along the orbit

    def in_doubles(self) -> Torus:
        """The same solution with its coefficients rounded to doubles."""
        phases = {q: float(phi) for q, phi in self.phases.items()}
        cosines = self.cosines.astype(float)
        given: Any = GIVEN
        return replace(self, cosines=cosines, phases=phases, digits=None, origin=given)

    def state(self, t: float = 0.0) -> tuple[Floats, Floats]:
        """Mode coordinates Q and momenta P at a time, in doubles, for `integrate` to start from.

        t : a number, dimensionless. Returns two arrays (N-1,). Raises InputError for many times.

        >>> import symfpu
        >>> from symfpu import Chain, integrate
        >>> orbit = symfpu.torus(Chain(N=8, alpha="0.3"), (1,), amplitudes={1: "0.4"})
        >>> integrate(orbit.chain, *orbit.state(), 10.0, step=0.1).energy_error < 1e-10
        True
        """
        if np.ndim(t):
            raise InputError(
                "t",
                t,
                "one finite number",
                "take Q(t) and P(t) for many times",
            )
        kind = self.chain.kind_of_ends.mode_type
        return self.Q(t).astype(kind), self.P(t).astype(kind)

    def Q(self, t: ArrayLike) -> Numbers:
        """Mode coordinates Q_q(t); t a number or an array (T,), result (N-1,) or (T, N-1)."""
        return with_digits(self._Q(t), self.digits)

    def _Q(self, t: ArrayLike) -> Numbers:
        return self._along(t, self.cosines)

    def P(self, t: ArrayLike) -> Numbers:
        """Mode momenta P_q(t) = dQ_q/dt.

        t : a number or an array (T,), result (N-1,) or (T, N-1).
        """
        return with_digits(self._P(t), self.digits)

    def _P(self, t: ArrayLike) -> Numbers:
        with self._context():
            velocities = -self._rates[:, None] * self.cosines
            return self._along(t, velocities, sine=True)

    def _along(self, t: ArrayLike, coefficients: Numbers, *, sine: bool = False) -> Numbers:
        """Modes of coefficients of cos(nu.theta), or of sin(nu.theta), at times."""
        with self._context():
            times = self._times(t)
            theta = times.reshape(-1, 1) * self._omega + self._offsets()
            [values] = self._at_angles(theta, [coefficients], sine=sine)
            return values[0] if times.ndim == 0 else values

    def _times(self, t: ArrayLike) -> Numbers:
        try:
            times = self.numbers.array(t)
        except (TypeError, ValueError) as error:
            raise InputError(
                "t", t, "a finite number or an array of them", "pass real numbers"
            ) from error
        if times.ndim > 1 or not self.numbers.finite(times):
            allowed = "a finite number or a one-dimensional array of them"
            raise InputError("t", t, allowed, "flatten it")
        return times

    def _offsets(self) -> Numbers:
        return self.numbers.array([self.phases[q] for q in self.seeds])

    def _at_angles(
        self, theta: Numbers, tables: Sequence[Numbers], *, sine: bool = False
    ) -> list[Numbers]:
        """Modes (P, N-1) of tables of coefficients at angles (P, s)."""
        step = max(1, CHUNK // len(self.harmonics))
        parts = []
        for i in range(0, len(theta), step):
            angles = theta[i : i + step] @ self.harmonics.T
            parts.append(self._columns.modes(angles, tables, self.numbers, sine=sine))
        if not parts:
            kind = self.chain.kind_of_ends.mode_type
            return [np.zeros((0, self.chain.N - 1), dtype=kind) for _ in tables]
        return [np.concatenate(found) for found in zip(*parts, strict=True)]

    def x(self, t: ArrayLike) -> Numbers:
        """Displacements x_1 .. x_(N-1); t a number or (T,), result (N-1,) or (T, N-1).

        On a ring x_0 .. x_(N-1).
        """
        with self._context():
            return with_digits(self.chain.positions(self._Q(t)), self.digits)

    def p(self, t: ArrayLike) -> Numbers:
        """Momenta of the particles; t a number or (T,), result (N-1,) or (T, N-1)."""
        with self._context():
            return with_digits(self.chain.positions(self._P(t)), self.digits)

    # energies

    def energy(self, t: ArrayLike = 0.0) -> Any:
        """Total energy H at t, a number or (T,), in the shape of t.

        Constant in time for an exact torus.
        """
        with self._context():
            energy = self.chain.energy(self._Q(t), self._P(t))
            return with_digits(energy[()], self.digits)

    def harmonic_energies(self, t: ArrayLike = 0.0) -> Numbers:
        """Harmonic energies E_q(t) (Eq. harmonicene); shape of t with an axis N-1 at the end."""
        with self._context():
            energies = self.chain.harmonic_energies(self._Q(t), self._P(t))
            return with_digits(energies, self.digits)

    def energy_error(self, t: ArrayLike, *, harmonic: bool = False) -> Numbers:
        """Relative error (E(t) - E(0)) / E(0) of the total energy, or of the harmonic one, sum E_q.

        As in section 3.2.
        """
        with self._context():
            if harmonic:
                values = self.harmonic_energies(t).sum(axis=-1)
                start = self.harmonic_energies().sum()
            else:
                values, start = self.energy(t), self.energy()
            return with_digits(np.asarray((values - start) / start), self.digits)

    def average_spectrum(self, T: float | None = None) -> Numbers:
        """Time averages of the harmonic energies E_q, in closed form; shape (N-1,).

        T : averaging time from t = 0, computed in doubles; None for the infinite-time average,
        (1/4) sum c^2 ((nu.omega)^2 + Omega^2) over nu != 0 plus the constant term. With the factor
        1/2 of E_q that the paper's section 3.2 leaves out. On a ring a wave has half of its energy
        in q and half in -q, and waves of one mode with equal rates interfere.
        """
        if T is None:
            return with_digits(self._averages(None), self.digits)
        if not isinstance(T, Real) or not np.isfinite(float(T)) or T <= 0:
            raise InputError(
                "T", T, "a positive finite time, or None for infinite", "pass T > 0"
            )
        return self.in_doubles()._averages(float(T))

    def _averages(self, T: float | None) -> Numbers:
        with self._context():
            offsets = self.harmonics @ self._offsets()
            return self._columns.averages(
                T, self.cosines, self.frequencies, offsets, self.numbers
            )

    # the equations of motion

    def residuals(self, points: int | None = None) -> Numbers:
        """Largest |d^2Q_q/dt^2 - force| of each mode on a grid of angles, shape (N-1,).

        Zero for an exact torus.

        points : grid points for each of the s angles; default such that the grid has about 4096.
        With digits, where doubles cannot see the residual, about 16.
        """
        return with_digits(self._residuals(points)[0], self.digits)

    def residual(self, points: int | None = None) -> float:
        """Largest residual on a grid of angles, over the largest acceleration.

        Infinite where a bond is beyond the wall of its potential there.

        points : grid points for each angle, as for `residuals`.
        """
        return self._residual if points is None else self._residual_of(points)

    @cached_property
    def _residual(self) -> float:
        """The residual on the default grid, which every sentence on this solution states."""
        return self._residual_of(None)

    def _residual_of(self, points: int | None) -> float:
        residuals, largest = self._residuals(points)
        found = float(residuals.max() / largest)
        return math.inf if math.isnan(found) else found

    def _residuals(self, points: int | None) -> tuple[Numbers, Any]:
        if self.digits is not None and points is None:
            residuals, largest = self.in_doubles()._residuals(None)
            if residuals.max() > DOUBLES_RESIDUAL * largest:
                return residuals, largest
        number = self._grid_points() if points is None else integer(points, "points", 1)
        with self._context():
            return self._worst_on_grid(number)

    def _grid_points(self) -> int:
        """Points for each of the angles by default."""
        wanted = GRID_POINTS if self.digits is None else GRID_POINTS_DIGITS
        return points_of_each_angle(wanted, len(self.seeds))

    def _worst_on_grid(self, number: int) -> tuple[Numbers, Any]:
        """By mode the largest |d^2Q_q/dt^2 - force|, and the largest force.

        The linear force of a harmonic is taken with its second derivative, where the two cancel.
        """
        worst = np.zeros(self.chain.N - 1)
        largest: Any = 0.0
        squares = self.chain.frequencies(self.numbers) ** 2
        own = self._columns.linear(self.numbers) ** 2
        linear = (own - self._rates[:, None] ** 2) * self.cosines
        for Q, off in self._on_grid([self.cosines, linear], number):
            anharmonic = self.chain.anharmonic_accelerations(Q)
            worst = np.maximum(worst, np.abs(off - anharmonic).max(axis=0))
            largest = max(largest, np.abs(anharmonic - squares * Q).max())
        return worst, largest

    def _on_grid(self, tables: Sequence[Numbers], number: int) -> Iterator[list[Numbers]]:
        """Modes of tables of coefficients at the angles of the grid, in its portions, or all."""
        columns, small = self._columns, number ** len(self.seeds) <= TRANSFORMED
        if self.digits is None and small and isinstance(columns, ModeColumns):
            yield columns.modes_on_grid(tables, number)
            return
        for theta in self.angle_grid(number):
            yield self._at_angles(theta, tables)

    def energy_range(self) -> float:
        """The range of H over a grid of angles, over its mean: zero for an exact torus."""
        with self._context():
            velocities = -self._rates[:, None] * self.cosines
            energies = []
            for theta in self.angle_grid(self._grid_points()):
                [Q] = self._at_angles(theta, [self.cosines])
                [P] = self._at_angles(theta, [velocities], sine=True)
                energies.append(self.chain.energy(Q, P))
            H = np.concatenate(energies)
            return float((H.max() - H.min()) / abs(H.mean()))

    def angle_grid(self, number: int) -> Iterator[Numbers]:
        """The tensor grid of angles, radians, in portions (P, s); a shift keeps it off 0 and pi.

        number : of points for each of the s angles; at most MOST_ANGLES points in all.
        """
        s = len(self.seeds)
        each = integer(number, "number", 1)
        if each**s > MOST_ANGLES:
            allowed = f"at most {MOST_ANGLES:,} points on the grid of {s} angles"
            raise InputError("number", each, allowed, "take fewer points for each angle")
        return self._angles(each)

    def _angles(self, number: int) -> Iterator[Numbers]:
        shape = (number,) * len(self.seeds)
        points, portion = math.prod(shape), angles_at_once(self.chain)
        for start in range(0, points, portion):
            index = np.arange(start, min(start + portion, points))
            digits = np.stack(np.unravel_index(index, shape), axis=-1)
            yield 2 * self.numbers.pi * (3 * digits + 1) / (3 * number)

    # as a table

    def _grid(self) -> Grid:
        seeds, modes = ("seed",), ("mode",)
        phases = [self.phases[q] for q in self.seeds]
        amplitudes = [self.amplitudes[q] for q in self.seeds]
        nu = "factor of the angle of a seed in a harmonic"
        average = "infinite-time average of the harmonic energy E_q"
        with self._context():
            rates = with_digits(self._omega, self.digits)
            linear = with_digits(self.chain.frequencies(self.numbers), self.digits)
        columns = self._columns.columns
        return Grid(
            axes={
                "harmonic": list(map(joined, self.harmonics.tolist())),
                "mode": self.chain.mode_numbers,
                "seed": self.seeds,
                **columns,
            },
            variables={
                "nu": Variable(("harmonic", "seed"), self.harmonics, nu),
                **self._columns.variables(self.cosines),
                **self.origin.variables(),
                "frequency": Variable(seeds, rates, "frequency omega_q of a seed"),
                "amplitude": Variable(
                    seeds, amplitudes, "coefficient of cos(theta_q) in Q_q"
                ),
                "phase": Variable(seeds, phases, "angle at t = 0", RADIANS),
                "average_energy": Variable(modes, self.average_spectrum(), average),
                "linear_frequency": Variable(
                    modes, linear, "Omega_q of small oscillations"
                ),
            },
            attributes=attributes(
                self,
                self.chain,
                seeds=self.seeds,
                frequencies=self.frequencies,
                energy=self.energy(),
                digits=self.digits,
                warnings=self.warnings,
            ),
            rows=("harmonic", *columns),
            across="seed",
        )


def angles_at_once(chain: Chain) -> int:
    """How many angles of a grid are in one portion."""
    return max(1, min(GRID_POINTS, CHUNK // chain.N))


def points_of_each_angle(wanted: int, s: int) -> int:
    """Of a grid of s angles that has about so many points; 2 to 64."""
    number: int = round(wanted ** (1 / s))
    return max(2, min(64, number))


def require_solution(solution: object, argument: str) -> Torus:
    """A torus or a breather; InputError for what is none."""
    if not isinstance(solution, Torus):
        advice = "pass what torus, solve_amplitudes or refine gave"
        raise InputError(
            argument, type(solution).__name__, "a solution: a torus or a breather", advice
        )
    return solution


def require_fixed_solution(
    solution: object, argument: str, advice: str = "what takes a ring is in docs/chains.md"
) -> Torus:
    """The same of a chain with fixed ends; InputError also for one of a ring, with advice."""
    found = require_solution(solution, argument)
    if found.chain.periodic:
        allowed = "a solution of a chain with fixed ends: this is not known on a ring"
        raise InputError(argument, f"of {found.chain!r}", allowed, advice)
    return found


def comes_from(torus: object, origin: type[Kind]) -> TypeGuard[Torus[Kind]]:
    """Whether this is a torus that was made in a way.

    >>> comes_from(3, Origin)
    False
    """
    return isinstance(torus, Torus) and isinstance(torus.origin, origin)


def show(result: Any, *names: str) -> None:
    """Lets numbers in these fields of a frozen result print its digits; for `__post_init__`."""
    if result.digits is not None:
        for name in names:
            shown = with_digits(getattr(result, name), result.digits)
            object.__setattr__(result, name, shown)
