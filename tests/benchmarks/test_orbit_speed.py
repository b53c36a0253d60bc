"""Orbits: energy error against force evaluations beside DOP853 and heyoka, a long run, and the cost of a step by N. Measured, not asserted.

Allowed on one core: 3 s for N = 32 to T = 1e6 with an energy error below 1e-10, 60 s for N = 512; a cost of a step linear in N up to 4096.
"""

import itertools
import time

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from symfpu import Chain, integrate, lindstedt, random_state, solve_amplitudes
from symfpu.dynamics.schemes import SCHEMES
from symfpu.paper.printed import APPENDIX_F

STEPS = {
    "yoshida4": (0.02, 0.05, 0.1, 0.2),
    "aba864": (0.05, 0.1, 0.2, 0.4),
    "blanes_moan6": (0.25, 0.5, 0.8),
    "kahan_li8": (0.2, 0.4, 0.6),
    "aba864_modes": (0.25, 0.5, 1.0, 1.4),
}


@pytest.fixture(scope="module")
def four_torus():
    """The 4-torus of Fig. 2, N = 32, as its initial conditions."""
    case = APPENDIX_F[0]
    torus = solve_amplitudes(lindstedt(case.chain, case.seeds, case.frequencies, 6))
    return case.chain, torus.Q(0.0), torus.P(0.0)


@pytest.mark.parametrize("name", SCHEMES)
def test_energy_error_against_force_evaluations(name, four_torus, benchmark, record):
    T = 1e4
    integrate(*four_torus, 10.0, step=0.1, scheme=name)  # kernels
    made = {}
    benchmark.pedantic(lambda: made.update({h: integrate(*four_torus, T, step=h, scheme=name) for h in STEPS[name]}), rounds=1)
    cases = (f"{SCHEMES[name].stages / h:.0f}: {orbit.energy_error:.1e} in {orbit.seconds:.3f} s" for h, orbit in made.items())
    record(f"{name}, N = 32 to T = 1e4", note=f"force evaluations a unit of time: energy error; {'; '.join(cases)}")


def test_dop853(four_torus, benchmark, record):
    chain, Q, P = four_torus
    n, T, cases = chain.N - 1, 1e3, []

    def run():
        for rtol in (1e-8, 1e-10, 1e-12):
            start = time.perf_counter()
            found = solve_ivp(
                lambda t, y: np.append(y[n:], chain.accelerations(y[:n])), (0, T), np.append(Q, P), "DOP853", rtol=rtol, atol=1e-3 * rtol
            )
            error = abs(float(chain.energy(found.y[:n, -1], found.y[n:, -1]) / chain.energy(Q, P)) - 1)
            cases.append(f"{found.nfev / T:.0f}: {error:.1e} in {time.perf_counter() - start:.2f} s")

    benchmark.pedantic(run, rounds=1)
    record("scipy DOP853, N = 32 to T = 1e3", note="; ".join(cases))


def test_heyoka(four_torus, benchmark, record):
    """Adaptive Taylor series, if it is installed: pip install symfpu[heyoka]. An order of a series costs about one evaluation."""
    heyoka = pytest.importorskip("heyoka")
    chain, Q, P = four_torus
    n, alpha, T, cases = chain.N - 1, float(chain.alpha), 1e4, []
    x, p = (heyoka.make_vars(*(f"{name}{j}" for j in range(n))) for name in "xp")
    stretches = [right - left for left, right in itertools.pairwise([0.0, *x, 0.0])]
    tensions = [r + alpha * r**2 for r in stretches]
    system = [*zip(x, p, strict=True), *((p[j], tensions[j + 1] - tensions[j]) for j in range(n))]
    start = np.concatenate([chain.positions(Q), chain.positions(P)])

    def run():
        for tolerance in (1e-8, 1e-11, np.finfo(float).eps):
            orbit = heyoka.taylor_adaptive(system, start, tol=tolerance, compact_mode=True)
            begun = time.perf_counter()
            steps = orbit.propagate_until(T)[3]
            seconds = time.perf_counter() - begun
            error = abs(float(chain.energy(chain.modes(orbit.state[:n]), chain.modes(orbit.state[n:])) / chain.energy(Q, P)) - 1)
            cases.append(f"{steps * orbit.order / T:.0f}: {error:.1e} in {seconds:.2f} s")

    benchmark.pedantic(run, rounds=1)
    record(f"heyoka {heyoka.__version__}, N = 32 to T = 1e4", note=f"steps times order a unit of time: {'; '.join(cases)}")


@pytest.mark.parametrize(("name", "step"), [("kahan_li8", 0.5), ("aba864_modes", 1.4)])
def test_the_long_run(name, step, four_torus, benchmark, record):
    """Allowed 3 s with an energy error below 1e-10."""
    integrate(*four_torus, 10.0, step=0.1, scheme=name)
    orbit = benchmark.pedantic(integrate, (*four_torus, 1e6), {"step": step, "scheme": name}, rounds=3, iterations=1)
    record(f"{name}, N = 32 to T = 1e6, step {step}", note=f"energy error {orbit.energy_error:.1e}")


@pytest.mark.parametrize("specific", [0.015 / 32, 0.01])
def test_the_long_run_with_all_modes_alive(specific, benchmark, record):
    """Allowed 3 s with an energy error below 1e-10: random modes of equal harmonic energy, H / N as in Fig. 9 and twenty times that."""
    chain, draws = Chain(32, alpha="0.33"), np.random.default_rng(1)
    Q, P = draws.normal(size=31) / chain.frequencies(), draws.normal(size=31)
    scale = brentq(lambda s: float(chain.energy(s * Q, s * P)) - 32 * specific, 0, 0.5)
    integrate(chain, scale * Q, scale * P, 10.0, step=0.1, scheme="blanes_moan6")
    run = {"step": 0.25, "scheme": "blanes_moan6"}
    orbit = benchmark.pedantic(integrate, (chain, scale * Q, scale * P, 1e6), run, rounds=3, iterations=1)
    record(f"blanes_moan6, N = 32 to T = 1e6, step 0.25, H/N = {specific:.2g}", note=f"energy error {orbit.energy_error:.1e}")


def test_the_long_run_of_a_long_chain(benchmark, record):
    """Allowed 60 s; ten low modes of N = 512."""
    chain = Chain(512, alpha="0.33")
    Q = np.where(np.arange(511) < 10, 1.0, 0.0)
    integrate(chain, Q, 0 * Q, 10.0, step=0.1)
    orbit = benchmark.pedantic(integrate, (chain, Q, 0 * Q, 1e6), {"step": 0.5}, rounds=1, iterations=1)
    record("kahan_li8, N = 512 to T = 1e6, step 0.5", note=f"energy error {orbit.energy_error:.1e}")


@pytest.mark.parametrize("N", [32, 128, 512, 1024, 2048, 4096])
def test_cost_of_a_step(N, benchmark, record):
    chain, steps = Chain(N, alpha="0.33"), 2**21 // N
    Q = 1e-3 * np.random.default_rng(1).normal(size=N - 1)
    integrate(chain, Q, 0 * Q, 1.0, step=0.1)
    orbit = benchmark.pedantic(integrate, (chain, Q, 0 * Q, 0.1 * steps), {"step": 0.1, "samples": 1}, rounds=5, iterations=1)
    cost = benchmark.stats.stats.min / steps
    record(f"kahan_li8, N = {N}, a step", note=f"{1e6 * cost:.2f} us, {1e9 * cost / N / orbit.scheme.stages:.2f} ns a particle and kick")


TOGETHER = 64
ROUNDS = 5


def processor_seconds(run):
    start = time.process_time()
    run()
    return time.process_time() - start


@pytest.mark.parametrize("averages", [False, True])
@pytest.mark.parametrize(
    ("chain", "T", "scheme"),
    [
        (Chain(32, alpha="0.33"), 2e3, "kahan_li8"),
        (Chain(32, alpha="0.33", ends="periodic"), 2e3, "kahan_li8"),
        (Chain(128, alpha="0.33"), 500.0, "kahan_li8"),
        (Chain(512, alpha="0.33"), 200.0, "kahan_li8"),
        (Chain(32, potential="toda:0.33"), 500.0, "kahan_li8"),
        (Chain(32, potential="lj"), 200.0, "kahan_li8"),
        (Chain(32, alpha="0.33"), 500.0, "aba864_modes"),
    ],
    ids=["32", "ring", "128", "512", "toda", "lj", "modes"],
)
def test_many_orbits_at_once(chain, T, scheme, averages, benchmark, record):
    """Allowed half of the time of as many orbits one by one, N = 32; both in turns."""
    drawn = [random_state(chain, "0.01", seed) for seed in range(TOGETHER)]
    Q, P = (np.array(part) for part in zip(*drawn, strict=True))
    run = {"step": 0.25, "scheme": scheme, "averages": averages}

    def alone():
        integrate(chain, Q[0], P[0], T, **run)

    def together():
        integrate(chain, Q, P, T, **run)

    alone(), together()
    pairs = [(processor_seconds(alone), processor_seconds(together)) for _ in range(ROUNDS)]
    one, many = map(min, zip(*pairs, strict=True))
    benchmark.pedantic(together, rounds=1, iterations=1)
    record(
        f"{TOGETHER} orbits, {chain}, {scheme}, T = {T:g}{', averages' if averages else ''}",
        note=f"{TOGETHER * one / many:.2f} times the rate of one",
    )
