"""Exported series in Octave against forty digits: statements and tables, all cases of a test in one process."""

from functools import cache

import numpy as np
import pytest

from symfpu.codegen.languages.octave import OCTAVE as LANGUAGE
from tests.codegen import series_cases
from tests.codegen.series_cases import CASES, OF_LARGEST, UNIVERSAL, assert_close, assert_frequencies
from tests.codegen.test_octave import arrays, listed, octave

STRAIGHT = ("alpha, one seed", "one mode", "wrapped modes", "one parity only", "order 0")  # small enough for statements to be forced


@cache
def series(name):
    return series_cases.numeric(CASES[name])


def written(folder, name, solved, case, form="default"):
    """The form that was written: straight-line or tables."""
    program = series_cases.program_of(solved, case, name, form)
    (folder / f"{name}.m").write_text(LANGUAGE.series(program))
    return program.straight is not None


def asked(name, given, universal):
    """Calls whose output is checked by agree."""
    amplitudes, phases, frequencies, times = map(listed, given)
    rates = f", {frequencies}" if universal else ""
    script = [f"show({name}('self_test')); A = {amplitudes}; t = {times}; phi = {phases}; w = {frequencies};"]
    script.append(f"[Q, P] = {name}(t, A, phi, w); [omega, jacobian] = {name}('corrected_frequencies', A{rates});")
    script.append(f"show(Q, P, omega, jacobian, {name}(t.', A, phi.', w.') - Q);")
    if not universal:
        script.append(f"[Q, P] = {name}(t(1:3), A); [q, p] = {name}(t(1:3), A, 0 * A, omega); show([Q - q; P - p]);")
    return [*script, f"[Q, P] = {name}([], A, [], w); show(Q, P, {name}(2.5, A, [], w) - {name}(2.5, A, 0 * A, w))"]


def agree(results, case, given, universal):
    """What asked printed against other digits."""
    N, s = case[0].N, len(case[1])
    assert 0 <= next(results)[0, 0] <= OF_LARGEST
    for exact in series_cases.expected_orbit(case, *given):
        assert_close(next(results), exact)
    omega, jacobian = next(results), next(results)
    assert (omega.shape, jacobian.shape) == ((1, s), (s, s))
    if universal:
        case = (*case[:2], tuple(given[2]), *case[3:])
    assert_frequencies(omega[0], jacobian, case, given[0])
    assert not any(next(results).any() for _ in range(1 if universal else 2))
    assert [next(results).shape for _ in range(3)] == [(0, N - 1), (0, N - 1), (1, N - 1)]


def numbers(lines):
    return iter(arrays(line for line in lines if not line.startswith("largest deviation")))


@pytest.mark.long
@pytest.mark.parametrize("names", [STRAIGHT, tuple(CASES)], ids=["statements", "tables"])
def test_numeric_series_agree_with_forty_digits(names, tmp_path):
    form = "statements" if names is STRAIGHT else "tables"
    script, draws = [], []
    for n, name in enumerate(names):
        assert written(tmp_path, f"series_{n}", series(name), CASES[name], form) == (names is STRAIGHT)
        amplitudes, *others = series_cases.drawn(CASES[name])
        draws.append((amplitudes * (-1) ** np.arange(len(amplitudes)), *others))
        script += asked(f"series_{n}", draws[-1], universal=False)
    results = numbers(octave(tmp_path, script))
    for name, given in zip(names, draws, strict=True):
        agree(results, CASES[name], given, universal=False)


@pytest.mark.long
def test_universal_series_agree_with_forty_digits(tmp_path):
    script, draws = [], []
    for n, case in enumerate(UNIVERSAL.values()):
        assert written(tmp_path, f"series_{n}", series_cases.universal(case), case)
        draws.append(series_cases.drawn(case))
        script += asked(f"series_{n}", draws[-1], universal=True)
    results = numbers(octave(tmp_path, script))
    for case, given in zip(UNIVERSAL.values(), draws, strict=True):
        moved = (*case[:2], tuple(given[2]), *case[3:])  # the series with these frequencies in its divisors
        agree(results, moved, given, universal=True)


def test_changed_coefficient_and_bad_arguments(tmp_path):
    case, script = CASES["alpha, one seed"], []
    formula = UNIVERSAL["order 0"]
    written(tmp_path, "formula", series_cases.universal(formula), formula)
    written(tmp_path, "sample", series("alpha, one seed"), case)
    program = series_cases.program_of(series("alpha, one seed"), case, "broken", "tables")
    text = LANGUAGE.series(program)
    largest = repr(max((float(c) for block in program.tables.blocks for c in block.coefficients.flat), key=abs))
    at = text.index("function values = coefficientTable1")
    assert largest in text[at:]
    (tmp_path / "broken.m").write_text(text[:at] + text[at:].replace(largest, repr(float(largest) * (1 + 1e-9)), 1))
    script = ["refused('broken', 'self_test')", "refused('sample')", "refused('sample', 1)", "refused('formula', 1, 1)"]
    script += ["refused('sample', 'corrected_frequencies')", "refused('formula', 'corrected_frequencies', 1)"]
    script += ["refused('sample', 'selftest')", "refused('sample', ones(2, 2), 1)", "refused('sample', 1, [1 2])"]
    script += ["refused('sample', 1, 1, [1 2])", "refused('sample', 1, 1, 1, [1 2])", "refused('formula', 1, 1, 1, [])"]
    lines = octave(tmp_path, script)
    assert lines[1].startswith("broken:self_test | broken: the self-test failed")
    kinds = [line.split(" | ")[0].split(":")[1] for line in lines[2:]]
    assert kinds == [*["arguments"] * 5, "word", *["shape"] * 5]
