"""The propagation rule proved or refuted by exact arithmetic, with a certificate for others.

A mode is excited at an order if its term is not identically zero for generic frequencies
(Definition 1). That it is excited is shown by one coefficient with a nonzero residue modulo a
prime. That it is not excited is shown by the couplings, which leave it nothing, or by an identity
between integer polynomials in the L_q(nu); what neither shows is reported as undecided.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from symfpu.algebra.grading import monomial_count
from symfpu.algebra.residue import largest_modulus
from symfpu.chain.chain import Chain
from symfpu.chain.potentials.potential import Potential
from symfpu.chain.powers import powers_of
from symfpu.chain.propagation import coupled_modes, excitation_sequence
from symfpu.errors import InputError, SymfpuError, VanishingResidue
from symfpu.files.progress import Progress
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, integer_between, length_of, order_of, seed_modes
from symfpu.proofs.certified import Certified
from symfpu.proofs.seed_sums import modes_of_one_parity
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, fields_of, listed
from symfpu.results.table import Columns, Table, joined
from symfpu.series.coefficients import ResiduePoint
from symfpu.series.force import force_numbers
from symfpu.series.lindstedt import lindstedt
from symfpu.series.memory import check_size
from symfpu.series.monomials import shared_grading
from symfpu.series.residues import residue_series
from symfpu.series.series import LindstedtSeries

FORMAT = "symfpu propagation certificate"
SCHEMA, POTENTIALS = 1, 2  # of alpha and beta, of other potentials
# of a certificate: what is evidence
EVIDENCE = ("excited", "vanishing", "points", "coefficients", "digest")
SINGLE = ("alpha", "beta")  # models of one coupling, for which the rule is stated
MOST_POINTS = 1000  # of independent primes and frequencies; each is a run of the recursion
ATTEMPTS = 50  # points tried before giving up on vanishing divisors
IDENTITY_TERMS = 4000  # monomials times modes up to which an identity is tried
IDENTITY_ORDER = 4


@dataclass(frozen=True)
class Witness:
    """A coefficient that is not zero: mode, order, monomial, and its residue at a point.

    The monomial is (p_1, n_1, ..., p_s, n_s).
    """

    mode: int
    order: int
    point: int
    monomial: tuple[int, ...]
    residue: int

    def record(self) -> dict[str, Any]:
        """As a certificate holds it."""
        return {
            "mode": self.mode,
            "order": self.order,
            "point": self.point,
            "monomial": list(self.monomial),
            "residue": self.residue,
        }


@dataclass(frozen=True)
class Vanishing:
    """Orders at which the term of a mode is identically zero, and by what.

    By 'couplings' or 'identity'.
    """

    mode: int
    orders: tuple[int, ...]
    by: str

    def record(self) -> dict[str, Any]:
        """As a certificate holds it."""
        return {"mode": self.mode, "orders": list(self.orders), "by": self.by}


@dataclass(frozen=True)
class Undecided:
    """Orders at which the term of a mode was zero at every point and no proof was found.

    error_probability : bound on the probability that a term of generic frequencies vanishes at
    all points, if the primes do not divide all its coefficients.
    """

    mode: int
    orders: tuple[int, ...]
    error_probability: float

    def record(self) -> dict[str, Any]:
        """As a certificate holds it."""
        bound = f"{self.error_probability:.1e}"
        return {"mode": self.mode, "orders": list(self.orders), "error_probability": bound}


@dataclass(frozen=True)
class RuleException:
    """A mode whose order is not the predicted one.

    None where it is excited at no order up to the last.
    """

    mode: int
    predicted: int | None
    actual: int | None

    def record(self) -> dict[str, Any]:
        """As a certificate holds it."""
        return {"mode": self.mode, "predicted": self.predicted, "actual": self.actual}


@public
@dataclass(frozen=True)
class PropagationProof(Certified):
    """The Proposition's D_k beside the actual ones up to an order, and everything that shows it.

    Made by `prove_propagation`.

    N, model, seeds, order : the case. potential : None where the model is 'alpha' or 'beta'; of
    another chain, whose model is the potential as it is typed.
    rule, actual : modes by order, 0 .. order.
    verdict : 'proved', 'refuted' (some exception is decided) or 'undecided'.
    exceptions : modes whose order is not the predicted one. undecided : modes and orders that
        nothing decides.
    points : primes, roots and frequencies of the runs. excited : a coefficient that is not zero,
        for every excited mode.
    vanishing : modes and orders that are identically zero, and by what. All dimensionless
        integers, exact.

    >>> from symfpu import prove_propagation
    >>> prove_propagation(8, (1, 4), 3, model="beta")
    PropagationProof(N=8, beta, seeds=1,4, order 3: refuted; mode 7 predicted at 1, actually 2)
    >>> prove_propagation(8, (1, 4), 3, model="beta").to_frame().query("not agrees")
       mode  rule  actual  agrees undecided_orders
    6     7     1       2   False
    """

    not_kept = ""  # a file of results holds it, too
    layout: ClassVar[dict[str, Any]] = {"indent": 1}

    N: int
    model: str
    seeds: tuple[int, ...]
    order: int
    rule: tuple[tuple[int, ...], ...]
    actual: tuple[tuple[int, ...], ...]
    verdict: str
    exceptions: tuple[RuleException, ...]
    undecided: tuple[Undecided, ...]
    points: tuple[ResiduePoint, ...] = field(repr=False)
    excited: tuple[Witness, ...] = field(repr=False)
    vanishing: tuple[Vanishing, ...] = field(repr=False)
    potential: Potential | None = None

    def _fields(self) -> Iterator[Field]:
        """The certificate without the evidence, and what kind of evidence that is."""
        yield Field("", label="chain", shown=f"N={self.N}, {self.model}")
        yield Field("", label="seeds", shown=listed(self.seeds))
        known = self.certificate()
        yield from fields_of({key: known[key] for key in known if key not in EVIDENCE})
        yield Field("reason", self.reason)
        for k, modes in enumerate(self.actual):
            yield Field("", label=f"D_{k}", shown=listed(modes) or "none")
        for odd in self.exceptions:
            shown = f"predicted {odd.predicted}, actually {odd.actual}"
            yield Field("", label=f"mode {odd.mode}", shown=shown)

    def __repr__(self) -> str:
        seeds = ",".join(map(str, self.seeds))
        verdict = self.verdict
        for e in self.exceptions[:3]:
            verdict += f"; mode {e.mode} predicted at {e.predicted}, actually {e.actual}"
        if len(self.exceptions) > 3:
            verdict += f"; {len(self.exceptions) - 3} more"
        case = f"N={self.N}, {self.model}, seeds={seeds}, order {self.order}"
        return f"PropagationProof({case}: {verdict})"

    @property
    def reason(self) -> str:
        """What shows the excited modes: "sign", "residues", or "sign and residues".

        "couplings" where none is excited, as they leave nothing.
        The sign argument is for the models of one coupling, and shows more: the mode is excited
        for the frequencies of every N on the same flat (docs/propagation.md, Theorem 7).
        """
        excited = {witness.mode for witness in self.excited}
        by_sign = excited & self.by_sign
        reasons = ["sign"] if by_sign else []
        if excited > by_sign:
            reasons.append("residues")
        return " and ".join(reasons) or "couplings"

    @property
    def by_sign(self) -> frozenset[int]:
        """Modes that sums of the seeds, which fold with one sign, show excited by themselves."""
        if self.model not in SINGLE:
            return frozenset()
        orders = {q: k for k, modes in enumerate(self.rule) for q in modes}
        return frozenset(modes_of_one_parity(self.N, self.model, self.seeds, orders))

    def _certificate_body(self) -> dict[str, Any]:
        """`symfpu.checkers.propagation` checks it by another route."""
        rule = [list(modes) for modes in self.rule]
        actual = [list(modes) for modes in self.actual]
        return {
            "format": FORMAT,
            "schema": SCHEMA if self.potential is None else POTENTIALS,
            "N": self.N,
            **self._law_record(),
            "seeds": list(self.seeds),
            "order": self.order,
            "rule": rule,
            "actual": actual,
            "verdict": self.verdict,
            "exceptions": [e.record() for e in self.exceptions],
            "undecided": [u.record() for u in self.undecided],
            "points": [_point_record(p) for p in self.points],
            "excited": [w.record() for w in self.excited],
            "vanishing": [v.record() for v in self.vanishing],
        }

    def _law_record(self) -> dict[str, Any]:
        """The model, or the potential with the coefficients c_3, c_4, ... up to the last order."""
        if self.potential is None:
            return {"model": self.model}
        step = 2 if self.potential.even else 1
        degrees = range(3, 3 + step * self.order)
        coefficients = [str(self.potential.coefficient(n)) for n in degrees]
        text = self.potential.text
        return {"potential": text, "step": step, "coefficients": coefficients}

    def _table(self) -> Table:
        """One row for each mode: its order by the rule, its actual one, what is not decided."""
        modes = range(1, self.N)
        rule = {q: k for k, at in enumerate(self.rule) for q in at}
        actual = {q: k for k, at in enumerate(self.actual) for q in at}
        shown = {zero.mode: joined(zero.orders) for zero in self.undecided}
        columns: Columns = {
            "mode": modes,
            "rule": [rule.get(q) for q in modes],
            "actual": [actual.get(q) for q in modes],
            "agrees": [rule.get(q) == actual.get(q) for q in modes],
            "undecided_orders": [shown.get(q, "") for q in modes],
        }
        known = attributes(
            self,
            N=self.N,
            model=self.model,
            seeds=self.seeds,
            order=self.order,
            verdict=self.verdict,
        )
        return Table(columns, known)


def _point_record(point: ResiduePoint) -> dict[str, Any]:
    frequencies = list(point.frequencies)
    return {"prime": point.prime, "root": point.root, "frequencies": frequencies}


@public
def prove_propagation(
    N: int,
    seeds: Sequence[int],
    order: int,
    *,
    model: str | None = None,
    potential: Potential | str | None = None,
    points: int = 1,
    random_seed: int = 0,
    workers: int | None = None,
    progress: Progress | None = None,
) -> PropagationProof:
    """Prove or refute the Proposition (Eqs. app, dk) for given N, seeds and model, up to an order.

    N : number of bonds, at least 2. seeds : distinct modes D_0. order : the last k.
        model : 'alpha' (default) or 'beta'. potential : in its place, that of any chain with
        exact coefficients, such as toda("1/2") or "poly:1,2/3". All are dimensionless, exact.
    points : independent primes and random frequencies, each a run of the recursion, 1000 at
        most; with 0 nothing can be shown excited.
    random_seed : the same seed gives the same points.
    workers : threads of the recursion; default as many as there are processors.
    progress : called as (label, fraction done).

    Appendix B proves the Proposition in general; here each case is decided exactly, and some of
    beta are refuted. For other potentials the rule is that of `excitation_sequence` (ours).
    Raises InputError for arguments out of range and for a potential whose coefficients are
    rounded, TooLarge before allocating what does not fit.

    >>> prove_propagation(8, (1, 4), 3, model="beta")
    PropagationProof(N=8, beta, seeds=1,4, order 3: refuted; mode 7 predicted at 1, actually 2)
    """
    N = length_of(N)
    points = integer_between(points, "points", 0, MOST_POINTS, "fewer points")
    chain = proved_chain(N, model, potential)
    modes = seed_modes(seeds, N)
    seeds = tuple(sorted(modes))
    order = order_of(order)
    check_size(chain, seeds, order, "residue")
    if workers is not None:
        integer(workers, "workers", 1)
    rule = excitation_sequence(N, seeds, order, potential=chain.potential)
    source = random.Random(random_seed)  # noqa: S311 (points need be random, not secret)
    used: list[ResiduePoint] = []
    found: dict[int, Witness] = {}
    for number in range(points):
        done = _of_point(progress, number, points)
        point, series = _run_at_random_point(chain, seeds, order, source, done, workers)
        used.append(point)
        for witness in _witnesses(series, number, point.prime):
            known = found.get(witness.mode)
            if known is None or witness.order < known.order:
                found[witness.mode] = witness
    first = dict.fromkeys(seeds, 0)
    for q, witness in found.items():
        first[q] = witness.order
    vanishing, undecided = _zero_terms(chain, seeds, order, first, used)
    exceptions = _exceptions(N, rule, first)
    actual = [_modes_of_order(first, k) for k in range(order + 1)]
    verdict = _verdict(exceptions, undecided)
    excited = tuple(found[q] for q in sorted(found))
    return PropagationProof(
        N=N,
        model=law_name(chain),
        seeds=seeds,
        order=order,
        rule=tuple(rule),
        actual=tuple(actual),
        verdict=verdict,
        exceptions=exceptions,
        undecided=undecided,
        points=tuple(used),
        excited=excited,
        vanishing=vanishing,
        potential=None if chain.model in SINGLE else chain.potential,
    )


def proved_chain(N: int, model: str | None, potential: Potential | str | None) -> Chain:
    """The chain of one of both models, or of a potential with exact coefficients.

    The strength of a single coupling scales the amplitudes, so that alpha or beta is 1. InputError
    for others, and where model and potential are both given.
    """
    if potential is None:
        model = model or "alpha"
        if model not in SINGLE:
            advice = "of others give the potential, such as potential='poly:1,2/3'"
            raise InputError("model", model, "'alpha' or 'beta'", advice)
        return Chain(N, alpha=int(model == "alpha"), beta=int(model == "beta"))
    powers_of(model, potential)  # refuses both
    chain = Chain(N, potential=potential)
    if not chain.potential.exact:
        allowed = "a potential with exact coefficients"
        advice = "rounded ones prove nothing: write it with rational numbers"
        raise InputError("potential", chain.potential, allowed, advice)
    if chain.model in SINGLE:
        return proved_chain(N, chain.model, None)
    return chain


def law_name(chain: Chain) -> str:
    """'alpha', 'beta', or the potential as it is typed."""
    return chain.model if chain.model in SINGLE else chain.potential.text


def _modes_of_order(first: dict[int, int], order: int) -> tuple[int, ...]:
    return tuple(q for q in sorted(first) if first[q] == order)


def _exceptions(
    N: int, rule: Sequence[Sequence[int]], first: dict[int, int]
) -> tuple[RuleException, ...]:
    """The modes whose first order is not that of the rule."""
    predicted = {q: k for k, modes in enumerate(rule) for q in modes}
    exceptions = []
    for q in range(1, N):
        by_rule, actual = predicted.get(q), first.get(q)
        if by_rule != actual:
            exceptions.append(RuleException(q, by_rule, actual))
    return tuple(exceptions)


def _verdict(exceptions: Iterable[RuleException], undecided: Sequence[Undecided]) -> str:
    open_modes = {u.mode for u in undecided}
    if any(e.mode not in open_modes for e in exceptions):
        return "refuted"
    return "undecided" if undecided else "proved"


def _of_point(progress: Progress | None, number: int, points: int) -> Progress | None:
    """What the run at one of so many points tells."""
    if progress is None:
        return None
    label = "recursion modulo a prime"
    return lambda _, fraction: progress(label, (number + fraction) / points)


def random_point(N: int, seeds: int, degree: int, source: random.Random) -> ResiduePoint:
    """A random prime p = 1 mod 4N, an element of order 4N, and random frequencies.

    The prime keeps sums of this degree exact.
    """
    from sympy import isprime, primefactors

    period = 4 * N
    top = largest_modulus(seeds, degree) // period
    if top < 2**12:
        none_left = (
            f"no primes 1 mod {period} are left for order {degree - 1} with {seeds} seeds"
        )
        raise SymfpuError(f"{none_left}; take a lower order")
    prime = 4
    while not isprime(prime):
        prime = period * source.randrange(top // 2, top) + 1
    factors = primefactors(period)
    root = 1
    # until its order is 4N, no less
    while any(pow(root, period // f, prime) == 1 for f in factors):
        root = pow(source.randrange(2, prime), (prime - 1) // period, prime)
    frequencies = tuple(source.randrange(1, prime) for _ in range(seeds))
    return ResiduePoint(prime, root, frequencies)


def _run_at_random_point(
    chain: Chain,
    seeds: tuple[int, ...],
    order: int,
    source: random.Random,
    progress: Progress | None,
    workers: int | None,
) -> tuple[ResiduePoint, LindstedtSeries]:
    degree = 1 + chain.degree_step * order
    denominators = {number.denominator for number in force_numbers(chain, degree)}
    for _ in range(ATTEMPTS):
        point = random_point(chain.N, len(seeds), degree, source)
        if not all(n % point.prime for n in denominators):
            continue
        try:
            series = residue_series(
                chain, seeds, point, order, workers=workers, progress=progress
            )
        except VanishingResidue:
            continue
        return point, series
    vanished = f"a divisor vanished at each of {ATTEMPTS} random points"
    raise SymfpuError(f"{vanished}; the seeds {seeds} may be resonant for every frequency")


def _witnesses(series: LindstedtSeries, point: int, prime: int) -> Iterable[Witness]:
    """For every mode outside the seeds, its first nonzero order and a monomial there.

    It is the monomial with the fewest divisors.
    """
    shown = set(series.seeds)
    for k in range(1, series.order + 1):
        table = series.coordinates[k]
        excited = np.flatnonzero(table.any(axis=0)) + 1
        new = [int(q) for q in excited if int(q) not in shown]
        if not new:
            continue
        degree = series.degree(k)
        canonical = series.grading.canonical(degree)
        exponents = series.grading.exponents(degree)[canonical]
        divisors = np.prod(exponents + 1, axis=1)
        simplest = np.argsort(divisors, kind="stable")
        for q in new:
            column = table[:, q - 1]
            row = next(int(r) for r in simplest if column[r] != 0)
            monomial = tuple(map(int, exponents[row]))
            residue = int(column[row]) % prime
            yield Witness(q, k, point, monomial, residue)
            shown.add(q)


def _zero_terms(
    chain: Chain,
    seeds: tuple[int, ...],
    order: int,
    actual: dict[int, int],
    points: Sequence[ResiduePoint],
) -> tuple[tuple[Vanishing, ...], tuple[Undecided, ...]]:
    """Why every term below the actual order of its mode is zero; what is left is undecided."""
    sets = coupled_modes(chain.N, seeds, order, potential=chain.potential)
    coupled = list(map(set, sets))
    vanishing, undecided = [], []
    for q in range(1, chain.N):
        first = actual.get(q, order + 1)
        orders = [] if q in seeds else list(range(1, first))
        by_couplings = tuple(j for j in orders if q not in coupled[j])
        rest = [j for j in orders if q in coupled[j]]
        by_identity = tuple(j for j in rest if _is_identity(chain, seeds, q, j))
        left = tuple(j for j in rest if j not in by_identity)
        if by_couplings:
            vanishing.append(Vanishing(q, by_couplings, "couplings"))
        if by_identity:
            vanishing.append(Vanishing(q, by_identity, "identity"))
        if left:
            probability = _error_probability(chain, len(seeds), max(left), points)
            undecided.append(Undecided(q, left, probability))
    return tuple(vanishing), tuple(undecided)


def _is_identity(chain: Chain, seeds: tuple[int, ...], q: int, order: int) -> bool:
    """Whether the term of q is the zero polynomial in independent symbols L_q(nu).

    False also where that is too large.
    """
    degree = 1 + chain.degree_step * order
    terms = monomial_count(len(seeds), degree) * chain.N
    if order > IDENTITY_ORDER or terms > IDENTITY_TERMS:
        return False
    series = lindstedt(chain, seeds, order=order)
    column = series.coordinates[order][:, q - 1]
    return all(value == 0 for value in column)


def _error_probability(
    chain: Chain, seeds: int, order: int, points: Sequence[ResiduePoint]
) -> float:
    """Bound of the probability that an excited term vanishes at every point (Schwartz-Zippel).

    A term is a quotient of polynomials in the frequencies over a product of divisors, each at
    most `order` times and of degree 2; its numerator vanishes at a random point with probability
    at most degree / p.
    """
    if not points:
        return 1.0
    grading = shared_grading(seeds, 1 + chain.degree_step * order)
    harmonics: set[tuple[int, ...]] = set()
    for d in range(1, grading.degree + 1):
        rows, *_ = grading.harmonics(d)
        harmonics |= {tuple(nu) for nu in rows.tolist()}
    degree = 2 * order * len(harmonics) * (chain.N - 1)
    at_each_point = [min(1.0, degree / point.prime) for point in points]
    return float(np.prod(at_each_point))
