"""Speed and memory of the main job, on two cores, after the first compilation. Measured and printed, not asserted."""

import subprocess
import sys

import pytest

from symfpu import Chain, lindstedt
from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.grading import Grading, monomial_count
from symfpu.algebra.selection import CosineModes
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS

TORI = (TWO_TORUS, *(torus for torus in APPENDIX_F if len(torus.seeds) > 1))


def series_of(torus):
    return lindstedt(torus.chain, torus.seeds, torus.frequencies, torus.order)


def plain_count(series):
    """Multiply-adds of the same products over all bonds without symmetries: every ordered pair of monomials, N bonds."""
    sizes = [monomial_count(len(series.seeds), d) for d in range(series.degree(series.order) + 1)]
    return series.chain.N * sum(sizes[d] * sizes[e] for d in range(1, len(sizes)) for e in range(1, len(sizes) - d))


@pytest.fixture(scope="module", autouse=True)
def compiled():
    lindstedt(Chain(N=16, alpha=1), (1,), ("0.2",), 2)
    lindstedt(Chain(N=32, alpha=1), (1,), ("0.2",), 2)


@pytest.mark.parametrize("torus", TORI, ids=lambda torus: torus.label)
def test_torus(benchmark, record, torus):
    series = benchmark.pedantic(series_of, (torus,), rounds=3, iterations=1, warmup_rounds=1)
    record(f"series of {torus.label}, order {torus.order}", multiply_adds=series.multiply_adds)


@pytest.mark.parametrize("torus", TORI, ids=lambda torus: torus.label)
def test_product_kernel(benchmark, record, torus):
    """All bond products of one series alone: the squares of every degree, on the coordinates of the finished series."""
    series = series_of(torus)
    ring = Float64Ring(CosineModes(torus.chain.N, torus.seeds, Grading(len(torus.seeds), torus.order + 1)))
    for k, modes in enumerate(series.coordinates):
        ring.put(k + 1, modes.copy())

    def products():
        ring.multiply_adds = 0
        for degree in range(2, torus.order + 2):
            ring.power(2, degree)

    benchmark.pedantic(products, rounds=3, iterations=1, warmup_rounds=1)
    record(f"product kernel alone, {torus.label}", multiply_adds=ring.multiply_adds, plain=plain_count(series))


def test_breather(benchmark, record):
    torus = APPENDIX_F[-1]
    series = benchmark.pedantic(lindstedt, (torus.chain, torus.seeds, torus.frequencies, 250), rounds=3, iterations=1, warmup_rounds=1)
    record("breather N = 32 to order 250", multiply_adds=series.multiply_adds)


def test_breather_of_order_1000(benchmark, record):
    torus = APPENDIX_F[-1]
    arguments = (torus.chain, torus.seeds, torus.frequencies, 1000)
    series = benchmark.pedantic(lindstedt, arguments, rounds=1, iterations=1)
    record("breather N = 32 to order 1000", multiply_adds=series.multiply_adds)


@pytest.mark.parametrize(
    ("name", "command"),
    [
        ("import symfpu", [sys.executable, "-c", "import symfpu"]),
        ("symfpu --help", [sys.executable, "-c", "from symfpu.cli.main import main; main(['--help'])"]),
    ],
)
def test_start(benchmark, record, name, command):
    benchmark.pedantic(subprocess.run, (command,), {"check": True, "capture_output": True}, rounds=5, iterations=1, warmup_rounds=1)
    record(name)


def test_first_compilation(benchmark, record, tmp_path):
    """A fresh kernel cache: the first series pays for the compilation of both row widths."""
    code = (
        "from symfpu import Chain, lindstedt\n"
        "lindstedt(Chain(N=16, alpha=1), (1,), ('0.2',), 2); lindstedt(Chain(N=32, alpha=1), (1,), ('0.2',), 2)"
    )

    def run():
        folder = tmp_path / str(len(list(tmp_path.iterdir())))
        folder.mkdir()
        subprocess.run([sys.executable, "-c", code], check=True, env={"NUMBA_CACHE_DIR": str(folder), "PATH": ""})

    benchmark.pedantic(run, rounds=3, iterations=1)
    record("first compilation of all kernels (whole process)")


SIX_TORI = """
from symfpu.series.lindstedt import lindstedt
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS
for t in (TWO_TORUS, *APPENDIX_F[:5]):
    lindstedt(t.chain, t.seeds, t.frequencies, t.order)
"""


def test_memory(in_a_process, record):
    _, peak = in_a_process(SIX_TORI, rounds=3)
    record("six tori in a process of their own", note=f"peak memory {peak:.2f} GB")
