"""The gallery: the same bytes again, files that pass their own tests, and commands that make them."""

import hashlib
import json
from pathlib import Path

import pytest

from symfpu.cli.main import main
from symfpu.codegen.gallery import GALLERY, build
from tests.codegen.compilers import self_test

FOLDER = Path(__file__).parents[2] / "generated"
FILES = sorted(path for path in FOLDER.iterdir() if path.name != "manifest.json")


@pytest.fixture(scope="module")
def rebuilt(tmp_path_factory):
    return build(tmp_path_factory.mktemp("generated")).parent


@pytest.mark.long
def test_the_gallery_rebuilds_byte_for_byte(rebuilt):
    assert sorted(path.name for path in rebuilt.iterdir()) == sorted(path.name for path in FOLDER.iterdir())
    for path in FOLDER.iterdir():
        assert path.read_bytes() == (rebuilt / path.name).read_bytes(), path.name


def test_the_manifest_lists_every_file_with_its_hash():
    manifest = json.loads((FOLDER / "manifest.json").read_text())
    assert sorted(manifest) == [path.name for path in FILES]
    for path in FILES:
        assert manifest[path.name]["sha256"] == hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.mark.long
def test_the_commands_of_the_manifest_make_the_file(tmp_path, monkeypatch):
    manifest = json.loads((FOLDER / "manifest.json").read_text())
    monkeypatch.chdir(tmp_path)
    for command in manifest["breather_25.c"]["commands"]:
        assert main(command.split()[1:]) == 0
    assert (tmp_path / "breather_25.c").read_bytes() == (FOLDER / "breather_25.c").read_bytes()


@pytest.mark.long
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_every_file_passes_its_own_test(path, tmp_path):
    run = self_test(path, tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr


def test_every_example_is_there():
    assert {path.stem.removesuffix("_series").removesuffix("_mp") for path in FILES} == set(GALLERY)
