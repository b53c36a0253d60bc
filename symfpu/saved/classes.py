"""The classes that a file may name: nothing else is made of what is in it.

A class is named with its module, which is imported when a file names the class: the verbs that open
files need not wait for all rooms.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import Any

# results that a user keeps; series and solutions have formats of their own (symfpu.bundles)
RESULTS = {
    "AlignmentIndices": "symfpu.dynamics.alignment",
    "AmplitudeHistory": "symfpu.tori.amplitudes",
    "Assessment": "symfpu.tori.verdict",
    "Atlas": "symfpu.borders.atlas",
    "BorderLaw": "symfpu.borders.laws",
    "Event": "symfpu.families.members",
    "Family": "symfpu.families.family",
    "Floquet": "symfpu.breathers.floquet",
    "ForetoldIndices": "symfpu.action_angle.foretold",
    "FrequencyAnalysis": "symfpu.spectral.analysis",
    "FrequencyChanges": "symfpu.series.sample",
    "FrequencyMap": "symfpu.spectral.mapping",
    "GroupGrowth": "symfpu.localization.growth",
    "GrowthExponents": "symfpu.localization.growth",
    "Member": "symfpu.families.members",
    "NormalEvent": "symfpu.families.normal_events",
    "NormalFamily": "symfpu.families.normal_family",
    "NormalModes": "symfpu.normal.modes",
    "Orbit": "symfpu.dynamics.orbits",
    "PadeSum": "symfpu.tori.resummation",
    "ProfileDistance": "symfpu.localization.profiles",
    "ProfileFit": "symfpu.localization.laws",
    "ProfileInvariance": "symfpu.localization.trials",
    "ProfileLine": "symfpu.localization.laws",
    "PropagationProof": "symfpu.proofs.certificates",
    "Recurrence": "symfpu.localization.recurrence",
    "RootCertificate": "symfpu.tori.from_series",
    "RuleForAllN": "symfpu.proofs.theorem",
    "SampledSeries": "symfpu.series.sample",
    "Sweep": "symfpu.proofs.sweeps",
    "SweepRows": "symfpu.sweeps.rows",
    "TodaInvariants": "symfpu.integrable.invariants",
    "TodaTorus": "symfpu.integrable.torus",
    "Trend": "symfpu.localization.trials",
    "Twist": "symfpu.action_angle.twist",
}
# what they hold
PARTS = {
    "DecidedFlat": "symfpu.proofs.every_length",
    "Edges": "symfpu.integrable.discriminant",
    "Flat": "symfpu.proofs.flats",
    "LargestTerm": "symfpu.tori.verdict",
    "NormalDivisor": "symfpu.normal.modes",
    "NormalFrequencies": "symfpu.normal.frequencies",
    "NormalMode": "symfpu.normal.modes",
    "ParametricResonance": "symfpu.normal.resonances",
    "ResiduePoint": "symfpu.series.coefficients",
    "RuleException": "symfpu.proofs.certificates",
    "SpectralLine": "symfpu.spectral.analysis",
    "SweepCase": "symfpu.proofs.sweeps",
    "SweepFailure": "symfpu.sweeps.rows",
    "SweepRow": "symfpu.sweeps.rows",
    "Undecided": "symfpu.proofs.certificates",
    "Vanishing": "symfpu.proofs.certificates",
    "Witness": "symfpu.proofs.certificates",
}


class ByName(Mapping[str, type[Any]]):
    """Classes by name. modules : the module of each."""

    def __init__(self, modules: Mapping[str, str]) -> None:
        self._modules = modules

    def __getitem__(self, name: str) -> type[Any]:
        found: type[Any] = getattr(import_module(self._modules[name]), name)
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(self._modules)

    def __len__(self) -> int:
        return len(self._modules)


CLASSES = ByName(RESULTS | PARTS)


def is_result(value: Any) -> bool:
    """Whether a file may hold this by itself."""
    kind = type(value)
    return RESULTS.get(kind.__name__) == kind.__module__
