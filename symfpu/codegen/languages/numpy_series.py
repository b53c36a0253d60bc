"""NumPy: a series with free amplitudes as one module that needs nothing but numpy."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterable, Sequence
from string import Template
from typing import Any

import mpmath
import sympy
from sympy.printing.codeprinter import CodePrinter
from sympy.printing.numpy import NumPyPrinter

from symfpu.codegen.languages.numpy_source import WIDTH, text_constant
from symfpu.codegen.series_program import SeriesProgram, SeriesTables
from symfpu.codegen.torus_program import SPLIT_DIGITS, TOLERANCE, number

EXTENSION = "py"

ANGLES = '''

def _product(a, b):
    """a b as the sum of two doubles (Dekker)."""
    big = 134217729.0 * a
    a_high = big - (big - a)
    big = 134217729.0 * b
    b_high = big - (big - b)
    a_low, b_low, product = a - a_high, b - b_high, a * b
    return product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


def _angles(t, frequencies, phases):
    """omega t + phi modulo 2 pi, (s, times): turns in two doubles, so that large times lose no digit of the angle."""
    rows = []
    for omega, phase in zip(frequencies, phases):
        high, low = _product(omega, _INVERSE[0])
        low += omega * _INVERSE[1]
        product, error = _product(t, high)
        rows.append(2 * np.pi * ((product - np.rint(product)) + error + t * low) + phase)
    return np.array(rows)


def _given(name, values):
    array = np.asarray(values, dtype=float)
    if array.shape != (len(SEEDS),):
        raise ValueError("%s must be one number for each of the seeds %s" % (name, SEEDS))
    return array

'''

FUNCTIONS = '''

def orbit($parameters):
    """Mode coordinates Q and momenta P: arrays (T, N-1) for times (T,), (N-1,) for a number.

    amplitudes : s numbers A, in the order of SEEDS. phases : s angles in radians; default zeros. frequencies : s rates of the
    angles, theta = omega t + phi; $frequencies. All quantities are dimensionless.
    """
    times, A = np.asarray(t, dtype=float), _given("amplitudes", amplitudes)
    if times.ndim > 1:
        raise ValueError("t must be a number or one-dimensional")
    chosen = np.zeros(len(SEEDS)) if phases is None else _given("phases", phases)
    omega = $omega
    flat = times.reshape(-1)
    Q, P = np.empty((len(flat), N - 1)), np.empty((len(flat), N - 1))
    coefficients = _coefficients(A, omega)
    for first in range(0, len(flat), _BLOCK):
        rows = slice(first, first + _BLOCK)
        Q[rows], P[rows] = _sums(_angles(flat[rows], omega, chosen), coefficients)
    return (Q[0], P[0]) if times.ndim == 0 else (Q, P)


def positions($parameters):
    """Mode coordinates Q_q(t), q = 1 .. N-1; see orbit."""
    return orbit($arguments)[0]


def momenta($parameters):
    """Mode momenta P_q = dQ_q/dt; see orbit."""
    return orbit($arguments)[1]


def self_test():
    """Largest deviation from the embedded test vectors, each relative to the largest value of its kind."""
    texts = (_CHECK_TIMES, _CHECK_AMPLITUDES, _CHECK_PHASES, _CHECK_FREQUENCIES)
    times, amplitudes, phases, rates = (np.array(text.split(), dtype=float) for text in texts)
    results = (*orbit(times, $test), *corrected_frequencies(amplitudes$rates))
    worst = 0.0
    for ours, text in zip(results, (_CHECK_POSITIONS, _CHECK_MOMENTA, _CHECK_CORRECTED, _CHECK_JACOBIAN)):
        known = np.array(text.split(), dtype=float).reshape(ours.shape)
        worst = max(worst, float(np.abs(ours - known).max() / (np.abs(known).max() or 1.0)))
    return worst


if __name__ == "__main__":
    deviation = self_test()
    print("largest deviation %.1e, allowed %.0e" % (deviation, TOLERANCE))
    raise SystemExit(0 if deviation <= TOLERANCE else 1)
'''

TABLES = '''
def _table(text, kind, columns):
    return np.array(text.split(), dtype=kind).reshape(-1, columns)


_BLOCK = 128  # times at once
_TABLES = [
    (
        np.array(modes) - 1,
        _table(harmonics, int, len(SEEDS)),
        np.array(starts.split(), dtype=int),
        _table(_POWERS, int, len(SEEDS))[np.array(powers.split(), dtype=int)],
        _table(values, float, len(modes)),
    )
    for modes, harmonics, starts, powers, values in _BLOCKS
]


def _coefficients(amplitudes, frequencies):
    """Modes, harmonics, and coefficients of cosines in Q and of sines in P at these amplitudes."""
    x = np.array(_SCALES.split(), dtype=float) * amplitudes
    parts = []
    for modes, harmonics, starts, powers, values in _TABLES:
        cosines = np.add.reduceat(values * np.prod(x**powers, axis=1)[:, None], starts, axis=0)
        parts.append((modes, harmonics, cosines, -(harmonics @ frequencies)[:, None] * cosines))
    return parts


def _sums(theta, coefficients):
    """Q and P, (times, N-1), at angles (s, times)."""
    Q, P = np.zeros((2, theta.shape[1], N - 1))
    for modes, harmonics, cosines, sines in coefficients:
        waves = np.ones((len(harmonics), theta.shape[1]), dtype=complex)
        for angle, n in zip(theta, harmonics.T):
            top = int(np.abs(n).max())
            waves *= np.exp(1j * np.arange(-top, top + 1)[:, None] * angle)[n + top]
        Q[:, modes] = waves.real.T @ cosines
        P[:, modes] = waves.imag.T @ sines
    return Q, P


def corrected_frequencies(amplitudes):
    """omega(A) of the seeds, shape (s,), and its Jacobian d omega_i / d A_j, shape (s, s)."""
    scales = np.array(_SCALES.split(), dtype=float)
    x = scales * _given("amplitudes", amplitudes)
    e = 2 * _table(_FREQUENCY_POWERS, int, len(SEEDS))
    table = _table(_FREQUENCY_COEFFICIENTS, float, len(SEEDS))
    omega = np.array(_LINEAR.split(), dtype=float) + np.prod(x**e, axis=1) @ table
    jacobian = np.empty((len(SEEDS), len(SEEDS)))
    for j in range(len(SEEDS)):
        lowered = e.copy()
        lowered[:, j] = np.maximum(e[:, j] - 1, 0)
        jacobian[:, j] = (e[:, j] * np.prod(x**lowered, axis=1)) @ table * scales[j]
    return omega, jacobian
'''

LARGEST_PRODUCT = 4  # powers up to it are written as products
PRODUCT = 100  # binds more tightly than any operator of SymPy's printers: all but names and numbers get parentheses


ENDS = (
    "return np.stack([q + 0 * theta[0] for q in Q], axis=1), np.stack([p + 0 * theta[0] for p in P], axis=1)",
    "return np.array(corrected, dtype=float), np.array(jacobian, dtype=float)",
)


class Waves:
    """Cosines and sines of a module under its short name, for SymPy's printers."""

    module = "np"

    def _print_cos(self, expression: sympy.Expr) -> str:
        return f"{self.module}.cos({self._print(expression.args[0])})"  # type: ignore[attr-defined]

    def _print_sin(self, expression: sympy.Expr) -> str:
        return f"{self.module}.sin({self._print(expression.args[0])})"  # type: ignore[attr-defined]


class _Printer(Waves, NumPyPrinter):  # type: ignore[misc]
    """NumPy with its short name; a Float is the double next to it."""

    def __init__(self) -> None:
        super().__init__({"fully_qualified_modules": False})

    def _print_Float(self, value: sympy.Float) -> str:
        return repr(float(value))

    def _print_Rational(self, value: sympy.Rational) -> str:
        return f"({value.p} / {value.q})"

    def _print_Pow(self, power: sympy.Pow, rational: bool = False) -> str:
        base, exponent = power.as_base_exp()
        if exponent.is_Integer and 1 < abs(exponent) <= LARGEST_PRODUCT:
            product = " * ".join([self.parenthesize(base, PRODUCT)] * abs(int(exponent)))
            return f"({product})" if exponent > 0 else f"(1 / ({product}))"
        return str(super()._print_Pow(power, rational=rational))


def emit_series(program: SeriesProgram) -> str:
    """The module as text; the same bytes for the same program."""
    with mpmath.workdps(SPLIT_DIGITS):
        exact = 1 / (2 * mpmath.pi)
        inverse = float(exact), float(exact - float(exact))
    constants = [
        f"N = {program.N}",
        f"SEEDS = {program.seeds!r}",
        f"TOLERANCE = {TOLERANCE!r}",
        f"_INVERSE = {inverse!r}  # 1 / 2 pi as the sum of two doubles",
        *check_constants(program),
        *([] if program.tables is None else table_constants(program.tables, lambda x: number(float(x)))),
    ]
    body = TABLES if program.straight is None else straight_functions(program, _Printer(), _constant, ENDS)
    header = f'"""{series_docstring(program)}"""\n\nimport numpy as np\n'
    return header + "\n" + "\n".join(constants) + "\n" + ANGLES + body + filled(FUNCTIONS, program)


def _constant(value: Any, _: str) -> str:
    return repr(float(value))


def series_docstring(program: SeriesProgram) -> str:
    """The header of a Python module."""
    facts = "\n".join(f"{key}: {value}" for key, value in program.facts.items())
    return (
        f"{program.name}: a Poincare-Lindstedt series of a Fermi-Pasta-Ulam chain with free amplitudes. Written by a machine.\n\n"
        f"{facts}\n\norbit({_arguments(program)}), positions, momenta, corrected_frequencies: see their docstrings. Arrays end in the\n"
        "mode axis q = 1 .. N-1, time first; angles in radians, everything else dimensionless. Run this file to test it.\n"
    )


def _arguments(program: SeriesProgram) -> str:
    return "t, amplitudes, frequencies, phases" if program.universal else "t, amplitudes, phases, frequencies"


def filled(functions: str, program: SeriesProgram) -> str:
    """The functions that are the same in every file, with what a universal series does differently."""
    if program.universal:
        words = {
            "parameters": "t, amplitudes, frequencies, phases=None",
            "frequencies": "they enter the divisors too",
            "omega": '_given("frequencies", frequencies)',
            "test": "amplitudes, rates, phases",
            "rates": ", rates",
        }
    else:
        words = {
            "parameters": "t, amplitudes, phases=None, frequencies=None",
            "frequencies": "default corrected_frequencies(A)",
            "omega": 'corrected_frequencies(amplitudes)[0] if frequencies is None else _given("frequencies", frequencies)',
            "test": "amplitudes, phases, rates",
            "rates": "",
        }
    return Template(functions).substitute(words, arguments=_arguments(program))


def check_constants(program: SeriesProgram) -> list[str]:
    """The embedded test vectors."""
    check = program.check
    vectors = {"AMPLITUDES": check.amplitudes, "PHASES": check.phases, "FREQUENCIES": check.frequencies, "TIMES": check.times}
    vectors |= {"POSITIONS": _flat(check.positions), "MOMENTA": _flat(check.momenta)}
    vectors |= {"CORRECTED": check.corrected, "JACOBIAN": _flat(check.jacobian)}
    return [text_constant(f"_CHECK_{name}", words) for name, words in vectors.items()]


def _flat(rows: Iterable[Sequence[str]]) -> tuple[str, ...]:
    return tuple(x for row in rows for x in row)


def table_constants(tables: SeriesTables, word: Callable[[Any], str]) -> list[str]:
    """The tables as string constants; word gives a coefficient as text."""
    constants = [
        text_constant("_SCALES", map(word, tables.scales)),
        text_constant("_LINEAR", map(word, tables.linear)),
        text_constant("_POWERS", map(str, tables.powers.flat)),
        text_constant("_FREQUENCY_POWERS", map(str, tables.frequency_powers.flat)),
        text_constant("_FREQUENCY_COEFFICIENTS", map(word, tables.frequency_coefficients.flat)),
    ]
    names = []
    for p, block in enumerate(tables.blocks):
        constants.append(text_constant(f"_HARMONICS_{p}", map(str, block.harmonics.flat)))
        constants.append(text_constant(f"_STARTS_{p}", map(str, block.starts[:-1])))
        constants.append(text_constant(f"_ROW_POWERS_{p}", map(str, block.powers)))
        constants.append(text_constant(f"_COEFFICIENTS_{p}", map(word, block.coefficients.flat)))
        names.append(f"({list(block.modes)!r}, _HARMONICS_{p}, _STARTS_{p}, _ROW_POWERS_{p}, _COEFFICIENTS_{p})")
    constants.append(f"_BLOCKS = [{', '.join(names)}]")
    return constants


def straight_functions(program: SeriesProgram, printer: CodePrinter, constant: Callable[[Any, str], str], ends: tuple[str, str]) -> str:
    """The functions _coefficients, _sums and corrected_frequencies as straight-line code.

    constant : a constant as text, from its value and its expression in mpmath. ends : the results of the last two, to be filled.
    """
    straight = program.straight
    assert straight is not None

    def line(name: str, expression: Any) -> str:
        return _wrapped(f"{name} = ", printer.doprint(expression))

    def row(values: Iterable[Any]) -> str:
        return "[" + ", ".join(printer.doprint(x) for x in values) + "]"

    divisors = ", frequencies" if program.universal else ""
    constants = [f"    {name} = {constant(*both)}" for name, both in straight.constants.items()]
    kept = [name for name, _ in straight.coefficients if name[0] in "cd" and name[1].isdigit()]
    jacobian = "[" + ", ".join(map(row, straight.jacobian)) + "]"
    lines = [
        "\n_BLOCK = 1024  # times at once\n\n\ndef _coefficients(amplitudes, frequencies):",
        '    """Coefficients of cosines in Q and of sines in P at these amplitudes."""',
        *_unpacked(program, ("A", "amplitudes"), ("omega", "frequencies")),
        *constants,
        *(line(*statement) for statement in straight.coefficients),
        _wrapped("return ", "".join(f"{name}, " for name in kept)),
        "\n\ndef _sums(theta, coefficients):",
        '    """Q and P, (times, N-1), at angles (s, times)."""',
        *_unpacked(program, ("theta", "theta")),
        _wrapped("", "".join(f"{name}, " for name in kept)) + " = coefficients",
        *(line(*statement) for statement in straight.waves),
        _wrapped("Q = ", row(straight.positions)),
        _wrapped("P = ", row(straight.momenta)),
        f"    {ends[0]}",
        f"\n\ndef corrected_frequencies(amplitudes{divisors}):",
        '    """omega(A) of the seeds, shape (s,), and its Jacobian d omega_i / d A_j, shape (s, s)."""',
        *_unpacked(program, ("A", '_given("amplitudes", amplitudes)')),
        *(_unpacked(program, ("omega", '_given("frequencies", frequencies)')) if program.universal else ()),
        *constants,
        *(line(*statement) for statement in straight.frequency_statements),
        _wrapped("corrected = ", row(straight.corrected)),
        _wrapped("jacobian = ", jacobian),
        f"    {ends[1]}",
    ]
    return "\n".join(lines) + "\n"


def _unpacked(program: SeriesProgram, *pairs: tuple[str, str]) -> list[str]:
    return [f"    ({', '.join(f'{name}{q}' for q in program.seeds)},) = {source}" for name, source in pairs]


def _wrapped(start: str, text: str) -> str:
    """One statement in lines of at most WIDTH columns, broken at spaces inside parentheses."""
    if len(start) + len(text) + 4 <= WIDTH:
        return f"    {start}{text}"
    lines = textwrap.wrap(text, WIDTH - 8, break_long_words=False, break_on_hyphens=False)
    return "\n".join([f"    {start}(", *(f"        {part}" for part in lines), "    )"])
