"""Localization: laws of the energy profile, spectra of orbits."""
