"""Iterative refinement on linear equations whose solution is known as fractions."""

from fractions import Fraction

import numpy as np
import pytest

from symfpu.refinement import iterative_refinement
from symfpu.refinement.iterative_refinement import Failure, Problem, converge
from tests.refinement.test_digits import unheard

BITS = 400


class Equations(Problem):
    """A x + b z = d for four coefficients x and one frequency z, with x_1 = 1 held: an integer matrix, Jacobian in doubles."""

    MATRIX = np.array([[3, 1, 4, 1], [5, 9, 2, 6], [5, 3, 5, 8], [9, 7, 9, 3]], dtype=object)
    COLUMN = np.array([2, 7, 1, 8], dtype=object)
    RIGHT = np.array([1, 0, 2, -1], dtype=object)

    def __init__(self, factor=1.0):
        self.factor, self.bits = factor, BITS
        self.coefficients = np.zeros((4, 1), dtype=object)
        self.coefficients[0, 0] = 1 << BITS
        self.frequencies = np.zeros(1, dtype=object)
        self.mask = np.ones((4, 1), dtype=bool)
        self.largest, self.frequency_scale = 1 << BITS, 1.0
        self.reached = []

    def residual(self):
        return (self.MATRIX @ self.coefficients[:, 0] + self.COLUMN * self.frequencies[0] - (self.RIGHT << BITS))[:, None]

    def solve(self, residual, conditions):
        columns = np.column_stack([self.MATRIX[:, 1:], self.COLUMN]).astype(float)
        change = -self.factor * np.linalg.solve(columns, residual[:, 0])
        return np.append(0.0, change[:-1])[:, None], change[-1:]

    def after_step(self, digits):
        self.reached.append(digits)


def exact():
    """By Gauss and Jordan in fractions."""
    rows = [
        [Fraction(int(x)) for x in (*row[1:], z, r - row[0])]
        for row, z, r in zip(Equations.MATRIX, Equations.COLUMN, Equations.RIGHT, strict=True)
    ]
    for i in range(4):
        pivot = next(k for k in range(i, 4) if rows[k][i])
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for k in range(4):
            if k != i:
                rows[k] = [x - rows[k][i] * y for x, y in zip(rows[k], rows[i], strict=True)]
    return [row[-1] for row in rows]


def errors(problem):
    found = [*problem.coefficients[1:, 0], problem.frequencies[0]]
    return [abs(Fraction(int(x), 1 << BITS) - y) for x, y in zip(found, exact(), strict=True)]


@pytest.mark.parametrize("digits", [20, 60, 100])
def test_the_digits_that_were_asked_for_are_those_of_the_fractions(digits):
    """And no more steps than double precision needs for them."""
    problem = Equations()
    converge(problem, digits, unheard)
    assert max(errors(problem)) < Fraction(1, 10**digits)
    assert problem.coefficients[0, 0] == 1 << BITS
    assert problem.steps <= 2 + digits / 13
    gained = np.diff(problem.reached)
    assert gained.min() > 13


def test_a_rough_jacobian_needs_more_steps():
    """Half of each step is left by a Jacobian that is twice as large."""
    problem = Equations(0.5)
    converge(problem, 20, unheard)
    assert max(errors(problem)) < Fraction(1, 10**20)
    assert problem.steps > 60


@pytest.mark.parametrize(("factor", "reason"), [(0.0, "stops at a residual or update of 1e"), (2.5, "stops at a residual or update of 1e")])
def test_a_wrong_jacobian_fails(factor, reason):
    """One that asks for no change, and one whose steps grow."""
    with pytest.raises(Failure, match=reason):
        converge(Equations(factor), 20, unheard)


def test_a_singular_jacobian_fails(monkeypatch):
    monkeypatch.setattr(Equations, "COLUMN", 0 * Equations.COLUMN)
    with pytest.raises(Failure, match="the Jacobian is singular"):
        converge(Equations(), 20, unheard)


def test_too_few_steps_fail(monkeypatch):
    monkeypatch.setattr(iterative_refinement, "MOST_STEPS", 3)
    with pytest.raises(Failure, match=r"update of 1e-[1-9]"):
        converge(Equations(), 60, unheard)


def test_steps_are_reported_with_their_residuals():
    heard = []
    converge(Equations(), 30, lambda label, fraction: heard.append(label))
    assert heard[0].startswith("step 1: residual 1e")
    assert heard[1].startswith("step 2: residual 1e-1")
