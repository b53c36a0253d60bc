"""Frequency maps: known frequencies at each energy, lines of a file that go on, refusals."""

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, MapIncomplete, frequency_map, frequency_shift, read_sweep
from symfpu.files.kept_lines import entry_of, line_of
from symfpu.spectral import mapping
from tests.refusals import each, refused
from tests.tolerances import MAP_FREQUENCY, MAP_SHIFT

CHAIN = Chain(N=4, beta=1)
SHORT = {"T": 500, "step": 0.1}


def test_a_mode_that_moves_alone_has_its_breathers_frequency():
    """Mode N/2 of the beta chain stays alone: its orbit is the breather of that energy."""
    energies = ("0.01", "0.1")
    found = frequency_map(CHAIN, energies, seeds=(2,), **SHORT)
    exact = [float(symfpu.torus(CHAIN, (2,), energy=E).frequency) for E in energies]
    assert found.frequencies[:, 1] == pytest.approx(exact, rel=MAP_FREQUENCY)
    assert np.isnan(found.frequencies[:, [0, 2]]).all()
    assert found.counts.tolist() == [1, 1]
    assert found.drifts.max() < MAP_FREQUENCY


@pytest.mark.parametrize("energy", ["1e-6", pytest.param("4e-6", marks=pytest.mark.long)])
def test_small_shifts_are_those_of_the_lowest_order(energy):
    chain = Chain(N=8, alpha="0.3")
    found = frequency_map(chain, (energy,), T=20_000)
    amplitude = np.sqrt(2 * float(energy)) / chain.frequencies()[0]
    expected = float(frequency_shift(chain, {1: repr(float(amplitude))})[1]) / chain.frequencies()[0]
    assert found.shifts()[0, 0] == pytest.approx(expected, rel=MAP_SHIFT)


def test_the_level_decides_what_counts():
    low, high = (frequency_map(CHAIN, ("0.1",), level=level, **SHORT) for level in (1e-6, 0.5))
    assert low.counts[0] > high.counts[0] == 1
    assert np.isnan(high.shifts()[0, 1:]).all()
    assert not np.isnan(low.shifts()[0, 2])


def test_a_map_goes_on_from_its_file(tmp_path):
    path, heard = tmp_path / "map.jsonl", []
    whole = frequency_map(CHAIN, ("0.01", "0.1"), file=path, **SHORT)
    header, first, second = path.read_bytes().splitlines()
    changed = entry_of(first)
    changed["result"]["frequencies"][0] = 0.5
    path.write_bytes(header + b"\n" + line_of(changed) + second[:40])
    again = frequency_map(CHAIN, ("0.1", "0.01"), file=path, progress=lambda label, done: heard.append((label, done)), **SHORT)
    assert again.frequencies[0, 0] == 0.5, "taken from the file"
    assert np.array_equal(again.frequencies[1], whole.frequencies[1], equal_nan=True)
    assert {label for label, _ in heard} == {"energies", "H = 0.1"}
    assert [done for _, done in heard] == sorted(done for _, done in heard)
    assert len(path.read_text().splitlines()) == 3
    with pytest.raises(InputError, match="another file"):
        frequency_map(CHAIN, ("0.1",), file=path, T=600, step=0.1)
    case = {"case": {"energy": "0.1"}}
    for entry in ({"energy": "0.1"}, case | {"result": {"modes": [1]}}, case | {"result": 1}):
        path.write_bytes(header + b"\n" + line_of(entry))
        with pytest.raises(InputError, match="damaged"):
            frequency_map(CHAIN, ("0.1",), file=path, **SHORT)


@pytest.mark.long
def test_energies_are_shared_out_to_processes(tmp_path, monkeypatch):
    energies, heard = ("0.01", "0.1"), []
    here = frequency_map(CHAIN, energies, **SHORT)
    monkeypatch.setattr(mapping, "WORTH_PROCESSES", 0)
    monkeypatch.setattr(mapping, "available_cores", lambda: 2)
    path = tmp_path / "map.jsonl"
    there = frequency_map(CHAIN, energies, file=path, progress=lambda *told: heard.append(told), **SHORT)
    for name in ("frequencies", "errors", "strengths", "counts", "drifts"):
        assert np.array_equal(getattr(there, name), getattr(here, name), equal_nan=True)
    assert heard == [("energies", 0.0), ("energies", 0.5), ("energies", 1.0)]
    assert sorted(row.case["energy"] for row in read_sweep(path).rows) == ["0.01", "0.1"]


def test_an_energy_that_fails_costs_no_other(tmp_path):
    """Energy 1000 is above the barrier of the cubic potential."""
    path, chain = tmp_path / "map.jsonl", Chain(N=4, alpha="0.3")
    with pytest.raises(MapIncomplete, match=r"the first H = 1000 \(EscapedOrbit: .*energies that have some: 2") as caught:
        frequency_map(chain, ("1000", "0.01", "0.1"), file=path, **SHORT)
    assert caught.value.failures["1000"].numbers["energy"] == pytest.approx(1000)
    assert caught.value.done.energies.tolist() == [0.01, 0.1]
    whole = frequency_map(chain, ("0.01", "0.1"), file=path, **SHORT)
    assert np.array_equal(whole.frequencies, caught.value.done.frequencies, equal_nan=True)
    with pytest.raises(MapIncomplete, match="energies that have some: 0") as caught:
        frequency_map(chain, ("1000",), file=path, **SHORT)
    assert caught.value.done is None


def test_a_map_that_is_stopped_keeps_what_is_done(tmp_path):
    path = tmp_path / "map.jsonl"

    def stop(label, done):
        if label == "H = 0.1":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        frequency_map(CHAIN, ("0.01", "0.1"), file=path, progress=stop, **SHORT)
    assert [row.case["energy"] for row in read_sweep(path).rows] == ["0.01"]


@each(energies=[(), ("0",), "0.1"], level=[1], lines=[0], seeds=[(4,)], T=[-500], step=[0], scheme=["euler"])
def test_what_is_no_map_is_refused(name, value):
    refused(frequency_map, name, value, chain=CHAIN, energies=("0.1",), **SHORT)


def test_orbits_shorter_than_the_lowest_seed_are_refused_before_any_runs():
    with pytest.raises(InputError, match=r"T = 600, 4\.7 turns of mode 1"):
        frequency_map(Chain(64, alpha="0.3"), ("0.001",), T=600, step=0.1)
    with pytest.raises(InputError, match="at least"):
        frequency_map(CHAIN, ("0.1",), T=1, step=0.1)


def test_a_short_orbit_has_no_frequency_that_is_a_sum_of_others():
    """Mode 4 had 2.2357 +- 0.006, which is omega_1 + omega_3."""
    found = frequency_map(Chain(5, alpha="0.3"), ("0.05",), T=300)
    assert np.isfinite(found.frequencies[0, :3]).all()
    assert np.isnan(found.frequencies[0, 3])
