"""Tori with prescribed frequencies, energies and starts: in doubles and in digits, orbits that stay on them, wrong arguments."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, Energy, InputError, integrate, lindstedt, refine, solve_amplitudes
from tests.refinement.test_ring_tori import of_series
from tests.tolerances import AMPLITUDE, ORBIT, ROUNDING, THOUSAND_ROUNDINGS, TWENTY_DIGITS

PI = "3.14159265358979324"
CASES = (
    (Chain(8, alpha="0.3"), {1: "0.4", 2: "0.02"}, {2: PI}, {1: "0.4", 2: 0}),
    (Chain(8, beta="0.3"), {1: "0.3", 3: "0.01"}, {}, {1: "0.3", 3: "0.011"}),
    (Chain(2, beta=1), {1: "0.4"}, {}, {1: "0.41"}),
    (Chain(7, potential="toda:0.4"), {2: "0.2", 6: "0.1"}, {2: "0.5"}, {2: "0.17", 6: "0.1"}),
    (Chain(4, alpha="0.3"), {1: "0.2", 2: "0.1", 3: "0.05"}, {1: PI}, {1: "-0.2", 2: "0.1", 3: "0.05"}),
)


@pytest.mark.parametrize(("chain", "amplitudes", "phases", "start"), CASES, ids=repr)
def test_seeds_start_where_they_are_told_and_the_orbit_stays_on_it(chain, amplitudes, phases, start):
    guess = symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=4)
    torus = refine(replace(guess, phases={q: float(phi) for q, phi in phases.items()}), start=start)
    assert not torus.warnings
    found = torus.Q(0.0)
    for q, x in start.items():
        assert abs(found[q - 1] - float(x)) <= ROUNDING
    assert dict(torus.phases) == {q: float(phases.get(q, 0)) for q in amplitudes}
    orbit = integrate(chain, *torus.state(), 50.0, step=0.01, samples=3)
    assert np.abs(orbit.Q - torus.Q(orbit.times)).max() < ORBIT


@pytest.mark.parametrize(
    ("start", "words"),
    [
        ({1: "0.4"}, "name every seed"),
        ({1: "0.4", 2: 0, 3: 0}, "name every seed"),
        ([0.4, 0.0], "name every seed"),
        ({1: 0, 2: 0}, "an orbit that moves"),
        ({1: "near", 2: 0}, "start, 1"),
    ],
)
def test_wrong_starts(start, words):
    guess = symfpu.torus(Chain(8, alpha="0.3"), (1, 2), amplitudes={1: "0.4", 2: "0.02"}, method="series", order=2)
    with pytest.raises(InputError, match=words):
        refine(guess, start=start)


def test_what_is_no_torus_of_fixed_ends():
    with pytest.raises(InputError):
        refine("torus", start={1: 1})
    with pytest.raises(InputError, match="ends"):
        refine(of_series(12, {2: 0.001, 3: 0.002}, {"beta": "0.3"}), start={2: 1, 3: 1})


def two_modes():
    return symfpu.torus(Chain(8, alpha="0.3"), (1, 2), amplitudes={1: "0.4", 2: "0.1"}, method="series", order=4)


def two_waves():
    ring = Chain(8, potential="toda:1/2", ends="periodic")
    return solve_amplitudes(lindstedt(ring, (1, -3), ("0.77", "1.85"), 4))


def second_share(torus):
    first, second, *_ = torus.average_spectrum()
    return second / first


AVERAGED = {"energy": Energy("0.03", harmonic=True, energy_ratio={1: 2, -3: 1})}
# what is prescribed; what it is of a torus; the value
PRESCRIBED = {
    "frequencies": (two_modes, {"frequencies": ("0.3905", "0.766")}, lambda torus: torus.omega[2], "0.766"),
    "energy": (two_modes, {"energy": "0.02"}, lambda torus: torus.energy(), "0.02"),
    "amplitude ratio kept": (two_modes, {"energy": "0.02"}, lambda torus: torus.amplitudes[2] / torus.amplitudes[1], "0.25"),
    "harmonic energy": (two_modes, {"energy": Energy("0.02", harmonic=True)}, lambda torus: torus.harmonic_energies().sum(), "0.02"),
    "energy ratio": (two_modes, {"energy": Energy("0.02", energy_ratio={1: 1, 2: "0.3"})}, second_share, "0.3"),
    "start": (two_modes, {"start": {1: "0.41", 2: "0.1"}}, lambda torus: torus.Q(0.0)[0], "0.41"),
    "energy of waves": (two_waves, {"energy": "0.03"}, lambda torus: torus.energy(), "0.03"),
    "averaged energy of waves": (two_waves, AVERAGED, lambda torus: torus.average_spectrum().sum(), "0.03"),
}  # fmt: skip


QUICK = {"energy", "start", "energy of waves"}
ALL = [pytest.param(name, marks=[] if name in QUICK else pytest.mark.long) for name in PRESCRIBED]


@pytest.mark.parametrize("name", ALL)
def test_what_is_prescribed_is_met_in_doubles_and_to_the_last_digit(name):
    guess, given, measured, value = PRESCRIBED[name]
    doubles = refine(guess(), **given)
    assert float(measured(doubles)) == pytest.approx(float(value), rel=THOUSAND_ROUNDINGS)
    digits = refine(guess(), **given, digits=24)
    with mpmath.workdps(40):
        assert abs(mpmath.mpf(str(measured(digits))) / mpmath.mpf(value) - 1) < TWENTY_DIGITS
    assert digits.origin.bound < TWENTY_DIGITS
    near = {q: float(A) for q, A in digits.amplitudes.items()}
    assert near == pytest.approx(dict(doubles.amplitudes), rel=AMPLITUDE)


@pytest.mark.long
def test_a_file_knows_what_was_prescribed(tmp_path):
    """A run of the same energy goes on; one of another is refused."""
    file = tmp_path / "torus.checkpoint"
    first = refine(two_modes(), energy="0.02", digits=20, file=file)
    again = refine(two_modes(), energy="0.02", digits=26, file=file)
    assert again.origin.sweeps > first.origin.sweeps
    with mpmath.workdps(40):
        assert abs(again.energy() - mpmath.mpf("0.02")) < TWENTY_DIGITS
    with pytest.raises(InputError, match="energy"):
        refine(two_modes(), energy="0.021", digits=26, file=file)


def test_one_thing_is_prescribed_at_a_time():
    with pytest.raises(InputError, match="at most one of them"):
        refine(two_modes(), energy="0.02", start={1: "0.4", 2: 0})
    for frequencies in (("0.39",), "0.39", {1: "0.39"}, (0, 1)):
        with pytest.raises(InputError, match=r"^frequencies"):
            refine(two_modes(), frequencies=frequencies)
