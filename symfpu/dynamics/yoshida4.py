"""Yoshida's scheme of order 4, the one of the paper: three leapfrog steps.

The middle one goes backwards.

H. Yoshida, Phys. Lett. A 150 (1990) 262, Eq. 4.5 with weights of Eq. 2.11: x_1 = 1/(2 - 2^(1/3)),
x_0 = 1 - 2 x_1.
"""

from __future__ import annotations

from symfpu.dynamics.scheme import Scheme, palindrome

OUTER_STEP = 1 / (2 - 2 ** (1 / 3))
MIDDLE_STEP = 1 - 2 * OUTER_STEP

YOSHIDA4 = Scheme(
    name="yoshida4",
    order=4,
    splitting="T + V",
    source="H. Yoshida, Phys. Lett. A 150 (1990) 262",
    drifts=palindrome((OUTER_STEP / 2, (OUTER_STEP + MIDDLE_STEP) / 2), middle=False),
    kicks=(OUTER_STEP, MIDDLE_STEP, OUTER_STEP),
)
