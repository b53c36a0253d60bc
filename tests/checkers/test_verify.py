"""Checkers run by the standard library alone, from the folder of the package."""

import subprocess
import sys
from pathlib import Path

import pytest

import symfpu
from symfpu import Chain, prove_existence, prove_propagation
from symfpu.checkers.__main__ import main

FOLDER = Path(symfpu.__file__).parent / "checkers"


def checked(*files):
    return subprocess.run([sys.executable, "-I", "-S", FOLDER, *files], capture_output=True, text=True, check=False, cwd="/")


@pytest.fixture(scope="module")
def proofs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("proofs")
    prove_propagation(8, (1, 4), 2, model="beta").write(folder / "rule.json")
    prove_existence(symfpu.torus(Chain(3, alpha="0.3"), (1,), amplitudes={1: "0.1"})).write(folder / "breather.json")
    return folder


def test_valid_certificates_are_said_to_be(proofs):
    found = checked(proofs / "rule.json", proofs / "breather.json")
    assert (found.returncode, found.stderr) == (0, "")
    assert found.stdout.count("the certificate is valid") == 2


def test_one_that_is_refused_ends_in_1_and_the_others_are_checked(proofs, tmp_path):
    text = (proofs / "rule.json").read_text()
    (tmp_path / "forged.json").write_text(text.replace('"order": 2', '"order": 3'))
    found = checked(tmp_path / "forged.json", proofs / "rule.json")
    assert found.returncode == 1
    assert "forged.json: refused: the digest is not that of the contents" in found.stderr
    assert "rule.json: the certificate is valid" in found.stdout


def test_without_a_file_it_says_how_it_is_used(capsys):
    assert main([]) == 2
    assert "python -I -S symfpu/checkers FILE" in capsys.readouterr().err
