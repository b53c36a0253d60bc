"""Floquet multipliers, normal modes, actions and their twist, families with their events."""

from functools import cache

import symfpu
from symfpu import Chain, actions, birkhoff_form, family, floquet, normal_frequency_series, normal_modes, refine, twist
from tests.breather import breather_of
from tests.fingerprint.cases import case
from tests.fingerprint.entries import sampled, solver

ALPHA = Chain(8, alpha="0.3")
ORBITS = {
    "alpha": (ALPHA, 1, "0.3"),
    "beta, N odd": (Chain(9, beta=1), 2, "0.3"),
    "unstable": (Chain(6, beta=1), 5, "1.5"),
    "toda": (Chain(7, potential="toda:1/2"), 3, "0.2"),
    "one particle": (Chain(2, beta=1), 1, "0.5"),
}


@cache
def orbit(name):
    return breather_of(*ORBITS[name])


@cache
def torus():
    amplitudes = {1: "0.2", 2: "0.1"}
    return symfpu.refine(
        symfpu.torus(Chain(4, alpha="0.3"), tuple(amplitudes), amplitudes=amplitudes, method="series", order=4), amplitudes=amplitudes
    )


@cache
def wave():
    return refine(symfpu.solve_amplitudes(symfpu.lindstedt(Chain(8, alpha="0.3", ends="periodic"), (1,), ("0.766",), 6)))


@case
def multipliers():
    for name in ORBITS:
        yield name, floquet(orbit(name)).record()
    yield "wave", floquet(wave()).record()


@case
def normal_frequencies():
    for name in ORBITS:
        if name != "one particle":
            yield name, normal_modes(orbit(name), resonance_length=6).record()
    yield "torus", normal_modes(torus(), resonance_length=6).record()
    yield "wave", normal_modes(wave(), resonance_length=4).record()
    yield "digits", normal_modes(refine(orbit("alpha"), digits=25), modes=[2], resonance_length=4).record()


@case
def normal_series():
    both = Chain(8, alpha="1/3", beta="1/5")
    found = normal_frequency_series(both, (1,), 2, 3)
    yield "symbols", found.record()
    yield "closed shift", str(normal_frequency_series(Chain(8, beta=1), (1,), 3, 2).closed_shift())
    numbers = normal_frequency_series(both, (1, 3), 2, 3, {1: "0.392", 2: "0.768", 3: "1.113"})
    yield "numbers", numbers.record()
    yield "at amplitudes", numbers.at({1: 0.1, 3: 0.05})
    yield "digits", normal_frequency_series(both, (1,), 2, 3, {1: "0.392", 2: "0.768"}, digits=25).at({1: "0.1"})
    yield "self-consistent", solver(symfpu.solve_normal_frequency(orbit("alpha"), 2, 4).sigma)


@case
def a_normal_family():
    found = symfpu.normal_family(symfpu.torus(Chain(6, beta=1), (5,), amplitudes={5: "0.5"}), {5: "1.5"}, members=3, resonance_length=2)
    yield "line", found.record()


@case
def action_angle():
    for name in ("alpha", "unstable"):
        yield f"{name}, actions", solver(actions(orbit(name)))
        yield f"{name}, twist", twist(orbit(name)).record()
    yield "torus, twist", twist(torus()).record()
    yield "wave, actions", solver(actions(wave()))
    for chain, seeds in ((ALPHA, (1, 2)), (Chain(9, beta=1), (1, 3)), (Chain(6, potential="toda:1/2"), (1, 2, 3))):
        found = symfpu.twist_at_rest(chain, seeds)
        yield f"at rest, {chain!r}", found.record()
        yield f"at rest, {chain!r}, formula", [[str(x) for x in row] for row in found.formula()]
    yield "at rest, all modes", symfpu.twist_at_rest(Chain(9, beta=1)).record()


@case
def birkhoff():
    form = birkhoff_form(ALPHA, (1, 2), 2)
    yield "alpha", form.record()
    yield "alpha, frequencies", {q: str(omega) for q, omega in form.frequencies().items()}
    yield "digits", birkhoff_form(ALPHA, (1, 2), 2, digits=20).frequencies_at({1: "0.1", 2: "0.1"})
    yield "beta", birkhoff_form(Chain(5, beta=1), (1,), 3).record()


def shortened(record):
    """Every sixteenth time of a long table."""
    return record | {"columns": {name: values[15::16] for name, values in record["columns"].items()}}


@case
def foretold():
    found = symfpu.foretold_indices(orbit("alpha"), 1e4, vectors=4, samples=64)
    yield "alpha", sampled(shortened(found.record()))
    yield "settling", sampled(found.settling())
    yield "unstable", sampled(shortened(symfpu.foretold_indices(orbit("unstable"), 1e3, vectors=3, samples=64).record()))


@case
def families():
    unstable = family(Chain(6, beta=1), (5,), "3", from_energy="0.05", multipliers=True)
    yield "instability", sampled(unstable.record())
    tori = family(ALPHA, (1, 2), "0.005", from_energy="0.001", members=12)
    yield "two seeds", sampled(tori.record())
    yield "two seeds, at energy", sampled(symfpu.member_at_energy(tori, "0.002", harmonic=False).amplitudes)
    breathers = family(Chain(8, alpha="0.4", beta="0.1"), (3,), "0.05", from_energy="0.01", members=6, multipliers=True)
    yield "one seed", sampled(breathers.record())
    middle = sum(member.torus.frequency for member in (breathers.members[0], breathers.members[-1])) / 2
    yield "one seed, at frequency", sampled([torus.amplitudes for torus in symfpu.member_at_frequency(breathers, 3, middle)])
    yield "a normal family", sampled(family(Chain(4, beta=1), (2,), "0.5", from_energy="0.01", members=4, normal=True).record())
    yield "ring", sampled(family(Chain(9, alpha="0.3", ends="periodic"), (2,), "0.2", from_energy="0.05", members=4).record())


@case
def of_a_ring():
    chain = Chain(9, beta=1, ends="periodic")
    found = symfpu.torus(chain, (2,), amplitudes={2: "0.4"})
    yield "multipliers", floquet(found).record()
    yield "normal frequencies", normal_modes(found, resonance_length=4).record()
