"""An unstable breather.

Floquet multipliers of an exact one-mode motion: a complex quadruple has left the circle.
"""

from symfpu import Chain, breather_at_amplitude, floquet

found = floquet(breather_at_amplitude(Chain(6, alpha="0.5"), 3, "1"))
print(found)
found.plot()
