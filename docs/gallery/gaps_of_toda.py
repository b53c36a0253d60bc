"""Gaps of Toda's curve.

A torus of the alpha chain through the spectral curve of the Toda chain: on a torus of Toda only the gaps of the seeds are open.
"""

from symfpu import Chain, lindstedt, solve_amplitudes, toda_invariants

chain = Chain(N=16, alpha="0.33")
series = lindstedt(chain, seeds=(1, 2), frequencies=("0.19626", "0.39046"), order=12)
torus = solve_amplitudes(series)
found = toda_invariants(chain, torus.Q(0.0), torus.P(0.0))
print(found)
found.plot()
