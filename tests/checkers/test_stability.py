"""Certificates of stability: every number altered is refused, and with digests made to fit whatever the theorem would not give."""

import copy
import random
from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, prove_stability
from symfpu.checkers.stability import verify
from symfpu.checkers.stability.bounds import INVERSE_BITS, inverse_of
from symfpu.checkers.stability.slopes import ONE, PLACES
from tests.breather import breather_of
from tests.checkers.certificate_files import altered, check_refused, reason, sealed
from tests.tolerances import INVERSE_OF_BLOCK

CASES = {
    "stable": (Chain(4, alpha="0.3"), 1, "0.2"),
    "unstable": (Chain(6, beta=1), 4, "0.6"),
}


@cache
def certificate(name):
    if name == "of its amplitude":
        return prove_stability(symfpu.torus(Chain(4, alpha="1/2"), (2,), amplitudes={2: 1}), amplitude=1).certificate()
    return prove_stability(breather_of(*CASES[name])).certificate()


def sealed_inside(data):
    """With the digest of the proof of existence made to fit, too."""
    return sealed(data | {"existence": sealed(data["existence"])})


FIRST = ("exponents", 0)
NO_ORBIT = "no orbit is proved|no readable"
FORGERIES = {
    "another sigma": ("stable", (*FIRST, "sigma", 0), lambda x: x + x // 10**4, "exceeds r"),
    "a smaller radius": ("stable", (*FIRST, "radius", 0), lambda m: m // 3, "exceeds r"),
    "a radius without a contraction": ("stable", (*FIRST, "radius", 1), lambda e: e - 36, "not below 1|exceeds r|may be"),
    "another coefficient": ("stable", (*FIRST, "vector", 0, 0, -1), lambda v: v + 2**30, "exceeds r|not 1 at kappa"),
    "other bits": ("stable", (*FIRST, "bits"), lambda b: b + 1, "kappa"),
    "another kappa": ("stable", (*FIRST, "kappa"), lambda k: [k[0], k[1] - 2], "kappa"),
    "an exponent shifted": ("stable", (*FIRST, "base"), lambda _: 1, "exceeds r|may be the same|not below 1"),
    "a wrong sector": ("stable", (*FIRST, "sector"), lambda _: 1, "sector is out of its range"),
    "an exponent twice": ("stable", ("exponents",), lambda x: [x[0], x[0]], "may be the same"),
    "an exponent missing": ("stable", ("exponents",), lambda x: x[:1], "where 2 are due"),
    "one too many": ("stable", ("exponents",), lambda x: [*x, x[0]], "where 2 are due"),
    "stable said to be unstable": ("stable", ("claim",), lambda _: "unstable", "may be real"),
    "unstable said to be stable": ("unstable", ("claim",), lambda _: "stable", "are due"),
    "no exponent of an unstable orbit": ("unstable", ("exponents",), lambda _: [], "no exponent is given"),
    "another rate": ("unstable", (*FIRST, "sigma", 1), lambda x: x + x // 10**3, "exceeds r"),
    "a real one": ("unstable", (*FIRST, "sigma", 1), lambda _: 0, "imaginary part"),
    "fewer harmonics": ("stable", ("free",), lambda _: 2, "wrong number of weights|too low"),
    "a weight too many": ("stable", (*FIRST, "weights"), lambda w: w + "0", "number of weights"),
    "a weight of nothing": ("stable", (*FIRST, "weights"), lambda w: " " + w[1:], "no readable"),
    "no block": ("stable", (*FIRST, "block"), lambda _: [], "kappa is not in the block"),
    "another orbit": ("stable", ("existence", "orbit", 1), lambda t: t[:9] + ("#" if t[9] == "!" else "!") + t[10:], NO_ORBIT),
    "another frequency": ("stable", ("existence", "omega"), lambda w: w.replace("7", "8", 1), NO_ORBIT),
    "another coupling": ("stable", ("existence", "coefficients", 0), lambda _: "31/100", NO_ORBIT),
    "a frequency known too well": ("of its amplitude", ("existence", "frequency", 1), lambda _: 0, NO_ORBIT),
    "a frequency hardly known": ("of its amplitude", ("existence", "frequency", 1), lambda r: r << 60, "exceeds r"),
    "a frequency not known": ("of its amplitude", ("existence", "frequency", 1), lambda r: r << 82, "not known well enough"),
    "another amplitude": ("of its amplitude", ("existence", "value"), lambda _: "1001/1000", NO_ORBIT),
}


@pytest.mark.parametrize("forgery", FORGERIES)
def test_forgeries_with_digests_that_fit_are_refused(forgery, tmp_path):
    name, place, change, why = FORGERIES[forgery]
    check_refused(verify, sealed_inside(altered(certificate(name), place, change)), tmp_path, why)


def test_choices_may_differ_but_not_the_theorem(tmp_path):
    """Another weight far from the orbit proves the same theorem."""
    data = certificate("stable")
    weights = data["exponents"][0]["weights"]
    assert weights[-1] in "01"
    other = altered(data, (*FIRST, "weights"), lambda w: w[:-1] + "2")
    assert reason(verify, sealed(other), tmp_path) is None


def test_an_interval_of_the_frequency_may_be_wider(tmp_path):
    """As far as the radius of the exponent allows."""
    wider = altered(certificate("of its amplitude"), ("existence", "frequency", 1), lambda r: r << 8)
    assert reason(verify, sealed_inside(wider), tmp_path) is None


def test_the_inverse_of_a_block_is_one():
    rng = random.Random(3)
    matrix = [[rng.randrange(-ONE, ONE) for _ in range(5)] for _ in range(5)]
    inverse = np.array(inverse_of(copy.deepcopy(matrix)), dtype=float) / 2.0**INVERSE_BITS
    np.testing.assert_allclose(inverse @ (np.array(matrix, dtype=float) / 2.0**PLACES), np.eye(5), atol=INVERSE_OF_BLOCK)
