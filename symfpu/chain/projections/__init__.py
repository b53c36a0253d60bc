"""How the ends of a chain project coefficients of harmonics onto its bonds, and back."""
