"""Torus in three dimensions.

A 2-torus in the space of three coordinates.
"""

from symfpu import Chain, lindstedt, plots, solve_amplitudes

chain = Chain(N=16, alpha="0.33")
series = lindstedt(chain, seeds=(1, 2), frequencies=("0.19626", "0.39046"), order=12)
plots.torus(solve_amplitudes(series))
