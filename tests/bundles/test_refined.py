"""Refined tori in files and as source code: what comes back is the same, and damaged arrays do not."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from symfpu.bundles.bundle import BundleError, load, save
from symfpu.chain.chain import Chain
from symfpu.codegen.evaluator import compile_evaluator
from symfpu.codegen.export import export
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from tests.bundles.test_bundle import same
from tests.bundles.test_bundle_damage import forged, numpy_file
from tests.codegen.compilers import program
from tests.codegen.test_c99 import assert_close

TIMES = np.array([0.0, 1.7, 63.0])  # NumPy rounds omega t: half a last place of it is 1e-14


@pytest.fixture(scope="module")
def torus():
    """Two seeds in no order of the chain's, phases, a doubt, and numbers that are no short decimals."""
    series = lindstedt(Chain(8, alpha="1/3", beta="0.2"), (1, 3), (Fraction("0.3904"), Fraction("1.1118")), 4)
    refined = refine(solve_amplitudes(series, phases={1: 0.4, 3: -1.3}), tolerance=1e-9)
    return replace(refined, warnings=('a "doubt", \u00b5 = 1e-3',))


@pytest.fixture
def file(torus, tmp_path):
    return save(tmp_path / "torus", torus)


def test_a_refined_torus_comes_back_exactly(torus, file):
    bundle = load(file)
    assert same(bundle.torus, torus)
    assert torus.steps
    assert torus.near_resonances
    assert bundle.series is None
    assert same(bundle.torus.positions(TIMES), torus.positions(TIMES))
    assert repr(bundle).startswith(f"Bundle({torus!r}, no verdict, saved 20")


def test_frequencies_found_by_newtons_method_come_back_exactly(torus, tmp_path):
    """Of 25 digits, as those of prescribed amplitudes are; and odd numbers."""
    odd = replace(
        torus,
        frequencies=(Fraction(3**50, 3**51 + 1), Fraction("1.111842345678901234567890")),
        amplitudes={1: -0.0, 3: 5e-324},
        phases={1: -1e-300, 3: 0.1 + 0.2},
        steps=(),
        near_resonances=(),
        warnings=(),
    )
    assert same(load(save(tmp_path / "odd", odd)).torus, odd)


def test_its_test_vectors_are_the_torus(torus, file):
    points = load(file).test_vectors
    times = [float(point.t) for point in points]
    assert len(times) == 3
    assert torus.positions(times).tolist() == [list(map(float, point.Q)) for point in points]
    assert torus.momenta(times).tolist() == [list(map(float, point.P)) for point in points]


def test_flipped_bytes_of_the_arrays_are_found(torus, file):
    """Most are refused; those in fields of the archive that nobody reads change nothing."""
    data, found = file.read_bytes(), 0
    for name in (b"harmonics.npy", b"cosines.npy"):
        for place in range(data.index(name) + len(name), data.index(name) + len(name) + 500, 5):
            file.write_bytes(data[:place] + bytes([data[place] ^ 16]) + data[place + 1 :])
            try:
                assert same(load(file).torus, torus)
            except BundleError:
                found += 1
    assert found > 180


CHANGES = {
    "a coefficient less": lambda m, b: m.update({"cosines.npy": numpy_file(np.zeros(b["torus"]["harmonics"] * 7 - 1))}),
    "a coefficient more": lambda m, b: m.update({"cosines.npy": numpy_file(np.zeros(b["torus"]["harmonics"] * 7 + 1))}),
    "numbers of another kind": lambda m, b: m.update({"cosines.npy": numpy_file(np.zeros(b["torus"]["harmonics"] * 7, "<f4"))}),
    "harmonics that are no integers": lambda m, b: m.update({"harmonics.npy": numpy_file(np.zeros(b["torus"]["harmonics"] * 2))}),
    "no harmonics": lambda m, b: (m.pop("harmonics.npy"), b["arrays"].pop("harmonics")),
    "no cosines": lambda m, b: m.pop("cosines.npy"),
    "another count": lambda m, b: b["torus"].update(harmonics=b["torus"]["harmonics"] - 1),
    "a count of none": lambda m, b: b["torus"].update(harmonics=0),
    "a huge count": lambda m, b: b["torus"].update(harmonics=10**15),
    "a longer chain": lambda m, b: b["torus"].update(N=9),
    "no coupling": lambda m, b: b["torus"].update(alpha="0", beta="0"),
    "a seed outside": lambda m, b: b["torus"].update(seeds=[1, 8]),
    "a seed less": lambda m, b: b["torus"].update(seeds=[1]),
    "a frequency less": lambda m, b: b["torus"].update(frequencies=["0.4"]),
    "a frequency of code": lambda m, b: b["torus"].update(frequencies=["exit()", "1"]),
    "an amplitude less": lambda m, b: b["torus"].update(amplitudes=["0.4"]),
    "a phase more": lambda m, b: b["torus"].update(phases=["0", "0", "0"]),
    "a step of three numbers": lambda m, b: b["torus"].update(steps=[["1", "1", "1"]]),
    "negative products": lambda m, b: b["torus"].update(steps=[["1", "1", "1", -1]]),
    "another kind": lambda m, b: b["torus"].update(kind="other"),
    "neither series nor torus": lambda m, b: b.update(torus=None),
    "NaN": lambda m, b: m.update({"cosines.npy": numpy_file(np.full(b["torus"]["harmonics"] * 7, np.nan))}),
    "no harmonic of a seed": lambda m, b: m.update({"harmonics.npy": numpy_file(np.full(b["torus"]["harmonics"] * 2, 7))}),
    "a negative frequency": lambda m, b: b["torus"].update(frequencies=["-0.4", "1.1"]),
}


@pytest.mark.parametrize("case", CHANGES)
def test_forged_files_are_refused(case, file):
    with pytest.raises(BundleError, match=f"^{file} "):
        load(forged(file, CHANGES[case]))


def test_what_a_later_version_adds_is_ignored(torus, file):
    assert same(load(forged(file, lambda m, b: b["torus"].update(news=1))).torus, torus)


@pytest.mark.parametrize("backend", ["c", "numpy"])
def test_an_evaluator_gives_the_same_orbit(torus, backend):
    if backend == "c":
        program("gcc")
    evaluator = compile_evaluator(torus, backend=backend)
    turned = {1: 2.0, 3: -0.3}
    for phases, expected in ((None, torus), (turned, replace(torus, phases=turned))):
        assert_close(evaluator.positions(TIMES, phases), expected.positions(TIMES))
        assert_close(evaluator.momenta(TIMES, phases), expected.momenta(TIMES))
        assert_close(evaluator.harmonic_energies(TIMES, phases), expected.harmonic_energies(TIMES))
        assert_close(evaluator.energy(TIMES, phases)[:, None], expected.energy(TIMES)[:, None])


def test_an_exported_module_gives_the_same_orbit(torus, tmp_path):
    source = export(torus, "numpy", tmp_path / "orbit").read_text()
    module = {"__name__": "orbit"}
    exec(compile(source, "orbit", "exec"), module)
    assert_close(np.asarray(module["positions"](TIMES)), torus.positions(TIMES))
    assert_close(np.asarray(module["momenta"](TIMES)), torus.momenta(TIMES))
