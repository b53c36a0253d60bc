"""Every kind of result, once, small: what tests/test_results.py takes through pickle, files, records, tables and pictures."""

import copy
import inspect
import pickle
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import symfpu
from symfpu import Chain, fpu_trajectory, lindstedt
from tests.certified.tori import torus as two_angles
from tests.store.test_saved_file import SERIES

PAIR, SINGLE = Chain(8, alpha="0.3"), Chain(8, alpha="0.4", beta="0.1")
COPIES = {"pickle": lambda x: pickle.loads(pickle.dumps(x)), "copy": copy.copy, "deepcopy": copy.deepcopy}
TIMES = [0.0, 1.7, 100.0]


@cache
def series(digits=None):
    return lindstedt(PAIR, (1, 2), ("0.3905", "0.7663"), 4, digits=digits)


@cache
def torus(digits=None):
    """With all that it keeps of what it was asked: the copies hold that too."""
    found = symfpu.solve_amplitudes(series(digits), phases={1: 0.4})
    found.Q(TIMES)
    return found


@cache
def refined():
    return symfpu.refine(torus())


@cache
def orbit():
    frequency = symfpu.torus(SINGLE, (3,), amplitudes={3: "0.3"}).frequency
    return symfpu.torus(SINGLE, (3,), frequencies=(frequency,))


@cache
def stability():
    return symfpu.normal_modes(orbit(), modes=[5])


@cache
def hyperbolic_in_digits():
    """Complex and real numbers: sigma_1 is hyperbolic, sigma_3 elliptic."""
    breather = symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: "1"})
    return symfpu.normal_modes(symfpu.refine(breather, digits=20, amplitudes={2: "1"}))


@cache
def breathers():
    return symfpu.family(SINGLE, (3,), "0.05", from_energy="0.01", members=3, multipliers=True)


@cache
def normal_breathers():
    return symfpu.family(Chain(4, beta=1), (2,), "0.02", from_energy="0.01", members=1, normal=True)


@cache
def normal_line():
    """Two stable tori and an unstable one, and where the first turns into the last, by hand."""
    chain = Chain(N=4, alpha="0.5")
    found = tuple(symfpu.normal_modes(symfpu.torus(chain, (2,), amplitudes={2: A})) for A in ("0.5", "0.75", "1"))
    met = symfpu.ParametricResonance("parametric", (1,), (1,), 0.0)
    onset = symfpu.NormalEvent("stability", met, 1, 0.5412, {2: 0.7706}, 0.9, begins=True)
    crossed = symfpu.NormalEvent("resonance", met, 0, 0.2, {2: 0.6}, 0.5)
    return symfpu.NormalFamily(found, (0.0, 0.5, 1.0), (crossed, onset))


@cache
def trajectory():
    samples = np.arange(0.0, 200.0, 2.0)
    return symfpu.integrate(PAIR, *fpu_trajectory(PAIR, {1: "0.1"}), 200.0, step=0.25, samples=samples, averages=True)


@cache
def growth():
    found = trajectory()
    groups = symfpu.excitation_sequence(8, (1,), 2, model="alpha")
    return symfpu.growth_exponents(PAIR, found.times[1:], found.averages[1:], groups)


@cache
def indices():
    start = fpu_trajectory(PAIR, {1: "0.1"})
    return symfpu.alignment_indices(PAIR, *start, 100.0, vectors=3, samples=64, frames=1)


@cache
def invariance():
    return symfpu.profile_invariance(Chain(16, alpha="0.33"), "1/8", 1e-4, (16, 32, 48), 50.0)


@cache
def waves():
    return symfpu.lindstedt(Chain(8, alpha="0.3", ends="periodic"), (1,), ("0.766",), 6)


@cache
def sampled():
    return symfpu.sample_series(lindstedt(PAIR, (1,), order=3), [[0.39], [0.4]])


@cache
def fitted():
    chain = Chain(32, beta="0.3")
    spectrum = 10 ** symfpu.profile_law(chain, 4, 1e-6)(np.arange(1, 32) / 32)
    return symfpu.fit_profile(chain, spectrum, 4, floor=0.0)


@cache
def lines():
    orbit = symfpu.integrate(Chain(N=3, beta=1), [0.1, 0.2], [0, 0], 300, step=0.25)
    return symfpu.frequency_analysis(orbit)


@cache
def mapped():
    """Three energies of a short chain."""
    return symfpu.frequency_map(Chain(N=5, alpha="0.3"), ("0.001", "0.01", "0.1"), T=500, step=0.25)


@cache
def borders():
    """Three lengths of a chain, and one that is impossible."""
    chains = [{"N": N, "beta": 1} for N in (1, 4, 6, 8)]
    with ThreadPoolExecutor(1) as pool:
        return symfpu.atlas(chains, ["high:1"], 4, by="amplitude", borders=["poles"], executor=pool)


@cache
def returns():
    t = np.linspace(0, 15, 151)
    return symfpu.recurrence(t, np.stack([1 + np.cos(t), 1 - np.cos(t)], axis=-1))


@cache
def swept_rules():
    with ThreadPoolExecutor(1) as pool:
        return symfpu.sweep_propagation((4,), 2, 1, model="beta", executor=pool)


@cache
def swept():
    """One case is impossible."""
    cases = [{"chain": {"N": N, "beta": "0.1"}} for N in (1, 8)]
    with ThreadPoolExecutor(1) as pool:
        return symfpu.sweep(symfpu.least_packet, cases, fixed={"specific_energy": 1e-3}, executor=pool)


@cache
def evaluator():
    return symfpu.compile_evaluator(torus(), backend="numpy")


@cache
def file():
    with tempfile.TemporaryDirectory() as folder:
        return symfpu.saved_file(symfpu.save(Path(folder) / "torus", torus(30), verdict={"verdict": "good"}))


@cache
def all_lengths():
    return lindstedt(Chain("N", alpha=1), (1, "N-1"), order=2)


def motion(solution):
    state = solution.Q(TIMES), solution.P(TIMES), solution.energy()
    return *state, solution.average_spectrum(), solution.residuals()


def terms(found):
    return found.harmonic_terms([0.1, 0.2], 3), found.term(1, 2), found.coefficients(3, 2)


def energies(found):
    return found.energy_error, found.harmonic_energies(), found.scheme.stable_phase


class Case(NamedTuple):
    """make : a result. answers : what it is asked; a copy, and what comes back from a file, answers the same."""

    make: Callable[[], Any]
    answers: Callable[[Any], Any]


# by the name of the class, and of the kind if there are several
CASES = {
    "AlignmentIndices": Case(indices, lambda x: (x.slopes(), x.dimension())),
    "AmplitudeHistory": Case(lambda: symfpu.amplitude_history(series()), lambda x: x.differences()),
    "AmplitudeHistory, digits": Case(lambda: symfpu.amplitude_history(series(30)), lambda x: (x.differences(), x.amplitudes)),
    "Assessment": Case(lambda: symfpu.assess(torus().origin.series, torus()), lambda x: x.record()),
    "Atlas": Case(borders, lambda x: (x.borders, x.laws, x.points)),
    "AtlasBorder": Case(lambda: borders().borders[0], lambda x: (x.N, x.model, x.limited, x.reason)),
    "BirkhoffForm": Case(lambda: symfpu.birkhoff_form(PAIR, (1, 2), 2), lambda x: x.hamiltonian()),
    "BirkhoffForm, digits": Case(
        lambda: symfpu.birkhoff_form(PAIR, (1, 2), 2, digits=20),
        lambda x: x.frequencies_at({1: 0.1, 2: 0.1}),
    ),
    "BorderLaw": Case(lambda: borders().law("high:1", "poles"), lambda x: x.local),
    "SavedFile": Case(file, lambda x: motion(x.result)),
    "Chain": Case(lambda: Chain(8, alpha="1/3", beta="0.1"), lambda x: (x.frequencies(), x.small_parameter())),
    "Evaluator": Case(evaluator, lambda x: (x.Q(TIMES, {2: 0.5}), x.energy())),
    "Event": Case(lambda: symfpu.Event("fold", "omega_1", 3, 0.1, 0.2), lambda x: x.kind),
    "ExistenceProof": Case(lambda: symfpu.prove_existence(orbit()), lambda x: x.certificate()),
    "ExpandableTerm": Case(lambda: symfpu.expandable_term(lindstedt(PAIR, (1,), order=2), 3, 2, ("0.39",)), lambda x: x.html()),
    "Family, normal": Case(normal_breathers, lambda x: (x.members[0].normal.frequencies, x.normal_events)),
    "Family": Case(breathers, lambda x: symfpu.member_at_energy(x, "0.012", harmonic=False).amplitudes),
    "Floquet": Case(lambda: symfpu.floquet(orbit()), lambda x: (x.stable, x.multipliers)),
    "ForetoldIndices": Case(lambda: symfpu.foretold_indices(orbit(), 1e3), lambda x: (x.settling(), x.slopes())),
    "Torus": Case(lambda: torus().in_doubles(), motion),
    "FromSeries": Case(lambda: torus(30).origin, lambda x: (x.history, x.amplitudes, x.terms())),
    "FrequencyAnalysis": Case(lines, lambda x: (x.drift, x.count(0.1))),
    "FrequencyChanges": Case(lambda: sampled().frequencies_at([0.1]), lambda x: x.by_frequencies),
    "FrequencyMap": Case(mapped, lambda x: (x.shifts(), x.counts)),
    "GroupGrowth": Case(lambda: growth().groups[0], lambda x: x.mean),
    "GrowthExponents": Case(growth, lambda x: x.groups),
    "LindstedtSeries": Case(series, terms),
    "LindstedtSeries, digits": Case(lambda: torus(30).origin.series, terms),
    "LindstedtSeries, long fraction": Case(SERIES["long fraction"], lambda x: x.term(1, 1)),
    "LindstedtSeries, residue": Case(SERIES["residue"], repr),
    "LindstedtSeries, symbolic": Case(lambda: lindstedt(PAIR, (1, 2), order=3), lambda x: x.term(3, 1)),
    "LindstedtSeries, nested": Case(lambda: lindstedt(PAIR, (1, 2), order=4, ring="nested"), lambda x: x.term(3, 1)),
    "Member": Case(lambda: breathers().members[0], lambda x: (x.multipliers.stable, motion(x.torus))),
    "Member, normal": Case(lambda: normal_breathers().members[0], lambda x: x.normal.verdict),
    "NamedParts": Case(lambda: lindstedt(PAIR, (1,), order=4).term(5, 4, form="cse"), lambda x: str(x.whole())),
    "NormalEvent": Case(lambda: normal_line().events[0], repr),
    "NormalFamily": Case(normal_line, lambda x: (x.events, x.verdict)),
    "NormalFrequencies": Case(lambda: normal_breathers().members[0].normal, lambda x: (x.verdict, x.frequencies, x.resonances)),
    "NormalFrequencySeries": Case(lambda: symfpu.normal_frequency_series(PAIR, (1,), 2, 2), lambda x: x.correction(2)),
    "NormalMode": Case(lambda: stability().modes[0], lambda x: (x.kind, x.signature)),
    "NormalModes": Case(stability, lambda x: (x.frequencies, x.multipliers(), x.mode(5).variation([0.3]))),
    "NormalModes, digits": Case(hyperbolic_in_digits, lambda x: (x.frequencies, x.mode(1).sigma, x.mode(3).action)),
    "Orbit": Case(trajectory, energies),
    "PadeSum": Case(lambda: symfpu.pade_frequencies(series(30), torus(30).amplitudes), lambda x: x.values),
    "ParametricResonance": Case(lambda: stability().resonances[0], lambda x: x.condition),
    "Torus, HarmonicBalance": Case(orbit, motion),
    "Torus, IterativeRefinement, breather": Case(lambda: symfpu.refine(orbit(), digits=30), lambda x: (x.amplitude, motion(x))),
    "Torus, IterativeRefinement, waves": Case(
        lambda: symfpu.refine(symfpu.solve_amplitudes(waves()), digits=20),
        lambda x: (x.amplitudes, x.origin.error, x.Q(TIMES), x.x(TIMES), x.energy()),
    ),
    "Torus, IterativeRefinement": Case(lambda: symfpu.refine(orbit(), digits=20), lambda x: (x.amplitudes, x.origin.error, motion(x))),
    "ProfileDistance": Case(lambda: symfpu.profile_distance([1, 1e-2], [1, 1e-3], 1e-12), lambda x: x.distance),
    "ProfileFit": Case(fitted, lambda x: x.line(0.3)),
    "ProfileInvariance": Case(invariance, lambda x: (x.levels(), x.moved())),
    "ProfileLine": Case(lambda: symfpu.profile_law(PAIR, 1, 1e-6), lambda x: x(np.array([0.25, 0.5]))),
    "PropagationProof": Case(lambda: symfpu.prove_propagation(8, (1, 4), 3, model="beta"), lambda x: x.certificate()),
    "Torus, FromSeries": Case(torus, motion),
    "Torus, FromSeries, digits": Case(lambda: torus(30), motion),
    "Recurrence": Case(returns, lambda x: (x.first, x.best)),
    "Torus, Newton": Case(refined, motion),
    "Torus, Newton, waves": Case(lambda: symfpu.refine(symfpu.solve_amplitudes(waves())), lambda x: (motion(x), x.origin.near_resonances)),
    "Torus, FromSeries, waves": Case(lambda: symfpu.solve_amplitudes(waves()), motion),
    "Torus, standing waves": Case(lambda: symfpu.unfold(orbit()), motion),
    "ResidualProof": Case(lambda: symfpu.prove_residual(two_angles()), lambda x: x.certificate()),
    "Torus, Resummed": Case(lambda: symfpu.resum(torus(30)), lambda x: (x.origin.disagreement, motion(x))),
    "RootCertificate": Case(lambda: torus(30).origin.certificate, lambda x: x.radius),
    "RuleForAllN": Case(lambda: symfpu.prove_for_all_N("beta", 1, 1), lambda x: x.certificate()),
    "SampledSeries": Case(sampled, lambda x: (x.coordinates, x.derivatives_by_frequency(1)[1])),
    "SeriesForAllN": Case(all_lengths, lambda x: (repr(x), str(x.term(2, 1)))),
    "SpectralLine": Case(lambda: lines().lines[0], repr),
    "StabilityProof": Case(lambda: symfpu.prove_stability(orbit()), lambda x: x.certificate()),
    "StayProof": Case(lambda: symfpu.prove_stay(two_angles(), time=1000), lambda x: (x.certificate(), x.distance_at(10))),
    "Sweep": Case(swept_rules, lambda x: x.exceptions),
    "SweepRows": Case(swept, lambda x: x.failures),
    "TodaInvariants": Case(
        lambda: symfpu.toda_invariants(PAIR, *fpu_trajectory(PAIR, {1: "0.1"})),
        lambda x: (x.gaps, x.actions, x.frequencies),
    ),
    "TodaTorus": Case(
        lambda: symfpu.toda_torus(Chain(4, alpha="1/2"), (1, 3), actions=("0.1", "0.2"), digits=20),
        lambda x: x.state({3: 1}),
    ),
    "TorusDimension": Case(lambda: indices().dimension(), lambda x: x.weights),
    "Trend": Case(lambda: invariance().slope_rate, lambda x: x.rate),
    "Twist": Case(lambda: symfpu.twist(orbit()), lambda x: (x.matrix, x.signature)),
    "HarmonicBalance": Case(lambda: orbit().origin, lambda x: (x.iterations, x.sigma)),
    "IterativeRefinement": Case(lambda: symfpu.refine(orbit(), digits=20).origin, lambda x: (x.bound, x.error, x.sweeps)),
    "Newton": Case(lambda: refined().origin, lambda x: (x.steps, x.near_resonances)),
    "Energy": Case(lambda: symfpu.Energy("0.01", energy_ratio={1: 2, 3: 1}), repr),
    "Orders": Case(lambda: symfpu.Orders(8, frequency_order=6), repr),
    "Origin": Case(lambda: torus().in_doubles().origin, repr),
    "Resummed": Case(lambda: symfpu.resum(torus(30)).origin, lambda x: x.disagreement),
    "TwistAtRest": Case(lambda: symfpu.twist_at_rest(PAIR, (1, 2)), lambda x: (x.matrix, x.formula())),
}

ORIGINS = ("FromSeries", "HarmonicBalance", "IterativeRefinement", "Newton", "Origin", "Resummed")

# what a public class has not, and why; every other one has a file, a record and a table
WITHOUT = {
    "AtlasBorder": ("file record table", "a row of Atlas"),
    "BirkhoffForm": ("file", "exact numbers of a field, made anew"),
    "BorderLaw": ("table", "numbers of one line"),
    "SavedFile": ("file table", "it is what a file held, and has its results"),
    "Chain": ("file record table", "an argument"),
    "Evaluator": ("file record table", "a program"),
    "Energy": ("file record table", "an argument"),
    "Event": ("table", "one row of a family's data set"),
    "ExistenceProof": ("file", "its certificate is its file"),
    "ExpandableTerm": ("file record table", "an expression"),
    **dict.fromkeys(ORIGINS, ("file record table", "part of Torus")),
    "NamedParts": ("file record table", "an expression"),
    "NormalEvent": ("table", "a line of NormalFamily"),
    "NormalFrequencies": ("file record table", "part of Member"),
    "NormalFrequencySeries": ("file", "a series, made anew"),
    "NormalMode": ("file record table", "part of NormalModes"),
    "Orders": ("file record table", "an argument"),
    "ParametricResonance": ("file record table", "part of NormalModes"),
    "ProfileDistance": ("table", "one number and its mode"),
    "ProfileLine": ("table", "three numbers"),
    "ResidualProof": ("file", "its certificate is its file"),
    "SpectralLine": ("file record table", "a row of FrequencyAnalysis"),
    "StabilityProof": ("file", "its certificate is its file"),
    "StayProof": ("file", "its certificate is its file"),
    "TwistAtRest": ("file", "exact numbers of a field, made anew"),
}


def kind_of(name):
    """The class that a case is of."""
    return name.partition(",")[0]


@cache
def result(name):
    return CASES[name].make()


def public_classes():
    """Names of the classes of the public face but for errors."""
    things = {name: getattr(symfpu, name) for name in symfpu.__all__}
    classes = {name: thing for name, thing in things.items() if inspect.isclass(thing)}
    return {name for name, kind in classes.items() if not issubclass(kind, Exception)}
