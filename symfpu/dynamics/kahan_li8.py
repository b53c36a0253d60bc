"""The symmetric composition of order 8 of 17 leapfrog steps on T + V, symplectic and reversible.

W. Kahan and R.-C. Li, Math. Comp. 66 (1997) 1089, "s17odr8a". A leapfrog step of length g h is a
drift of g h/2, a kick of g h, a drift of g h/2; drifts that meet are one. For modes of Omega = 2
the error is about 2e-7 a unit of time at steps of 0.25, and 4e-14 at steps of 0.05.
"""

from __future__ import annotations

import itertools

from symfpu.dynamics.scheme import Scheme, palindrome

KICKS = palindrome(
    (
        0.13020248308889008087881763,
        0.56116298177510838456196441,
        -0.38947496264484728640807860,
        0.15884190655515560089621075,
        -0.39590389413323757733623154,
        0.18453964097831570709183254,
        0.25837438768632204729397911,
        0.29501172360931029887096624,
        -0.60550853383003451169892108,
    ),
    middle=True,
)
_ENTRY = KICKS[0] / 2
_BETWEEN = tuple((left + right) / 2 for left, right in itertools.pairwise(KICKS))

KAHAN_LI8 = Scheme(
    name="kahan_li8",
    order=8,
    splitting="T + V",
    source="W. Kahan and R.-C. Li, Math. Comp. 66 (1997) 1089, s17odr8a",
    drifts=(_ENTRY, *_BETWEEN, _ENTRY),
    kicks=KICKS,
)
