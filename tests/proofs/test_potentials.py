"""Proofs of the propagation rule for any potential: prover, checker and universal form agree; what proves nothing is refused."""

import json
from fractions import Fraction

import pytest

from symfpu import Chain, InputError, coupling_sequence, lemma_holds, lindstedt, prove_propagation, sweep_propagation
from symfpu.chain.potentials.toda import Toda
from symfpu.chain.potentials.typed import potential_of_text
from symfpu.checkers.propagation import NAMED_POTENTIALS, verify
from symfpu.checkers.reading import CertificateError
from symfpu.proofs.leading import leading_terms
from tests.checkers.certificate_files import sealed
from tests.checkers.test_forgeries import is_valid
from tests.checkers.test_propagation import SAYS
from tests.refusals import each, refused

CASES = {
    "toda:1/2": (8, (1, 4), 3),
    "lj:12,6": (9, (2, 4), 3),
    "poly:1": (7, (3, 5), 3),  # alpha
    "poly:1/2": (5, (1, 2), 4),
    "poly:0,1": (6, (2, 3), 2),  # beta
    "poly:1,2/3": (7, (3,), 4),
    "poly:0,1,0,1/2": (6, (2, 3), 2),  # even
    "poly:0,1,2": (6, (2, 3), 3),  # no terms of order 1
    "poly:0,0,0,1": (6, (2, 3), 2),
}


@pytest.fixture(scope="module", params=CASES)
def typed(request):
    return request.param


@pytest.fixture(scope="module")
def proof(typed):
    return prove_propagation(*CASES[typed], potential=typed)


def said_of(proof):
    """The model where one coupling makes the chain one, else the potential."""
    return f"in the {proof.model} chain" if proof.model in ("alpha", "beta") else f"potential {proof.potential.text},"


@pytest.fixture(scope="module")
def toda():
    return json.loads(json.dumps(prove_propagation(6, (2,), 3, potential="toda:1/2").certificate()))


def first_orders(series):
    """The first order at which a mode has a coefficient that is not the zero polynomial."""
    first = {}
    for k, table in enumerate(series.coordinates):
        for q in range(1, series.chain.N):
            if any(value != 0 for value in table[:, q - 1]):
                first.setdefault(q, k)
    return first


def test_actual_orders_are_those_of_the_universal_form(typed, proof):
    """By another ring: the first order at which a coefficient is not the zero polynomial in the L_q(nu)."""
    series = lindstedt(Chain(proof.N, potential=typed), proof.seeds, order=proof.order)
    assert {q: k for k, modes in enumerate(proof.actual) for q in modes} == first_orders(series)
    assert proof.undecided == ()


def test_the_corrected_rule_gives_the_actual_sets(typed, proof):
    assert tuple(coupling_sequence(proof.N, proof.seeds, proof.order, potential=typed)) == proof.actual


def test_certificates_are_valid_by_the_other_route(proof, tmp_path):
    proof.write(tmp_path / "c.json")
    lines = verify(tmp_path / "c.json")
    assert said_of(proof) in lines[0]
    assert SAYS[proof.verdict] in lines[0]


def test_the_certificate_names_potential_step_and_coefficients(toda):
    assert toda["schema"] == 2
    assert (toda["potential"], toda["step"], toda["coefficients"]) == ("toda:0.5", 1, ["1/2", "1/6", "1/24"])
    assert "model" not in toda


def test_a_pair_with_sum_N_beside_a_third_seed_fails_wherever_squares_do_not_act():
    """The exception of the beta model in a potential of higher degree; Toda's squares lead there all the same."""
    for potential in ("poly:0,1,0,1/2", "poly:0,1,2"):
        proof = prove_propagation(8, (1, 4), 2, potential=potential)
        assert [e.mode for e in proof.exceptions] == [7]
    assert prove_propagation(8, (1, 4), 2, potential="toda:1").verdict == "proved"


@pytest.mark.parametrize(("potential", "model"), [("poly:1/3", "alpha"), ("poly:0,5", "beta")])
def test_one_coupling_is_the_model_whatever_its_strength(potential, model):
    """The strength scales the amplitudes: the same certificate, to the last byte."""
    by_potential, by_model = (prove_propagation(7, (2,), 2, **law) for law in ({"potential": potential}, {"model": model}))
    assert json.dumps(by_potential.certificate()) == json.dumps(by_model.certificate())
    assert by_potential.model == model


def test_both_couplings_are_followed_power_by_power():
    for N, seeds in ((6, (2, 3)), (8, (1, 4)), (6, (3,)), (9, (3, 6))):
        series = lindstedt(Chain(N, alpha=1, beta="3/7"), seeds, order=3)
        sets = coupling_sequence(N, seeds, 3, model="alpha+beta")
        assert {q: k for k, modes in enumerate(sets) for q in modes} == first_orders(series)


def test_primes_that_divide_a_denominator_are_passed_over():
    prime = prove_propagation(6, (1,), 2, potential="toda:1").points[0].prime
    other = prove_propagation(6, (1,), 2, potential=f"poly:1,1/{prime}")
    assert other.points[0].prime != prime
    assert other.verdict == "proved"


# --- the checker


@pytest.mark.parametrize(
    "change",
    [
        {"potential": "toda:1/3"},
        {"potential": "toda:1/2,1"},
        {"potential": "toda:1/0"},
        {"potential": "lennard_jones:6,6"},
        {"potential": "polynomial:1/2,1/6"},
        {"potential": "toda"},
        {"potential": ["toda:1/2"]},
        {"coefficients": ["1/2", "1/6", "1/0"]},
        {"coefficients": ["0.5", "1/6", "1/24"]},
        {"coefficients": "1/2"},
        {"step": 2},
        {"step": 2, "coefficients": ["1/2", "1/6", "1/24", "1", "1", "1"], "potential": "mine:1"},
        {"step": 0, "coefficients": []},
    ],
)
def test_what_is_no_such_potential_is_refused(toda, change, tmp_path):
    assert is_valid(toda, tmp_path)
    assert not is_valid(sealed(toda | change), tmp_path)


def test_a_name_that_the_checker_does_not_know_is_said_to_be_unchecked(toda, tmp_path):
    (tmp_path / "c.json").write_text(json.dumps(sealed(toda | {"potential": "mine:1/2"})))
    assert "mine:1/2 (its coefficients as written, the name not checked)" in verify(tmp_path / "c.json")[0]


def test_coefficients_longer_than_any_use_are_refused(toda, tmp_path):
    (tmp_path / "c.json").write_text(json.dumps(sealed(toda | {"coefficients": ["1" * 40_000] * 3})))
    with pytest.raises(CertificateError, match="too long"):
        verify(tmp_path / "c.json")


@pytest.mark.parametrize("typed", ["toda:-2/3", "lj:12,6", "lj:5/2,1", "poly:1,0,-2/7"])
def test_the_checker_knows_the_coefficients_by_itself(typed):
    potential = potential_of_text(typed)
    own = NAMED_POTENTIALS[potential.kind]
    for n in range(3, 12):
        assert own(n, *potential.parameters) == potential.coefficient(n)


# --- refusals


class Rounded(Toda):
    exact = False


@each(model=["alpha"], potential=["spring:1", Rounded(Fraction(1, 2))])
def test_what_proves_nothing_is_refused_by_name(name, value):
    """Also a model beside a potential."""
    refused(prove_propagation, name, value, N=6, seeds=(1,), order=2, potential="toda:1")


@pytest.mark.parametrize("closed_form", [lambda chain: leading_terms(chain, (1,), 2), lambda chain: lemma_holds(chain, (1,), 2)])
def test_closed_forms_of_both_models_refuse_other_chains_by_name(closed_form):
    with pytest.raises(InputError, match=r"^chain = .*toda\(0\.5\)"):
        closed_form(Chain(8, potential="toda:1/2"))


# --- sweeps


def test_a_sweep_of_a_potential_goes_on_from_its_file_and_from_no_other(tmp_path, threads):
    kept = {"executor": threads, "file": tmp_path / "toda.jsonl"}
    first = sweep_propagation((4, 5), 1, 2, potential="toda:1", **kept)
    longer = sweep_propagation((4, 5, 6), 2, 2, potential="toda:1", **kept)
    for order, potential in ((2, "toda:2"), (3, "toda:1")):
        with pytest.raises(InputError, match=r"^file = "):
            sweep_propagation((4, 5), 1, order, potential=potential, **kept)
    assert (first.model, len(first.cases)) == ("toda:1", 7)
    assert set(first.cases) <= set(longer.cases)
    assert all(case.verdict == "proved" and case.corrected_rule_holds for case in longer.cases)


SWEPT = {
    "toda:1/2": (5, 0),
    "lj:12,6": (5, 0),
    "poly:1,2/3": (5, 0),
    "poly:1,2": (5, 0),
    "poly:0,1,1": (4, 40),
    "poly:0,1,0,1/2": (3, 40),
    "poly:0,0,1": (6, 13),
}


@pytest.mark.long
@pytest.mark.parametrize("potential", SWEPT)
def test_sweeps_of_the_page(potential, threads):
    """docs/propagation.md: exceptions where no squares act, and none of the corrected rule."""
    order, exceptions = SWEPT[potential]
    sweep = sweep_propagation(range(2, 11), 3, order, potential=potential, executor=threads)
    assert len(sweep.cases) == 375
    assert (len(sweep.exceptions), {case.verdict for case in sweep.cases} - {"proved", "refuted"}) == (exceptions, set())
    assert all(case.corrected_rule_holds for case in sweep.cases)
