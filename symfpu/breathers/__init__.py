"""Periodic orbits: harmonic balance, many digits, shooting, Floquet multipliers."""
