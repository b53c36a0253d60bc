"""Errors go to other processes and come back whole: pickled and copied; and one failing case costs a pool no other."""

import importlib
import multiprocessing
import pkgutil
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path

import mpmath
import pytest

import symfpu
from symfpu import Chain, SymfpuError, lindstedt, solve_amplitudes
from symfpu.breathers.curve import NotOnTheCurve
from symfpu.breathers.equations import Balance
from symfpu.checkers.reading import CertificateError
from symfpu.cli.terminal import Interrupted
from symfpu.errors import VanishingResidue
from symfpu.families.appendix_a import NoFurtherMember
from symfpu.files.checkpoint import Refused
from symfpu.paper.corrected import TimeIsUp
from symfpu.paper.side_by_side import TargetsFailed
from symfpu.sweeps.rows import SweepFailure
from tests.every_result import COPIES, PAIR, SINGLE, mapped, orbit, refined, stability, swept, swept_rules
from tests.store.test_saved_file import same


def caught(kind, function, *arguments, **options):
    with pytest.raises(kind) as found:
        function(*arguments, **options)
    return found.value


def no_periodic_orbit():
    balance = Balance(SINGLE, 3, 2)
    return symfpu.NoPeriodicOrbit(balance, "the step fails", balance.vector(orbit().cosines, 0.01))


@cache
def no_torus_at_energy():
    soft = Chain(2, beta="-0.5")
    return caught(symfpu.NoTorusAtEnergy, symfpu.torus, soft, (1,), energy="100", method="series", order=1)


@cache
def no_frequencies():
    return caught(symfpu.NoSelfConsistentFrequencies, symfpu.torus, Chain(8, beta=-1), (3,), amplitudes={3: 10}, method="series", order=1)


ERRORS = {
    SymfpuError: lambda: SymfpuError("something failed; do something else"),
    symfpu.InputError: lambda: symfpu.InputError("order", -1, "0 or more", "take 0"),
    symfpu.TooLarge: lambda: symfpu.TooLarge(9, 10**12, 10**9, 5),
    symfpu.TorusTooLarge: lambda: symfpu.TorusTooLarge(16, 9000, 10**12, 10**9, 300),
    symfpu.ExpansionTooLarge: lambda: symfpu.ExpansionTooLarge(1e9, 1e11, 10**9),
    symfpu.ResonantDivisor: lambda: symfpu.ResonantDivisor(7, (2, 1), (1, 3), 2, exact=True),
    symfpu.NoRealAmplitude: lambda: symfpu.NoRealAmplitude(1, -0.5, 4),
    symfpu.DidNotConverge: lambda: symfpu.DidNotConverge(4, {1: 0.1}, 0.3),
    symfpu.UndeterminedAmplitudes: lambda: symfpu.UndeterminedAmplitudes((1, 2), 2),
    VanishingResidue: lambda: VanishingResidue(13, 2),
    symfpu.OrbitStopped: lambda: symfpu.OrbitStopped("it stopped", "go on", time=1.0, mode=3, energy=0.5, orbit=(1,)),
    symfpu.EscapedOrbit: lambda: symfpu.EscapedOrbit("it left", "stay", time=1.0, mode=3, energy=0.5),
    symfpu.UnstableStep: lambda: symfpu.UnstableStep("a long step", "shorten it", time=0.0, mode=7, energy=0.5),
    symfpu.OrbitLost: lambda: symfpu.OrbitLost(3.0, 0.1),
    symfpu.BundleError: lambda: symfpu.BundleError(Path("torus"), "is damaged", "restore it"),
    Refused: lambda: Refused("file", "orbit", "a checkpoint of the same orbit", "name another"),
    symfpu.NoDiscriminant: lambda: symfpu.NoDiscriminant((3.0, 0.5), 0.1),
    symfpu.BandsTooNarrow: lambda: symfpu.BandsTooNarrow(2),
    symfpu.NoTodaTorus: lambda: symfpu.NoTodaTorus((1, 2), (0.1, 3.0), 0.5),
    symfpu.NoRecurrence: lambda: symfpu.NoRecurrence(10.0, 0.5),
    symfpu.NoTwist: lambda: symfpu.NoTwist("Newton's matrix is singular"),
    NotOnTheCurve: lambda: NotOnTheCurve("a reason", None, crossings=1),
    symfpu.NotInFamily: lambda: symfpu.NotInFamily("H", 1.0, (0.1, 0.5), "ended"),
    NoFurtherMember: lambda: NoFurtherMember("no root", (1,), (0.4,), "a reason"),
    symfpu.NoTorus: lambda: symfpu.NoTorus("a reason", refined(), 0.1),
    symfpu.NoNormalModes: lambda: symfpu.NoNormalModes(3, 1.1, stability().resonances[0]),
    symfpu.NoStabilityProof: lambda: symfpu.NoStabilityProof(0.1 + 0j, "Y", 1e-3, 1e-5, "more digits may help"),
    symfpu.NoStayProof: lambda: symfpu.NoStayProof(1e9, 1e5, 1e-14, 1e-12, 3.0),
    symfpu.NoExistenceProof: lambda: symfpu.NoExistenceProof("Y", 1e-3, 1e-5, "more digits may help"),
    symfpu.NoTorusAtEnergy: no_torus_at_energy,
    symfpu.NoSelfConsistentFrequencies: no_frequencies,
    symfpu.NoPeriodicOrbit: no_periodic_orbit,
    symfpu.NoBreatherAtEnergy: lambda: symfpu.NoBreatherAtEnergy(3, 0.5, False, orbit(), no_periodic_orbit()),
    symfpu.SweepIncomplete: lambda: symfpu.SweepIncomplete(
        swept_rules(), {(5, (1,)): SweepFailure("TooLarge", "order = 9", {"needed": 10**12})}
    ),
    symfpu.MapIncomplete: lambda: symfpu.MapIncomplete(mapped(), {"10": SweepFailure("EscapedOrbit", "bond 2", {"energy": 10.0})}),
    symfpu.SweepStopped: lambda: symfpu.SweepStopped(swept(), 3, "a reason"),
    symfpu.CaseTooLarge: lambda: symfpu.CaseTooLarge(10**12, 10**9),
    symfpu.FileFull: lambda: symfpu.FileFull("rows.jsonl", 3, "No space left on device"),
    symfpu.WorkerDied: lambda: symfpu.WorkerDied(-9),
    symfpu.WorkersDoNotStart: lambda: symfpu.WorkersDoNotStart("exit code 1"),
    Interrupted: lambda: Interrupted("nothing is kept"),
    TimeIsUp: lambda: TimeIsUp(10.0, "step 3"),
    TargetsFailed: lambda: TargetsFailed({"fig9": Interrupted("nothing is kept")}),
    CertificateError: lambda: CertificateError("a witness is zero"),
}


def all_errors(kind=SymfpuError):
    return {kind}.union(*map(all_errors, kind.__subclasses__()))


def test_every_error_of_every_module_has_a_case():
    for module in pkgutil.walk_packages(symfpu.__path__, "symfpu."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    assert {kind for kind in all_errors() if kind.__module__.startswith("symfpu.")} <= set(ERRORS)


def content(error):
    """Attributes by name, in whatever order they were set; those that are errors as what is in them."""
    failures = vars(error).get("failures", {})
    inside = {"failures": [content(e) for e in failures.values()]} if failures else {}
    return dict(sorted((vars(error) | inside).items()))


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("kind", ERRORS, ids=lambda kind: kind.__name__)
def test_errors_come_back_whole(kind, way):
    error = ERRORS[kind]()
    error.__notes__ = ["a note"]
    returned = COPIES[way](error)
    assert returned is not error
    assert type(returned) is type(error) is kind
    assert str(returned) == str(error)
    assert same(returned.args, error.args)
    assert same(content(returned), content(error))


FAILING = 2


def amplitude_of(case):
    """Work for a pool, of which one case fails."""
    frequency = {0: "0.3905", 1: "0.391", FAILING: "0.39"}[case]
    return solve_amplitudes(lindstedt(PAIR, (1,), (frequency,), 4, digits=30))


@pytest.mark.long
def test_one_failing_case_costs_a_pool_of_processes_no_other():
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        tasks = [pool.submit(amplitude_of, case) for case in (0, FAILING, 1)]
        good, error = [tasks[0].result(), tasks[2].result()], tasks[1].exception()
    expected = caught(symfpu.NoRealAmplitude, amplitude_of, FAILING)
    assert type(error) is symfpu.NoRealAmplitude
    assert str(error) == str(expected)
    assert vars(error) == vars(expected)
    for found, case in zip(good, (0, 1), strict=True):
        alone = amplitude_of(case)
        assert same(found.amplitudes, alone.amplitudes)
        assert str(found.amplitudes[1]) == mpmath.nstr(alone.amplitudes[1], 30)
