"""Tori: from a series to amplitudes, orbits and a verdict."""
