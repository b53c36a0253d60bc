"""Files of solutions without a series: forgeries are refused, and files of the first version stay what they were."""

import json
import zipfile

import mpmath
import numpy as np
import pytest

from symfpu.breathers.balance import PeriodicOrbit
from symfpu.breathers.digits import PreciseOrbit
from symfpu.bundles.bundle import BundleError, load, save
from symfpu.errors import InputError
from symfpu.tori.quasiperiodic import FourierTorus
from tests.bundles.test_bundle_damage import forged, numpy_file
from tests.tori.solutions import CASES


def torus_entry(**changes):
    return lambda members, body: body["torus"].update(changes)


def made_entry(**changes):
    return lambda members, body: body["torus"]["made"].update(changes)


def array(name, values):
    return lambda members, body: members.update({f"{name}.npy": numpy_file(values)})


INFINITE = np.full((14, 7), np.inf).ravel()
CHANGES = {
    "another class": (torus_entry(**{"class": "Chain"}), "no solution is of the class 'Chain'"),
    "another kind": (torus_entry(kind="sums"), "a torus of kind 'sums' without a series"),
    "no torus": (lambda members, body: body.update(torus=None), "a torus of kind None"),
    "negative frequency": (torus_entry(frequencies=["-1.1"]), "do not fit the seeds"),
    "two frequencies": (torus_entry(frequencies=["1.1", "1.2"]), "do not fit the seeds"),
    "no phases": (torus_entry(phases=[]), "do not fit the seeds"),
    "seed outside": (torus_entry(seeds=[8]), "seeds"),
    "no harmonics": (torus_entry(harmonics=0), "harmonics = 0"),
    "many harmonics": (torus_entry(harmonics=10**15), "bytes where"),
    "digits": (torus_entry(digits=20), "words"),
    "infinite": (array("cosines", INFINITE[: 13 * 7]), "a number of cosines is not finite"),
    "gaps": (array("harmonics", 2 * np.arange(13)), "not those of a periodic orbit"),
    "steps": (made_entry(iterations=-1), "iterations"),
    "sigma": (made_entry(sigma="exit()"), "exit"),
}


@pytest.mark.parametrize("case", CHANGES)
def test_forged_orbits_are_refused(case, tmp_path):
    file = save(tmp_path / "orbit", CASES["PeriodicOrbit"]())
    change, message = CHANGES[case]
    forged(file, change)
    with pytest.raises(BundleError, match=message):
        load(file)


DIGITS = {
    "no words": (torus_entry(words=0), "words = 0"),
    "many words": (torus_entry(words=10**15), "bytes where"),
    "bound": (made_entry(bound={"exact": "exit()"}), "is no binary number"),
}


@pytest.mark.parametrize("case", DIGITS)
def test_forged_digits_are_refused(case, tmp_path):
    file = save(tmp_path / "orbit", CASES["PreciseOrbit"]())
    change, message = DIGITS[case]
    forged(file, change)
    with pytest.raises(BundleError, match=message):
        load(file)


def schema(file):
    with zipfile.ZipFile(file) as archive:
        return json.loads(archive.read("bundle.json"))["schema"]


@pytest.mark.parametrize("name", CASES)
def test_files_say_the_oldest_schema_that_reads_them(name, tmp_path):
    """Series and refined tori as before; all else is new, and an older symfpu says that it is."""
    old = name.startswith(("QTorus", "RefinedTorus"))
    assert schema(save(tmp_path / "solution", CASES[name]())) == (1 if old else 2)


@pytest.mark.parametrize("name", ["PeriodicOrbit", "PreciseOrbit"])
def test_what_is_not_finite_is_not_written(name, tmp_path):
    orbit = CASES[name]()
    cosines = orbit.cosines.copy()
    cosines[2, 2] = float("inf") * cosines[1, 2]
    fields = orbit.chain, orbit.seeds, orbit.frequencies, orbit.harmonics, cosines, orbit.phases, orbit.digits
    spoilt = (
        PeriodicOrbit(*fields, iterations=1, sigma=0.1) if name == "PeriodicOrbit" else PreciseOrbit(*fields, bound=orbit.bound, sweeps=1)
    )
    with pytest.raises(InputError, match=r"^result = .*finite"):
        save(tmp_path / "orbit", spoilt)
    assert not list(tmp_path.iterdir())


def test_numbers_of_many_digits_keep_every_bit(tmp_path):
    """Tiny and large ones, with signs, whole and zero."""
    with mpmath.workdps(60):
        values = [mpmath.mpf(2) ** -3000 / 3, -(mpmath.mpf(10) ** 40) / 7, mpmath.mpf(0), mpmath.mpf(-1), *[mpmath.mpf("0.1")] * 3]
    precise = CASES["PreciseOrbit"]()
    cosines = np.array([values, values[::-1]], dtype=object)
    harmonics = precise.harmonics[:2]
    torus = FourierTorus(precise.chain, precise.seeds, precise.frequencies, harmonics, cosines, {3: mpmath.mpf("0.25")}, 40)
    loaded = load(save(tmp_path / "torus", torus)).torus
    assert [x._mpf_ for x in loaded.cosines.flat] == [x._mpf_ for x in cosines.flat]
    assert loaded.phases == torus.phases
    assert str(loaded.cosines[1, 0]) == str(torus.cosines[1, 0]) == "0.1"
