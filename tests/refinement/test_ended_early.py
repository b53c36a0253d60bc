"""Newton's method whose linear systems are not solved: steps that lower the residual are taken, and what was reached has a warning."""

import numpy as np
import pytest
import scipy.sparse.linalg

import symfpu
from symfpu import Chain, NoTorus, refine
from symfpu.borders import newton_end
from symfpu.borders.point import Ray
from symfpu.refinement import linear_system, tori
from symfpu.refinement.tori import ENDED_EARLY, REFINED_RESIDUAL, ended_early
from tests.tolerances import REFINED_COEFFICIENT

CHAIN, NEAR, WANTED = Chain(8, alpha="0.3"), {1: "0.29", 3: "0.14"}, {1: "0.3", 3: "0.15"}
KRYLOV = scipy.sparse.linalg.gmres
BLOCK = 8  # unknowns that are solved for directly


def guess(amplitudes=NEAR):
    return symfpu.torus(CHAIN, tuple(amplitudes), amplitudes=amplitudes, method="series", order=6)


@pytest.fixture
def solver(monkeypatch):
    """Parts of the solutions that the first systems get, the last one for all that follow; 0 is none."""
    monkeypatch.setattr(linear_system, "SMALLEST_BLOCK", BLOCK)
    monkeypatch.setattr(linear_system, "LARGEST_BLOCK", BLOCK)

    def give(*parts):
        left = list(parts)

        def gmres(operator, right, **limits):
            part = left.pop(0) if len(left) > 1 else left[0]
            solution, info = KRYLOV(operator, right, **limits)
            return part * solution, info if part == 1 else 1

        monkeypatch.setattr(scipy.sparse.linalg, "gmres", gmres)

    return give


def test_a_step_that_lowers_the_residual_is_a_step(solver):
    """Two systems are solved to 0.7 of their right-hand sides, the others to the end: the torus is that of exact steps."""
    expected = refine(guess(), amplitudes=WANTED)
    solver(0.3, 0.3, 1)
    found = refine(guess(), amplitudes=WANTED)
    assert found.warnings == ()
    assert len(found.origin.steps) > len(expected.origin.steps)
    assert np.array_equal(found.harmonics, expected.harmonics)
    assert np.abs(found.cosines - expected.cosines).max() < REFINED_COEFFICIENT


def test_a_step_that_does_not_is_the_last(solver):
    """Of a hundredth of the solution, and of a wrong one."""
    for part in (0.01, -1.0):
        solver(part)
        with pytest.raises(NoTorus, match=r"products leave \d\S* of the right-hand side"):
            refine(guess(), amplitudes=WANTED)


@pytest.mark.parametrize("part", [0.0, 0.01])
def test_where_all_but_rounding_was_reached_that_is_the_torus(solver, part):
    solver(1, 1, 1, part)
    found = refine(guess(), amplitudes=WANTED)
    [warning] = found.warnings
    assert ended_early(found)
    assert found.warnings
    assert f"of the right-hand side of Newton's method; the residual is {found.residual():.2g} with" in warning
    assert found.residual() < REFINED_RESIDUAL
    assert found.amplitudes == pytest.approx({1: 0.3, 3: 0.15}, abs=REFINED_COEFFICIENT)


def test_before_that_there_is_no_torus(solver):
    """The step before was still large, whatever the residual."""
    solver(1, 0.0)
    with pytest.raises(NoTorus) as failure:
        refine(guess({1: "0.2999", 3: "0.15"}), amplitudes=WANTED)
    assert failure.value.iterate.amplitudes[1] == pytest.approx(0.3, abs=REFINED_COEFFICIENT)
    assert not failure.value.iterate.warnings


def two_choices_of_harmonics():
    """From the lowest series, whose fall-off asks for half as many harmonics as are needed: 122 leave 2.9e-11."""
    amplitudes = {1: "0.4", 2: "0.2"}
    return refine(
        symfpu.torus(Chain(8, beta="0.3"), tuple(amplitudes), amplitudes=amplitudes, method="series", order=1), amplitudes=amplitudes
    )


@pytest.mark.parametrize("level", [REFINED_RESIDUAL, 1e-11])
def test_the_torus_of_fewer_harmonics_is_given_if_it_is_of_use(solver, monkeypatch, level):
    whole = two_choices_of_harmonics()
    monkeypatch.setattr(tori, "REFINED_RESIDUAL", level)
    solver(*whole_then_none(monkeypatch))
    if level == REFINED_RESIDUAL:
        found = two_choices_of_harmonics()
        assert ended_early(found)
        assert len(found.harmonics) < len(whole.harmonics)
        assert whole.residual() < found.residual() < REFINED_RESIDUAL
        return
    with pytest.raises(NoTorus) as failure:
        two_choices_of_harmonics()
    assert len(failure.value.iterate.harmonics) == len(whole.harmonics)


def whole_then_none(monkeypatch):
    """Parts of a solver for which every system with the first choice of harmonics is solved, and none with the second."""
    sizes = []
    solved = linear_system.Jacobian.approximate

    def counted(jacobian, *rest):
        sizes.append(jacobian.size)
        return solved(jacobian, *rest)

    with monkeypatch.context() as here:
        here.setattr(linear_system.Jacobian, "approximate", counted)
        two_choices_of_harmonics()
    return [1] * sizes.count(sizes[0]) + [0.0]


def test_a_border_does_not_take_it_for_a_torus(solver, monkeypatch):
    """There a smaller step is tried."""
    ray, place = Ray(Chain(8, beta="0.3"), (1, 2), 2), 0.01
    first, tori = ray.torus(place, None), newton_end._Tori(ray)
    assert tori.refined(first, place, newton_end.MOST_HARMONICS).warnings == ()
    solver(1, 1, 1, 0.0)
    early = refine(guess(), amplitudes=WANTED)
    monkeypatch.setattr(newton_end, "refine", lambda *_, **__: early)
    with pytest.raises(NoTorus, match=ENDED_EARLY):
        tori.refined(first, place, newton_end.MOST_HARMONICS)
