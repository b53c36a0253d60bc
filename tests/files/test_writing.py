"""Output folders and files: made, or refused before anything is computed."""

import pytest

from symfpu.errors import InputError
from symfpu.files.writing import output_file, output_folder


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
    for path in (tmp_path, tmp_path / "none" / "new"):
        with pytest.raises(InputError, match="output"):
            output_file(path)
