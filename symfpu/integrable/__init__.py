"""The Toda chain, solved by its spectral curve: an oracle that shares no code with the series.

`lax` has Flaschka's matrices and the gaps of a state, `discriminant` the polynomial with given
heights of its gaps, `curve` actions and frequencies, `inverse` a state from its spectrum, `torus`
tori with the gaps of the seeds alone, which `search` finds, `invariants` all of it for a state.
"""
