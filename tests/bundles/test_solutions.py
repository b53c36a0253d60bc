"""Files of solutions of every kind of chain: as they were, to the last bit; forgeries are refused."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symfpu import BundleError, Chain, InputError, Newton, Torus, lindstedt, refine, solve_amplitudes, toda, unfold
from symfpu.bundles.bundle import load, save
from tests.bundles.test_bundle import opened, same
from tests.bundles.test_bundle_damage import forged, numpy_file
from tests.every_result import result
from tests.tori.solutions import CASES


def torus_entry(**changes):
    return lambda members, body: body["torus"].update(changes)


def series_entry(**changes):
    return lambda members, body: body["series"].update(changes)


def made_entry(**changes):
    return lambda members, body: body["torus"]["made"].update(changes)


def array(name, values):
    return lambda members, body: members.update({f"{name}.npy": numpy_file(values)})


def without_harmonics(members, body):
    members.pop("harmonics.npy")
    body["arrays"].pop("harmonics")


INFINITE = np.full((14, 7), np.inf).ravel()
OF_ORBITS = {
    "another origin": (torus_entry(origin="Chain"), "no solution is of the origin 'Chain'"),
    "another kind": (torus_entry(kind="sums"), "a torus of kind 'sums' without a series"),
    "no torus": (lambda members, body: body.update(torus=None), "a torus of kind None"),
    "negative frequency": (torus_entry(frequencies=["-1.1"]), "do not fit the seeds"),
    "two frequencies": (torus_entry(frequencies=["1.1", "1.2"]), "do not fit the seeds"),
    "a frequency of code": (torus_entry(frequencies=["exit()"]), "is damaged"),
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
OF_DIGITS = {
    "no words": (torus_entry(words=0), "words = 0"),
    "many words": (torus_entry(words=10**15), "bytes where"),
    "bound": (made_entry(bound={"exact": "exit()"}), "is no binary number"),
}
OF_WAVES = {
    "ends of a series": (series_entry(ends="fixed"), "is damaged"),
    "seeds of a ring": (series_entry(seeds=[1, 4, -4]), "is damaged"),
    "a high order": (series_entry(order=10**6), "is damaged"),
    "a frequency less of a series": (series_entry(frequencies=["1"]), "is damaged"),
    "a shorter ring": (series_entry(N=3), "is damaged"),
    "unit": (series_entry(unit="none"), "is damaged"),
    "a ring of before": (series_entry(ring="travelling"), r"make it again: lindstedt\(chain"),
}
OF_RINGS = {
    "ends of a torus": (torus_entry(ends="round"), "is damaged"),
    "a seed less": (torus_entry(seeds=[1]), "is damaged"),
    "a huge count": (torus_entry(harmonics=10**9), "is damaged"),
    "a phase less": (torus_entry(phases=["0"]), "is damaged"),
    "a frequency of zero": (torus_entry(frequencies=["0", "1"]), "is damaged"),
    "travels": (torus_entry(travels=1), "is damaged"),
    "a ring of one": (torus_entry(N=1), "is damaged"),
}


def filled(name, value, more=0, kind="<f8"):
    """An array of the right length, or longer, with one value at every place."""

    def change(members, body):
        entry = body["torus"]
        width = entry["N"] - 1 if name == "cosines" else len(entry["seeds"])
        members[f"{name}.npy"] = numpy_file(np.full(entry["harmonics"] * width + more, value, kind))

    return change


def one_less(members, body):
    body["torus"]["harmonics"] -= 1


OF_REFINED = {
    "a coefficient less": (filled("cosines", 0.0, -1), "bytes where"),
    "a coefficient more": (filled("cosines", 0.0, 1), "bytes where"),
    "numbers of another kind": (filled("cosines", 0.0, kind="<f4"), "cosines"),
    "NaN": (filled("cosines", np.nan), "not finite"),
    "harmonics that are no integers": (filled("harmonics", 0.0), "harmonics"),
    "no harmonic of a seed": (filled("harmonics", 7, kind="<i8"), "harmonic"),
    "no member with harmonics": (without_harmonics, "harmonics"),
    "no cosines": (lambda members, body: members.pop("cosines.npy"), "cosines"),
    "another count": (one_less, "bytes where"),
    "a count of none": (torus_entry(harmonics=0), "harmonics = 0"),
    "a huge count": (torus_entry(harmonics=10**15), "bytes where"),
    "a longer chain": (torus_entry(N=9), "bytes where"),
    "no coupling": (torus_entry(alpha="0", beta="0"), "is damaged"),
    "a seed outside": (torus_entry(seeds=[1, 8]), "seeds"),
    "a seed less": (torus_entry(seeds=[1]), "is damaged"),
    "a frequency less": (torus_entry(frequencies=["0.4"]), "do not fit the seeds"),
    "a frequency of code": (torus_entry(frequencies=["exit()", "1"]), "is damaged"),
    "a negative frequency": (torus_entry(frequencies=["-0.4", "1.1"]), "do not fit the seeds"),
    "a phase more": (torus_entry(phases=["0", "0", "0"]), "do not fit the seeds"),
    "a step of three numbers": (made_entry(steps=[["1", "1", "1"]]), "is damaged"),
    "negative products": (made_entry(steps=[["1", "1", "1", -1]]), "is damaged"),
    "another kind": (torus_entry(kind="other"), "a torus of kind"),
    "neither series nor torus": (lambda members, body: body.update(torus=None), "a torus of kind None"),
}
FORGED = {"HarmonicBalance": OF_ORBITS, "IterativeRefinement, breather": OF_DIGITS, "Newton": OF_REFINED}
FORGED |= {"waves": OF_WAVES, "Newton of waves": OF_RINGS, "fixed": {"ends": (series_entry(ends="periodic"), "is damaged")}}


@pytest.mark.parametrize(("kind", "case"), [(kind, case) for kind, changes in FORGED.items() for case in changes])
def test_forged_solutions_are_refused(kind, case, tmp_path):
    file = save(tmp_path / "kept", results_to_forge(kind))
    change, message = FORGED[kind][case]
    forged(file, change)
    with pytest.raises(BundleError, match=message) as caught:
        load(file)
    assert str(caught.value).startswith(f"{file} ")
    assert "\n" not in str(caught.value)


def results_to_forge(kind):
    """A solution of tests/every_result.py or of tests/tori/solutions.py, or a series."""
    if kind == "waves":
        return waves()
    if kind == "Newton of waves":
        return newton()
    if kind == "fixed":
        return lindstedt(Chain(8, alpha="0.3"), (1,), ("0.392",), 2)
    return CASES[kind]() if kind in CASES else result(kind)


@pytest.mark.parametrize("name", ["HarmonicBalance", "IterativeRefinement"])
def test_what_is_not_finite_is_not_written(name, tmp_path):
    orbit = CASES[name]()
    cosines = orbit.cosines.copy()
    cosines[2, 2] = float("inf") * cosines[1, 2]
    spoilt = replace(orbit, cosines=cosines)
    with pytest.raises(InputError, match=r"^result = .*finite"):
        save(tmp_path / "orbit", spoilt)
    assert not list(tmp_path.iterdir())


def test_numbers_of_many_digits_keep_every_bit(tmp_path):
    """Tiny and large ones, with signs, whole and zero."""
    with mpmath.workdps(60):
        values = [mpmath.mpf(2) ** -3000 / 3, -(mpmath.mpf(10) ** 40) / 7, mpmath.mpf(0), mpmath.mpf(-1), *[mpmath.mpf("0.1")] * 3]
    precise = CASES["IterativeRefinement, breather"]()
    cosines = np.array([values, values[::-1]], dtype=object)
    harmonics = precise.harmonics[:2]
    torus = Torus(precise.chain, precise.seeds, precise.frequencies, harmonics, cosines, {3: mpmath.mpf("0.25")}, 40)
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


@pytest.mark.parametrize("law", [{"potential": "toda:1/2"}, {"beta": "1/3"}, {"alpha": "1/3", "beta": "-1/5"}])
@pytest.mark.parametrize("order", [0, 1, 5])
def test_series_come_back(law, order, tmp_path):
    series = waves(order, **law)
    kept = load(save(tmp_path / "waves", series)).series
    assert same(kept, series)
    squares = [0.01, 0.02]
    assert np.array_equal(kept.frequency_terms(squares)[0], series.frequency_terms(squares)[0])


def standing():
    return unfold(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 4)))


def newton():
    return refine(solve_amplitudes(waves(), phases={1: 0.3}))


@pytest.mark.parametrize("made", [lambda: solve_amplitudes(waves(), phases={1: 0.3}), standing, newton])
def test_tori_of_rings_come_back(made, tmp_path):
    torus = made()
    bundle = load(save(tmp_path / "torus", torus))
    assert same(bundle.torus, torus)
    points = bundle.test_vectors
    times = [float(point.t) for point in points]
    assert len(times) == 3
    assert torus.Q(times).tolist() == [list(map(complex, point.Q)) for point in points]
    assert torus.P(times).tolist() == [list(map(complex, point.P)) for point in points]


def test_the_ends_stand_in_the_file_of_a_ring_alone(tmp_path):
    _, body = opened(save(tmp_path / "ring", waves()))
    assert body["series"]["ends"] == "periodic"
    fixed = lindstedt(Chain(8, potential="toda:1/2"), (1,), ("0.392",), 2)
    _, body = opened(save(tmp_path / "fixed", fixed))
    assert "ends" not in body["series"]


def test_frequencies_found_by_newtons_method_come_back_exactly(tmp_path):
    """Of 25 digits, as those of prescribed amplitudes are; and odd numbers."""
    series = lindstedt(Chain(8, alpha="1/3", beta="0.2"), (1, 3), (Fraction("0.3904"), Fraction("1.1118")), 4)
    odd = replace(
        refine(solve_amplitudes(series), tolerance=1e-9),
        frequencies=(Fraction(3**50, 3**51 + 1), Fraction("1.111842345678901234567890")),
        phases={1: -1e-300, 3: 0.1 + 0.2},
        origin=Newton((), ()),
        warnings=(),
    )
    assert same(load(save(tmp_path / "odd", odd)).torus, odd)
