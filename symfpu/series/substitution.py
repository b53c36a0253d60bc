"""Numbers for the symbols of a universal series: multipliers L_q(nu) and couplings.

Each arithmetic gives the values of all leaves of the program; the program does the rest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import flint
import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.formulas import Coupling, Multiplier, NodeTable
from symfpu.algebra.grading import Ints
from symfpu.algebra.program import Program
from symfpu.algebra.program_values import tabled, values_in, values_in_doubles
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.words import IntegerTable
from symfpu.chain.chain import Chain
from symfpu.errors import ResonantDivisor, SymfpuError
from symfpu.series.divisors import Divisors, vanishes
from symfpu.series.tables import LOG10_2

Floats = NDArray[np.float64]
Tables = Sequence[Any]

FIRST_GUARD = 20  # digits beyond the promised ones at the first attempt
MOST_BITS = 2**20
EPS = 2.0**-50


class Leaves(NamedTuple):
    """The multipliers that first appear at an order.

    numbers : places of their symbols, (L,). modes, harmonics : (L,), (L, s).
    """

    numbers: Ints
    modes: Ints
    harmonics: Ints


def multipliers_by_order(program: Program, degree_step: int) -> dict[int, Leaves]:
    """The multipliers of a program by the order at which their harmonic can first appear."""
    rows: dict[int, list[tuple[int, int, tuple[int, ...]]]] = {}
    for number, symbol in enumerate(program.symbols):
        if isinstance(symbol, Multiplier):
            length = sum(map(abs, symbol.harmonic))
            order = max(1, -(-(length - 1) // degree_step))
            rows.setdefault(order, []).append((number, symbol.mode, symbol.harmonic))
    found = {}
    for order in sorted(rows):
        numbers, modes, harmonics = zip(*rows[order], strict=True)
        found[order] = Leaves(np.array(numbers), np.array(modes), np.array(harmonics))
    return found


def leaves_in_doubles(
    program: Program, chain: Chain, space: CosineModes, divisors: Divisors, order: int
) -> Floats:
    """Values of the symbols, (symbols, 1), order by order as the recursion takes them.

    Raises ResonantDivisor.
    """
    numbers = {symbol: number for number, symbol in enumerate(program.symbols)}
    values = np.empty((len(numbers), 1))
    for k in range(1, order + 1):
        degree = 1 + chain.degree_step * k
        harmonics, _ = space.grading.harmonics(degree)
        table = divisors.multipliers(harmonics, space.mask_by_harmonic(degree), k)
        for row, column in np.argwhere(table).tolist():
            symbol = Multiplier(column + 1, tuple(harmonics[row].tolist()))
            if symbol in numbers:
                values[numbers[symbol], 0] = table[row, column]
    for number, value in couplings_of(program, chain):
        values[number, 0] = float(value)
    return values


def couplings_of(program: Program, chain: Chain) -> Iterator[tuple[int, Fraction]]:
    """The places of the couplings among the symbols, and their values in a chain."""
    for number, symbol in enumerate(program.symbols):
        if isinstance(symbol, Coupling):
            yield number, chain.relative_couplings(symbol.power)[symbol.power]


def tables_in_doubles(tables: Tables, leaves: Floats) -> list[Floats]:
    """Tables of nodes in doubles; leaves : (symbols, points) to (..., points)."""
    program = tables[0].program
    values = values_in_doubles(program, leaves)
    return [tabled(values, table.nodes) for table in tables]


def sampled_leaves(
    program: Program,
    chain: Chain,
    seeds: Sequence[int],
    frequencies: Floats,
    relative: Floats | None,
) -> Floats:
    """Values of the symbols at many points, (symbols, points).

    frequencies : (points, s). relative : of the second coupling of an FPU chain, (points,); None
    takes the couplings of the chain. Divisors are taken in long doubles. Raises ResonantDivisor
    for one that is zero in them.
    """
    values = np.empty((len(program.symbols), len(frequencies)))
    linear = np.array(
        [np.longdouble(str(chain.linear_frequency(q))) for q in range(1, chain.N)]
    )
    chosen = frequencies.astype(np.longdouble)
    for order, leaves in multipliers_by_order(program, chain.degree_step).items():
        own = np.broadcast_to(
            linear[leaves.modes - 1, None], (len(leaves.modes), len(chosen))
        )
        base = own.copy()
        for i, q in enumerate(seeds):
            base[leaves.modes == q] = chosen[:, i]
        drive = np.abs(leaves.harmonics.astype(np.longdouble) @ chosen.T)
        divisors = (base - drive) * (base + drive)
        if not divisors.all():
            place, _ = np.argwhere(divisors == 0)[0]
            nu = tuple(leaves.harmonics[place].tolist())
            raise ResonantDivisor(int(leaves.modes[place]), nu, seeds, order, exact=True)
        values[leaves.numbers] = own * own / divisors
    for number, value in couplings_of(program, chain):
        values[number] = float(value) if relative is None else relative
    return values


# balls


class Certified(NamedTuple):
    """Tables of integers in units of 2^-bits, and their radii in the same units."""

    tables: list[IntegerTable]
    radii: list[Floats]
    bits: int


def certified_tables(
    tables: Tables,
    chain: Chain,
    seeds: Sequence[int],
    omega: Sequence[Fraction],
    digits: int,
) -> Certified:
    """Tables of nodes to so many digits of the largest entry of each, proved by balls.

    Raises ResonantDivisor; SymfpuError where more digits than MOST_BITS allow were lost.
    """
    bits = int((digits + FIRST_GUARD) / LOG10_2)
    while bits < MOST_BITS:
        with flint.ctx.workprec(bits):
            leaves = leaves_in_balls(tables[0].program, chain, seeds, omega, bits)
            balls = [values_in(table.program, leaves, table.nodes) for table in tables]
        found = [
            _rounded(table, values, bits)
            for table, values in zip(tables, balls, strict=True)
        ]
        if all(_precise(table, radii, digits) for table, radii in found):
            whole, radii = map(list, zip(*found, strict=True))
            return Certified(whole, radii, bits)
        bits *= 2
    raise SymfpuError(
        f"{digits} digits need more than {MOST_BITS} bits; take a lower order"
    )


def leaves_in_balls(
    program: Program,
    chain: Chain,
    seeds: Sequence[int],
    omega: Sequence[Fraction],
    bits: int,
) -> list[Any]:
    """Values of the symbols as balls that hold them, at the precision of flint's context."""
    chosen = [flint.arb(flint.fmpq(w.numerator, w.denominator)) for w in omega]
    leaves: list[Any] = [None] * len(program.symbols)
    for order, found in multipliers_by_order(program, chain.degree_step).items():
        for number, mode, harmonic in zip(*(part.tolist() for part in found), strict=True):
            own = 2 * flint.arb.sin_pi_fmpq(flint.fmpq(mode, 2 * chain.N))
            base = chosen[seeds.index(mode)] if mode in seeds else own
            drive = sum(
                (n * w for n, w in zip(harmonic, chosen, strict=True)), flint.arb(0)
            )
            divisor = (base - drive) * (base + drive)
            if divisor.contains(0):
                exact = vanishes(chain, seeds, omega, mode, harmonic)
                raise ResonantDivisor(mode, tuple(harmonic), seeds, order, exact=exact)
            leaves[number] = own * own / divisor
    for number, value in couplings_of(program, chain):
        leaves[number] = flint.arb(flint.fmpq(value.numerator, value.denominator))
    return leaves


def _rounded(
    table: NodeTable, balls: NDArray[np.object_], bits: int
) -> tuple[IntegerTable, Floats]:
    """Midpoints in units of 2^-bits, and radii that cover the rounding."""
    integers = np.zeros(balls.size, dtype=object)
    radii = np.zeros(balls.size)
    for place, ball in enumerate(balls.ravel()):
        if isinstance(ball, int):
            integers[place] = ball << bits
            continue
        mantissa, exponent = map(int, ball.mid().man_exp())
        shift = exponent + bits
        integers[place] = mantissa << shift if shift >= 0 else mantissa >> -shift
        radius, power = map(int, ball.rad().man_exp())
        radii[place] = np.ldexp(float(radius), power + bits) * (1 + EPS) + (shift < 0)
    whole = IntegerTable.of(integers.reshape(table.shape))
    return whole, radii.reshape(table.shape)


def _precise(table: IntegerTable, radii: Floats, digits: int) -> bool:
    """Whether all radii are below so many digits of the largest entry."""
    largest = float(np.abs(table.floats()).max(initial=0.0))
    return float(radii.max(initial=0.0)) <= largest * 10.0**-digits or not radii.any()
