"""Lines that are kept as they come: whole ones count, a cut one is left out, changed ones are found by their checksum."""

import os
import random

import pytest

from symfpu import FileFull, InputError
from symfpu.files.kept_lines import KeptLines, entry_of
from symfpu.files.sealed import document_in, read_bytes, write_sealed
from tests.system import files_up_to


class Numbers(KeptLines):
    """Numbers, one a line."""

    run = "count"

    def __init__(self, path, order=1):
        super().__init__(path, {"format": "numbers", "order": order})
        self.numbers = []

    def take(self, entries):
        self.numbers = [int(entry["n"]) for entry in entries]


def kept_in(path, order=1):
    with Numbers(path, order) as kept:
        return kept.numbers


def added_to(path, *entries):
    with Numbers(path) as kept:
        kept.add(entries)


def test_entries_come_back_and_a_cut_line_is_left_out(tmp_path):
    path = tmp_path / "numbers.jsonl"
    assert kept_in(path) == []
    added_to(path, {"n": 1}, {"n": 2})
    path.write_text(path.read_text() + '{"n": 3')
    assert kept_in(path) == [1, 2]
    assert list(map(entry_of, path.read_bytes().splitlines()[1:])) == [{"n": 1}, {"n": 2}]


def test_with_no_path_nothing_is_kept():
    added_to(None, {"n": 1})
    assert kept_in(None) == []


def test_other_files_are_refused_by_what_differs_and_left_as_they_are(tmp_path):
    path = tmp_path / "numbers.jsonl"
    added_to(path, {"m": 1})
    path.write_text(path.read_text() + '{"n": 3')
    before = path.read_bytes()
    with pytest.raises(InputError, match=r"that of this count.*order 1 and not 2.*another file"):
        kept_in(path, order=2)
    with pytest.raises(InputError, match="it is damaged"):
        kept_in(path)
    assert path.read_bytes() == before
    with pytest.raises(InputError, match="a folder that exists"):
        kept_in(tmp_path / "none" / "numbers.jsonl")


def test_one_writes_at_a_time(tmp_path):
    path = tmp_path / "numbers.jsonl"
    with Numbers(path), pytest.raises(InputError, match="the other count"):
        kept_in(path)
    assert kept_in(path) == []


def test_entries_that_find_no_room_are_left_out_together(tmp_path):
    path = tmp_path / "numbers.jsonl"
    added_to(path, {"n": 1})
    with files_up_to(path.stat().st_size + 20), pytest.raises(FileFull, match="make room there") as caught:
        added_to(path, *[{"n": n} for n in range(9)])
    assert caught.value.rows == 1
    assert kept_in(path) == [1]


def test_entries_are_replaced(tmp_path):
    path = tmp_path / "numbers.jsonl"
    with Numbers(path) as kept:
        kept.add([{"n": 1}, {"n": 2}])
        kept.replace([{"n": 2}])
        kept.add([{"n": 3}])
    assert kept_in(path) == [2, 3]


def test_no_flipped_bit_changes_a_number_in_silence(tmp_path):
    """600 bits of a file, each flipped alone: it is refused, or its last line counts as cut off."""
    path, numbers = tmp_path / "numbers.jsonl", [10**9 + 7 * n for n in range(40)]
    added_to(path, *[{"n": n} for n in numbers])
    content, draw = path.read_bytes(), random.Random(5)
    refused = 0
    for _ in range(600):
        place = draw.randrange(len(content))
        changed = bytearray(content)
        changed[place] ^= 1 << draw.randrange(8)
        path.write_bytes(changed)
        try:
            assert kept_in(path) == numbers[:-1]
            assert place == len(content) - 1, "the end of the last line"
        except InputError:
            refused += 1
            assert path.read_bytes() == changed, "what is refused is left as it is"
    assert refused > 590


def test_a_changed_line_is_named(tmp_path):
    path = tmp_path / "numbers.jsonl"
    added_to(path, {"n": 1}, {"n": 2})
    head, first, second = path.read_bytes().splitlines(keepends=True)
    said = {
        b"{}\n" + first: "that of this count",
        head.replace(b": 1", b": 1 "): "line 1 was changed",
        head.replace(b'"crc32": "', b'"crc32": "0'): "line 1 was changed",
        head + first.replace(b"1", b"3", 1) + second: "line 2 was changed",
        head + first + second.replace(b"2", b"3", 1): "line 3 was changed",
        head + first + b"\n" + second: "line 3 was changed",
    }
    for content, words in said.items():
        path.write_bytes(content)
        with pytest.raises(InputError, match=words):
            kept_in(path)


DOCUMENT = {"members": 3, "amplitudes": {1: 0.1, 10: -2.5e-300, 2: 1e22}, "events": [{"kind": "fold", "harmonic": (1, -1)}]}
READ = {"members": 3, "amplitudes": {"1": 0.1, "10": -2.5e-300, "2": 1e22}, "events": [{"kind": "fold", "harmonic": [1, -1]}]}


def test_a_document_comes_back_as_json_holds_it(tmp_path):
    write_sealed(tmp_path / "record", DOCUMENT)
    assert document_in(read_bytes(tmp_path / "record", "file")) == READ
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="a regular file"):
        read_bytes(tmp_path / "pipe", "file")


def test_no_flipped_bit_is_taken_for_the_document(tmp_path):
    """Of spaces between words alone, a flip may change nothing that is read."""
    write_sealed(tmp_path / "record", DOCUMENT)
    content, draw = (tmp_path / "record").read_bytes(), random.Random(5)
    refused = 0
    for _ in range(600):
        changed = bytearray(content)
        changed[draw.randrange(len(content))] ^= 1 << draw.randrange(8)
        try:
            assert document_in(bytes(changed)) == READ
        except (ValueError, KeyError, AttributeError, TypeError):
            refused += 1
    assert refused > 500
