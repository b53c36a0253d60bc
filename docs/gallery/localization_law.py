"""A law of localization.

The profile of an FPU-trajectory, a line fitted to it, and the law of section 6.1.
"""

import matplotlib.pyplot as plt
import numpy as np

from symfpu import (
    Chain,
    fit_profile,
    fpu_trajectory,
    integrate,
    packet_amplitudes,
    profile_law,
)

chain, s, epsilon = Chain(64, alpha="0.33"), 8, "1.5625e-8"
start = fpu_trajectory(chain, packet_amplitudes(chain, range(1, s + 1), "1e-6"))
E = integrate(
    chain, *start, 1e3, step=1.0, scheme="aba864_modes", samples=1, averages=True
).averages[-1]
fit, law = (
    fit_profile(chain, E, s, power=2.0, floor=0),
    profile_law(chain, s, float(epsilon)),
)
print(fit, law, sep="\n")
kappa = np.arange(1, 64) / 64
ax = plt.subplots()[1]
ax.plot(kappa, np.log10(E / E.sum()), "o", label="average energies")
ax.plot(kappa[s:], fit.line(kappa[s:]), label="fitted line")
ax.plot(kappa[s:], law(kappa[s:]), ":", label="law")
ax.set(xlabel=r"$\kappa = q/N$", ylabel=r"$\log_{10} e_\kappa$")
ax.legend()
