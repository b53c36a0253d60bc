"""The spectrum of a torus.

Two modes carry the torus of Fig. 1 of the paper; the others follow, group by group: $D_k$ is excited at order $k$.
"""

from symfpu import Chain, lindstedt, solve_amplitudes

chain = Chain(N=16, alpha="0.33")
series = lindstedt(chain, seeds=(1, 2), frequencies=("0.19626", "0.39046"), order=12)
torus = solve_amplitudes(series)
print(torus)
torus.plot()
