"""The classes that a file may name: nothing else is made of what is in it."""

from __future__ import annotations

from typing import Any

from symfpu.action_angle.foretold import ForetoldIndices
from symfpu.action_angle.twist import Twist
from symfpu.borders.atlas import Atlas
from symfpu.borders.laws import BorderLaw
from symfpu.breathers.floquet import Floquet
from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.dynamics.orbits import Orbit
from symfpu.families.continuation import Event, Member
from symfpu.families.family import Family
from symfpu.families.normal_events import NormalEvent
from symfpu.families.normal_family import NormalFamily
from symfpu.integrable.discriminant import Edges
from symfpu.integrable.invariants import TodaInvariants
from symfpu.integrable.torus import TodaTorus
from symfpu.localization.growth import GroupGrowth, GrowthExponents
from symfpu.localization.laws import ProfileFit, ProfileLine
from symfpu.localization.profiles import ProfileDistance
from symfpu.localization.recurrence import Recurrence
from symfpu.localization.trials import ProfileInvariance, Trend
from symfpu.normal.frequencies import NormalFrequencies
from symfpu.normal.modes import NormalDivisor, NormalMode, NormalModes
from symfpu.normal.resonances import ParametricResonance
from symfpu.proofs.certificates import (
    PropagationProof,
    RuleException,
    Undecided,
    Vanishing,
    Witness,
)
from symfpu.proofs.every_length import DecidedFlat
from symfpu.proofs.flats import Flat
from symfpu.proofs.sweeps import Sweep, SweepCase
from symfpu.proofs.theorem import RuleForAllN
from symfpu.series.sample import EnergyChanges, FrequencyChanges, SampledSeries
from symfpu.series.series import ResiduePoint
from symfpu.spectral.analysis import FrequencyAnalysis, SpectralLine
from symfpu.spectral.mapping import FrequencyMap
from symfpu.sweeps.rows import SweepFailure, SweepRow, SweepRows
from symfpu.tori.amplitudes import AmplitudeHistory
from symfpu.tori.resummation import PadeSum
from symfpu.tori.torus import RootCertificate
from symfpu.tori.verdict import Assessment, LargestTerm

# results that a user keeps; series and solutions have formats of their own (symfpu.bundles)
RESULTS: tuple[type[Any], ...] = (
    AlignmentIndices,
    AmplitudeHistory,
    Assessment,
    Atlas,
    BorderLaw,
    EnergyChanges,
    Event,
    Family,
    Floquet,
    ForetoldIndices,
    FrequencyAnalysis,
    FrequencyChanges,
    FrequencyMap,
    GroupGrowth,
    GrowthExponents,
    Member,
    NormalEvent,
    NormalFamily,
    NormalModes,
    Orbit,
    PadeSum,
    ProfileDistance,
    ProfileFit,
    ProfileInvariance,
    ProfileLine,
    PropagationProof,
    Recurrence,
    RootCertificate,
    RuleForAllN,
    SampledSeries,
    Sweep,
    SweepRows,
    TodaInvariants,
    TodaTorus,
    Trend,
    Twist,
)
# what they hold
PARTS: tuple[type[Any], ...] = (
    DecidedFlat,
    Edges,
    Flat,
    LargestTerm,
    NormalDivisor,
    NormalFrequencies,
    NormalMode,
    ParametricResonance,
    ResiduePoint,
    RuleException,
    SpectralLine,
    SweepCase,
    SweepFailure,
    SweepRow,
    Undecided,
    Vanishing,
    Witness,
)
CLASSES = {kind.__name__: kind for kind in (*RESULTS, *PARTS)}
