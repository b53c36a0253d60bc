"""The recurrence of Fermi, Pasta and Ulam.

All energy in mode 1; it spreads over a few modes, and comes back.
"""

import numpy as np

from symfpu import Chain, fpu_trajectory, integrate, packet_amplitudes, plots, recurrence

chain = Chain(32, alpha="0.33")
start = fpu_trajectory(chain, packet_amplitudes(chain, (1,), "0.014915"))
orbit = integrate(chain, *start, 15000, step=0.5, samples=np.arange(0, 15001, 20))
print(recurrence(orbit.times, orbit.harmonic_energies()))
plots.time_series(orbit, quantity="E", modes=(1, 2, 3, 4))
