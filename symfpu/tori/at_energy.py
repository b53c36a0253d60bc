"""A torus of a given energy: the amplitudes, in a given ratio or with given ratios of mode energies, that have it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers
from symfpu.numbers.typed import Number, exact, seed_modes
from symfpu.tori.broyden import NotFound, solve, walk
from symfpu.tori.frequencies import EXTREME, Frequencies, Plan, Point, assembled, checked_plan, doubted, positive_by_seed, refuse_tiny
from symfpu.tori.torus import QTorus

LEAST, ENOUGH = 2e-15, 2e-13  # relative error of the energy: what is not worth another torus, what a solution may leave
SPARE = 1  # digits beyond the asked ones to which the energy is met
REACH = 0.3  # change of the amplitudes squared from their guess, relative, that stays on the family
NO_ORBIT = 0.25  # residual, relative to the largest acceleration, from which the energy of a truncated series means nothing
POINTS = 128  # angles at which that residual is taken, about


class NoTorusAtEnergy(SymfpuError):
    """No torus of this energy: raised by `torus_at_energy` where the way from the linear modes ends below it.

    energy : asked for; harmonic : whether it is sum E_q. reached : the largest energy on the way;
        amplitudes : by seed, there, {} if there was none. reason : why it was not followed on. Energies and
        amplitudes are dimensionless. Ours.
    """

    def __init__(self, target: _Target, last: _Member, failure: NotFound) -> None:
        self.energy, self.harmonic, self.reason = float(target.energy), target.harmonic, failure.reason
        self.reached = 0.0 if last.torus is None else float(target.measured(last.torus))
        self.amplitudes = {} if last.torus is None else {q: float(a) for q, a in last.torus.amplitudes.items()}
        name = "harmonic energy" if self.harmonic else "energy H"
        there = ", ".join(f"A_{q} = {a:.6g}" for q, a in self.amplitudes.items())
        super().__init__(
            f"no torus of {name} {self.energy:.6g}: its family was followed from 0 to {self.reached:.6g}{there and f' ({there})'} at order "
            f"{target.plan.order}, then: {self.reason}; take a smaller energy or another order"
        )


@dataclass(frozen=True, eq=False)
class _Member:
    """A torus on the way. unknowns : A^2 in units of those of the linear chain with the same energy; inverse : Broyden's matrix."""

    unknowns: Numbers
    inverse: Numbers
    point: Point
    torus: QTorus | None


@dataclass(frozen=True, eq=False)
class _Target:
    """What is asked, and the equations for it: (E - energy) / energy, or with mode energies, e_q E / (w_q sum e energy) - 1.

    e_q : time average of E_q of a seed, w_q its weight, sum w = 1. The latter vanish together if and only if E is the energy and
    the e are as the w. Both kinds have a matrix near 1 at small energies.
    """

    plan: Plan
    search: Frequencies
    energy: Fraction
    harmonic: bool
    weights: tuple[Fraction, ...]  # of A^2 of the seeds, or of their mode energies
    by_amplitude: bool

    def measured(self, torus: QTorus) -> Any:
        """H, or the sum of E_q, at t = 0."""
        return torus.harmonic_energies().sum() if self.harmonic else torus.energy()

    @property
    def linear_squares(self) -> Numbers:
        """A^2 of the seeds on the linear chain with the whole energy; shape (s,)."""
        numbers = self.search.numbers
        linear = self.search.chain.frequencies(numbers)[np.array(self.search.seeds) - 1]
        weights, energy = np.array([numbers.number(w) for w in self.weights]), numbers.number(self.energy)
        return np.asarray(2 * energy * weights / ((linear**2 * weights).sum() if self.by_amplitude else linear**2))

    def near(self, member: _Member, part: float) -> _Member:
        """The member with this part of the energy, near another member; raises NotFound."""
        with self.search.numbers.context(self.search.digits):
            squares, point = part * self.linear_squares, member.point

            def equations(x: Numbers) -> tuple[Numbers, float, tuple[Point, QTorus]]:
                nonlocal point
                if not all(x > 0):
                    raise NotFound(x, float("nan"), "an amplitude goes to zero")
                point = self.search.near(point, x * squares)
                amplitudes = self.search.numbers.sqrt(point.squares).tolist()
                torus = assembled(self.search, point, self.plan, dict(zip(self.search.seeds, amplitudes, strict=True)))
                left = self._left(torus, part)
                return left, float(np.max(np.abs(left))), (point, torus)

            found = solve(equations, member.unknowns, member.inverse, *self._tolerances())
            point, torus = found.value
            if float(np.max(np.abs(found.x - member.unknowns))) > REACH * float(np.max(np.abs(member.unknowns))):
                raise NotFound(found.x, found.residual, "the torus found is far from the one before")
            left = torus.in_doubles().residual(max(3, round(POINTS ** (1 / len(torus.seeds)))))
            if not left <= NO_ORBIT:
                raise NotFound(found.x, left, f"the equations of motion are met only to {left:.0%} of the largest acceleration")
            return _Member(found.x, found.inverse, point, torus)

    def _left(self, torus: QTorus, part: float) -> Numbers:
        ratio = self.measured(torus) / (part * self.search.numbers.number(self.energy))
        if self.by_amplitude:
            return np.array([ratio - 1])
        spectrum = torus.average_spectrum()[np.array(torus.seeds) - 1]
        weights = np.array([self.search.numbers.number(w) for w in self.weights])
        return np.asarray(spectrum / spectrum.sum() / weights * ratio - 1)

    def _tolerances(self) -> tuple[float, float]:
        return (LEAST, ENOUGH) if self.search.digits is None else (10.0 ** -(self.search.digits + SPARE),) * 2

    def solved(self) -> _Member:
        """The member with the whole energy, by continuation from rest, in doubles; raises NoTorusAtEnergy."""
        size = 1 if self.by_amplitude else len(self.search.seeds)
        end, failure = walk(_Member(np.ones(size), np.eye(size), self.search.rest, None), self.near)
        if failure is not None:
            raise NoTorusAtEnergy(self, end, failure)
        return end

    def polished(self, member: _Member) -> _Member:
        """The same member with the digits asked for."""
        assert self.plan.digits is not None
        with MULTIPRECISION.context(self.plan.digits):
            array = MULTIPRECISION.array
            search, point = self.search.polished(member.point, array(member.point.squares), self.plan.digits)
            target = replace(self, search=search)
            try:
                return target.near(_Member(array(member.unknowns), array(member.inverse), point, None), 1.0)
            except NotFound as failure:
                raise NoTorusAtEnergy(self, member, failure) from failure


def torus_at_energy(
    chain: Chain,
    seeds: Sequence[int],
    energy: Number,
    *,
    harmonic: bool,
    order: int,
    amplitude_ratio: Mapping[int, Number] | None = None,
    energy_ratio: Mapping[int, Number] | None = None,
    frequency_order: int | None = None,
    coordinate_order: int | None = None,
    phases: Mapping[int, Number] | None = None,
    digits: int | None = None,
) -> QTorus:
    """The q-torus of a given energy and ratio of seed amplitudes or mode energies; frequencies are found.

    chain, seeds : the model and its distinct modes D_0; all quantities are dimensionless, phases in radians.
    energy : a positive exact number.
    harmonic : False, it is the total energy H at t = 0; True, the harmonic energy sum E_q at t = 0, over all
        modes.
    order : of the series.
    amplitude_ratio : weights of the amplitudes A_q, by seed.
    energy_ratio : weights of the infinite-time averages of E_q of the seeds (other modes take what the torus
        gives them). At most one of the two; default equal mode energies. Only their ratios count.
    frequency_order, coordinate_order : where frequencies and Q_q(t) are cut, up to order; default order.
    phases : by seed, radians; default 0.
    digits : of all results; None for doubles.

    Solves Eq. omeser with the energy as a further equation; the paper's Appendix A steers the linear energy
    instead. The energy is met to some 1e-13 of itself, or to `digits`. Of several tori it is the one that
    continues the linear modes as the energy grows.
    Raises InputError for arguments out of range, NoTorusAtEnergy with the energies reached and why they end
    there: no frequencies, or a series that solves the equations of motion no better than to a quarter of the
    largest acceleration.

    >>> torus = torus_at_energy(Chain(N=8, alpha="0.33"), (1, 2), "0.01", harmonic=False, order=3)
    >>> round(float(torus.energy()), 12), [round(a, 9) for a in torus.amplitudes.values()]
    (0.01, [0.254094674, 0.129588043])
    """
    plan = checked_plan(chain, order, frequency_order, coordinate_order, phases, digits)
    modes = tuple(sorted(seed_modes(seeds, chain.N)))
    plan.check_size(chain, modes)
    if not isinstance(harmonic, bool):
        raise InputError("harmonic", harmonic, "False for the total energy H, True for the sum of the E_q", "say which energy is meant")
    total = exact(energy, "energy")
    if not 1 / EXTREME <= total <= EXTREME:
        raise InputError("energy", energy, "a positive number, 1e-60 to 1e60", "take a small one")
    weights = _weights(chain, modes, amplitude_ratio, energy_ratio)
    target = _Target(plan, Frequencies(chain, modes, plan.frequency_order), total, harmonic, weights, amplitude_ratio is not None)
    refuse_tiny(target.search, target.linear_squares, "energy", energy)
    member = target.solved()
    if digits is not None:
        member = target.polished(member)
    assert member.torus is not None
    return doubted(member.torus)


def _weights(
    chain: Chain, seeds: tuple[int, ...], amplitude_ratio: Mapping[int, Number] | None, energy_ratio: Mapping[int, Number] | None
) -> tuple[Fraction, ...]:
    """Weights of A^2 or of the mode energies, of sum 1."""
    if amplitude_ratio is not None and energy_ratio is not None:
        raise InputError("energy_ratio", dict(energy_ratio), "at most one of amplitude_ratio and energy_ratio", "leave one of them out")
    name, given = ("energy_ratio", energy_ratio) if amplitude_ratio is None else ("amplitude_ratio", amplitude_ratio)
    numbers = positive_by_seed(chain, name, dict.fromkeys(seeds, 1) if given is None else given)
    if tuple(numbers) != seeds:
        raise InputError(name, given, f"a weight for each of the seeds {seeds}", "name every seed once, and no other mode")
    powers = [w if amplitude_ratio is None else w**2 for w in numbers.values()]
    return tuple(w / sum(powers) for w in powers)
