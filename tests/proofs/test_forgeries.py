"""Certificates of the prover, checked as they are and with every field altered, the digest made to fit."""

import copy
import json

import pytest

from symfpu import prove_propagation
from symfpu.proofs.check_propagation import verify
from tests.proofs.certificate_files import reason, sealed

CASES = {
    "proved": (9, (2, 4), 3, {}),
    "refuted": (6, (2, 3), 2, {"model": "beta"}),
    "breather": (12, (5,), 4, {}),
    "potential": (6, (2,), 3, {"potential": "toda:1/2"}),
}
STILL_TRUE = "potential: another text"  # a name that the checker does not know, with its coefficients


@pytest.fixture(scope="module", params=[pytest.param(name, marks=[pytest.mark.long] * (name == "breather")) for name in CASES])
def certificate(request):
    *case, law = CASES[request.param]
    return json.loads(json.dumps(prove_propagation(*case, **law).certificate()))


def is_valid(certificate, folder):
    return reason(verify, certificate, folder) is None


def alterations(value):
    """The value with one thing altered anywhere inside: a description and the altered copy."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield f"without {key}", {k: v for k, v in value.items() if k != key}
            for what, altered in alterations(inner):
                yield f"{key}: {what}", value | {key: altered}
        yield "another key", value | {"another": 1}
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield f"without [{i}]", value[:i] + value[i + 1 :]
            for what, altered in alterations(inner):
                yield f"[{i}] {what}", [*value[:i], altered, *value[i + 1 :]]
        yield "longer", [*value, copy.deepcopy(value[-1]) if value else 1]
    elif isinstance(value, int):
        yield "+ 1", value + 1
        yield "negative", -value - 1
        yield "true", True
        yield "as text", str(value)
    elif isinstance(value, str):
        yield "another text", value + "x"
        yield "null", None
    elif value is None:
        yield "zero", 0


def test_every_alteration_is_found_without_the_digest(certificate, tmp_path):
    assert is_valid(certificate, tmp_path)
    count = 0
    for what, altered in alterations({key: value for key, value in certificate.items() if key != "digest"}):
        count += 1
        assert not is_valid(sealed(altered), tmp_path) or what == STILL_TRUE, what
    assert count > 100


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
