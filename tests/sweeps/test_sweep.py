"""Sweeps: every case a row, whatever becomes of it; gone on with from its file and from no other."""

import json
import os
import threading
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from fractions import Fraction

import mpmath
import pytest

from symfpu import Chain, FileFull, InputError, SweepStopped, excitation_sequence, prove_propagation, read_sweep, sweep
from symfpu.files.kept_lines import entry_of, line_of
from symfpu.sweeps.rows_file import RowsFile, head_of
from symfpu.sweeps.this_process import ThisProcess
from tests.sweeps.functions import coupling_of, deadly_square, lists, rows_so_far, slow_square, square, strange
from tests.system import files_up_to

TEN = [{"n": n} for n in range(10)]


def lines_of(file):
    """The entries, each of which agrees with its checksum."""
    return list(map(entry_of, file.read_bytes().splitlines()))


def write_lines(file, *entries):
    file.write_bytes(b"".join(map(line_of, entries)))


def test_rows_are_in_the_order_of_the_cases(threads):
    swept = sweep(square, TEN, fixed={"shift": 1}, executor=threads)
    assert [row.case for row in swept.rows] == TEN
    assert [row.result["square"] for row in swept.rows] == [n * n + 1 for n in range(10)]
    assert (swept.function, swept.fixed) == ("tests.sweeps.functions.square", {"shift": 1})
    assert repr(swept) == "SweepRows(tests.sweeps.functions.square: 10 cases)"


def test_the_head_says_what_the_rows_are_of(tmp_path, threads):
    file, chain = tmp_path / "rows.jsonl", Chain(8, beta="1/10")
    sweep(coupling_of, [{"mode": 2}], fixed={"chain": chain}, executor=threads, file=file)
    head, row = lines_of(file)
    assert head["format"] == "symfpu sweep"
    assert head["schema"] == 2
    assert head["symfpu_version"] == "0.1.0"
    assert head["function"] == "tests.sweeps.functions.coupling_of"
    assert head["fixed"] == {"chain": {"N": 8, "alpha": "0", "beta": "0.1"}}
    assert row == {"case": {"mode": 2}, "result": {"alpha": "0", "omega": chain.frequencies()[1]}}


def test_a_failure_is_a_row_with_its_kind_and_numbers(tmp_path, threads):
    file = tmp_path / "rows.jsonl"
    swept = sweep(square, [{"n": -2}, {"n": 2}], executor=threads, file=file)
    failure = swept.rows[0].failure
    assert (failure.kind, failure.numbers) == (
        "InputError",
        {"argument": "n", "value": -2, "allowed": "0 or more", "advice": "take its size"},
    )
    assert failure.message.startswith("n = -2: allowed")
    assert (swept.rows[1].result["square"], swept.failures) == (4, swept.rows[:1])
    assert read_sweep(file).failures == swept.failures
    assert "1 failed: 1 InputError" in repr(swept)


def test_a_grid_with_impossible_points_is_a_table_with_holes(threads):
    grid = [{"chain": {"N": N, "beta": beta}, "mode": mode} for N in (1, 4) for beta in (0, "1/3") for mode in (1, 3, 5)]
    swept = sweep(coupling_of, grid, executor=threads)
    possible = [row for row in swept.rows if row.failure is None]
    assert [(row.case["chain"], row.case["mode"]) for row in possible] == [({"N": 4, "alpha": "0", "beta": "1/3"}, mode) for mode in (1, 3)]
    assert {row.failure.kind for row in swept.failures} == {"InputError", "IndexError"}
    frame = swept.to_frame()
    assert list(frame) == ["case", "chain_N", "chain_beta", "mode", "failure", "failure_message", "chain_alpha", "alpha", "omega"]
    assert frame.chain_beta.dtype == float
    assert frame[frame.failure == ""].omega.tolist() == list(Chain(4, beta=1).frequencies()[[0, 2]])
    data = swept.to_xarray()
    assert (data.omega.dims, data.omega.isnull().sum().item()) == (("case",), 10)
    assert data.attrs["function"] == swept.function


def test_lists_in_tables_are_text_and_long_ones_are_left_out(threads):
    swept = sweep(lists, [{"modes": (1, 3), "length": n} for n in (2, 30)], executor=threads)
    frame = swept.to_frame()
    assert (frame.modes.tolist(), frame.short.tolist(), frame["sum"].tolist()) == (["1,3"] * 2, ["1,3"] * 2, [1, 435])
    assert frame.long.tolist() == ["0,1", ""]
    assert swept.rows[1].result["long"] == list(range(30))
    assert "nested" not in frame


def test_a_chain_and_its_arguments_are_the_same_case(tmp_path, threads):
    file = tmp_path / "rows.jsonl"
    sweep(coupling_of, [{"chain": Chain(8, beta="1/10")}], executor=threads, file=file)
    sweep(coupling_of, [{"chain": {"N": 8, "beta": Fraction(1, 10)}}], executor=threads, file=file)
    assert len(lines_of(file)) == 2
    with pytest.raises(InputError, match="all differ"):
        sweep(coupling_of, [{"chain": Chain(8, beta="1/10")}, {"chain": {"N": 8, "beta": "0.1"}}], executor=threads)


def test_results_are_records(threads):
    proof = sweep(prove_propagation, [{"N": 4, "seeds": (1, 2), "order": 1}], executor=threads).rows[0].result
    assert (proof["kind"], proof["verdict"], proof["N"]) == ("PropagationProof", "proved", 4)
    (row,) = sweep(excitation_sequence, [{"seeds": (1, 2)}], fixed={"N": 4, "order": 1}, executor=threads).rows
    assert row.result == [[1, 2], [3]]


def test_what_json_does_not_hold_is_refused_or_text(threads):
    rows = sweep(strange, TEN[:4], executor=threads).rows
    assert rows[0].failure.kind == "InputError"
    assert "object" in rows[0].failure.message
    assert [row.result for row in rows[1:]] == ["nan", [0.0, 1.0], 3]


def test_a_sweep_goes_on_where_it_was(tmp_path, threads):
    file, heard = tmp_path / "rows.jsonl", []
    whole = sweep(square, TEN, executor=threads, file=file)
    lines = file.read_text().splitlines(keepends=True)
    file.write_text("".join(lines[:6]) + lines[6][:9])  # cut in the middle of a line
    assert len(read_sweep(file).rows) == 5
    again = sweep(square, TEN, executor=threads, file=file, progress=lambda label, fraction: heard.append((label, fraction)))
    assert again == whole
    assert heard == [("cases", n / 10) for n in (6, 7, 8, 9, 10)]
    assert sorted(file.read_text().splitlines(keepends=True)) == sorted(lines)
    longer = sweep(square, [*TEN, {"n": 10}], executor=threads, file=file)
    assert longer.rows[:10] == whole.rows
    assert sweep(square, TEN[3:5], executor=None, file=file).rows == whole.rows[3:5]  # nothing to do: no process starts


@pytest.mark.parametrize("length", [0, 1, 20])
def test_a_file_whose_head_was_cut_is_begun_again(tmp_path, threads, length):
    file = tmp_path / "rows.jsonl"
    file.write_text(json.dumps(head_of("tests.sweeps.functions.square", {}))[:length])
    assert len(sweep(square, TEN[:2], executor=threads, file=file).rows) == 2
    assert [line["case"] for line in lines_of(file)[1:]] == TEN[:2]


def test_failures_are_computed_again_when_asked(tmp_path, threads):
    file = tmp_path / "rows.jsonl"
    head = head_of("tests.sweeps.functions.square", {})
    spoilt = {"case": {"n": 2}, "failure": {"kind": "MemoryError", "message": "", "numbers": {}}}
    good = {"case": {"n": 3}, "result": "kept"}
    write_lines(file, head, spoilt, good)
    assert sweep(square, TEN[2:4], executor=threads, file=file).rows[0].failure.kind == "MemoryError"
    again = sweep(square, TEN[2:4], executor=threads, file=file, retry=True)
    assert [row.result for row in again.rows] == [{"square": 4, "root": 2**0.5}, "kept"]
    assert len(lines_of(file)) == 3


@pytest.mark.parametrize(
    ("function", "fixed", "said"),
    [
        (deadly_square, {}, "function 'tests.sweeps.functions.square' and not"),
        (square, {"shift": 2}, r"fixed {'shift': 1} and not {'shift': 2}"),
    ],
)
def test_a_file_of_another_sweep_is_refused(tmp_path, threads, function, fixed, said):
    file = tmp_path / "rows.jsonl"
    sweep(square, TEN[:1], fixed={"shift": 1}, executor=threads, file=file)
    before = file.read_bytes()
    with pytest.raises(InputError, match=said):
        sweep(function, TEN[:1], fixed=fixed, executor=threads, file=file)
    assert file.read_bytes() == before


@pytest.mark.parametrize("version", ["0.0.9", "0.2.0"])
def test_a_file_of_another_version_is_refused(tmp_path, threads, version):
    file = tmp_path / "rows.jsonl"
    write_lines(file, head_of("tests.sweeps.functions.square", {}) | {"symfpu_version": version})
    with pytest.raises(InputError, match=f"symfpu_version '{version}' and not"):
        sweep(square, TEN[:1], executor=threads, file=file)


@pytest.mark.parametrize("text", ["precious data without newline", "line one\nprecious tail", '{"format": "another"}\n{}\n'])
def test_a_foreign_file_is_left_as_it_is(tmp_path, threads, text):
    file = tmp_path / "notes.txt"
    file.write_text(text)
    with pytest.raises(InputError, match="that of this sweep"):
        sweep(square, TEN, executor=threads, file=file)
    with pytest.raises(InputError, match="the file of a sweep"):
        read_sweep(file)
    assert file.read_text() == text


DAMAGE, HEAD = "it is damaged: remove it", head_of("tests.sweeps.functions.square", {})
NO_FILES = {
    "a row without a case": ([HEAD, {"n": 0}], DAMAGE),
    "a failure without a kind": ([HEAD, {"case": {"n": 0}, "failure": 3}], DAMAGE),
    "a case twice": ([HEAD, *2 * [{"case": {"n": 0}, "result": 1}]], DAMAGE),
    "a head without function": ([{key: HEAD[key] for key in HEAD if key != "function"}], f"{DAMAGE}|has function None and not"),
    "a head without fixed": ([{key: HEAD[key] for key in HEAD if key != "fixed"}], f"{DAMAGE}|has fixed None and not"),
    "a schema without checksums": ([HEAD | {"schema": 1}], "schema 1 and not 2"),
}


@pytest.mark.parametrize("case", NO_FILES)
def test_files_that_no_sweep_writes_are_refused(tmp_path, threads, case):
    file, (entries, reason) = tmp_path / "rows.jsonl", NO_FILES[case]
    write_lines(file, *entries)
    for call in (read_sweep, lambda path: sweep(square, TEN, executor=threads, file=path)):
        with pytest.raises(InputError, match=reason):
            call(file)


def test_a_line_that_was_changed_is_named_and_can_be_removed(tmp_path, threads):
    file = tmp_path / "rows.jsonl"
    whole = sweep(square, TEN[:3], executor=threads, file=file)
    head, first, second, third = file.read_bytes().splitlines(keepends=True)
    file.write_bytes(head + first + second.replace(b'"square": ', b'"square": 7') + third)
    for call in (read_sweep, lambda path: sweep(square, TEN[:3], executor=threads, file=path)):
        with pytest.raises(InputError, match=r"line 3 was changed.* remove this line"):
            call(file)
    file.write_bytes(head + first + third)
    assert sweep(square, TEN[:3], executor=threads, file=file) == whole


def test_without_processes_a_row_is_kept_before_the_next_case_begins(tmp_path):
    file = tmp_path / "rows.jsonl"
    swept = sweep(rows_so_far, TEN[:3], executor=ThisProcess(file=str(file)), file=file)
    assert [row.result for row in swept.rows] == [0, 1, 2]
    assert [row.failure.kind for row in sweep(square, [{"n": -1}], executor=ThisProcess()).rows] == ["InputError"]


def test_one_process_at_a_time_writes(tmp_path, threads):
    file = tmp_path / "rows.jsonl"
    with RowsFile(file, head_of("tests.sweeps.functions.square", {})), pytest.raises(InputError, match="no other run"):
        sweep(square, TEN, executor=threads, file=file)
    assert len(sweep(square, TEN, executor=threads, file=file).rows) == 10


def test_a_full_disk_costs_no_row_that_is_written(tmp_path, threads):
    file = tmp_path / "rows.jsonl"
    with files_up_to(600), pytest.raises(FileFull, match="make room there") as caught:
        sweep(square, [{"n": n} for n in range(100)], executor=threads, file=file)
    kept = read_sweep(file).rows
    assert len(kept) == caught.value.rows > 2
    assert file.read_bytes().endswith(b"}\n")
    whole = sweep(square, [{"n": n} for n in range(100)], executor=threads, file=file)
    assert {row.case["n"] for row in whole.rows} == set(range(100))
    assert len(lines_of(file)) == 101


class Counting(ThreadPoolExecutor):
    """How many calls are on their way at once, at most."""

    def __init__(self):
        super().__init__(8)
        self.now = self.most = 0
        self.lock = threading.Lock()

    def submit(self, function, *arguments):
        with self.lock:
            self.now += 1
            self.most = max(self.most, self.now)
        future = super().submit(function, *arguments)
        future.add_done_callback(self._less)
        return future

    def _less(self, _):
        with self.lock:
            self.now -= 1


@pytest.mark.parametrize(("within", "most"), [(100, 1), (299, 2), (300, 3)])
def test_memory_limits_how_many_run_at_once(within, most):
    with Counting() as pool:
        swept = sweep(slow_square, TEN, fixed={"seconds": 0.01}, executor=pool, memory=lambda n: 100, within=within)
    assert len(swept.rows) == 10
    assert not swept.failures
    assert pool.most == most


def test_a_case_that_no_memory_holds_is_a_row(threads):
    swept = sweep(square, TEN, executor=threads, memory=lambda n: 10**n, within=10**6)
    assert [row.case["n"] for row in swept.failures] == [7, 8, 9]
    failure = swept.failures[0].failure
    assert (failure.kind, failure.numbers) == ("CaseTooLarge", {"needed": 10**7, "free": 10**6})
    assert sweep(square, TEN, executor=threads, memory=lambda n: 1 // n).failures[0].failure.kind == "ZeroDivisionError"


def test_an_executor_that_breaks_down_leaves_no_false_rows(tmp_path):
    file = tmp_path / "rows.jsonl"
    with ProcessPoolExecutor(1) as pool:
        pool.submit(deadly_square, 3)
        with pytest.raises(SweepStopped, match="have no row") as caught:
            sweep(square, TEN, executor=pool, file=file)
    assert len(read_sweep(file).rows) == len(caught.value.rows.rows) == 10 - caught.value.missing
    assert not caught.value.rows.failures


@pytest.mark.parametrize(
    ("function", "cases", "options", "said"),
    [
        (lambda n: n, TEN, {}, "function of a module"),
        (square, [], {}, "at least one case"),
        (square, [3], {}, "pass dictionaries"),
        (square, [{"m": 3}], {}, "arguments of the function"),
        (square, [{"n": 3}], {"fixed": {"n": 3}}, "name it once"),
        (square, [{"n": object()}], {}, "a chain, text, a number"),
        (square, TEN, {"within": 100}, "memory="),
        (square, TEN, {"memory": len, "within": 0}, "within = 0"),
        (square, TEN, {"file": "no/such/folder/rows.jsonl"}, "folder"),
    ],
)
def test_other_arguments_are_refused(threads, function, cases, options, said):
    with pytest.raises(InputError, match=said):
        sweep(function, cases, executor=threads, **options)


def test_numbers_of_many_digits_are_text(threads):
    with mpmath.workdps(40):
        third = mpmath.mpf(1) / 3
    swept = sweep(square, [{"n": third}], executor=threads)
    assert mpmath.mpf(swept.rows[0].case["n"]) == pytest.approx(1 / 3)
    assert len(swept.rows[0].case["n"]) > 40


def test_what_might_never_end_is_not_read_as_a_sweep(tmp_path, threads):
    """A pipe that nobody writes: opening it would wait for ever."""
    os.mkfifo(tmp_path / "pipe")
    for call in (read_sweep, lambda path: sweep(pow, [{"base": 2, "exp": 3}], executor=threads, file=path)):
        with pytest.raises(InputError, match="allowed is a regular file"):
            call(tmp_path / "pipe")
