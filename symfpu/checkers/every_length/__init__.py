"""Independent checker of the theorem for every N: Python integers and fractions only.

It finds the hyperplanes m.q = 2 w N and all flats again, takes a seed set of its own where the
certificate says nothing of a flat, and decides each once more: by sums of seeds that fold with one
sign, by chains of couplings, by the signs of the products of couplings, by residues that the
recursion of `propagation` computes again, or by couplings that are zero. The theorems that
make these proofs are in docs/propagation.md. The folder shares no code with the prover and imports
nothing but the standard library, the checker of certificates of one N and what checkers read with,
`reading.py`.
"""

from symfpu.checkers.every_length.claim import Theorem as Theorem
from symfpu.checkers.every_length.claim import read_claim as read_claim
from symfpu.checkers.every_length.deciding import check_flat as check_flat
from symfpu.checkers.every_length.evidence import read_evidence as read_evidence
from symfpu.checkers.every_length.reading import FORMAT as FORMAT
from symfpu.checkers.every_length.reading import read_theorem as read_theorem
from symfpu.checkers.every_length.theorem import check_theorem as check_theorem
from symfpu.checkers.every_length.theorem import sentence as sentence
from symfpu.checkers.every_length.theorem import verify as verify
