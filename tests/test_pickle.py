"""Results and errors go to other processes and come back: pickled and copied they answer the same."""

import copy
import importlib
import inspect
import multiprocessing
import pickle
import pkgutil
from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from pathlib import Path

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu.action_angle.at_rest import twist_at_rest
from symfpu.action_angle.birkhoff import birkhoff_form
from symfpu.action_angle.foretold import foretold_indices
from symfpu.action_angle.newton_twist import NoTwist
from symfpu.action_angle.twist import twist
from symfpu.breathers.at_energy import NoBreatherAtEnergy
from symfpu.breathers.balance import Balance, NoPeriodicOrbit, breather_at_amplitude, periodic_orbit
from symfpu.breathers.digits import periodic_orbit_digits
from symfpu.breathers.floquet import floquet
from symfpu.breathers.shooting import ShootingFailed, shoot
from symfpu.bundles.bundle import load, save
from symfpu.certified.enclosures import NoStabilityProof
from symfpu.certified.existence import NoExistenceProof, prove_existence
from symfpu.certified.residual import prove_residual
from symfpu.certified.stability_proof import prove_stability
from symfpu.certified.stay import NoStayProof, prove_stay
from symfpu.chain.chain import Chain
from symfpu.chain.propagation import excitation_sequence
from symfpu.cli.terminal import Interrupted
from symfpu.codegen.evaluator import compile_evaluator
from symfpu.dynamics.alignment import alignment_indices
from symfpu.dynamics.frame_run import OrbitLost
from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.stopping import EscapedOrbit, OrbitStopped, UnstableStep
from symfpu.errors import (
    DidNotConverge,
    ExpansionTooLarge,
    InputError,
    NoRealAmplitude,
    ResonantDivisor,
    SymfpuError,
    TooLarge,
    TorusTooLarge,
    UndeterminedAmplitudes,
    VanishingResidue,
)
from symfpu.families.appendix_a import NoFurtherMember, appendix_a
from symfpu.families.continuation import Event
from symfpu.families.family import NotInFamily, member_at_energy
from symfpu.families.following import family
from symfpu.files.archive import BundleError
from symfpu.files.checkpoint import Refused
from symfpu.files.kept_lines import FileFull
from symfpu.integrable.discriminant import NoDiscriminant
from symfpu.integrable.invariants import toda_invariants
from symfpu.integrable.quadrature import BandsTooNarrow
from symfpu.integrable.search import NoTodaTorus
from symfpu.integrable.torus import toda_torus
from symfpu.localization.growth import growth_exponents
from symfpu.localization.laws import fit_profile, profile_law
from symfpu.localization.profiles import fpu_trajectory, profile_distance
from symfpu.localization.recurrence import NoRecurrence, recurrence
from symfpu.localization.trials import profile_invariance
from symfpu.normal.modes import NoNormalModes
from symfpu.normal.phantom import normal_frequency_series
from symfpu.normal.search import normal_modes
from symfpu.paper.corrected import TimeIsUp
from symfpu.paper.side_by_side import TargetsFailed
from symfpu.proofs.certificates import prove_propagation
from symfpu.proofs.leading import leading_terms
from symfpu.proofs.reading import CertificateError
from symfpu.proofs.sweeps import Sweep, SweepCase, SweepIncomplete
from symfpu.proofs.theorem import prove_for_all_N
from symfpu.refinement.tori import NoTorus, refine, refine_at_amplitudes
from symfpu.series.expandable import expandable_term
from symfpu.series.lindstedt import lindstedt
from symfpu.series.sample import sample_series
from symfpu.series.travelling import travelling_waves
from symfpu.spectral.analysis import frequency_analysis
from symfpu.spectral.mapping import MapIncomplete
from symfpu.sweeps.rows import SweepFailure, SweepRow, SweepRows
from symfpu.sweeps.sweep import CaseTooLarge, SweepStopped
from symfpu.sweeps.workers import WorkerDied, WorkersDoNotStart
from symfpu.tori.amplitudes import amplitude_history, solve_amplitudes
from symfpu.tori.at_energy import NoTorusAtEnergy, torus_at_energy
from symfpu.tori.frequencies import NoSelfConsistentFrequencies, torus_at_amplitudes
from symfpu.tori.resummation import pade_frequencies, resum
from symfpu.tori.ring_torus import travelling_torus
from symfpu.tori.verdict import assess
from tests.bundles.test_bundle import SERIES, same
from tests.codegen.compilers import program
from tests.plots import cases

COPIES = {"pickle": lambda x: pickle.loads(pickle.dumps(x)), "copy": copy.copy, "deepcopy": copy.deepcopy}
PAIR, SINGLE = Chain(8, alpha="0.3"), Chain(8, alpha="0.4", beta="0.1")
TIMES = [0.0, 1.7, 100.0]


@cache
def series(digits=None):
    return lindstedt(PAIR, (1, 2), ("0.3905", "0.7663"), 4, digits=digits)


@cache
def torus(digits=None):
    """With all that it keeps of what it was asked: the copies hold that too."""
    found = solve_amplitudes(series(digits), phases={1: 0.4})
    found.positions(TIMES)
    return found


@cache
def refined():
    return refine(torus())


@cache
def two_angles():
    """A refined torus of the smallest chain that has one."""
    amplitudes = {1: "0.2", 2: "0.1"}
    return refine_at_amplitudes(torus_at_amplitudes(Chain(3, alpha="0.3"), amplitudes, order=4), amplitudes)


@cache
def orbit():
    return periodic_orbit(SINGLE, 3, breather_at_amplitude(SINGLE, 3, "0.3").frequency)


@cache
def stability():
    return normal_modes(orbit(), modes=[5])


@cache
def precise():
    return periodic_orbit_digits(orbit(), 30)


@cache
def breathers():
    return family(SINGLE, (3,), "0.05", from_energy="0.01", members=3, multipliers=True)


@cache
def trajectory():
    Q, P = fpu_trajectory(PAIR, {1: "0.1"})
    return integrate(PAIR, Q, P, 200.0, step=0.25, samples=np.arange(0.0, 200.0, 2.0), averages=True)


@cache
def growth():
    found = trajectory()
    groups = excitation_sequence(8, (1,), 2, model="alpha")
    return growth_exponents(PAIR, found.times[1:], found.averages[1:], groups)


@cache
def indices():
    Q, P = fpu_trajectory(PAIR, {1: "0.1"})
    return alignment_indices(PAIR, Q, P, 100.0, vectors=3, samples=64, frames=1)


@cache
def invariance():
    return profile_invariance(Chain(16, alpha="0.33"), "1/8", 1e-4, (16, 32, 48), 50.0)


@cache
def waves():
    return travelling_waves(Chain(8, alpha="0.3", ends="periodic"), (1,), ("0.766",), 6)


def series_of(kind, _):
    return SERIES[kind]()


def fitted():
    chain = Chain(32, beta="0.3")
    spectrum = 10 ** profile_law(chain, 4, 1e-6)(np.arange(1, 32) / 32)
    return fit_profile(chain, spectrum, 4, floor=0.0)


def lines_found():
    return frequency_analysis(integrate(Chain(N=3, beta=1), [0.1, 0.2], [0, 0], 300, step=0.25))


def times_and_returns():
    t = np.linspace(0, 15, 151)
    return recurrence(t, np.stack([1 + np.cos(t), 1 - np.cos(t)], axis=-1))


def bundle(folder):
    return load(save(folder / "torus", torus(30), verdict={"verdict": "good"}))


def motion(solution):
    state = solution.positions(TIMES), solution.momenta(TIMES), solution.energy()
    return *state, solution.average_spectrum(), solution.residuals()


def appendix(_):
    return appendix_a(PAIR, (1,), {1: 0.05}, 4, members=2)


def shot(_):
    return shoot(SINGLE, 3, orbit().frequency, orbit().positions(0.0))


def terms(found):
    return found.harmonic_terms([0.1, 0.2], 3), found.term(1, 2), found.coefficients(3, 2)


def energies(found):
    return found.energy_error, found.harmonic_energies(), found.scheme.stable_phase


# name of the class, and of the kind if there are several: how to make one (from a folder), and what to ask it
RESULTS = {
    "AlignmentIndices": (lambda _: indices(), lambda x: (x.slopes(), x.dimension())),
    "AmplitudeHistory": (lambda _: amplitude_history(series()), lambda x: x.differences()),
    "AmplitudeHistory, digits": (lambda _: amplitude_history(series(30)), lambda x: x.differences()),
    "AppendixAFamily": (appendix, lambda x: [motion(m.torus) for m in x.members]),
    "Assessment": (lambda _: assess(torus().series, torus()), lambda x: x.record()),
    "Atlas": (lambda _: cases.borders_found(), lambda x: (x.borders, x.laws, x.points)),
    "AtlasBorder": (lambda _: cases.borders_found().borders[0], lambda x: (x.N, x.model, x.limited, x.reason)),
    "BorderLaw": (lambda _: cases.borders_found().law("high:1", "poles"), lambda x: x.local),
    "Bundle": (bundle, lambda x: motion(x.torus)),
    "Chain": (lambda _: Chain(8, alpha="1/3", beta="0.1"), lambda x: (x.frequencies(), x.small_parameter())),
    "Event": (lambda _: Event("fold", "omega_1", 3, 0.1, 0.2), lambda x: x.kind),
    "ExistenceProof": (lambda _: prove_existence(orbit()), lambda x: x.certificate()),
    "StabilityProof": (lambda _: prove_stability(orbit()), lambda x: x.certificate()),
    "ResidualProof": (lambda _: prove_residual(two_angles()), lambda x: x.certificate()),
    "StayProof": (lambda _: prove_stay(two_angles(), time=1000), lambda x: (x.certificate(), x.distance_at(10))),
    "Family": (lambda _: breathers(), lambda x: member_at_energy(x, "0.012", harmonic=False).amplitudes),
    "Floquet": (lambda _: floquet(orbit()), lambda x: (x.stable, x.multipliers)),
    "FourierTorus": (lambda _: torus().in_doubles(), motion),
    "GroupGrowth": (lambda _: growth().groups[0], lambda x: x.mean),
    "GrowthExponents": (lambda _: growth(), lambda x: x.groups),
    **{f"LindstedtSeries, {kind}": (partial(series_of, kind), repr) for kind in SERIES},
    "TravellingSeries": (lambda _: waves(), lambda x: (x.harmonic_terms([0.1], 3), x.frequency_terms([0.1]))),
    "RingTorus": (lambda _: travelling_torus(waves()), lambda x: (x.positions(TIMES), x.momenta(TIMES), x.average_spectrum())),
    "RefinedRingTorus": (lambda _: refine(travelling_torus(waves())), lambda x: (x.positions(TIMES), x.near_resonances)),
    "LeadingTerm": (lambda _: leading_terms(PAIR, (1, 2), 3)[5], lambda x: x.expression()),
    "SampledSeries": (lambda _: sampled(), lambda x: (x.coordinates, x.derivatives_by_frequency(1)[1])),
    "EnergyChanges": (lambda _: sampled().energies_at([0.1]), lambda x: x.by_frequencies),
    "FrequencyChanges": (lambda _: sampled().frequencies_at([0.1]), lambda x: x.by_frequencies),
    "NamedParts": (lambda _: lindstedt(PAIR, (1,), order=4).term(5, 4, form="cse"), lambda x: str(x.whole())),
    "ExpandableTerm": (lambda _: expandable_term(lindstedt(PAIR, (1,), order=2), 3, 2, ("0.39",)), lambda x: x.html()),
    "SeriesForAllN": (lambda _: lindstedt(Chain("N", alpha=1), (1, "N-1"), order=2), lambda x: (repr(x), str(x.term(2, 1)))),
    "LindstedtSeries, asked": (lambda _: torus(30).series, terms),
    "Member": (lambda _: breathers().members[0], lambda x: (x.multipliers.stable, motion(x.torus))),
    "NormalModes": (lambda _: stability(), lambda x: (x.frequencies, x.multipliers(), x.mode(5).variation([0.3]))),
    "NormalMode": (lambda _: stability().modes[0], lambda x: (x.kind, x.signature)),
    "ParametricResonance": (lambda _: stability().resonances[0], lambda x: x.condition),
    "Orbit": (lambda _: trajectory(), energies),
    "PadeSum": (lambda _: pade_frequencies(series(30), torus(30).amplitudes), lambda x: x.values),
    "PeriodicOrbit": (lambda _: orbit(), motion),
    "PreciseTorus": (lambda _: refine(orbit(), digits=20), lambda x: (x.amplitudes, x.error, motion(x))),
    "PreciseOrbit": (lambda _: precise(), lambda x: (x.amplitude, motion(x))),
    "ProfileDistance": (lambda _: profile_distance([1, 1e-2], [1, 1e-3], 1e-12), lambda x: x.distance),
    "ProfileFit": (lambda _: fitted(), lambda x: x.line(0.3)),
    "ProfileInvariance": (lambda _: invariance(), lambda x: (x.levels(), x.moved())),
    "ProfileLine": (lambda _: profile_law(PAIR, 1, 1e-6), lambda x: x(np.array([0.25, 0.5]))),
    "PropagationProof": (lambda _: prove_propagation(8, (1, 4), 3, model="beta"), lambda x: x.certificate()),
    "QTorus": (lambda _: torus(), motion),
    "QTorus, digits": (lambda _: torus(30), motion),
    "Recurrence": (lambda _: times_and_returns(), lambda x: (x.first, x.best)),
    "RefinedTorus": (lambda _: refined(), motion),
    "ResummedTorus": (lambda _: resum(torus(30)), lambda x: (x.disagreement, motion(x))),
    "RootCertificate": (lambda _: torus(30).certificate, lambda x: x.radius),
    "ShotOrbit": (shot, lambda x: (motion(x), x.iterations)),
    "RuleForAllN": (lambda _: prove_for_all_N("beta", 1, 1), lambda x: x.certificate()),
    "Sweep": (lambda _: sweep(), lambda x: x.exceptions),
    "SweepRows": (lambda _: swept_rows(), lambda x: x.failures),
    "TorusDimension": (lambda _: indices().dimension(), lambda x: x.weights),
    "TodaInvariants": (lambda _: toda_invariants(PAIR, *fpu_trajectory(PAIR, {1: "0.1"})), lambda x: (x.gaps, x.actions, x.frequencies)),
    "TodaTorus": (lambda _: toda_torus(Chain(4, alpha="1/2"), (1, 3), actions=("0.1", "0.2"), digits=20), lambda x: x.state({3: 1})),
    "FrequencyAnalysis": (lambda _: lines_found(), lambda x: (x.drift, x.count(0.1))),
    "FrequencyMap": (lambda _: cases.mapped(), lambda x: (x.shifts(), x.counts)),
    "SpectralLine": (lambda _: lines_found().lines[0], repr),
    "BirkhoffForm": (lambda _: birkhoff_form(PAIR, (1, 2), 2), lambda x: x.hamiltonian()),
    "BirkhoffForm, digits": (lambda _: birkhoff_form(PAIR, (1, 2), 2, digits=20), lambda x: x.frequencies_at({1: 0.1, 2: 0.1})),
    "NormalFamily": (lambda _: cases.normal_line(), lambda x: (x.events, x.verdict)),
    "NormalEvent": (lambda _: cases.normal_line().events[0], repr),
    "NormalFrequencies": (lambda _: normal_member().normal, lambda x: (x.verdict, x.frequencies, x.resonances)),
    "Member, normal": (lambda _: normal_member(), lambda x: x.normal.verdict),
    "NormalFrequencySeries": (lambda _: normal_frequency_series(PAIR, (1,), 2, 2), lambda x: x.correction(2)),
    "ForetoldIndices": (lambda _: foretold_indices(orbit(), 1e3), lambda x: (x.settling(), x.slopes())),
    "Twist": (lambda _: twist(orbit()), lambda x: (x.matrix, x.signature)),
    "TwistAtRest": (lambda _: twist_at_rest(PAIR, (1, 2)), lambda x: (x.matrix, x.formula())),
    "Trend": (lambda _: invariance().slope_rate, lambda x: x.rate),
}


@cache
def normal_member():
    return family(Chain(4, beta=1), (2,), "0.02", from_energy="0.01", members=1, normal=True).members[0]


def sweep():
    return Sweep("beta", 1, (SweepCase(4, (1, 2), "refuted", ((3, 1, None),), True),))


def swept_rows():
    case = {"chain": {"N": 4, "alpha": "0", "beta": "0.1"}}
    failure = SweepFailure("WorkerDied", "it was killed", {"exit_code": -9})
    return SweepRows("a.function", {"order": 2}, (SweepRow(case, 0.5), SweepRow({"chain": {"N": 1}}, None, failure)))


def public_classes():
    things = {name: getattr(symfpu, name) for name in symfpu.__all__}
    classes = {name: thing for name, thing in things.items() if inspect.isclass(thing)}
    return {name for name, kind in classes.items() if not issubclass(kind, Exception)}


def test_every_public_class_has_a_case():
    assert public_classes() - {"Evaluator"} <= {name.partition(",")[0] for name in RESULTS}


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("name", RESULTS)
def test_results_come_back_and_answer_the_same(name, way, tmp_path):
    make, answers = RESULTS[name]
    result = make(tmp_path)
    assert type(result).__name__ == name.partition(",")[0]
    before = repr(result)
    returned = COPIES[way](result)
    assert returned is not result
    assert same(returned, result)
    assert repr(returned) == before
    assert same(answers(returned), answers(result))


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("backend", ["c", "numpy"])
def test_evaluators_come_back_and_answer_the_same(backend, way):
    if backend == "c":
        program("gcc")
    evaluator = compile_evaluator(torus(), backend=backend)
    returned = COPIES[way](evaluator)
    assert repr(returned) == repr(evaluator)
    assert same(returned.positions(TIMES, {2: 0.5}), evaluator.positions(TIMES, {2: 0.5}))
    assert same(returned.energy(), evaluator.energy())


def test_an_evaluator_that_arrives_where_no_compiler_is_says_so(monkeypatch):
    from symfpu.codegen import evaluator

    source = "int nothing;\n"
    sent = pickle.dumps(evaluator.CompiledFunctions(source, 7, None))
    monkeypatch.setattr(evaluator, "find_compiler", lambda: None)
    with pytest.raises(SymfpuError, match="no C compiler"):
        pickle.loads(sent)


def caught(kind, function, *arguments, **options):
    with pytest.raises(kind) as found:
        function(*arguments, **options)
    return found.value


def no_periodic_orbit():
    balance = Balance(SINGLE, 3, 2)
    return NoPeriodicOrbit(balance, "the step fails", balance.vector(orbit().cosines, 0.01))


@cache
def no_torus_at_energy():
    soft = Chain(2, beta="-0.5")
    return caught(NoTorusAtEnergy, torus_at_energy, soft, (1,), "100", harmonic=False, order=1)


@cache
def no_frequencies():
    return caught(NoSelfConsistentFrequencies, torus_at_amplitudes, Chain(8, beta=-1), {3: 10}, 1)


def sampled():
    return sample_series(lindstedt(PAIR, (1,), order=3), [[0.39], [0.4]])


ERRORS = {
    SymfpuError: lambda: SymfpuError("something failed; do something else"),
    InputError: lambda: InputError("order", -1, "0 or more", "take 0"),
    TooLarge: lambda: TooLarge(9, 10**12, 10**9, 5),
    TorusTooLarge: lambda: TorusTooLarge(16, 9000, 10**12, 10**9, 300),
    ExpansionTooLarge: lambda: ExpansionTooLarge(1e9, 1e11, 10**9),
    ResonantDivisor: lambda: ResonantDivisor(7, (2, 1), (1, 3), 2, exact=True),
    NoRealAmplitude: lambda: NoRealAmplitude(1, -0.5, 4),
    DidNotConverge: lambda: DidNotConverge(4, {1: 0.1}, 0.3),
    UndeterminedAmplitudes: lambda: UndeterminedAmplitudes((1, 2), 2),
    VanishingResidue: lambda: VanishingResidue(13, 2),
    OrbitStopped: lambda: OrbitStopped("it stopped", "go on", time=1.0, mode=3, energy=0.5, orbit=(1,)),
    EscapedOrbit: lambda: EscapedOrbit("it left", "stay", time=1.0, mode=3, energy=0.5),
    UnstableStep: lambda: UnstableStep("a long step", "shorten it", time=0.0, mode=7, energy=0.5),
    OrbitLost: lambda: OrbitLost(3.0, 0.1),
    BundleError: lambda: BundleError(Path("torus"), "is damaged", "restore it"),
    Refused: lambda: Refused("file", "orbit", "a checkpoint of the same orbit", "name another"),
    NoDiscriminant: lambda: NoDiscriminant((3.0, 0.5), 0.1),
    BandsTooNarrow: lambda: BandsTooNarrow(2),
    NoTodaTorus: lambda: NoTodaTorus((1, 2), (0.1, 3.0), 0.5),
    NoRecurrence: lambda: NoRecurrence(10.0, 0.5),
    NoTwist: lambda: NoTwist("Newton's matrix is singular"),
    NotInFamily: lambda: NotInFamily("H", 1.0, (0.1, 0.5), "ended"),
    NoFurtherMember: lambda: NoFurtherMember("no root", (1,), (0.4,), "a reason"),
    NoTorus: lambda: NoTorus("a reason", refined(), 0.1),
    NoNormalModes: lambda: NoNormalModes(3, 1.1, stability().resonances[0]),
    NoStabilityProof: lambda: NoStabilityProof(0.1 + 0j, "Y", 1e-3, 1e-5, "more digits may help"),
    NoStayProof: lambda: NoStayProof(1e9, 1e5, 1e-14, 1e-12, 3.0),
    NoExistenceProof: lambda: NoExistenceProof("Y", 1e-3, 1e-5, "more digits may help"),
    NoTorusAtEnergy: no_torus_at_energy,
    NoSelfConsistentFrequencies: no_frequencies,
    NoPeriodicOrbit: no_periodic_orbit,
    NoBreatherAtEnergy: lambda: NoBreatherAtEnergy(3, 0.5, False, orbit(), no_periodic_orbit()),
    ShootingFailed: lambda: ShootingFailed(1, "a reason", np.array([0.1, 0.0]), (0.2, 0.1)),
    SweepIncomplete: lambda: SweepIncomplete(sweep(), {(5, (1,)): SweepFailure("TooLarge", "order = 9", {"needed": 10**12})}),
    MapIncomplete: lambda: MapIncomplete(cases.mapped(), {"10": SweepFailure("EscapedOrbit", "bond 2", {"energy": 10.0})}),
    SweepStopped: lambda: SweepStopped(swept_rows(), 3, "a reason"),
    CaseTooLarge: lambda: CaseTooLarge(10**12, 10**9),
    FileFull: lambda: FileFull("rows.jsonl", 3, "No space left on device"),
    WorkerDied: lambda: WorkerDied(-9),
    WorkersDoNotStart: lambda: WorkersDoNotStart("exit code 1"),
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
    expected = caught(NoRealAmplitude, amplitude_of, FAILING)
    assert type(error) is NoRealAmplitude
    assert str(error) == str(expected)
    assert vars(error) == vars(expected)
    for found, case in zip(good, (0, 1), strict=True):
        alone = amplitude_of(case)
        assert same(found.amplitudes, alone.amplitudes)
        assert str(found.amplitudes[1]) == mpmath.nstr(alone.amplitudes[1], 30)
