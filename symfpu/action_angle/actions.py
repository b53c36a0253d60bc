"""The actions of a torus, in closed form.

An action is the integral of P dQ along the i-th angle over 2 pi. On an invariant torus it does not
depend on where the other angles stand, so it is the average over all of them of
sum_q P_q dQ_q/dtheta_i. With Q_q = sum c_q[nu] cos(nu.theta), P_q = -sum (nu.omega) c_q[nu]
sin(nu.theta), one nu of each pair +-nu, the average of sin^2 is 1/2:

    I_i = 1/2 sum over nu and q of nu_i (nu.omega) c_q[nu]^2.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from symfpu.algebra.grading import Ints
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Numbers, with_digits
from symfpu.numbers.public import public
from symfpu.tori.torus import Torus


@public
def actions(solution: Torus) -> dict[int, Any]:
    """The action of every angle, by seed: I_i = 1/2 sum nu_i (nu.omega) c_q[nu]^2.

    solution : any torus or breather, of fixed ends or of a ring; on a ring the coefficients of
        its waves. Dimensionless. For small amplitudes I_q = Omega_q A_q^2 / 2. Standing waves of
        a ring have twice that: two chains of half the length move.

    Doubles, or mpf that print the digits of the solution. The integral of P dQ along an angle,
    averaged over the others: exact on a torus, as close as the solution else. Ours. Raises
    InputError for what is no solution.

    >>> import symfpu
    >>> from symfpu import Chain
    >>> round(actions(symfpu.torus(Chain(8, beta=1), (1,), amplitudes={1: "0.4"}))[1], 9)
    0.031268297
    """
    if not isinstance(solution, Torus):
        allowed = "a solution: a torus or a breather"
        advice = "pass what solve_amplitudes or refine gave"
        raise InputError("solution", type(solution).__name__, allowed, advice)
    with solution.numbers.context(solution.digits):
        omega = [solution.numbers.number(w) for w in solution.frequencies]
        squares = (solution.cosines**2).sum(axis=1)
        found = half_weighted(solution.harmonics, np.array(omega), squares)
        found = 2 * found if solution.stands else found  # two chains of half the length
    return _by_seed(solution.seeds, with_digits(found, solution.digits))


def half_weighted(harmonics: Ints, omega: Numbers, squares: Numbers) -> Numbers:
    """1/2 sum of nu_i (nu.omega) times the squares (H,) of the harmonics (H, s); shape (s,)."""
    rates = harmonics @ omega
    return np.asarray(harmonics.T @ (rates * squares) / 2)


def _by_seed(seeds: tuple[int, ...], values: Numbers) -> dict[int, Any]:
    numbers = values.tolist() if values.dtype != object else list(values)
    return dict(zip(seeds, numbers, strict=True))
