"""What happens on the way of a family: folds, resonances and changes of stability, located.

A fold is found by parabolas through ever nearer tori, a resonance by Newton's method with the zero
divisor as its condition, a change of stability by halving.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import mpmath
import numpy as np

from symfpu.breathers.floquet import floquet
from symfpu.families.continuation import (
    ASTRAY,
    Event,
    Level,
    Member,
    Way,
    extrapolated,
    member,
)
from symfpu.refinement.conditions import Crossing, ratio_conditions
from symfpu.refinement.invariance import DIGITS, long
from symfpu.refinement.tori import NoTorus, RefinedTorus, refined_torus, shifts_of

SIGNIFICANT = (
    1e-11  # of the largest coefficient: a divisor of a smaller one may change its sign unnoticed
)
LOCATED, LOCATIONS = (
    1e-7,
    8,
)  # relative change of the place of an event that is enough, and the most members spent on it
STRONGEST = (
    8  # crossings of resonances of one step, by their coefficients, that Newton's method locates
)


def quantities(torus: RefinedTorus) -> dict[str, float]:
    """What may turn along a family: energy, shifts of the frequencies, amplitudes."""
    shifts = shifts_of(torus)
    named = {f"omega_{q}": float(x) for q, x in zip(torus.seeds, shifts, strict=True)}
    return {"H": float(torus.energy())} | named | {f"A_{q}": a for q, a in torus.amplitudes.items()}


class _Sign(NamedTuple):
    """A divisor that changes its sign between two tori.

    part : of their distance, where it does so by interpolation.
    """

    mode: int
    harmonic: tuple[int, ...]
    part: float
    coefficient: float


def _signs(first: RefinedTorus, second: RefinedTorus) -> list[_Sign]:
    """The divisors of significant coefficients that change their sign between two tori.

    As they come.
    """
    rows = {tuple(nu): i for i, nu in enumerate(first.harmonics.tolist())}
    pairs = [
        (rows[nu], j) for j, nu in enumerate(map(tuple, second.harmonics.tolist())) if nu in rows
    ]
    i, j = (np.array(x) for x in zip(*pairs, strict=True))
    linear = first.chain.frequencies()
    known = []
    for torus, at in ((first, i), (second, j)):
        rates = np.abs(torus.harmonics[at] @ np.array([float(w) for w in torus.frequencies]))
        known.append(rates[:, None] - linear)
    size = (
        np.maximum(np.abs(first.cosines[i]), np.abs(second.cosines[j]))
        / np.abs(second.cosines).max()
    )
    seeds = np.zeros(size.shape, dtype=bool)
    for k, q in enumerate(first.seeds):
        seeds[:, q - 1] = (np.abs(first.harmonics[i]).sum(axis=1) == 1) & (
            first.harmonics[i][:, k] == 1
        )
    found = []
    for h, q in zip(
        *np.nonzero((known[0] * known[1] < 0) & (size > SIGNIFICANT) & ~seeds), strict=True
    ):
        part = float(known[0][h, q] / (known[0][h, q] - known[1][h, q]))
        found.append(
            _Sign(
                int(q) + 1,
                tuple(first.harmonics[i[h]].tolist()),
                part,
                float(second.cosines[j[h], q]),
            )
        )
    return sorted(found, key=lambda sign: sign.part)


def resonances(way: Way, after: int) -> Iterator[Event]:
    """The divisors that change their sign between the last two tori.

    The strongest are located by Newton's method. The others, and those where it finds no torus
    between the two, are interpolated.
    """
    first, second = way.tori[-2:]
    signs = _signs(first, second)
    strongest = sorted(signs, key=lambda sign: -abs(sign.coefficient))[
        : 0 if first.warnings or second.warnings else STRONGEST
    ]
    for sign in signs:
        torus = _resonant(way, sign) if sign in strongest else None
        if torus is None:
            energy, coefficient = (
                float(first.energy()) + sign.part * float(second.energy() - first.energy()),
                sign.coefficient,
            )
        else:
            row = torus.harmonics.tolist().index(list(sign.harmonic))
            energy, coefficient = float(torus.energy()), float(torus.cosines[row, sign.mode - 1])
        yield Event(
            "resonance",
            "divisor",
            after,
            energy,
            coefficient,
            sign.mode,
            sign.harmonic,
            torus is None,
        )


def _resonant(way: Way, sign: _Sign) -> RefinedTorus | None:
    """The torus between the last two on which this divisor is zero.

    None where Newton's method does not lead to it.
    """
    first, second = way.tori[-2:]
    chain = first.chain
    rate = sum(
        n * (a + b)
        for n, a, b in zip(sign.harmonic, first.frequencies, second.frequencies, strict=True)
    )
    with mpmath.workdps(2 * DIGITS):
        linear = sum(
            n * chain.linear_frequency(q) for n, q in zip(sign.harmonic, first.seeds, strict=True)
        )
        wanted = chain.linear_frequency(sign.mode)
        crossing = Crossing(
            sign.harmonic, long((wanted if rate > 0 else -wanted) - linear), float(wanted)
        )
    conditions = [crossing, *ratio_conditions(tuple(way.ratio), way.ratio, energies=way.energies)]
    try:
        found = refined_torus(
            extrapolated(first, second, sign.part - 1),
            conditions,
            tolerance=way.tolerance,
            report=way.report,
        )
    except NoTorus:
        return None
    along, astray = way.local(first, second).place(found)
    known = list(sign.harmonic) in found.harmonics.tolist()
    return None if found.warnings or astray > ASTRAY or not known or not 0 <= along <= 1 else found


def folds(way: Way, after: int) -> Iterator[Event]:
    """The quantities that turn about the middle of the last three tori.

    By parabolas through nearer ones.
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
    if name.startswith("omega"):
        value = float(torus.frequencies[torus.seeds.index(int(name.split("_")[1]))])
    return Event("fold", name, after + (place > 0), float(torus.energy()), value)


def _turn(way: Way, measure: Callable[[RefinedTorus], float]) -> tuple[RefinedTorus, float]:
    """Where a measure turns, and how far along the way from the middle one of the last three tori.

    Newton tori between these, at the vertex of the parabola through the best three of all.
    """
    first, middle, last = way.tori[-3:]
    local = way.local(first, middle)
    scales = local.scales()
    x = [local.variables(torus, scales).astype(float) for torus in (first, middle, last)]
    direction = (x[1] - x[0]) / np.linalg.norm(x[1] - x[0])
    known = {
        float((y - x[1]) @ direction): torus
        for y, torus in zip(x, (first, middle, last), strict=True)
    }
    torus, place = middle, 0.0
    for _ in range(LOCATIONS):
        near = sorted(known, key=lambda s: abs(s - place))[:3]
        vertex = _vertex(near, [measure(known[s]) for s in near])
        if not min(known) <= vertex <= max(known) or abs(vertex - place) < LOCATED:
            break
        try:
            torus, place = local.at(vertex), vertex
        except NoTorus:
            break
        known[vertex] = torus
    return torus, place


def crossing(way: Way, goal: Level) -> tuple[int, RefinedTorus] | None:
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
    second, first, _ = np.polyfit(np.array(s) - s[0], np.array(y) - y[0], 2)
    return float(s[0] - first / (2 * second)) if second else float(s[0])


def stability_change(way: Way, first: Member, second: Member, after: int) -> Event | None:
    """The place between two breathers where one becomes unstable or stable.

    The step is halved down to it.
    """
    if (
        first.multipliers is None
        or second.multipliers is None
        or first.multipliers.stable == second.multipliers.stable
    ):
        return None
    before, last = way.tori[-2], way.tori[-1]
    local = way.local(last, before)
    scales = local.scales()
    length = float(
        np.linalg.norm(
            (local.variables(last, scales) - local.variables(before, scales)).astype(float)
        )
    )
    low, high, energy = 0.0, -length, first.energy
    for _ in range(LOCATIONS):
        middle = (low + high) / 2
        try:
            torus = local.at(middle)
        except NoTorus:
            break
        stable = floquet(torus).stable
        energy = float(torus.energy())
        low, high = (middle, high) if stable == first.multipliers.stable else (low, middle)
    unstable = second.multipliers if first.multipliers.stable else first.multipliers
    change = "begins" if first.multipliers.stable else "ends"
    return Event(
        "stability",
        f"instability ({', '.join(unstable.instabilities)}) {change}",
        after,
        energy,
        unstable.largest,
    )


def events_between(way: Way, first: Member, second: Member, after: int) -> list[Event]:
    """What happens between the last two members of the way, and the folds at the first of them."""
    change = stability_change(way, first, second, after)
    return [*folds(way, after - 1), *resonances(way, after), *([change] if change else [])]


class Found(NamedTuple):
    """The next member of a family.

    kept : members before it, fewer than there are where these have passed the goal.
    """

    kept: int
    member: Member
    events: list[Event]


def continued(
    way: Way, members: Sequence[Member], goal: Level, *, multipliers: bool
) -> Iterator[Found]:
    """Members and events from the end of a way on, as long as they are asked for.

    Ends with NoTorus where the family cannot be followed.

    members : so far, the last of the way; it grows with what is found. The member at the goal has
        its energy.
    """
    while True:
        way.advance(goal)
        kept = len(members)
        if passed := crossing(way, goal):
            number, torus = passed
            kept += number - 2
            way.tori = [*way.tori[-3:][:number], torus]
        found = member(way.tori[-1], multipliers=multipliers)
        yield Found(kept, found, events_between(way, members[kept - 1], found, kept - 1))
