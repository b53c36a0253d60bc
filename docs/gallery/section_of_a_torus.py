"""Section of a torus.

The torus seen once a period of mode 1: a closed curve for every mode.
"""

from symfpu import Chain, lindstedt, plots, solve_amplitudes

chain = Chain(N=16, alpha="0.33")
series = lindstedt(chain, seeds=(1, 2), frequencies=("0.19626", "0.39046"), order=12)
plots.section(solve_amplitudes(series), modes=(2, 3, 4))
