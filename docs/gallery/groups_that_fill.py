"""Groups that fill.

An FPU-trajectory starts in modes 1 to 4; the modes of $D_1$, $D_2$, ... receive energy one group after the other.
"""

import matplotlib.pyplot as plt

from symfpu import (
    Chain,
    excitation_sequence,
    fpu_trajectory,
    integrate,
    normalised_averages,
    packet_amplitudes,
)

chain = Chain(32, alpha="0.33")
start = fpu_trajectory(chain, packet_amplitudes(chain, (1, 2, 3, 4), "1.8e-4"))
orbit = integrate(chain, *start, 1e4, step=0.5, scheme="aba864_modes", averages=True)
shares = normalised_averages(orbit)
ax = plt.subplots()[1]
for k, group in enumerate(excitation_sequence(32, (1, 2, 3, 4), 4)):
    lines = ax.loglog(orbit.times[1:], shares[1:, [q - 1 for q in group]], color=f"C{k}")
    lines[0].set_label(f"$D_{k}$")
ax.set(xlabel="$t$", ylabel=r"$\overline{E}_q(t)/E$", ylim=(1e-26, 10))
ax.legend(ncols=5)
