"""What the refinement of a torus needs, said before it is allocated.

By counting the arrays that are alive together in each part of a step: tables of all coefficients
(H, C), functions on the points of the lattice (bonds, P), the block of the preconditioner (m, m)
with its sparse couplings, the vectors of GMRES, and the angles at which the residual is taken.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import psutil

from symfpu.chain.chain import Chain
from symfpu.chain.projections.by_ends import count_columns, count_points
from symfpu.errors import TorusTooLarge
from symfpu.refinement.invariance import MOST_SLOPES, PORTION, InvarianceEquation
from symfpu.refinement.lattice import Floats, Ints, Lattice
from symfpu.refinement.linear_system import KRYLOV, SMALLEST_BLOCK, block_size
from symfpu.tori.columns import CHUNK
from symfpu.tori.torus import GRID_POINTS, angles_at_once, points_of_each_angle

DOUBLE = 8
# tables in long doubles and doubles that the search keeps, and those of a step beside them
TABLES, TABLES_OF_A_STEP = 16, 5
FUNCTIONS = 5  # on the points, of a portion of the bonds
MODES_BYTES = 72  # of two modes, in the tables of bonds and modes and of couplings
HARMONIC_BYTES = 600  # of the numbers of a harmonic in Python
COUPLED_MODES = 5  # that a harmonic of the slopes couples a mode to, at most about
COUPLING_BYTES = 84  # of one in all its forms, of which half go on
EXPONENTIAL = 72  # bytes of one, with what it is made of
# of a mode at one angle, where the residual is taken: on a ring, and with fixed ends by a Fourier
# transform of coordinates and what is linear in them
BYTES_AT_AN_ANGLE, TRANSFORMED_BYTES = 24, 72
# what an allocator holds beyond the arrays, and of them
KEPT_BYTES, KEPT_PART = 2**24, 1.2
LESS = 0.95
TABLES_OF_CANDIDATES = 4  # in doubles, where harmonics are chosen by forces


@dataclass(frozen=True)
class Sizes:
    """Of one refinement.

    harmonics, columns : H, C of the coefficients. unknowns : among them. bonds, points : of the
    functions on the lattice. block : unknowns that are solved for directly. angles : where the
    residual is taken, held at once. ring : whether by exponentials of all harmonics. candidates :
    coefficients of those among which the next harmonics are chosen.
    """

    harmonics: int
    columns: int
    unknowns: int
    bonds: int
    points: int
    block: int
    angles: int
    ring: bool
    candidates: int = 0

    def scaled(self, factor: float) -> Sizes:
        """With fewer harmonics, about."""
        return replace(
            self,
            harmonics=int(factor * self.harmonics),
            unknowns=int(factor * self.unknowns),
            points=int(factor * self.points),
            block=min(self.block, int(factor * self.unknowns)),
        )

    def bytes(self) -> int:
        """The most that is alive at once."""
        table = DOUBLE * self.harmonics * self.columns
        functions = DOUBLE * self.bonds * self.points
        portion = min(functions, DOUBLE * max(PORTION, self.points))
        kept = TABLES * table + HARMONIC_BYTES * self.harmonics + functions
        kept += MODES_BYTES * self.columns**2
        block = DOUBLE * self.block**2
        modes = min(self.columns, COUPLED_MODES)
        coupled = COUPLING_BYTES * 2 * MOST_SLOPES * self.block * modes
        spectra = functions + DOUBLE * self.points * (self.columns + 2)
        step = TABLES_OF_A_STEP * table + FUNCTIONS * portion
        vectors = (KRYLOV + 6) * DOUBLE * self.unknowns
        residual = TRANSFORMED_BYTES * self.angles * self.columns
        if self.ring:
            at_once = min(self.angles, max(1, CHUNK // max(1, self.harmonics)))
            residual = EXPONENTIAL * at_once * self.harmonics
            residual += BYTES_AT_AN_ANGLE * self.angles * self.columns
        parts = (
            2 * block + coupled + spectra,
            block + coupled // 2 + vectors + step,
            residual,
            TABLES_OF_CANDIDATES * DOUBLE * self.candidates,
        )
        return KEPT_BYTES + int(KEPT_PART * (kept + max(parts)))


def least_sizes(chain: Chain, harmonics: Ints, separated: Ints | None = None) -> Sizes:
    """Before the equations are made: with the smallest block, and what symmetry leaves unknown."""
    count, s = harmonics.shape
    columns = count_columns(chain)
    halves = (not chain.periodic) + bool(chain.potential.even)
    unknowns = columns * count // 2**halves
    angles = points_of_each_angle(GRID_POINTS, s) ** s
    return Sizes(
        harmonics=count,
        columns=columns,
        unknowns=unknowns,
        bonds=count_points(chain),
        points=Lattice(harmonics, separated).points,
        block=min(SMALLEST_BLOCK, unknowns),
        angles=int(min(angles, angles_at_once(chain)) if chain.periodic else angles),
        ring=chain.periodic,
    )


def sizes_of(
    least: Sizes, equation: InvarianceEquation, cosines: Floats, shifts: Floats
) -> Sizes:
    """Of the first step from an iterate."""
    divisors = equation.divisors(shifts).astype(float)
    block = block_size(equation, divisors, equation.slopes(cosines))
    return replace(least, unknowns=int(equation.mask.sum()), block=block)


def require_memory(sizes: Sizes, chain: Chain) -> None:
    """TorusTooLarge for what does not fit into the free memory."""
    free = psutil.virtual_memory().available
    if (needed := sizes.bytes()) <= free:
        return
    fewer = sizes
    while fewer.harmonics and fewer.bytes() > free:
        fewer = fewer.scaled(LESS)
    raise TorusTooLarge(chain.N, sizes.harmonics, needed, free, fewer.harmonics)
