"""Other potentials.

Tori of the same seeds in an alpha chain, a Toda chain and one of Lennard-Jones, at equal $c_3 A$.
"""

from symfpu import Chain, plots, torus

chains = {
    "alpha": Chain(16, alpha="0.33"),
    "Toda": Chain(16, potential="toda:0.33"),
    "Lennard-Jones": Chain(16, potential="lj:12,6"),
}
sizes = {
    name: 0.3 / abs(float(chain.potential.coefficient(3))) for name, chain in chains.items()
}
tori = [
    torus(chains[name], (1, 2), amplitudes={1: A, 2: A / 2}) for name, A in sizes.items()
]
plots.spectrum(tori, labels=list(chains))
