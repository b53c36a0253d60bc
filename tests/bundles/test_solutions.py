"""Files of solutions of every kind of chain: as they were, to the last bit; forgeries are refused."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symfpu import (
    BundleError,
    Chain,
    FourierTorus,
    InputError,
    PeriodicOrbit,
    PreciseTorus,
    lindstedt,
    refine,
    solve_amplitudes,
    toda,
    unfold,
)
from symfpu.bundles.bundle import load, save
from tests.bundles.test_bundle import opened, same
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
    file = save(tmp_path / "orbit", CASES["PreciseTorus, breather"]())
    change, message = DIGITS[case]
    forged(file, change)
    with pytest.raises(BundleError, match=message):
        load(file)


@pytest.mark.parametrize("name", ["PeriodicOrbit", "PreciseTorus"])
def test_what_is_not_finite_is_not_written(name, tmp_path):
    orbit = CASES[name]()
    cosines = orbit.cosines.copy()
    cosines[2, 2] = float("inf") * cosines[1, 2]
    fields = orbit.chain, orbit.seeds, orbit.frequencies, orbit.harmonics, cosines, orbit.phases, orbit.digits
    spoilt = (
        PeriodicOrbit(*fields, iterations=1, sigma=0.1) if name == "PeriodicOrbit" else PreciseTorus(*fields, bound=orbit.bound, sweeps=1)
    )
    with pytest.raises(InputError, match=r"^result = .*finite"):
        save(tmp_path / "orbit", spoilt)
    assert not list(tmp_path.iterdir())


def test_numbers_of_many_digits_keep_every_bit(tmp_path):
    """Tiny and large ones, with signs, whole and zero."""
    with mpmath.workdps(60):
        values = [mpmath.mpf(2) ** -3000 / 3, -(mpmath.mpf(10) ** 40) / 7, mpmath.mpf(0), mpmath.mpf(-1), *[mpmath.mpf("0.1")] * 3]
    precise = CASES["PreciseTorus, breather"]()
    cosines = np.array([values, values[::-1]], dtype=object)
    harmonics = precise.harmonics[:2]
    torus = FourierTorus(precise.chain, precise.seeds, precise.frequencies, harmonics, cosines, {3: mpmath.mpf("0.25")}, 40)
    loaded = load(save(tmp_path / "torus", torus)).torus
    assert [x._mpf_ for x in loaded.cosines.flat] == [x._mpf_ for x in cosines.flat]
    assert loaded.phases == torus.phases
    assert str(loaded.cosines[1, 0]) == str(torus.cosines[1, 0]) == "0.1"


POTENTIALS = ["toda:1/2", "lj:12,6", "poly:1/3,0,1/5", "poly:0,0,0,1/5"]
FREQUENCY = ("0.392",)


def torus_of(potential):
    return solve_amplitudes(lindstedt(Chain(8, potential=potential), (1,), FREQUENCY, 4))


@pytest.mark.parametrize("kind", ["torus", "universal", "digits"])
@pytest.mark.parametrize("potential", POTENTIALS)
def test_what_is_of_another_potential_comes_back(potential, kind, tmp_path):
    chosen = {"frequencies": FREQUENCY, "digits": 30} if kind == "digits" else {}
    result = torus_of(potential) if kind == "torus" else lindstedt(Chain(8, potential=potential), (1,), order=2, **chosen)
    kept = load(save(tmp_path / "result", result))
    assert same(kept.torus or kept.series, result)


def test_the_potential_stands_in_the_file_and_an_older_reader_is_told(tmp_path):
    _, body = opened(save(tmp_path / "toda", torus_of("toda:1/3")))
    assert body["series"]["potential"] == "toda:1/3"
    assert not {"alpha", "beta"} & body["series"].keys()
    _, body = opened(save(tmp_path / "fpu", torus_of("poly:1/3")))
    assert (body["series"]["alpha"], body["series"]["beta"]) == ("1/3", "0")
    assert "potential" not in body["series"]


@pytest.mark.parametrize("written", ["spring:1", "toda:1,2", "toda:__import__('os')", "toda:0", ""])
def test_an_unknown_potential_is_refused_by_name(written, tmp_path):
    file = save(tmp_path / "toda", torus_of("toda:1/2"))
    forged(file, lambda members, body: body["series"].update(potential=written))
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


OMEGA = ("0.7661", "1.8486")


def waves(order=6, **law):
    chain = Chain(8, **(law or {"potential": "toda:1/2"}), ends="periodic")
    return lindstedt(chain, (1, -3), OMEGA, order)


def standing():
    return unfold(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 4)))


@pytest.mark.parametrize("law", [{"potential": "toda:1/2"}, {"beta": "1/3"}, {"alpha": "1/3", "beta": "-1/5"}])
@pytest.mark.parametrize("order", [0, 1, 5])
def test_series_come_back(law, order, tmp_path):
    series = waves(order, **law)
    kept = load(save(tmp_path / "waves", series)).series
    assert same(kept, series)
    squares = [0.01, 0.02]
    assert np.array_equal(kept.frequency_terms(squares)[0], series.frequency_terms(squares)[0])


def newton():
    return refine(solve_amplitudes(waves(), phases={1: 0.3}))


@pytest.mark.parametrize("made", [lambda: solve_amplitudes(waves(), phases={1: 0.3}), standing, newton])
def test_tori_come_back(made, tmp_path):
    torus = made()
    bundle = load(save(tmp_path / "torus", torus))
    assert same(bundle.torus, torus)
    assert np.array_equal(bundle.torus.Q([0.0, 3.3]), torus.Q([0.0, 3.3]))
    first = bundle.test_vectors[0]
    assert [complex(Q) for Q in first.Q] == torus.Q(0.0).tolist()
    assert len(first.P) == torus.chain.N - 1


def test_the_ends_stand_in_the_file_of_a_ring_alone(tmp_path):
    _, body = opened(save(tmp_path / "ring", waves()))
    assert body["series"]["ends"] == "periodic"
    fixed = lindstedt(Chain(8, potential="toda:1/2"), (1,), ("0.392",), 2)
    _, body = opened(save(tmp_path / "fixed", fixed))
    assert "ends" not in body["series"]


def test_a_series_of_waves_in_the_format_before_is_refused_with_what_helps(tmp_path):
    file = save(tmp_path / "waves", waves())
    forged(file, lambda members, body: body["series"].update(ring="travelling"))
    with pytest.raises(BundleError, match=r"make it again: lindstedt\(chain"):
        load(file)


LIES = {
    "series": {"ends": "fixed", "seeds": [1, 4, -4], "order": 10**6, "frequencies": ["1"], "N": 3, "unit": "none"},
    "torus": {"ends": "round", "seeds": [1], "harmonics": 10**9, "phases": ["0"], "frequencies": ["0", "1"], "travels": 1, "N": 1},
}


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, lies in LIES.items() for name in lies])
def test_a_file_that_lies_is_refused(kind, name, tmp_path):
    file = save(tmp_path / "waves", waves() if kind == "series" else newton())
    forged(file, lambda members, body: body[kind].update({name: LIES[kind][name]}))
    with pytest.raises(BundleError, match="is damaged") as caught:
        load(file)
    assert "\n" not in str(caught.value)


def test_a_chain_with_fixed_ends_is_no_ring_whatever_its_file_says(tmp_path):
    file = save(tmp_path / "fixed", lindstedt(Chain(8, alpha="0.3"), (1,), ("0.392",), 2))
    forged(file, lambda members, body: body["series"].update(ends="periodic"))
    with pytest.raises(BundleError, match="is damaged"):
        load(file)


@pytest.fixture(scope="module")
def torus():
    """Two seeds in no order of the chain's, phases, a doubt, and numbers that are no short decimals."""
    series = lindstedt(Chain(8, alpha="1/3", beta="0.2"), (1, 3), (Fraction("0.3904"), Fraction("1.1118")), 4)
    refined = refine(solve_amplitudes(series, phases={1: 0.4, 3: -1.3}), tolerance=1e-9)
    return replace(refined, warnings=('a "doubt", \u00b5 = 1e-3',))


@pytest.fixture
def file(torus, tmp_path):
    return save(tmp_path / "torus", torus)


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
    assert torus.Q(times).tolist() == [list(map(complex, point.Q)) for point in points]
    assert torus.P(times).tolist() == [list(map(complex, point.P)) for point in points]


OF_REFINED = {
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


@pytest.mark.parametrize("case", OF_REFINED)
def test_forged_tori_are_refused(case, file):
    with pytest.raises(BundleError, match=f"^{file} "):
        load(forged(file, OF_REFINED[case]))


def test_what_a_later_version_adds_is_ignored(torus, file):
    assert same(load(forged(file, lambda m, b: b["torus"].update(news=1))).torus, torus)
