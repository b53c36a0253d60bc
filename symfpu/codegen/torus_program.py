"""What every language is given: the numbers of a torus in an order that loops run through.

Q_q(t) = sum c_q[nu] cos(nu.(omega t + phi)). A harmonic appears in modes of one parity only, so
the harmonics fall into two blocks, each with the modes of its parity: half of the coefficients
are never stored, multiplied or added.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Ints
from symfpu.codegen.bond_potential import BondPotential, bond_potential
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers, text
from symfpu.numbers.typed import decimal
from symfpu.tori.torus import Torus

CHECK_PERIODS = (
    0.0,
    0.37,
    41.3,
)  # times of the test vectors, in periods of the slowest seed
DOUBLE_DIGITS = 17  # after which decimal text reads back as the same double
EXTRA_DIGITS = 5
TOLERANCE = 1e-13  # of the self-test, relative to the largest coordinate or momentum


@dataclass(frozen=True, eq=False)
class Block:
    """Harmonics of one parity. modes : (M,). harmonics : (H, s). coefficients : (H, M), c_q[nu]."""

    modes: tuple[int, ...]
    harmonics: Ints
    coefficients: Numbers


@dataclass(frozen=True, eq=False)
class Check:
    """Test vectors as decimal text.

    times : (T,). positions, momenta : (T, N-1). energies : (T,).
    """

    times: tuple[str, ...]
    positions: tuple[tuple[str, ...], ...]
    momenta: tuple[tuple[str, ...], ...]
    energies: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class TorusProgram:
    """A torus as data for a language. facts : what the header says, in order.

    couplings : alpha and beta of an FPU chain, None for another; bond : V of another, else None.
    """

    name: str
    facts: Mapping[str, str]
    N: int
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    phases: tuple[Any, ...]
    couplings: tuple[Fraction, Fraction] | None
    bond: BondPotential | None
    digits: int | None
    blocks: tuple[Block, ...] = field(repr=False)
    check: Check = field(repr=False)

    @property
    def fpu(self) -> bool:
        """Whether it is a torus of an FPU chain."""
        return self.couplings is not None

    @property
    def highest(self) -> tuple[int, ...]:
        """Largest |nu_i| of every seed."""
        harmonics = [block.harmonics for block in self.blocks]
        return highest_numbers(harmonics, len(self.seeds))


def torus_program(torus: Torus, name: str, facts: Mapping[str, str]) -> TorusProgram:
    """Order the numbers of a torus for code; facts come first in the header."""
    chain, seeds = torus.chain, torus.seeds
    blocks = _blocks(torus)
    digest = coefficient_hash(blocks)
    all_facts = {**facts, "hash of the coefficients": digest}
    phases = [torus.phases[q] for q in seeds]
    return TorusProgram(
        name=name,
        facts=all_facts,
        N=chain.N,
        seeds=seeds,
        frequencies=torus.frequencies,
        phases=tuple(phases),
        couplings=chain.couplings if chain.fpu else None,
        bond=bond_potential(chain),
        digits=torus.digits,
        blocks=tuple(blocks),
        check=_check(torus),
    )


def _blocks(torus: Torus) -> list[Block]:
    """Of both parities, as far as they have coefficients; harmonics without one are left out."""
    parities = torus.harmonics @ np.array(torus.seeds) % 2
    modes = np.arange(1, torus.chain.N)
    blocks = []
    for parity in (0, 1):
        columns = np.flatnonzero(modes % 2 == parity)
        rows = np.flatnonzero(parities == parity)
        coefficients = torus.cosines[np.ix_(rows, columns)]
        _require_parity(torus, rows, modes % 2 != parity)
        silent = (coefficients == 0).all(axis=1)
        if silent.all():
            continue
        own_modes = modes[columns].tolist()
        harmonics = torus.harmonics[rows[~silent]]
        block = Block(tuple(own_modes), harmonics, coefficients[~silent])
        blocks.append(block)
    return blocks


def _require_parity(torus: Torus, rows: Ints, others: NDArray[np.bool_]) -> None:
    """InputError where harmonics appear in modes of the other parity, beyond rounding."""
    largest = np.abs(torus.cosines).max(initial=0)
    strange = np.abs(torus.cosines[rows][:, others]).max(initial=0)
    if strange > TOLERANCE * largest:
        allowed = "harmonics nu in modes q with nu.seeds - q even, as equations of motion make them"
        raise InputError(
            "solution", f"a coefficient {float(strange):.2g}", allowed, "refine it first"
        )


def highest_numbers(harmonics: Sequence[Ints], s: int) -> tuple[int, ...]:
    """Largest |nu_i| of every seed among arrays of harmonics (H, s)."""
    none = np.zeros((1, s), dtype=np.int64)
    every = np.concatenate([none, *harmonics])
    largest = np.abs(every).max(axis=0)
    return tuple(largest.tolist())


def torus_facts(torus: Torus) -> dict[str, str]:
    """The header of a torus: chain, seeds, frequencies; exact numbers as they were typed."""
    seeds = map(str, torus.seeds)
    frequencies = map(decimal, torus.frequencies)
    return {
        "chain": repr(torus.chain),
        "seeds": ", ".join(seeds),
        "frequencies": ", ".join(frequencies),
        "precision": precision_text(torus.digits),
    }


def precision_text(digits: int | None) -> str:
    """Digits as a header names them."""
    return "doubles" if digits is None else f"{digits} digits"


def coefficient_hash(blocks: Iterable[Block]) -> str:
    """SHA-256 of harmonics and coefficients as decimal text."""
    digest = hashlib.sha256()
    for block in blocks:
        places = block.modes, block.harmonics.tolist()
        digest.update(repr(places).encode())
        digest.update(hashed_numbers(block.coefficients))
    return digest.hexdigest()


def hashed_numbers(values: Numbers) -> bytes:
    """The numbers of an array as a hash sees them."""
    return "\n".join(map(number, values.flat)).encode()


def number(value: Any, digits: int = DOUBLE_DIGITS) -> str:
    """A coefficient as decimal text: a double so that it reads back, an mpf to so many digits."""
    if isinstance(value, float):
        return repr(float(value))
    return text(value, digits)


def blocks_or_zero(program: TorusProgram) -> tuple[Block, ...]:
    """The blocks of a torus; a coefficient of zero for a torus at rest, which has none."""
    if program.blocks:
        return program.blocks
    harmonic = np.zeros((1, len(program.seeds)), dtype=np.int64)
    zero = np.zeros((1, 1))
    return (Block((1,), harmonic, zero),)


def _check(torus: Torus) -> Check:
    """Test vectors of the stored coefficients, evaluated with more digits than these have."""
    places = DOUBLE_DIGITS if torus.digits is None else torus.digits
    exact = replace_digits(torus, places + EXTRA_DIGITS)
    times = _check_times(torus)
    Q, P = exact.Q(times), exact.P(times)
    with MULTIPRECISION.context(places + EXTRA_DIGITS):
        H = exact.chain.energy(Q, P)
    positions = texts(Q, places + 2)
    momenta = texts(P, places + 2)
    (energies,) = texts(H[None], places + 2)
    return Check(tuple(map(repr, times)), positions, momenta, energies)


def texts(rows: Iterable[Iterable[Any]], digits: int) -> tuple[tuple[str, ...], ...]:
    """Numbers as decimal text."""
    table = []
    for row in rows:
        words = [text(x, digits) for x in row]
        table.append(tuple(words))
    return tuple(table)


def _check_times(torus: Torus) -> list[float]:
    """The same numbers in decimal and in binary."""
    slowest = min(map(float, torus.frequencies))
    period = 2 * np.pi / slowest
    times = [n * period for n in CHECK_PERIODS]
    return [round(t * 64) / 64 for t in times]


def replace_digits(torus: Torus, digits: int) -> Torus:
    """The same coefficients, to be evaluated with so many digits."""
    with MULTIPRECISION.context(digits):
        cosines = np.asarray(exact_numbers(torus.cosines), dtype=object)
        phases = {q: mpmath.mpf(phi) for q, phi in torus.phases.items()}
    same = torus.chain, torus.seeds, torus.frequencies, torus.harmonics
    return Torus(*same, cosines, phases, digits)


# A double is the number it is here, not its shortest decimal.
exact_numbers = np.frompyfunc(mpmath.mpf, 1, 1)
