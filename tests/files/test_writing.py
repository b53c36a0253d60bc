"""Files are written whole or not at all, links are followed, devices and pipes stay what they are."""

import csv
import errno
import fcntl
import os
import pty
import signal
import socket
import stat
import subprocess
import sys

import numpy as np
import pytest

from symfpu import InputError
from symfpu.files import writing
from symfpu.files.archive import SCHEMA, Archive, write_document
from symfpu.files.formats import BUNDLE
from symfpu.files.writing import open_to_read, output_file, output_folder, regular_file, write_bytes, write_file, write_rows, write_text
from tests.system import of_system, raising, read_from


def drafts(folder):
    return [path.name for path in folder.iterdir() if path.name.startswith(".symfpu-")]


def test_output_folder_is_made_with_its_parents(tmp_path):
    assert output_folder(tmp_path / "a" / "b").is_dir()
    assert output_folder(tmp_path / "a" / "b").is_dir()


def test_a_file_is_no_output_folder(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="output"):
        output_folder(tmp_path / "file")


def test_an_output_file_is_refused_before_anything_is_computed(tmp_path):
    assert output_file(tmp_path / "new") == tmp_path / "new"
    assert list(tmp_path.iterdir()) == []
    for path in (tmp_path, tmp_path / "none" / "new", tmp_path / "a\0b"):
        with pytest.raises(InputError, match="output"):
            output_file(path)


def test_a_file_that_is_replaced_keeps_its_permissions(tmp_path):
    path = tmp_path / "file"
    path.write_text("before")
    path.chmod(0o640)
    write_text(path, "after")
    assert path.read_text() == "after"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert drafts(tmp_path) == []


def test_a_link_is_followed(tmp_path):
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    (folder / "file").write_text("before")
    for name, target in (("old", "file"), ("new", "made")):
        link = tmp_path / name
        link.symlink_to(folder / target)
        assert output_file(link) == link
        write_text(link, f"through {name}")
        assert link.is_symlink()
        assert (folder / target).read_text() == f"through {name}"
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    (tmp_path / "nowhere").symlink_to(tmp_path / "none" / "file")
    for name in ("loop", "nowhere"):
        with pytest.raises(InputError, match="a folder that exists"):
            output_file(tmp_path / name)
        with pytest.raises(InputError, match="a file that can be written"):
            write_text(tmp_path / name, "")


def test_a_file_that_fails_stays_as_it_was(tmp_path, monkeypatch):
    path = tmp_path / "file"
    path.write_text("before")

    def interrupted(stream):
        stream.write(b"half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_file(path, interrupted)
    monkeypatch.setattr(os, "fsync", raising(of_system(errno.ENOSPC)))
    with pytest.raises(InputError, match=r"file'.*No space left on device") as caught:
        write_text(path, "after")
    assert caught.value.value == str(path)
    assert path.read_text() == "before"
    assert drafts(tmp_path) == []


def test_a_pipe_is_written_to_and_stays_a_pipe(tmp_path):
    pipe = tmp_path / "pipe"
    with read_from(pipe) as heard:
        assert output_file(pipe) == pipe
        write_bytes(pipe, b"content")
    assert heard == [b"content"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert drafts(tmp_path) == []


def test_a_device_is_written_to_and_stays_a_device(tmp_path):
    """The terminal of a pair, by its own name and by a link."""
    ours, theirs = pty.openpty()
    try:
        terminal = os.ttyname(theirs)
        before = os.stat(terminal)
        link = tmp_path / "link"
        link.symlink_to(terminal)
        for path in (writing.Path(terminal), link):
            assert output_file(path) == path
            write_text(path, "heard")
            assert os.read(ours, 100) == b"heard"
        assert os.path.samestat(os.stat(terminal), before)
        assert link.is_symlink()
    finally:
        os.close(ours)
        os.close(theirs)


def test_an_archive_goes_through_a_pipe(tmp_path):
    """A stream that does not go back: what comes out is the file."""
    body, values = {"format": BUNDLE, "schema": SCHEMA}, np.arange(1000.0)
    copy = tmp_path / "copy"
    with read_from(tmp_path / "pipe") as heard:
        write_document(tmp_path / "pipe", body, {"values": values})
    copy.write_bytes(*heard)
    with copy.open("rb") as stream:
        assert (Archive(copy, stream).array("values", "<f8", 1000) == values).all()


def test_a_socket_is_refused(tmp_path):
    path = tmp_path / "socket"
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(str(path))
        for refused in (output_file, lambda path: write_text(path, "")):
            with pytest.raises(InputError, match="neither a file, a pipe nor"):
                refused(path)
    assert stat.S_ISSOCK(path.stat().st_mode)


PRINTS = """
import sys
from pathlib import Path
from symfpu.files.writing import write_text
print("first")
write_text(Path("/dev/stdout"), "second\\n")
print("third")
"""


@pytest.mark.parametrize("to", ["file", "pipe"])
def test_standard_output_by_name_comes_in_its_turn(to, tmp_path):
    path = tmp_path / "out"
    command = [sys.executable, "-c", PRINTS]
    if to == "file":
        with path.open("wb") as stream:
            subprocess.run(command, stdout=stream, check=True)
        shown = path.read_text()
    else:
        shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert shown.splitlines() == ["first", "second", "third"]


HALF = """
import sys, time
from pathlib import Path
from symfpu.files.writing import write_file
def half(stream):
    stream.write(b"half")
    stream.flush()
    print("written", flush=True)
    time.sleep(60)
write_file(Path(sys.argv[1]), half)
"""


def test_drafts_of_dead_processes_go_and_those_of_living_ones_stay(tmp_path):
    writer = subprocess.Popen([sys.executable, "-c", HALF, tmp_path / "theirs"], stdout=subprocess.PIPE)
    try:
        assert writer.stdout.readline() == b"written\n"
        [draft] = drafts(tmp_path)
        assert f"-{writer.pid}-" in draft
        write_text(tmp_path / "ours", "whole")
        assert drafts(tmp_path) == [draft]
    finally:
        writer.send_signal(signal.SIGKILL)
        writer.wait()
        writer.stdout.close()
    assert drafts(tmp_path) == [draft]
    for name in (".symfpu-notes", ".symfpu-1-0123456789abcdef"):
        target = tmp_path / "kept" if name.endswith("f") else tmp_path / name
        target.write_text("of somebody else")
    (tmp_path / ".symfpu-1-0123456789abcdef").symlink_to(tmp_path / "kept")
    write_text(tmp_path / "ours", "again")
    assert sorted(drafts(tmp_path)) == [".symfpu-1-0123456789abcdef", ".symfpu-notes"]
    assert (tmp_path / "kept").read_text() == "of somebody else"


def test_a_draft_that_is_removed_before_it_is_locked_is_made_again(tmp_path, monkeypatch):
    first = []

    def removed(stream):
        if not first:
            first.append(os.path.basename(stream.name))
            os.unlink(stream.name)
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return True

    monkeypatch.setattr(writing, "lock", removed)
    write_text(tmp_path / "file", "whole")
    assert len(first) == 1
    assert (tmp_path / "file").read_text() == "whole"
    assert drafts(tmp_path) == []


def test_a_table_is_written_as_csv_does(tmp_path):
    rows = [["t", "a, b"], ["0.5", 'c "d"']]
    write_rows(tmp_path / "table.csv", rows)
    with (tmp_path / "table.csv").open(newline="") as stream:
        assert list(csv.reader(stream)) == rows


def test_what_might_never_end_is_not_opened_to_read(tmp_path):
    """A pipe that nobody writes: opening it would wait for ever."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    ours, theirs = pty.openpty()
    try:
        for path in (pipe, writing.Path(os.ttyname(theirs))):
            with pytest.raises(InputError, match="a regular file"):
                open_to_read(path)
    finally:
        os.close(ours)
        os.close(theirs)
    with pytest.raises(FileNotFoundError):
        open_to_read(tmp_path / "none")


def test_what_is_read_again_is_a_regular_file(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(InputError, match="a regular file"):
        regular_file(pipe, "file", "choose another")
    assert regular_file(tmp_path / "new", "file", "choose another") == tmp_path / "new"
