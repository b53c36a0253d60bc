"""The public names of symfpu, each once, by what they are about; a new one is a line here.

Type checkers read this file; symfpu/__init__.py loads each name from its module when it is first
used.
"""

# the chain, and what its couplings alone decide
from symfpu.chain.chain import Chain as Chain
from symfpu.chain.commensurability import frequency_rank as frequency_rank
from symfpu.chain.frequency_shift import frequency_shift as frequency_shift
from symfpu.chain.frequency_shift import frequency_shift_formula as frequency_shift_formula
from symfpu.chain.potentials.from_expression import from_expression as from_expression
from symfpu.chain.potentials.lennard_jones import lennard_jones as lennard_jones
from symfpu.chain.potentials.morse import morse as morse
from symfpu.chain.potentials.polynomial import polynomial as polynomial
from symfpu.chain.potentials.toda import toda as toda
from symfpu.chain.propagation import coupling_sequence as coupling_sequence
from symfpu.chain.propagation import excitation_sequence as excitation_sequence
from symfpu.chain.propagation import reachable_modes as reachable_modes

# series
from symfpu.series.closed_forms import closed_form as closed_form
from symfpu.series.closed_forms import collect_terms as collect_terms
from symfpu.series.closed_forms import same_series as same_series
from symfpu.series.closed_forms import substitute_multipliers as substitute_multipliers
from symfpu.series.frequency_expansion import frequency_expansion as frequency_expansion
from symfpu.series.expandable import ExpandableTerm as ExpandableTerm
from symfpu.series.expandable import expandable_term as expandable_term
from symfpu.series.lindstedt import lindstedt as lindstedt
from symfpu.series.named_parts import NamedParts as NamedParts
from symfpu.series.sample import FrequencyChanges as FrequencyChanges
from symfpu.series.sample import SampledSeries as SampledSeries
from symfpu.series.sample import sample_series as sample_series
from symfpu.series.series import LindstedtSeries as LindstedtSeries

# tori
from symfpu.solutions.torus import torus as torus
from symfpu.tori.energy import Energy as Energy
from symfpu.tori.orders import Orders as Orders

# tori from series
from symfpu.tori.amplitudes import AmplitudeHistory as AmplitudeHistory
from symfpu.tori.amplitudes import amplitude_history as amplitude_history
from symfpu.tori.amplitudes import solve_amplitudes as solve_amplitudes
from symfpu.tori.resummation import PadeSum as PadeSum
from symfpu.tori.resummation import Resummed as Resummed
from symfpu.tori.resummation import pade_amplitudes as pade_amplitudes
from symfpu.tori.resummation import pade_frequencies as pade_frequencies
from symfpu.tori.resummation import pade_poles as pade_poles
from symfpu.tori.resummation import resum as resum
from symfpu.tori.from_series import FromSeries as FromSeries
from symfpu.tori.from_series import RootCertificate as RootCertificate
from symfpu.tori.torus import Origin as Origin
from symfpu.tori.torus import Torus as Torus
from symfpu.tori.unfolding import unfold as unfold
from symfpu.tori.verdict import Assessment as Assessment
from symfpu.tori.verdict import assess as assess

# tori by Newton's method
from symfpu.refinement.digits import IterativeRefinement as IterativeRefinement
from symfpu.refinement.newton import Newton as Newton
from symfpu.refinement.tori import refine as refine

# theorems about tori
from symfpu.certified.residual import ResidualProof as ResidualProof
from symfpu.certified.residual import prove_residual as prove_residual
from symfpu.certified.stay import StayProof as StayProof
from symfpu.certified.stay import prove_stay as prove_stay

# breathers
from symfpu.breathers.balance import HarmonicBalance as HarmonicBalance
from symfpu.certified.existence import ExistenceProof as ExistenceProof
from symfpu.certified.existence import prove_existence as prove_existence
from symfpu.breathers.floquet import Floquet as Floquet
from symfpu.breathers.floquet import floquet as floquet
from symfpu.certified.stability_proof import StabilityProof as StabilityProof
from symfpu.certified.stability_proof import prove_stability as prove_stability

# actions, twist and Birkhoff's normal form
from symfpu.action_angle.actions import actions as actions
from symfpu.action_angle.at_rest import TwistAtRest as TwistAtRest
from symfpu.action_angle.at_rest import twist_at_rest as twist_at_rest
from symfpu.action_angle.birkhoff import BirkhoffForm as BirkhoffForm
from symfpu.action_angle.birkhoff import birkhoff_form as birkhoff_form
from symfpu.action_angle.foretold import ForetoldIndices as ForetoldIndices
from symfpu.action_angle.foretold import foretold_indices as foretold_indices
from symfpu.action_angle.twist import Twist as Twist
from symfpu.action_angle.twist import twist as twist

# stability of tori: normal frequencies
from symfpu.normal.frequencies import NormalFrequencies as NormalFrequencies
from symfpu.normal.modes import NoNormalModes as NoNormalModes
from symfpu.normal.modes import NormalMode as NormalMode
from symfpu.normal.modes import NormalModes as NormalModes
from symfpu.normal.phantom import NormalFrequencySeries as NormalFrequencySeries
from symfpu.normal.phantom import normal_frequency_series as normal_frequency_series
from symfpu.normal.resonances import ParametricResonance as ParametricResonance
from symfpu.normal.search import normal_modes as normal_modes
from symfpu.normal.self_consistent import solve_normal_frequency as solve_normal_frequency

# families in energy
from symfpu.families.members import Event as Event
from symfpu.families.members import Member as Member
from symfpu.families.family import Family as Family
from symfpu.families.following import family as family
from symfpu.families.family import member_at_energy as member_at_energy
from symfpu.families.family import member_at_frequency as member_at_frequency
from symfpu.families.normal_events import NormalEvent as NormalEvent
from symfpu.families.normal_family import NormalFamily as NormalFamily
from symfpu.families.normal_family import normal_family as normal_family

# dynamics: orbits and alignment indices, and states to start from
from symfpu.dynamics.alignment import AlignmentIndices as AlignmentIndices
from symfpu.dynamics.alignment import alignment_indices as alignment_indices
from symfpu.dynamics.alignment import seconds_needed as seconds_needed
from symfpu.dynamics.orbits import Orbit as Orbit
from symfpu.dynamics.orbits import integrate as integrate
from symfpu.dynamics.starts import packet_state as packet_state
from symfpu.dynamics.starts import particle_state as particle_state
from symfpu.dynamics.starts import random_state as random_state
from symfpu.dynamics.state_files import read_state as read_state

# where tori end
from symfpu.borders.atlas import Atlas as Atlas
from symfpu.borders.atlas import AtlasBorder as AtlasBorder
from symfpu.borders.atlas import atlas as atlas
from symfpu.borders.atlas import read_atlas as read_atlas
from symfpu.borders.laws import BorderLaw as BorderLaw

# frequency analysis of orbits
from symfpu.spectral.analysis import FrequencyAnalysis as FrequencyAnalysis
from symfpu.spectral.analysis import SpectralLine as SpectralLine
from symfpu.spectral.analysis import frequency_analysis as frequency_analysis
from symfpu.spectral.mapping import FrequencyMap as FrequencyMap
from symfpu.spectral.mapping import MapIncomplete as MapIncomplete
from symfpu.spectral.mapping import frequency_map as frequency_map
from symfpu.spectral.near import torus_near as torus_near

# the Toda chain, exactly
from symfpu.integrable.invariants import TodaInvariants as TodaInvariants
from symfpu.integrable.invariants import toda_gaps as toda_gaps
from symfpu.integrable.invariants import toda_invariants as toda_invariants
from symfpu.integrable.torus import TodaTorus as TodaTorus
from symfpu.integrable.torus import toda_torus as toda_torus

# localization: laws, floors, profiles, growth, recurrence, trials
from symfpu.localization.floors import coefficient_errors as coefficient_errors
from symfpu.localization.floors import spectrum_floor as spectrum_floor
from symfpu.localization.growth import GroupGrowth as GroupGrowth
from symfpu.localization.growth import GrowthExponents as GrowthExponents
from symfpu.localization.growth import growth_exponents as growth_exponents
from symfpu.localization.laws import ProfileFit as ProfileFit
from symfpu.localization.laws import ProfileLine as ProfileLine
from symfpu.localization.laws import breather_law as breather_law
from symfpu.localization.laws import fit_profile as fit_profile
from symfpu.localization.laws import group_energy as group_energy
from symfpu.localization.laws import least_packet as least_packet
from symfpu.localization.laws import middle_modes as middle_modes
from symfpu.localization.laws import natural_packet as natural_packet
from symfpu.localization.laws import packet_groups as packet_groups
from symfpu.localization.laws import packet_parameter as packet_parameter
from symfpu.localization.laws import profile_law as profile_law
from symfpu.localization.laws import rounding_floor as rounding_floor
from symfpu.localization.packet_sums import packet_energies as packet_energies
from symfpu.localization.profiles import ProfileDistance as ProfileDistance
from symfpu.localization.profiles import fpu_trajectory as fpu_trajectory
from symfpu.localization.profiles import normalised_averages as normalised_averages
from symfpu.localization.profiles import packet_amplitudes as packet_amplitudes
from symfpu.localization.profiles import profile_distance as profile_distance
from symfpu.localization.recurrence import Recurrence as Recurrence
from symfpu.localization.recurrence import recurrence as recurrence
from symfpu.localization.trials import ProfileInvariance as ProfileInvariance
from symfpu.localization.trials import Trend as Trend
from symfpu.localization.trials import profile_invariance as profile_invariance
from symfpu.localization.trials import slope_by_energy as slope_by_energy

# proofs
from symfpu.proofs.asymptotic_groups import (
    asymptotic_group_energy as asymptotic_group_energy,
)
from symfpu.proofs.asymptotic_groups import asymptotic_profile as asymptotic_profile
from symfpu.proofs.asymptotics import asymptotic_divisor as asymptotic_divisor
from symfpu.proofs.asymptotics import asymptotic_energy as asymptotic_energy
from symfpu.proofs.asymptotics import asymptotic_term as asymptotic_term
from symfpu.proofs.certificates import PropagationProof as PropagationProof
from symfpu.proofs.certificates import prove_propagation as prove_propagation
from symfpu.proofs.leading import leading_term as leading_term
from symfpu.proofs.leading import lemma_holds as lemma_holds
from symfpu.proofs.sweeps import Sweep as Sweep
from symfpu.proofs.sweeps import SweepIncomplete as SweepIncomplete
from symfpu.proofs.sweeps import sweep_propagation as sweep_propagation
from symfpu.proofs.theorem import RuleForAllN as RuleForAllN
from symfpu.proofs.theorem import prove_for_all_N as prove_for_all_N

# sweeps of any function
from symfpu.series.memory import series_bytes as series_bytes
from symfpu.sweeps.rows import SweepRows as SweepRows
from symfpu.sweeps.sweep import read_sweep as read_sweep
from symfpu.sweeps.sweep import sweep as sweep

# files, and how to cite
from symfpu.store.saved_file import SavedFile as SavedFile
from symfpu.results.citation import cite as cite
from symfpu.store.saved_file import load as load
from symfpu.store.saved_file import save as save
from symfpu.store.saved_file import saved_file as saved_file

# code generation
from symfpu.codegen.evaluator import Evaluator as Evaluator
from symfpu.codegen.evaluator import compile_evaluator as compile_evaluator
from symfpu.codegen.export import export as export

# pictures: a room of functions, symfpu.plots.spectrum(torus)
from symfpu import plots as plots

# notebooks
from symfpu.notebook import init_printing as init_printing

# errors
from symfpu.action_angle.newton_twist import NoTwist as NoTwist
from symfpu.breathers.balance import NoBreatherAtEnergy as NoBreatherAtEnergy
from symfpu.breathers.equations import NoPeriodicOrbit as NoPeriodicOrbit
from symfpu.certified.enclosures import NoStabilityProof as NoStabilityProof
from symfpu.certified.existence import NoExistenceProof as NoExistenceProof
from symfpu.certified.stay import NoStayProof as NoStayProof
from symfpu.dynamics.frame_run import OrbitLost as OrbitLost
from symfpu.dynamics.stopping import EscapedOrbit as EscapedOrbit
from symfpu.dynamics.stopping import OrbitStopped as OrbitStopped
from symfpu.dynamics.stopping import UnstableStep as UnstableStep
from symfpu.errors import DidNotConverge as DidNotConverge
from symfpu.errors import ExpansionTooLarge as ExpansionTooLarge
from symfpu.errors import InputError as InputError
from symfpu.errors import NoRealAmplitude as NoRealAmplitude
from symfpu.errors import ResonantDivisor as ResonantDivisor
from symfpu.errors import SymfpuError as SymfpuError
from symfpu.errors import TooLarge as TooLarge
from symfpu.errors import TorusTooLarge as TorusTooLarge
from symfpu.errors import UndeterminedAmplitudes as UndeterminedAmplitudes
from symfpu.families.family import NotInFamily as NotInFamily
from symfpu.files.archive import BundleError as BundleError
from symfpu.localization.recurrence import NoRecurrence as NoRecurrence
from symfpu.refinement.tori import NoTorus as NoTorus
from symfpu.integrable.discriminant import NoDiscriminant as NoDiscriminant
from symfpu.integrable.quadrature import BandsTooNarrow as BandsTooNarrow
from symfpu.integrable.search import NoTodaTorus as NoTodaTorus
from symfpu.files.kept_lines import FileFull as FileFull
from symfpu.sweeps.sweep import CaseTooLarge as CaseTooLarge
from symfpu.sweeps.sweep import SweepStopped as SweepStopped
from symfpu.sweeps.workers import WorkerDied as WorkerDied
from symfpu.sweeps.workers import WorkersDoNotStart as WorkersDoNotStart
from symfpu.tori.at_energy import NoTorusAtEnergy as NoTorusAtEnergy
from symfpu.tori.frequencies import (
    NoSelfConsistentFrequencies as NoSelfConsistentFrequencies,
)

__version__: str
__all__: list[str]

def _load_pictures() -> None: ...
