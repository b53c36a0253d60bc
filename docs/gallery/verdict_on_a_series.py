"""Verdict on a series.

How well the equations of motion are met, by the order at which the coordinates are cut, and a verdict in a word.
"""

from symfpu import Chain, assess, lindstedt, solve_amplitudes

chain = Chain(N=16, alpha="0.33")
series = lindstedt(chain, seeds=(1, 2), frequencies=("0.19626", "0.39046"), order=20)
found = assess(series, solve_amplitudes(series))
print(found.verdict, *found.reasons, sep="\n- ")
found.plot()
