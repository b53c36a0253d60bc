"""Waves on a ring.

Two travelling waves on a ring of 32 particles: one to the right, one to the left.
"""

import numpy as np

from symfpu import Chain, lindstedt, plots, solve_amplitudes

ring = Chain(32, alpha="0.33", ends="periodic")
wave = solve_amplitudes(lindstedt(ring, (2, -3), ("0.3902", "0.5807"), order=6))
print(wave)
plots.space_time(wave, times=np.linspace(0, 100, 201))
