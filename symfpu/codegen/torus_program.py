"""What every language is given: the numbers of a torus in an order that loops run through, and nothing of the package.

Q_q(t) = sum c_q[nu] cos(nu.(omega t + phi)). A harmonic appears in modes of one parity only, so the harmonics fall into two
blocks, each with the modes of its parity: half of the coefficients are never stored, multiplied or added.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers, text
from symfpu.numbers.typed import decimal
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic

Ints = NDArray[np.int64]
CHECK_PERIODS = (0.0, 0.37, 41.3)  # times of the embedded test vectors, in periods of the slowest seed
EXTRA_DIGITS = 5
SPLIT_DIGITS = 60  # from which omega / 2 pi is split into two doubles
TOLERANCE = 1e-13  # of the self-test, relative to the largest coordinate or momentum


@dataclass(frozen=True, eq=False)
class Block:
    """Harmonics of one parity. modes : (M,). harmonics : (H, s). coefficients : (H, M), c_q[nu]."""

    modes: tuple[int, ...]
    harmonics: Ints
    coefficients: Numbers


@dataclass(frozen=True, eq=False)
class Check:
    """Test vectors: times (T,), positions and momenta (T, N-1), energies (T,), all as decimal text."""

    times: tuple[str, ...]
    positions: tuple[tuple[str, ...], ...]
    momenta: tuple[tuple[str, ...], ...]
    energies: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class TorusProgram:
    """A torus as data for an emitter. facts : what the header says, in order. highest : largest |nu_i| of every seed."""

    name: str
    facts: Mapping[str, str]
    N: int
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    phases: tuple[Any, ...]
    alpha: Fraction
    beta: Fraction
    digits: int | None
    blocks: tuple[Block, ...] = field(repr=False)
    check: Check = field(repr=False)

    @property
    def highest(self) -> tuple[int, ...]:
        return tuple(max((int(np.abs(b.harmonics[:, i]).max(initial=0)) for b in self.blocks), default=0) for i in range(len(self.seeds)))

    @property
    def coefficient_count(self) -> int:
        return sum(b.coefficients.size for b in self.blocks)


def torus_program(torus: QuasiPeriodic, name: str, facts: Mapping[str, str]) -> TorusProgram:
    """Order the numbers of a torus for code; facts come first in the header."""
    parity = torus.harmonics @ np.array(torus.seeds) % 2
    modes = np.arange(1, torus.chain.N)
    blocks = []
    for p in (0, 1):
        columns = np.flatnonzero(modes % 2 == p)
        rows = np.flatnonzero(parity == p)
        rows = rows[(torus.cosines[np.ix_(rows, columns)] != 0).any(axis=1)] if len(rows) and len(columns) else rows[:0]
        if len(rows):
            blocks.append(Block(tuple(map(int, modes[columns])), torus.harmonics[rows], torus.cosines[np.ix_(rows, columns)]))
    return TorusProgram(
        name=name,
        facts=dict(facts) | {"hash of the coefficients": coefficient_hash(blocks)},
        N=torus.chain.N,
        seeds=torus.seeds,
        frequencies=torus.frequencies,
        phases=tuple(torus.phases[q] for q in torus.seeds),
        alpha=torus.chain.alpha,
        beta=torus.chain.beta,
        digits=torus.digits,
        blocks=tuple(blocks),
        check=_check(torus),
    )


def torus_facts(torus: QuasiPeriodic) -> dict[str, str]:
    """The header of a torus: chain, seeds, frequencies; exact numbers as they were typed."""
    return {
        "chain": repr(torus.chain),
        "seeds": ", ".join(map(str, torus.seeds)),
        "frequencies": ", ".join(map(decimal, torus.frequencies)),
        "precision": "doubles" if torus.digits is None else f"{torus.digits} digits",
    }


def coefficient_hash(blocks: list[Block]) -> str:
    """SHA-256 of harmonics and coefficients as decimal text."""
    digest = hashlib.sha256()
    for block in blocks:
        digest.update(repr((block.modes, block.harmonics.tolist())).encode())
        digest.update("\n".join(number(c) for c in block.coefficients.flat).encode())
    return digest.hexdigest()


def number(value: Any, digits: int = 17) -> str:
    """A coefficient as decimal text that reads back as the same double; an mpf to so many digits."""
    return repr(float(value)) if isinstance(value, float) else text(value, digits)


def turns(program: TorusProgram) -> tuple[tuple[float, float], ...]:
    """omega / 2 pi of every seed as the sum of two doubles."""
    pairs = []
    with mpmath.workdps(SPLIT_DIGITS):
        for w in program.frequencies:
            exact = mpmath.mpf(w.numerator) / w.denominator / (2 * mpmath.pi)
            high = float(exact)
            pairs.append((high, float(exact - high)))
    return tuple(pairs)


def inverse_turn() -> tuple[float, float]:
    """1 / 2 pi as the sum of two doubles."""
    with mpmath.workdps(SPLIT_DIGITS):
        exact = 1 / (2 * mpmath.pi)
        high = float(exact)
        return high, float(exact - high)


def rates(harmonics: Ints, frequencies: Sequence[Fraction]) -> list[float]:
    """nu.omega of harmonics (H, s), correctly rounded."""
    return [float(sum(n * w for n, w in zip(nu, frequencies, strict=True))) for nu in harmonics.tolist()]


def bond_cosines(N: int) -> list[float]:
    """cos(k pi / 2N) for k = 0 .. 4N-1, correctly rounded."""
    with mpmath.workdps(SPLIT_DIGITS):
        return [float(mpmath.cospi(mpmath.mpf(k) / (2 * N))) for k in range(4 * N)]


def bond_norm(N: int) -> float:
    """sqrt(2/N), correctly rounded."""
    with mpmath.workdps(SPLIT_DIGITS):
        return float(mpmath.sqrt(mpmath.mpf(2) / N))


def blocks_or_zero(program: TorusProgram) -> tuple[Block, ...]:
    """The blocks of a torus; one with a coefficient of zero for a torus at rest, which has none."""
    zero = Block((1,), np.zeros((1, len(program.seeds)), dtype=np.int64), np.zeros((1, 1)))
    return program.blocks or (zero,)


def _check(torus: QuasiPeriodic) -> Check:
    """Test vectors of the stored coefficients, evaluated with more digits than these have."""
    places = 17 if torus.digits is None else torus.digits
    exact = replace_digits(torus, places + EXTRA_DIGITS)
    period = 2 * np.pi / min(float(w) for w in torus.frequencies)
    times = [round(n * period * 64) / 64 for n in CHECK_PERIODS]  # the same number in decimal and in binary
    Q, P = exact.positions(times), exact.momenta(times)
    with MULTIPRECISION.context(places + EXTRA_DIGITS):
        H = exact.chain.energy(Q, P)

    def rows(values: Numbers) -> tuple[tuple[str, ...], ...]:
        return tuple(tuple(text(x, places + 2) for x in row) for row in values)

    return Check(tuple(map(repr, times)), rows(Q), rows(P), tuple(text(h, places + 2) for h in H))


def replace_digits(torus: QuasiPeriodic, digits: int) -> FourierTorus:
    """The same coefficients, to be evaluated with so many digits."""
    with MULTIPRECISION.context(digits):
        cosines = np.asarray(_EXACT(torus.cosines), dtype=object)
        phases = {q: mpmath.mpf(phi) for q, phi in torus.phases.items()}
    return FourierTorus(torus.chain, torus.seeds, torus.frequencies, torus.harmonics, cosines, phases, digits)


_EXACT = np.frompyfunc(mpmath.mpf, 1, 1)  # a double is the number it is here, not its shortest decimal
