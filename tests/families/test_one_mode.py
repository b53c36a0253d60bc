"""One normal mode followed alone through onsets: the numbers of all of them together, and the multipliers of Krein's signature +1."""

from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, floquet, normal_family, normal_modes, refine
from symfpu.normal.search import LOST, followed_modes
from tests.breather import breather_of
from tests.tolerances import NORMAL_CONVERGED, NORMAL_MULTIPLIER

CASES = {  # chain, first and last amplitudes, members, modes that once went astray
    "past sigma_7 = 5 omega": (Chain(8, beta=1), {1: "1.36"}, {1: "1.44"}, 3, (7,)),
    "out of a parametric onset": (Chain(6, beta=1), {5: "1.3"}, {5: "0.5"}, 3, (4,)),
    "out of a quartet": (Chain(8, alpha="0.5"), {2: "1.2"}, {2: "0.5"}, 4, (1, 7)),
    "into a quartet": (Chain(8, alpha="0.5"), {2: "0.5"}, {2: "1.2"}, 2, (1, 7)),
    "two angles, past sigma_7 = 5 omega_1": (Chain(8, beta=1), {1: "1.36", 3: "0.01"}, {1: "1.43", 3: "0.01"}, 2, (7,)),
    "two angles, out of an onset": (Chain(6, beta=1), {1: "0.05", 5: "1.3"}, {1: "0.05", 5: "0.9"}, 2, (4,)),
    "two angles, another's direction": (Chain(8, alpha="0.5"), {2: "1.2", 5: "0.02"}, {2: "0.85", 5: "0.02"}, 2, (1,)),
}
SLOW = {"into a quartet", "out of a quartet", *(name for name in CASES if "angles" in name)}
NAMES = [pytest.param(name, marks=pytest.mark.long) if name in SLOW else name for name in CASES]
ONE_ANGLE = [p for p, name in zip(NAMES, CASES, strict=True) if len(CASES[name][1]) == 1]


@cache
def start(name):
    """From smaller amplitudes, where a series leads to the torus."""
    chain, wanted, *_ = CASES[name]
    if len(wanted) == 1:
        return breather_of(chain, *wanted, *wanted.values())
    near = {q: min(float(a), 0.2) for q, a in wanted.items()}
    found = symfpu.torus(chain, tuple(near), amplitudes=near)
    for part in (0.25, 0.5, 0.75, 1.0):
        found = refine(found, amplitudes={q: a + part * (float(wanted[q]) - a) for q, a in near.items()})
    return found


@cache
def line(name, modes=None):
    _, _, end, members, _ = CASES[name]
    return normal_family(start(name), end, members=members, modes=modes, resonance_length=0).members


def forward_multipliers(orbit):
    """Those on the circle whose solutions have positive Krein form, by the eigenvectors of the monodromy matrix."""
    values, vectors = np.linalg.eig(floquet(orbit).monodromy)
    Q, P = np.split(vectors, 2)
    forms = (Q.conj() * P).sum(axis=0).imag
    return values[(np.abs(np.abs(values) - 1) < NORMAL_MULTIPLIER) & (forms > 0)]


@pytest.mark.parametrize("name", NAMES)
def test_one_mode_alone_is_the_one_among_all(name):
    for q in CASES[name][-1]:
        for one, every in zip(line(name, (q,)), line(name), strict=True):
            assert complex(one.frequencies[q]) == pytest.approx(complex(every.frequencies[q]), abs=NORMAL_CONVERGED)
            assert one.mode(q).signature == every.mode(q).signature == (0 if one.mode(q).growth else 1)


@pytest.mark.parametrize("name", ONE_ANGLE)
def test_their_multipliers_are_those_of_positive_signature(name):
    for q in CASES[name][-1]:
        for found in line(name, (q,)):
            multiplier = found.multipliers()[q]
            growing = found.mode(q).growth
            known = floquet(found.torus).multipliers if growing else forward_multipliers(found.torus)
            assert np.abs(known - multiplier).min() < NORMAL_MULTIPLIER


@pytest.mark.long
def test_the_two_of_a_quartet_are_two_solutions():
    """sigma_1 and nu.omega - conj(sigma_1) of mode 7; both were sigma_1 and 2 omega more."""
    found = normal_modes(symfpu.torus(Chain(8, alpha="0.5"), (2,), amplitudes={2: "1.2"}), modes=[1, 7])
    one, seven = (complex(w) / float(found.torus.frequency) for w in found.frequencies.values())
    assert one.imag == pytest.approx(seven.imag, abs=NORMAL_CONVERGED)
    assert one.real + seven.real == pytest.approx(3, abs=NORMAL_CONVERGED)


@pytest.mark.long
def test_a_mode_that_is_lost_on_the_way_is_said_to_be(monkeypatch):
    """No overlap is enough here. Sought anew it is told by a main coefficient above a half, and else it is missing."""
    before, torus = (found.torus for found in line("past sigma_7 = 5 omega", (7,))[1:])
    monkeypatch.setattr("symfpu.normal.reduction.LEAST_FOLLOWED", 2.0)
    found, missing = followed_modes(torus, normal_modes(before, modes=[3, 7]), modes=[3, 7])
    assert [mode.mode for mode in found.modes] == [3]
    assert LOST in str(missing[7])
    assert found.missing == {7: str(missing[7])}
