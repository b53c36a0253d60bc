"""Certificates as files, sealed with a digest that fits, altered at a place; and why a checker refuses one."""

import copy
import hashlib
import json

from symfpu.checkers import existence as check_existence
from symfpu.checkers.reading import CertificateError


def sealed(data):
    """With the digest of these contents: what is left to refuse is the mathematics."""
    contents = {key: value for key, value in data.items() if key != "digest"}
    text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
    return contents | {"digest": hashlib.sha256(text.encode()).hexdigest()}


def reason(verify, data, folder):
    """Why a certificate is refused; None where it is not."""
    path = folder / "c.json"
    path.write_text(json.dumps(data))
    try:
        verify(path)
    except CertificateError as error:
        return str(error)
    return None


def check_refused(verify, data, folder, why):
    """For one of the reasons, which stand between bars."""
    found = reason(verify, data, folder)
    assert found
    assert any(word in found for word in why.split("|")), found


def parts_of(value, place=()):
    """Everything in a certificate, and the whole, each with its place."""
    yield place, value
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from parts_of(inner, (*place, key))


def places_of(value):
    """The places of all numbers and texts in a certificate."""
    return [place for place, part in parts_of(value) if not isinstance(part, dict | list)]


def altered(data, place, change):
    """A copy with what stands at a place changed by a function."""
    other = copy.deepcopy(data)
    inside = other
    for key in place[:-1]:
        inside = inside[key]
    inside[place[-1]] = change(inside[place[-1]])
    return other


def replaced(data, place, value):
    """A copy with another value at a place, which may be the whole."""
    return altered(data, place, lambda _: value) if place else value


def moved(value):
    return value + 1 if isinstance(value, int) else f"{value}1"


def bounds_of(data):
    """What a certificate of existence claims, and the bounds of its checker."""
    claim = check_existence.read_claim(data)
    inverse = check_existence.read_inverse(data, claim)
    bonds = check_existence.Bonds(claim, inverse.last + inverse.slope_harmonics)
    return claim, check_existence.Bounds(claim, bonds, inverse)
