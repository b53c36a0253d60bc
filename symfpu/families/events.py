"""What happens on the way of a family: folds, resonances and changes of stability, located.

A fold is found by parabolas through ever nearer tori, a resonance by Newton's method with the zero
divisor as its condition, a change of stability by halving.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.floquet import floquet
from symfpu.families.breather_walk import stability_between
from symfpu.families.continuation import Way
from symfpu.families.members import Event, Level, Member, member
from symfpu.families.normal_events import NormalEvent
from symfpu.families.normal_way import NormalWay
from symfpu.numbers.long_doubles import DIGITS, long
from symfpu.refinement.conditions import resonance
from symfpu.refinement.guesses import extrapolated, shifts_of
from symfpu.refinement.lattice import Floats, Ints
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import NoTorus
from symfpu.tori.torus import Torus

# of the largest coefficient: a divisor of a smaller one may change its sign unnoticed
LEAST_COEFFICIENT = 1e-11
LOCATION_TOLERANCE = 1e-7  # relative change of the place of an event that is enough
LOCATIONS = 8  # the most members spent on it
# crossings of resonances of one step, by their coefficients, that Newton's method locates
MOST_CROSSINGS = 8


def quantities(torus: Torus[Newton]) -> dict[str, float]:
    """What may turn along a family: energy, shifts of the frequencies, amplitudes."""
    by_seed = zip(torus.seeds, shifts_of(torus), strict=True)
    shifts = {f"omega_{q}": float(shift) for q, shift in by_seed}
    amplitudes = {f"A_{q}": a for q, a in torus.amplitudes.items()}
    return {"H": float(torus.energy())} | shifts | amplitudes


class _Sign(NamedTuple):
    """A divisor that changes its sign between two tori.

    part : of their distance, where it does so by interpolation. column : of its coefficient.
    """

    mode: int
    harmonic: tuple[int, ...]
    column: int
    part: float
    coefficient: float


def _signs(first: Torus[Newton], second: Torus[Newton]) -> list[_Sign]:
    """The divisors of significant coefficients that change their sign between two tori.

    They are in the order in which they do so.
    """
    harmonics, earlier_size, later_size = _common(first, second)
    places = _places(first, harmonics)
    numbers = np.array(first.chain.mode_numbers)[places]
    modes = np.broadcast_to(numbers, earlier_size.shape)
    earlier, later = (_divisors(torus, harmonics, places) for torus in (first, second))
    size = np.maximum(np.abs(earlier_size), np.abs(later_size))
    largest = np.abs(second.cosines).max()
    significant = size / largest > LEAST_COEFFICIENT
    own = _own_harmonics(first, harmonics, modes)
    changed = (earlier * later < 0) & significant & ~own
    found = []
    for h, column in zip(*np.nonzero(changed), strict=True):
        before, after = earlier[h, column], later[h, column]
        part = float(before / (before - after))
        harmonic = tuple(harmonics[h].tolist())
        mode = int(modes[h, column])
        coefficient = float(later_size[h, column])
        found.append(_Sign(mode, harmonic, int(column), part, coefficient))
    return sorted(found, key=lambda sign: sign.part)


def _common(first: Torus[Newton], second: Torus[Newton]) -> tuple[Ints, Floats, Floats]:
    """The harmonics that two tori share, (H, s), and coefficients of the one and the other."""
    known, earlier = first.harmonics, first.cosines
    others, later = second.harmonics, second.cosines
    rows = {tuple(nu): i for i, nu in enumerate(known.tolist())}
    of_second = enumerate(map(tuple, others.tolist()))
    pairs = [(rows[nu], j) for j, nu in of_second if nu in rows]
    i, j = map(list, zip(*pairs, strict=True))
    return known[i], earlier[i], later[j]


def _places(torus: Torus[Newton], harmonics: Ints) -> Ints:
    """Of the modes of coefficients among those of the chain, broadcast with (H, C).

    Of travelling waves the one mode of each harmonic.
    """
    numbers = np.array(torus.chain.mode_numbers)
    if not torus.travels:
        return np.arange(len(numbers))[None, :]
    waves = harmonics @ np.array(torus.seeds) % torus.chain.N
    place = np.zeros(torus.chain.N, dtype=np.int64)
    place[numbers % torus.chain.N] = np.arange(len(numbers))
    return np.asarray(place[waves][:, None])


def _divisors(torus: Torus[Newton], harmonics: Ints, places: Ints) -> Floats:
    """|nu.omega| - Omega of the modes; shape (H, C)."""
    omega = np.array([float(w) for w in torus.frequencies])
    rates = np.abs(harmonics @ omega)
    return np.asarray(rates[:, None] - torus.chain.frequencies()[places])


def _own_harmonics(torus: Torus[Newton], harmonics: Ints, modes: Ints) -> NDArray[np.bool_]:
    """Where a seed has its own harmonic; shape (H, C)."""
    single = np.abs(harmonics).sum(axis=1) == 1
    of_seeds = zip(torus.seeds, harmonics.T, strict=True)
    own = [(single & (n == 1))[:, None] & (modes == q) for q, n in of_seeds]
    return np.asarray(np.any(own, axis=0))


def resonances(way: Way, after: int) -> Iterator[Event]:
    """The divisors that change their sign between the last two tori.

    The strongest are located by Newton's method. The others, and those where it finds no torus
    between the two, are interpolated.
    """
    first, second = way.tori[-2:]
    signs = _signs(first, second)
    located = 0 if first.warnings or second.warnings else MOST_CROSSINGS
    strongest = sorted(signs, key=lambda sign: -abs(sign.coefficient))[:located]
    for sign in signs:
        torus = _resonant(way, sign) if sign in strongest else None
        if torus is None:
            rise = float(second.energy() - first.energy())
            energy = float(first.energy()) + sign.part * rise
            coefficient = sign.coefficient
        else:
            energy = float(torus.energy())
            coefficient = _coefficient(torus, sign)
        yield Event(
            kind="resonance",
            what="divisor",
            after=after,
            energy=energy,
            value=coefficient,
            mode=sign.mode,
            harmonic=sign.harmonic,
            interpolated=torus is None,
        )


def _coefficient(torus: Torus[Newton], sign: _Sign) -> float:
    """The one under a divisor."""
    harmonics, table = torus.harmonics, torus.cosines
    row = harmonics.tolist().index(list(sign.harmonic))
    return float(table[row, sign.column])


def _resonant(way: Way, sign: _Sign) -> Torus[Newton] | None:
    """The torus between the last two on which this divisor is zero.

    None where Newton's method does not lead to it.
    """
    first, second = way.tori[-2:]
    chain, harmonic = first.chain, sign.harmonic
    rates = zip(harmonic, first.frequencies, second.frequencies, strict=True)
    twice = sum(n * (a + b) for n, a, b in rates)  # nu.omega in the middle
    with mpmath.workdps(2 * DIGITS):
        by_seed = zip(harmonic, first.seeds, strict=True)
        linear = sum(n * chain.linear_frequency(q) for n, q in by_seed)
        Omega = chain.linear_frequency(sign.mode)
        wanted = Omega if twice > 0 else -Omega
        condition = resonance(harmonic, long(wanted - linear), float(Omega))
    try:
        found = way.meeting(condition, extrapolated(first, second, sign.part - 1))
    except NoTorus:
        return None
    return found if list(harmonic) in found.harmonics.tolist() else None


def folds(way: Way, after: int) -> Iterator[Event]:
    """The quantities that turn about the middle of the last three tori.

    They are found by parabolas through nearer ones.
    """
    three = way.tori[-3:]
    if len(three) < 3:
        return
    values = [quantities(torus) for torus in three]
    for name in values[0]:
        a, b, c = (v[name] for v in values)
        noise = way.tolerance * max(abs(a), abs(b), abs(c))
        if (b - a) * (c - b) < 0 and min(abs(b - a), abs(c - b)) > noise:
            yield _fold(way, name, after)


def _fold(way: Way, name: str, after: int) -> Event:
    """The fold of a quantity near the middle of the last three tori."""
    torus, place = _turn(way, lambda t: quantities(t)[name])
    value = quantities(torus)[name]
    if name.startswith("omega_"):
        seed = int(name.removeprefix("omega_"))
        value = float(torus.frequencies[torus.seeds.index(seed)])
    return Event("fold", name, after + (place > 0), float(torus.energy()), value)


def _turn(
    way: Way, measure: Callable[[Torus[Newton]], float]
) -> tuple[Torus[Newton], float]:
    """Where a measure turns, and how far along the way from the middle one of the last three tori.

    Newton tori between these, at the vertex of the parabola through the best three of all.
    """
    three = way.tori[-3:]
    first, middle, _ = three
    local = way.local(first, middle)
    scales = local.scales()
    x = [local.variables(torus, scales).astype(float) for torus in three]
    secant = x[1] - x[0]
    direction = secant / np.linalg.norm(secant)
    places = [float((y - x[1]) @ direction) for y in x]
    known = dict(zip(places, three, strict=True))
    torus, place = middle, 0.0
    for _ in range(LOCATIONS):
        near = sorted(known, key=lambda s: abs(s - place))[:3]
        vertex = _vertex(near, [measure(known[s]) for s in near])
        if (
            not min(known) <= vertex <= max(known)
            or abs(vertex - place) < LOCATION_TOLERANCE
        ):
            break
        try:
            torus, place = local.at(vertex), vertex
        except NoTorus:
            break
        known[vertex] = torus
    return torus, place


def crossing(way: Way, goal: Level) -> tuple[int, Torus[Newton]] | None:
    """The torus of the goal where the energy turns between the last three tori.

    All of them are below the goal, which the energy passes.

    With the number of these three that come before it. None where the energy does not turn, or
    below the goal. Raises NoTorus.
    """
    three = way.tori[-3:]
    if len(three) < 3:
        return None
    before, middle, after = map(goal.of, three)
    if not before < middle > after:
        return None
    top, place = _turn(way, goal.of)
    if not goal.passed(goal.of(top)):
        return None
    number = 1 if place <= 0 else 2
    return number, way.local(three[number - 1], top).between(goal)


def _vertex(s: Sequence[float], y: Sequence[float]) -> float:
    x, z = np.array(s) - s[0], np.array(y) - y[0]
    second, first, _ = np.polyfit(x, z, 2)
    if not second:
        return float(s[0])
    return float(s[0] - first / (2 * second))


def stability_change(way: Way, first: Member, second: Member, after: int) -> Event | None:
    """The place between two breathers where one becomes unstable or stable.

    The step is halved down to it.
    """
    if first.multipliers is None or second.multipliers is None:
        return None
    stable_before = first.multipliers.stable
    if stable_before == second.multipliers.stable:
        return None
    before, last = way.tori[-2:]
    if not last.travels:
        place = stability_between(before, last, stable_before)
    else:
        place = _halved(way, stable_before)
    energy = (first.energy + second.energy) / 2 if place is None else place
    unstable = second.multipliers if stable_before else first.multipliers
    change = "begins" if stable_before else "ends"
    what = f"instability ({', '.join(unstable.instabilities)}) {change}"
    return Event(
        "stability", what, after, energy, unstable.largest, interpolated=place is None
    )


def _halved(way: Way, stable_before: bool) -> float | None:
    """The energy between the last two waves where the stability changes, by halving."""
    before, last = way.tori[-2:]
    local = way.local(last, before)
    scales = local.scales()
    difference = local.variables(last, scales) - local.variables(before, scales)
    low, high, energy = 0.0, -float(np.linalg.norm(difference.astype(float))), None
    for _ in range(LOCATIONS):
        middle = (low + high) / 2
        try:
            torus = local.at(middle)
        except NoTorus:
            break
        energy = float(torus.energy())
        same = floquet(torus).stable == stable_before
        low, high = (middle, high) if same else (low, middle)
    return energy


def events_between(
    way: Way, first: Member, second: Member, after: int, normal: NormalWay | None
) -> list[Event | NormalEvent]:
    """What happens between the last two members of the way, and the folds at the first of them."""
    change = stability_change(way, first, second, after)
    changes = [change] if change else []
    of_normal = normal.events(way, first, second, after) if normal else []
    return [*folds(way, after - 1), *resonances(way, after), *changes, *of_normal]


class Found(NamedTuple):
    """The next member of a family.

    kept : members before it, fewer than there are where these have passed the goal.
    """

    kept: int
    member: Member
    events: list[Event | NormalEvent]


def continued(
    way: Way,
    members: Sequence[Member],
    goal: Level,
    *,
    multipliers: bool,
    normal: NormalWay | None,
) -> Iterator[Found]:
    """Members and events from the end of a way on, as long as they are asked for.

    Ends with NoTorus where the family cannot be followed.

    members : so far, the last of the way; it grows with what is found. The member at the goal has
        its energy. normal : of the normal frequencies, if they are asked for.
    """
    while True:
        way.advance(goal)
        kept = len(members)
        if passed := crossing(way, goal):
            number, torus = passed
            kept += number - 2
            way.tori = [*way.tori[-3:][:number], torus]
        torus = way.tori[-1]
        frequencies = normal.of(torus, way) if normal else None
        found = member(torus, multipliers=multipliers, normal=frequencies)
        events = events_between(way, members[kept - 1], found, kept - 1, normal)
        yield Found(kept, found, events)
