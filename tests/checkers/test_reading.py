"""What checkers read with: nothing but plain strings and integers passes, each key once, each number in its range."""

import json
import os
import random
from fractions import Fraction

import pytest

import symfpu
from symfpu import Chain, prove_existence, prove_for_all_N, prove_propagation, prove_residual, prove_stability
from symfpu.checkers import every_length as check_every_length
from symfpu.checkers import existence as check_existence
from symfpu.checkers import propagation as check_propagation
from symfpu.checkers import stability as check_stability
from symfpu.checkers import torus as check_torus
from symfpu.checkers.reading import CertificateError, Kind, check_kind, dyadic, fraction, need, read_kind, verified, whole
from symfpu.checkers.rounding import scientific, up
from symfpu.checkers.verify import CHECKERS
from symfpu.checkers.verify import verify as verify_certificate
from tests import every_result
from tests.checkers.certificate_files import altered, moved, places_of, reason, sealed
from tests.system import raising

KIND = Kind("some certificate", 3, {"format", "schema", "value", "digest"})
GOOD = sealed({"format": "some certificate", "schema": 3, "value": [1, -2, "1/2"]})


def read(text, folder):
    path = folder / "c.json"
    path.write_text(text)
    return read_kind(path, KIND)


def test_a_certificate_is_read_as_it_was_written(tmp_path):
    assert read(json.dumps(GOOD), tmp_path) == GOOD


STRANGE = {
    "a float": ('"value": [1.0, -2, "1/2"]', "not JSON of plain"),
    "a power": ('"value": [1e0, -2, "1/2"]', "not JSON of plain"),
    "a boolean": ('"value": [true, -2, "1/2"]', "not JSON of plain"),
    "nothing": ('"value": [null, -2, "1/2"]', "not JSON of plain"),
    "a long integer": (f'"value": [{"1" * 3000}, -2, "1/2"]', "not JSON of plain"),
    "a key twice": ('"value": [1, -2, "1/2"], "value": [1, -2, "1/2"]', "there twice"),
    "a key twice inside": ('"value": {"a": 1, "a": 2}', "there twice"),
    "a key more": ('"more": 1, "value": [1, -2, "1/2"]', "missing or unknown"),
    "another value": ('"value": [1, -2, "1/3"]', "the digest is not"),
}


@pytest.mark.parametrize("name", STRANGE)
def test_what_is_no_plain_certificate_is_refused(name, tmp_path):
    part, reason = STRANGE[name]
    with pytest.raises(CertificateError, match=reason):
        read(json.dumps(GOOD).replace('"value": [1, -2, "1/2"]', part), tmp_path)


@pytest.mark.parametrize(("key", "value", "reason"), [("format", "other", "not a some certificate"), ("schema", 4, "supports schema 3")])
def test_another_kind_or_version_is_refused(key, value, reason):
    with pytest.raises(CertificateError, match=reason):
        check_kind(sealed(GOOD | {key: value}), KIND)


@pytest.mark.parametrize("value", [True, "5", None, 5.0, -1, 11])
def test_an_integer_is_one_in_its_range(value):
    assert whole(10, 0, 10, "it") == 10
    with pytest.raises(CertificateError, match="it is out of its range"):
        whole(value, 0, 10, "it")


@pytest.mark.parametrize("text", ["1.5", "1/0", "1/-2", " 1", "1e3", "", 1, "1" * 20_001, "½"])
def test_a_fraction_is_one_as_written(text):
    assert fraction("-3/6", "it") == Fraction(-1, 2)
    with pytest.raises(CertificateError, match="it is no fraction"):
        fraction(text, "it")


@pytest.mark.parametrize("pair", [[0, 1], [-1, 1], [1, -1], [1, 2**15], [2**8192 + 1, 0], [True, 1]])
def test_a_bound_is_a_positive_dyadic_number(pair):
    assert dyadic([3, 2], "it") == Fraction(3, 4)
    with pytest.raises(CertificateError, match="it is out of its range"):
        dyadic(pair, "it")


@pytest.mark.parametrize("error", [OSError, KeyError, TypeError, AttributeError, RecursionError, ZeroDivisionError, OverflowError])
def test_what_breaks_the_reading_refuses_the_certificate(error, tmp_path):
    with pytest.raises(CertificateError, match=r"no readable certificate.*reason"):
        verified(tmp_path, raising(error("reason")), list)


def test_a_reason_stays_as_it_is(tmp_path):
    with pytest.raises(CertificateError, match=r"^reason$"):
        verified(tmp_path, lambda _: {}, lambda _: need(False, "reason"))


@pytest.mark.parametrize(
    ("x", "digits", "text"),
    [
        (Fraction(0), 3, "0"),
        (Fraction(1, 3), 3, "3.34e-1"),
        (Fraction(-1, 3), 3, "-3.34e-1"),
        (Fraction(9999, 1000), 3, "1.00e1"),
        (Fraction(10) ** 30, 2, "1.0e30"),
        (Fraction(7, 2), 1, "4"),
        (Fraction(3), 3, "3.00"),
    ],
)
def test_numbers_in_decimals_are_not_below_the_true_ones(x, digits, text):
    assert scientific(x, digits) == text
    assert abs(Fraction(scientific(x, digits))) >= abs(x)
    assert abs(Fraction(scientific(x, digits, rounded=lambda y: y.__floor__()))) <= abs(x)


def test_up_is_the_least_integer_not_below():
    assert [up(x) for x in (Fraction(1, 2), Fraction(-1, 2), Fraction(4, 2), 3)] == [1, 0, 2, 3]


# every kind of certificate

VERIFY = {of.FORMAT: of.verify for of in (check_every_length, check_existence, check_propagation, check_stability, check_torus)}
MADE = {
    check_every_length.FORMAT: lambda: prove_for_all_N("beta", 2, 1),
    check_existence.FORMAT: lambda: prove_existence(every_result.orbit()),
    check_propagation.FORMAT: lambda: prove_propagation(8, (1, 4), 3, model="beta"),
    check_stability.FORMAT: lambda: prove_stability(symfpu.torus(Chain(4, alpha="0.3"), (1,), amplitudes={1: "0.2"})),
    check_torus.FORMAT: lambda: prove_residual(every_result.two_angles()),
}


@pytest.mark.parametrize("kind", CHECKERS)
@pytest.mark.parametrize("text", ["", "{}", "[]", "[1, 2]", '{"format": 1}', '{"format": "KIND"}', "\x00", "1.5", "x" * 10])
def test_what_is_no_certificate_is_refused(kind, text, tmp_path):
    path = tmp_path / "c.json"
    path.write_text(text.replace("KIND", kind))
    anywhere = [path, tmp_path, tmp_path / "none"]
    for verify, places in ((VERIFY[kind], [*anywhere, os.devnull, "a\0b"]), (verify_certificate, anywhere)):
        for place in places:
            with pytest.raises(CertificateError) as caught:
                verify(place)
            assert "\n" not in str(caught.value)


@pytest.mark.parametrize("kind", CHECKERS)
def test_a_large_file_is_not_read(kind, tmp_path):
    path = tmp_path / "c.json"
    with path.open("wb") as file:
        file.truncate(2**40)
    with pytest.raises(CertificateError, match=r"at most (64|256) MB"):
        VERIFY[kind](path)


@pytest.mark.parametrize("kind", CHECKERS)
def test_a_certificate_finds_its_checker(kind, tmp_path):
    MADE[kind]().write(tmp_path / "c.json")
    assert verify_certificate(tmp_path / "c.json") == VERIFY[kind](tmp_path / "c.json")
    data = json.loads((tmp_path / "c.json").read_text())
    assert "unknown" in reason(verify_certificate, sealed(data | {"more": 1}), tmp_path)
    assert "not a " in reason(VERIFY[kind], sealed(data | {"format": "other"}), tmp_path)
    assert "support" in reason(VERIFY[kind], sealed(data | {"schema": 99}), tmp_path)


@pytest.mark.parametrize("kind", CHECKERS)
def test_the_digest_binds_every_number_and_text(kind, tmp_path):
    """Of long certificates, 300 of them drawn at random."""
    data = MADE[kind]().certificate()
    places = places_of(data)
    for place in random.Random(5).sample(places, min(300, len(places))):
        assert reason(verify_certificate, altered(data, place, moved), tmp_path), place
