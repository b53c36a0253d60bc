"""Exported files have the same bytes whatever the order of sets: every language, in two processes of other hash seeds."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

HASHES = """
import hashlib
from symfpu.codegen import series_program
from symfpu.codegen.export import LANGUAGES
from tests.codegen.series_cases import CASES, UNIVERSAL, numeric, program_of, universal

programs = []
for limit in (0, 10**9):
    series_program.STRAIGHT_LINE = limit
    programs += [program_of(numeric(CASES[name]), CASES[name]) for name in ("wrapped modes", "one mode")]
programs += [program_of(universal(UNIVERSAL[name]), UNIVERSAL[name]) for name in ("wrapped, order 1", "mixed, one mode")]
for name, language in LANGUAGES.items():
    for program in programs:
        print(name, hashlib.sha256(language.series(program).encode()).hexdigest())
"""


@pytest.mark.long
def test_same_bytes_whatever_the_order_of_sets():
    root = Path(__file__).parents[2]
    found = []
    for seed in ("1", "29"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        run = subprocess.run([sys.executable, "-c", HASHES], cwd=root, env=environment, capture_output=True, text=True, check=True)
        found.append(run.stdout.splitlines())
    assert len(found[0]) == 5 * 6
    assert found[0] == found[1]
