"""Compiled: the recursion of `packet_sums` on the subsets of r factors, all signs at once.

The values of a subset for all 2^(r-1) patterns of signs, the last one +, lie side by side, so that
products of subsets are products of vectors: for r = 7 eight to sixteen registers each.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.compiled import compiled

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Ways = tuple[Integers, Integers, Floats, Integers]


@compiled(error_model="numpy")
def squares_of_products(
    seeds: Integers,
    turned: bool,
    s: int,
    frequencies: Floats,
    ways: Ways,
    least_pairs: int,
    tolerance: float,
    keys: Integers,
    meeting: Floats,
) -> Any:
    """Sum over rows and signs of (1 + (nu/Omega_q)^2) c^2 without its share of equal arrangements.

    seeds : (rows, r); turned : whether the last one is subtracted, in all ways. frequencies :
        Omega_0 .. . ways : subsets as bits, ascending in size; the first way of each and the end;
        couplings; parts of two factors and more (ways, most): places among the subsets, or -1.
    least_pairs : of opposite factors that other products may have, too; then what they add up to
        is written: keys (rows with such pairs times signs,), meeting (the same, 3): c / same
        arrangements, the share of c^2, the weight.

    Returns the sum, how many were written, and whether a divisor was below the tolerance.
    """
    rows, r = seeds.shape
    patterns, full = 1 << (r - 1), (1 << r) - 1
    signs = sign_patterns(r)
    rates = np.zeros((full + 1, patterns))
    found = np.ones((len(ways[0]), patterns))
    values, term = np.empty(patterns), np.empty(patterns)
    modes, net = np.zeros(full + 1, dtype=np.int64), np.empty(r, dtype=np.int64)
    total, written = 0.0, 0
    for row in range(rows):
        own = seeds[row]
        add_up_rates(rates, frequencies, own, signs)
        values[:] = 0.0
        for column in range(r - 1, -1, -1):
            if turned and own[column] != own[r - 1]:
                continue
            add_up_modes(modes, own, column if turned else -1)
            least = run_recursion(found, term, modes, rates, frequencies, ways)
            if least < tolerance:
                return total, written, True
            values += found[len(found) - 1]
            if not turned:
                break
        linear = frequencies[abs(modes[full])] ** 2
        alike, pairs = equal_factors(own)
        for k in range(patterns):
            weight = 1.0 + rates[full, k] ** 2 / linear
            square = values[k] ** 2 / alike
            if alike == 1.0:
                total += 2.0 * weight * square
                continue
            same, cancelled, held = left_over(own, signs[:, k], net)
            total += 2.0 * weight * square / same
            if pairs >= least_pairs and cancelled >= least_pairs:
                keys[written] = key_of(net, held, s)
                meeting[written, 0] = values[k] / alike
                meeting[written, 1] = square / same
                meeting[written, 2] = weight
                written += 1
    return total, written, False


@compiled()
def sign_patterns(r: int) -> Floats:
    """Of r factors, the last one +; (r, 2^(r-1))."""
    signs = np.ones((r, 1 << (r - 1)))
    for i in range(r - 1):
        for k in range(signs.shape[1]):
            signs[i, k] = 1.0 - 2.0 * ((k >> i) & 1)
    return signs


@compiled()
def add_up_rates(rates: Floats, frequencies: Floats, own: Integers, signs: Floats) -> None:
    """nu of every subset with every pattern of signs."""
    r, patterns = signs.shape
    for i in range(r):
        step = frequencies[own[i]]
        for subset in range(1 << i):
            for k in range(patterns):
                rates[(1 << i) | subset, k] = rates[subset, k] + step * signs[i, k]


@compiled()
def add_up_modes(modes: Integers, own: Integers, subtracted: int) -> None:
    """m of every subset, one factor subtracted, or none (-1)."""
    for i in range(len(own)):
        step = -own[i] if i == subtracted else own[i]
        for subset in range(1 << i):
            modes[(1 << i) | subset] = modes[subset] + step


@compiled(fastmath={"contract"}, error_model="numpy")
def run_recursion(
    found: Floats,
    term: Floats,
    modes: Integers,
    rates: Floats,
    frequencies: Floats,
    ways: Ways,
) -> float:
    """U of every subset; the least divisor over Omega^2."""
    subsets, first_way, couplings, parts = ways
    patterns, least = len(term), np.inf
    for place in range(len(subsets)):
        if first_way[place] == first_way[place + 1]:
            continue  # one factor, U = 1
        target = found[place]
        target[:] = 0.0
        for way in range(first_way[place], first_way[place + 1]):
            g, a, b = couplings[way], parts[way, 0], parts[way, 1]
            if b >= 0:
                multiplied(term, found, g, parts[way])
                for k in range(patterns):
                    target[k] += term[k]
            elif a >= 0:
                for k in range(patterns):
                    target[k] += g * found[a, k]
            else:
                for k in range(patterns):
                    target[k] += g
        squared = frequencies[abs(modes[subsets[place]])] ** 2
        nearest = divided(target, rates[subsets[place]], squared)
        least = min(least, nearest / squared)
    return least


@compiled(fastmath={"contract"})
def multiplied(term: Floats, found: Floats, g: float, parts: Integers) -> None:
    """g times the product of two or more parts."""
    a, b = parts[0], parts[1]
    for k in range(len(term)):
        term[k] = g * found[a, k] * found[b, k]
    for i in range(2, len(parts)):
        if parts[i] >= 0:
            c = parts[i]
            for k in range(len(term)):
                term[k] *= found[c, k]


@compiled(fastmath={"contract", "nnan", "nsz"}, error_model="numpy")
def divided(target: Floats, rates: Floats, squared: float) -> float:
    """The target times -Omega^2 / (Omega^2 - nu^2); the least |Omega^2 - nu^2|."""
    least = np.inf
    for k in range(len(target)):
        divisor = squared - rates[k] * rates[k]
        least = min(least, abs(divisor))
        target[k] *= -squared / divisor
    return least


@compiled()
def equal_factors(own: Integers) -> tuple[float, int]:
    """The product of m! over numbers m of equal factors, and how many pairs can be taken out."""
    alike, pairs = 1.0, 0
    for i in range(len(own)):
        earlier = 0
        for j in range(i + 1):
            if own[j] == own[i]:
                earlier += 1
        alike *= earlier
        pairs += 1 - earlier % 2
    return alike, pairs


@compiled()
def left_over(own: Integers, signs: Floats, net: Integers) -> tuple[float, int, int]:
    """The product of m! over equal factors of one sign, the pairs of opposite ones, and how many
    factors are left once those are gone, which are written to `net`.
    """
    same, cancelled, held = 1.0, 0, 0
    for i in range(len(own)):
        plus = minus = 0
        for j in range(i + 1):
            if own[j] == own[i]:
                plus += signs[j] > 0
                minus += signs[j] < 0
        positive = signs[i] > 0
        same *= plus if positive else minus
        if (minus >= plus) if positive else (plus >= minus):
            # the opposite of an earlier one, which is taken back
            cancelled += 1
            for k in range(held):
                if abs(net[k]) == own[i]:
                    held -= 1
                    net[k] = net[held]
                    break
        else:
            net[held] = own[i] if positive else -own[i]
            held += 1
    return same, cancelled, held


@compiled()
def key_of(net: Integers, held: int, s: int) -> int:
    """Of factors in any order: the larger number whose digits are they, or their opposites."""
    for i in range(1, held):
        x, j = net[i], i
        while j and net[j - 1] > x:
            net[j] = net[j - 1]
            j -= 1
        net[j] = x
    forth = back = 0
    for i in range(held):
        forth = forth * (2 * s + 2) + net[i] + s + 1
        back = back * (2 * s + 2) - net[held - 1 - i] + s + 1
    return max(forth, back)


@compiled()
def rows_that_meet(seeds: Integers, least_pairs: int) -> int:
    """How many rows have so many pairs of equal factors."""
    count = 0
    for row in range(len(seeds)):
        _, pairs = equal_factors(seeds[row])
        count += pairs >= least_pairs
    return count
