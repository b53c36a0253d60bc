"""Where a torus passes the singularity of its series: by a determinant, and by the series themselves."""

from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, lindstedt, refine
from symfpu.borders.fold import _determinant, sheet_of
from symfpu.borders.newton_end import NewtonEnd, RefinedPoint
from symfpu.borders.point import _radius
from tests.tolerances import FOLD_RADIUS, SHEET_DETERMINANT

CHAIN = Chain(8, alpha=1)
FOLD = 0.1227  # H of the fold of seed 1, to 1 %
ORDER = 64
GRID = 256  # angles


LEAST, STEP = 1e-4, 1.2


@cache
def walked(steps):
    """The breather of seed 1 by so many steps from the linear chain."""
    if steps == 0:
        return refine(symfpu.torus(CHAIN, (1,), energy=str(LEAST), method="series", order=8), energy=str(LEAST))
    return refine(walked(steps - 1), energy=f"{LEAST * STEP**steps:.10g}", tolerance=1e-10)


@cache
def followed(energy):
    """The breather with this energy."""
    before = walked(int(np.log(energy / LEAST) / np.log(STEP)))
    return refine(before, energy=f"{energy:.10g}", tolerance=1e-10)


def radius(torus) -> float:
    """By the last terms of a long series at the frequency of the torus, in units of its own mu."""
    series = lindstedt(CHAIN, (1,), torus.frequencies, ORDER)
    amplitude = float(torus.amplitudes[1])
    sizes = {}
    for k in range(1, ORDER + 1):
        _, values = series.harmonic_terms([amplitude], k)
        sizes[k] = float(np.abs(values * CHAIN.frequencies()).max())
    return _radius(sizes, ORDER, 2)


@pytest.mark.long
def test_the_radius_touches_one_at_the_fold():
    at_fold = radius(followed(FOLD))
    assert abs(at_fold - 1) < FOLD_RADIUS
    below, above = radius(followed(0.5 * FOLD)), radius(followed(2 * FOLD))
    assert below > 1 + 10 * FOLD_RADIUS
    assert above > 1 + 10 * FOLD_RADIUS


def range_matrix(torus):
    """The derivative, over the divisors, by differences of the forces on a grid, and its unknowns, all in real Fourier space."""
    (seed,) = torus.seeds
    chain, count = torus.chain, torus.harmonics.shape[0]
    nu = torus.harmonics[:, 0]
    theta = 2 * np.pi * np.arange(GRID) / GRID
    cosines = np.cos(np.outer(theta, nu))
    back = 2 * cosines.T / GRID
    back[nu == 0] /= 2
    omega = float(torus.frequencies[0])
    linear = chain.frequencies()

    def forces(coefficients):
        Q = cosines @ coefficients
        return back @ (chain.accelerations(Q) + linear**2 * Q)

    every = 1 if chain.alpha else 2  # where V is even, harmonics are odd
    unknown = [(k, q) for k in range(count) for q in range(chain.N - 1) if (q + 1 - nu[k] * seed) % 2 == 0 and (every == 1 or nu[k] % 2)]
    unknown.remove((int(np.flatnonzero(nu == 1)[0]), seed - 1))
    step = 1e-6
    matrix = np.zeros((len(unknown), len(unknown)))
    for j, (k, q) in enumerate(unknown):
        moved = np.zeros((count, chain.N - 1))
        moved[k, q] = step
        change = (forces(torus.cosines + moved) - forces(torus.cosines - moved)) / (2 * step)
        for i, (row, mode) in enumerate(unknown):
            matrix[i, j] = change[row, mode]
    divisors = np.array([(nu[k] * omega) ** 2 - linear[q] ** 2 for k, q in unknown])
    # accelerations plus the linear part are minus the nonlinear force
    return (np.diag(-divisors) - matrix) / -divisors[:, None], unknown


@pytest.mark.parametrize(("part", "sign"), [(0.5, 1), (0.95, 1), (1.05, -1), (2.0, -1)])
def test_the_sign_changes_at_the_fold(part, sign):
    """The determinant by differences has the same sign, and the same size."""
    torus = followed(part * FOLD)
    sheet = sheet_of(torus)
    assert (sheet.mode, sheet.harmonic) == (2, (2,))
    by_differences, logarithm = np.linalg.slogdet(range_matrix(torus)[0])
    assert sheet.sign == by_differences == sign
    assert abs(sheet.logarithm - logarithm) < SHEET_DETERMINANT


@pytest.mark.parametrize(("chain", "seed", "energy"), [(Chain(8, beta=1), 1, "0.05"), (Chain(8, beta=1), 3, "0.5")], ids=repr)
def test_the_coefficient_of_the_weakest_direction_is_that_of_the_eigenvector(chain, seed, energy):
    """By all eigenvectors of the derivative by differences; too few steps of inverse iteration named harmonic 7."""
    torus = refine(symfpu.torus(chain, (seed,), energy=energy), energy=energy, tolerance=1e-8)
    matrix, unknown = range_matrix(torus)
    values, vectors = np.linalg.eig(matrix)
    sizes = np.abs(vectors[:, np.argmin(np.abs(values))])
    row, column = unknown[np.argmax(sizes)]
    sheet = sheet_of(torus)
    assert (sheet.mode, sheet.harmonic) == (column + 1, tuple(torus.harmonics[row].tolist()))


def test_a_coefficient_that_is_not_sure_is_not_named(monkeypatch):
    """Two that are equally large, and a direction that does not settle."""
    turned = np.array([[1.0, 1.0], [-1.0, 1.0]]) / np.sqrt(2)
    for eigenvalues, expected in (((0.01, 1.0), None), ((1.0, -1.0), None)):
        matrix = turned @ np.diag(eigenvalues) @ turned.T
        assert _determinant(matrix)[2] is expected
    assert _determinant(np.diag([0.5, 0.01]))[2] == 1


def test_too_many_coefficients_are_said(monkeypatch):
    monkeypatch.setattr("symfpu.borders.fold.MOST_UNKNOWNS", 10)
    torus = followed(0.5 * FOLD)
    assert sheet_of(torus) is None
    end = NewtonEnd("left", 1.0, (RefinedPoint(0.5 * FOLD, torus),), {})
    assert end.record("fold")["none"].startswith("not looked for")
