"""The dimension of a torus.

Alignment indices of an orbit on a 2-torus: $G_2$ stays, $G_k$ falls as $t^{2-k}$.
"""

from symfpu import Chain, alignment_indices, lindstedt, refine, solve_amplitudes

chain = Chain(N=8, alpha="0.5")
series = lindstedt(chain, seeds=(2, 5), frequencies=("0.762367", "1.658939"), order=6)
torus = refine(solve_amplitudes(series))
found = alignment_indices(chain, torus.Q(0.0), torus.P(0.0), 1e5, samples=200, frames=1)
print(found.dimension())
found.plot()
