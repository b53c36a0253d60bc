"""What is typed for a series, checked: exact frequencies, numbers of digits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

from symfpu.errors import InputError
from symfpu.numbers.typed import Number, exact, integer

MOST_DIGITS = 5_000
SMALLEST, LARGEST = Fraction(1, 10**6), 10**6


def frequencies_of(
    frequencies: Sequence[Number] | Mapping[int, Number], seeds: tuple[int, ...]
) -> tuple[Fraction, ...]:
    """One exact positive number for each seed, in their order or by seed; raises InputError."""
    if isinstance(frequencies, Mapping):
        frequencies = _in_order(frequencies, seeds)
    if isinstance(frequencies, str) or not isinstance(frequencies, Iterable):
        allowed = "a sequence, one positive number for each seed"
        advice = "list them in the order of the seeds"
        raise InputError("frequencies", frequencies, allowed, advice)
    frequencies = list(frequencies)
    values = tuple(exact(w, "frequencies") for w in frequencies)
    if len(values) != len(seeds):
        typed = tuple(map(str, frequencies))
        allowed = f"one number for each of the seeds {seeds}"
        raise InputError("frequencies", typed, allowed, "add or drop some")
    for q, w, number in zip(seeds, values, frequencies, strict=True):
        if not SMALLEST <= w <= LARGEST:
            allowed = "a positive finite number (1e-6 to 1e6)"
            advice = "take one near the linear frequency"
            raise InputError(f"frequencies, omega_{q}", str(number), allowed, advice)
    return values


def _in_order(frequencies: Mapping[int, Number], seeds: tuple[int, ...]) -> list[Number]:
    """Those given by seed, in the order of the seeds."""
    if set(frequencies) != set(seeds):
        allowed = f"a number for each of the seeds {seeds}"
        raise InputError("frequencies", dict(frequencies), allowed, "name every seed once")
    return [frequencies[q] for q in seeds]


def digits_of(digits: int) -> int:
    """A number of digits; raises InputError."""
    if integer(digits, "digits", 1) > MOST_DIGITS:
        raise InputError("digits", digits, f"1..{MOST_DIGITS}", "take fewer")
    return int(digits)
