"""Series of many digits beside the same series in doubles and beside one product of FLINT; bundles. Measured, not asserted."""

import flint
import numpy as np
import pytest

from symfpu import lindstedt, load, save, solve_amplitudes
from symfpu.paper.printed import APPENDIX_F, FIG9_BREATHER, TWO_TORUS
from tests.benchmarks.history import seconds

CASES = [
    pytest.param(TWO_TORUS, 30, 50, id="2-torus of Fig. 1 to order 30, 50 digits"),
    pytest.param(APPENDIX_F[0], 11, 50, id="4-torus N = 32 to order 11, 50 digits"),
    pytest.param(FIG9_BREATHER, 250, 100, id="breather N = 32 to order 250, 100 digits"),
]


def flint_product(series):
    """One polynomial of FLINT with the integers of mode 1's coordinate up to half of the degree, squared.

    The series multiplies such polynomials on every bond of half of the chain: as many monomials, as many bits.
    """
    degree = series.degree(series.order)
    names = [f"{letter}{i}" for i in range(len(series.seeds)) for letter in "zc"]
    context = flint.fmpz_mpoly_ctx.get(names, "lex")
    terms = {}
    rng = np.random.default_rng(1)
    for d in range(1, degree // 2 + 1):
        for row in series.grading.exponents(d).tolist():
            terms[tuple(row)] = flint.fmpz(int.from_bytes(rng.bytes(series.bits // 8), "little"))
    polynomial = context.from_dict(terms)
    return min(seconds(lambda: polynomial * polynomial) for _ in range(3))


@pytest.mark.parametrize(("torus", "order", "digits"), CASES)
def test_series_of_many_digits(benchmark, record, request, torus, order, digits):
    arguments = (torus.chain, torus.seeds, torus.frequencies, order)
    lindstedt(*arguments[:3], 2, digits=digits)  # kernels
    first = seconds(lambda: lindstedt(*arguments, digits=digits))
    series = benchmark.pedantic(lindstedt, arguments, {"digits": digits}, rounds=3, iterations=1)
    taken = benchmark.stats.stats.median
    doubles = min(seconds(lambda: lindstedt(*arguments)) for _ in range(3))
    one = flint_product(series)
    beside = f"{taken / one:.1f} FLINT products of one bond ({one:.3f} s each), {torus.chain.N // 2} bonds"
    note = f"{taken / doubles:.0f} times doubles, the first {first / doubles:.0f}; {beside}"
    record(f"{request.node.callspec.id} ({series.guard_digits} guard digits)", multiply_adds=series.multiply_adds, note=note)


FOUR_TORUS = """
from symfpu.series.lindstedt import lindstedt
from symfpu.paper.printed import APPENDIX_F
t = APPENDIX_F[0]
lindstedt(t.chain, t.seeds, t.frequencies, 11, digits=50)
"""


def test_memory_of_the_four_torus(in_a_process, record):
    _, peak = in_a_process(FOUR_TORUS)
    record("4-torus, 50 digits, in a process of its own", note=f"peak memory {peak:.2f} GB")


@pytest.mark.parametrize("digits", [None, 50])
def test_load_the_four_torus(benchmark, record, tmp_path, digits):
    torus = APPENDIX_F[0]
    series = lindstedt(torus.chain, torus.seeds, torus.frequencies, 11, digits=digits)
    path = save(tmp_path / "torus.symfpu", solve_amplitudes(series))
    benchmark.pedantic(load, (path,), rounds=3, iterations=1)
    record(f"load the 4-torus ({digits or 'doubles'})", note=f"{path.stat().st_size / 1e6:.1f} MB")
