"""What the theorems are about: a chain, frequencies, a torus and the directions of a frame."""

from fractions import Fraction
from typing import Any, NamedTuple

from symfpu.checkers.reading import MOST_BITS, Json, fraction, fractions, need, whole
from symfpu.checkers.torus.budget import Budget, budget_of
from symfpu.checkers.torus.series import Harmonic, Row, Series

LARGEST_N, MOST_ANGLES = 128, 4
MOST_HARMONICS, HIGHEST_HARMONIC = 300_000, 2000
HIGHEST_DEGREE = 40


class Claim(NamedTuple):
    """What the theorems are about: a chain, frequencies, a torus by particle 1 .. N-1.

    couplings : of V'(r) - r by power of r. budget : the steps that its check may take.
    """

    N: int
    couplings: dict[int, Fraction]
    seeds: list[int]
    omega: Row
    torus: list[Series]
    budget: Budget

    @property
    def angles(self) -> int:
        return len(self.seeds)


class Direction(NamedTuple):
    """x of a column of the frame with its rate sigma; twist : (domega), () of normal ones."""

    rate: Fraction
    twist: Row
    x: list[Series]


def read_claim(data: Json) -> Claim:
    """The claim, its sizes bounded."""
    N = whole(data["N"], 3, LARGEST_N, "N")
    couplings = read_couplings(data["coefficients"])
    seeds, rates = data["seeds"], data["omega"]
    whole(len(seeds), 1, min(MOST_ANGLES, N - 1), "the number of seeds")
    need(len(set(seeds)) == len(seeds) == len(rates), "as many frequencies as seeds")
    for q in seeds:
        whole(q, 1, N - 1, "a seed")
    omega = [fraction(w, "omega") for w in rates]
    need(all(w > 0 for w in omega), "a frequency is not positive")
    bits = whole(data["bits"], 1, MOST_BITS, "bits")
    torus = read_series(data["torus"], bits, N, seeds, parity=0, even=True)
    check_angles(torus, len(seeds))
    return Claim(N, couplings, list(seeds), omega, torus, budget_of(data))


def check_angles(torus: list[Series], count: int) -> None:
    """Every angle moves a particle by a harmonic of its own: no point, and no torus of fewer."""
    for m in range(count):
        own = tuple(int(i == m) for i in range(count))
        need(any(x.values.get(own) for x in torus), f"nothing moves with the angle {m + 1}")


def read_couplings(texts: Any) -> dict[int, Fraction]:
    """V'(r) - r = c_3 r^2 + c_4 r^3 + ..., by power of r."""
    need(type(texts) is list and 0 < len(texts) <= HIGHEST_DEGREE, "wrong coefficients")
    values = fractions(texts, 1, "a coefficient of V")
    need(any(values), "the chain is harmonic")
    return {k: c for k, c in enumerate(values, 2) if c}


def read_series(
    rows: Any, bits: int, N: int, seeds: list[int], *, parity: int, even: bool
) -> list[Series]:
    """x_1 .. x_(N-1) of rows [nu, x_1 .. x_(N//2)]; the other particles by reflection.

    even : of cosines, from half of the harmonics.
    """
    whole(len(rows), 1, MOST_HARMONICS, "the number of harmonics")
    s, particles = len(seeds), [Series({}, bits) for _ in range(N - 1)]
    for row in rows:
        need(type(row) is list and len(row) == s + N // 2, "wrong length of a harmonic")
        nu = tuple(whole(n, -HIGHEST_HARMONIC, HIGHEST_HARMONIC, "nu") for n in row[:s])
        half = [whole(x, -(2**MOST_BITS), 2**MOST_BITS, "a coefficient") for x in row[s:]]
        sign = reflection(nu, seeds, parity)
        need(N % 2 or sign > 0 or not half[-1], "the middle particle breaks the symmetry")
        every = [*half, *(sign * x for x in reversed(half[: (N - 1) // 2]))]
        for at in {nu, tuple(-n for n in nu)} if even else {nu}:
            need(at not in particles[0].values, "a harmonic is there twice")
            for series, x in zip(particles, every, strict=True):
                series.values[at] = x
    return particles


def reflection(nu: Harmonic, seeds: list[int], parity: int) -> int:
    """x_(N-j) = +-x_j: all modes of a harmonic are odd, or all are even."""
    modes = sum(n * q for n, q in zip(nu, seeds, strict=True)) + parity
    return 1 if modes % 2 else -1


def read_directions(data: Json, claim: Claim) -> list[Direction]:
    """s directions of the actions, and N-1-s normal ones."""
    entries, s = data["directions"], claim.angles
    need(len(entries) == claim.N - 1, "there are not N - 1 directions")
    bits = whole(data["frame_bits"], 1, 256, "frame_bits")
    unit = 1 << whole(data["rate_bits"], 1, 256, "rate_bits")
    found = []
    for i, (mode, rate, twist, rows) in enumerate(entries):
        even = i < s
        need(type(twist) is list and len(twist) == (s if even else 0), "wrong twist")
        need(not even or rate == 0, "a direction of an action has a frequency")
        turns = [whole(x, -(2**300), 2**300, "the twist") for x in twist]
        parity = 0 if even else whole(mode, 1, claim.N - 1, "a mode")
        x = read_series(rows, bits, claim.N, claim.seeds, parity=parity, even=even)
        sigma = Fraction(whole(rate, -(2**300), 2**300, "a rate"), unit)
        found.append(Direction(sigma, [Fraction(t, unit) for t in turns], x))
    return found
