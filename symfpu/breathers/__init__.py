"""Periodic orbits: harmonic balance, many digits, Floquet multipliers."""
