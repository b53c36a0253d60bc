"""Sums of cosines on a tensor grid of angles, all points at once by a Fourier transform."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Ints

Floats = NDArray[np.float64]


def grid_sums(harmonics: Ints, coefficients: Floats, number: int) -> Floats:
    """sum over nu of c[nu] cos(nu.theta) at theta_i = 2 pi (3 d_i + 1) / (3 number); (P, M).

    harmonics : (H, s). coefficients : (H, M). number : of points for each angle, P = number^s, in
    the order of `np.ndindex`. Harmonics that agree modulo the number are one on the grid.

    >>> import numpy as np
    >>> theta = 2 * np.pi * (3 * np.arange(2) + 1) / 6
    >>> grid_sums(np.array([[1], [3]]), np.array([[2.0], [1.0]]), 2).ravel().round(9) + 0.0
    array([0., 0.])
    >>> (2 * np.cos(theta) + np.cos(3 * theta)).round(9) + 0.0
    array([0., 0.])
    """
    from scipy.sparse import csr_array

    count, s = harmonics.shape
    shape = (number,) * s
    thirds = harmonics.sum(axis=1) % (3 * number)
    turns = np.exp(2j * np.pi * thirds / (3 * number))
    places = np.ravel_multi_index(tuple((harmonics % number).T), shape)
    folding = csr_array((turns, (places, np.arange(count))), shape=(number**s, count))
    folded = (folding @ coefficients).reshape(*shape, -1)
    sums = np.fft.ifftn(folded, axes=range(s), norm="forward")
    return np.asarray(sums.real.reshape(number**s, -1))
