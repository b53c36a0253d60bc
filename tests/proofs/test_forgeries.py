"""Certificates of the prover, checked as they are and with every field altered, the digest made to fit."""

import copy
import hashlib
import json

import pytest

from symfpu.proofs.certificates import prove_propagation
from symfpu.proofs.check_propagation import verify
from symfpu.proofs.reading import CertificateError

CASES = {
    "proved": (9, (2, 4), 3, "alpha"),
    "refuted": (6, (2, 3), 2, "beta"),
    "breather": (12, (5,), 4, "alpha"),
}


@pytest.fixture(scope="module", params=CASES)
def certificate(request):
    N, seeds, order, model = CASES[request.param]
    return json.loads(json.dumps(prove_propagation(N, seeds, order, model=model).certificate()))


def sealed(certificate):
    body = {key: value for key, value in certificate.items() if key != "digest"}
    text = json.dumps(body, sort_keys=True, separators=(",", ":"))
    return certificate | {"digest": hashlib.sha256(text.encode()).hexdigest()}


def is_valid(certificate, folder):
    path = folder / "c.json"
    path.write_text(json.dumps(certificate))
    try:
        verify(path)
    except CertificateError:
        return False
    return True


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


def test_certificate_is_valid(certificate, tmp_path):
    assert is_valid(certificate, tmp_path)


def test_any_alteration_breaks_the_digest(certificate, tmp_path):
    for what, altered in alterations(certificate):
        assert not is_valid(altered, tmp_path), what


def test_every_alteration_is_found_without_the_digest(certificate, tmp_path):
    count = 0
    for what, altered in alterations({key: value for key, value in certificate.items() if key != "digest"}):
        count += 1
        assert not is_valid(sealed(altered), tmp_path), what
    assert count > 200


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


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "certificate"),
        ("{", "certificate"),
        ("[]", "certificate"),
        ("nonsense", "JSON"),
        ('{"format": "symfpu propagation certificate"}', "certificate"),
        ("[" * 100_000, "certificate"),
        ('{"N": ' + "9" * 6000 + "}", ""),
    ],
)
def test_what_is_no_certificate_is_refused(text, reason, tmp_path):
    path = tmp_path / "c.json"
    path.write_text(text)
    with pytest.raises(CertificateError) as caught:
        verify(path)
    assert "\n" not in str(caught.value)
    assert reason in str(caught.value) or reason == ""


def test_newer_schema_is_named(tmp_path):
    certificate = sealed(prove_propagation(6, (1,), 1).certificate() | {"schema": 3})
    (tmp_path / "c.json").write_text(json.dumps(certificate))
    with pytest.raises(CertificateError, match=r"schema.* 3 "):
        verify(tmp_path / "c.json")


def test_absurd_sizes_are_refused_at_once(tmp_path):
    certificate = prove_propagation(6, (1,), 1).certificate()
    for key, value in (("N", 10**9), ("order", 10**9), ("seeds", list(range(1, 5000)))):
        assert not is_valid(sealed(certificate | {key: value}), tmp_path)


def test_truncated_file_is_refused(tmp_path):
    path = tmp_path / "c.json"
    prove_propagation(6, (1,), 2).write(path)
    text = path.read_text()
    for length in range(0, len(text) - 2, max(1, len(text) // 40)):
        path.write_text(text[:length])
        with pytest.raises(CertificateError):
            verify(path)
