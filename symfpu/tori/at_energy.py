"""A torus of a given energy, in a given ratio of amplitudes or of mode energies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from symfpu.chain.chain import Chain, require_chain
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers
from symfpu.numbers.typed import seed_modes
from symfpu.series.arguments import digits_of
from symfpu.tori.broyden import Found, NotFound, solve, walk
from symfpu.tori.energy import Energy
from symfpu.tori.frequencies import (
    Frequencies,
    Point,
    doubted,
    listed,
    positive_by_seed,
    refuse_tiny,
    require_size,
)
from symfpu.tori.from_series import FromSeries
from symfpu.tori.orders import Orders, require_shifts
from symfpu.tori.torus import Torus

# relative error of the energy: what is not worth another torus, what a solution may leave
LEAST_ERROR, LARGEST_ERROR = 2e-15, 2e-13
SPARE_DIGITS = 1  # digits beyond the asked ones to which the energy is met
# change of the amplitudes squared from their guess, relative, that stays on the family
LARGEST_DEVIATION = 0.3
# residual, relative to the largest acceleration, from which the energy of a truncated series
# means nothing
LARGEST_RESIDUAL = 0.25
POINTS = 128  # angles at which that residual is taken, about


class NoTorusAtEnergy(SymfpuError):
    """No torus of this energy: the way from the linear modes ends below it.

    Raised by `torus` of a series at a given energy.

    energy : asked for; harmonic : whether it is sum E_q. reached : the largest energy on the way;
        amplitudes : by seed, there, {} if there was none. reason : why it was not followed on.
        Energies and amplitudes are dimensionless. Ours.
    """

    def __init__(self, target: _Target, last: _Member, failure: NotFound) -> None:
        self.energy = float(target.energy)
        self.harmonic = target.harmonic
        self.reason = failure.reason
        self.reached = 0.0
        self.amplitudes: dict[int, float] = {}
        if last.torus is not None:
            self.reached = float(target.measured(last.torus))
            self.amplitudes = {q: float(a) for q, a in last.torus.amplitudes.items()}
        name = "harmonic energy" if self.harmonic else "energy H"
        there = f" ({listed('A', self.amplitudes)})" if self.amplitudes else ""
        way = f"its family was followed from 0 to {self.reached:.6g}{there}"
        end = f"at order {target.search.orders.order}, then: {self.reason}"
        advice = "take a smaller energy or another order"
        super().__init__(f"no torus of {name} {self.energy:.6g}: {way} {end}; {advice}")


@dataclass(frozen=True, eq=False)
class _Member:
    """A torus on the way.

    unknowns : A^2 in units of those of the linear chain with the same energy; inverse : Broyden's
    matrix.
    """

    unknowns: Numbers
    inverse: Numbers
    point: Point
    torus: Torus[FromSeries] | None


@dataclass(frozen=True, eq=False)
class _Target:
    """What is asked, and the equations for it.

    (E - energy) / energy, or with mode energies, e_q E / (w_q sum e energy) - 1.

    e_q : time average of E_q of a seed, w_q its weight, sum w = 1. The latter vanish together if
    and only if E is the energy and the e are as the w. Both kinds have a matrix near 1 at small
    energies.
    """

    search: Frequencies
    asked: Energy
    weights: tuple[Fraction, ...]  # of A^2 of the seeds, or of their mode energies

    @property
    def energy(self) -> Fraction:
        """What is asked for."""
        return self.asked.exact

    @property
    def harmonic(self) -> bool:
        """Whether it is sum E_q."""
        return self.asked.harmonic

    @property
    def by_amplitude(self) -> bool:
        """Whether the weights are those of A^2."""
        return self.asked.amplitude_ratio is not None

    def measured(self, torus: Torus[FromSeries]) -> Any:
        """H, or the sum of E_q, at t = 0."""
        return torus.harmonic_energies().sum() if self.harmonic else torus.energy()

    @property
    def linear_squares(self) -> Numbers:
        """A^2 of the seeds on the linear chain with the whole energy; shape (s,)."""
        search = self.search
        number = search.numbers.number
        linear = search.chain.frequencies(search.numbers)[search.modes]
        weights = np.array([number(w) for w in self.weights])
        return squares_of_linear_modes(
            linear, number(self.energy), weights, by_amplitude=self.by_amplitude
        )

    def near(self, member: _Member, part: float) -> _Member:
        """The member with this part of the energy, near another member; raises NotFound."""
        search = self.search
        with search.numbers.context(search.digits):
            squares = part * self.linear_squares
            point = member.point

            def equations(
                x: Numbers,
            ) -> tuple[Numbers, float, tuple[Point, Torus[FromSeries]]]:
                nonlocal point
                if not all(x > 0):
                    raise NotFound(x, float("nan"), "an amplitude goes to zero")
                point = search.near(point, x * squares)
                torus = self._torus(point)
                left = self._left(torus, part)
                size = float(np.max(np.abs(left)))
                return left, size, (point, torus)

            tolerances = self._tolerances()
            found = solve(equations, member.unknowns, member.inverse, *tolerances)
            _refuse_strange(found, member)
            point, torus = found.value
            return _Member(found.x, found.inverse, point, torus)

    def _torus(self, point: Point) -> Torus[FromSeries]:
        roots = self.search.numbers.sqrt(point.squares)
        amplitudes = dict(zip(self.search.seeds, roots.tolist(), strict=True))
        return self.search.torus(point, amplitudes)

    def _left(self, torus: Torus[FromSeries], part: float) -> Numbers:
        number = self.search.numbers.number
        ratio = self.measured(torus) / (part * number(self.energy))
        if self.by_amplitude:
            return np.array([ratio - 1])
        spectrum = torus.average_spectrum()[self.search.modes]
        weights = np.array([number(w) for w in self.weights])
        return np.asarray(spectrum / spectrum.sum() / weights * ratio - 1)

    def _tolerances(self) -> tuple[float, float]:
        digits = self.search.digits
        if digits is None:
            return LEAST_ERROR, LARGEST_ERROR
        last_place = 10.0 ** -(digits + SPARE_DIGITS)
        return last_place, last_place

    def from_torus(self, torus: Torus[FromSeries]) -> _Member:
        """The member with the whole energy near a torus, in doubles; raises NotFound."""
        point = self.search.point_of(torus)
        unknowns = point.squares / self.linear_squares
        if self.by_amplitude:
            unknowns = unknowns[:1]
        start = _Member(unknowns, np.eye(len(unknowns)), point, torus)
        return self.near(start, 1.0)

    def solved(self, near: Torus[FromSeries] | None = None) -> _Member:
        """The member with the whole energy, in doubles: near a torus, else from rest.

        Raises NoTorusAtEnergy.
        """
        if near is not None:
            try:
                return self.from_torus(near)
            except NotFound:
                pass  # too far: the way from rest decides
        unknowns = 1 if self.by_amplitude else len(self.search.seeds)
        rest = _Member(np.ones(unknowns), np.eye(unknowns), self.search.rest, None)
        end, failure = walk(rest, self.near)
        if failure is not None:
            raise NoTorusAtEnergy(self, end, failure)
        return end

    def polished(self, member: _Member, digits: int) -> _Member:
        """The same member with so many digits."""
        with MULTIPRECISION.context(digits):
            array = MULTIPRECISION.array
            squares = array(member.point.squares)
            search, point = self.search.polished(member.point, squares, digits)
            target = replace(self, search=search)
            start = _Member(array(member.unknowns), array(member.inverse), point, None)
            try:
                return target.near(start, 1.0)
            except NotFound as failure:
                raise NoTorusAtEnergy(self, member, failure) from failure


def _refuse_strange(found: Found[tuple[Point, Torus[FromSeries]]], member: _Member) -> None:
    """NotFound for a torus far from the last one, or one that is hardly an orbit."""
    distance = float(np.max(np.abs(found.x - member.unknowns)))
    size = float(np.max(np.abs(member.unknowns)))
    if distance > LARGEST_DEVIATION * size:
        raise NotFound(
            found.x, found.residual, "the torus found is far from the one before"
        )
    _, torus = found.value
    points = max(3, round(POINTS ** (1 / len(torus.seeds))))
    left = torus.in_doubles().residual(points)
    if not left <= LARGEST_RESIDUAL:
        share = f"{left:.0%} of the largest acceleration"
        raise NotFound(found.x, left, f"the equations of motion are met only to {share}")


def series_at_energy(
    chain: Chain,
    seeds: Sequence[int],
    energy: Energy,
    orders: Orders,
    *,
    digits: int | None = None,
    near: Torus[FromSeries] | None = None,
) -> Torus[FromSeries]:
    """The torus of the series with a given energy and ratio; its frequencies are found.

    chain, seeds : the model, with fixed ends, and its distinct modes D_0.
    energy : at t = 0; without a ratio the seeds have equal averages of E_q.
    digits : of all results; None for doubles.
    near : a torus of the same chain and seeds, of an energy and ratio near to these, from which
        the way begins; default rest. It saves time and decides nothing else.

    Solves Eq. omeser with the energy as a further equation; the paper's Appendix A steers the
    linear energy instead. The energy is met to some 1e-13 of itself, or to `digits`. Of several
    tori it is the one that continues the linear modes as the energy grows.
    Raises InputError for arguments out of range, NoTorusAtEnergy with the energies reached and
    why they end there: no frequencies, or a series that solves the equations of motion no better
    than to a quarter of the largest acceleration.
    """
    require_chain(chain)
    require_shifts(orders, chain)
    places = None if digits is None else digits_of(digits)
    modes = tuple(sorted(seed_modes(seeds, chain.N)))
    require_size(chain, modes, orders.order, places)
    weights = seed_weights(chain, modes, energy)
    search = Frequencies(chain, modes, orders)
    target = _Target(search, energy, weights)
    refuse_tiny(search, target.linear_squares, "energy", energy.value)
    member = target.solved(near)
    if places is not None:
        member = target.polished(member, places)
    assert member.torus is not None
    return doubted(member.torus)


def squares_of_linear_modes(
    linear: Numbers, energy: Any, weights: Numbers, *, by_amplitude: bool
) -> Numbers:
    """A^2 of modes of the linear chain that share an energy; (s,).

    linear : Omega_q. weights : of A^2, or of the energies, of sum 1.
    """
    stiffness = linear**2
    if by_amplitude:
        stiffness = (stiffness * weights).sum()
    return np.asarray(2 * energy * weights / stiffness)


def seed_weights(
    chain: Chain, seeds: tuple[int, ...], energy: Energy
) -> tuple[Fraction, ...]:
    """Weights of A^2, or of the mode energies, of sum 1; equal mode energies without a ratio."""
    by_amplitude = energy.amplitude_ratio is not None
    name = "amplitude_ratio" if by_amplitude else "energy_ratio"
    given = energy.amplitude_ratio if by_amplitude else energy.energy_ratio
    equal = dict.fromkeys(seeds, 1)
    numbers = positive_by_seed(chain, name, equal if given is None else given)
    if set(numbers) != set(seeds):
        allowed = f"a weight for each of the seeds {seeds}"
        raise InputError(name, given, allowed, "name every seed once, and no other mode")
    weights = [numbers[q] for q in seeds]
    if by_amplitude:
        weights = [w**2 for w in weights]
    total = sum(weights)
    return tuple(w / total for w in weights)
