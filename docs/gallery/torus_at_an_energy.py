"""Tori at an energy.

From the energy instead of the frequencies: three tori of two equal amplitudes.
"""

from symfpu import Chain, plots, torus

chain = Chain(N=12, alpha="0.33")
energies = ("1e-4", "1e-3", "1e-2")
tori = [torus(chain, (1, 2), energy=E) for E in energies]
for found in tori:
    print([float(omega) for omega in found.frequencies])
plots.spectrum(tori, labels=[f"H = {E}" for E in energies])
