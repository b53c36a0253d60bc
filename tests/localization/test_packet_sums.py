"""Energies of packets by sums over all products of seeds: against tori, the derived laws of long chains, and counting."""

import math

import numpy as np
import pytest
import symengine as se

import symfpu
from symfpu import Chain, InputError, breather_law, middle_modes, packet_energies, packet_groups, packet_parameter
from symfpu.localization.packet_sums import check_keys, packet_products, product_count
from tests.tolerances import EIGHT_DIGITS, LEADING_ORDER_SLACK, NEXT_IN_LENGTH, THOUSAND_ROUNDINGS

ALPHA, BETA, BOTH = Chain(16, alpha="0.33"), Chain(20, beta="0.3"), Chain(16, alpha="0.3", beta="0.2")


def _distance(chain, s, order, epsilon):
    """Largest relative difference from the torus of the series, over all modes of D_1 .. D_order."""
    torus = symfpu.torus(chain, range(1, s + 1), energy=epsilon * chain.N, method="series", order=order)
    spectrum = torus.average_spectrum()
    modes = [q for group in packet_groups(chain, s)[1 : order + 1] for q in group]
    modes = [q for q in modes if q + (order * chain.degree_step + 1) * s < 2 * chain.N]
    share = spectrum[:s].mean() * s / chain.N  # of the seeds alone
    return np.abs(spectrum[np.array(modes) - 1] / packet_energies(chain, s, share, modes) - 1).max()


@pytest.mark.parametrize(
    ("chain", "s", "order"),
    [
        (ALPHA, 3, 2),
        pytest.param(ALPHA, 3, 3, marks=pytest.mark.long),
        (BETA, 3, 2),
        pytest.param(BOTH, 2, 4, marks=pytest.mark.long),
        pytest.param(BETA, 2, 3, marks=pytest.mark.long),  # opposite factors of different products meet
        pytest.param(Chain(40, alpha="0.33"), 8, 3, marks=pytest.mark.long),
    ],
)
def test_tori_of_small_energy_have_these_energies(chain, s, order):
    """By another route, for every mode of the groups: the difference is of first order in the energy."""
    near, nearer = (_distance(chain, s, order, epsilon) for epsilon in (1e-7, 1e-8))
    assert near < LEADING_ORDER_SLACK
    assert nearer < near / 5


@pytest.mark.parametrize(
    ("kind", "s", "k"),
    [
        ("alpha", 3, 1),
        ("beta", 1, 2),
        pytest.param("alpha", 2, 2, marks=pytest.mark.long),
        pytest.param("beta", 2, 1, marks=pytest.mark.long),
    ],
)
def test_long_chains_have_the_derived_factor(kind, s, k):
    """The formula in N, with two powers of 1/N^2, leaves the third."""
    formula = symfpu.asymptotic_group_energy(Chain("N", **{kind: 1}), s, k)
    left = []
    for N in (128, 256):
        chain = Chain(N, **{kind: 1})
        expected = float(formula.subs({se.Symbol("N"): N, se.Symbol("epsilon"): 1}))
        found = packet_energies(chain, s, 1.0)[k - 1]
        left.append(found / expected - 1)
    assert left[0] / left[1] == pytest.approx(16, rel=NEXT_IN_LENGTH)


def test_one_seed_is_the_law_of_breathers():
    chain = Chain(2048, alpha="0.25")
    energy = 1e-9
    found = packet_energies(chain, 1, energy / chain.N, [2, 3, 4])
    assert found == pytest.approx(breather_law(chain, energy)[1:4], rel=NEXT_IN_LENGTH)
    assert packet_energies(Chain(9, beta=1), 1, 1e-3, [2, 3, 4])[[0, 2]].tolist() == [0.0, 0.0]  # even modes


@pytest.mark.parametrize("kind", ["alpha", "beta"])
def test_longer_chains_differ_by_one_over_the_width(kind):
    """At fixed M and eps the factor has a limit: its steps halve as N doubles. So E_q/eps does not depend on N in the end."""
    factors = []
    for N in (256, 512, 1024):
        chain, s = Chain(N, **{kind: 1}), N // 16
        unit = packet_parameter(chain, s, 1.0) ** chain.degree_step * N / s
        factors.append(packet_energies(chain, s, 1.0, [middle_modes(chain, s)[0]])[0] / unit)
    first, second = np.diff(factors)
    assert 1.5 < first / second < 2.5


def test_threads_add_up_to_the_same():
    chain, modes = Chain(512, beta="0.3"), [130, 192]
    assert packet_energies(chain, 32, 1e-6, modes).tolist() == packet_energies(chain, 32, 1e-6, modes, workers=3).tolist()


def test_wide_packets_of_the_third_group():
    """Against sums by arrays of all signs at once, the route before compiled loops, two minutes for this mode, 6s."""
    found = packet_energies(Chain(1024, beta="0.3"), 64, 1.5625e-6, [384])
    assert found == pytest.approx([7.9710615e-36], rel=EIGHT_DIGITS)


def test_harmonics_without_a_number_are_refused():
    """Nine factors of 62 seeds have one in 64 bits, of 63 none."""
    check_keys(62, 9, 621)
    with pytest.raises(InputError, match="64 bits"):
        check_keys(63, 9, 631)


def test_energies_go_with_powers_of_the_energy():
    modes = middle_modes(BETA, 2)[:2]
    ratio = packet_energies(BETA, 2, 2e-4, modes) / packet_energies(BETA, 2, 1e-4, modes)
    assert ratio == pytest.approx([2**3, 2**5], rel=THOUSAND_ROUNDINGS)


@pytest.mark.parametrize(("s", "degree", "q"), [(5, 3, 6), (5, 3, 10), (7, 5, 15), (7, 5, 28), (4, 4, 14), (1, 3, 2), (1, 3, 3)])
def test_products_are_counted_and_make_up_the_mode(s, degree, q):
    total, seen = 0, set()
    for rows, turned in packet_products(s, degree, q):
        total += len(rows)
        assert rows.min() >= 1
        assert rows.max() <= s
        assert (rows.sum(axis=1) - 2 * turned * rows[:, -1] == q).all()
        seen |= {tuple(sorted(row)) for row in rows.tolist()}
    assert total == len(seen) == product_count(s, degree, q)


def test_a_run_tells_its_modes():
    heard = []
    packet_energies(ALPHA, 3, 1e-6, [5, 8], progress=lambda label, fraction: heard.append((label, fraction)))
    assert [label for label, _ in heard] == sorted(label for label, _ in heard)
    assert heard[0] == ("mode 5", 0.0)
    assert dict(reversed(heard))["mode 8"] == 0.5
    assert [fraction for _, fraction in heard] == sorted(fraction for _, fraction in heard)
    assert heard[-1][1] < 1
    assert packet_energies(Chain(2, alpha=1), 1, 1e-6).shape == (0,)


REFUSED = {
    "a seed": lambda: packet_energies(ALPHA, 3, 1e-6, [3]),
    "a mode that folded sums reach": lambda: packet_energies(ALPHA, 10, 1e-6, [15]),
    "no energy": lambda: packet_energies(ALPHA, 3, 0.0),
    "no number": lambda: packet_energies(ALPHA, 3, math.nan),
    "a ring": lambda: packet_energies(Chain(16, alpha=1, ends="periodic"), 3, 1e-6),
    "an hour of work": lambda: packet_energies(Chain(4096, beta=1), 512, 1e-6, [3072]),
    "no workers": lambda: packet_energies(ALPHA, 3, 1e-6, workers=0),
    "no chain": lambda: packet_energies("chain", 3, 1e-6),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_it_cannot_sum_is_refused(case):
    with pytest.raises(InputError):
        REFUSED[case]()
