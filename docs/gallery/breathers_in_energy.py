"""Breathers in energy.

A family of breathers from the linear limit, with its events.
"""

from symfpu import Chain, family

found = family(Chain(8, alpha="0.3"), (1,), to_energy="0.05", multipliers=True)
print(found)
found.plot()
