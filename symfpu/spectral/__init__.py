"""Lines in the spectra of orbits: frequency analysis."""
