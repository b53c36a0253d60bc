"""NumPy: one module that needs nothing but numpy; dense matrix products over blocks of times."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable

from symfpu.codegen.nested import Nested, nest
from symfpu.codegen.torus_program import TOLERANCE, TorusProgram, number, turns

EXTENSION = "py"
WIDTH = 118

FUNCTIONS = '''
_SPLIT = min(1, len(SEEDS) - 1)
_MODES = np.arange(1, N)
_LINEAR = 2 * np.sin(_MODES * (np.pi / (2 * N)))


def _table(text, kind, columns):
    return np.array(text.split(), dtype=kind).reshape(-1, columns) if columns else np.zeros((1, 0), dtype=kind)


_LEADING, _TRAILING = _table(_LEADING_TEXT, int, _SPLIT), _table(_TRAILING_TEXT, int, len(SEEDS) - _SPLIT)
_BLOCK = 128  # times at once


def _slices(layout, text, modes):
    """(leading part, first trailing part, coefficients of cosines and rates times them) of every inner sum."""
    numbers, rows = _table(text, float, len(modes)), []
    at = 0
    for leading, start, count in _table(layout, int, 3):
        nu = np.concatenate([np.repeat(_LEADING[leading][None], count, axis=0), _TRAILING[start : start + count]], axis=1)
        part = numbers[at : at + count]
        both = np.concatenate([part, (nu @ np.array(FREQUENCIES))[:, None] * part], axis=1)
        rows.append((leading, start, np.ascontiguousarray(both.T)))
        at += count
    return np.array(modes) - 1, rows


_BLOCKS = [_slices(*block) for block in _BLOCK_TEXTS]


def _angles(t, phases):
    """omega t + phi modulo 2 pi, (s, times): turns in two doubles, so that large times lose no digit of the angle."""
    splitter = 134217729.0
    big = splitter * t
    t_high = big - (big - t)
    t_low = t - t_high
    columns = []
    for (high, low), phase in zip(_TURNS, phases):
        big = splitter * high
        f_high = big - (big - high)
        f_low = high - f_high
        product = t * high
        error = ((t_high * f_high - product) + t_high * f_low + t_low * f_high) + t_low * f_low
        columns.append(2 * np.pi * ((product - np.rint(product)) + error + t * low) + phase)
    return np.stack(columns)


def _plan(harmonics):
    """Harmonics as a number of the first seed and a row of a shorter list for the others."""
    if harmonics.shape[1] < 2:
        return harmonics[:, 0] if harmonics.shape[1] else None, None, None
    rest, where = np.unique(harmonics[:, 1:], axis=0, return_inverse=True)
    return harmonics[:, 0], where.reshape(-1), _plan(rest)


_OUTER, _INNER = _plan(_LEADING), _plan(_TRAILING)


def _waves(theta, plan):
    """exp(i nu.theta), (harmonics, times), from powers of exp(i theta_j); theta (s, times)."""
    first, where, rest = plan
    if first is None:
        return np.ones((1, theta.shape[-1]), dtype=complex)
    top = int(np.abs(first).max())
    rows = np.exp(1j * np.arange(-top, top + 1)[:, None] * theta[0])[first + top]
    if rest is not None:
        rows *= _waves(theta[1:], rest)[where]
    return rows


def orbit(t, phases=None):
    """Mode coordinates Q and momenta P: arrays (T, N-1) for times (T,), (N-1,) for a number.

    phases : s angles in radians, in the order of SEEDS; default PHASES. All quantities are dimensionless.
    """
    times = np.asarray(t, dtype=float)
    chosen = np.asarray(PHASES if phases is None else phases, dtype=float)
    if times.ndim > 1 or chosen.shape != (len(SEEDS),):
        raise ValueError("t must be a number or one-dimensional, phases one angle for each of the seeds %s" % (SEEDS,))
    flat = times.reshape(-1)
    Q, P = np.zeros((len(flat), N - 1)), np.zeros((len(flat), N - 1))
    for first in range(0, len(flat), _BLOCK):
        theta = _angles(flat[first : first + _BLOCK], chosen)
        outer, inner = _waves(theta[:_SPLIT], _OUTER), _waves(theta[_SPLIT:], _INNER).view(float)
        for columns, rows in _BLOCKS:
            m = len(columns)
            q, p = np.zeros((m, theta.shape[1])), np.zeros((m, theta.shape[1]))
            for leading, start, coefficients in rows:
                sums = (coefficients @ inner[start : start + coefficients.shape[1]]).view(complex)
                sums *= outer[leading]
                q += sums[:m].real
                p -= sums[m:].imag
            Q[first : first + _BLOCK, columns] = q.T
            P[first : first + _BLOCK, columns] = p.T
    return (Q[0], P[0]) if times.ndim == 0 else (Q, P)


def positions(t, phases=None):
    """Mode coordinates Q_q(t), q = 1 .. N-1; see orbit."""
    return orbit(t, phases)[0]


def momenta(t, phases=None):
    """Mode momenta P_q = dQ_q/dt; see orbit."""
    return orbit(t, phases)[1]


def harmonic_energies(t, phases=None):
    """E_q = (P_q^2 + Omega_q^2 Q_q^2) / 2 of every mode; shapes as those of orbit."""
    Q, P = orbit(t, phases)
    return 0.5 * (P**2 + (_LINEAR * Q) ** 2)


def energy(t, phases=None):
    """Total energy H of the chain; a number, or (T,)."""
    Q, P = orbit(t, phases)
    bonds = np.cos(np.outer(_MODES, np.arange(N) + 0.5) * (np.pi / N)) * np.sqrt(2.0 / N)
    r = (_LINEAR * Q) @ bonds
    return 0.5 * np.sum(P**2, axis=-1) + np.sum(r**2 * (0.5 + r * (ALPHA / 3 + r * BETA / 4)), axis=-1)


def self_test():
    """Largest deviation from the embedded test vectors, relative to the largest coordinate or momentum."""
    times = np.array(_CHECK_TIMES.split(), dtype=float)
    Q, P = orbit(times)
    worst = 0.0
    for ours, text in ((Q, _CHECK_POSITIONS), (P, _CHECK_MOMENTA)):
        known = _table(text, float, N - 1)
        worst = max(worst, np.abs(ours - known).max() / np.abs(known).max())
    known = np.array(_CHECK_ENERGIES.split(), dtype=float)
    return max(worst, float(np.abs(energy(times) / known - 1).max()))


if __name__ == "__main__":
    deviation = self_test()
    print("largest deviation %.1e, allowed %.0e" % (deviation, TOLERANCE))
    raise SystemExit(0 if deviation <= TOLERANCE else 1)
'''


def emit_torus(program: TorusProgram) -> str:
    """The module as text; the same bytes for the same program."""
    nested = nest(program)
    constants = [
        f"N = {program.N}",
        f"SEEDS = {program.seeds!r}",
        f"FREQUENCIES = ({', '.join(number(float(w)) for w in program.frequencies)},)",
        f"PHASES = ({', '.join(number(float(p)) for p in program.phases)},)",
        f"ALPHA, BETA = {number(float(program.alpha))}, {number(float(program.beta))}",
        f"TOLERANCE = {TOLERANCE!r}",
        "_TURNS = (  # omega / 2 pi, each as the sum of two doubles",
        *(f"    {pair!r}," for pair in turns(program)),
        ")",
        text_constant("_LEADING_TEXT", (str(n) for n in nested.leading.flat)),
        text_constant("_TRAILING_TEXT", (str(n) for n in nested.trailing.flat)),
        *_blocks(program, nested),
        text_constant("_CHECK_TIMES", program.check.times),
        text_constant("_CHECK_POSITIONS", (x for row in program.check.positions for x in row)),
        text_constant("_CHECK_MOMENTA", (x for row in program.check.momenta for x in row)),
        text_constant("_CHECK_ENERGIES", program.check.energies),
    ]
    header = f'"""{module_docstring(program)}"""\n\nimport numpy as np\n'
    return header + "\n" + "\n".join(constants) + "\n" + FUNCTIONS


def module_docstring(program: TorusProgram) -> str:
    """The header of a Python module."""
    facts = "\n".join(f"{key}: {value}" for key, value in program.facts.items())
    return (
        f"{program.name}: an invariant torus of a Fermi-Pasta-Ulam chain. Written by a machine; do not edit.\n\n{facts}\n\n"
        "orbit(t, phases), positions, momenta, harmonic_energies, energy: see their docstrings. Arrays end in the mode axis\n"
        "q = 1 .. N-1, time first; angles in radians, everything else dimensionless. Run this file to test it.\n"
    )


def _blocks(program: TorusProgram, nested: Nested) -> Iterable[str]:
    names = []
    for p, (block, slices) in enumerate(zip(program.blocks, nested.slices, strict=True)):
        layout = (str(n) for s in slices for n in (s.leading, s.start, len(s.coefficients)))
        yield text_constant(f"_LAYOUT_{p}", layout)
        yield text_constant(f"_COEFFICIENTS_{p}", (number(float(c)) for s in slices for c in s.coefficients.flat))
        names.append(f"(_LAYOUT_{p}, _COEFFICIENTS_{p}, {list(block.modes)!r})")
    yield f"_BLOCK_TEXTS = [{', '.join(names)}]"


def text_constant(name: str, words: Iterable[str]) -> str:
    """A long list of numbers as a string constant in short lines."""
    lines = textwrap.wrap(" ".join(words), WIDTH, break_long_words=False, break_on_hyphens=False)
    return f'{name} = """\n' + "\n".join(lines) + '\n"""'
