"""Every number that the package gives of a Toda chain, held against its spectral curve: the tests (a) to (f) of an exact judge."""

import math
from itertools import combinations

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, alignment_indices, floquet, lindstedt, refine, solve_amplitudes, toda, toda_gaps, toda_torus
from tests.tolerances import EPS, FLOQUET_PHASE, ROUNDING, TODA_RATE, TWENTY_DIGITS

# seeds and actions at unit scale; the last column has the scales of actions at which errors are taken
CASES = [
    (8, (1,), (1.0,), (0.05, 0.1), range(2, 13)),
    pytest.param(8, (1, 3), (1.0, 0.5), (0.05, 0.1), range(2, 13), marks=pytest.mark.long),
    pytest.param(8, (1, 2, 3, 4), (1.0, 0.5, 0.3, 0.2), (0.04, 0.06), range(2, 13), marks=pytest.mark.long),
    pytest.param(16, (1, 2, 3, 4), (1.0, 0.5, 0.3, 0.2), (0.025, 0.05), range(2, 9), marks=pytest.mark.long),
]


def scaled(N, seeds, actions, scale):
    """The exact torus with the actions times scale^2, and its frequencies in decimals."""
    chain = Chain(N, potential=toda("1/2"))
    exact = toda_torus(chain, seeds, actions=[action * scale**2 for action in actions], digits=30)
    return chain, exact, [mpmath.nstr(w, 28) for w in exact.frequencies.values()]


def energy_errors(N, seeds, actions, scale, orders):
    """By order of the frequency series, how far the energy of its torus is from the exact one."""
    chain, exact, frequencies = scaled(N, seeds, actions, scale)
    series = lindstedt(chain, seeds, frequencies, order=max(orders))
    tori = [solve_amplitudes(series, frequency_order=K) for K in orders]
    return [abs(float(torus.energy()) - float(exact.energy)) for torus in tori]


@pytest.mark.parametrize(("N", "seeds", "actions", "scales", "orders"), CASES)
def test_errors_fall_with_the_order(N, seeds, actions, scales, orders):
    """(a) Frequencies cut after order K leave A^2 off by A^(K+2), K even (odd orders are empty), and so the energy."""
    small, large = (energy_errors(N, seeds, actions, scale, orders) for scale in scales)
    for K, near, far in zip(orders, small, large, strict=True):
        power = math.log(far / near) / math.log(scales[1] / scales[0])
        assert abs(power - (K + 2 - K % 2)) < TODA_RATE * (K + 2), K
        assert near < far


@pytest.mark.parametrize(
    ("N", "seeds", "frequencies"),
    [pytest.param(16, (1, 2), ("0.19626", "0.39046"), marks=pytest.mark.long), (8, (3,), ("1.13",)), (7, (2, 5), ("0.88", "1.83"))],
)
def test_refined_tori_have_no_other_gap(N, seeds, frequencies):
    """(b) All gaps but those of the seeds are closed to the rounding of the state, and the energy is the exact one."""
    chain = Chain(N, potential=toda("0.33"))
    torus = refine(solve_amplitudes(lindstedt(chain, seeds, frequencies, order=12)))
    gaps = np.asarray(toda_gaps(chain, *torus.state()))
    others = [q for q in range(1, N) if q not in seeds]
    assert gaps[[q - 1 for q in seeds]].min() > math.sqrt(EPS)
    assert gaps[[q - 1 for q in others]].max() < ROUNDING
    exact = toda_torus(chain, seeds, frequencies=frequencies)
    assert float(torus.energy()) == pytest.approx(float(exact.energy), rel=ROUNDING)


@pytest.mark.parametrize(("seeds", "actions", "order"), [((1,), (1.0,), 22), pytest.param((2, 3), (1.0, 0.7), 16, marks=pytest.mark.long)])
def test_twenty_digits_of_the_energy(seeds, actions, order):
    """(c) Series in fixed-point numbers and quadrature on the curve: two routes to twenty digits."""
    chain, exact, frequencies = scaled(8, seeds, actions, 0.02)
    torus = solve_amplitudes(lindstedt(chain, seeds, frequencies, order=order, digits=35))
    assert abs(torus.energy() / exact.energy - 1) < TWENTY_DIGITS


@pytest.mark.parametrize("N", [5, 6, 8])
def test_modes_are_excited_as_in_the_fpu_chain(N):
    """(d) Integrability takes no mode out of D_k, for generic frequencies, ..."""
    for seeds in [*combinations(range(1, N), 1), *combinations(range(1, N), 2)]:
        series = lindstedt(Chain(N, potential=toda(1)), seeds, order=3, ring="nested")
        orders = [{int(q) + 1 for q in np.flatnonzero(np.asarray(table.nonzero).any(axis=0))} for table in series.coordinates]
        seen: set[int] = set()
        for k, modes in enumerate(symfpu.excitation_sequence(N, seeds, 3)):
            assert orders[k] - seen == set(modes)
            seen |= orders[k]


@pytest.mark.parametrize(("N", "seeds"), [(16, (1, 2)), (16, (3, 5)), (9, (4, 6))])
def test_the_lowest_shift_is_of_each_seed_alone(N, seeds):
    """(d) ... but at the linear frequencies no seed shifts another at second order, as it does in the FPU chain; at fourth it does."""
    linear = Chain(N, alpha=1).frequencies()
    at = {}
    for name, chain in (("alpha", Chain(N, alpha="1/2")), ("toda", Chain(N, potential=toda("1/2")))):
        universal = lindstedt(chain, seeds, order=4, ring="nested")
        at[name] = universal.at(frequencies=[repr(float(linear[q - 1])) for q in seeds]).corrections
    cross = {name: np.abs(np.diag(np.asarray(tables[2]))).max() for name, tables in at.items()}  # |w_2|^2 stands first
    own = np.abs(np.asarray(at["toda"][2])).max()
    assert cross["toda"] < ROUNDING * own < cross["alpha"]
    assert np.abs(np.asarray(at["toda"][4])[1]).min() > 1


@pytest.mark.parametrize(("N", "seed", "omega"), [(8, 1, "0.392"), (7, 3, "1.26"), (8, 6, "1.87")])
def test_breathers_are_stable_with_the_normal_frequencies_of_the_curve(N, seed, omega):
    """(e) Multipliers on the circle, at the angles sigma T of the closed gaps."""
    chain = Chain(N, potential=toda("1/2"))
    multipliers = np.asarray(floquet(symfpu.torus(chain, (seed,), frequencies=(omega,))).multipliers)
    assert np.abs(np.abs(multipliers) - 1).max() < ROUNDING
    curve = toda_torus(chain, (seed,), frequencies=(omega,), digits=20)
    period = 2 * math.pi / float(omega)
    for sigma in curve.normal_frequencies.values():
        angle = np.exp(1j * float(sigma) * period)
        assert np.abs(multipliers - angle).min() < FLOQUET_PHASE


@pytest.mark.long
@pytest.mark.parametrize(
    ("seeds", "actions", "time"), [((1, 2), (0.3, 0.2), 1e5), ((2,), (0.5,), 1e6), ((), (), 1e6)], ids=["two", "one", "all"]
)
def test_alignment_indices_count_the_open_gaps(seeds, actions, time):
    """(f) s for a torus with s open gaps, N - 1 for a state with all of them."""
    chain = Chain(5, potential=toda(1))
    state = np.array([0.5, 0.3, -0.2, 0.25]), np.array([0.1, -0.2, 0.3, 0.1])
    if seeds:
        state = tuple(np.asarray(part, dtype=float) for part in toda_torus(chain, seeds, actions=actions).state())
    opened = int((np.asarray(toda_gaps(chain, *state)) > math.sqrt(EPS)).sum())
    assert opened == (len(seeds) or 4)
    found = alignment_indices(chain, *state, time, frames=1).dimension()
    assert (found.verdict, found.value) == (f"regular, dimension {opened}", opened)
