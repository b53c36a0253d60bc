"""Every requirement has a lowest version, from which `make lowest` makes its environment."""

import runpy
from pathlib import Path

import pytest

lowest = runpy.run_path(str(Path(__file__).parents[1] / ".ci" / "lowest.py"))["lowest"]


def test_the_constraints_are_the_bounds_of_the_project(tmp_path):
    project = tmp_path / "pyproject.toml"
    project.write_text('[project]\ndependencies = ["b-c>=1.5", "a>=2"]\n[project.optional-dependencies]\nx = ["d>=0.1rc1", "a>=2"]\n')
    assert list(lowest(project)) == ["a==2", "b-c==1.5", "d==0.1rc1"]


@pytest.mark.parametrize("requirement", ["a", "a==1", "a>=1,<2", "a>1"])
def test_a_requirement_without_a_lowest_version_is_refused(requirement, tmp_path):
    project = tmp_path / "pyproject.toml"
    project.write_text(f'[project]\ndependencies = ["{requirement}"]\n[project.optional-dependencies]\n')
    with pytest.raises(ValueError, match="not of the form"):
        list(lowest(project))


def test_our_own_requirements_have_one():
    names = [line.split("==")[0] for line in lowest()]
    assert {"numpy", "scipy", "numba", "pytest"} <= set(names)
    assert len(names) == len(set(names))
