"""The propagation rule for every N: one seed set decides each of finitely many flats.

A mode is shown excited by the sign argument or a chain of couplings, which hold for every seed
set of the flat and the true frequencies, or by a residue, which holds there for the L_q(nu) as
independent symbols. It is shown not to be excited by the couplings. Statement, proofs and what is
left between the two are in docs/propagation.md.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from symfpu.chain.propagation import coupling_sequence, excitation_sequence
from symfpu.proofs.certificates import RuleException, Witness, random_point
from symfpu.proofs.flats import Flat, degree_of
from symfpu.proofs.plus_terms import PlusResidues, PlusTerms
from symfpu.proofs.seed_sums import chained_modes, modes_of_one_parity
from symfpu.series.coefficients import ResiduePoint

ATTEMPTS = 4  # points at which a residue may be zero before a mode counts as undecided


@dataclass(frozen=True, slots=True)
class DecidedFlat:
    """What the representative of a flat decides, for every N and seeds of the flat.

    flat : its representative. exceptions : modes of the representative whose order is not that of
    the rule. chained : excited modes that a chain of couplings shows, not the sign. witnesses :
    residues of the modes that both leave. points : where they were taken. undecided : modes that
    nothing decides.
    """

    flat: Flat
    exceptions: tuple[RuleException, ...] = ()
    chained: tuple[int, ...] = ()
    witnesses: tuple[Witness, ...] = ()
    points: tuple[ResiduePoint, ...] = ()
    undecided: tuple[int, ...] = ()

    @property
    def by_sign(self) -> bool:
        """Whether the sign argument shows every excited mode."""
        return not self.chained and not self.witnesses and not self.undecided


def decided_flat(model: str, order: int, flat: Flat) -> DecidedFlat:
    """Decide one flat by its representative."""
    N, seeds = flat.N, flat.seeds
    rule = _by_mode(excitation_sequence(N, seeds, order, model=model))
    by_sign = modes_of_one_parity(N, model, seeds, rule) | set(seeds)
    chained = chained_modes(N, model, seeds, rule, by_sign)
    if rule.keys() <= by_sign | chained:
        return DecidedFlat(flat, chained=tuple(sorted(chained - by_sign)))
    terms = PlusTerms(N, model, seeds)
    actual = _actual(terms, model, order, rule, by_sign | chained)
    exceptions = _exceptions(N, rule, actual)
    chained = chained_modes(N, model, seeds, actual, by_sign)
    shown = by_sign | chained
    left = [
        (q, k)
        for q, k in sorted(actual.items())
        if q not in shown and terms.decided_by_sign(q, degree_of(model, k)) is None
    ]
    witnesses, points = _witnesses(terms, model, left)
    shown |= {witness.mode for witness in witnesses}
    undecided = tuple(q for q, _ in left if q not in shown)
    in_chains = tuple(sorted(chained - by_sign))
    return DecidedFlat(flat, exceptions, in_chains, witnesses, points, undecided)


def _actual(
    terms: PlusTerms, model: str, order: int, rule: dict[int, int], shown: set[int]
) -> dict[int, int]:
    """The rule where all its modes have terms, else the corrected one.

    The rule can only be too early: outside its sets there is no term.
    """
    for q, k in rule.items():
        if q not in shown and not _has_terms(terms, q, degree_of(model, k)):
            return _by_mode(coupling_sequence(terms.N, terms.seeds, order, model=model))
    return rule


def _by_mode(sequence: Sequence[Sequence[int]]) -> dict[int, int]:
    return {q: k for k, modes in enumerate(sequence) for q in modes}


def _has_terms(terms: PlusTerms, q: int, degree: int) -> bool:
    return any(q in terms.signs(p) for p in terms.of_degree(degree))


def _exceptions(
    N: int, rule: dict[int, int], actual: dict[int, int]
) -> tuple[RuleException, ...]:
    modes = [q for q in range(1, N) if rule.get(q) != actual.get(q)]
    return tuple(RuleException(q, rule.get(q), actual.get(q)) for q in modes)


def _witnesses(
    terms: PlusTerms, model: str, left: Sequence[tuple[int, int]]
) -> tuple[tuple[Witness, ...], tuple[ResiduePoint, ...]]:
    """A coefficient with a nonzero residue for each of these modes and orders, where found."""
    found: dict[int, Witness] = {}
    points: list[ResiduePoint] = []
    if left:
        degree = max(degree_of(model, k) for _, k in left)
        for residues in _at_random_points(terms, degree):
            before = len(found)
            for q, k in left:
                witness = _witness(residues, q, k, degree_of(model, k), len(points))
                if q not in found and witness:
                    found[q] = witness
            if len(found) > before:
                points.append(residues.point)
            if len(found) == len(left):
                break
    return tuple(found[q] for q in sorted(found)), tuple(points)


def _witness(
    residues: PlusResidues, q: int, order: int, degree: int, point: int
) -> Witness | None:
    for p in residues.terms.of_degree(degree):
        residue = residues.values(p).get(q, 0)
        if residue:
            monomial = tuple(e for n in p for e in (n, 0))
            return Witness(q, order, point, monomial, residue)
    return None


def _at_random_points(terms: PlusTerms, degree: int) -> Iterator[PlusResidues]:
    """The same points for the same seed set, those left out at which a divisor vanishes."""
    name = f"{terms.N} {terms.seeds} {terms.factors}"
    source = random.Random(name)  # noqa: S311 (points need be random, not secret)
    for _ in range(ATTEMPTS):
        point = random_point(terms.N, len(terms.seeds), degree, source)
        residues = PlusResidues(terms, point)
        try:
            for p in terms.of_degree(degree):
                residues.values(p)
        except ZeroDivisionError:
            continue
        yield residues
