"""One function for a torus: what is asked is met, by each way the same, and what cannot be says how far it went."""

from dataclasses import replace

import numpy as np
import pytest

import symfpu
from symfpu import Chain, Energy, InputError, Newton, NoTorus, Orders, integrate
from symfpu.solutions import from_rest
from tests.tolerances import (
    CONVERGED_DIGITS,
    FIXED_ENERGY,
    GROWTH_WITH_ENERGY,
    ORBIT,
    PROMISED_RESIDUAL,
    SERIES_AND_TORUS,
    THIRTY_DIGITS,
    TWENTY_DIGITS,
)
from tests.tori.test_ring_torus import ring

CASES = {
    "alpha": (Chain(8, alpha="0.3"), (1, 3), "0.01"),
    "beta, wrapped": (Chain(9, beta=1), (3, 6), "0.05"),
    "soft": (Chain(6, beta="-0.3"), (2, 5), "0.02"),
    "Toda": (Chain(7, potential="toda:0.4"), (1, 2), "0.01"),
    "three particles": (Chain(3, alpha="0.4"), (1, 2), "0.02"),
    "waves": (ring(8, alpha="0.3", beta="0.2"), (1, -2), "0.02"),
}


@pytest.mark.parametrize("name", CASES)
def test_by_each_way_it_is_the_same_torus(name):
    chain, seeds, energy = CASES[name]
    found = symfpu.torus(chain, seeds, energy=energy)
    assert found.residual() < PROMISED_RESIDUAL
    assert float(found.energy()) == pytest.approx(float(energy), rel=FIXED_ENERGY)
    ways = {"frequencies": found.frequencies, "amplitudes": found.amplitudes}
    if not chain.periodic:
        ways["start"] = {q: found.Q(0.0)[q - 1] for q in found.seeds}
    for way, value in ways.items():
        other = symfpu.torus(chain, seeds, **{way: value})
        assert other.amplitudes == pytest.approx(found.amplitudes, rel=CONVERGED_DIGITS)
        assert list(map(float, other.frequencies)) == pytest.approx(list(map(float, found.frequencies)), rel=CONVERGED_DIGITS)


@pytest.mark.parametrize("name", [name for name in CASES if name != "waves"])
def test_orbits_stay_on_it(name):
    """By an integrator, which knows nothing of tori."""
    chain, seeds, energy = CASES[name]
    torus = replace(symfpu.torus(chain, seeds, energy=energy), phases={seeds[0]: 0.4})
    orbit = integrate(chain, *torus.state(), 50.0, step=0.01, samples=3, scheme="kahan_li8")
    assert np.abs(orbit.Q - torus.Q(orbit.times)).max() < ORBIT


@pytest.mark.parametrize("harmonic", [False, True])
def test_ratios_are_met_and_mode_energies_are_equal_by_default(harmonic):
    chain, seeds, energy = CASES["alpha"]
    modes = np.array(seeds) - 1
    equal, shared, sized = (
        symfpu.torus(chain, seeds, energy=Energy(energy, harmonic=harmonic, **ratio))
        for ratio in ({}, {"energy_ratio": {1: 3, 3: 1}}, {"amplitude_ratio": {3: 2, 1: 1}})
    )
    for torus, ratio in ((equal, 1), (shared, 3)):
        assert np.divide(*torus.average_spectrum()[modes]) == pytest.approx(ratio, rel=FIXED_ENERGY)
    assert sized.amplitudes[3] / sized.amplitudes[1] == pytest.approx(2, rel=FIXED_ENERGY)
    for torus in (equal, shared, sized):
        measured = torus.harmonic_energies().sum() if harmonic else torus.energy()
        assert measured == pytest.approx(float(energy), rel=FIXED_ENERGY)


def test_opposite_waves_of_one_energy_have_one_amplitude():
    found = symfpu.torus(ring(7, alpha="0.3"), (1, -1), energy="0.01")
    assert found.amplitudes[1] == pytest.approx(found.amplitudes[-1], rel=CONVERGED_DIGITS)
    assert found.residual() < PROMISED_RESIDUAL


def test_waves_that_drive_another_in_resonance_are_no_torus():
    """Umklapp, 4 - 3 (-1) = 7 = -1 of a ring of 8: a residual of 5e-6 is left, which is no torus to rounding."""
    with pytest.raises(NoTorus, match="Umklapp"):
        symfpu.torus(ring(8, alpha="0.3"), (1, -1), energy="0.01")


def test_every_seed_has_its_own_frequency_in_any_order():
    chain, omega = Chain(16, alpha="0.33"), {1: "0.19626", 2: "0.39046"}
    tori = [
        symfpu.torus(chain, (1, 2), frequencies=tuple(omega.values())),
        symfpu.torus(chain, (2, 1), frequencies=("0.39046", "0.19626")),
        symfpu.torus(chain, (2, 1), frequencies=omega),
    ]
    assert all(torus.seeds == (1, 2) for torus in tori)
    assert all(torus.amplitudes == tori[0].amplitudes for torus in tori)
    assert all(isinstance(torus.origin, Newton) for torus in tori)


@pytest.mark.parametrize("name", ["alpha", "waves"])
def test_the_way_from_rest_leads_to_the_same_torus(name, monkeypatch):
    """Guesses that would do are refused, so that it takes steps."""
    chain, seeds, energy = CASES[name]
    at_once, steps, refused = symfpu.torus(chain, seeds, energy=energy), [], []

    def require_good(guess):
        if len(refused) < 3:
            refused.append(guess)
            raise NoTorus("too large", guess, 1.0)

    monkeypatch.setattr(from_rest, "_require_good", require_good)
    tell = lambda label, part: steps.append(part) if label == "way from rest" else None  # noqa: E731
    by_steps = symfpu.torus(chain, seeds, energy=energy, progress=tell)
    assert steps == sorted(steps)
    assert steps[:2] == [0.125, 0.375]
    assert steps[-1] == 1
    assert by_steps.amplitudes == pytest.approx(at_once.amplitudes, rel=CONVERGED_DIGITS)
    assert by_steps.residual() < PROMISED_RESIDUAL


@pytest.mark.long
def test_what_is_too_much_says_how_far_it_was_followed():
    """Beyond the barrier of a soft chain."""
    with pytest.raises(NoTorus, match=r"followed from rest to H = .*ask for less, such as energy=") as failure:
        symfpu.torus(Chain(4, beta=-1), (1, 3), energy="5")
    assert failure.value.iterate.seeds == (1, 3)


def test_what_is_not_solved_to_rounding_is_an_error(monkeypatch):
    """As where no more harmonics fit; the iterate is kept."""
    chain, seeds, energy = CASES["beta, wrapped"]
    monkeypatch.setattr(from_rest, "REFINED_RESIDUAL", 0.0)
    with pytest.raises(NoTorus, match="most_harmonics") as failure:
        symfpu.torus(chain, seeds, energy=energy)
    assert failure.value.iterate.residual() == failure.value.residual < PROMISED_RESIDUAL


@pytest.mark.long
def test_a_torus_that_no_guess_reaches_at_once():
    """N = 16, H = 0.1: the short series leads to no torus; in steps the amplitudes go on as those of the family below."""
    chain = Chain(16, alpha="0.33")
    low, high = (symfpu.torus(chain, (1, 2), energy=energy) for energy in ("0.08", "0.1"))
    assert high.residual() < PROMISED_RESIDUAL
    for q, A in high.amplitudes.items():
        assert A / low.amplitudes[q] == pytest.approx(1.25**0.36, rel=GROWTH_WITH_ENERGY)


def test_digits_are_those_asked_for():
    chain, seeds, energy = CASES["alpha"]
    few, many = (symfpu.torus(chain, seeds, energy=energy, digits=digits) for digits in (20, 30))
    assert many.origin.bound < THIRTY_DIGITS
    assert abs(many.amplitudes[1] - few.amplitudes[1]) < TWENTY_DIGITS


@pytest.mark.parametrize("name", ["frequencies", "amplitudes", "energy"])
def test_a_series_of_no_given_order_is_cut_where_it_is_best(name):
    chain = Chain(8, alpha="0.3")
    near = symfpu.torus(chain, (1, 3), energy="0.001")
    way = {name: {"frequencies": near.frequencies, "amplitudes": near.amplitudes, "energy": "0.001"}[name]}
    best = symfpu.torus(chain, (1, 3), method="series", **way)
    assert not best.warnings
    for order in (4, 8):
        assert symfpu.torus(chain, (1, 3), method="series", order=order, **way).residual() >= best.residual()
    exact = symfpu.torus(chain, (1, 3), **way)
    assert best.amplitudes == pytest.approx(exact.amplitudes, rel=SERIES_AND_TORUS)


def test_one_seed_of_a_series_and_its_orders():
    found = symfpu.torus(Chain(8, alpha="0.3"), (1,), energy="0.01", method="series", order=Orders(6, coordinate_order=4))
    assert (found.origin.series.order, found.origin.frequency_order, found.origin.order) == (6, 6, 4)


@pytest.mark.parametrize(
    ("named", "given"),
    [
        ("frequencies, amplitudes, energy, start", {}),
        ("frequencies, amplitudes, energy, start", {"energy": 1, "amplitudes": {1: 1, 3: 1}}),
        ("method", {"energy": 1, "method": "shooting"}),
        ("order", {"energy": 1, "order": 4}),
        ("order", {"energy": 1, "method": "series", "order": -1}),
        ("start", {"start": {1: 1, 3: 1}, "method": "series"}),
        ("energy", {"energy": 0}),
        ("energy", {"energy": "x"}),
        ("energy_ratio", {"energy": Energy(1, energy_ratio={1: 1})}),
        ("frequencies", {"frequencies": ("0.39",)}),
        ("amplitudes", {"amplitudes": {1: "0.1"}}),
        ("amplitudes", {"amplitudes": {1: "0.1", 3: 0}}),
        ("start", {"start": {1: "0.1"}}),
        ("digits", {"energy": "0.01", "digits": 0}),
        ("seeds", {"energy": 1, "seeds": (1, 1)}),
        ("seeds", {"energy": 1, "seeds": 1}),
        ("chain", {"energy": 1, "chain": 8}),
    ],
    ids=str,
)
def test_wrong_arguments_are_refused_by_name(named, given):
    with pytest.raises(InputError) as failure:
        symfpu.torus(**{"chain": Chain(8, alpha="0.3"), "seeds": (1, 3)} | given)
    assert failure.value.argument == named


def test_a_ring_has_no_series_of_an_energy_and_no_start():
    chain = ring(8, alpha="0.3")
    with pytest.raises(InputError, match=r"^chain"):
        symfpu.torus(chain, (1, 2), energy=1, method="series")
    with pytest.raises(InputError, match="give amplitudes"):
        symfpu.torus(chain, (1, 2), start={1: "0.1", 2: "0.1"})
