"""Small chains on which slow and fast routes are compared: every model, parity and number of seeds, and wrapped modes."""

from typing import NamedTuple


class Case(NamedTuple):
    name: str
    N: int
    alpha: str
    beta: str
    seeds: tuple
    frequencies: tuple
    order: int


SHALLOW = (
    Case("alpha, one seed", 6, "0.25", "0", (1,), ("0.52",), 6),
    Case("alpha, odd N, wrapped", 5, "1/3", "0", (3,), ("1.63",), 6),
    Case("alpha, two seeds", 5, "0.4", "0", (1, 2), ("0.63", "1.19"), 4),
    Case("alpha, two high seeds, negative", 6, "-0.3", "0", (4, 5), ("1.74", "1.94"), 4),
    Case("alpha, three seeds", 5, "0.5", "0", (1, 3, 4), ("0.62", "1.61", "1.91"), 3),
    Case("beta, one seed", 6, "0", "0.3", (1,), ("0.53",), 4),
    Case("beta, wrapped, negative", 5, "0", "-0.3", (4,), ("1.89",), 4),
    Case("beta, two seeds", 5, "0", "0.7", (1, 2), ("0.64", "1.2"), 2),
    Case("beta, three seeds", 4, "0", "0.7", (1, 2, 3), ("0.78", "1.43", "1.87"), 1),
    Case("both, one seed", 5, "0.3", "0.2", (2,), ("1.18",), 5),
    Case("both, two seeds, negative alpha", 4, "-0.3", "0.2", (1, 3), ("0.77", "1.85"), 4),
    Case("beta, two bonds", 2, "0", "0.5", (1,), ("1.45",), 4),
    Case("both, two bonds", 2, "0.5", "0.5", (1,), ("1.45",), 6),
    Case("alpha, two bonds", 2, "0.5", "0", (1,), ("1.45",), 3),
)

# Expanded polynomials in the multipliers grow fast with the order: these are compared as numbers only.
DEEP = (
    Case("alpha, order 12", 9, "0.33", "0", (1,), ("0.36",), 12),
    Case("beta, order 6", 8, "0", "0.33", (1,), ("0.41",), 6),
    Case("alpha, two low seeds", 8, "0.33", "0", (1, 2), ("0.4", "0.79"), 6),
    Case("both, three seeds", 7, "0.33", "0.1", (2, 3, 6), ("0.88", "1.26", "1.96"), 4),
    Case("beta, three spread seeds", 8, "0", "0.33", (1, 2, 5), ("0.4", "0.79", "1.68"), 2),
    Case("alpha, four seeds", 9, "0.3", "0", (1, 2, 3, 4), ("0.36", "0.70", "1.02", "1.31"), 3),
)

CASES = SHALLOW + DEEP
