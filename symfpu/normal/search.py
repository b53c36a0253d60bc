"""The door: normal frequencies of a torus, mode by mode, with as many harmonics as they need."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from symfpu.chain.projections.standing import is_sine
from symfpu.errors import SymfpuError
from symfpu.files.progress import Progress, unheard
from symfpu.normal.beside import beside, nearness
from symfpu.normal.collisions import undecided_modes
from symfpu.normal.digits import PreciseModes
from symfpu.normal.linearised import Linearised, Values
from symfpu.normal.modes import NoNormalModes, NormalDivisor, NormalMode, NormalModes
from symfpu.normal.names import Names
from symfpu.normal.reduction import LEAST_OVERLAP, Reduced, continued, followed, reduced
from symfpu.normal.resonances import OWN, ParametricResonance, resonance_length_of
from symfpu.normal.torus import (
    LENGTH,
    Flows,
    checked_modes,
    checked_solution,
    in_digits,
    resonances_near,
    second_order,
)
from symfpu.numbers.public import public
from symfpu.refinement.iterative_refinement import Failure
from symfpu.refinement.lattice import Ints
from symfpu.tori.torus import Torus

TOLERANCE = 1e-10  # residual of a mode whose harmonics are enough
SHOWN_DIVISORS = 5
UNRESOLVED = 1e-7  # difference from a frequency of the torus that a double root may have
SPREAD = 10.0  # times rounding: what is nearer to nu.omega turns as the torus does
NEARLY_TURNING = 1e-2  # of sigma: a direction so near to nu.omega is looked for beside it
TOO_NEAR = 1e-4  # to nu.omega, where doubles do not tell a direction from a shift
STILL = 1e-2  # of sigma: the action of a direction that may turn as the torus does
RESOLVED = 1e-7  # residual of such a direction
HALVINGS = 4  # of the step between two tori, where a mode cannot be followed at once
LOST = "its eigenfunction on the torus before does not tell it from others"
NEARER = "follow it in smaller steps, or together with the modes that it mixes with"

# why a mode is missing, and what to do
TURNING = (
    "in doubles it is not told from a shift of the angles, which turns as the torus does"
)
AWAY = "move an amplitude by 1e-5 of it or more, or leave the mode out by modes="
DISPLACED = "to displace the waves costs less than doubles show"
LARGER = "take larger amplitudes, or leave the mode out by modes="


@public
def normal_modes(
    solution: Torus,
    *,
    modes: Iterable[int] | None = None,
    resonance_length: int = LENGTH,
    progress: Progress | None = None,
) -> NormalModes:
    """Normal frequencies of a torus or breather, their eigenfunctions, signatures and resonances.

    solution : of any potential and of any number of angles, refined: its residual is at most
        1e-9. With fixed ends, or of a ring: travelling waves, or what `unfold` gave.
        Dimensionless. Of one that was refined to many digits (`refine` with digits)
        frequencies and eigenfunctions have as many, by iterative refinement; any other is rounded
        to doubles, as `solution.in_doubles()` is.
    modes : which of the N-1-s modes, of a ring signed; default all that can be told from others.
    resonance_length : largest sum |nu_i| of the resonances listed.
    progress : called as (label, fraction), once a mode.

    The equations of motion (Eq. eqmo) linearised about the torus are solved by exp(i sigma t)
    p(theta), in harmonics of the angles: Newton's method from Omega_q with its closed shift of
    second order (of travelling waves from Omega_q), products on the lattice of `refine`. Of a
    breather, exp(2 pi i sigma/omega) are the Floquet multipliers. About travelling waves the
    solution goes as exp(i sigma t - 2 pi i q j/N); about standing ones q > 0 is a sine and -q, or
    N/2, a cosine, a pair of one frequency at rest. Uniform motion, which nothing couples to, is
    left out. Ours: the paper has none.

    Where a resonance does not let a mode be told from others the result has the rest, and says why
    in `missing`. Raises InputError, and NoNormalModes for such a mode that `modes` names, or if
    there is no other.

    >>> import symfpu
    >>> from symfpu import Chain, refine
    >>> amplitudes = {1: "0.2", 2: "0.1"}
    >>> torus = symfpu.torus(Chain(N=4, alpha="0.3"), (1, 2), amplitudes=amplitudes)
    >>> round(normal_modes(torus).frequencies[3], 9)
    1.847...
    """
    torus = checked_solution(solution)
    chosen = checked_modes(torus, modes)
    length = resonance_length_of(resonance_length, torus.seeds, 1)
    search, tell = _Search(torus, length), progress or unheard
    found, missing = search.each(chosen, tell)
    named = modes is not None
    _require(found, missing, named=named)
    if in_digits(solution):
        found, others = _in_digits(solution, found, length, tell)
        missing |= others
        _require(found, missing, named=named)
    return search.result(solution, found, missing)


Found = tuple[dict[int, NormalMode], dict[int, NoNormalModes]]  # and why others were not


def _require(
    found: Mapping[int, NormalMode], missing: Mapping[int, NoNormalModes], *, named: bool
) -> None:
    """NoNormalModes where modes that were named are missing, or all are."""
    if missing and (named or not found):
        raise next(iter(missing.values()))


def _in_digits(
    torus: Torus,
    found: Mapping[int, NormalMode],
    length: int,
    tell: Progress,
) -> Found:
    """Modes in doubles with the digits of the torus."""
    precise: dict[int, NormalMode] = {}
    missing: dict[int, NoNormalModes] = {}
    search: PreciseModes | None = None
    for number, (q, mode) in enumerate(found.items()):
        tell(f"normal mode {q}, {torus.digits} digits", number / len(found))
        try:
            search = search or PreciseModes(torus)
            precise[q] = search.refined(mode, tell)
        except Failure as failure:
            real = complex(mode.sigma).real
            nearest = resonances_near(torus, {q: real}, length)
            reason = f"no {torus.digits} digits of its frequency: {failure}"
            missing[q] = NoNormalModes(q, real, nearest[0] if nearest else None, reason)
    return precise, missing


def followed_modes(
    solution: Torus,
    before: NormalModes | None,
    *,
    modes: Iterable[int] | None = None,
    between: Between | None = None,
    progress: Progress | None = None,
) -> tuple[NormalModes, dict[int, NoNormalModes]]:
    """Normal modes of a torus, each continued from its eigenfunction on a torus nearby.

    before : of the torus nearby; None, or without a mode, where there is none: then the mode is
        sought as by `normal_modes`. between : the torus at a part of the way from that one, 0 to
        1, for modes that cannot be followed in one step. One that cannot be followed at all is
        sought anew, and taken if its main coefficient tells that it is this mode.

    Returns what was found, and by mode why one was not; in doubles.
    """
    torus = checked_solution(solution)
    chosen = checked_modes(torus, modes)
    known = None if before is None else Before.of(before)
    search = _Search(torus, LENGTH, known, between)
    found, missing = search.each(chosen, progress or unheard)
    return search.result(solution, found, missing), missing


Between = Callable[[float], Torus]


class Before(NamedTuple):
    """Modes of a torus nearby, in doubles, and the closed shifts there."""

    modes: Mapping[int, NormalMode]
    shifts: Mapping[int, float]

    @classmethod
    def of(cls, found: NormalModes) -> Before:
        modes = {mode.mode: mode.in_doubles() for mode in found.modes}
        return cls(modes, second_order(found.torus))


class _Search:
    """The search for the modes of one torus, from closed shifts or from modes known before."""

    def __init__(
        self,
        torus: Torus,
        length: int,
        before: Before | None = None,
        between: Between | None = None,
        halvings: int = HALVINGS,
        flows: Flows | None = None,
    ) -> None:
        self._torus, self._length = torus, length
        self._guesses = second_order(torus)
        self._before = before or Before({}, {})
        self._between, self._halvings = between, halvings
        self._names = Names(torus)
        self._flows = flows or Flows(torus)
        self._firsts: dict[int, NormalMode | None] = {}
        self._anew: set[int] = set()

    def each(self, modes: tuple[int, ...], tell: Progress) -> Found:
        """Those that continue the chosen modes.

        With their rivals, so that one mode alone is the one that it is among all of them.
        """
        sought = set(modes)
        while True:
            found, missing = self._of_all(sorted(sought), tell)
            rivals = {
                r for q in self._anew & set(found) for r in self._names.rivals(found[q])
            }
            if rivals <= sought:
                break
            sought |= rivals
        own = {q: mode for q, mode in found.items() if q in modes}
        return own, {q: none for q, none in missing.items() if q in modes}

    def _of_all(self, modes: Sequence[int], tell: Progress) -> Found:
        found: dict[int, NormalMode] = {}
        missing: dict[int, NoNormalModes] = {}
        for number, q in enumerate(modes):
            tell(f"normal mode {q}", number / len(modes))
            try:
                found[q] = self._required(q, found)
            except NoNormalModes as none:
                missing[q] = none
        return found, missing

    def result(
        self,
        solution: Torus,
        found: dict[int, NormalMode],
        missing: Mapping[int, NoNormalModes],
    ) -> NormalModes:
        """The modes that were found, with the resonances of all of them."""
        real = {q: mode.sigma.real for q, mode in found.items()}
        return NormalModes(
            torus=solution,
            modes=tuple(found.values()),
            guesses={q: self._guesses[q] for q in found},
            resonances=tuple(resonances_near(solution, real, self._length)),
            undecided=undecided_modes(solution, tuple(found.values())),
            missing={q: str(none) for q, none in missing.items()},
        )

    def _required(self, q: int, others: dict[int, NormalMode]) -> NormalMode:
        """The one that continues q; NoNormalModes where there is none."""
        guess = self._guesses[q]
        found = self.mode(q, guess, others)
        turning = found and self._turning(found)
        if found and not turning:
            self._require_told(found)
            return found
        nearest = resonances_near(self._torus, {q: guess}, self._length)
        own = turning or next((one for one in nearest if one.kind == OWN), None)
        beside = own and self._beside(q, own, others)
        if beside:
            return beside
        if turning and self._is_cosine(q):
            raise NoNormalModes(q, guess, turning, DISPLACED, LARGER)
        if turning or (own and self._too_near(q, own)):
            raise NoNormalModes(q, guess, own, TURNING, AWAY)
        raise NoNormalModes(q, guess, nearest[0] if nearest else None)

    def _require_told(self, found: NormalMode) -> None:
        """NoNormalModes for a mode that was lost on the way, if its main coefficient is small."""
        q, sigma = found.mode, complex(found.sigma).real
        lost = q in self._anew and q in self._before.modes
        if not lost or self._names.told(found):
            return
        nearest = resonances_near(self._torus, {q: sigma}, self._length)
        raise NoNormalModes(q, sigma, next(iter(nearest), None), LOST, NEARER)

    def _turning(self, found: NormalMode) -> ParametricResonance | None:
        """The resonance of a direction that turns as the torus does, if this is none but that.

        Shifts of the angles are solutions, too, with all nu.omega. To displace standing waves
        costs nothing but by Umklapp of high order: then the two frequencies of that direction, a
        cosine, are one to more digits than a double root has.
        """
        torus, sigma = self._torus, complex(found.sigma)
        cosine = self._is_cosine(found.mode)
        if not cosine and abs(found.action) > STILL * abs(sigma):
            return None
        unresolved = UNRESOLVED if cosine else max(UNRESOLVED, SPREAD * found.rounding)
        if (
            found.residual > RESOLVED
        ):  # of a double root that a torus in doubles tears apart
            unresolved = max(unresolved, float(np.sqrt(found.residual)))
        nearest = resonances_near(torus, {found.mode: sigma.real}, self._length)
        for one in nearest:
            if one.kind == OWN and abs(complex(one.distance, sigma.imag)) < unresolved:
                return one
        return None

    def _beside(
        self, q: int, own: ParametricResonance, others: dict[int, NormalMode]
    ) -> NormalMode | None:
        """A direction that turns nearly as the torus does, or grows there: sigma = nu.omega +- ."""
        rate = self._rate(own)
        shifts = self._shifts(q)
        found = self._sought(q, partial(beside, q=q, rate=rate, shifts=shifts))
        return found if found and self._apart(found, rate, others) else None

    def _too_near(self, q: int, own: ParametricResonance) -> bool:
        """Whether there is one, but too near for Newton's method in doubles."""
        *_, finest = self._flows
        shifts = self._shifts(q)
        return nearness(finest.of(q), q, self._rate(own), shifts) < TOO_NEAR

    def _rate(self, own: ParametricResonance) -> float:
        """nu.omega."""
        omega = np.array([float(w) for w in self._torus.frequencies])
        return float(np.array(own.harmonic) @ omega)

    def _shifts(self, q: int) -> int:
        """How many solutions in the symmetry of a mode are shifts of the angles."""
        return 0 if self._is_cosine(q) else len(self._torus.seeds)

    def _is_cosine(self, q: int) -> bool:
        """Whether a mode is a cosine about standing waves, which no shift of the angles is."""
        torus = self._torus
        standing = torus.stands
        return standing and not is_sine(torus.chain, q)

    def _apart(self, found: NormalMode, rate: float, others: dict[int, NormalMode]) -> bool:
        """Whether a direction beside a frequency is no shift, and none of the others."""
        if found.residual > RESOLVED or self._turning(found):
            return False
        if not found.growth:
            return not self._names.twin(found, others.values())
        known = [other.growth for other in others.values() if other.growth]
        alone = all(abs(found.growth / growth - 1) > UNRESOLVED for growth in known)
        near = abs(found.sigma.real - rate) < UNRESOLVED
        grows = found.growth > max(found.rounding, UNRESOLVED)
        return near and alone and grows

    def mode(
        self, q: int, guess: float, others: dict[int, NormalMode]
    ) -> NormalMode | None:
        """The one that continues q and is none of the others; None where there is none.

        Another that turns out to be this one is sought anew.
        """
        found = self._first(q, guess)
        twin = found and self._names.twin(found, others.values())
        if not twin:
            return found
        if found and found.growth:
            partner = self._partner(found)
            if partner and not self._names.twin(partner, others.values()):
                return partner
        found = self._sought(q, partial(continued, q=q))
        twin = found and self._names.twin(found, others.values())
        if not found or not twin:
            return found
        other = twin.mode
        again = self._sought(other, partial(continued, q=other))
        if again is None or self._names.twin(again, [found, *others.values()]):
            return None
        others[twin.mode] = again
        return found

    def _partner(self, found: NormalMode) -> NormalMode | None:
        """The other one of a quartet, nu.omega - conj(sigma), by the mode's largest coefficient."""
        q = found.mode
        column = self._torus.chain.mode_numbers.index(q)
        rates = complex(found.sigma).real + found.rates
        sizes = np.where(rates < 0, np.abs(found.coefficients[:, column]), 0)
        row = int(np.argmax(sizes))
        sigma = complex(-rates[row], found.growth)

        def near(flow: Linearised) -> Reduced | None:
            turned = at_harmonics(found, found.harmonics[row] - flow.harmonics)
            return followed(flow, q, sigma, flow.table(turned.conj()))

        return self._sought(q, near)

    def _first(self, q: int, guess: float) -> NormalMode | None:
        """The one that is taken for q if no other mode objects."""
        if q not in self._firsts:
            followed = self._along(q)
            if followed is None:
                self._anew.add(q)
            if followed is None or self._names.is_others(followed):
                anew = self._sought(q, partial(reduced, q=q, guess=guess))
                told = anew and self._names.told(anew)
                followed = anew if told or followed is None else followed
            self._firsts[q] = followed
        return self._firsts[q]

    def _along(self, q: int) -> NormalMode | None:
        """From the torus before, in as many steps as it needs; None where none leads here.

        Through an onset, where two directions become one, in the shortest.
        """
        if q not in self._before.modes:
            return None
        found = self._sought(q, partial(self._nearby, q=q), patient=False)
        turning = found and self._turning(found)
        if turning or found is None or not self._continues(found):
            own = turning or self._turned_before(q)
            found = self._beside(q, own, {}) if own else None
        if found is None or not self._continues(found):
            return self._by_halves(q)
        if bool(found.growth) == bool(self._before.modes[q].growth):
            return found
        return self._by_halves(q) or found

    def _turned_before(self, q: int) -> ParametricResonance | None:
        """The frequency of the torus beside which the mode turned on the torus before."""
        sigma = complex(self._before.modes[q].sigma).real
        for one in resonances_near(self._torus, {q: sigma}, self._length):
            if one.kind == OWN and abs(one.distance) < NEARLY_TURNING * abs(sigma):
                return one
        return None

    def _continues(self, found: NormalMode) -> bool:
        """Whether it is like the eigenfunction on the torus before."""
        like = at_harmonics(self._before.modes[found.mode], found.harmonics)
        return bool(abs(np.vdot(like, found.coefficients)) > LEAST_OVERLAP)

    def _by_halves(self, q: int) -> NormalMode | None:
        """The same by the torus half way."""
        middle = self._middle
        half = None if middle is None else middle._along(q)
        if middle is None or half is None:
            return None
        known, between = Before({q: half}, middle._guesses), self._part(0.5, 1.0)
        halvings = self._halvings - 1
        rest = _Search(self._torus, self._length, known, between, halvings, self._flows)
        return rest._along(q)

    @cached_property
    def _middle(self) -> _Search | None:
        """The search on the torus half way; None where there is none."""
        if self._between is None or not self._halvings:
            return None
        try:
            torus = checked_solution(self._between(0.5))
        except SymfpuError:
            return None
        between, halvings = self._part(0.0, 0.5), self._halvings - 1
        return _Search(torus, self._length, self._before, between, halvings)

    def _part(self, low: float, high: float) -> Between:
        """The tori on a part of the way."""
        whole = self._between
        assert whole is not None
        return lambda part: whole(low + part * (high - low))

    def _nearby(self, flow: Linearised, q: int) -> Reduced | None:
        """From the torus before, its frequency moved as the closed shift is."""
        known = self._before.modes[q]
        moved = self._guesses[q] - self._before.shifts[q]
        like = flow.table(at_harmonics(known, flow.harmonics))
        return followed(flow, q, known.sigma + moved, like)

    def _sought(
        self,
        q: int,
        find: Callable[[Linearised], Reduced | None],
        *,
        patient: bool = True,
    ) -> NormalMode | None:
        """With as many harmonics as the tolerance needs; the best one met if none do.

        patient : whether more harmonics are tried where fewer give none.
        """
        best: NormalMode | None = None
        for every in self._flows:
            flow = every.of(q)
            found = find(flow)
            if not (found or patient):
                break
            if found and (best is None or found.residual < best.residual):
                best = _mode_of(flow, found)
            if best and best.residual < TOLERANCE:
                break
        return best


def at_harmonics(mode: NormalMode, harmonics: Ints) -> Values:
    """The eigenfunction at other harmonics, 0 where it has none, of norm 1; shape (F, N-1)."""
    rows = {tuple(nu): row for row, nu in enumerate(mode.harmonics.tolist())}
    places = np.array([rows.get(tuple(nu), -1) for nu in harmonics.tolist()])
    table = np.where(places[:, None] < 0, 0, mode.coefficients[places])
    return np.asarray(table / np.linalg.norm(table))


def _mode_of(flow: Linearised, found: Reduced) -> NormalMode:
    return NormalMode(
        mode=found.mode,
        sigma=found.sigma,
        harmonics=flow.harmonics,
        rates=flow.rates.astype(float),
        coefficients=flow.by_mode(found.coefficients),
        action=found.action,
        residual=found.residual,
        divisors=_smallest_divisors(flow, found),
        deflated=found.deflated,
        products=found.products,
        rounding=found.rounding,
    )


def _smallest_divisors(flow: Linearised, found: Reduced) -> tuple[NormalDivisor, ...]:
    every = flow.divisors(found.sigma)
    sizes = np.where(flow.allowed(found.mode), np.abs(every), np.inf)
    sizes[0, flow.column(found.mode)] = np.inf
    order = np.argsort(sizes, axis=None)[:SHOWN_DIVISORS]
    places = zip(*np.unravel_index(order, sizes.shape), strict=True)
    nearest = []
    for row, column in places:
        if np.isfinite(sizes[row, column]):
            harmonic = tuple(flow.harmonics[row].tolist())
            divisor = every[row, column].item()
            coefficient = found.coefficients[row, column].item()
            mode = flow.mode_at(int(row), int(column))
            nearest.append(NormalDivisor(mode, harmonic, divisor, coefficient))
    return tuple(nearest)
