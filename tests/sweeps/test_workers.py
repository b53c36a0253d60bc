"""Processes that die: of their own, by signals at random moments, with their driver; and Dask."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import CancelledError
from pathlib import Path

import psutil
import pytest

from symfpu import sweep
from symfpu.algebra.dense import available_cores, threads_of_a_computation
from symfpu.sweeps.rows_file import read_rows
from symfpu.sweeps.workers import ProcessWorkers, worker_processes
from tests.sweeps.functions import deadly_square, slow_square, square, square_in_little_memory, told_square

ROOT = Path(__file__).parents[2]


def test_a_worker_that_dies_is_a_row_and_the_rest_goes_on():
    swept = sweep(deadly_square, [{"n": n} for n in range(8)])
    assert {row.case["n"]: row.result for row in swept.rows if row.failure is None} == {n: n * n for n in (0, 1, 2, 4, 6, 7)}
    assert [row.failure.kind for row in swept.failures] == ["WorkerDied"] * 2
    assert [row.failure.numbers for row in swept.failures] == [{"exit_code": 7}, {"exit_code": -9}]
    assert "by signal 9" in swept.failures[1].failure.message


def test_a_worker_out_of_memory_is_a_row():
    cases = [{"n": n, "numbers": 10**9 if n == 1 else 10} for n in range(4)]
    swept = sweep(square_in_little_memory, cases)
    assert [row.result for row in swept.rows] == [0, None, 4, 9]
    assert swept.failures[0].failure.kind == "MemoryError"


def test_a_worker_that_is_killed_while_it_waits_costs_nothing():
    with ProcessWorkers(1) as pool:
        pid = pool.submit(os.getpid).result()
        os.kill(pid, signal.SIGKILL)
        assert pool.submit(os.getpid).result() != pid


def test_a_worker_computes_on_one_thread_unless_the_environment_says_otherwise(monkeypatch):
    for given, expected in ((None, 1), ("2", min(2, available_cores())), ("1,4", 1), ("none", available_cores())):
        monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
        if given is not None:
            monkeypatch.setenv("OMP_NUM_THREADS", given)
        assert threads_of_a_computation() == (expected if given else available_cores())
        with ProcessWorkers(1) as pool:
            assert pool.submit(threads_of_a_computation).result() == expected
        assert os.environ.get("OMP_NUM_THREADS") == given


def test_tasks_at_work_are_ended_where_they_are_cancelled():
    pool = ProcessWorkers(1)
    pid = pool.submit(os.getpid).result()
    working, waiting = pool.submit(time.sleep, 60), pool.submit(os.getpid)
    while not working.running():
        time.sleep(0.01)
    pool.shutdown(cancel_futures=True)
    assert working.exception().exit_code == -signal.SIGKILL
    assert isinstance(waiting_error(waiting), CancelledError)
    assert not psutil.pid_exists(pid)


def waiting_error(future):
    try:
        return future.exception(timeout=5)
    except CancelledError as error:
        return error


def test_what_a_task_tells_is_heard_in_its_order_and_before_its_end():
    heard = []
    with ProcessWorkers(1) as pool:
        future = pool.submit_heard(lambda label, fraction: heard.append((label, fraction)), told_square, 3)
        assert future.result() == 9
        assert heard == [("begun", 0.0), ("squared", 0.5)]
        assert pool.submit(square, 3).result() == {"square": 9, "root": 3**0.5}


def test_a_task_that_dies_after_it_has_told_something_is_dead():
    heard = []
    with ProcessWorkers(1) as pool:
        future = pool.submit_heard(lambda *told: heard.append(told), told_square, 3, deadly=True)
        assert future.exception().exit_code == 7
        assert heard == [("begun", 0.0)]
        assert pool.submit_heard(lambda *told: None, told_square, 2).result() == 4


def test_an_error_in_a_with_ends_what_is_at_work():
    futures = []

    def interrupted():
        with worker_processes(1) as pool:
            pool.submit(os.getpid).result()
            futures.append(pool.submit(time.sleep, 60))
            while not futures[0].running():
                time.sleep(0.01)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    (working,) = futures
    assert working.exception().exit_code == -signal.SIGKILL


def test_a_script_without_its_guard_is_told(tmp_path):
    script = tmp_path / "script.py"
    script.write_text("from symfpu.sweeps.sweep import sweep\nfrom tests.sweeps.functions import square\nsweep(square, [{'n': 1}])\n")
    done = run([str(script)])
    _, error = done.communicate(timeout=60)
    assert done.returncode == 1
    assert "start them under `if __name__ == '__main__':`" in error.decode()


def test_a_function_that_was_typed_is_refused_before_processes_start():
    lines = "from symfpu.sweeps.sweep import sweep\ndef typed(n): return n\nsweep(typed, [{'n': 1}])"
    _, error = run(["-c", lines]).communicate(timeout=60)
    assert b"a function in a file, from which worker processes import it" in error


def test_a_worker_at_work_ends_with_its_driver(tmp_path):
    script, mark = tmp_path / "script.py", tmp_path / "mark"
    imports = "from symfpu.sweeps.sweep import sweep\nfrom tests.sweeps.functions import mark_and_sleep\n"
    script.write_text(f"{imports}if __name__ == '__main__':\n    sweep(mark_and_sleep, [{{'file': {str(mark)!r}}}])\n")
    driver = run([str(script)])
    while not (mark.exists() and mark.read_text()):
        assert driver.poll() is None
        time.sleep(0.05)
    driver.kill()
    driver.wait()
    driver.stderr.close()
    assert no_orphans({int(mark.read_text())})


def run(arguments):
    path = {"PYTHONPATH": str(ROOT)}
    return subprocess.Popen([sys.executable, *arguments], cwd=ROOT, env=os.environ | path, stderr=subprocess.PIPE)


def kill_at_random(file, cases, seconds, chance, seed, moments):
    """Drive a sweep to its end through kill -9 of the driver and of its workers; how many of each."""
    source, deaths, seen = random.Random(seed), {"driver": 0, "workers": 0}, set()
    arguments = ["-m", "tests.sweeps.functions", str(file), str(cases), str(seconds)]
    driver = run(arguments)
    while driver.poll() is None:
        if source.random() < 0.9:  # else also before anything is done
            wait_for_a_row(file, driver)
        time.sleep(moments * source.random())
        workers = [process for process in children(driver.pid) if is_worker(process)]
        seen |= {process.pid for process in workers}
        if source.random() < chance:
            driver.kill()
            if driver.wait() == -signal.SIGKILL:
                driver.stderr.close()
                deaths["driver"] += 1
                driver = run(arguments)
        elif workers:
            source.choice(workers).kill()
            deaths["workers"] += 1
    _, told = driver.communicate()
    assert driver.returncode == 0, told.decode()
    return deaths, seen


def wait_for_a_row(file, driver):
    """So that a busy machine, which starts processes slowly, comes to the end of the sweep too."""
    before = file.stat().st_size if file.exists() else 0
    while driver.poll() is None and not (file.exists() and file.stat().st_size > before):
        time.sleep(0.01)


def children(pid):
    try:
        return psutil.Process(pid).children()
    except psutil.NoSuchProcess:
        return []


def is_worker(process):
    try:
        return "spawn_main" in " ".join(process.cmdline())
    except psutil.Error:
        return False


def check_rows(file, cases):
    """Each case once; a result that is right, or the death of its worker."""
    lines = [json.loads(line) for line in file.read_text().splitlines()][1:]
    assert sorted(line["case"]["n"] for line in lines) == list(range(cases))
    _, rows = read_rows(file)
    for row in rows:
        n = row.case["n"]
        assert row.result == {"square": n * n} or row.failure.kind == "WorkerDied"
    return [row for row in rows if row.failure]


def no_orphans(pids):
    end = time.monotonic() + 20
    while any(psutil.pid_exists(pid) for pid in pids) and time.monotonic() < end:
        time.sleep(0.1)
    return not any(psutil.pid_exists(pid) for pid in pids)


# cases, seconds of each, the chance of the driver, a seed, moments between kills, and the fewest deaths of each
KILLS = [(60, 0.05, 0.4, 3, 0.5, 0), *((1500, 0.01, 0.3, seed, 1.0, 2) for seed in (1, 2))]


@pytest.mark.long
@pytest.mark.parametrize(("cases", "seconds", "chance", "seed", "moments", "fewest"), KILLS)
def test_kills_at_random_lose_no_row_and_double_none(cases, seconds, chance, seed, moments, fewest, tmp_path):
    file = tmp_path / "rows.jsonl"
    deaths, seen = kill_at_random(file, cases, seconds, chance, seed, moments)
    failed = check_rows(file, cases)
    assert min(deaths.values()) >= fewest
    assert sum(deaths.values()) >= 1
    assert len(failed) <= deaths["workers"]
    assert no_orphans(seen)


@pytest.fixture
def dask():
    return pytest.importorskip("distributed", reason="the optional extra 'dask' is not installed")


@pytest.mark.filterwarnings("ignore")
def test_a_client_of_dask_works_unchanged(dask, tmp_path):
    local = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    cases, file = [{"n": n} for n in range(-1, 20)], tmp_path / "rows.jsonl"
    with dask.LocalCluster(**local) as cluster, dask.Client(cluster) as client:
        swept = sweep(square, cases, executor=client, file=file, memory=lambda n: 1, within=5)
    assert [row.result and row.result["square"] for row in swept.rows] == [None, *(n * n for n in range(20))]
    assert swept.rows[0].failure.kind == "InputError"
    assert len(file.read_text().splitlines()) == 22


@pytest.mark.long
@pytest.mark.filterwarnings("ignore")
def test_a_worker_of_dask_that_dies_is_a_row(dask):
    local = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with dask.LocalCluster(**local) as cluster, dask.Client(cluster) as client:
        swept = sweep(deadly_square, [{"n": n} for n in (1, 3, 6)], executor=client)
        assert sweep(slow_square, [{"n": 2}], fixed={"seconds": 0}, executor=client).rows[0].result == {"square": 4}
    assert [row.result for row in swept.rows] == [1, None, 36]
    assert swept.rows[1].failure.kind == "KilledWorker"
