"""The propagation rule as a theorem for every N, with a certificate."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, length_of, order_of, seed_modes
from symfpu.proofs.certified import Certified
from symfpu.proofs.decided_file import DecidedFile
from symfpu.proofs.every_length import DecidedFlat, decided_flat
from symfpu.proofs.families import equation_text, mode_text
from symfpu.proofs.flats import MOST_SEEDS, Arrangement, Flat, degree_of, flats, last_order
from symfpu.proofs.seed_sums import without_odd_sums
from symfpu.results.attributes import attributes
from symfpu.results.field import Field
from symfpu.results.numbers import json_value
from symfpu.results.table import Columns, Table
from symfpu.sweeps.workers import executor_of

FORMAT, SCHEMA = "symfpu rule for all N certificate", 2
MODELS = ("alpha", "beta")
BATCH = 16  # flats in one task
FEW = 2000  # flats that are decided without a pool of processes


@dataclass(frozen=True)
class ExceptionalFlat:
    """A family of seed sets, of every N, in which the rule fails.

    Those that fulfil no further equation which makes another flat: the smallest flat decides.
    equations : what the seeds of the family fulfil, such as "2 q_2 = N". dimension : how many
    numbers remain free, 0 for the multiples of one seed set. modes : (mode in terms of N and
    seeds, order by the rule, actual order or None). N, seeds : the representative.
    """

    equations: tuple[str, ...]
    dimension: int
    modes: tuple[tuple[str, int | None, int | None], ...]
    N: int
    seeds: tuple[int, ...]

    def __str__(self) -> str:
        shifts = "; ".join(f"{q}: {rule} -> {actual}" for q, rule, actual in self.modes)
        return f"{', '.join(self.equations)}   (modes {shifts})"


@public
@dataclass(frozen=True)
class RuleForAllN(Certified):
    """The Proposition for all sets of s seeds and every N, up to an order: a theorem.

    Made by `prove_for_all_N`.

    model : 'alpha' or 'beta'. seeds_number : s. order : the last k. verdict : 'proved', 'refuted'
    (on the exceptional flats, and only there) or 'undecided'. decided : what each flat decides.
    All are dimensionless integers, exact.

    >>> from symfpu import prove_for_all_N
    >>> prove_for_all_N("beta", 2, 1)
    RuleForAllN(beta, 2 seeds, order 1: refuted on 8 of 98 flats, on the others proved)
    """

    not_kept = ""  # a file of results holds it, too

    model: str
    seeds_number: int
    order: int
    verdict: str
    decided: tuple[DecidedFlat, ...] = field(repr=False)

    def _fields(self) -> Iterator[Field]:
        """The theorem, and every family of seed sets that it excepts."""
        exceptional = [json_value(vars(flat)) for flat in self.exceptional_flats]
        yield Field("model", self.model, "model")
        yield Field("seeds_number", self.seeds_number, "seeds")
        yield Field("order", self.order, "order")
        yield Field("verdict", self.verdict)
        yield Field("reason", self.reason, "reason")
        yield Field("theorem", self.theorem)
        yield Field("flats", self.flats, "flats")
        yield Field("exceptional_flats", exceptional, "exceptional", str(len(exceptional)))
        yield Field("gaps", [[found.flat.N, *found.flat.seeds] for found in self.gaps])

    def __repr__(self) -> str:
        seeds = f"{self.seeds_number} seed" + "s" * (self.seeds_number > 1)
        case = f"{self.model}, {seeds}, order {self.order}"
        return f"RuleForAllN({case}: {self._outcome()})"

    def _outcome(self) -> str:
        exceptional = len([found for found in self.decided if found.exceptions])
        gaps = len(self.gaps)
        how = f", on {gaps} for generic L_q" if gaps else ""
        if self.verdict == "refuted":
            return (
                f"refuted on {exceptional} of {self.flats} flats, on the others proved{how}"
            )
        return f"{self.verdict} on {self.flats} flats{how}"

    @property
    def flats(self) -> int:
        """How many flats there are."""
        return len(self.decided)

    @property
    def reason(self) -> str:
        """What shows the excited modes: "sign", where needed with "chains" and "residues"."""
        reasons = ["sign"]
        if any(found.chained for found in self.decided):
            reasons.append("chains")
        if any(found.witnesses for found in self.decided):
            reasons.append("residues")
        return " and ".join(reasons)

    @property
    def gaps(self) -> tuple[DecidedFlat, ...]:
        """Flats of dimension one and more with a mode that a residue decides, not the sign.

        There the theorem holds for the L_q(nu) as independent symbols, and for the true ones of
        all seed sets but a nowhere dense part of the flat. On a flat of dimension 0 all seed sets
        have the frequencies of the representative, at which the residue is taken.
        """
        decided = self.decided
        return tuple(found for found in decided if found.witnesses and found.flat.dimension)

    @property
    def exceptional_flats(self) -> tuple[ExceptionalFlat, ...]:
        """Every flat on which the rule fails, as a family of seed sets."""
        arrangement = Arrangement(self.model, self.seeds_number, self.order)
        named = partial(_exceptional, arrangement, degree_of(self.model, self.order))
        return tuple(named(found) for found in self.decided if found.exceptions)

    def deciding(self, N: int, seeds: Sequence[int]) -> DecidedFlat:
        """The flat that decides a seed set: the smallest one that holds it.

        N : number of bonds. seeds : s distinct modes, in any order.
        Raises InputError for others.

        >>> from symfpu import prove_for_all_N
        >>> prove_for_all_N("beta", 2, 1).deciding(1000, (7, 500)).flat
        Flat(N=8, seeds=(1, 4), dimension=1)
        """
        modes = sorted(seed_modes(seeds, length_of(N)))
        if len(modes) != self.seeds_number:
            allowed = f"{self.seeds_number} modes"
            raise InputError("seeds", tuple(seeds), allowed, "prove it for as many seeds")
        arrangement = Arrangement(self.model, self.seeds_number, self.order)
        held = arrangement.through(N, np.array([modes]))
        for found in self.decided:
            flat = found.flat
            if (arrangement.through(flat.N, np.array([flat.seeds])) == held).all():
                return found
        raise AssertionError("the flats are not complete")

    @property
    def theorem(self) -> str:
        """What is proved, in one sentence."""
        return theorem_text(self)

    def _certificate_body(self) -> dict[str, Any]:
        """`symfpu.checkers.every_length` checks it by another route."""
        listed = self._listed()
        points = [point for found in listed for point in found.points]
        return {
            "format": FORMAT,
            "schema": SCHEMA,
            "model": self.model,
            "seeds_number": self.seeds_number,
            "order": self.order,
            "verdict": self.verdict,
            "count": self.flats,
            "flats": [[found.flat.N, *found.flat.seeds] for found in listed],
            "exceptions": list(_exception_records(listed)),
            "undecided": [
                [i, q] for i, found in enumerate(listed) for q in found.undecided
            ],
            "points": [[p.prime, p.root, *p.frequencies] for p in points],
            "witnesses": list(_witness_records(listed)),
        }

    def _listed(self) -> list[DecidedFlat]:
        """Of which something has to be said: a checker finds and decides the others by itself."""
        return [
            found
            for found in self.decided
            if found.exceptions or found.witnesses or found.undecided
        ]

    def _table(self) -> Table:
        """One row for each flat."""
        found = self.decided
        columns: Columns = {
            "dimension": [f.flat.dimension for f in found],
            "N": [f.flat.N for f in found],
            "seeds": [",".join(map(str, f.flat.seeds)) for f in found],
            "exceptions": [len(f.exceptions) for f in found],
            "by_sign": [f.by_sign for f in found],
            "undecided": [len(f.undecided) for f in found],
        }
        known = attributes(
            self,
            model=self.model,
            seeds_number=self.seeds_number,
            order=self.order,
            verdict=self.verdict,
        )
        return Table(columns, known)


def _exception_records(listed: Sequence[DecidedFlat]) -> Iterator[list[int | None]]:
    """Flat, mode, order by the rule, actual order."""
    for i, found in enumerate(listed):
        for e in found.exceptions:
            yield [i, e.mode, e.predicted, e.actual]


def _witness_records(listed: Sequence[DecidedFlat]) -> Iterator[list[int]]:
    """Flat, point, mode, order, residue, and the powers of the seeds."""
    first = 0
    for i, found in enumerate(listed):
        for w in found.witnesses:
            powers = w.monomial[::2]
            yield [i, first + w.point, w.mode, w.order, w.residue, *powers]
        first += len(found.points)


def theorem_text(proof: RuleForAllN) -> str:
    """The theorem of a proof in one sentence."""
    s = proof.seeds_number
    sets = f"every set of {s} seed" + "s" * (s > 1)
    where = "on"
    if s >= degree_of(proof.model, proof.order):
        where = f"at most where {s} of the seeds are on one of"
        sets = f"every set of {s} or more seeds"
    start = f"{proof.model} chains: for every N and {sets}, to order {proof.order},"
    if proof.verdict == "undecided":
        return f"{start} the propagation rule is not decided"
    exceptional = len([found for found in proof.decided if found.exceptions])
    rule = "the propagation rule holds"
    if exceptional:
        rule += f" except {where} {exceptional} of {proof.flats} flats"
    if not proof.gaps:
        return f"{start} {rule}, for generic frequencies"
    rest = f"on {len(proof.gaps)} flats for generic L_q(nu) instead"
    return f"{start} {rule}, for generic frequencies; {rest}"


def _exceptional(
    arrangement: Arrangement, degree: int, found: DecidedFlat
) -> ExceptionalFlat:
    flat = found.flat
    rows = arrangement.equations(flat.N, flat.seeds)
    modes = tuple(
        (mode_text(e.mode, flat, rows, degree), e.predicted, e.actual)
        for e in found.exceptions
    )
    equations = tuple(map(equation_text, rows))
    return ExceptionalFlat(equations, flat.dimension, modes, flat.N, flat.seeds)


@public
def prove_for_all_N(
    model: str,
    seeds_number: int,
    order: int,
    *,
    executor: Any = None,
    file: Path | str | None = None,
    progress: Progress | None = None,
) -> RuleForAllN:
    """Prove or refute the Proposition (Eqs. app, dk) for every N and all sets of s seeds.

    model : 'alpha' or 'beta'. seeds_number : s, 1 to 3. All are dimensionless.
    order : the last k, 1 up to the last whose certificate can be checked: in alpha 200, 12 and 4
        for s = 1, 2 and 3, in beta 100, 6 and 2.
    executor : any concurrent.futures.Executor, or a client of dask; default a pool of processes
        where flats are many, which a script must start under `if __name__ == "__main__":`.
    file : JSON lines, one for each decided flat; an existing file of the same theorem is
        continued.
    progress : called as (label, fraction done).

    With s = k + 1 seeds (alpha) or 2k + 1 (beta) order k is settled for all larger sets, too.
    Raises InputError, before anything is computed, for arguments out of range and for a file of
    another theorem; FileFull where a flat finds no room; WorkersDoNotStart where a script starts
    processes without that line. What a flat is, why a representative
    decides it, and what it proves: docs/propagation.md (ours).

    >>> proof = prove_for_all_N("beta", 2, 1)
    >>> print(proof.exceptional_flats[0])
    2 q_2 = N   (modes N - q_1: 1 -> None)
    >>> prove_for_all_N("alpha", 1, 4)
    RuleForAllN(alpha, 1 seed, order 4: proved on 16 flats)
    """
    if model not in MODELS:
        advice = "other potentials are proved N by N: prove_propagation"
        raise InputError("model", model, "'alpha' or 'beta'", advice)
    s, last = integer(seeds_number, "seeds_number", 1), order_of(order, 1)
    if s > MOST_SEEDS:
        allowed = f"1 to {MOST_SEEDS}"
        advice = "flats of more seeds are not enumerated; prove_propagation decides one set"
        raise InputError("seeds_number", s, allowed, advice)
    _require_checkable(model, s, last)
    told = progress or unheard
    with ExitStack() as stack:
        kept = stack.enter_context(DecidedFile(file, model, s, last))
        all_flats = flats(model, s, last, told)
        asked = _with_odd_sums(model, last, all_flats)
        todo = [flat for flat in asked if flat not in kept.decided]
        pool = None
        if executor is not None or len(todo) > FEW:
            pool = stack.enter_context(executor_of(executor, math.ceil(len(todo) / BATCH)))
        for batch in _decided(pool, model, last, todo):
            kept.append(batch)
            told("flats", len(kept.decided) / len(asked))
    found = {flat: kept.decided[flat] for flat in asked}
    decided = tuple(found.get(flat) or DecidedFlat(flat) for flat in all_flats)
    return RuleForAllN(model, s, last, _verdict(decided), decided)


def _require_checkable(model: str, s: int, order: int) -> None:
    """InputError for an order whose certificate the checker would not take."""
    most = last_order(model, s)
    if order > most:
        seeds = f"{s} seed" + "s" * (s > 1)
        allowed = f"1 to {most} for {seeds} in {model}, whose certificates can be checked"
        advice = f"no checker takes terms of {degree_of(model, order)} leaves of {seeds}; "
        advice += "prove_propagation decides one seed set"
        raise InputError("order", order, allowed, advice)


def _with_odd_sums(model: str, order: int, all_flats: Sequence[Flat]) -> list[Flat]:
    """Those that Theorem 7 of docs/propagation.md does not decide by itself."""
    seeds = np.array([flat.seeds for flat in all_flats], dtype=np.int64)
    N = np.array([flat.N for flat in all_flats], dtype=np.int64)
    open_flats = np.flatnonzero(~without_odd_sums(model, order, seeds, N)).tolist()
    return [all_flats[i] for i in open_flats]


def _verdict(decided: Sequence[DecidedFlat]) -> str:
    if any(found.undecided for found in decided):
        return "undecided"
    return "refuted" if any(found.exceptions for found in decided) else "proved"


def _decided(
    pool: Executor | None, model: str, order: int, todo: Sequence[Flat]
) -> Iterator[list[DecidedFlat]]:
    """The flats in batches, those decided in other processes as they come."""
    batches = [todo[i : i + BATCH] for i in range(0, len(todo), BATCH)]
    decide = partial(decide_batch, model, order)
    yield from map(decide, batches) if pool is None else pool.map(decide, batches)


def decide_batch(model: str, order: int, batch: Sequence[Flat]) -> list[DecidedFlat]:
    """Decide some flats on one core."""
    return [decided_flat(model, order, flat) for flat in batch]
