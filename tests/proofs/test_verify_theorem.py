"""The checker of theorems for every N refuses whatever is not one."""

import copy
import hashlib
import json

import pytest

from symfpu import prove_for_all_N
from symfpu.proofs.verify import CertificateError
from symfpu.proofs.verify_theorem import verify


def written(path, data):
    """With the digest of the altered contents: what is left to refuse is the mathematics."""
    body = {key: value for key, value in data.items() if key != "digest"}
    text = json.dumps(body, sort_keys=True, separators=(",", ":"))
    path.write_text(json.dumps(body | {"digest": hashlib.sha256(text.encode()).hexdigest()}))
    return path


def refused(path, data):
    with pytest.raises(CertificateError):
        verify(written(path, data))
    return True


def test_theorems_verify_and_say_the_same_sentence(tmp_path):
    for model, s, order in (("alpha", 1, 5), ("beta", 1, 3), ("alpha", 2, 1), ("beta", 2, 1)):
        proof = prove_for_all_N(model, s, order)
        path = written(tmp_path / "c.json", proof.certificate())
        assert verify(path)[0] == proof.theorem


def test_no_flat_can_be_left_out_doubled_or_invented(tmp_path):
    proof = prove_for_all_N("beta", 2, 1).certificate()
    path = tmp_path / "c.json"
    for i in (0, 5, 40, 97):
        assert refused(path, proof | {"flats": proof["flats"][:i] + proof["flats"][i + 1 :]})
        assert refused(path, proof | {"flats": [*proof["flats"], proof["flats"][i]]})
    assert refused(path, proof | {"flats": [*proof["flats"], [500, 3, 17]]})
    assert refused(path, proof | {"flats": [*proof["flats"], [32, 4, 16]]})


def test_every_altered_number_is_refused(tmp_path):
    data = prove_for_all_N("beta", 2, 1).certificate()
    path = tmp_path / "c.json"
    for key in ("order", "seeds_number", "schema"):
        assert refused(path, data | {key: data[key] + 1})
    assert refused(path, data | {"model": "alpha"})
    assert refused(path, data | {"verdict": "proved"})
    for i, row in enumerate(data["exceptions"][:3]):
        for j in range(len(row)):
            altered = copy.deepcopy(data)
            altered["exceptions"][i][j] = 1 if row[j] is None else row[j] + 1
            assert refused(path, altered), (i, j)
    assert refused(path, data | {"exceptions": data["exceptions"][1:]})
    assert refused(path, data | {"undecided": [[0, 1]]})
    assert refused(path, data | {"extra": 1})


@pytest.mark.long
def test_every_altered_number_of_a_residue_is_refused(tmp_path):
    data = prove_for_all_N("alpha", 2, 3).certificate()
    path = tmp_path / "c.json"
    verify(written(path, data))
    for key in ("witnesses", "points"):
        for j in range(len(data[key][0])):
            altered = copy.deepcopy(data)
            altered[key][0][j] += 1
            assert refused(path, altered), (key, j)
    assert refused(path, data | {"witnesses": data["witnesses"][1:]})


def test_what_is_no_certificate_is_refused(tmp_path):
    path = tmp_path / "c.json"
    for text in ("", "[1]", '{"format": 1}', "x" * 10, '{"format": "symfpu rule for all N certificate"}'):
        path.write_text(text)
        with pytest.raises(CertificateError):
            verify(path)
    with pytest.raises(CertificateError):
        verify(tmp_path / "none.json")
    data = prove_for_all_N("alpha", 1, 1).certificate()
    path.write_text(json.dumps(data | {"order": 2}))
    with pytest.raises(CertificateError, match="digest"):
        verify(path)
