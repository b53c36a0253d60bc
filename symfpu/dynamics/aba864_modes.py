"""The scheme ABA864 on harmonic + anharmonic, in mode space: what it was made for, since the anharmonic kicks are small.

Kicks are products of cosine polynomials by their coefficients (symfpu.dynamics.orbit_loops): they obey the selection rules, a mode
that no product feeds stays exactly zero, and tail modes keep their relative accuracy. A kick costs about N^2 where T + V costs N.
"""

from __future__ import annotations

from symfpu.dynamics.aba864 import DRIFTS, KICKS, SOURCE
from symfpu.dynamics.scheme import Scheme

ABA864_MODES = Scheme(name="aba864_modes", order=4, splitting="harmonic + anharmonic", source=SOURCE, drifts=DRIFTS, kicks=KICKS)
