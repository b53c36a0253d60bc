"""The rule of propagation, refuted.

Which mode is excited at which order: the rule of the paper, and what a proof by exact arithmetic found for two seeds
of the beta chain.
"""

from symfpu import prove_propagation

proof = prove_propagation(8, seeds=(1, 4), order=3, model="beta")
print(proof)
proof.plot()
