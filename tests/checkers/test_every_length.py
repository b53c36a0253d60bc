"""The checker of theorems for every N refuses whatever is not one."""

import copy
import random

import pytest

from symfpu import coupling_sequence, excitation_sequence, prove_for_all_N
from symfpu.checkers import every_length as check_every_length
from symfpu.checkers.every_length import verify
from symfpu.checkers.reading import CertificateError
from tests.checkers.certificate_files import altered, parts_of, reason, sealed


def refused(folder, data):
    return reason(verify, sealed(data), folder)


def test_theorems_verify_and_say_the_same_sentence(tmp_path):
    for model, s, order in (("alpha", 1, 5), ("beta", 1, 3), ("alpha", 2, 1), ("beta", 2, 1)):
        proof = prove_for_all_N(model, s, order)
        proof.write(tmp_path / "c.json")
        assert verify(tmp_path / "c.json")[0] == proof.theorem


@pytest.mark.long
def test_of_larger_sets_the_exceptions_are_those_of_their_parts():
    """Theorem 5: flats are of three seeds, and a larger set can be exceptional only where three of its seeds are."""
    proof = prove_for_all_N("beta", 3, 1)
    assert (
        "3 or more seeds, to order 1, the propagation rule holds except at most where 3 of the seeds are on one of 708 of 10180 flats"
        in proof.theorem
    )
    assert check_every_length.sentence(check_every_length.Theorem("beta", 3, 1), "refuted", 708, 10180, 0) == proof.theorem


def test_a_larger_set_may_obey_the_rule_though_three_of_its_seeds_do_not():
    """Mode 7 is the exception of 1, 2, 6; as a fourth seed it is none."""
    for seeds, obeys in (((1, 2, 6), False), ((1, 2, 6, 7), True)):
        rule = excitation_sequence(8, seeds, 1, model="beta")
        assert (rule == coupling_sequence(8, seeds, 1, model="beta")) is obeys


def test_no_flat_can_be_left_out_doubled_or_invented(tmp_path):
    proof = prove_for_all_N("beta", 2, 1).certificate()
    # of which nothing is said; twice; none of the arrangement
    assert refused(tmp_path, proof | {"flats": [*proof["flats"], [3, 1, 2]]})
    assert refused(tmp_path, proof | {"flats": [*proof["flats"], proof["flats"][0]]})
    assert refused(tmp_path, proof | {"flats": [*proof["flats"][:-1], [500, 3, 17]]})
    assert refused(tmp_path, proof | {"flats": proof["flats"][:-1]})
    first, *others = proof["flats"]
    assert first == [8, 1, 4]
    # other seed sets of the same flat
    for other in ([16, 2, 8], [10, 1, 5], [12, 1, 6]):
        assert refused(tmp_path, proof | {"flats": [other, *others]})


def test_an_exception_cannot_be_left_out_or_moved(tmp_path):
    proof = prove_for_all_N("beta", 2, 2).certificate()
    for i in (0, 10, len(proof["exceptions"]) - 1):
        assert refused(tmp_path, proof | {"exceptions": proof["exceptions"][:i] + proof["exceptions"][i + 1 :]})
    i, mode, predicted, actual = proof["exceptions"][0]
    assert (predicted, actual) == (1, 2)
    for row in ([i, mode, 1, None], [i, mode, 2, 1], [i, mode, 1, 1]):
        assert refused(tmp_path, proof | {"exceptions": [row, *proof["exceptions"][1:]]})


def numbers(data):
    """Where numbers, and orders that are null, stand in a certificate."""
    return [place for place, value in parts_of(data) if place != ("digest",) and isinstance(value, int | None)]


def check_every_number(data, folder, changes, places=None):
    """With each alteration the digest is made anew: what refuses is the mathematics; null becomes an order."""
    assert refused(folder, data) is None
    tried = places or numbers(data)
    for place in tried:
        for by in changes:
            assert refused(folder, altered(data, place, lambda x, by=by: by if x is None else x + by)), (place, by)
    return len(tried)


def test_every_altered_number_is_refused(tmp_path):
    data = prove_for_all_N("beta", 2, 1).certificate()
    assert check_every_number(data, tmp_path, (1, -1)) == 4 + 3 * 8 + 4 * 8
    assert check_every_number(prove_for_all_N("alpha", 1, 3).certificate(), tmp_path, (1, -1)) == 4
    assert refused(tmp_path, data | {"model": "alpha"})
    assert refused(tmp_path, data | {"verdict": "proved"})
    assert refused(tmp_path, data | {"undecided": [[0, 1]]})
    assert refused(tmp_path, data | {"extra": 1})


@pytest.mark.long
@pytest.mark.parametrize(("model", "s", "order", "share"), [("alpha", 2, 4, 120), ("beta", 2, 2, 4)])
def test_every_altered_number_of_longer_proofs_is_refused(tmp_path, model, s, order, share):
    # one in so many at random, and those that stand alone
    data = prove_for_all_N(model, s, order).certificate()
    places = numbers(data)
    source = random.Random(18)
    chosen = source.sample(places, len(places) // share) + [place for place in places if len(place) == 1]
    assert check_every_number(data, tmp_path, (source.choice((1, -1)),), chosen) > 20


def test_residues_are_refused_when_altered(tmp_path):
    data = prove_for_all_N("alpha", 2, 4).certificate()
    claim = check_every_length.read_claim(data)
    evidence = check_every_length.read_evidence(data, claim, len(data["flats"]))
    i = data["witnesses"][0][0]
    flat = tuple(data["flats"][i])

    def check(found, points):
        check_every_length.check_flat(claim, flat, found, points)

    check(evidence[i], data["points"])
    (mode, order), (point, residue, powers) = next(iter(evidence[i].witnesses.items()))
    for wrong in (
        (point, residue + 1, powers),
        (point, 0, powers),
        (point + 1, residue, powers),
        (point, residue, powers[::-1] if powers[0] != powers[1] else (powers[0] + 1, powers[1] - 1)),
    ):
        with pytest.raises((CertificateError, IndexError)):
            check(evidence[i]._replace(witnesses=evidence[i].witnesses | {(mode, order): wrong}), data["points"])
    for j in range(len(data["points"][point])):
        points = copy.deepcopy(data["points"])
        points[point][j] += 1
        with pytest.raises(CertificateError):
            check(evidence[i], points)
    with pytest.raises(CertificateError, match="undecided"):
        check(evidence[i]._replace(witnesses={}), data["points"])
    with pytest.raises(CertificateError, match="nothing asks"):
        check(evidence[i]._replace(witnesses=evidence[i].witnesses | {(1, 1): (point, residue, powers)}), data["points"])
