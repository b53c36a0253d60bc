"""The file of a long run: entries come back, a cut line is left out, other files are refused."""

import json
import resource

import pytest

from symfpu.errors import InputError
from symfpu.files.kept_lines import FileFull, KeptLines


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
    assert [json.loads(line) for line in path.read_text().splitlines()][1:] == [{"n": 1}, {"n": 2}]


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
    with pytest.raises(InputError, match="damaged"):
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
    """The limit of the size of a file, which the system tells as it tells a full disk."""
    path, usual = tmp_path / "numbers.jsonl", resource.getrlimit(resource.RLIMIT_FSIZE)
    added_to(path, {"n": 1})
    resource.setrlimit(resource.RLIMIT_FSIZE, (path.stat().st_size + 20, usual[1]))
    try:
        with pytest.raises(FileFull, match="make room there") as caught:
            added_to(path, *[{"n": n} for n in range(9)])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, usual)
    assert caught.value.rows == 1
    assert kept_in(path) == [1]


def test_entries_are_replaced(tmp_path):
    path = tmp_path / "numbers.jsonl"
    with Numbers(path) as kept:
        kept.add([{"n": 1}, {"n": 2}])
        kept.replace([{"n": 2}])
        kept.add([{"n": 3}])
    assert kept_in(path) == [2, 3]
