"""Tori as points of the curve of their family: all coefficients, and the tangent of the family.

A torus continues another one if both fit one cubic with all their coefficients and tangents, by
the rule of `symfpu.breathers.curve`. Energies, amplitudes and frequencies alone may be those of
another family.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from symfpu.action_angle.newton_twist import equation_of
from symfpu.breathers.curve import unlike
from symfpu.refinement.conditions import Condition
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.lattice import Floats, Ints
from symfpu.refinement.linear_system import Jacobian, NewtonState
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import NoTorus
from symfpu.tori.torus import Torus

SAME = 1e-6  # of the size: tori that are nearer are one


@dataclass(frozen=True, eq=False)
class Whole:
    """A torus of a family: its coefficients, and their derivatives along the family.

    torus : the torus. harmonics : (H, s). cosines, tangent : (H, C); the tangent has length 1 and
    either direction.
    """

    torus: Torus[Newton]
    harmonics: Ints
    cosines: Floats
    tangent: Floats


def whole(torus: Torus[Newton], conditions: Sequence[Condition]) -> Whole:
    """A torus with the tangent along which the first condition changes, and the others hold.

    Raises NoTorus where the family has no single tangent.
    """
    equation, table = equation_of(torus)
    cosines, shifts = table.astype(np.longdouble), shifts_of(torus)
    try:
        with np.errstate(divide="ignore", invalid="ignore"):
            state = NewtonState(equation, conditions, cosines, shifts)
            changes, _ = Jacobian(state).responses(1)
    except (np.linalg.LinAlgError, ValueError) as failure:
        reason = f"the tangent of the family is not determined ({failure})"
        raise NoTorus(reason, torus, torus.residual()) from failure
    tangent = changes[0] / np.linalg.norm(changes[0])
    return Whole(torus, equation.harmonics, cosines.astype(float), tangent)


def require_one_curve(*members: Whole, towards: Whole | None = None) -> None:
    """NoTorus unless these tori, in order, lie on one smooth piece of a curve.

    towards : a torus before the first; without one the way goes from the first to the last.
    """
    harmonics = _all_harmonics([*members, *([towards] if towards else [])])
    points = [_spread(harmonics, m.harmonics, m.cosines) for m in members]
    tangents = [_spread(harmonics, m.harmonics, m.tangent) for m in members]
    before = _spread(harmonics, towards.harmonics, towards.cosines) if towards else None
    forward = points[-1] - points[0] if before is None else points[0] - before
    for k, tangent in enumerate(tangents):
        forward = tangents[k] = tangent if tangent @ forward >= 0 else -tangent

    def name(place: int) -> str:
        row, column = divmod(place, members[0].cosines.shape[1])
        nu = ",".join(map(str, harmonics[row]))
        modes = members[0].torus.chain.mode_numbers
        of_mode = (
            f" of mode {modes[column]}" if len(modes) == len(members[0].cosines[0]) else ""
        )
        return f"harmonic ({nu}){of_mode}"

    size = max(float(np.abs(point).max()) for point in points)
    pairs = pairwise(zip(points, tangents, strict=True))
    for (start, end), found in zip(pairs, members[1:], strict=True):
        if float(np.linalg.norm(end[0] - start[0])) < SAME * size:
            continue
        if reason := unlike(start, end, name):
            raise NoTorus(reason, found.torus, found.torus.residual())


def _all_harmonics(members: Sequence[Whole]) -> list[tuple[int, ...]]:
    """Those of any of the tori."""
    return sorted({tuple(nu) for m in members for nu in m.harmonics.tolist()})


def _spread(harmonics: list[tuple[int, ...]], known: Ints, table: Floats) -> Floats:
    """A table at other harmonics, 0 where it has none, as one row."""
    rows = {tuple(nu): row for nu, row in zip(known.tolist(), table, strict=True)}
    nothing = np.zeros(table.shape[1])
    return np.concatenate([rows.get(nu, nothing) for nu in harmonics])
