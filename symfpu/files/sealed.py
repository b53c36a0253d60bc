"""One JSON document with its digest, written whole: a bit that was changed is seen."""

from __future__ import annotations

import json
from pathlib import Path

from symfpu.files.archive import Json, digest_of
from symfpu.files.writing import open_to_read, write_text

DIGEST = "digest"


def write_sealed(path: Path, document: Json) -> None:
    """The document as a file, with its digest as the last key."""
    plain = json.loads(json.dumps(document))  # as it will be read: keys are text
    text = json.dumps(plain | {DIGEST: digest_of(plain)}, indent=1)
    write_text(path, text + "\n")


def read_bytes(path: Path, argument: str) -> bytes:
    """What a regular file holds; InputError for a pipe or a device."""
    with open_to_read(path, argument) as stream:
        return stream.read()


def document_in(content: bytes) -> Json:
    """The document; ValueError, KeyError or AttributeError where it is none, or was changed."""
    document: Json = json.loads(content)
    digest = document.pop(DIGEST)
    if digest != digest_of(document):
        raise ValueError("the digest is not that of the contents")
    return document
