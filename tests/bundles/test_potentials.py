"""Files of chains with other potentials: as they were, to the last bit, and refused where the potential is unknown."""

import json
import zipfile

import numpy as np
import pytest

from symfpu.bundles.bundle import load, save
from symfpu.chain.chain import Chain
from symfpu.chain.potentials.toda import toda
from symfpu.errors import InputError
from symfpu.files.archive import BundleError, digest_of
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.quasiperiodic import FourierTorus
from tests.bundles.test_bundle import same

POTENTIALS = ["toda:1/2", "lj:12,6", "poly:1/3,0,1/5", "poly:0,0,0,1/5"]
FREQUENCY = ("0.392",)


def torus_of(potential):
    return solve_amplitudes(lindstedt(Chain(8, potential=potential), (1,), FREQUENCY, 4))


def fourier(torus):
    parts = torus.harmonics, torus.cosines, torus.phases, None
    return FourierTorus(torus.chain, torus.seeds, torus.frequencies, *parts)


def document(file):
    with zipfile.ZipFile(file) as archive:
        return json.loads(archive.read("bundle.json"))


def forged(file, change):
    """The same file with another document, its digest right."""
    with zipfile.ZipFile(file) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    body = json.loads(members["bundle.json"])
    change(body)
    body.pop("digest")
    members["bundle.json"] = json.dumps(body | {"digest": digest_of(body)}).encode()
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)


@pytest.mark.parametrize("potential", POTENTIALS[:3])
def test_tori_come_back(potential, tmp_path):
    torus = torus_of(potential)
    kept = load(save(tmp_path / "torus", torus)).torus
    assert kept.chain == torus.chain
    assert kept.amplitudes == torus.amplitudes
    assert np.array_equal(kept.cosines, torus.cosines)
    assert kept.energy() == torus.energy()


@pytest.mark.parametrize("ring", ["universal", "digits"])
@pytest.mark.parametrize("potential", POTENTIALS)
def test_series_of_other_rings_come_back(potential, ring, tmp_path):
    chosen = {"frequencies": FREQUENCY, "digits": 30} if ring == "digits" else {}
    series = lindstedt(Chain(8, potential=potential), (1,), order=2, **chosen)
    kept = load(save(tmp_path / "series", series)).series
    assert same(kept, series)


def test_solutions_by_coefficients_come_back(tmp_path):
    solution = fourier(torus_of("toda:1/2"))
    kept = load(save(tmp_path / "solution", solution)).torus
    assert (kept.chain, kept.seeds) == (solution.chain, solution.seeds)
    assert np.array_equal(kept.cosines, solution.cosines)


def test_the_potential_stands_in_the_file_and_an_older_reader_is_told(tmp_path):
    body = document(save(tmp_path / "toda", torus_of("toda:1/3")))
    assert (body["schema"], body["series"]["potential"]) == (3, "toda:1/3")
    assert not {"alpha", "beta"} & body["series"].keys()
    body = document(save(tmp_path / "fpu", torus_of("poly:1/3")))
    assert (body["schema"], body["series"]["alpha"], body["series"]["beta"]) == (1, "1/3", "0")
    assert "potential" not in body["series"]


@pytest.mark.parametrize("written", ["spring:1", "toda:1,2", "toda:__import__('os')", "toda:0", ""])
def test_an_unknown_potential_is_refused_by_name(written, tmp_path):
    file = save(tmp_path / "toda", torus_of("toda:1/2"))
    forged(file, lambda body: body["series"].update(potential=written))
    with pytest.raises(BundleError, match=r"potential .*; update symfpu") as caught:
        load(file)
    assert repr(written)[:20] in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_potential_that_its_text_would_not_give_back_is_not_written(tmp_path):
    long = toda("1." + "1" * 990)  # the text of twice as many digits would be too long
    squared = toda(long.a**2)
    series = lindstedt(Chain(8, potential=squared), (1,), order=1)
    with pytest.raises(InputError, match=r"^potential = "):
        save(tmp_path / "toda", series)
    assert not list(tmp_path.iterdir())
