"""What a series needs, said before it is allocated."""

from __future__ import annotations

import bisect
import math
from collections.abc import Sequence

import psutil

from symfpu.algebra.dense import predicted_bytes
from symfpu.algebra.program_ring import predicted_bytes as program_bytes
from symfpu.algebra.residue import PRIME_BITS
from symfpu.chain.chain import Chain, require_any_chain, require_fixed_ends
from symfpu.errors import InputError, TooLarge
from symfpu.numbers.public import public
from symfpu.numbers.typed import order_of
from symfpu.series.arguments import digits_of
from symfpu.series.force import highest_power, stored_powers
from symfpu.series.rings import RINGS
from symfpu.series.tables import LOG10_2

# digits, an order and at most, for the prediction of memory only
EXPECTED_GUARD, EXPECTED_LOSS, MOST_EXPECTED = 20, 0.7, 60
# series in doubles that the stages before and after a fixed-point series hold, with their radii
OTHER_STAGES = 6
CONSTANT_BYTES = 2**24
MOST_WORK = 10**15  # multiply-adds, which take ten days
# degree 0 in a phantom seed, or 1 with either sign: three times the monomials of the others, five
# times their pairs with such a product
PHANTOM_FACTOR = 5


def check_size(
    chain: Chain,
    seeds: tuple[int, ...],
    order: int,
    ring: str,
    digits: int = 0,
    *,
    phantom: bool = False,
) -> None:
    """Refuse an order whose arrays would not fit, before anything is allocated.

    phantom : whether the first seed's amplitude is needed to its first power only.
    """
    free = psutil.virtual_memory().available
    full, factor = (len(seeds) - 1, PHANTOM_FACTOR) if phantom else (len(seeds), 1)

    def needed(k: int) -> int:
        return factor * _needed(chain, full, k, ring, digits)

    def work(k: int) -> int:
        return factor * _multiply_adds(chain, full, k)

    if needed(order) > free:
        largest = bisect.bisect_right(range(order), free, key=needed) - 1
        raise TooLarge(order, needed(order), free, largest)
    if work(order) > MOST_WORK:
        largest = bisect.bisect_right(range(order), MOST_WORK, key=work) - 1
        allowed = f"what takes {MOST_WORK:.0e} multiply-adds ({work(order):.1e} are needed)"
        raise InputError("order", order, allowed, f"take order {largest} or less")


@public
def series_bytes(
    chain: Chain, seeds: Sequence[int], order: int, *, digits: int | None = None
) -> int:
    """The bytes that `lindstedt` needs at most with frequencies given, known before it starts.

    chain, seeds, order, digits : as of `lindstedt`; N is a number. Of `sweep` its argument memory.
    A bound of the arrays, by their closed form: the program itself is not in it. Ours.

    Raises InputError for arguments out of range.

    >>> series_bytes(Chain(N=32, alpha=1), (1, 2, 3, 4), 8)
    24715984
    """
    count, last = len(require_any_chain(chain).seeds_of(seeds)), order_of(order)
    if digits is None:
        return _needed(chain, count, last, "float64", 0)
    require_fixed_ends(chain)
    return _needed(chain, count, last, "fixedpoint", digits_of(digits))


def _multiply_adds(chain: Chain, seeds: int, order: int) -> int:
    """Of one product of two series, about: pairs of monomials, each on half of the bonds."""
    degree = 1 + chain.degree_step * order
    return math.comb(degree + 4 * seeds, 4 * seeds) * (_bonds(chain) // 2)


def _bonds(chain: Chain) -> int:
    """N, or 2 on a ring: one column and one value stand for all."""
    return 2 if chain.periodic else chain.N


def _needed(chain: Chain, seeds: int, order: int, ring: str, digits: int) -> int:
    degree = 1 + chain.degree_step * order
    powers = stored_powers(chain, degree, grows=RINGS[ring].grows)
    size = predicted_bytes(_bonds(chain), seeds, degree, powers=powers)
    if ring == "fixedpoint":
        guard = EXPECTED_GUARD + min(EXPECTED_LOSS * order, MOST_EXPECTED)
        bits_of_products = (digits + guard) / LOG10_2 * 2
        primes = math.ceil(bits_of_products / (PRIME_BITS - 2))
        return CONSTANT_BYTES + size * (primes + OTHER_STAGES)
    if RINGS[ring].program:
        highest = highest_power(chain, degree)
        return size + program_bytes(chain.N, seeds, degree, chain.degree_step, highest)
    return size
