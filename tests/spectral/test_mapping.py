"""Frequency maps: known frequencies at each energy, lines of a file that go on, refusals."""

import json

import numpy as np
import pytest

from symfpu import Chain, breather_at_energy, frequency_map, frequency_shift
from symfpu.errors import InputError
from tests.tolerances import MAP_FREQUENCY, MAP_SHIFT

CHAIN = Chain(N=4, beta=1)
SHORT = {"T": 500, "step": 0.1}


def test_a_mode_that_moves_alone_has_its_breathers_frequency():
    """Mode N/2 of the beta chain stays alone: its orbit is the breather of that energy."""
    energies = ("0.01", "0.1")
    found = frequency_map(CHAIN, energies, seeds=(2,), **SHORT)
    exact = [float(breather_at_energy(CHAIN, 2, E).frequency) for E in energies]
    assert found.frequencies[:, 1] == pytest.approx(exact, rel=MAP_FREQUENCY)
    assert np.isnan(found.frequencies[:, [0, 2]]).all()
    assert found.counts.tolist() == [1, 1]
    assert found.drifts.max() < MAP_FREQUENCY


def test_small_shifts_are_those_of_the_lowest_order():
    chain = Chain(N=8, alpha="0.3")
    found = frequency_map(chain, ("1e-6", "4e-6"), T=20_000)
    amplitude = np.sqrt(2e-6) / chain.frequencies()[0]
    expected = float(frequency_shift(chain, {1: repr(float(amplitude))})[1]) / chain.frequencies()[0]
    assert found.shifts()[:, 0] == pytest.approx([expected, 4 * expected], rel=MAP_SHIFT)


def test_the_level_decides_what_counts():
    low, high = (frequency_map(CHAIN, ("0.1",), level=level, **SHORT) for level in (1e-6, 0.5))
    assert low.counts[0] > high.counts[0] == 1
    assert np.isnan(high.shifts()[0, 1:]).all()
    assert not np.isnan(low.shifts()[0, 2])


def test_a_map_goes_on_from_its_file(tmp_path):
    path, heard = tmp_path / "map.jsonl", []
    whole = frequency_map(CHAIN, ("0.01", "0.1"), file=path, **SHORT)
    header, first, second = path.read_text().splitlines()
    changed = json.loads(first) | {"frequencies": [0.5, *json.loads(first)["frequencies"][1:]]}
    path.write_text("\n".join([header, json.dumps(changed), second[:40]]))
    again = frequency_map(CHAIN, ("0.1", "0.01"), file=path, progress=lambda label, done: heard.append((label, done)), **SHORT)
    assert again.frequencies[0, 0] == 0.5, "taken from the file"
    assert np.array_equal(again.frequencies[1], whole.frequencies[1], equal_nan=True)
    assert {label for label, _ in heard} == {"energies", "H = 0.1"}
    assert [done for _, done in heard] == sorted(done for _, done in heard)
    assert len(path.read_text().splitlines()) == 3
    with pytest.raises(InputError, match="another file"):
        frequency_map(CHAIN, ("0.1",), file=path, T=600, step=0.1)
    path.write_text(header + '\n{"energy": "0.01"}\n')
    with pytest.raises(InputError, match="damaged"):
        frequency_map(CHAIN, ("0.1",), file=path, **SHORT)


@pytest.mark.parametrize(
    ("energies", "options", "words"),
    [
        ((), {}, "energies H > 0"),
        (("0",), {}, "energies H > 0"),
        ("0.1", {}, "a sequence"),
        (("0.1",), {"level": 1}, "between 0 and 1"),
        (("0.1",), {"lines": 0}, "lines"),
        (("0.1",), {"seeds": (4,)}, "seeds"),
        (("0.1",), {"T": 1}, "at least"),
    ],
)
def test_what_is_no_map_is_refused(energies, options, words):
    with pytest.raises(InputError, match=words):
        frequency_map(CHAIN, energies, **SHORT | options)


def test_a_ring_is_refused_by_name():
    with pytest.raises(InputError, match="periodic"):
        frequency_map(Chain(8, beta=1, ends="periodic"), ("0.1",), **SHORT)
