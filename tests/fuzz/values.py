"""What the fuzzer passes: sound values by the name of a parameter, and odd ones for any."""

import math
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal
from fractions import Fraction
from functools import cache, partial

import mpmath
import numpy as np
import symengine
import sympy

import symfpu
from symfpu import Chain

CHAINS = (
    partial(Chain, 8, alpha="0.3"),
    partial(Chain, 5, beta=1),
    partial(Chain, 8, alpha="0.3", beta="0.2"),
    partial(Chain, 6, potential="toda:1/2"),
    partial(Chain, 2, alpha="0.3"),
    partial(Chain, 8, beta=1, ends="periodic"),
    partial(Chain, 9, alpha="0.3", ends="periodic"),
    partial(Chain, "N", alpha=1),
)


def alpha():
    return Chain(8, alpha="0.3")


@cache
def series():
    return symfpu.lindstedt(alpha(), (1, 2), ("0.3903", "0.7655"), 4)


@cache
def precise_series():
    return symfpu.lindstedt(alpha(), (1,), ("0.3903",), 4, digits=30)


@cache
def symbols():
    return symfpu.lindstedt(alpha(), (1, 2), order=2)


@cache
def every_length():
    return symfpu.lindstedt(Chain("N", alpha=1), (1, 2), order=2)


@cache
def torus():
    return symfpu.solve_amplitudes(series())


@cache
def refined():
    return symfpu.refine(torus())


@cache
def breather():
    return symfpu.torus(alpha(), (1,), amplitudes={1: "0.1"})


@cache
def precise():
    return symfpu.refine(breather(), digits=30)


@cache
def waves():
    chain = Chain(8, beta=1, ends="periodic")
    return symfpu.lindstedt(chain, (1,), (float(chain.frequencies()[0]) * 1.0005,), 3)


@cache
def wave():
    return symfpu.torus(Chain(8, beta=1, ends="periodic"), (1,), amplitudes={1: "0.1"})


@cache
def orbit():
    chain = alpha()
    state = symfpu.packet_state(chain, (1, 2), "0.001")
    return symfpu.integrate(chain, *state, 300.0, step=0.2, averages=True)


@cache
def analysis():
    return symfpu.frequency_analysis(orbit())


@cache
def family():
    return symfpu.family(alpha(), (1,), "0.0002", members=4)


@cache
def rule():
    return symfpu.prove_propagation(8, (1, 4), 2, model="beta")


@cache
def existence():
    return symfpu.prove_existence(breather())


@cache
def indices():
    return symfpu.alignment_indices(alpha(), orbit().Q[0], orbit().P[0], 100.0, samples=64)


@cache
def one_thread():
    """An executor that starts no processes."""
    return ThreadPoolExecutor(1)


TORI = (torus, refined, breather, wave, precise)
RESULTS = (*TORI, series, precise_series, symbols, every_length, waves, orbit, analysis, family, rule, existence, indices)
FILES = ("new.json", "new.symfpu", "torus.symfpu", "certificate.json", "text.txt", "empty")
EXPRESSIONS = ("cosh(r)-1", "r**2/2 + r**3", "A1**2 + 3", "x + y", "exp(r)", "Omega_1*A1")

by_name = {
    "chain": CHAINS,
    "chains": ([alpha()], [{"N": 4, "alpha": 1}]),
    "N": (2, 5, 8, 32, "N"),
    "seeds": ((1,), (1, 2), (3,), [2, 5], (-1,), ("N-1",)),
    "seed": (1, 2, 3, 7),
    "q": (1, 3, 7, "N-1"),
    "mode": (1, 3, "N-1"),
    "modes": (None, "tail", [1, 2], (3, 4, 5)),
    "order": (0, 1, 2, 3, 4),
    "coordinate_order": (None, 2),
    "frequency_order": (None, 2),
    "terms": (1, 2),
    "degree": (2, 4),
    "digits": (None, 15, 20, 30),
    "energy": ("0.001", "0.01", 0.0005),
    "to_energy": ("0.0003", "0.0006"),
    "from_energy": (None, "0.0001"),
    "energies": (("0.001",), [0.0005]),
    "specific_energy": (0.001, 1e-4),
    "specific_energies": ((1e-4, 1e-3),),
    "amplitude": (None, "0.1", 0.05),
    "amplitudes": ({1: "0.1"}, {1: 0.1, 2: 0.05}),
    "amplitude_ratio": (None, {1: 1, 2: "0.5"}),
    "energy_ratio": (None, {1: 1, 2: 1}),
    "coordinates": ({1: 0.1, 2: 0.05},),
    "frequency": ("0.3903", None),
    "frequencies": (None, ("0.3903",), ("0.3903", "0.7655")),
    "phases": (None, {1: 0}, {1: "0.3", 2: 1}),
    "method": ("newton", "series", "arclength", "appendix-a"),
    "value": ("0.01", 1),
    "level": (1e-6, 1e-3),
    "guess": (None, torus, breather, {1: 0.1, 2: 0.1}),
    "near": (None, torus),
    "T": (10.0, 100.0),
    "time": (100.0, 10**9),
    "t": (0.0, 1.0, [0.0, 0.5]),
    "times": ([0.0, 1.0, 2.0], np.linspace(0, 100, 50)),
    "step": (0.1, 0.4),
    "scheme": ("kahan_li8", "blanes_moan6", "aba864_modes", "leapfrog"),
    "samples": (20, 64),
    "vectors": (None, 2, 4),
    "frames": (1, 2),
    "windows": (4, 8),
    "lines": (2, 4),
    "file": (None, "new.jsonl", "run.npz"),
    "folder": (None, "family"),
    "path": FILES,
    "executor": (one_thread,),
    "workers": (1,),
    "progress": (None,),
    "series": (series, precise_series, symbols, every_length, waves),
    "solution": TORI,
    "torus": TORI,
    "orbit": (orbit, breather, wave),
    "analysis": (analysis,),
    "found": (family,),
    "result": RESULTS,
    "a": (None, "1/2", 0.5, series),
    "b": (series, [0.1] * 7),
    "m": (12, 8),
    "n": (6, 4),
    "s": (1, 2),
    "k": (0, 1, [0, 1]),
    "model": (None, "alpha", "beta"),
    "potential": (None, "toda:1/2", "morse:1", "poly:1,1"),
    "ends": ("fixed", "periodic"),
    "end": ("low", "high"),
    "lengths": ((4, 5),),
    "largest_set": (1, 2),
    "seeds_number": (1,),
    "members": (3, 5),
    "resonance_length": (2, 4),
    "tolerance": (1e-13, 1e-10),
    "most_harmonics": (200, 4000),
    "Q": ([0.1] + [0.0] * 6, np.zeros(4), np.full(7, 0.01)),
    "P": ([0.0] * 7, np.zeros(4)),
    "displacements": ([0.1] + [0.0] * 6,),
    "momenta": ([0.0] * 7,),
    "spectrum": (np.exp(-np.arange(7.0)), np.ones(4)),
    "spectra": (np.exp(-np.ones((2, 1)) * np.arange(7.0)),),
    "averages": (None, np.ones((50, 7))),
    "groups": (((1,), (2, 3)),),
    "floor": (1e-22,),
    "power": (None, 0.0),
    "expression": EXPRESSIONS,
    "V": EXPRESSIONS,
    "r": ("r", sympy.Symbol("r")),
    "symbols": (("A1", "A2"), [symengine.Symbol("x")]),
    "language": ("c", "fortran", "numpy", "mpmath", "octave"),
    "borders": (("ratio",), ("ratio", "sums")),
    "packets": (["low:1"], [(1, 2)]),
    "function": (pow,),
    "cases": ([{"base": 2, "exp": 3}],),
    "sizes": ((8, 16),),
    "fraction": ("1/4",),
    "actions": (None, ("0.001",)),
    "share": ("energy", "amplitude"),
    "shares": (None, {1: 1, 2: 1}),
    "form": ("text", "bibtex", "cff"),
    "name": ("Q", "x"),
    "harmonic": (True, False),
    "half_width": (0, "1e-6"),
    "coefficients": (1, "1/3"),
    "start": (0.0,),
    "relative": (None, 0.1),
    "language_path": FILES,
}

INTEGERS = (0, -1, 1, 3, -7, 10**6, 10**9, 2**31, 2**63, 2**64, 10**25, 10**400, -(10**400), True)
DOUBLES = (0.5, 1.0, 2.0, 1e-300, 5e-324, 1e-30, 1e300, -1e300, math.nan, math.inf, -math.inf, complex(1, 1))
EXACT = (Fraction(1, 3), Fraction(10**400, 7), Decimal("0.1"), Decimal("1e1000"))
OF_LIBRARIES = (np.float64(0.3), np.int64(3), np.float32(0.1), np.longdouble(1) / 3, mpmath.mpf("0.1"), mpmath.mpf("1e-400"), mpmath.inf)
SYMBOLIC = (sympy.Integer(2), sympy.Rational(1, 3), sympy.pi, symengine.Integer(2))
ODD_NUMBERS = (*INTEGERS, *DOUBLES, *EXACT, *OF_LIBRARIES, *SYMBOLIC)

NUMBERS_AS_TEXT = ["0.1", "1e400", "1e-400", "1e-5000", "-3", "1/0", "1/3", "nan", "inf", "0x10", "1_000", "2**9"]
WORDS = ["x", "low", "N", "N-1", "N/2", "(((((", "[1,2]", "x+", "None", "missing/new.json", "torus.symfpu", "text.txt", "empty", "folder"]
ODD_TEXTS = (*NUMBERS_AS_TEXT, *WORDS, "", " ", "9" * 5000, "a" * 300, "\x00", "\ud800", "é")

CONTAINERS = (None, [], (), {}, set(), [1], (1, 1), (1, 2, 3), (0,), (-1,), (1.5,), (None,), ("x",), (10**30,), [[1, 2], [3]])
LONG = (tuple(range(1, 8)), tuple(range(1000)), [math.nan], [1e300] * 7, ["1e400"] * 7, [0.1] * 7, [1e-3] * 7, [True] * 7)
BY_SEED = ({1: None}, {1: "0.1"}, {1: 0}, {0: 1}, {9: "0.1"}, {1: 1e300}, {1: 1e-320}, {1: math.nan}, {"1": 1}, {1.5: 1}, {(1,): 1})
OBJECTS = (b"abc", range(3), object, print, Ellipsis)
ARRAYS = (np.zeros(0), np.zeros(7), np.ones(7), np.full(7, np.nan), np.full(7, 1e200), np.ones((7, 7)), np.zeros((3, 7)), np.array(3))
ODD_ARRAYS = (np.array(["x"]), np.array([None]), np.ones(7, dtype=complex))
ODD_OTHERS = (*CONTAINERS, *LONG, *BY_SEED, *OBJECTS, *ARRAYS, *ODD_ARRAYS)


def sound(name, random):
    """A value that fits a parameter of this name, or nothing that is known: None."""
    choices = by_name.get(name)
    return made(random.choice(choices)) if choices else None


def odd(random):
    """Any value: a number or a text of odd size, a container, an array, or a result."""
    choices = random.choice((ODD_NUMBERS, ODD_NUMBERS, ODD_TEXTS, ODD_OTHERS, RESULTS, CHAINS))
    return made(random.choice(choices))


def made(value):
    """What a maker makes; other values as they are, containers as copies."""
    if isinstance(value, partial) or value in MAKERS:
        return value()
    if isinstance(value, np.ndarray):
        return value.copy()
    return type(value)(value) if isinstance(value, list | dict | set) else value


class _Makers:
    """Membership by identity: values need not be hashable."""

    def __init__(self, makers):
        self.makers = makers

    def __contains__(self, value):
        return any(value is maker for maker in self.makers)


MAKERS = _Makers((*RESULTS, one_thread))
