"""Poincare-Lindstedt series of q-tori and q-breathers in Fermi-Pasta-Ulam chains, symbolic first.

Public names are loaded when they are first used, so that importing the package takes no time.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from symfpu.chain.frequency_shift import frequency_shift, frequency_shift_formula  # at once: a module has the name of its function
from symfpu.notebook import init_printing
from symfpu.series.lindstedt import lindstedt

if TYPE_CHECKING:
    from symfpu.breathers.at_energy import NoBreatherAtEnergy, breather_at_energy
    from symfpu.breathers.balance import NoPeriodicOrbit, PeriodicOrbit, breather_at_amplitude, periodic_orbit
    from symfpu.breathers.digits import PreciseOrbit, periodic_orbit_digits
    from symfpu.breathers.floquet import Floquet, floquet
    from symfpu.breathers.shooting import ShootingFailed, ShotOrbit, shoot
    from symfpu.bundles.bundle import Bundle, load, save
    from symfpu.chain.chain import Chain
    from symfpu.chain.commensurability import frequency_rank
    from symfpu.chain.propagation import coupling_sequence, excitation_sequence, reachable_modes
    from symfpu.codegen.evaluator import Evaluator, compile_evaluator
    from symfpu.codegen.export import export
    from symfpu.dynamics.alignment import AlignmentIndices, alignment_indices, seconds_needed
    from symfpu.dynamics.frame_run import OrbitLost
    from symfpu.dynamics.orbits import Orbit, integrate
    from symfpu.dynamics.stopping import EscapedOrbit, OrbitStopped, UnstableStep
    from symfpu.errors import (
        DidNotConverge,
        InputError,
        NoRealAmplitude,
        ResonantDivisor,
        SymfpuError,
        TooLarge,
        UndeterminedAmplitudes,
    )
    from symfpu.families.continuation import Event, Member
    from symfpu.families.family import Family, NotInFamily, family
    from symfpu.files.archive import BundleError
    from symfpu.localization.growth import GroupGrowth, GrowthExponents, growth_exponents
    from symfpu.localization.laws import (
        ProfileFit,
        ProfileLine,
        breather_law,
        fit_profile,
        group_energy,
        least_packet,
        middle_modes,
        natural_packet,
        packet_groups,
        packet_parameter,
        profile_law,
        rounding_floor,
    )
    from symfpu.localization.profiles import ProfileDistance, fpu_trajectory, normalised_averages, packet_amplitudes, profile_distance
    from symfpu.localization.recurrence import NoRecurrence, Recurrence, recurrence
    from symfpu.localization.trials import ProfileInvariance, Trend, profile_invariance, slope_by_energy
    from symfpu.proofs.certificates import PropagationProof, prove_propagation
    from symfpu.proofs.leading import leading_term, lemma_holds
    from symfpu.proofs.sweeps import Sweep, sweep_propagation
    from symfpu.refinement.tori import NoTorus, RefinedTorus, refine, refine_at_amplitudes, refine_at_energy
    from symfpu.series.series import LindstedtSeries
    from symfpu.tori.amplitudes import AmplitudeHistory, amplitude_history, solve_amplitudes
    from symfpu.tori.at_energy import NoTorusAtEnergy, torus_at_energy
    from symfpu.tori.frequencies import NoSelfConsistentFrequencies, torus_at_amplitudes
    from symfpu.tori.quasiperiodic import FourierTorus
    from symfpu.tori.resummation import PadeSum, ResummedTorus, pade_amplitudes, pade_frequencies, pade_poles, resum
    from symfpu.tori.torus import QTorus, RootCertificate
    from symfpu.tori.verdict import Assessment, assess

__version__ = "0.1.0"

init_printing()

_DEFINED = {
    "symfpu.tori.amplitudes": (
        "AmplitudeHistory",
        "amplitude_history",
        "solve_amplitudes",
    ),
    "symfpu.files.archive": ("BundleError",),
    "symfpu.bundles.bundle": (
        "Bundle",
        "load",
        "save",
    ),
    "symfpu.proofs.certificates": (
        "PropagationProof",
        "prove_propagation",
    ),
    "symfpu.chain.chain": ("Chain",),
    "symfpu.codegen.evaluator": (
        "Evaluator",
        "compile_evaluator",
    ),
    "symfpu.codegen.export": ("export",),
    "symfpu.chain.commensurability": ("frequency_rank",),
    "symfpu.dynamics.alignment": ("AlignmentIndices", "alignment_indices", "seconds_needed"),
    "symfpu.dynamics.frame_run": ("OrbitLost",),
    "symfpu.dynamics.orbits": ("Orbit", "integrate"),
    "symfpu.dynamics.stopping": ("EscapedOrbit", "OrbitStopped", "UnstableStep"),
    "symfpu.errors": (
        "DidNotConverge",
        "InputError",
        "NoRealAmplitude",
        "ResonantDivisor",
        "SymfpuError",
        "TooLarge",
        "UndeterminedAmplitudes",
    ),
    "symfpu.families.family": (
        "Family",
        "NotInFamily",
        "family",
    ),
    "symfpu.tori.at_energy": (
        "NoTorusAtEnergy",
        "torus_at_energy",
    ),
    "symfpu.tori.quasiperiodic": ("FourierTorus",),
    "symfpu.chain.frequency_shift": (
        "frequency_shift",
        "frequency_shift_formula",
    ),
    "symfpu.proofs.leading": (
        "leading_term",
        "lemma_holds",
    ),
    "symfpu.localization.laws": (
        "ProfileFit",
        "ProfileLine",
        "breather_law",
        "fit_profile",
        "group_energy",
        "least_packet",
        "middle_modes",
        "natural_packet",
        "packet_groups",
        "packet_parameter",
        "profile_law",
        "rounding_floor",
    ),
    "symfpu.localization.trials": (
        "ProfileInvariance",
        "Trend",
        "profile_invariance",
        "slope_by_energy",
    ),
    "symfpu.chain.propagation": (
        "coupling_sequence",
        "excitation_sequence",
        "reachable_modes",
    ),
    "symfpu.breathers.digits": (
        "PreciseOrbit",
        "periodic_orbit_digits",
    ),
    "symfpu.breathers.at_energy": (
        "NoBreatherAtEnergy",
        "breather_at_energy",
    ),
    "symfpu.breathers.balance": (
        "NoPeriodicOrbit",
        "PeriodicOrbit",
        "breather_at_amplitude",
        "periodic_orbit",
    ),
    "symfpu.families.continuation": (
        "Event",
        "Member",
    ),
    "symfpu.breathers.floquet": (
        "Floquet",
        "floquet",
    ),
    "symfpu.breathers.shooting": (
        "ShootingFailed",
        "ShotOrbit",
        "shoot",
    ),
    "symfpu.refinement.tori": (
        "NoTorus",
        "RefinedTorus",
        "refine",
        "refine_at_amplitudes",
        "refine_at_energy",
    ),
    "symfpu.tori.resummation": (
        "PadeSum",
        "ResummedTorus",
        "pade_amplitudes",
        "pade_frequencies",
        "pade_poles",
        "resum",
    ),
    "symfpu.tori.frequencies": (
        "NoSelfConsistentFrequencies",
        "torus_at_amplitudes",
    ),
    "symfpu.series.series": ("LindstedtSeries",),
    "symfpu.localization.growth": ("GroupGrowth", "GrowthExponents", "growth_exponents"),
    "symfpu.localization.profiles": ("ProfileDistance", "fpu_trajectory", "normalised_averages", "packet_amplitudes", "profile_distance"),
    "symfpu.localization.recurrence": ("NoRecurrence", "Recurrence", "recurrence"),
    "symfpu.proofs.sweeps": (
        "Sweep",
        "sweep_propagation",
    ),
    "symfpu.tori.torus": (
        "QTorus",
        "RootCertificate",
    ),
    "symfpu.tori.verdict": (
        "Assessment",
        "assess",
    ),
}
_HOME = {name: module for module, names in _DEFINED.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOME[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


__all__ = [
    "AlignmentIndices",
    "AmplitudeHistory",
    "Assessment",
    "Bundle",
    "BundleError",
    "Chain",
    "DidNotConverge",
    "EscapedOrbit",
    "Evaluator",
    "Event",
    "Family",
    "Floquet",
    "FourierTorus",
    "GroupGrowth",
    "GrowthExponents",
    "InputError",
    "LindstedtSeries",
    "Member",
    "NoBreatherAtEnergy",
    "NoPeriodicOrbit",
    "NoRealAmplitude",
    "NoRecurrence",
    "NoSelfConsistentFrequencies",
    "NoTorus",
    "NoTorusAtEnergy",
    "NotInFamily",
    "Orbit",
    "OrbitLost",
    "OrbitStopped",
    "PadeSum",
    "PeriodicOrbit",
    "PreciseOrbit",
    "ProfileDistance",
    "ProfileFit",
    "ProfileInvariance",
    "ProfileLine",
    "PropagationProof",
    "QTorus",
    "Recurrence",
    "RefinedTorus",
    "ResonantDivisor",
    "ResummedTorus",
    "RootCertificate",
    "ShootingFailed",
    "ShotOrbit",
    "Sweep",
    "SymfpuError",
    "TooLarge",
    "Trend",
    "UndeterminedAmplitudes",
    "UnstableStep",
    "alignment_indices",
    "amplitude_history",
    "assess",
    "breather_at_amplitude",
    "breather_at_energy",
    "breather_law",
    "compile_evaluator",
    "coupling_sequence",
    "excitation_sequence",
    "export",
    "family",
    "fit_profile",
    "floquet",
    "fpu_trajectory",
    "frequency_rank",
    "frequency_shift",
    "frequency_shift_formula",
    "group_energy",
    "growth_exponents",
    "init_printing",
    "integrate",
    "leading_term",
    "least_packet",
    "lemma_holds",
    "lindstedt",
    "load",
    "middle_modes",
    "natural_packet",
    "normalised_averages",
    "packet_amplitudes",
    "packet_groups",
    "packet_parameter",
    "pade_amplitudes",
    "pade_frequencies",
    "pade_poles",
    "periodic_orbit",
    "periodic_orbit_digits",
    "profile_distance",
    "profile_invariance",
    "profile_law",
    "prove_propagation",
    "reachable_modes",
    "recurrence",
    "refine",
    "refine_at_amplitudes",
    "refine_at_energy",
    "resum",
    "rounding_floor",
    "save",
    "seconds_needed",
    "shoot",
    "slope_by_energy",
    "solve_amplitudes",
    "sweep_propagation",
    "torus_at_amplitudes",
    "torus_at_energy",
]
