"""Files of rings: series and tori of waves as they were, to the last bit, and refused where they do not fit together."""

import dataclasses

import numpy as np
import pytest

from symfpu.bundles.bundle import load, save
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.files.archive import BundleError
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.series.travelling import travelling_waves
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.ring_torus import travelling_torus, unfold
from tests.bundles.test_potentials import document, forged

OMEGA = ("0.7661", "1.8486")


def waves(order=6, **law):
    chain = Chain(8, **(law or {"potential": "toda:1/2"}), ends="periodic")
    return travelling_waves(chain, (1, -3), OMEGA, order)


def standing():
    return unfold(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 4)))


def same(kept, made):
    assert type(kept) is type(made)
    for field in dataclasses.fields(made):
        if field.name != "grading":
            one, other = (getattr(value, field.name) for value in (kept, made))
            assert np.array_equal(one, other) if isinstance(other, np.ndarray) else str(one) == str(other), field.name


@pytest.mark.parametrize("law", [{"potential": "toda:1/2"}, {"beta": "1/3"}, {"alpha": "1/3", "beta": "-1/5"}])
@pytest.mark.parametrize("order", [0, 1, 5])
def test_series_come_back(law, order, tmp_path):
    series = waves(order, **law)
    kept = load(save(tmp_path / "waves", series)).series
    same(kept, series)
    for name in ("coordinates", "corrections"):
        for one, other in zip(getattr(kept, name), getattr(series, name), strict=True):
            assert one.shape == other.shape
            assert np.array_equal(one, other)
    squares = [0.01, 0.02]
    assert np.array_equal(kept.frequency_terms(squares)[0], series.frequency_terms(squares)[0])


def newton():
    return refine(travelling_torus(waves(), phases={1: 0.3}))


@pytest.mark.parametrize("made", [lambda: travelling_torus(waves(), phases={1: 0.3}), standing, newton])
def test_tori_come_back(made, tmp_path):
    torus = made()
    bundle = load(save(tmp_path / "torus", torus))
    same(bundle.torus, torus)
    assert bundle.series is None
    assert np.array_equal(bundle.torus.positions([0.0, 3.3]), torus.positions([0.0, 3.3]))
    assert bundle.torus.chain == torus.chain
    first = bundle.test_vectors[0]
    assert [float(x) for x in first.Q] == torus.positions(0.0).tolist()
    assert len(first.P) == torus.chain.N


def test_the_ends_stand_in_the_file_of_a_ring_alone(tmp_path):
    body = document(save(tmp_path / "ring", waves()))
    assert (body["schema"], body["series"]["ends"]) == (5, "periodic")
    fixed = lindstedt(Chain(8, potential="toda:1/2"), (1,), ("0.392",), 2)
    body = document(save(tmp_path / "fixed", fixed))
    assert (body["schema"], "ends" in body["series"]) == (3, False)


SERIES_LIES = {
    "ends": "fixed",
    "seeds": [1, 4, -4],
    "order": 10**6,
    "frequencies": ["1"],
    "N": 3,
    "unit": "none",
}


@pytest.mark.parametrize("name", SERIES_LIES)
def test_a_series_that_lies_is_refused(name, tmp_path):
    file = save(tmp_path / "waves", waves())
    forged(file, lambda body: body["series"].update({name: SERIES_LIES[name]}))
    with pytest.raises(BundleError, match="is damaged") as caught:
        load(file)
    assert "\n" not in str(caught.value)


TORUS_LIES = {"ends": "round", "seeds": [1], "waves": 10**9, "phases": ["0"], "frequencies": ["0", "1"], "order": -1}


@pytest.mark.parametrize("name", TORUS_LIES)
def test_a_torus_that_lies_is_refused(name, tmp_path):
    file = save(tmp_path / "torus", travelling_torus(waves()))
    forged(file, lambda body: body["torus"].update({name: TORUS_LIES[name]}))
    with pytest.raises(BundleError, match="is damaged"):
        load(file)


def test_a_chain_with_fixed_ends_is_no_ring_whatever_its_file_says(tmp_path):
    file = save(tmp_path / "fixed", lindstedt(Chain(8, alpha="0.3"), (1,), ("0.392",), 2))
    forged(file, lambda body: body["series"].update(ends="periodic"))
    with pytest.raises(BundleError, match="ends, not fixed"):
        load(file)


@pytest.mark.parametrize("made", [waves, lambda: travelling_torus(waves())])
def test_show(made, tmp_path, capsys):
    file = str(save(tmp_path / "made", made()))
    assert main(["show", file]) == 0
    assert "periodic" in capsys.readouterr().out
