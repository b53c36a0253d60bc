"""Amplitudes that settle.

The frequencies are chosen; the amplitudes follow from the frequency series, cut at order $K$. They settle as
$K$ grows.
"""

from symfpu import Chain, amplitude_history, lindstedt

chain = Chain(N=16, alpha="0.33")
series = lindstedt(chain, seeds=(1, 2), frequencies=("0.19626", "0.39046"), order=18)
history = amplitude_history(series)
print(history)
history.plot()
