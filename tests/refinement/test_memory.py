"""The memory of a refinement, predicted: against the peak of processes of their own, and refused before it is allocated."""

import re
import subprocess
import sys

import psutil
import pytest

import symfpu
from symfpu import Chain, InputError, TorusTooLarge, refine
from symfpu.refinement import memory, search, tori
from tests.tori.test_ring_torus import torus as waves

MEASURE = """
from pathlib import Path
import scipy.fft, scipy.linalg, scipy.sparse.linalg
from symfpu.chain.chain import Chain
from symfpu.refinement import search, tori
import symfpu
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.series.lindstedt import lindstedt
{guess}
sizes = []
search.FIRST_POLYTOPE = {first}
search.require_memory = lambda found, chain: sizes.append(found.bytes())
status = lambda name: int(Path("/proc/self/status").read_text().split(name)[1].split()[0]) * 1024
Path("/proc/self/clear_refs").write_text("5")  # the peak begins anew
before = status("VmRSS:")
tori.refine(near, amplitudes=wanted, most_harmonics={most})
print(status("VmHWM:") - before, max(sizes))
"""
FIXED = """
wanted = {{q: repr({scale} / q) for q in range(1, {s} + 1)}}
near = symfpu.torus(Chain({N}, {law}), tuple(wanted), amplitudes=wanted, method="series", order={order})
"""
RING = """
chain = Chain(16, potential="lj:12,6", ends="periodic")
linear = dict(zip(chain.mode_numbers, chain.frequencies()))
omega = [format(linear[q] * (1 + x), ".14f") for q, x in ((1, 2e-3), (2, 1e-3), (-3, 3e-3))]
near = solve_amplitudes(lindstedt(chain, (1, 2, -3), omega, 4))
wanted = {q: repr(float(a)) for q, a in near.amplitudes.items()}
"""
CASES = {
    "N = 64, s = 3": {"N": 64, "s": 3, "law": "alpha='0.3'", "scale": 0.5, "order": 2, "most": 2000},
    "N = 32, s = 4": {"N": 32, "s": 4, "law": "beta='0.3'", "scale": 0.5, "order": 2, "most": 8000},
    "N = 16, s = 2": {"N": 16, "s": 2, "law": "alpha='0.3'", "scale": 1.5, "order": 4, "most": 40000},
    "N = 128, s = 2": {"N": 128, "s": 2, "law": "alpha='0.3'", "scale": 0.5, "order": 2, "most": 2000},
    "N = 128, s = 3": {"N": 128, "s": 3, "law": "beta='0.3'", "scale": 1.0, "order": 2, "most": 3000},
    "N = 32, s = 5": {"N": 32, "s": 5, "law": "beta='0.3'", "scale": 0.3, "order": 1, "most": 8000},
    "N = 16, s = 4": {"N": 16, "s": 4, "law": "alpha='0.3'", "scale": 0.3, "order": 2, "most": 8000},
    "N = 16, s = 3": {"N": 16, "s": 3, "law": "alpha='0.3'", "scale": 1.0, "order": 3, "most": 6000},
    "N = 16, s = 5": {"N": 16, "s": 5, "law": "alpha='0.3'", "scale": 0.3, "order": 2, "most": 8000},
    "N = 1024, s = 2": {"N": 1024, "s": 2, "law": "beta='0.3'", "scale": 0.3, "order": 2, "most": 2000},
    "ring, s = 3": {"most": 20000},
    "by forces": {"N": 128, "s": 3, "law": "beta='0.3'", "scale": 1.0, "order": 2, "most": 3000, "first": 1500},
}
QUICK = {"N = 1024, s = 2"}
ALL = [pytest.param(name, marks=[] if name in QUICK else pytest.mark.long) for name in CASES]
TOO_MUCH = 1.5  # as promised: of the peak, what is predicted at most
LEAST = 120e6  # bytes from which on it is; below, what an allocator keeps counts for more


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the peak of a process from /proc")
@pytest.mark.parametrize("name", ALL)
def test_the_peak_is_that_predicted_or_less(name):
    case = CASES[name]
    guess = FIXED.format(**case) if "N" in case else RING
    script = MEASURE.format(guess=guess, most=case["most"], first=case.get("first", 10**9))
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    measured, predicted = map(int, re.findall(r"\d+", result.stdout))
    assert 0 < measured < predicted
    assert predicted < TOO_MUCH * max(measured, LEAST)


def near(chain, wanted):
    return symfpu.torus(chain, tuple(wanted), amplitudes=wanted, method="series", order=2)


@pytest.mark.parametrize("stage", ["before its equations", pytest.param("before the first step", marks=pytest.mark.long)])
def test_what_does_not_fit_is_refused_before_it_is_begun(monkeypatch, stage):
    """With less free memory than the smallest block asks for, and with less than the block that it has; the residual's angles left out."""
    monkeypatch.setattr(memory, "TRANSFORMED_BYTES", 0)
    chain, wanted = Chain(16, alpha="0.3"), {1: "1.0", 2: "0.5"}
    guess, needed = near(chain, wanted), []
    with monkeypatch.context() as here:
        here.setattr(search, "require_memory", lambda sizes, chain: needed.append(sizes.bytes()))
        refine(guess, amplitudes=wanted)
    least, whole = needed
    assert least < whole
    free = least - 1 if stage == "before its equations" else whole - 1

    def none(*_):
        raise AssertionError("it was begun")

    monkeypatch.setattr(psutil, "virtual_memory", lambda: type("Memory", (), {"available": free}))
    monkeypatch.setattr(search, "newton", none)
    if free < least:
        monkeypatch.setattr(search, "InvarianceEquation", none)
    with pytest.raises(TorusTooLarge) as refused:
        refine(guess, amplitudes=wanted)
    error = refused.value
    assert isinstance(error, InputError)
    assert (error.free, error.needed) == (free, free + 1)
    assert f"{free:,} bytes of free memory ({free + 1:,} are needed)" in str(error)
    assert f"take most_harmonics={error.largest} or less" in str(error)
    assert 0 < error.largest < error.harmonics


def test_as_many_harmonics_as_it_names_fit(monkeypatch):
    chain, wanted = Chain(8, alpha="0.3"), {1: "0.3", 3: "0.15"}
    guess = near(chain, wanted)
    free = int(memory.KEPT_BYTES * 1.25)
    monkeypatch.setattr(psutil, "virtual_memory", lambda: type("Memory", (), {"available": free}))
    with pytest.raises(TorusTooLarge) as refused:
        refine(guess, amplitudes=wanted)
    found = refine(guess, amplitudes=wanted, most_harmonics=refused.value.largest)
    assert len(found.harmonics) <= refused.value.largest


def test_where_none_fit_the_chain_is_too_long(monkeypatch):
    guess = waves(9, (1, 4), (1.5e-3, 2e-3), 4, beta="0.5")
    monkeypatch.setattr(psutil, "virtual_memory", lambda: type("Memory", (), {"available": 1000}))
    with pytest.raises(TorusTooLarge, match=r"of N = 9'.* take a shorter chain"):
        tori.refine(guess)
