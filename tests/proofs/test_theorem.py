"""The rule for every N, against the recursion at seed sets which the proof never saw."""

import json
import random
from itertools import combinations_with_replacement, permutations, product
from math import pi, sin
from operator import mul

import pytest

from symfpu import InputError, RuleForAllN, prove_for_all_N, prove_propagation
from symfpu.chain.propagation import product_couplings
from symfpu.checkers.every_length import read_claim
from symfpu.checkers.propagation import MODELS, Budget, Case, Point, Recursion
from symfpu.checkers.reading import CertificateError
from symfpu.checkers.verify import verify as verify_certificate
from symfpu.cli.main import main
from symfpu.proofs.certificates import random_point
from symfpu.proofs.decided_file import DecidedFile
from symfpu.proofs.every_length import decided_flat
from symfpu.proofs.flats import Flat, last_order
from symfpu.proofs.plus_terms import BOTH, MINUS, PLUS, PlusResidues, PlusTerms, sign_product, splits
from tests.refusals import each, refused


def test_exceptions_are_those_of_the_recursion_at_other_lengths():
    proof = prove_for_all_N("beta", 2, 1)
    assert proof.verdict == "refuted"
    source = random.Random(18)
    half = [(N, (q, N // 2)) for N in (10, 14, 22) for q in (1, 3, 4)]
    others = [(N, tuple(source.sample(range(1, N), 2))) for N in (17, 18, 21) for _ in range(4)]
    refuted = 0
    for N, seeds in [*half, *others]:
        case = prove_propagation(N, seeds, 1, model="beta")
        found = proof.deciding(N, seeds)
        assert (case.verdict == "refuted") == bool(found.exceptions), (N, seeds)
        refuted += bool(found.exceptions)
    assert len(half) <= refuted < len(others)


def test_one_seed_is_a_theorem_by_sign_alone():
    for model, order in (("alpha", 6), ("beta", 4)):
        proof = prove_for_all_N(model, 1, order)
        assert (proof.verdict, proof.reason, proof.gaps) == ("proved", "sign", ())
        assert all(found.by_sign for found in proof.decided)
        assert "for generic frequencies" in proof.theorem


@pytest.mark.long
@pytest.mark.parametrize(("model", "s", "order", "count"), [("alpha", 1, 20, 271), ("beta", 1, 9, 120), ("alpha", 2, 3, 1057)])
def test_theorems_of_alpha_and_of_one_seed(model, s, order, count):
    proof = prove_for_all_N(model, s, order)
    assert (proof.verdict, proof.flats, proof.exceptional_flats) == ("proved", count, ())


@pytest.mark.long
def test_a_theorem_that_needs_residues(tmp_path):
    proof = prove_for_all_N("alpha", 2, 4)
    assert (proof.verdict, proof.reason) == ("proved", "sign and chains and residues")
    assert proof.theorem.endswith(f"on {len(proof.gaps)} flats for generic L_q(nu) instead")
    path = tmp_path / "c.json"
    proof.write(path)
    assert verify_certificate(path)[0] == proof.theorem


@pytest.mark.long
def test_representatives_decide_as_the_recursion_does():
    source = random.Random(18)
    for model, s, order in (("alpha", 2, 3), ("beta", 2, 2), ("alpha", 3, 1), ("beta", 3, 1)):
        proof = prove_for_all_N(model, s, order)
        for found in source.sample(proof.decided, 25):
            flat = found.flat
            case = prove_propagation(flat.N, flat.seeds, order, model=model)
            assert found.exceptions == case.exceptions, flat


def test_multiples_of_a_representative_are_decided_alike():
    for model, flat in (("beta", Flat(8, (1, 4), 1)), ("alpha", Flat(5, (1, 4), 0))):
        twice = Flat(2 * flat.N, tuple(2 * q for q in flat.seeds), flat.dimension)
        small, large = decided_flat(model, 3, flat), decided_flat(model, 3, twice)
        doubled = [(2 * e.mode, e.predicted, e.actual) for e in small.exceptions]
        assert doubled == [(e.mode, e.predicted, e.actual) for e in large.exceptions]


def test_residues_are_those_of_the_checkers_recursion():
    for model, N, seeds, powers in (("alpha", 9, (2, 7), (2, 1)), ("beta", 10, (1, 5), (3, 2))):
        point = random_point(N, 2, 6, random.Random(7))
        terms = PlusTerms(N, model, seeds)
        found = PlusResidues(terms, point).values(powers)
        case = Case(N, 3, list(seeds), *MODELS[model])
        recursion = Recursion(case, Point(point.prime, point.root, list(point.frequencies)), Budget())
        monomial = tuple(e for n in powers for e in (n, 0))
        expected = {q: c[()] for q, c in recursion.coefficients(monomial).items() if c[()]}
        assert found == expected
        assert set(found) <= set(terms.signs(powers))


def test_negative_factors_make_every_term_of_its_sign():
    # frequencies large and close together: all L_q(nu) are negative
    omega = (3.1, 3.2)
    for model, N, seeds in (("alpha", 12, (2, 5)), ("beta", 10, (1, 5)), ("alpha", 8, (3, 5))):
        terms = PlusTerms(N, model, seeds)
        for degree in (3, 4) if model == "alpha" else (3, 5):
            for p in terms.of_degree(degree):
                for q, sign in terms.signs(p).items():
                    size = numeric(terms, p, omega).get(q, 0.0)
                    assert sign == BOTH or (size > 0) == (sign == PLUS), (model, p, q)
                    assert sign == BOTH or size != 0


def numeric(terms, p, omega):
    if sum(p) == 1:
        return {terms.seeds[p.index(1)]: 1.0}
    sums = {}
    for parts in splits(p, terms.factors):
        tables = [numeric(terms, part, omega) for part in parts]
        for modes in product(*tables):
            term = len(set(permutations(parts)))
            for table, m in zip(tables, modes, strict=True):
                term *= table[m]
            for q, coupling in product_couplings(terms.N, tuple(sorted(modes))):
                own = omega[terms.seeds.index(q)] ** 2 if q in terms.seeds else (2 * sin(q * pi / (2 * terms.N))) ** 2
                L = (2 * sin(q * pi / (2 * terms.N))) ** 2 / (own - sum(n * w for n, w in zip(p, omega, strict=True)) ** 2)
                assert L < 0
                sums[q] = sums.get(q, 0.0) - L * coupling * term
    return sums


def test_signs_multiply():
    assert sign_product((PLUS, MINUS)) == MINUS
    assert sign_product((MINUS, MINUS)) == PLUS
    assert sign_product((BOTH, MINUS)) == BOTH


def test_a_proof_goes_on_from_its_file(tmp_path):
    path = tmp_path / "flats.jsonl"
    whole = prove_for_all_N("beta", 2, 2, file=path)
    lines = path.read_text().splitlines(keepends=True)
    asked = len(lines) - 1
    # flats that sums of seeds decide at once are not kept
    assert 200 < asked < whole.flats
    path.write_text("".join(lines[:101]) + lines[101][:9])
    heard = []
    again = prove_for_all_N("beta", 2, 2, file=path, progress=lambda label, done: heard.append((label, done)))
    assert again == whole
    assert min(done for label, done in heard if label == "flats") > 100 / asked
    assert sorted(path.read_text().splitlines()) == sorted(map(str.strip, lines))
    with pytest.raises(InputError, match=r"order 2 and not 1.*another file"):
        prove_for_all_N("beta", 2, 1, file=path)


def test_one_proof_at_a_time_writes_its_file(tmp_path):
    path = tmp_path / "flats.jsonl"
    with DecidedFile(path, "beta", 2, 1), pytest.raises(InputError, match="the other proof"):
        prove_for_all_N("beta", 2, 1, file=path)
    assert prove_for_all_N("beta", 2, 1, file=path).flats == 98


@each(model=["toda"], seeds_number=[0, 4], order=[0])
def test_arguments_are_checked_at_the_door(name, value):
    refused(prove_for_all_N, name, value, model="alpha", seeds_number=1, order=1)


@pytest.mark.parametrize("s", [1, 2, 3])
@pytest.mark.parametrize("model", ["alpha", "beta"])
def test_orders_beyond_the_checker_are_refused_before_anything_is_computed(model, s, tmp_path):
    """The last order is the checker's own: it takes a claim of it, and not of the next."""
    path, heard = tmp_path / "flats.jsonl", []
    order = last_order(model, s)
    claim = {"model": model, "seeds_number": s}
    assert read_claim(claim | {"order": order}).order == order
    with pytest.raises(CertificateError, match="beyond this checker"):
        read_claim(claim | {"order": order + 1})
    with pytest.raises(InputError, match=f"order = {order + 1}: allowed is 1 to {order} for {s} seed.*can be checked"):
        prove_for_all_N(model, s, order + 1, file=path, progress=lambda *told: heard.append(told))
    assert (heard, path.exists()) == ([], False)


def test_sets_of_more_seeds_are_settled_by_as_many_as_a_term_has_leaves():
    proof = prove_for_all_N("alpha", 2, 2)
    assert "every set of 2 seeds, to order 2" in proof.theorem
    assert proof.reason == "sign and chains"
    assert "every set of 2 or more seeds, to order 1" in prove_for_all_N("alpha", 2, 1).theorem


def test_undecided_is_said():
    proof = RuleForAllN("alpha", 1, 1, "undecided", prove_for_all_N("alpha", 1, 1).decided)
    assert proof.theorem.endswith("is not decided")


def test_the_verb_proves_for_all_N_and_verifies(capsys, tmp_path):
    path = str(tmp_path / "c.json")
    arguments = ["prove", "--all-N", "--model", "beta", "--seeds-number", "2", "--order", "1"]
    assert main([*arguments, "-o", path]) == 0
    printed = capsys.readouterr().out
    assert "2 q_2 = N   (modes N - q_1: 1 -> None)" in printed
    assert main([*arguments, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["verdict"], record["flats"], len(record["exceptional_flats"])) == ("refuted", 98, 8)
    assert main(["verify", path]) == 0
    assert record["theorem"] in capsys.readouterr().out
    for wrong in (["-N", "8"], ["--seeds", "1"], ["--points", "2"]):
        assert main([*arguments, *wrong]) == 2
    assert main(["prove", "--order", "1", "-N", "8", "--seeds", "1", "--seeds-number", "2"]) == 2
    assert main(["prove", "--order", "1", "-N", "8"]) == 2
    assert capsys.readouterr().err.count("\n") == 5


def of_theorem_6(N, seeds):
    """Modes that three seeds make only as N - n of l, m, n with l + m = N (docs/propagation.md)."""
    found = set()
    for q in set(range(1, N)) - set(seeds):
        triples = [t for t in combinations_with_replacement(seeds, 3) if q in folds(t, N)]
        if triples and all(any(t[i] + t[j] == N and t[k] == N - q for i, j, k in PAIRS) for t in triples):
            found.add(q)
    return found


PAIRS = ((0, 1, 2), (0, 2, 1), (1, 2, 0))


def folds(modes, N):
    sums = [sum(map(mul, signs, modes)) for signs in product((1, -1), repeat=3)]
    return {min(total % (2 * N), -total % (2 * N)) for total in sums}


@pytest.mark.parametrize("s", [2, pytest.param(3, marks=pytest.mark.long)])
def test_exceptions_at_order_one_are_those_of_theorem_6(s):
    for found in prove_for_all_N("beta", s, 1).decided:
        flat = found.flat
        assert {e.mode for e in found.exceptions} == of_theorem_6(flat.N, flat.seeds), flat


@pytest.mark.long
def test_processes_decide_as_this_one_does(threads):
    """So many flats that worker processes share them."""
    assert repr(prove_for_all_N("alpha", 2, 5)) == repr(prove_for_all_N("alpha", 2, 5, executor=threads))
