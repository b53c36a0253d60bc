"""Tori and breathers from a choice of amplitudes, energy or frequencies, and by Newton's method; of rings, too."""

from functools import cache

import numpy as np

import symfpu
from symfpu import Chain, lindstedt, refine, solve_amplitudes
from tests.breather import breather_of
from tests.fingerprint.cases import case
from tests.fingerprint.entries import solver

ALPHA = Chain(8, alpha="0.3")
BREATHERS = {
    "alpha": (ALPHA, 1, "0.3"),
    "beta, N odd": (Chain(9, beta=1), 2, "0.3"),
    "both": (Chain(8, alpha="0.4", beta="0.1"), 3, "0.3"),
    "one particle": (Chain(2, beta=1), 1, "0.5"),
    "toda": (Chain(7, potential="toda:1/2"), 3, "0.2"),
    "cosh": (Chain(6, potential=symfpu.from_expression("cosh(r) - 1")), 5, "0.4"),
    "high mode": (Chain(32, alpha="0.33"), 25, "0.1"),
}


@cache
def breather(name):
    return breather_of(*BREATHERS[name])


@cache
def pair():
    return symfpu.torus(ALPHA, (1, 2), amplitudes={1: "0.2", 2: "0.1"}, method="series", order=6)


def motion(solution):
    modes = not solution.chain.periodic  # of a ring the particles
    yield "positions", solver((solution.Q if modes else solution.x)([0.4, 1.7]))
    yield "momenta", solver((solution.P if modes else solution.p)([0.4, 1.7]))
    yield "spectrum", solver(solution.average_spectrum())


def told(name, solution):
    yield name, solution.record()
    for what, value in motion(solution):
        yield f"{name}, {what}", value


@case
def by_wish():
    yield from told("at amplitudes", pair())
    yield from told("at amplitudes, digits", symfpu.torus(ALPHA, (1,), amplitudes={1: "0.2"}, method="series", order=6, digits=25))
    yield from told("at energy", symfpu.torus(Chain(16, alpha="0.33"), (1, 2), energy="0.001", method="series", order=8))
    yield from told(
        "at energy, shared",
        symfpu.torus(Chain(9, beta=1), (1, 3), energy=symfpu.Energy("0.01", energy_ratio={1: 2, 3: 1}), method="series", order=4),
    )
    yield from told(
        "at harmonic energy",
        symfpu.torus(Chain(7, potential="morse:1/3"), (2,), energy=symfpu.Energy("0.01", harmonic=True), method="series", order=5),
    )
    yield from told(
        "three seeds", symfpu.torus(Chain(9, alpha="0.3"), (1, 2, 3), amplitudes={1: "0.1", 2: "0.1", 3: "0.05"}, method="series", order=3)
    )


@case
def by_newton():
    yield from told("at frequencies", refine(pair()))
    yield from told("at amplitudes", symfpu.refine(pair(), amplitudes={1: "0.25", 2: "0.1"}))
    yield from told("at energy", refine(pair(), energy="0.02"))
    yield from told("at energy, shared", refine(pair(), energy=symfpu.Energy("0.02", harmonic=True, energy_ratio={1: 1, 2: 1})))
    yield from told("at a start", symfpu.refine(pair(), start={1: "0.21", 2: "0.09"}))
    yield from told(
        "digits", refine(symfpu.torus(Chain(4, alpha="0.3"), (1, 2), amplitudes={1: "0.2", 2: "0.1"}, method="series", order=4), digits=30)
    )
    figure = symfpu.solve_amplitudes(symfpu.lindstedt(Chain(16, alpha="0.33"), (1, 2), ("0.19626", "0.39046"), 8))
    yield from told("Fig. 1", refine(figure))


@case
def breathers():
    for name in BREATHERS:
        yield from told(name, breather(name))
    yield from told("at frequency", symfpu.torus(ALPHA, (1,), frequencies=("0.3905",)))
    yield from told("at energy", symfpu.torus(Chain(6, beta=1), (5,), energy="0.5"))
    yield from told("at harmonic energy", symfpu.torus(ALPHA, (2,), energy=symfpu.Energy("0.01", harmonic=True)))
    yield from told("digits", symfpu.refine(breather("both"), digits=30))
    yield from told("digits at amplitude", symfpu.refine(breather("alpha"), digits=25, amplitudes={1: "0.31"}))
    yield "law", symfpu.breather_law(Chain(32, alpha="0.33"), 1e-4)


@case
def rings():
    chain = Chain(8, alpha="0.3", ends="periodic")
    series = lindstedt(chain, (1,), ("0.766",), 6)
    wave = solve_amplitudes(series)
    yield from told("wave of a series", wave)
    yield from told("wave by Newton", refine(wave))
    yield from told("wave at amplitude", symfpu.refine(wave, amplitudes={1: "0.15"}))
    yield from told("two waves", solve_amplitudes(lindstedt(Chain(9, beta=1, ends="periodic"), (1, 2), ("0.6850", "1.2870"), 4)))
    long = Chain(64, beta=1, ends="periodic")
    yield from told("breather of a ring", symfpu.torus(long, (5,), amplitudes={5: "0.8"}))
    yield from told("breather of a ring at energy", symfpu.torus(Chain(9, alpha="0.3", ends="periodic"), (2,), energy="0.1"))
    standing = symfpu.unfold(breather("alpha"))
    yield from told("standing", standing)
    yield "standing, mode coordinates", np.abs(standing.Q(0.0))
