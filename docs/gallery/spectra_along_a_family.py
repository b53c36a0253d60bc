"""Spectra along a family.

The average energies of all modes as the energy of the family grows.
"""

from symfpu import Chain, family, plots

plots.family_spectra(family(Chain(8, alpha="0.3"), (1, 2), to_energy="0.002"))
