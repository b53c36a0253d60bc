"""Where a torus passes the singularity of its series: by a determinant, and by the series themselves."""

from functools import lru_cache

import numpy as np
import pytest

from symfpu import Chain, lindstedt, refine_at_energy, torus_at_energy
from symfpu.borders.fold import sheet_of
from symfpu.borders.newton_end import NewtonEnd, RefinedPoint
from symfpu.borders.point import _radius
from tests.tolerances import FOLD_RADIUS, SHEET_DETERMINANT

CHAIN = Chain(8, alpha=1)
FOLD = 0.1227  # H of the fold of seed 1, to 1 %
ORDER = 64
GRID = 256  # angles


@lru_cache
def followed(energy: float):
    """The breather of seed 1 with this energy, by small steps from the linear chain."""
    H = 1e-4
    torus = refine_at_energy(torus_at_energy(CHAIN, (1,), str(H), order=8), str(H), harmonic=False)
    while energy > H:
        H = min(1.2 * H, energy)
        torus = refine_at_energy(torus, f"{H:.10g}", harmonic=False, tolerance=1e-10)
    return torus


def radius(torus) -> float:
    """By the last terms of a long series at the frequency of the torus, in units of its own mu."""
    series = lindstedt(CHAIN, (1,), torus.frequencies, ORDER)
    amplitude = float(torus.amplitudes[1])
    sizes = {}
    for k in range(1, ORDER + 1):
        _, values = series.harmonic_terms([amplitude], k)
        sizes[k] = float(np.abs(values * CHAIN.frequencies()).max())
    return _radius(sizes, ORDER, 2)


@pytest.mark.parametrize(("part", "sign"), [(0.5, 1), (0.95, 1), (1.05, -1), (2.0, -1)])
def test_the_sign_changes_at_the_fold(part, sign):
    sheet = sheet_of(followed(part * FOLD))
    assert sheet.sign == sign
    assert (sheet.mode, sheet.harmonic) == (2, (2,))


@pytest.mark.long
def test_the_radius_touches_one_at_the_fold():
    at_fold = radius(followed(FOLD))
    assert abs(at_fold - 1) < FOLD_RADIUS
    below, above = radius(followed(0.5 * FOLD)), radius(followed(2 * FOLD))
    assert below > 1 + 10 * FOLD_RADIUS
    assert above > 1 + 10 * FOLD_RADIUS


def range_determinant(torus):
    """Sign of the determinant by differences of the forces on a grid, all in real Fourier space."""
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

    unknown = [(k, q) for k in range(count) for q in range(chain.N - 1) if (nu[k] + q + 1) % 2 == 0]
    unknown.remove((int(np.flatnonzero(nu == 1)[0]), 0))
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
    sign, logarithm = np.linalg.slogdet((np.diag(-divisors) - matrix) / -divisors[:, None])
    return sign, logarithm


@pytest.mark.parametrize("part", [0.5, 0.95, 1.05, 2.0])
def test_the_determinant_by_differences(part):
    torus = followed(part * FOLD)
    sheet = sheet_of(torus)
    sign, logarithm = range_determinant(torus)
    assert sheet.sign == sign
    assert abs(sheet.logarithm - logarithm) < SHEET_DETERMINANT


def test_too_many_coefficients_are_said(monkeypatch):
    monkeypatch.setattr("symfpu.borders.fold.MOST_UNKNOWNS", 10)
    torus = followed(0.5 * FOLD)
    assert sheet_of(torus) is None
    end = NewtonEnd("left", 1.0, (RefinedPoint(0.5 * FOLD, torus),), {})
    assert end.record("fold")["none"].startswith("not looked for")
