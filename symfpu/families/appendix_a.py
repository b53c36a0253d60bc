"""Families of q-tori of growing energy by Appendix A.

Steps in frequency are taken by a Jacobian of differences.

Every member is a root of Eq. omeser at chosen frequencies. A step asks for equal increments of the
linear mode energies Omega_q^2 A_q^2 / 2 of all seeds. Where we differ from the printed algorithm:
- the trial frequencies (Eqs. omamid, omafin, omebguess) have the correct bracket: it is the lowest
  correction of the series, first with
  the divisors of the linear frequencies, then with those of the middle ones;
- the neighbouring trial amplitudes are already one step of equal increments away;
- after a step the new torus is the original one of the next, and the former one its neighbour, from
  which Delta omega is taken
  (Eq. delome); the text leaves this open;
- Delta omega, a step in every single frequency as long as that of all together, may leave the
  frequencies that have amplitudes: it is
  halved until all s neighbours have.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import (
    DidNotConverge,
    InputError,
    NoRealAmplitude,
    SymfpuError,
    UndeterminedAmplitudes,
)
from symfpu.families.members import Level
from symfpu.numbers.arithmetic import text
from symfpu.numbers.counted import counted
from symfpu.numbers.typed import Number, double, integer, seed_modes
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import root_squares, shifts, solve_amplitudes
from symfpu.tori.broyden import NotFound
from symfpu.tori.frequencies import Frequencies, positive_by_seed, require_size
from symfpu.tori.from_series import FromSeries
from symfpu.tori.orders import Orders, require_shifts
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]

INCREMENT = 0.1  # of the linear specific energy of the trial amplitudes, in one step
LOWERING = 0.5  # factor of trial amplitudes without a solution
ATTEMPTS = 20
HALVINGS = 12  # of Delta omega
# relative change of the increment from the one asked for, beyond which the root is another one
INCREMENT_CHANGE = 0.5
PLACE = 1e-15  # of an energy between two tori, in their distance or in ln A
OVERSHOOT = 1.2  # what a step that is to pass an energy is longer than the estimate
# InputError: resonant or negative frequencies
NO_ROOT = (NoRealAmplitude, DidNotConverge, InputError, UndeterminedAmplitudes)


class NoFurtherMember(SymfpuError):
    """A family ended: carries why, the frequencies that were tried, and the error behind it."""

    def __init__(
        self, what: str, seeds: Sequence[int], tried: Sequence[float], reason: str
    ) -> None:
        self.seeds, self.frequencies, self.reason = tuple(seeds), tuple(tried), reason
        omega = ", ".join(f"omega_{q} = {w:.9g}" for q, w in zip(seeds, tried, strict=True))
        super().__init__(
            f"{what} at {omega}: {reason}; take a smaller increment or another frequency order"
        )


@dataclass(frozen=True, eq=False)
class AppendixAMember:
    """One torus of a family.

    increment : Delta epsilon_l of the family, the growth of the linear specific energy asked for.
    """

    torus: Torus[FromSeries]
    increment: float

    def __repr__(self) -> str:
        omega = ", ".join(
            f"omega_{q}={text(float(w), 12)}"
            for q, w in zip(self.torus.seeds, self.frequencies, strict=True)
        )
        size = f"epsilon_l={self.linear_specific_energy:.8g}"
        return f"AppendixAMember({omega}, {size}, {self.torus!r})"

    @property
    def frequencies(self) -> tuple[Fraction, ...]:
        """omega of every seed, exact."""
        return self.torus.frequencies

    @property
    def amplitudes(self) -> Mapping[int, float]:
        """A of every seed."""
        return self.torus.amplitudes

    @property
    def energy(self) -> float:
        """Total energy H at t = 0."""
        return float(self.torus.energy())

    @property
    def harmonic_energy(self) -> float:
        """Harmonic energy sum E_q at t = 0."""
        return float(self.torus.harmonic_energies().sum())

    @property
    def linear_specific_energy(self) -> float:
        """epsilon_l = (1/N) sum over the seeds of Omega^2 A^2 / 2 (Eq. linespe), as solved."""
        return linear_specific_energy(self.torus.chain, self.torus.amplitudes)


@dataclass(frozen=True, eq=False)
class AppendixAFamily:
    """A family of tori, energies growing.

    ending : why it ends here. failure : the error that ended it, None if it has what was asked.
    """

    members: tuple[AppendixAMember, ...] = field(repr=False)
    ending: str
    failure: SymfpuError | None = None

    def __repr__(self) -> str:
        energies = (
            f", H={self.members[0].energy:.6g} .. {self.members[-1].energy:.6g}"
            if self.members
            else ""
        )
        return f"AppendixAFamily({counted(len(self.members), 'member')}{energies}; {self.ending})"


def linear_specific_energy(chain: Chain, amplitudes: Mapping[int, float]) -> float:
    """epsilon_l = (1/N) sum over the seeds of Omega^2 A^2 / 2 (Eq. linespe)."""
    linear = chain.frequencies()
    return sum(float(linear[q - 1] * a) ** 2 for q, a in amplitudes.items()) / (2 * chain.N)


def appendix_a(
    chain: Chain,
    seeds: Sequence[int],
    start_amplitudes: Mapping[int, Number],
    order: int,
    *,
    members: int,
    increment: Number | None = None,
    frequency_order: int | None = None,
    coordinate_order: int | None = None,
    after: tuple[AppendixAMember, AppendixAMember] | None = None,
) -> AppendixAFamily:
    """So many further tori of growing energy by Appendix A, or fewer with the reason in `ending`.

    The arguments are those of `appendix_a_members`; members : how many tori, from 1 up. Raises
    InputError only.

    >>> family = appendix_a(Chain(N=8, beta=1), (1, 2), {1: "0.1", 2: "0.05"}, 3, members=4)
    >>> family.ending, [round(m.linear_specific_energy, 8) for m in family.members]
    ('4 members, as asked', [0.0001867, 0.00020537, 0.00022403, 0.0002427])
    """
    wanted, found = integer(members, "members", 1), []
    steps = appendix_a_members(
        chain,
        seeds,
        start_amplitudes,
        order,
        increment=increment,
        frequency_order=frequency_order,
        coordinate_order=coordinate_order,
        after=after,
    )
    try:
        for member in steps:
            found.append(member)
            if len(found) == wanted:
                return AppendixAFamily(tuple(found), f"{wanted} members, as asked")
    except NoFurtherMember as failure:
        return AppendixAFamily(tuple(found), str(failure), failure)
    raise AssertionError("the generator has no end of its own")


def appendix_a_members(
    chain: Chain,
    seeds: Sequence[int],
    start_amplitudes: Mapping[int, Number],
    order: int,
    *,
    increment: Number | None = None,
    frequency_order: int | None = None,
    coordinate_order: int | None = None,
    after: tuple[AppendixAMember, AppendixAMember] | None = None,
) -> Iterator[AppendixAMember]:
    """The tori of Appendix A one by one, without end: stop taking them, or catch NoFurtherMember.

    start_amplitudes : trial amplitudes of the seeds, positive; halved until they have a solution.
    order : of the series, at which Q_q(t) is cut unless coordinate_order says less; frequency_order
    : K of the frequency series, up to order. increment : Delta epsilon_l, growth of the linear
    specific energy (Eq. linespe) in one step; default a tenth of that of the (halved) trial
    amplitudes. after : the last two members of a family, which is then continued with their
    increment; the trial amplitudes are not used. Raises InputError at the call.

    The linear specific energy of the seeds grows by Delta epsilon_l at each step, to first order,
    and H by about N Delta epsilon_l.
    """
    cuts: dict[str, Any] = {
        "frequency_order": frequency_order,
        "coordinate_order": coordinate_order,
    }
    orders = Orders(order, **cuts)
    require_chain(chain)
    require_shifts(orders, chain)
    modes = tuple(sorted(seed_modes(seeds, chain.N)))
    require_size(chain, modes, orders.order, None)
    start = positive_by_seed(chain, "start_amplitudes", start_amplitudes)
    if tuple(start) != modes:
        raise InputError(
            "start_amplitudes",
            start_amplitudes,
            f"an amplitude for each of the seeds {modes}",
            "name every seed once",
        )
    step = None if increment is None else double(increment, "increment")
    if step is not None and not 0 < step < np.inf:
        raise InputError(
            "increment",
            increment,
            "a positive number",
            "take a part of the linear specific energy",
        )
    family = _Family(chain, modes, orders)
    if after is not None:
        return family.continued(*_last_two(family, after))
    return family.members(np.array([float(a) for a in start.values()]), step)


def members_between(
    chain: Chain,
    seeds: tuple[int, ...],
    start_amplitudes: Mapping[int, float],
    order: int,
    *,
    increment: float,
    begin: Level,
    goal: Level,
    after: tuple[AppendixAMember, AppendixAMember] | None = None,
) -> Iterator[AppendixAMember]:
    """The tori of Appendix A from one energy to another.

    The first and the last have these energies to rounding.

    start_amplitudes : of which a multiple has the first energy. The others as for
    `appendix_a_members`. Raises NoFurtherMember.
    """
    family = _Family(chain, seeds, Orders(order))
    if after is None:
        trial = family.trial_at(np.array([start_amplitudes[q] for q in seeds]), begin)
        steps = family.begun(trial, increment)
    else:
        steps = family.continued(*after)
    last = after[1] if after else None
    for found in steps:
        energy = goal.of(found.torus)
        if last is not None and goal.passed(energy) and not goal.met(energy):
            found = member_at(goal, last, found)
        yield found
        if goal.passed(energy):
            return
        last = found


def member_at(
    level: Level, before: AppendixAMember, last: AppendixAMember
) -> AppendixAMember:
    """The torus of an energy between two members, its frequencies on the line between theirs.

    Raises NoFurtherMember.
    """
    series = before.torus.origin.series
    origin = before.torus.origin
    orders = Orders(series.order, origin.frequency_order, origin.order)
    return _Family(series.chain, series.seeds, orders).between(before, last, level)


def _last_two(family: _Family, after: object) -> tuple[AppendixAMember, AppendixAMember]:
    allowed = (
        f"two successive members of a family of {family.chain!r}, seeds {family.seeds}"
    )
    match after:
        case (AppendixAMember() as before, AppendixAMember() as last):
            same = all(
                (m.torus.chain, m.torus.seeds) == (family.chain, family.seeds)
                for m in (before, last)
            )
            if same and before.frequencies != last.frequencies:
                return before, last
    raise InputError("after", after, allowed, "pass family.members[-2:]")


def _first(failure: object) -> str:
    """What a message says before its advice."""
    return str(failure).split(";")[0]


def _bracket(excess: Callable[[float], float]) -> tuple[float, float]:
    """Two numbers between which a function that grows about as 2x passes zero.

    Raises the error of the last one that has no value.
    """
    below, above, without = -math.inf, math.inf, math.inf
    x, failure = 0.0, None
    for _ in range(ATTEMPTS):
        try:
            value = excess(x)
        except NO_ROOT as error:
            failure, without = error, x
            x = x + math.log(LOWERING) if below == -math.inf else (below + without) / 2
            continue
        if value < 0:
            below = x
        else:
            above = x
        if above - below < math.inf:
            return below, above
        step = OVERSHOOT * value / 2 or PLACE
        x = min(x - step, (x + without) / 2)
    raise failure or DidNotConverge(0, {}, math.nan)


class _Family:
    """The steps of the algorithm for one chain, its seeds and orders; shifts are omega - Omega."""

    def __init__(self, chain: Chain, seeds: tuple[int, ...], orders: Orders) -> None:
        self.chain, self.seeds, self.orders = chain, seeds, orders
        self.linear = chain.frequencies()[np.array(seeds) - 1]
        self.search = Frequencies(chain, seeds, orders)

    def members(self, trial: Floats, increment: float | None) -> Iterator[AppendixAMember]:
        """Initialization, (i) to (iv), then the iteration."""
        failure: SymfpuError | None = None
        for _ in range(ATTEMPTS):
            step = increment or INCREMENT * linear_specific_energy(
                self.chain, self._by_seed(trial)
            )
            try:
                first = AppendixAMember(
                    self._torus(self.trial_shifts(trial), trial**2), step
                )
                raised = np.sqrt(trial**2 + self._growth(step))
                second = AppendixAMember(
                    self._torus(self.trial_shifts(raised), raised**2), step
                )
                break
            except NO_ROOT as error:
                failure, trial = error, LOWERING * trial
        else:
            raise NoFurtherMember(
                "no torus for the trial amplitudes",
                self.seeds,
                self.linear + self.trial_shifts(trial),
                _first(failure),
            )
        yield first
        yield second
        yield from self.continued(first, second)

    def begun(self, trial: Floats, increment: float) -> Iterator[AppendixAMember]:
        """The same from trial amplitudes that are not halved; the first of them has a torus."""
        first = AppendixAMember(self._torus(self.trial_shifts(trial), trial**2), increment)
        yield first
        raised = np.sqrt(trial**2 + self._growth(increment))
        try:
            second = AppendixAMember(
                self._torus(self.trial_shifts(raised), raised**2), increment
            )
        except NO_ROOT as error:
            tried = (self.linear + self.trial_shifts(raised)).tolist()
            raise NoFurtherMember(
                "no further torus", self.seeds, tried, _first(error)
            ) from error
        yield second
        yield from self.continued(first, second)

    def trial_at(self, trial: Floats, level: Level) -> Floats:
        """The multiple of trial amplitudes (s,) whose torus has an energy.

        Raises NoFurtherMember.
        """

        def torus(x: float) -> Torus[FromSeries]:
            amplitudes = math.exp(x) * trial
            return self._torus(self.trial_shifts(amplitudes), amplitudes**2)

        x, _ = self._solved(torus, level, None, self.linear + self.trial_shifts(trial))
        return math.exp(x) * trial

    def between(
        self, before: AppendixAMember, last: AppendixAMember, level: Level
    ) -> AppendixAMember:
        """The torus of an energy on the line between the frequencies of two.

        Raises NoFurtherMember.
        """
        start, end = (shifts(m.torus.origin.series) for m in (before, last))
        near, far = (
            np.array([float(a) ** 2 for a in m.amplitudes.values()]) for m in (before, last)
        )

        def torus(part: float) -> Torus[FromSeries]:
            return self._torus(start + part * (end - start), near + part * (far - near))

        _, found = self._solved(torus, level, (0.0, 1.0), self.linear + end)
        return AppendixAMember(found, last.increment)

    def _solved(
        self,
        torus: Callable[[float], Torus[FromSeries]],
        level: Level,
        bracket: tuple[float, float] | None,
        tried: Floats,
    ) -> tuple[float, Torus[FromSeries]]:
        """Where a line of tori has an energy, and the torus there.

        bracket : on the line; None looks for one, ln A along the line. tried : frequencies to be
        named in NoFurtherMember.
        """
        from scipy.optimize import brentq

        def excess(x: float) -> float:
            return math.log(level.of(torus(x)) / level.energy)

        reason = "the energy of its tori jumps"
        try:
            x = float(brentq(excess, *(bracket or _bracket(excess)), xtol=PLACE))
            found = torus(x)
            if level.met(level.of(found)):
                return x, found
        except NO_ROOT as error:
            reason = _first(error)
        raise NoFurtherMember(
            f"no torus of {level.name} = {level.energy:.6g}",
            self.seeds,
            tried.tolist(),
            reason,
        )

    def continued(
        self, before: AppendixAMember, last: AppendixAMember
    ) -> Iterator[AppendixAMember]:
        """The iteration, without end."""
        while True:
            before, last = last, AppendixAMember(self._next(before, last), last.increment)
            yield last

    def _next(self, before: AppendixAMember, last: AppendixAMember) -> Torus[FromSeries]:
        """One step (Eqs. delome to omeprime)."""
        shift, earlier = (
            shifts(last.torus.origin.series),
            shifts(before.torus.origin.series),
        )
        squares = np.array([float(a) ** 2 for a in last.amplitudes.values()])
        growth = self._growth(last.increment)
        aimed = shift
        try:
            aimed = shift + np.linalg.solve(
                self._jacobian(shift, squares, float(np.linalg.norm(shift - earlier))),
                growth,
            )
            torus = self._torus(aimed, squares + growth)
        except (*NO_ROOT, np.linalg.LinAlgError) as failure:
            raise NoFurtherMember(
                "no further torus", self.seeds, self.linear + aimed, _first(failure)
            ) from failure
        gained = (
            linear_specific_energy(self.chain, torus.amplitudes)
            - last.linear_specific_energy
        )
        if not abs(gained - last.increment) <= INCREMENT_CHANGE * last.increment:
            reason = (
                f"the linear specific energy grew by {gained:.3g}, not {last.increment:.3g}: "
                f"too long a step, or another root"
            )
            raise NoFurtherMember(
                "no further torus", self.seeds, self.linear + aimed, reason
            )
        return torus

    def _jacobian(self, shift: Floats, squares: Floats, difference: float) -> Floats:
        """J_A = dA_i^2 / d omega_j by differences (Eq. jacome); shape (s, s).

        Eq. omeprime needs its inverse, d omega_i / dA_j^2.
        """
        for halving in range(HALVINGS + 1):
            columns = []
            try:
                for j in range(len(self.seeds)):
                    moved = shift + np.where(np.arange(len(shift)) == j, difference, 0.0)
                    columns.append((self._root(moved, squares) - squares) / difference)
                return np.stack(columns, axis=1)
            except NO_ROOT:
                if halving == HALVINGS:
                    raise
                difference /= 2
        raise AssertionError

    def _root(self, shift: Floats, guess: Floats) -> Floats:
        """A^2 at shifts of the frequencies."""
        series = lindstedt(
            self.chain, self.seeds, self._exact(shift), self.orders.frequency_order
        )
        return np.asarray(root_squares(series, self.orders.frequency_order, guess)[0])

    def _torus(self, shift: Floats, guess: Floats) -> Torus[FromSeries]:
        series = lindstedt(self.chain, self.seeds, self._exact(shift), self.orders.order)
        K, coordinates = self.orders.frequency_order, self.orders.coordinate_order
        return solve_amplitudes(
            series,
            frequency_order=K,
            order=coordinates,
            guess=self._by_seed(np.sqrt(guess)),
        )

    def trial_shifts(self, amplitudes: Floats) -> Floats:
        """Lowest corrections (Eqs. omamid, omafin).

        First with the linear frequencies in the divisors and then with those found.

        With beta alone no divisor enters, and both are Eq. omebguess. Shape (s,).
        """
        middle = np.array(
            list(frequency_shift(self.chain, self._by_seed(amplitudes)).values())
        )
        first = 2 // self.chain.degree_step
        terms, _ = lindstedt(
            self.chain, self.seeds, self._exact(middle), first
        ).frequency_terms(amplitudes**2)
        return np.asarray(terms[first])

    def _growth(self, increment: float) -> Floats:
        """Increments of A^2 (Eq. omeprime); shape (s,).

        Those of Omega^2 A^2 / 2 are equal, and N Delta epsilon_l in all.
        """
        return np.asarray(2 * self.chain.N * increment / (len(self.seeds) * self.linear**2))

    def _exact(self, shift: Floats) -> tuple[Fraction, ...]:
        try:
            return self.search.exact(shift / self.linear)
        except NotFound as failure:
            raise DidNotConverge(self.orders.frequency_order, {}, float("nan")) from failure

    def _by_seed(self, values: Floats) -> dict[int, float]:
        return dict(zip(self.seeds, map(float, values), strict=True))
