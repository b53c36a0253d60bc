"""A q-breather.

A torus of one angle: a periodic orbit carried by mode 25 of 32 bonds, that of Fig. 8 of the paper.
"""

from symfpu import Chain, torus

orbit = torus(Chain(32, alpha="0.33"), (25,), frequencies=("1.8830741847088537",))
print(orbit)
orbit.plot()
