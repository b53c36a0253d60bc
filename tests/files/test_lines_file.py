"""The file of a long run: lines come back, a cut one is left out, other files are refused."""

import json

import pytest

from symfpu.errors import InputError
from symfpu.files.lines_file import LinesFile


def numbers(path, order=1):
    return LinesFile(path, {"format": "numbers", "order": order}, lambda line: int(line["n"]), "numbers")


def test_lines_come_back_and_a_cut_one_is_left_out(tmp_path):
    path = tmp_path / "numbers.jsonl"
    assert numbers(path).read() == []
    numbers(path).append([{"n": 1}, {"n": 2}])
    path.write_text(path.read_text() + '{"n": 3')
    assert numbers(path).read() == [1, 2]
    assert [json.loads(line) for line in path.read_text().splitlines()][1:] == [{"n": 1}, {"n": 2}]


def test_with_no_path_nothing_is_kept():
    nowhere = numbers(None)
    nowhere.append([{"n": 1}])
    assert nowhere.read() == []


def test_other_files_are_refused(tmp_path):
    path = tmp_path / "numbers.jsonl"
    numbers(path).read()
    with pytest.raises(InputError, match="another file"):
        numbers(path, order=2).read()
    numbers(path).append([{"m": 1}])
    with pytest.raises(InputError, match="damaged"):
        numbers(path).read()
    with pytest.raises(InputError, match="read and written"):
        numbers(tmp_path / "none" / "numbers.jsonl").read()
