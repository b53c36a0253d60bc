"""Every kind of solution passes the same tests: one class a kind, its tests inherited."""

import inspect
from fractions import Fraction

import numpy as np
import pytest

import symfpu
from symfpu.bundles.bundle import save
from symfpu.bundles.solutions import KINDS
from symfpu.chain.chain import Chain
from symfpu.codegen.evaluator import compile_evaluator
from symfpu.codegen.export import export
from symfpu.errors import InputError
from symfpu.refinement.tori import refine
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic
from tests.tori.solutions import CASES, SolutionTests


class TestQTorus(SolutionTests):
    name, residual, with_series = "QTorus", 1e-7, True


class TestQTorusDigits(SolutionTests):
    name, residual, with_series = "QTorus, digits", 1e-9, True


class TestRefinedTorus(SolutionTests):
    name = "RefinedTorus"


class TestRefinedTorusOneAngle(SolutionTests):
    name = "RefinedTorus, one angle"


class TestResummedTorus(SolutionTests):
    name, residual = "ResummedTorus", 2e-7


class TestResummedTorusDigits(SolutionTests):
    name, residual = "ResummedTorus, digits", 1e-9


class TestFourierTorus(SolutionTests):
    name = "FourierTorus"


class TestPeriodicOrbit(SolutionTests):
    name = "PeriodicOrbit"


class TestPreciseOrbit(SolutionTests):
    name, residual = "PreciseOrbit", 1e-25


class TestPreciseTorus(SolutionTests):
    name, residual = "PreciseTorus", 1e-20


class TestShotOrbit(SolutionTests):
    name, residual = "ShotOrbit", 1e-11


def kinds(base=QuasiPeriodic):
    return {base}.union(*map(kinds, base.__subclasses__()))


def test_every_kind_has_its_tests():
    ours = {kind.__name__ for kind in kinds() - {QuasiPeriodic} if kind.__module__.startswith("symfpu.")}
    tested = {test.name for test in SolutionTests.__subclasses__()}
    assert tested == set(CASES)
    assert ours == {name.partition(",")[0] for name in CASES}
    assert ours == {*KINDS, "QTorus", "RefinedTorus"}
    public = {name for name in symfpu.__all__ if inspect.isclass(getattr(symfpu, name))}
    assert ours <= public


@pytest.mark.parametrize("door", [refine, compile_evaluator, lambda x: export(x, "c", "x"), lambda x: save("x", x)])
def test_what_is_no_solution_is_refused_at_every_door(door):
    with pytest.raises(InputError, match="a solution: a torus or a breather"):
        door(np.ones((3, 7)))


def mode(q, *harmonic):
    """A solution of one harmonic in one mode, seeds 1 and 2, at the linear frequencies."""
    cosines = np.zeros((1, 7))
    cosines[0, q - 1] = 1.0
    chain = Chain(8, alpha="0.3")
    frequencies = tuple(map(Fraction, chain.frequencies()[:2].tolist()))
    return FourierTorus(chain, (1, 2), frequencies, np.array([harmonic]), cosines, {1: 0.5})


def test_phases_left_out_are_zero():
    assert mode(1, 1, 0).phases == {1: 0.5, 2: 0.0}


def test_amplitudes_are_found_under_either_sign_of_a_harmonic_and_zero_where_there_is_none():
    assert mode(2, 0, -1).amplitudes == {1: 0.0, 2: 1.0}


def test_a_harmonic_in_modes_of_the_other_parity_is_not_exported(tmp_path):
    """Sources have no place for it: it was left out in silence."""
    with pytest.raises(InputError, match=r"^solution = .*nu.seeds - q even"):
        export(mode(2, 1, 0), "numpy", tmp_path / "mode")


def test_files_refuse_kinds_they_do_not_know(tmp_path):
    class Strange(FourierTorus):
        pass

    torus = CASES["FourierTorus"]()
    strange = Strange(torus.chain, torus.seeds, torus.frequencies, torus.harmonics, torus.cosines, torus.phases)
    with pytest.raises(InputError, match=r"^result = 'Strange'.*in_doubles"):
        save(tmp_path / "strange", strange)
