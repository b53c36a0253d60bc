"""One run at a time has a file or a folder; a killed one has nothing."""

import errno
import os
import subprocess
import sys

import pytest

from symfpu import InputError
from symfpu.files import locking
from symfpu.files.locking import one_run
from tests.system import of_system, raising

WAITS = """
import sys, time
from pathlib import Path
from symfpu.files.locking import one_run
with one_run(Path(sys.argv[1])):
    print("locked", flush=True)
    time.sleep(60)
"""


def test_a_second_run_is_refused_with_the_process_of_the_first(tmp_path):
    file = tmp_path / "run"
    said = rf"process {os.getpid()} on .*wait for the other orbit"
    with one_run(file), pytest.raises(InputError, match=said), one_run(file, run="orbit"):
        pass
    assert list(tmp_path.iterdir()) == []
    with one_run(file), one_run(tmp_path / "other"), one_run(tmp_path):
        pass
    assert list(tmp_path.iterdir()) == []


def test_a_folder_is_locked_by_all_of_its_names(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "folder")
    with one_run(tmp_path / "folder"):
        for name in ("link", "folder"):
            with (
                pytest.raises(InputError, match=r"^folder = .*a folder that no other run writes"),
                one_run(tmp_path / name, argument="folder"),
            ):
                pass


def test_a_file_is_locked_by_all_of_its_names(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "folder" / "run")
    with one_run(tmp_path / "folder" / "run"), pytest.raises(InputError, match="no other run"), one_run(tmp_path / "link"):
        pass


def test_the_lock_of_a_killed_process_does_not_count(tmp_path):
    file = tmp_path / "run"
    other = subprocess.Popen([sys.executable, "-c", WAITS, file], stdout=subprocess.PIPE)
    try:
        assert other.stdout.readline() == b"locked\n"
        with pytest.raises(InputError, match=f"process {other.pid} on"), one_run(file):
            pass
    finally:
        other.kill()
        other.wait()
        other.stdout.close()
    assert len(list(tmp_path.iterdir())) == 1
    with one_run(file):
        pass
    assert list(tmp_path.iterdir()) == []


def test_a_lock_that_was_removed_before_it_was_had_is_made_again(tmp_path, monkeypatch):
    """Another run ends between opening the lock file and locking it."""
    file, usual, removed = tmp_path / "run", locking.lock, []

    def lock(stream):
        if not removed:
            removed.append(stream.name)
            os.unlink(stream.name)
        return usual(stream)

    monkeypatch.setattr(locking, "lock", lock)
    with one_run(file), pytest.raises(InputError, match="no other run"), one_run(file):
        pass
    assert len(removed) == 1


def test_a_file_system_without_locks_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(locking, "lock", raising(of_system(errno.ENOLCK)))
    with pytest.warns(RuntimeWarning, match="no locks.*one process"), one_run(tmp_path / "run"):
        pass


def test_a_place_without_room_is_refused_by_name(tmp_path, monkeypatch):
    monkeypatch.setattr(locking, "_taken", raising(of_system(errno.ENOSPC)))
    with pytest.raises(InputError, match=r"run'.*No space left on device"), one_run(tmp_path / "run"):
        pass


def test_two_files_are_locked_together_or_not_at_all(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    with one_run(second), pytest.raises(InputError, match="second"), one_run(first, second):
        pass
    with one_run(first, None, second):
        pass
