"""Expressions as potentials: their text, their Taylor series, the laws of their bonds."""
