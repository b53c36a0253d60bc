"""An unstable breather.

Floquet multipliers of an exact one-mode motion: a complex quadruple has left the circle.
"""

from symfpu import Chain, floquet, torus

found = floquet(torus(Chain(6, alpha="0.5"), (3,), amplitudes={3: "1"}))
print(found)
found.plot()
