"""Tori at an energy.

From the energy instead of the frequencies: three tori of two equal amplitudes.
"""

from symfpu import Chain, plots, torus_at_energy

chain = Chain(N=12, alpha="0.33")
energies = ("1e-4", "1e-3", "1e-2")
tori = [torus_at_energy(chain, (1, 2), E, harmonic=False, order=6) for E in energies]
for torus in tori:
    print([float(omega) for omega in torus.frequencies])
plots.spectrum(tori, labels=[f"H = {E}" for E in energies])
