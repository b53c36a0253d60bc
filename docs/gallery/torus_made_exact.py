"""A torus made exact.

Newton's method starts at the truncated series and meets the equations of motion to rounding.
"""

from symfpu import Chain, lindstedt, plots, refine, solve_amplitudes

chain = Chain(N=8, alpha="0.5")
series = lindstedt(chain, seeds=(2, 5), frequencies=("0.762367", "1.658939"), order=6)
torus = solve_amplitudes(series)
exact = refine(torus)
print(
    f"residual {torus.residual():.1e} by the series, {exact.residual():.1e} by Newton's method"
)
plots.spectrum([torus, exact], labels=["order 6", "exact"])
