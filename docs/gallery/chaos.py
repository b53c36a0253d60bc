"""Chaos.

The estimate of the Lyapunov exponent settles on a chaotic orbit, and falls as $\\log t/t$ on a regular one.
"""

import matplotlib.pyplot as plt

from symfpu import Chain, alignment_indices, fpu_trajectory, packet_amplitudes

chain = Chain(N=8, beta=1)
ax = plt.subplots()[1]
for energy in ("0.1", "5"):
    start = fpu_trajectory(chain, packet_amplitudes(chain, (1, 2, 3), energy))
    found = alignment_indices(chain, *start, 3e3, step=0.1, frames=1)
    print(f"E = {energy}: {found.dimension().verdict}")
    ax.loglog(found.times, abs(found.lyapunov), label=f"E = {energy}")
ax.set(xlabel="$t$", ylabel=r"$\log|v(t)|/t$")
ax.legend()
