"""Poincare-Lindstedt series of travelling waves on a ring: one real number for each monomial."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.algebra.grading import Grading, Ints
from symfpu.algebra.polynomials import square_root
from symfpu.algebra.travelling import TravellingDoubles, TravellingModes
from symfpu.chain.chain import Chain, require_any_chain
from symfpu.errors import InputError
from symfpu.files.progress import Progress
from symfpu.frames.attributes import attributes
from symfpu.frames.table import Table
from symfpu.frames.tabled import Tabled
from symfpu.numbers.arithmetic import DOUBLES, Arithmetic
from symfpu.numbers.typed import Number, integer
from symfpu.series.arguments import frequencies_of
from symfpu.series.coefficient_table import (
    STRETCH,
    Part,
    coefficient_table,
    harmonics_and_powers,
    of_amplitudes,
    of_frequency,
)
from symfpu.series.divisors import SmallDivisor
from symfpu.series.memory import check_size
from symfpu.series.monomials import shared_grading
from symfpu.series.recursion import run_recursion
from symfpu.series.rings import FLOAT64
from symfpu.series.sums import frequency_sums
from symfpu.series.tables import DoubleTables, Exponents
from symfpu.series.travelling_divisors import TravellingDivisors, place_of

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TravellingSeries(Tabled):
    """The series of travelling waves on a ring of N particles, with free amplitudes.

    Made by `travelling_waves`, ours; dimensionless, phases in radians. Every seed q is a wave,

        x_j = N^(-1/2) A_q sin(2 pi |q| j / N - sgn(q) theta_q),  theta_q = omega_q t + phi_q,

    which runs to higher j for q > 0, and a harmonic nu of the angles lives in one mode, that of
    nu.q modulo N. Stretches are N^(-1/2) sum u cos(nu.(2 pi q (j + 1/2)/N - theta)), u real.

    chain, seeds, order : as given. frequencies : omega of every seed, exact, shape (s,).
    grading : which monomials stand in which row.
    coordinates : for each order 0 .. order the u of its monomials, without mu, in the variables
        Omega_q (A_q/2) e^(i theta_q); shape (canonical monomials,).
    corrections : for each order 0 .. order, W_q^(k) of omega_q^2 = Omega_q^2 (1 + sum mu^k W^(k));
        shape (diagonal monomials, s); no rows where none exist.
    unit : of amplitudes, degree d carries unit^-(d-1). smallest_divisors : the smallest
        |lambda_q - (nu.omega)^2|, ascending. multiply_adds : operations of the recursion.

    >>> from symfpu import Chain, travelling_waves
    >>> travelling_waves(Chain(N=8, alpha="0.3", ends="periodic"), (1,), ("0.766",), 6)
    TravellingSeries(N=8, alpha=0.3, ends='periodic', seeds=1, order 6, 19 coefficients,
    smallest divisor 0.35 at mode 2, harmonic (2), order 1)
    >>> series = travelling_waves(Chain(N=8, beta=1, ends="periodic"), (1,), ("0.8",), 1)
    >>> series.to_frame().query("order == 1 and quantity == 'stretch'").nu_1.tolist()
    [3]
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    order: int
    grading: Grading = field(repr=False)
    coordinates: tuple[Floats, ...] = field(repr=False)
    corrections: tuple[Floats, ...] = field(repr=False)
    unit: Fraction
    smallest_divisors: tuple[SmallDivisor, ...]
    multiply_adds: int = 0

    digits = None

    @property
    def omega(self) -> dict[int, Fraction]:
        """The frequencies by seed, as the amplitudes are; exact."""
        return dict(zip(self.seeds, self.frequencies, strict=True))

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        seeds = ",".join(map(str, self.seeds))
        size = f"{sum(map(len, self.coordinates)):,} coefficients"
        smallest = ""
        if self.smallest_divisors:
            smallest = f", smallest divisor {self.smallest_divisors[0]}"
        return f"TravellingSeries({chain}, seeds={seeds}, order {self.order}, {size}{smallest})"

    @property
    def numbers(self) -> Arithmetic:
        """Doubles."""
        return DOUBLES

    def degree(self, order: int) -> int:
        """Degree of order k in the amplitudes: k + 1, or 2k + 1 where V is even."""
        return 1 + self.chain.degree_step * self._order(order)

    def _order(self, order: int) -> int:
        if integer(order, "order", 0) > self.order:
            allowed = f"0..{self.order}, the series' order"
            raise InputError("order", order, allowed, "compute a longer series")
        return int(order)

    @cached_property
    def _linear(self) -> Floats:
        places = [place_of(self.chain, q) for q in self.seeds]
        return np.asarray(self.chain.frequencies()[places])

    @cached_property
    def _kappa(self) -> float:
        """The factor |mu|^(1/step) unit of the variables, before the scaled tables apply."""
        root = abs(self.chain.mu) ** (1 / self.chain.degree_step)
        return float(root * self.unit)

    def _sign(self, order: int) -> float:
        return -1.0 if self.chain.mu < 0 and order % 2 else 1.0

    @cached_property
    def seed_factors(self) -> Floats:
        """kappa Omega_i / 2: the scaled variables at unit amplitudes; shape (s,)."""
        return self._kappa / 2 * self._linear

    def harmonic_terms(self, amplitudes: ArrayLike, order: int) -> tuple[Ints, Floats]:
        """mu^k times order k of the stretches at these amplitudes, by harmonics.

        amplitudes : (s,) in the order of the seeds. order : k.

        Returns harmonics (H, s), one of each pair +-nu, and u (H,), the coefficients of
        N^(-1/2) cos(nu.(2 pi q (j + 1/2)/N - theta)) in r_j. Raises InputError.
        """
        scaled = np.asarray(amplitudes, dtype=float)
        if scaled.shape != (len(self.seeds),):
            allowed = f"one for each of the seeds {self.seeds}"
            advice = "pass a sequence in their order"
            raise InputError("amplitudes", scaled.shape, allowed, advice)
        degree = self.degree(order)
        nu, index = self.grading.harmonics(degree)
        monomials = np.prod(
            (self.seed_factors * scaled) ** self.grading.powers(degree), axis=1
        )
        summands = self.coordinates[order] * monomials
        values = np.bincount(index, summands, len(nu)).astype(float)
        pairs = np.where((nu != 0).any(axis=1), 2.0, 1.0)
        return nu, values * pairs * (self._sign(order) / self._kappa)

    def frequency_terms(
        self, squared_amplitudes: ArrayLike, order: int | None = None
    ) -> tuple[Floats, Floats]:
        """mu^k omega_q^(k) for k = 0 .. order (default all) at A^2, and the derivatives by A^2.

        squared_amplitudes : (s,). order : the last k. Returns terms (order + 1, s), order 0 being
        Omega_q, and derivatives (order + 1, s, s) with the last axis for the variable.
        """
        top = self.order if order is None else self._order(order)
        orders = range(1, top + 1)
        diagonals = [self.grading.diagonal(self.chain.degree_step * k) for k in orders]
        tables = [self._sign(k) * self.corrections[k] for k in orders]
        squares = np.asarray(squared_amplitudes, dtype=float)
        slope = self.seed_factors**2
        return frequency_sums(self._linear, slope, squares, diagonals, tables)

    def frequency_coefficients(self, q: int, order: int) -> tuple[Ints, Floats]:
        """omega_q^(k) without mu^k, as a polynomial in the amplitudes (Eq. omeser).

        Returns exponents (count, s) of the amplitudes and coefficients (count,), none of them zero.
        """
        i, top = self.seeds.index(q), self._order(order)
        squares = [self._square_part(k, i) for k in range(top + 1)]
        polynomials = [
            dict(zip(map(tuple, part.powers.tolist()), part.values.tolist(), strict=True))
            for part in squares
        ]
        roots = square_root(polynomials, float(self._linear[i]))
        chosen = {exponents: c for exponents, c in roots[top].items() if c != 0}
        rows = np.array(list(chosen), dtype=np.int64).reshape(-1, len(self.seeds))
        return rows, np.array(list(chosen.values()))

    def _table(self) -> Table:
        """One row for each coefficient of the stretches and of omega^2, without mu^k."""
        orders = range(self.order + 1)
        stretches = [part for k in orders for part in self._stretch_parts(k)]
        squares = [self._square_part(k, i) for k in orders for i in range(len(self.seeds))]
        known = attributes(
            self,
            self.chain,
            seeds=self.seeds,
            frequencies=self.frequencies,
            order=self.order,
        )
        return coefficient_table([*stretches, *squares], self.seeds, known)

    def _stretch_parts(self, order: int) -> Iterator[Part]:
        """By mode the coefficients of N^(-1/2) prod A^power cos(nu.(2 pi q (j+1/2)/N - theta))."""
        degree = self.degree(order)
        rows = self.grading.canonical(degree)
        harmonics, powers = harmonics_and_powers(self.grading.exponents(degree)[rows])
        scale = Exponents(self.unit, degree - 1, 0)
        values = DoubleTables().scaled(
            self.coordinates[order], self._linear.tolist(), powers, scale
        )
        found = of_amplitudes(values, harmonics, degree)
        DoubleTables().finite(found, f"order {order} of the stretches")
        places = harmonics @ np.array(self.seeds) % self.chain.N
        for q in self.chain.mode_numbers:
            chosen = (places == q % self.chain.N) & (found != 0)
            if chosen.any():
                yield Part(
                    STRETCH, order, q, harmonics[chosen], powers[chosen], found[chosen]
                )

    def _square_part(self, order: int, i: int) -> Part:
        """[omega_q^2]^(k) of one seed."""
        degree = self.chain.degree_step * order
        square = self._linear[i] ** 2
        exponents, values = np.zeros((1, len(self.seeds)), dtype=np.int64), np.ones(1)
        if order:
            exponents = 2 * self.grading.diagonal(degree)
            scale = Exponents(self.unit, degree, degree)
            values = DoubleTables().scaled(
                self.corrections[order][:, i], self._linear.tolist(), exponents, scale
            )
        return of_frequency(order, self.seeds[i], exponents, square * values, squared=True)


def travelling_waves(
    chain: Chain,
    seeds: Sequence[int],
    frequencies: Sequence[Number] | Mapping[int, Number],
    order: int,
    *,
    progress: Progress | None = None,
) -> TravellingSeries:
    """The Poincare-Lindstedt series of travelling waves on a ring, with free amplitudes.

    chain : with ends="periodic". seeds : distinct signed modes; q and -q are two waves.
    frequencies : omega_q of each seed, exact numbers, shape (s,) or by seed; dimensionless.
    order : K of the coordinates and of the frequency corrections, from 0 up.
    progress : called as (label, fraction done).

    Ours: the recursion of Eqs. moda and modb on modes of one wave each: a harmonic nu lives in
    the mode nu.q modulo N. In doubles. Raises InputError for arguments out of range and a chain
    with fixed ends, TooLarge, and ResonantDivisor at the first harmonic that is in resonance with
    its mode: for the chosen frequencies, or for the linear ones, as 2 omega_(-q) - omega_q with
    mode q at q = N/4. What to do then is in the message and in docs/chains.md.

    >>> from symfpu import Chain
    >>> series = travelling_waves(Chain(N=8, beta=1, ends="periodic"), (1,), ("0.8",), 1)
    >>> series.corrections[1].round(12).tolist()  # omega^2 = Omega^2 (1 + 3 mu |w|^2)
    [[3.0]]
    """
    if not require_any_chain(chain).periodic:
        allowed = "a chain with ends='periodic'"
        raise InputError("chain", chain, allowed, "fixed ends have lindstedt(chain, ...)")
    modes = chain.seeds_of(seeds)
    omega = frequencies_of(frequencies, modes)
    order = integer(order, "order", 0)
    return series_of_waves(chain, modes, omega, order, progress)


def series_of_waves(
    chain: Chain,
    modes: tuple[int, ...],
    omega: tuple[Fraction, ...],
    order: int,
    progress: Progress | None,
    *,
    phantom: bool = False,
) -> TravellingSeries:
    """The series of checked arguments; phantom : cut at the first power of the first seed."""
    check_size(chain.at(N=2), modes, order, FLOAT64.name, phantom=phantom)
    degree = 1 + chain.degree_step * order
    grading = shared_grading(len(modes), degree, phantom=phantom)
    space = TravellingModes(chain.N, modes, grading)
    ring = TravellingDoubles(space, points=1)  # type: ignore[arg-type]
    divisors = TravellingDivisors(chain, space, omega)
    run_recursion(ring, divisors, chain, order, progress)
    waves, corrections, unit = ring.results()
    return TravellingSeries(
        chain=chain,
        seeds=modes,
        frequencies=omega,
        order=order,
        grading=grading,
        coordinates=tuple(table[:, 0] for table in waves),
        corrections=(np.zeros((0, len(modes))), *corrections),
        unit=unit,
        smallest_divisors=divisors.smallest(),
        multiply_adds=ring.multiply_adds,
    )
