"""Poincare-Lindstedt series of q-tori and q-breathers in Fermi-Pasta-Ulam chains, symbolic first."""

from symfpu.amplitudes import AmplitudeHistory, amplitude_history, solve_amplitudes
from symfpu.archive import BundleError
from symfpu.bundle import Bundle, load, save
from symfpu.certificates import PropagationProof, prove_propagation
from symfpu.chain import Chain
from symfpu.codegen.evaluator import Evaluator, compile_evaluator
from symfpu.codegen.export import export
from symfpu.commensurability import frequency_rank
from symfpu.errors import (
    DidNotConverge,
    InputError,
    NoRealAmplitude,
    ResonantDivisor,
    SymfpuError,
    TooLarge,
    UndeterminedAmplitudes,
)
from symfpu.fourier import FourierTorus
from symfpu.frequency_shift import frequency_shift, frequency_shift_formula
from symfpu.leading import leading_term, lemma_holds
from symfpu.lindstedt import lindstedt
from symfpu.notebook import init_printing
from symfpu.propagation import coupling_sequence, excitation_sequence, reachable_modes
from symfpu.resummation import PadeSum, ResummedTorus, pade_amplitudes, pade_frequencies, pade_poles, resum
from symfpu.series import LindstedtSeries
from symfpu.sweeps import Sweep, sweep_propagation
from symfpu.torus import QTorus, RootCertificate
from symfpu.verdict import Assessment, assess

__version__ = "0.1.0"

init_printing()

__all__ = [
    "AmplitudeHistory",
    "Assessment",
    "Bundle",
    "BundleError",
    "Chain",
    "DidNotConverge",
    "Evaluator",
    "FourierTorus",
    "InputError",
    "LindstedtSeries",
    "NoRealAmplitude",
    "PadeSum",
    "PropagationProof",
    "QTorus",
    "ResonantDivisor",
    "ResummedTorus",
    "RootCertificate",
    "Sweep",
    "SymfpuError",
    "TooLarge",
    "UndeterminedAmplitudes",
    "amplitude_history",
    "assess",
    "compile_evaluator",
    "coupling_sequence",
    "excitation_sequence",
    "export",
    "frequency_rank",
    "frequency_shift",
    "frequency_shift_formula",
    "init_printing",
    "leading_term",
    "lemma_holds",
    "lindstedt",
    "load",
    "pade_amplitudes",
    "pade_frequencies",
    "pade_poles",
    "prove_propagation",
    "reachable_modes",
    "resum",
    "save",
    "solve_amplitudes",
    "sweep_propagation",
]
