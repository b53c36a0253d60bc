"""A universal series modulo a prime: its program, node by node, in FLINT's residues."""

import flint
import numpy as np

from symfpu.algebra.program_values import values_in
from symfpu.algebra.residue import cosine_table
from symfpu.errors import VanishingResidue
from symfpu.series.substitution import couplings_of, multipliers_by_order


def coordinates_modulo(series, point):
    """The tables of coordinates at a `ResiduePoint`, as doubles in -p/2 .. p/2. Raises VanishingResidue."""
    program, prime = series.coordinates[0].program, point.prime
    leaves = residues_of_symbols(program, series, point)
    return [centered(values_in(program, leaves, table.nodes), prime) for table in series.coordinates]


def residues_of_symbols(program, series, point):
    chain, prime, omega = series.chain, point.prime, point.frequencies
    cosines = cosine_table(chain.N, prime, point.root)
    leaves = [None] * len(program.symbols)
    for order, found in multipliers_by_order(program, chain.degree_step).items():
        for number, mode, harmonic in zip(*(part.tolist() for part in found), strict=True):
            own = (2 - 2 * cosines[2 * mode]) % prime
            base = omega[series.seeds.index(mode)] ** 2 if mode in series.seeds else own
            drive = sum(n * w for n, w in zip(harmonic, omega, strict=True))
            divisor = (base - drive * drive) % prime
            if divisor == 0:
                raise VanishingResidue(prime, order)
            leaves[number] = flint.nmod(own, prime) / flint.nmod(divisor, prime)
    for number, value in couplings_of(program, chain):
        leaves[number] = flint.nmod(value.numerator, prime) / flint.nmod(value.denominator, prime)
    return leaves


def centered(values, prime):
    whole = np.array([int(value) % prime for value in values.ravel()], dtype=np.int64)
    return np.where(whole > prime // 2, whole - prime, whole).reshape(values.shape).astype(np.float64)
