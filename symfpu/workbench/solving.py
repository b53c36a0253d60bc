"""From a choice to its torus, by the functions that its lines of Python call."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from symfpu.errors import InputError
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.numbers.typed import decimal
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.store.saved_file import load
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.at_energy import series_at_energy
from symfpu.tori.energy import Energy
from symfpu.tori.frequencies import series_at_amplitudes
from symfpu.tori.from_series import FromSeries
from symfpu.tori.orders import Orders
from symfpu.tori.torus import Torus, comes_from
from symfpu.tori.verdict import Assessment, assess
from symfpu.workbench.choice import AMPLITUDES, ENERGY, FREQUENCIES, Choice


@dataclass(frozen=True, eq=False)
class Solved:
    """A torus, its series where it has one, and that of Newton's method where it was wished."""

    choice: Choice
    torus: Torus
    series: LindstedtSeries | None
    refined: Torus[Newton] | None = None

    @property
    def best(self) -> Torus:
        """What is kept and exported."""
        return self.torus if self.refined is None else self.refined


def solved(
    choice: Choice, near: Solved | None = None, progress: Progress | None = None
) -> Solved:
    """The torus of a choice; raises the errors of the functions that make it.

    near : what was solved before, from which amplitudes and energies are followed where it is of
        the same chain and seeds. progress : called as (label, fraction done).
    """
    tell = progress or unheard
    if near is not None and near.choice == unrefined(choice):
        found = near
    elif choice.bundle:
        found = _held(choice)
    else:
        found = _solved(choice, near, tell)
    if not choice.refined:
        return found
    tell("Newton's method", NO_FRACTION)
    torus = found.torus
    refined = refine(torus, progress=tell)
    return Solved(choice, torus, found.series, refined)


def unrefined(choice: Choice) -> Choice:
    """The same choice before Newton's method."""
    return choice.changed(bundle=choice.bundle)


def _held(choice: Choice) -> Solved:
    torus = load(choice.bundle)
    if not isinstance(torus, Torus):
        allowed = "a file with a torus or a breather in it"
        advice = "write one with save, or symfpu solve -o"
        raise InputError("bundle", type(torus).__name__, allowed, advice)
    series = torus.origin.series if comes_from(torus, FromSeries) else None
    return Solved(choice, torus, series)


def _solved(choice: Choice, near: Solved | None, tell: Progress) -> Solved:
    choice.require_known()
    chain, typed, order = choice.chain, choice.by_seed, choice.last_order
    if choice.given == FREQUENCIES:
        omega = tuple(typed.values())
        series = lindstedt(chain, tuple(typed), omega, order, progress=tell)
        return Solved(choice, solve_amplitudes(series), series)
    start = _start(choice, near)
    tell("frequencies", NO_FRACTION)
    if choice.given == AMPLITUDES:
        torus = series_at_amplitudes(chain, typed, Orders(order), near=start)
    elif choice.given == ENERGY:
        energy = Energy(choice.energy, energy_ratio=typed)
        torus = series_at_energy(chain, tuple(typed), energy, Orders(order), near=start)
    else:
        raise InputError("given", choice.given, "a known one", "choose it on the page")
    return Solved(choice, torus, torus.origin.series)


def _start(choice: Choice, near: Solved | None) -> Torus[FromSeries] | None:
    """The torus before, where amplitudes or energies lead from it to the wished one."""
    if near is None or near.choice.bundle or near.choice.given == FREQUENCIES:
        return (
            None  # one of chosen frequencies may be on another family than that from rest
        )
    before = near.torus
    seeds = set(choice.seed_modes)
    same = before.chain == choice.chain and set(before.seeds) == seeds
    if not same or not comes_from(before, FromSeries):
        return None
    return before if before.origin.order == choice.last_order else None


def judged(found: Solved, progress: Progress | None = None) -> Assessment | None:
    """The verdict on the series; None where there is none."""
    if comes_from(found.torus, FromSeries):
        return assess(found.torus.origin.series, found.torus, progress=progress)
    return None


def described(torus: Torus, bundle: str) -> Choice:
    """A choice that says what a torus from a file is; the file itself stays what is shown."""
    law: dict[str, Any] = {"alpha": "0", "beta": "0", "potential": ""}
    law |= torus.chain.typed_law
    order = torus.origin.order if comes_from(torus, FromSeries) else 8
    return Choice(
        N=str(torus.chain.N),
        **law,
        ends=torus.chain.ends,
        seeds=",".join(map(str, torus.seeds)),
        given=FREQUENCIES,
        values=tuple(decimal(w) for w in torus.frequencies),
        order=str(order),
        bundle=bundle,
    )
