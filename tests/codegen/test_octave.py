"""Exported Octave against the torus at forty digits, all cases in one process of GNU Octave."""

import subprocess
from dataclasses import replace

import numpy as np
import pytest

from symfpu.codegen.languages.octave import BLOCK
from symfpu.codegen.languages.octave import OCTAVE as LANGUAGE
from symfpu.codegen.torus_program import torus_facts, torus_program
from tests.codegen.compilers import program
from tests.codegen.series_cases import OF_LARGEST, assert_close
from tests.codegen.test_c99 import CASES, angles, at_rest, case, random_times

SHOW = """
function show(varargin)
for k = 1:nargin
    fprintf('%d %d', size(varargin{k}));
    fprintf(' %.17g', varargin{k}.');
    fprintf('\\n');
end
end
"""
REFUSED = """
function refused(varargin)
try
    feval(varargin{:});
    fprintf('nothing\\n');
catch problem
    fprintf('%s | %s\\n', problem.identifier, problem.message);
end
end
"""


def octave(folder, script):
    """What one process prints, without a warning; show(...) prints arrays, refused(f, ...) an error."""
    (folder / "show.m").write_text(SHOW.lstrip())
    (folder / "refused.m").write_text(REFUSED.lstrip())
    (folder / "main_script.m").write_text("\n".join(script) + "\n")
    run = subprocess.run(
        [program("octave-cli"), "--no-init-file", "--quiet", "--eval", "main_script"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    noise = "error: ignoring const execution_exception& while preparing to exit"  # of Octave 7 itself, at every exit
    assert (run.returncode, run.stderr.replace(noise, "").strip()) == (0, "")
    return run.stdout.splitlines()


def arrays(lines):
    """What show printed."""
    found = []
    for line in lines:
        rows, columns, *numbers = line.split()
        found.append(np.array(numbers, dtype=float).reshape(int(rows), int(columns)))
    return found


def listed(values):
    return "[" + " ".join(repr(float(x)) for x in values) + "]"


def source(torus, name="sample"):
    return LANGUAGE.torus(torus_program(torus, name, torus_facts(torus)))


@pytest.mark.long
def test_values_shapes_and_self_tests_of_all_cases(tmp_path):
    t = random_times(np.random.default_rng(5), BLOCK + 3)
    picked = [0, 1, BLOCK - 1, BLOCK, BLOCK + 2]
    script, tori = [], [case(name) for name in CASES]
    other = [angles(np.random.default_rng(6), torus.seeds) for torus in tori]
    for n, (torus, phases) in enumerate(zip(tori, other, strict=True)):
        (tmp_path / f"torus_{n}.m").write_text(source(torus, f"torus_{n}"))
        script.append(f"t = {listed(t)}; show(torus_{n}('self_test'));")
        for arguments, rows in (("t", [i + 1 for i in picked]), (f"t(1:5).', {listed(phases.values())}", range(1, 6))):
            script.append(f"[Q, P, E, H] = torus_{n}({arguments}); [q, p] = torus_{n}({arguments}); r = {listed(rows)};")
            script.append("show(size(H), Q(r, :), P(r, :), E(r, :), H(r));")
            script.append(f"show(max(abs([q - Q; p - P; torus_{n}({arguments}) - Q])));")
        script.append(f"[Q, P, E, H] = torus_{n}([]); show(Q, P, E, H); show(torus_{n}(1.5))")
    lines = octave(tmp_path, script)
    assert sum(line.startswith("largest deviation") for line in lines) == len(CASES)
    results = iter(arrays(line for line in lines if not line.startswith("largest")))
    for torus, phases in zip(tori, other, strict=True):
        modes = torus.chain.N - 1
        assert 0 <= next(results)[0, 0] <= OF_LARGEST
        for exact, times in ((torus, t[picked]), (replace(torus, phases=phases), t[:5])):
            assert next(results).tolist() == [[len(t) if exact is torus else 5, 1]]
            assert_close(next(results), exact.Q(times))
            assert_close(next(results), exact.P(times))
            assert_close(next(results), exact.harmonic_energies(times))
            assert_close(next(results), exact.energy(times)[:, None])
            assert not next(results).any()  # fewer outputs, the same numbers
        assert [next(results).shape for _ in range(5)] == [(0, modes), (0, modes), (0, modes), (0, 1), (1, modes)]


def test_changed_coefficient_bad_arguments_and_rest(tmp_path):
    torus = case("alpha, one seed", digits=None)
    text = source(torus, "broken")
    program = torus_program(torus, "broken", {})
    largest = max((float(c) for block in program.blocks for c in block.coefficients.flat), key=abs)
    at = text.index("function values = coefficientTable1")
    assert repr(largest) in text[at:]
    (tmp_path / "broken.m").write_text(text[:at] + text[at:].replace(repr(largest), repr(largest * (1 + 1e-11)), 1))
    (tmp_path / "sample.m").write_text(source(torus))
    (tmp_path / "still.m").write_text(source(at_rest(), "still"))
    script = ["refused('broken', 'self_test')", "refused('sample')", "refused('sample', 'selftest')", "refused('sample', ones(2, 2))"]
    script += ["refused('sample', 1i)", "refused('sample', 1, [1 2])", "refused('sample', {1})"]
    lines = octave(tmp_path, [*script, "still('self_test'); [Q, P, E, H] = still([1 2 3]); show(Q, P, E, H)"])
    assert lines[0].startswith("largest deviation")
    assert lines[1].startswith("broken:self_test | broken: the self-test failed")
    assert [line.split(" | ")[0] for line in lines[2:8]] == ["sample:arguments", "sample:word", *["sample:shape"] * 4]
    assert lines[6].endswith("phases must be 1 real number(s), one for each seed")
    assert lines[8] == "largest deviation 0.0e+00, allowed 1e-13"
    assert [x.shape for x in arrays(lines[9:])] == [(3, 4), (3, 4), (3, 4), (3, 1)]
