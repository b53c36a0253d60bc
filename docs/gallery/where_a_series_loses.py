"""Where a series loses.

The largest coefficients of the torus of Fig. 1 by order and harmonic. The harmonic that grows is $5\\theta_1 - 4\\theta_2$.
"""

from symfpu import Chain, lindstedt, plots, solve_amplitudes

chain = Chain(N=16, alpha="0.33")
series = lindstedt(chain, seeds=(1, 2), frequencies=("0.19626", "0.39046"), order=24)
plots.coefficients(solve_amplitudes(series))
