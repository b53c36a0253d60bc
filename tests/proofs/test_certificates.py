"""Proofs and refutations of the propagation rule."""

import json
import random

import pytest

from symfpu import InputError, SymfpuError, coupling_sequence, excitation_sequence, prove_propagation
from symfpu.proofs.certificates import random_point
from tests.refusals import each, refused
from tests.tolerances import ERROR_PROBABILITY


def test_proved_case():
    proof = prove_propagation(32, (1, 2, 3, 4), 4)
    assert proof.verdict == "proved"
    assert list(proof.actual) == excitation_sequence(32, (1, 2, 3, 4), 4)
    assert proof.exceptions == ()
    assert proof.undecided == ()


def test_without_points_nothing_is_decided_but_what_the_couplings_forbid():
    proof = prove_propagation(8, (1, 4), 2, model="beta", points=0)
    assert proof.verdict == "undecided"
    assert all(u.error_probability == 1 for u in proof.undecided)
    assert {v.by for v in proof.vanishing} == {"couplings"}
    assert 7 not in {q for u in proof.undecided for q in u.orders if 1 in u.orders}


@pytest.fixture
def couplings_forbid_nothing(monkeypatch):
    monkeypatch.setattr("symfpu.proofs.certificates.coupled_modes", lambda *_, **__: [(1, 2, 3, 4, 5)] * 3)


def test_identities_close_what_couplings_leave_open(couplings_forbid_nothing):
    """The zero term of an exception is proved by the universal form instead."""
    proof = prove_propagation(6, (2, 3), 2, model="beta")
    assert proof.verdict == "refuted"
    assert [(v.mode, v.orders, v.by) for v in proof.vanishing] == [(4, (1,), "identity")]


def test_zero_without_a_proof_is_undecided_with_a_probability(couplings_forbid_nothing, monkeypatch):
    monkeypatch.setattr("symfpu.proofs.certificates.IDENTITY_TERMS", 0)
    once, twice = (prove_propagation(6, (2, 3), 2, model="beta", points=n) for n in (1, 2))
    assert once.verdict == twice.verdict == "undecided"
    assert [(u.mode, u.orders) for u in once.undecided] == [(4, (1,))]
    assert 0 < once.undecided[0].error_probability < ERROR_PROBABILITY
    assert twice.undecided[0].error_probability < once.undecided[0].error_probability ** 1.5


def test_points_are_reproducible_and_independent():
    a, b, c = (prove_propagation(12, (5,), 3, points=2, random_seed=seed) for seed in (1, 1, 2))
    assert a == b
    assert a.points != c.points
    assert a.points[0].prime != a.points[1].prime
    assert a.actual == c.actual


def test_roots_of_points_are_primitive():
    """Also where 4N has several prime factors."""
    for N in (6, 15, 30):
        point = random_point(N, 2, 4, random.Random(N))
        assert point.prime % (4 * N) == 1
        powers = {pow(point.root, k, point.prime) for k in range(4 * N)}
        assert len(powers) == 4 * N
        assert pow(point.root, 4 * N, point.prime) == 1


LARGER = [(24, (5, 7, 12), 3, "beta"), (40, (3, 20, 37), 2, "beta"), (64, (31, 32, 33), 3, "beta"), (30, (7, 15, 22), 5, "alpha")]


@pytest.mark.parametrize(("N", "seeds", "order", "model"), LARGER)
def test_corrected_rule_on_larger_cases(N, seeds, order, model):
    assert prove_propagation(N, seeds, order, model=model).actual == tuple(coupling_sequence(N, seeds, order, model=model))


def test_certificate_is_plain_json(tmp_path):
    proof = prove_propagation(8, (1, 4), 3, model="beta")
    proof.write(tmp_path / "c.json")
    assert json.loads((tmp_path / "c.json").read_text()) == proof.certificate()
    assert list(tmp_path.iterdir()) == [tmp_path / "c.json"]
    with pytest.raises(InputError, match="output"):
        proof.write(tmp_path / "missing" / "c.json")


@each(N=[1], seeds=[(8,), ()], order=[-1], model=["alpha+beta"], points=[-1])
def test_bad_arguments_are_named(name, value):
    refused(prove_propagation, name, value, N=8, seeds=(1,), order=2)


def test_order_too_high_for_exact_sums_says_so():
    with pytest.raises(SymfpuError, match="take a lower order"):
        random_point(4096, 8, 60, random.Random(1))


def test_the_reason_is_the_sign_where_all_folds_have_one_parity():
    # one seed: Theorem 4 of docs/propagation.md
    assert prove_propagation(9, (1,), 4).reason == "sign"
    mixed = prove_propagation(8, (1, 4), 3, model="beta")
    # 7 = 8 - 1 is excited at order 2, not at that of the rule: no sum shows it
    assert mixed.reason == "sign and residues"
    assert 7 not in mixed.by_sign
    assert {2, 3, 6} <= mixed.by_sign
    assert prove_propagation(8, (1,), 2, potential="toda:1").reason == "residues"
    assert prove_propagation(2, (1,), 3).reason == "couplings"
