"""Travelling waves on a ring: against standing waves of fixed ends, closed forms, and the resonances of a ring."""

import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from symfpu import Chain, InputError, ResonantDivisor, excitation_sequence, lindstedt, reachable_modes
from symfpu.chain.commensurability import frequencies_cancel
from symfpu.chain.propagation import first_orders
from tests.refusals import each, refused
from tests.tolerances import COEFFICIENT, ROUNDING

LAWS = {
    "alpha": ({"alpha": "0.3"}, 6),
    "beta": ({"beta": "-0.3"}, 4),
    "both": ({"alpha": "-0.3", "beta": "0.2"}, 6),
    "toda": ({"potential": "toda:1/2"}, 6),
    "quintic": ({"potential": "poly:0,0,1/5"}, 6),
}


def ring(N, **law):
    return Chain(N, **law, ends="periodic")


def standing(series, amplitudes, order, angles):
    """Q_q cos(n.theta) of fixed ends by mode and |harmonic|, from waves that share angles in pairs."""
    N = series.chain.N // 2
    harmonics, values = series.harmonic_terms(amplitudes, order)
    found = {}
    for nu, c in zip(harmonics, values[:, 0], strict=True):
        m = int(nu @ np.array(series.seeds))
        if m % (2 * N) == 0:
            assert c == 0
            continue
        b = c * np.sign(np.sin(np.pi * m / (2 * N)))
        q = m % (2 * N)
        q, sign = (q, 0.5) if q < N else (2 * N - q, -0.5)
        n = tuple((nu[0::2] + nu[1::2]).tolist())
        n = max(n, tuple(-x for x in n))
        assert len(n) == angles
        found[q, n] = found.get((q, n), 0.0) + sign * b
    return found


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("N", "seeds", "frequencies"), [(8, (1,), ("0.394",)), (7, (2,), ("0.871",)), (9, (1, 4), ("0.349", "1.29"))])
def test_fixed_ends_are_the_odd_part_of_the_ring_of_twice_the_length(law, N, seeds, frequencies):
    couplings, order = LAWS[law]
    if len(seeds) == 2:
        order = 3 if couplings.keys() != {"beta"} else 1  # order 4: two pairs resonate, see below
    fixed = lindstedt(Chain(N, **couplings), seeds, frequencies, order)
    pairs = [x for q in seeds for x in (q, -q)]
    doubled = [w for w in frequencies for _ in range(2)]
    waves = lindstedt(ring(2 * N, **couplings), pairs, doubled, order)
    A = [0.7, 0.4][: len(seeds)]
    twice = np.repeat(A, 2)
    for k in range(order + 1):
        harmonics, table = fixed.harmonic_terms(A, k)
        found = standing(waves, twice, k, len(seeds))
        size = np.abs(table).max()
        for nu, row in zip(harmonics.tolist(), table, strict=True):
            n = max(tuple(nu), tuple(-x for x in nu))
            expected = [found.pop((q, n), 0.0) for q in range(1, N)]
            assert np.abs(row - expected).max() <= COEFFICIENT * size, (k, nu)
        assert all(abs(v) <= COEFFICIENT * size for v in found.values())
    terms, _ = fixed.frequency_terms(np.square(A))
    of_waves, _ = waves.frequency_terms(np.square(twice))
    assert np.allclose(of_waves[:, 0::2], terms, rtol=0, atol=COEFFICIENT)
    assert np.allclose(of_waves[:, 1::2], terms, rtol=0, atol=COEFFICIENT)


@pytest.mark.parametrize("N", [3, 4, 5, 8])
@pytest.mark.parametrize("q", [1, -1])
def test_one_wave_of_beta_in_closed_form(N, q):
    """omega^2 = Omega^2 (1 + 3 mu |w|^2), and the third harmonic, of wave number 3q modulo N."""
    chain = ring(N, beta="0.4")
    Omega = 2 * abs(np.sin(np.pi * q / N))
    omega = Fraction(Omega).limit_denominator(100) + Fraction(1, 50)
    series = lindstedt(chain, (q,), (omega,), 1)
    assert series.corrections[1].tolist() == [[3.0]]
    third = 2 * np.sin(3 * np.pi * q / N)
    own = float(omega) ** 2 if (3 * q % N) in (q % N, -q % N) else third**2
    expected = -(third**2) / (own - 9 * float(omega) ** 2)
    harmonics, _ = series.grading.harmonics(3)
    assert harmonics[-1] == [3]
    assert np.isclose(series.coordinates[1][-1], expected, rtol=0, atol=ROUNDING)


def test_a_wave_and_its_mirror_image_have_the_same_series():
    right = lindstedt(ring(9, alpha="0.3", beta="0.1"), (2, 3), ("1.29", "1.74"), 5)
    left = lindstedt(ring(9, alpha="0.3", beta="0.1"), (-2, -3), ("1.29", "1.74"), 5)
    for a, b in zip(right.coordinates, left.coordinates, strict=True):
        assert np.array_equal(a, b)


def test_opposite_waves_shift_each_other():
    """Of beta: 3 mu |w|^2 from itself, 6 mu |w|^2 from the other; and different frequencies do no harm."""
    series = lindstedt(ring(11, beta=1), (2, -2), ("1.09", "1.11"), 3)
    assert series.grading.diagonal(2).tolist() == [[0, 1], [1, 0]]
    assert np.allclose(series.corrections[1], [[6, 3], [3, 6]])


# ring, seeds: the least degree of a resonance, the mode that it drives, the harmonic
RESONANCES = [
    (16, (4, -4), 3, 4, (-1, 2)),
    (12, (3, -3), 3, 3, (-1, 2)),
    (16, (1, -1, 7), 3, -7, (1, -1, 1)),
    (12, (2, -2, 4), 3, -4, (1, -1, 1)),
    (16, (2, -2), 7, -2, (4, -3)),
    (15, (1, -1, 2, -2), 5, 1, (-1, 2, 1, -1)),
    (16, (1, 2, 3), None, None, None),
    (16, (3,), None, None, None),
    (16, (8,), None, None, None),
    (16, (1, -2, 5), None, None, None),
]


@pytest.mark.parametrize(("N", "seeds", "degree", "mode", "harmonic"), RESONANCES)
def test_resonances_of_a_ring(N, seeds, degree, mode, harmonic):
    chain = ring(N, beta=1)
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    omega = [Fraction(linear[q]).limit_denominator(10**6) + Fraction(k + 3, 1009) for k, q in enumerate(seeds)]
    if degree is None:
        assert lindstedt(chain, seeds, omega, 3).order == 3
        return
    order = (degree - 1) // 2
    lindstedt(chain, seeds, omega, order - 1)
    with pytest.raises(ResonantDivisor, match="resonance") as caught:
        lindstedt(chain, seeds, omega, order)
    found = caught.value
    assert "\n" not in str(found)
    assert (found.order, abs(found.mode)) == (order, abs(mode))
    assert np.abs(found.harmonic).sum() == degree
    assert (np.array(found.harmonic) @ np.array(seeds) - found.mode) % N == 0
    total = {abs(found.mode): -1}
    for n, q in zip(found.harmonic, seeds, strict=True):
        total[abs(q)] = total.get(abs(q), 0) + n
    assert frequencies_cancel(N, total)
    direction = np.array(found.harmonic) if found.mode == mode else -np.array(found.harmonic)
    assert tuple(direction) == harmonic or degree > 3


PAGE = Path(__file__).parents[2] / "docs/chains.md"
ROWS = re.findall(r"^\| (?:-?\d+, )*-?\d+ \|.*", PAGE.read_text(), re.MULTILINE)
HIGHEST = {1: 10, 2: 8, 3: 5, 4: 3}  # order of beta, by the number of seeds


def resonance_row(seeds):
    chain, count = ring(16, beta=1), HIGHEST[len(seeds)]
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    omega = [Fraction(linear[q]).limit_denominator(10**9) + Fraction(1, 1009 + 4 * k) for k, q in enumerate(seeds)]
    text = ", ".join(map(str, seeds))
    try:
        lindstedt(chain, seeds, omega, count)
    except ResonantDivisor as error:
        found = error
    else:
        return f"| {text} | none to {2 * count + 1} | | | | |"
    assert found.way_out  # one of the ring, not of the chosen frequencies
    degree = 2 * found.order + 1
    return f"| {text} | {degree} | {found.mode} | {found.harmonic} | {found.order} | {degree - 1} |"


@pytest.mark.long
@pytest.mark.parametrize("row", ROWS)
def test_the_table_of_the_page(row):
    assert len(ROWS) > 10
    assert resonance_row(tuple(map(int, row.split("|")[1].split(",")))) == row


def test_chosen_frequencies_that_coincide():
    with pytest.raises(ResonantDivisor, match="change omega_3"):
        lindstedt(ring(16, beta=1), (1, 3), ("0.4", "1.2"), 2)  # 3 omega_1 in mode 3


@pytest.mark.parametrize(
    ("N", "relation", "zero"),
    [
        (6, {1: 2, 3: -1}, True),
        (8, {4: 1, -4: -1}, True),
        (8, {4: 1, 2: -1}, False),
        (30, {3: 1, 9: -1, 5: 1}, True),
        (30, {3: 1, 9: -1, 6: 1}, False),
    ],
)
def test_relations_between_frequencies(N, relation, zero):
    assert frequencies_cancel(N, relation) == zero
    value = sum(n * 2 * np.sin(np.pi * abs(q) / N) for q, n in relation.items())
    assert (abs(value) < ROUNDING * 10) == zero


@each(seeds=[(0,), (9,), (1, 1)], frequencies=[(), ("-1",), None], order=[-1], chain=[3], ring=["symbolic", "residue"], digits=[30])
def test_bad_input(name, value):
    refused(lindstedt, name, value, chain=ring(16, beta=1), seeds=(1,), frequencies=("0.4",), order=1)


def test_a_long_ring_is_fast():
    chain = ring(1024, alpha="0.3")
    omega = ("0.0061365", "0.0122735", "0.01841101", "0.02454907")
    series = lindstedt(chain, (1, 2, 3, 4), omega, 8)
    assert series.multiply_adds < 1e8


RULES = [
    ({"alpha": "0.3"}, 16, (1, -3), 4),
    ({"alpha": "0.3"}, 13, (2,), 7),
    ({"alpha": "0.3", "beta": "0.2"}, 12, (1, 5), 3),
    ({"beta": "-0.3"}, 16, (1, 3), 3),
    ({"beta": "-0.3"}, 11, (-2, 3), 3),
    ({"beta": 1}, 8, (4,), 3),
    ({"potential": "poly:0,1/3,1/5"}, 15, (3, -4), 4),
]


@pytest.mark.parametrize(("law", "N", "seeds", "order"), RULES)
def test_the_rule_of_a_ring_is_the_first_order_of_its_series(law, N, seeds, order):
    """Every mode at the order at which a sum of signed seeds reaches it, and none before."""
    chain = ring(N, **law)
    linear = dict(zip(chain.mode_numbers, chain.frequencies(), strict=True))
    series = lindstedt(chain, seeds, [f"{linear[q] * 1.00137:.9f}" for q in seeds], order)
    excited = []
    for k in range(order + 1):
        harmonics, values = series.harmonic_terms([0.3] * len(seeds), k)
        waves = harmonics[values[:, 0] != 0] @ np.array(seeds) % N
        excited.append({min(q, N - q) for q in waves.tolist()} - {0})
    assert first_orders(excited) == excitation_sequence(N, seeds, order, potential=chain.potential, ends="periodic")


def test_the_rule_of_a_ring_of_twice_the_length_is_that_of_fixed_ends():
    for seeds in ((1,), (3, 5), (2, 7)):
        for model in ("alpha", "beta"):
            pairs = [sign * q for q in seeds for sign in (1, -1)]
            around = reachable_modes(18, pairs, 5, model=model, ends="periodic")
            walls = reachable_modes(9, seeds, 5, model=model)
            assert [tuple(q for q in modes if q != 9) for modes in around] == walls


@pytest.mark.parametrize("seeds", [(0,), (9,), (-8,), (1, 1)])
def test_the_rule_of_a_ring_refuses_what_is_no_seed_of_it(seeds):
    with pytest.raises(InputError, match=r"-7\.\.8 without 0"):
        excitation_sequence(16, seeds, 2, ends="periodic")
    with pytest.raises(InputError, match="'fixed' or 'periodic'"):
        excitation_sequence(16, (1,), 2, ends="round")
