"""Exact orbits to which truncated series are compared."""
