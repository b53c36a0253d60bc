"""A torus as one function file for GNU Octave and MATLAB; dense real matrix products over blocks of times.

A harmonic is a multiple of the first seed's angle and a trailing part, so that the sums of products of cosines and of sines
serve nu = (a, b) and (a, -b) at once: with a reference BLAS half the multiplications of complex sums, and few cosines.
Long tables are text read by sscanf, which Octave parses in half the time of a matrix of literals.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping
from string import Template

from symfpu.codegen.torus_program import TOLERANCE, Ints, TorusProgram, number, turns
from symfpu.numbers.arithmetic import Numbers

EXTENSION = "m"
WIDTH = 100  # columns of a line of numbers or comments, before what begins and ends it
CHUNK = 200  # lines of text in one statement
INDENT = "    "

HEADER = """\
function [Q, P, E, H] = $name(t, phases)
% $NAME  Machine-written: a quasi-periodic solution of a Fermi-Pasta-Ulam chain.
%   For GNU Octave and MATLAB, which need nothing else; do not edit.
%
%   Q_q(t) = sum over nu of c_q[nu] cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1.
%
$facts
%
%   [Q, P, E, H] = $name(t)
%   [Q, P, E, H] = $name(t, phases)
%     t       vector of T real times, row or column
%     phases  $s angles phi in radians, one a seed in the order above; default
$default
%     Q, P    T x (N-1) = T x $modes, coordinates and momenta: column q is mode q
%     E       T x $modes, E_q = (P_q^2 + Omega_q^2 Q_q^2) / 2, the energy of mode q
%     H       T x 1, total energy of the chain
%   All quantities are dimensionless. What is not asked for is not computed.
%
%   Accuracy: omega t is reduced to one turn in two doubles, so that large times lose no digit of
%   the angle; the sums are those of doubles, some 1e-15 of the largest coordinate. Phases are as
%   good as their own last digit. MATLAB needs R2016b or later.
%
%   $name('self_test')
%   prints and returns the largest deviation from embedded vectors, relative to the largest
%   coordinate, momentum or energy, and is an error above $tolerance.

if nargin < 1
    refuseCall('arguments', 'give a vector of times, or ''self_test''');
end
if ischar(t) || isa(t, 'string')
    if ~strcmp(t, 'self_test')
        refuseCall('word', 'the only word is ''self_test''');
    end
    Q = selfTest();
    return
end
if nargin < 2 || isempty(phases)
    phases = $phases;
end
t = checkedTimes(t);
phases = checkedRow('phases', phases);
if nargout < 2
    Q = torusOrbit(t, phases);
else
    [Q, P] = torusOrbit(t, phases);
end
if nargout > 2
    E = 0.5 * (P .^ 2 + (Q .* linearFrequencies()) .^ 2);
end
if nargout > 3
    H = totalEnergy(Q, P);
end
end
"""

CHECKS = """
function refuseCall(kind, message)
name = '$name';
error([name ':' kind], '%s: %s', name, message);
end

function t = checkedTimes(t)
if ~isnumeric(t) || ~isreal(t) || (~isempty(t) && numel(t) ~= max(size(t)))
    refuseCall('shape', 't must be a real vector of times');
end
t = double(t(:));
end

function row = checkedRow(what, values)
if ~isnumeric(values) || ~isreal(values) || numel(values) ~= $s
    refuseCall('shape', [what ' must be $s real number(s), one for each seed']);
end
row = reshape(double(values), 1, []);
end
"""

ANGLES = """
function [product, rest] = exactProduct(a, b)
% a b as the sum of two doubles (Dekker).
big = 134217729 * a;
a_high = big - (big - a);
a_low = a - a_high;
big = 134217729 * b;
b_high = big - (big - b);
b_low = b - b_high;
product = a .* b;
rest = ((a_high .* b_high - product) + a_high .* b_low + a_low .* b_high) + a_low .* b_low;
end

function theta = reducedAngles(t, high, low, phases)
% omega t + phi modulo 2 pi, T x s; high + low = omega / 2 pi, so that large times lose no digit of the angle.
[product, rest] = exactProduct(t, high);
theta = 2 * pi * ((product - round(product)) + rest + t * low) + phases;
end
"""

KERNEL = """
function signs = firstSigns(rows)
% Sign of the first number of every row that is not zero; 1 where all are.
signs = ones(size(rows, 1), 1);
for j = size(rows, 2):-1:1
    signs(rows(:, j) > 0) = 1;
    signs(rows(:, j) < 0) = -1;
end
end

function plan = plannedSums(harmonics)
% Harmonics (a cell for every block) as a >= 0 times the first angle, and a sign times one of few trailing parts b:
% cos(a x + b.y) = cos(a x) cos(b.y) - sin(a x) sin(b.y). One seed alone is trailing.
plan.split = min(1, $s - 1);
plan.trailing = zeros(0, $s - plan.split);
plan.harmonics = cell(size(harmonics));
plan.parts = cell(size(harmonics));
if isempty(harmonics)
    return
end
all_rows = vertcat(harmonics{:});
all_rows = all_rows .* firstSigns(all_rows);
leading = sum(all_rows(:, 1:plan.split), 2);
signs = firstSigns(all_rows(:, plan.split+1:end));
[plan.trailing, unused, where] = unique(all_rows(:, plan.split+1:end) .* signs, 'rows'); %#ok<ASGLU>
done = 0;
for k = 1:numel(harmonics)
    mine = done + (1:size(harmonics{k}, 1)).';
    done = done + numel(mine);
    plan.harmonics{k} = all_rows(mine, :);
    multiples = unique(leading(mine));
    plan.parts{k} = cell(1, numel(multiples));
    for i = 1:numel(multiples)
        part.leading = multiples(i);
        part.rows = find(leading(mine) == multiples(i));
        [part.used, unused, place] = unique(where(mine(part.rows))); %#ok<ASGLU>
        order = (1:numel(place)).';
        part.even = sparse(place, order, 1);
        part.odd = sparse(place, order, signs(mine(part.rows)));
        plan.parts{k}{i} = part;
    end
end
end

function weights = weightedParts(plan, coefficients, omega)
% Coefficients of the products of cosines and of sines in Q, then those in P.
weights = cell(size(coefficients));
for k = 1:numel(coefficients)
    c = coefficients{k};
    r = c .* (plan.harmonics{k} * omega(:));
    weights{k} = cell(numel(plan.parts{k}), 4);
    for i = 1:numel(plan.parts{k})
        part = plan.parts{k}{i};
        weights{k}{i, 1} = full(part.even * c(part.rows, :));
        weights{k}{i, 2} = full(part.odd * c(part.rows, :));
        weights{k}{i, 3} = full(part.even * r(part.rows, :));
        weights{k}{i, 4} = full(part.odd * r(part.rows, :));
    end
end
end

function [q, p] = summedBlock(plan, parts, weights, x, cosines, sines)
% The modes of one parity at few times; p only where it is asked for.
q = 0;
p = 0;
for i = 1:numel(parts)
    used = parts{i}.used;
    even = cosines(:, used);
    odd = sines(:, used);
    a = parts{i}.leading;
    if a == 0
        q = q + even * weights{i, 1};
        if nargout > 1
            p = p - odd * weights{i, 4};
        end
        continue
    end
    c = cos(a * x);
    s = sin(a * x);
    q = q + c .* (even * weights{i, 1}) - s .* (odd * weights{i, 2});
    if nargout > 1
        p = p - s .* (even * weights{i, 3}) - c .* (odd * weights{i, 4});
    end
end
end

function [Q, P] = summedOrbit(t, high, low, phases, plan, weights, modes)
% All modes at all times, $block times together.
Q = zeros(numel(t), $modes);
P = Q;
for first = 1:$block:numel(t)
    rows = first:min(first + $last, numel(t));
    theta = reducedAngles(t(rows), high, low, phases);
    angles = theta(:, plan.split+1:end) * plan.trailing.';
    cosines = cos(angles);
    sines = sin(angles);
    for k = 1:numel(modes)
        if nargout < 2
            Q(rows, modes{k}) = summedBlock(plan, plan.parts{k}, weights{k}, theta(:, 1), cosines, sines);
        else
            [Q(rows, modes{k}), P(rows, modes{k})] = ...
                summedBlock(plan, plan.parts{k}, weights{k}, theta(:, 1), cosines, sines);
        end
    end
end
end
"""
BLOCK = 128  # times evaluated together

FUNCTIONS = """
function [Q, P] = torusOrbit(t, phases)
persistent plan weights
modes = $mode_cells;
if isempty(plan)
    omega = $omega;
    harmonics = $harmonic_cells;
    coefficients = $coefficient_cells;
    plan = plannedSums(harmonics);
    weights = weightedParts(plan, coefficients, omega);
end
% omega / 2 pi as the sum of two doubles
high = $high;
low = $low;
if nargout < 2
    Q = summedOrbit(t, high, low, phases, plan, weights, modes);
else
    [Q, P] = summedOrbit(t, high, low, phases, plan, weights, modes);
end
end

function linear = linearFrequencies()
linear = 2 * sin((1:$modes) * (pi / $twice));
end

function H = totalEnergy(Q, P)
bonds = cos((1:$modes).' * ((0:$modes) + 0.5) * (pi / $N)) * sqrt(2 / $N);
r = (Q .* linearFrequencies()) * bonds;
H = 0.5 * sum(P .^ 2, 2) + sum(r .^ 2 .* (0.5 + r .* ($alpha / 3 + r * ($beta / 4))), 2);
end

function worst = selfTest()
t = testTimes();
[Q, P] = torusOrbit(t, $phases);
found = {Q, P, totalEnergy(Q, P)};
known = {reshape(testPositions(), $modes, []).', reshape(testMomenta(), $modes, []).', testEnergies()};
worst = largestDeviation(found, known);
end
"""

DEVIATION = """
function worst = largestDeviation(found, known)
% Of every kind of number relative to the largest of its kind; an error above the tolerance.
gaps = 0;
for k = 1:numel(known)
    scale = max(abs(known{k}(:)));
    if scale == 0
        scale = 1;
    end
    gaps = [gaps; abs(found{k}(:) - known{k}(:)) / scale]; %#ok<AGROW>
end
worst = max(gaps);
if any(isnan(gaps))
    worst = NaN;
end
fprintf('largest deviation %.1e, allowed %.0e\\n', worst, $tolerance);
if ~(worst <= $tolerance)
    refuseCall('self_test', sprintf('the self-test failed: deviation %.1e, allowed %.0e', worst, $tolerance));
end
end
"""


def emit_torus(program: TorusProgram) -> str:
    """The function file as text; the same bytes for the same program.

    program.name must be an identifier of lower-case letters, digits and underscores: local functions have names in mixed case.
    """
    s, blocks = len(program.seeds), program.blocks
    high, low = zip(*turns(program), strict=True)
    words = {
        **common_words(program.name, program.N, s),
        "facts": comments(program.facts),
        "default": _commented(", ".join(number(float(x)) for x in program.phases), 13),
        "phases": vector(map(float, program.phases)),
        "omega": vector(map(float, program.frequencies)),
        "high": vector(high),
        "low": vector(low),
        "alpha": number(float(program.alpha)),
        "beta": number(float(program.beta)),
        "twice": str(2 * program.N),
        "mode_cells": cells(vector(block.modes) for block in blocks),
        "harmonic_cells": cells(matrix(f"harmonicTable{k}", s) for k in range(1, len(blocks) + 1)),
        "coefficient_cells": cells(matrix(f"coefficientTable{k}", len(block.modes)) for k, block in enumerate(blocks, 1)),
    }
    check = program.check
    tables = [
        *(text for k, block in enumerate(blocks, 1) for text in _block_tables(k, block.harmonics, block.coefficients)),
        text_function("testTimes", check.times),
        text_function("testPositions", (x for row in check.positions for x in row)),
        text_function("testMomenta", (x for row in check.momenta for x in row)),
        text_function("testEnergies", check.energies),
    ]
    return Template(HEADER + CHECKS + FUNCTIONS + DEVIATION + ANGLES + KERNEL).substitute(words) + "".join(tables)


def common_words(name: str, N: int, s: int) -> dict[str, str]:
    """What both kinds of file are filled in with."""
    return {
        "name": name,
        "NAME": name.upper(),
        "N": str(N),
        "modes": str(N - 1),
        "s": str(s),
        "tolerance": repr(TOLERANCE),
        "block": str(BLOCK),
        "last": str(BLOCK - 1),
    }


def comments(facts: Mapping[str, str]) -> str:
    """The facts of the header as lines of a comment, whatever characters they have."""
    return "\n".join(_commented(f"{key}: {value}".encode("ascii", "backslashreplace").decode(), 3) for key, value in facts.items())


def _commented(text: str, indent: int) -> str:
    lines = textwrap.wrap(text, WIDTH, subsequent_indent=INDENT, break_on_hyphens=False)
    return "\n".join(f"%{indent * ' '}{line}" for line in lines)


def _block_tables(k: int, harmonics: Ints, coefficients: Numbers) -> list[str]:
    return [
        text_function(f"harmonicTable{k}", map(str, harmonics.flat)),
        text_function(f"coefficientTable{k}", (number(float(c)) for c in coefficients.flat)),
    ]


def text_function(name: str, words: Iterable[str]) -> str:
    """A local function that returns many numbers as a column."""
    lines = textwrap.wrap(" ".join(words), WIDTH, break_long_words=False, break_on_hyphens=False)
    chunks = [lines[i : i + CHUNK] for i in range(0, len(lines), CHUNK)]
    statements = [f"parts = cell(1, {len(chunks)});"]
    for i, chunk in enumerate(chunks, 1):
        statements.append(f"parts{{{i}}} = [ ...\n" + " ...\n".join(f"'{line} '" for line in chunk) + "];")
    return "\n".join([f"\nfunction values = {name}()", *statements, "values = sscanf([parts{:}], '%f');", "end\n"])


def vector(values: Iterable[int | float]) -> str:
    """A short row of numbers, continued in further lines."""
    words = ", ".join(number(x) if isinstance(x, float) else str(x) for x in values)
    return "[" + f" ...\n{2 * INDENT}".join(textwrap.wrap(words, WIDTH - 20, break_on_hyphens=False)) + "]"


def matrix(name: str, columns: int) -> str:
    """What a function of text_function returns, row by row."""
    return f"reshape({name}(), {columns}, []).'"


def cells(items: Iterable[str]) -> str:
    """A cell array in a row."""
    return "{" + f", ...\n{INDENT}".join(items) + "}"
