"""A missing compiler is skipped with one line, or a failure where it is required."""

import pytest

from tests.codegen.compilers import COMMANDS, PACKAGES, REQUIRED, program


@pytest.fixture
def nothing_installed(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv(REQUIRED, raising=False)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_missing_program_is_skipped_with_its_package(nothing_installed, name):
    with pytest.raises(pytest.skip.Exception) as skipped:
        program(name)
    assert str(skipped.value) == f"{name} is not installed (Debian: apt-get install {PACKAGES[name]})"


def test_a_required_program_that_is_missing_is_a_failure(nothing_installed, monkeypatch):
    monkeypatch.setenv(REQUIRED, "1")
    with pytest.raises(pytest.fail.Exception, match="gfortran is not installed"):
        program("gfortran")
