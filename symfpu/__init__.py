"""Poincare-Lindstedt series of q-tori and q-breathers in Fermi-Pasta-Ulam chains, symbolic first."""

from symfpu.amplitudes import AmplitudeHistory, amplitude_history, solve_amplitudes
from symfpu.chain import Chain
from symfpu.errors import (
    DidNotConverge,
    InputError,
    NoRealAmplitude,
    ResonantDivisor,
    SymfpuError,
    TooLarge,
    UndeterminedAmplitudes,
)
from symfpu.lindstedt import lindstedt
from symfpu.notebook import init_printing
from symfpu.propagation import excitation_sequence, reachable_modes
from symfpu.series import LindstedtSeries
from symfpu.torus import QTorus

__version__ = "0.1.0"

init_printing()

__all__ = [
    "AmplitudeHistory",
    "Chain",
    "DidNotConverge",
    "InputError",
    "LindstedtSeries",
    "NoRealAmplitude",
    "QTorus",
    "ResonantDivisor",
    "SymfpuError",
    "TooLarge",
    "UndeterminedAmplitudes",
    "amplitude_history",
    "excitation_sequence",
    "init_printing",
    "lindstedt",
    "reachable_modes",
    "solve_amplitudes",
]
