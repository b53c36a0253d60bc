"""Files of solutions of every kind of chain: as they were, to the last bit; forgeries are refused."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symfpu import BundleError, Chain, InputError, Newton, Torus, lindstedt, load, refine, save, saved_file, solve_amplitudes, toda, unfold
from tests.every_result import result
from tests.store.test_damage import forged, numpy_file
from tests.store.test_saved_file import POTENTIALS, opened, same, waves
from tests.tori.solutions import CASES


def fields_in(body):
    return body["result"]["fields"]


def torus_field(**changes):
    return lambda members, body: fields_in(body).update(changes)


def chain_entry(**changes):
    return lambda members, body: fields_in(body)["chain"]["chain"].update(changes)


def series_entry(**changes):
    return lambda members, body: body["parts"][0].update(changes)


def origin_field(**changes):
    return lambda members, body: fields_in(body)["origin"]["fields"].update(changes)


def fractions(*values):
    return {"tuple": [{"fraction": value} for value in values]}


def by_seed(*values):
    return {"dict": [[q, {"float": value}] for q, value in enumerate(values, 1)]}


def step(*values):
    names = ("residual", "change", "conditions", "krylov")
    fields = dict(zip(names, [*({"float": str(x)} for x in values[:3]), *values[3:]], strict=False))
    return {"tuple": [{"class": "NewtonStep", "fields": fields}]}


def shape(field, key="shape", **changes):
    def change(members, body):
        node = fields_in(body)[field]
        node[key] = changes.get("to") or [n + changes["more"] for n in node[key]]

    return change


def array(name, values):
    return lambda members, body: members.update({f"{name}.npy": numpy_file(values)})


def without_harmonics(members, body):
    members.pop("harmonics.npy")
    body["arrays"].pop("harmonics")


INFINITE = np.full((14, 7), np.inf).ravel()
OF_ORBITS = {
    "another origin": (torus_field(origin={"class": "Chain", "fields": {}}), "no result is of the class"),
    "an origin that is none": (torus_field(origin=1), "Torus.origin is of the type int"),
    "no torus": (lambda members, body: body.update(result=None), "NoneType is no result"),
    "negative frequency": (torus_field(frequencies=fractions("-1.1")), "do not fit the seeds"),
    "two frequencies": (torus_field(frequencies=fractions("1.1", "1.2")), "do not fit the seeds"),
    "a frequency of code": (torus_field(frequencies=fractions("exit()")), "is damaged"),
    "seed outside": (torus_field(seeds={"tuple": [8]}), "seeds"),
    "no harmonics": (shape("harmonics", to=[0, 1]), "bytes where"),
    "many harmonics": (shape("harmonics", to=[10**15, 1]), "bytes where"),
    "digits": (torus_field(digits=20), "for digits 20"),
    "infinite": (array("cosines", INFINITE[: 13 * 7]), "a coefficient that is not finite"),
    "gaps": (array("harmonics", 2 * np.arange(13)), "not those of a periodic orbit"),
    "steps": (origin_field(iterations=-1), "iterations"),
    "sigma": (origin_field(sigma={"float": "exit()"}), "exit"),
}
OF_DIGITS = {
    "no words": (shape("cosines", to=[0, 0]), "0 numbers of 0 words"),
    "many words": (shape("cosines", to=[10**15, 2]), "numbers of 2 words"),
    "a large shape": (shape("cosines", "of", to=[10**15, 7]), "numbers of"),
    "bound": (origin_field(bound={"mpf": {"exact": "exit()"}}), "is no binary number"),
}
OF_WAVES = {
    "ends of a series": (series_entry(ends="fixed"), "is damaged"),
    "seeds of a ring": (series_entry(seeds=[1, 4, -4]), "is damaged"),
    "a high order": (series_entry(order=10**6), "is damaged"),
    "a frequency less of a series": (series_entry(frequencies=["1"]), "is damaged"),
    "a shorter ring": (series_entry(N=3), "is damaged"),
    "unit": (series_entry(unit="none"), "is damaged"),
    "a ring of another name": (series_entry(ring="travelling"), "no ring 'travelling'"),
}
OF_RINGS = {
    "ends of a torus": (chain_entry(ends="round"), "is damaged"),
    "a seed less": (torus_field(seeds={"tuple": [1]}), "is damaged"),
    "a huge count": (shape("cosines", to=[10**9, 1]), "is damaged"),
    "a frequency of zero": (torus_field(frequencies=fractions("0", "1")), "is damaged"),
    "travels": (torus_field(travels=1), "is damaged"),
    "a ring of one": (chain_entry(N=1), "is damaged"),
}


def filled(name, value, more=0, kind="<f8"):
    """An array of the right length, or longer, with one value at every place."""

    def change(members, body):
        count = np.prod(fields_in(body)[name]["shape"])
        members[f"{name}.npy"] = numpy_file(np.full(count + more, value, kind))

    return change


OF_REFINED = {
    "a coefficient less": (filled("cosines", 0.0, -1), "bytes where"),
    "a coefficient more": (filled("cosines", 0.0, 1), "bytes where"),
    "numbers of another kind": (filled("cosines", 0.0, kind="<f4"), "cosines"),
    "NaN": (filled("cosines", np.nan), "not finite"),
    "harmonics that are no integers": (filled("harmonics", 0.0), "harmonics"),
    "no harmonic of a seed": (filled("harmonics", 7, kind="<i8"), "harmonic"),
    "no member with harmonics": (without_harmonics, "harmonics"),
    "no cosines": (lambda members, body: members.pop("cosines.npy"), "cosines"),
    "another count": (shape("harmonics", more=-1), "bytes where"),
    "a count of none": (shape("harmonics", to=[0, 2]), "bytes where"),
    "a huge count": (shape("harmonics", to=[10**15, 2]), "bytes where"),
    "a longer chain": (chain_entry(N=9), "cosines"),
    "no coupling": (chain_entry(alpha="0", beta="0"), "is damaged"),
    "a seed outside": (torus_field(seeds={"tuple": [1, 8]}), "seeds"),
    "a seed less": (torus_field(seeds={"tuple": [1]}), "is damaged"),
    "a frequency less": (torus_field(frequencies=fractions("0.4")), "do not fit the seeds"),
    "a frequency of code": (torus_field(frequencies=fractions("exit()", "1")), "is damaged"),
    "a negative frequency": (torus_field(frequencies=fractions("-0.4", "1.1")), "do not fit the seeds"),
    "an infinite phase": (torus_field(phases=by_seed("inf", "0")), "not finite"),
    "a step of three numbers": (origin_field(steps=step(1, 1, 1)), "is damaged"),
    "negative products": (origin_field(steps=step(1, 1, 1, -1)), "is damaged"),
    "neither series nor torus": (lambda members, body: body.update(result=1), "int is no result"),
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
    loaded = load(save(tmp_path / "torus", torus))
    assert [x._mpf_ for x in loaded.cosines.flat] == [x._mpf_ for x in cosines.flat]
    assert loaded.phases == torus.phases
    assert str(loaded.cosines[1, 0]) == str(torus.cosines[1, 0]) == "0.1"


def torus_of(potential):
    return solve_amplitudes(lindstedt(Chain(8, potential=potential), (1,), ("0.392",), 4))


@pytest.mark.parametrize("potential", POTENTIALS)
def test_a_torus_of_another_potential_comes_back(potential, tmp_path):
    torus = torus_of(potential)
    assert same(load(save(tmp_path / "torus", torus)), torus)


def test_the_potential_stands_in_the_file_and_an_older_reader_is_told(tmp_path):
    _, body = opened(save(tmp_path / "toda", torus_of("toda:1/3")))
    assert body["parts"][0]["potential"] == "toda:1/3"
    assert not {"alpha", "beta"} & body["parts"][0].keys()
    _, body = opened(save(tmp_path / "fpu", torus_of("poly:1/3")))
    assert (body["parts"][0]["alpha"], body["parts"][0]["beta"]) == ("1/3", "0")
    assert "potential" not in body["parts"][0]


@pytest.mark.parametrize("written", ["spring:1", "toda:1,2", "toda:__import__('os')", "toda:0", ""])
def test_an_unknown_potential_is_refused_by_name(written, tmp_path):
    file = save(tmp_path / "toda", torus_of("toda:1/2"))
    forged(file, lambda members, body: body["parts"][0].update(potential=written))
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


def standing():
    return unfold(solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 4)))


def newton():
    return refine(solve_amplitudes(waves(), phases={1: 0.3}))


@pytest.mark.parametrize("made", [lambda: solve_amplitudes(waves(), phases={1: 0.3}), standing, newton])
def test_tori_of_rings_come_back(made, tmp_path):
    torus = made()
    held = saved_file(save(tmp_path / "torus", torus))
    assert same(held.result, torus)
    points = held.test_vectors
    times = [float(point.t) for point in points]
    assert len(times) == 3
    assert torus.Q(times).tolist() == [list(map(complex, point.Q)) for point in points]
    assert torus.P(times).tolist() == [list(map(complex, point.P)) for point in points]


def test_the_ends_stand_in_the_file_of_a_ring_alone(tmp_path):
    _, body = opened(save(tmp_path / "ring", waves()))
    assert body["parts"][0]["ends"] == "periodic"
    fixed = lindstedt(Chain(8, potential="toda:1/2"), (1,), ("0.392",), 2)
    _, body = opened(save(tmp_path / "fixed", fixed))
    assert "ends" not in body["parts"][0]


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
    assert same(load(save(tmp_path / "odd", odd)), odd)
