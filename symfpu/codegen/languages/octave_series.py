"""A series with free amplitudes as one function file for GNU Octave and MATLAB: statements, or tables and the sums of a torus."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator
from string import Template

import mpmath
import sympy
from sympy.printing.octave import OctaveCodePrinter

from symfpu.codegen.languages.octave import (
    ANGLES,
    CHECKS,
    DEVIATION,
    INDENT,
    KERNEL,
    WIDTH,
    cells,
    comments,
    common_words,
    matrix,
    text_function,
    vector,
)
from symfpu.codegen.series_program import SeriesProgram, SeriesTables
from symfpu.codegen.straight_line import Statement, StraightLine
from symfpu.codegen.torus_program import SPLIT_DIGITS, number

EXTENSION = "m"
STRAIGHT_BLOCK = 1024  # times together: statements are interpreted once for them all

HEADER = """\
function [Q, P] = $name(t, amplitudes, phases, frequencies)
% $NAME  Machine-written: a Poincare-Lindstedt series of a Fermi-Pasta-Ulam chain.
%   For GNU Octave and MATLAB, which need nothing else; do not edit.
%
%   Q_q(t) = sum over nu of c_q[nu](A) cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1,
%   with free amplitudes A, phases phi and frequencies omega of the seeds.
%
$facts
%
$calls
%     t            vector of T real times, row or column
%     amplitudes   $s number(s) A, one a seed in the order above
%     phases       $s angles phi in radians; default, also of [], zeros
%     frequencies  $s rates omega of the angles; $meaning
%     Q, P         T x (N-1) = T x $modes, coordinates and momenta: column q is mode q
%     omega        1 x $s, corrected frequencies omega(A) of the seeds
%     jacobian     $s x $s, d omega_i / d A_j in row i, column j
%   All quantities are dimensionless.
%
%   Accuracy: omega t is reduced to one turn in two doubles, so that large times lose no digit of
%   the angle; the sums are those of doubles, some 1e-15 of the largest coordinate. Phases are as
%   good as their own last digit. MATLAB needs R2016b or later.
%
%   $name('self_test')
%   prints and returns the largest deviation from embedded vectors, relative to the largest
%   coordinate, momentum, frequency or slope, and is an error above $tolerance.

if nargin < 1
    refuseCall('arguments', 'give times and amplitudes, or ''self_test''');
end
if ischar(t) || isa(t, 'string')
    if strcmp(t, 'self_test')
        Q = selfTest();
    elseif ~strcmp(t, 'corrected_frequencies')
        refuseCall('word', 'the only words are ''corrected_frequencies'' and ''self_test''');
$corrected_call
    end
    return
end
if nargin < $least
    refuseCall('arguments', '$needed');
end
t = checkedTimes(t);
amplitudes = checkedRow('amplitudes', amplitudes);
if nargin < 3 || isempty(phases)
    phases = zeros(1, $s);
end
phases = checkedRow('phases', phases);
$default_frequencies
frequencies = checkedRow('frequencies', frequencies);
if nargout < 2
    Q = seriesOrbit(t, amplitudes, phases, frequencies);
else
    [Q, P] = seriesOrbit(t, amplitudes, phases, frequencies);
end
end
"""

NUMERIC = {
    "calls": """\
%   [Q, P] = $name(t, amplitudes)
%   [Q, P] = $name(t, amplitudes, phases)
%   [Q, P] = $name(t, amplitudes, phases, frequencies)
%   [omega, jacobian] = $name('corrected_frequencies', amplitudes)""",
    "meaning": "default omega(A) of the series",
    "corrected_call": """\
    elseif nargin ~= 2
        refuseCall('arguments', '''corrected_frequencies'' takes the amplitudes');
    else
        [Q, P] = correctedFrequencies(checkedRow('amplitudes', amplitudes));""",
    "least": "2",
    "needed": "give times and amplitudes",
    "default_frequencies": """\
if nargin < 4 || isempty(frequencies)
    frequencies = correctedFrequencies(amplitudes);
end""",
    "arguments": "A",
}
UNIVERSAL = {
    "calls": """\
%   [Q, P] = $name(t, amplitudes, phases, frequencies)
%   [omega, jacobian] = $name('corrected_frequencies', amplitudes, frequencies)""",
    "meaning": "they enter the divisors too",
    "corrected_call": """\
    elseif nargin ~= 3
        refuseCall('arguments', '''corrected_frequencies'' takes amplitudes and frequencies');
    else
        [Q, P] = correctedFrequencies(checkedRow('amplitudes', amplitudes), checkedRow('frequencies', phases));""",
    "least": "4",
    "needed": "give times, amplitudes, phases (or []) and frequencies",
    "default_frequencies": "% the frequencies enter the divisors and have no default",
    "arguments": "A, rates",
}

TURNS = """
function [high, low] = turnsOf(frequencies)
% omega / 2 pi as the sum of two doubles.
[high, low] = exactProduct(frequencies, $inverse);
low = low + frequencies * $inverse_low;
end
"""

SELF_TEST = """
function worst = selfTest()
A = testAmplitudes().';
rates = testFrequencies().';
found = cell(1, 4);
[found{1}, found{2}] = seriesOrbit(testTimes(), A, testPhases().', rates);
[found{3}, found{4}] = correctedFrequencies($arguments);
known = {reshape(testPositions(), $modes, []).', reshape(testMomenta(), $modes, []).', ...
    testCorrected().', reshape(testJacobian(), $s, []).'};
worst = largestDeviation(found, known);
end
"""

TABLES = """
function [Q, P] = seriesOrbit(t, A, phases, frequencies)
persistent plan exponents powers values gather
modes = $mode_cells;
if isempty(plan)
    exponents = $powers;
    powers = $power_cells;
    values = $value_cells;
    owners = $owner_cells;
    plan = plannedSums($harmonic_cells);
    gather = cell(size(owners));
    for k = 1:numel(owners)
        gather{k} = sparse(owners{k}, 1:numel(owners{k}), 1);
    end
end
scales = $scales;
monomials = prod((scales .* A) .^ exponents, 2);
coefficients = cell(size(values));
for k = 1:numel(values)
    coefficients{k} = full(gather{k} * (values{k} .* monomials(powers{k})));
end
weights = weightedParts(plan, coefficients, frequencies);
[high, low] = turnsOf(frequencies);
if nargout < 2
    Q = summedOrbit(t, high, low, phases, plan, weights, modes);
else
    [Q, P] = summedOrbit(t, high, low, phases, plan, weights, modes);
end
end

function [omega, jacobian] = correctedFrequencies(A)
persistent e table
if isempty(e)
    e = 2 * $frequency_powers;
    table = $frequency_coefficients;
end
scales = $scales;
x = scales .* A;
linear = $linear;
omega = linear + prod(x .^ e, 2).' * table;
jacobian = zeros($s, $s);
for j = 1:$s
    lowered = e;
    lowered(:, j) = max(e(:, j) - 1, 0);
    jacobian(:, j) = ((e(:, j) .* prod(x .^ lowered, 2)).' * table).' * scales(j);
end
end
"""

STRAIGHT = """
function [Q, P] = seriesOrbit(t, A, phases, rates)
$given
$rates
$constants
$coefficients
[high, low] = turnsOf(rates);
Q = zeros(numel(t), $modes);
P = Q;
for first = 1:$block:numel(t)
    rows = first:min(first + $last, numel(t));
    theta = reducedAngles(t(rows), high, low, phases);
$waves
$positions
    if nargout > 1
$momenta
    end
end
end

function [omega, jacobian] = correctedFrequencies($arguments)
$given
$frequency_rates
$constants
$frequency_statements
omega = zeros(1, $s);
jacobian = zeros($s, $s);
$corrected
$jacobian
end
"""


class _Printer(OctaveCodePrinter):  # type: ignore[misc]
    """A Float is the double next to it, a Rational a quotient of doubles."""

    def _print_Float(self, value: sympy.Float) -> str:
        return repr(float(value))

    def _print_Rational(self, value: sympy.Rational) -> str:
        return f"({value.p}/{value.q})"


def emit_series(program: SeriesProgram) -> str:
    """The function file as text; the same bytes for the same program.

    program.name must be an identifier of lower-case letters, digits and underscores: local functions have names in mixed case.
    """
    form = UNIVERSAL if program.universal else NUMERIC
    with mpmath.workdps(SPLIT_DIGITS):
        exact = 1 / (2 * mpmath.pi)
        inverse, inverse_low = float(exact), float(exact - float(exact))
    words = {
        **common_words(program.name, program.N, len(program.seeds)),
        "facts": comments(program.facts),
        "inverse": repr(inverse),
        "inverse_low": repr(inverse_low),
    }
    words |= {key: Template(text).substitute(words) for key, text in form.items()}
    if program.straight is not None:
        words |= _straight_words(program, program.straight)
        body, kernel, tables = STRAIGHT, "", []
    else:
        assert program.tables is not None
        words |= _table_words(program.tables)
        body, kernel, tables = TABLES, KERNEL, [*_tables(program.tables)]
    text = Template(HEADER + CHECKS + body + SELF_TEST + DEVIATION + TURNS + ANGLES + kernel).substitute(words)
    return "".join((text, *tables, *_check_tables(program)))


def _table_words(tables: SeriesTables) -> dict[str, str]:
    s, blocks, count = len(tables.scales), tables.blocks, len(tables.frequency_powers)
    each = range(1, len(blocks) + 1)
    return {
        "mode_cells": cells(vector(block.modes) for block in blocks),
        "harmonic_cells": cells(matrix(f"harmonicTable{k}", s) for k in each),
        "power_cells": cells(f"powerTable{k}()" for k in each),
        "owner_cells": cells(f"ownerTable{k}()" for k in each),
        "value_cells": cells(matrix(f"coefficientTable{k}", len(block.modes)) for k, block in enumerate(blocks, 1)),
        "powers": matrix("exponentTable", s),
        "scales": vector(map(float, tables.scales)),
        "linear": vector(map(float, tables.linear)),
        "frequency_powers": matrix("frequencyExponentTable", s) if count else f"zeros(0, {s})",
        "frequency_coefficients": matrix("frequencyCoefficientTable", s) if count else f"zeros(0, {s})",
    }


def _tables(tables: SeriesTables) -> Iterator[str]:
    """Numbers of a table; places count from 1."""
    yield text_function("exponentTable", map(str, tables.powers.flat))
    for k, block in enumerate(tables.blocks, 1):
        owners = (h for h, (start, end) in enumerate(zip(block.starts, block.starts[1:], strict=False), 1) for _ in range(start, end))
        yield text_function(f"harmonicTable{k}", map(str, block.harmonics.flat))
        yield text_function(f"ownerTable{k}", map(str, owners))
        yield text_function(f"powerTable{k}", (str(n + 1) for n in block.powers))
        yield text_function(f"coefficientTable{k}", (number(float(c)) for c in block.coefficients.flat))
    if len(tables.frequency_powers):
        yield text_function("frequencyExponentTable", map(str, tables.frequency_powers.flat))
        yield text_function("frequencyCoefficientTable", (number(float(c)) for c in tables.frequency_coefficients.flat))


def _check_tables(program: SeriesProgram) -> Iterator[str]:
    check = program.check
    for name in ("amplitudes", "phases", "frequencies", "times", "corrected"):
        yield text_function(f"test{name.capitalize()}", getattr(check, name))
    for name in ("positions", "momenta", "jacobian"):
        yield text_function(f"test{name.capitalize()}", (x for row in getattr(check, name) for x in row))


def _straight_words(program: SeriesProgram, straight: StraightLine) -> dict[str, str]:
    seeds, form = program.seeds, _Printer()

    def written(statements: Iterable[tuple[str, sympy.Expr]], indent: str = "") -> str:
        return "\n".join(_statement(name, form.doprint(e), indent) for name, e in statements)

    def given(symbol: str, values: str, indent: str = "") -> list[str]:
        return [f"{indent}{symbol}{q} = {values}{i});" for i, q in enumerate(seeds, 1)]

    def modes(name: str, expressions: Iterable[sympy.Expr]) -> list[Statement]:
        return [(f"{name}(rows, {q})", e) for q, e in enumerate(expressions, 1) if e != 0]

    rates = "\n".join(given("omega", "rates("))
    jacobian = [(f"jacobian({i}, {j})", e) for i, row in enumerate(straight.jacobian, 1) for j, e in enumerate(row, 1)]
    return {
        "given": "\n".join(given("A", "A(")),
        "rates": rates,
        "frequency_rates": rates if program.universal else "% coefficients are those of the chosen frequencies",
        "constants": "\n".join(f"{name} = {float(value)!r};" for name, (value, _) in straight.constants.items()),
        "coefficients": written(straight.coefficients),
        "waves": "\n".join((*given("theta", "theta(:, ", INDENT), written(straight.waves, INDENT))),
        "positions": written(modes("Q", straight.positions), INDENT),
        "momenta": written(modes("P", straight.momenta), 2 * INDENT),
        "frequency_statements": written(straight.frequency_statements),
        "corrected": written((f"omega({i})", e) for i, e in enumerate(straight.corrected, 1)),
        "jacobian": written(jacobian),
        "block": str(STRAIGHT_BLOCK),
        "last": str(STRAIGHT_BLOCK - 1),
    }


def _statement(name: str, expression: str, indent: str) -> str:
    """One statement, continued in further lines; broken between operators."""
    spaced = re.sub(r"(\.[*/])", r" \1 ", expression)
    lines = textwrap.wrap(f"{name} = {spaced};", WIDTH, break_long_words=False, break_on_hyphens=False)
    return indent + f" ...\n{indent}{INDENT}".join(lines)
