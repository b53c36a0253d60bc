"""States in files: columns with spaces, tabs and commas, archives, ends of both kinds, files that are none."""

import os

import numpy as np
import pytest

from symfpu import Chain, InputError, particle_state, read_state

CHAIN, RING = Chain(4, alpha=1), Chain(3, alpha=1, ends="periodic")
X, P = [0.1, -0.25, 1e-3], [0.0, 0.5, -0.5]
ROWS = list(zip(X, P, strict=True))
TEXTS = {
    "csv": "x,p\n" + "".join(f"{x!r},{p!r}\n" for x, p in ROWS),
    "columns": "# made by hand\n" + "".join(f"  {x!r}\t{p!r}  # particle\n\n" for x, p in ROWS),
    "header": "\ufeffx p\r\n" + "".join(f"{x!r} , {p!r}\r\n" for x, p in ROWS),
}


@pytest.mark.parametrize("chain", [CHAIN, RING], ids=str)
@pytest.mark.parametrize("kind", TEXTS)
def test_text_is_read_to_the_last_bit(chain, kind, tmp_path):
    file = tmp_path / "state.txt"
    file.write_text(TEXTS[kind], encoding="utf-8")
    assert np.array_equal(read_state(chain, file), particle_state(chain, X, P))


@pytest.mark.parametrize("chain", [CHAIN, RING], ids=str)
def test_archives_are_read(chain, tmp_path):
    np.savez(tmp_path / "state.npz", x=X, p=P, t=0.0)
    assert np.array_equal(read_state(chain, str(tmp_path / "state.npz")), particle_state(chain, X, P))


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("s.txt", b"", "with 0 and 0 numbers': allowed is a displacement and a momentum of each of 3 particles"),
        ("s.txt", b"1 2\n", "with 1 and 1 numbers"),
        ("s.txt", b"1 2\n3\n4 5\n", "whose line 2 is '3'"),
        ("s.txt", b"1 2\n3 4 5\n4 5\n", "whose line 2 is '3 4 5'"),
        ("s.txt", b"1 2\n3 4\nx p\n", "whose line 3 is 'x p'"),
        ("s.txt", b"p,x\n1 2\n3 4\n4 5\n", "whose line 1 is 'p x'"),
        ("s.txt", b"\xff\xfe\x00\x01", "that is no text"),
        ("s.txt", b"1 2\n3 nan\n4 5\n", "momenta = 'nan or inf'"),
        ("s.npz", b"1 2\n", "that is none"),
        ("s.npz", b"PK\x03\x04", "that is none"),
    ],
)
def test_other_files_are_refused(name, content, words, tmp_path):
    file = tmp_path / name
    file.write_bytes(content)
    with pytest.raises(InputError, match=words):
        read_state(CHAIN, file)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"x": X}, "that is none"),
        ({"x": X, "p": [P]}, r"shapes \(3,\) and \(1, 3\)"),
        ({"x": X, "p": np.array([None, 1, 2], dtype=object)}, "that is none"),
        ({"x": ["a", "b", "c"], "p": P}, "that is none"),
    ],
)
def test_other_archives_are_refused(arrays, words, tmp_path):
    np.savez(tmp_path / "s.npz", **arrays)
    with pytest.raises(InputError, match=words):
        read_state(CHAIN, tmp_path / "s.npz")


def test_a_missing_file_is_an_error_of_the_system(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_state(CHAIN, tmp_path / "none.txt")


@pytest.mark.parametrize("name", ["state.txt", "state.npz"])
def test_what_might_never_end_is_not_read(name, tmp_path):
    """A pipe that nobody writes: opening it would wait for ever."""
    os.mkfifo(tmp_path / name)
    with pytest.raises(InputError, match="allowed is a regular file"):
        read_state(CHAIN, tmp_path / name)
