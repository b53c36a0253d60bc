"""Certificates of the prover, checked as they are and with every field altered, the digest made to fit."""

import json

import pytest

from symfpu import prove_propagation
from symfpu.checkers.propagation import verify
from tests.checkers.certificate_files import parts_of, reason, replaced, sealed

CASES = {
    "proved": (9, (2, 4), 3, {}),
    "refuted": (6, (2, 3), 2, {"model": "beta"}),
    "breather": (12, (5,), 4, {}),
    "potential": (6, (2,), 3, {"potential": "toda:1/2"}),
}
STILL_TRUE = ("potential",), "toda:0.5x"  # a name that the checker does not know, with its coefficients


@pytest.fixture(scope="module", params=[pytest.param(name, marks=[pytest.mark.long] * (name == "breather")) for name in CASES])
def certificate(request):
    *case, law = CASES[request.param]
    return json.loads(json.dumps(prove_propagation(*case, **law).certificate()))


def is_valid(certificate, folder):
    return reason(verify, certificate, folder) is None


def alterations(value):
    """What to put in the place of a part."""
    if isinstance(value, dict):
        yield from ({name: part for name, part in value.items() if name != key} for key in value)
        yield value | {"another": 1}
    elif isinstance(value, list):
        yield from (value[:i] + value[i + 1 :] for i in range(len(value)))
        yield [*value, value[-1] if value else 1]
    elif isinstance(value, int):
        yield from (value + 1, -value - 1, True, str(value))
    else:
        yield from (0,) if value is None else (value + "x", None)


def test_every_alteration_is_found_without_the_digest(certificate, tmp_path):
    assert is_valid(certificate, tmp_path)
    contents = {key: value for key, value in certificate.items() if key != "digest"}
    altered = [(place, other) for place, value in parts_of(contents) for other in alterations(value)]
    assert len(altered) > 100
    for place, other in altered:
        forged = sealed(replaced(contents, place, other))
        assert not is_valid(forged, tmp_path) or (place, other) == STILL_TRUE, (place, other)


def test_another_witness_that_is_right_is_accepted(tmp_path):
    """What is checked is the statement: a second independent point proves the same."""
    for seed in (1, 2):
        assert is_valid(prove_propagation(7, (3,), 3, random_seed=seed).certificate(), tmp_path)
    assert is_valid(prove_propagation(7, (3,), 3, points=2).certificate(), tmp_path)


def test_undecided_and_identity_certificates_are_valid(tmp_path, monkeypatch):
    assert is_valid(prove_propagation(8, (1, 4), 2, model="beta", points=0).certificate(), tmp_path)
    monkeypatch.setattr("symfpu.proofs.certificates.coupled_modes", lambda *_, **__: [(1, 2, 3, 4, 5)] * 3)
    proof = prove_propagation(6, (2, 3), 2, model="beta")
    assert {v.by for v in proof.vanishing} == {"identity"}
    assert is_valid(proof.certificate(), tmp_path)
