"""Exponentials and logarithms inside compiled loops: errors against mpmath, ends of their ranges, the same bits one by one and as lanes."""

import math

import mpmath
import numpy as np
import pytest

from symfpu.chain import bond_loops  # noqa: F401
from symfpu.compiled import compiled
from symfpu.numbers import functions
from symfpu.numbers.exponentials import expm1_loop, log1p_loop
from symfpu.numbers.lanes import LANES, entry, put, zeros
from tests.tolerances import PLACES_OF_EXPONENTIALS

COUNT = 2000
LARGEST = math.log(np.finfo(float).max)  # of which e^x is finite
LOOPS = {"expm1": expm1_loop, "log1p": log1p_loop}


def made(name):
    function = getattr(functions, name)

    @compiled(error_model="numpy", keep=False)
    def loop(rows, out):
        for j in range(len(rows)):
            put(out, j, function(entry(rows, j)))

    return loop


@pytest.fixture(scope="module")
def compiled_loops():
    return {name: made(name) for name in LOOPS}


def uniform(least, most):
    return np.random.default_rng(1).uniform(least, most, COUNT)


def powers(least, most, sign=1):
    return sign * 10.0 ** uniform(least, most)


def halves():
    """Where the whole part of x / log 2 changes, and their neighbours."""
    middle = (np.arange(-99, 1024) + 0.5) * math.log(2)
    x = np.concatenate([middle, np.nextafter(middle, np.inf), np.nextafter(middle, -np.inf)])
    return x[x <= LARGEST]


def roots():
    """Where 1 + x is sqrt(2) times a power of two, and their neighbours."""
    middle = 2.0 ** (np.arange(-40, 900) + 0.5) - 1
    return np.concatenate([middle, np.nextafter(middle, np.inf), np.nextafter(middle, -np.inf)])


CASES = [
    ("expm1", uniform(-1, 1)),
    ("expm1", uniform(0.34, 0.36)),
    ("expm1", uniform(-60, 60)),
    ("expm1", uniform(-800, -30)),
    ("expm1", uniform(30, LARGEST)),
    ("expm1", uniform(LARGEST - 1, LARGEST)),
    ("expm1", powers(-323, 0)),
    ("expm1", powers(-323, 0, -1)),
    ("expm1", halves()),
    ("log1p", uniform(-1, 1)),
    ("log1p", uniform(0.35, 2.2)),
    ("log1p", uniform(-1, 100)),
    ("log1p", powers(-323, 308)),
    ("log1p", powers(-323, 0, -1)),
    ("log1p", powers(-16, 0) - 1),
    ("log1p", roots()),
]


def places(found, exact):
    """The error in units of the last place of the exact value."""
    return float(abs(mpmath.mpf(found) - exact) / math.ulp(float(exact)))


@pytest.mark.parametrize(("name", "x"), CASES)
def test_errors_are_below_about_one_unit_in_the_last_place(name, x, compiled_loops):
    found = np.zeros_like(x)
    compiled_loops[name](x, found)
    with mpmath.workprec(200):
        exact = [getattr(mpmath, name)(mpmath.mpf(number)) for number in x]
        errors = list(map(places, found, exact))
    assert max(errors) < PLACES_OF_EXPONENTIALS


@pytest.mark.parametrize(("name", "x"), CASES)
def test_lanes_and_interpreted_loops_have_the_bits_of_numbers_alone(name, x, compiled_loops):
    x = x[: len(x) // LANES * LANES]
    alone = np.zeros_like(x)
    for j in range(len(x)):  # each by a call of its own, which cannot be cut into vectors
        compiled_loops[name](x[j : j + 1], alone[j : j + 1])
    rows, lanes = zeros((len(x) // LANES, LANES)), zeros((len(x) // LANES, LANES))
    rows[...] = x.reshape(rows.shape)
    compiled_loops[name](rows, lanes)
    assert np.array_equal(lanes.ravel(), alone)
    with np.errstate(over="ignore"):
        assert np.array_equal(LOOPS[name](x), alone)


ENDS = {
    "expm1": {
        0.0: 0.0,
        5e-324: 5e-324,
        -5e-324: -5e-324,
        1e-310: 1e-310,
        np.nextafter(LARGEST, 800): np.inf,
        710.5: np.inf,
        1e308: np.inf,
        np.inf: np.inf,
        -38.0: -1.0,
        -1e308: -1.0,
        -np.inf: -1.0,
        np.nan: np.nan,
    },
    "log1p": {
        0.0: 0.0,
        5e-324: 5e-324,
        -5e-324: -5e-324,
        1e-310: 1e-310,
        np.inf: np.inf,
        -1.0: -np.inf,
        np.nextafter(-1.0, -2): np.nan,
        -1e308: np.nan,
        -np.inf: np.nan,
        np.nan: np.nan,
    },
}


@pytest.mark.parametrize("name", ENDS)
def test_ends_of_the_range(name, compiled_loops):
    x, expected = map(np.array, (list(ENDS[name]), list(ENDS[name].values())))
    found = np.zeros_like(x)
    compiled_loops[name](x, found)
    assert np.array_equal(found, expected, equal_nan=True)
    with np.errstate(all="ignore"):
        assert np.array_equal(LOOPS[name](x), expected, equal_nan=True)
    for number, value in zip(x, expected, strict=True):  # in every lane
        rows, lanes = zeros((1, LANES)), zeros((1, LANES))
        rows[...] = number
        compiled_loops[name](rows, lanes)
        assert np.array_equal(lanes[0], np.full(LANES, value), equal_nan=True)


def test_a_zero_keeps_its_sign(compiled_loops):
    found = np.ones(1)
    compiled_loops["expm1"](np.array([-0.0]), found)
    assert math.copysign(1, found[0]) == -1
