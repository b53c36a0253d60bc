"""A family is one curve: families to different ends agree, and those of breathers with a continuation written here."""

from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, family, from_expression, member_at_energy
from tests.tolerances import FIXED_ENERGY, FOUR_PLACES, SAME_ORBIT, SIX_PLACES

COSH = "cosh(r) - 1"
BETA = (
    (5, 1, 0.5),
    (5, 3, 0.5),
    (6, 1, 0.4),
    (7, 2, 0.4),
    (8, 1, 0.35),
    (9, 1, 0.4),
    (10, 3, 0.3),
    (12, 1, 0.3),
    (14, 5, 0.3),
    (16, 1, 0.5),
)
LONG_BETA = ((17, 1, 0.3), (21, 4, 0.2), (33, 16, 0.1))
ALPHA = (
    (5, 2, 0.1),
    (6, 1, 0.05),
    (8, 1, 0.03),
    (8, 5, 0.05),
    (9, 4, 0.05),
    (11, 1, 0.02),
    (13, 6, 0.03),
    (16, 1, 0.02),
    (20, 7, 0.02),
    (33, 1, 0.01),
)
TODA = ((8, 1, 0.1), (11, 3, 0.1), (16, 2, 0.05))
OF_COSH = ((8, 1, 1.0), (7, 3, 1.0), (12, 1, 1.0), (10, 9, 1.0))
CASES = [
    *[("beta", *case) for case in BETA + LONG_BETA],
    *[("alpha", *case) for case in ALPHA],
    *[("toda", *case) for case in TODA],
    *[("cosh", *case) for case in OF_COSH],
]
QUICK = [("beta", 5, 1, 0.5), ("beta", 8, 1, 0.35), ("alpha", 8, 5, 0.05), ("toda", 11, 3, 0.1)]


def chain_of(law, N):
    if law == "cosh":
        return Chain(N, potential=from_expression(COSH))
    return Chain(N, potential="toda:1/2") if law == "toda" else Chain(N, **{law: "1" if law == "beta" else "1/3"})


@cache
def followed(law, N, seed, energy):
    return family(chain_of(law, N), (seed,), repr(energy))


def agree(case):
    """Members between both ends are the same; the end of the nearer one is the orbit that the farther one has there."""
    law, N, seed, energy = case
    far, near = followed(*case), followed(law, N, seed, energy / 2)
    assert far.ending == near.ending == "reached the energy asked for"
    assert near.members[-1].energy == pytest.approx(energy / 2, rel=FIXED_ENERGY)
    first, last = far.members[0].energy, near.members[-1].energy
    ours = [m for m in far.members[1:] if m.energy < last]
    theirs = [m for m in near.members[1:-1] if m.energy > first]
    assert len(ours) == len(theirs) > 0
    for one, other in zip(ours, theirs, strict=True):
        assert one.torus.cosines.shape == other.torus.cosines.shape
        assert one.torus.cosines == pytest.approx(other.torus.cosines, abs=SAME_ORBIT)
    end = near.members[-1].torus
    same = symfpu.torus(chain_of(law, N), (seed,), energy=repr(energy / 2))
    assert end.amplitudes[seed] == pytest.approx(same.amplitude, rel=SAME_ORBIT)


@pytest.mark.parametrize("case", QUICK, ids=repr)
def test_families_to_two_ends_agree(case):
    agree(case)


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=repr)
def test_families_of_thirty_chains_agree(case):
    assert len(CASES) == 30
    agree(case)


def test_stability_is_lost_at_one_energy_whatever_the_end():
    for goal in ("0.3", "0.35"):
        found = family(chain_of("beta", 8), (1,), goal, from_energy="0.15", multipliers=True)
        places = [e.energy for e in found.events if e.kind == "stability"]
        assert places == ([] if goal == "0.3" else [pytest.approx(0.3246, abs=FOUR_PLACES)])


def test_a_resonance_that_is_followed_is_an_event():
    [event] = [e for e in followed("beta", 8, 1, 0.35).events if e.what == "followed"]
    assert (event.kind, event.mode, event.harmonic) == ("resonance", 7, (5,))
    assert "resonance of mode 7 with harmonic (5) at H = 0.15" in repr(event)
    assert "followed, its gap is 0.015 of the amplitude" in repr(event)


SMALL_THIRD = {"amplitude_ratio": {1: 1, 3: "0.01"}, "tolerance": 1e-9}  # beside the wide gap of harmonic 5 of seed 1
SEVERAL = {
    "two seeds": ((NEAR_FIVE := Chain(8, beta=1), (1, 3)), ("0.05", "0.18", "0.25"), SMALL_THIRD),
    "three seeds": ((Chain(8, alpha="1/3"), (1, 2, 3)), ("1e-5", "3e-5", "1e-4"), {"tolerance": 1e-9}),
    "a wave": ((Chain(12, alpha="1/2", ends="periodic"), (1,)), ("0.01", "0.05", "0.1"), {}),
    "two waves": ((Chain(8, beta=1, ends="periodic"), (1, 2)), ("0.05", "0.1", "0.2"), {"tolerance": 1e-9}),
}


@pytest.mark.parametrize("name", [pytest.param(name, marks=[] if name == "a wave" else pytest.mark.long) for name in SEVERAL])
def test_families_of_tori_to_two_ends_have_the_same_members(name):
    """The goal chooses no step: members are equal, and the end of the nearer family is on the farther one."""
    arguments, (first, near_end, far_end), options = SEVERAL[name]
    near, far = (family(*arguments, end, from_energy=first, **options) for end in (near_end, far_end))
    assert near.ending == far.ending == "reached the energy asked for"
    ours, theirs = near.members[:-1], far.members[: len(near.members) - 1]
    assert len(ours) > 2
    for one, other in zip(ours, theirs, strict=True):
        assert one.amplitudes == other.amplitudes
        assert np.array_equal(one.torus.harmonics, other.torus.harmonics)
    end, same = near.members[-1], member_at_energy(far, near_end, harmonic=False)
    for q, amplitude in end.amplitudes.items():
        assert same.amplitudes[q] == pytest.approx(amplitude, rel=SIX_PLACES)


@pytest.mark.parametrize("name", ["two seeds", "two waves"])
def test_the_first_torus_does_not_depend_on_the_goal(name):
    """It begins at a shift of a thousandth; below that a thousandth lower."""
    (chain, _), *_ = SEVERAL[name]
    first, second, low = (family(chain, (1, 2), goal, members=1, tolerance=1e-9).members[0] for goal in ("0.2", "0.03", "0.001"))
    assert first.amplitudes == second.amplitudes
    assert first.energy / low.energy == pytest.approx(1000, rel=FIXED_ENERGY)
    linear = chain.frequencies() if not chain.periodic else 2 * np.sin(np.pi * np.arange(1, 8) / 8)
    shifts = [float(w) / linear[q - 1] - 1 for q, w in zip((1, 2), first.torus.frequencies, strict=True)]
    assert 0.0009 < max(shifts) < 0.0011


@pytest.mark.long
def test_tori_of_two_seeds_follow_the_gap_that_breathers_follow():
    """With 1e-2 of the amplitude in mode 3, to ends on both sides of three orbits of one energy; from rest, on grids of their own."""
    amplitudes = {}
    for goal in ("0.2", "0.25", "0.3", "0.35"):
        found = family(NEAR_FIVE, (1, 3), goal, **SMALL_THIRD)
        assert found.ending == "reached the energy asked for"
        orbit = symfpu.torus(NEAR_FIVE, (1,), energy=goal)
        assert found.members[-1].amplitudes[1] == pytest.approx(orbit.amplitude, rel=FOUR_PLACES)
        amplitudes[goal] = found.members[-1].amplitudes[1]
    for energy in ("0.2", "0.25", "0.3"):
        assert member_at_energy(found, energy, harmonic=False).amplitudes[1] == pytest.approx(amplitudes[energy], rel=SIX_PLACES)


class Continued:
    """Pseudo-arclength in all coefficients with short steps: sums over bonds and derivatives by differences, nothing of symfpu."""

    def __init__(self, N, seed, tension, harmonics, places):
        self.N, self.seed, self.tension = N, seed, tension
        self.n, self.q = np.array([(n, q) for n in harmonics for q in range(1, N) if (q - n * seed) % 2 == 0]).T
        self.first = int(np.flatnonzero((self.n == 1) & (self.q == seed))[0])
        bond = np.arange(N) + 0.5
        self.Omega = 2 * np.sin(np.pi * np.arange(1, N) / (2 * N))
        self.stretch = np.sqrt(2 / N) * self.Omega[:, None] * np.cos(np.pi * np.outer(np.arange(1, N), bond) / N)
        phase = np.pi * (np.arange(places) + 0.5) / places
        self.waves = np.cos(np.outer(phase, np.arange(max(harmonics) + 1)))
        norms = np.where(np.arange(max(harmonics) + 1) == 0, 1, 2) / places
        self.back = norms[:, None] * self.waves.T

    def table(self, y):
        c = np.zeros((self.waves.shape[1], self.N - 1))
        c[self.n, self.q - 1] = y[:-1]
        return c

    def equations(self, y):
        """Of y = (coefficients, omega)."""
        r = self.waves @ self.table(y) @ self.stretch
        force = self.back @ self.tension(r) @ self.stretch.T
        return self.n**2 * y[-1] ** 2 * y[:-1] - force[self.n, self.q - 1]

    def energy(self, y, potential):
        return float(potential(self.table(y).sum(axis=0) @ self.stretch).sum())

    def derivatives(self, function, y):
        shifts = 1e-6 * np.eye(len(y))
        return np.array([(function(y + h) - function(y - h)) / 2e-6 for h in shifts]).T

    def solved(self, y, condition):
        for _ in range(8):
            values = np.append(self.equations(y), condition(y))
            matrix = np.vstack([self.derivatives(self.equations, y), self.derivatives(condition, y)])
            change = np.linalg.solve(matrix, values)
            y = y - change
            if np.abs(change).max() < 1e-11:
                return y
        raise AssertionError("no orbit")

    def path(self, amplitude, step):
        y = np.zeros(len(self.n) + 1)
        y[self.first], y[-1] = amplitude, self.Omega[self.seed - 1]
        y = self.solved(y, lambda x: x[self.first] - amplitude)
        tangent = np.zeros(len(y))
        tangent[self.first] = 1
        while True:
            yield y
            matrix = np.vstack([self.derivatives(self.equations, y), tangent])
            tangent = np.linalg.solve(matrix, np.append(np.zeros(len(self.n)), 1.0))
            tangent /= np.linalg.norm(tangent)
            guess, normal = y + step * tangent, tangent
            y = self.solved(guess, lambda x, guess=guess, normal=normal: normal @ (x - guess))


INDEPENDENT = {
    "beta, 8": ("beta", 8, 1, 0.35, 0.5, range(1, 30, 2), lambda r: r + r**3, lambda r: r**2 / 2 + r**4 / 4),
    "cosh, 8": ("cosh", 8, 1, 1.0, 0.5, range(1, 30, 2), np.sinh, lambda r: np.cosh(r) - 1),
    "alpha, 6": ("alpha", 6, 1, 0.05, 0.2, range(13), lambda r: r + r**2 / 3, lambda r: r**2 / 2 + r**3 / 9),
}


@pytest.mark.long
@pytest.mark.parametrize("name", INDEPENDENT)
def test_a_continuation_in_all_coefficients_finds_the_same_orbits(name):
    """Steps of 0.01; at the first passage of an energy the orbit of that energy."""
    law, N, seed, goal, amplitude, harmonics, tension, potential = INDEPENDENT[name]
    other = Continued(N, seed, tension, list(harmonics), 2 * max(harmonics))
    wanted = [m for m in followed(law, N, seed, goal).members if m.energy > 1.1 * (other.Omega[seed - 1] * amplitude) ** 2 / 2]
    assert len(wanted) > 1
    path = other.path(amplitude, 0.01)
    y = next(path)
    for m in wanted:
        while other.energy(y, potential) < m.energy:
            y = next(path)
        at = other.solved(y, lambda x, E=m.energy: other.energy(x, potential) - E)
        assert at[other.first] == pytest.approx(m.amplitudes[seed], abs=SIX_PLACES)
        assert at[-1] == pytest.approx(float(m.torus.frequencies[0]), abs=SIX_PLACES)
        assert np.abs(at - y).max() < 0.05
