"""The propagation rule: the examples of the paper's section 5, and Eq. app over all sign vectors."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symfpu import InputError, coupling_sequence, excitation_sequence, reachable_modes
from symfpu.chain import propagation
from symfpu.chain.propagation import carried_modes
from tests.refusals import each, refused

LENGTH = {"alpha": lambda k: k + 1, "beta": lambda k: 2 * k + 1, "alpha+beta": lambda k: k + 1}


def folded(total, N):
    """|2 [(|total| + N - 1) / 2N] N - |total||, as printed in Eqs. app and qbre."""
    return abs(2 * int((abs(total) + N - 1) / (2 * N)) * N - abs(total))


def literal_modes(N, seeds, r):
    """M_k of Eq. app: every sign vector with every r-tuple of seeds."""
    sums = {
        sum(s * q for s, q in zip(signs, modes, strict=True)) for signs in product((1, -1), repeat=r) for modes in product(seeds, repeat=r)
    }
    return tuple(sorted({folded(total, N) for total in sums} - {0, N}))


@st.composite
def chains(draw, most_seeds=3, most_bonds=14):
    N = draw(st.integers(2, most_bonds))
    seeds = draw(st.lists(st.integers(1, N - 1), min_size=1, max_size=min(most_seeds, N - 1), unique=True))
    return N, tuple(sorted(seeds))


@given(chains(), st.sampled_from(["alpha", "beta", "alpha+beta"]))
def test_reachable_modes_are_those_of_all_sign_vectors(chain, model):
    N, seeds = chain
    orders = 2 if model == "beta" else 4
    expected = [literal_modes(N, seeds, LENGTH[model](k)) for k in range(orders + 1)]
    assert reachable_modes(N, seeds, orders, model=model) == expected


@given(chains(most_seeds=4, most_bonds=60), st.sampled_from(["alpha", "beta"]))
def test_the_sequence_takes_each_reachable_mode_once_where_it_first_appears(chain, model):
    N, seeds = chain
    reached, sequence = (rule(N, seeds, 9, model=model) for rule in (reachable_modes, excitation_sequence))
    assert len(sequence) == 10
    assert sequence[0] == seeds
    seen = set()
    for modes, new in zip(reached, sequence, strict=True):
        assert set(new) == set(modes) - seen
        seen |= set(modes)


@given(chains(most_seeds=4, most_bonds=60))
def test_beta_reaches_at_order_k_what_alpha_reaches_at_2k(chain):
    """M^beta_k = M^alpha_2k (end of section 5)."""
    assert reachable_modes(*chain, 4, model="beta") == reachable_modes(*chain, 8, model="alpha")[::2]


@given(st.integers(2, 200), st.data(), st.sampled_from(["alpha", "beta"]))
def test_breathers_excite_one_mode_an_order(N, data, model):
    """Example i, Eq. qbre."""
    q0 = data.draw(st.integers(1, N - 1))
    modes = [folded(LENGTH[model](k) * q0, N) for k in range(16)]
    expected = [(q,) if 0 < q < N and q not in modes[:k] else () for k, q in enumerate(modes)]
    assert excitation_sequence(N, [q0], 15, model=model) == expected


def test_seeds_3_and_5():
    """Example ii; M_1 and M_2 are printed, the seeds 3 and 5 excepted from M_1: they are no sums of two seeds."""
    assert excitation_sequence(64, (3, 5), 2) == [(3, 5), (2, 6, 8, 10), (1, 7, 9, 11, 13, 15)]
    assert reachable_modes(64, (3, 5), 2) == [(3, 5), (2, 6, 8, 10), (1, 3, 5, 7, 9, 11, 13, 15)]


@given(st.integers(2, 6), st.integers(1, 5), st.integers(0, 30))
def test_low_frequency_packets_excite_packets(s, k, more):
    """Example iii, both models; with s = 1 the printed range for beta would name modes of the wrong parity."""
    N = (2 * k + 1) * s + 1 + more
    seeds = range(1, s + 1)
    assert excitation_sequence(N, seeds, k, model="alpha")[k] == tuple(range(k * s + 1, (k + 1) * s + 1))
    assert excitation_sequence(N, seeds, k, model="beta")[k] == tuple(range((2 * k - 1) * s + 1, (2 * k + 1) * s + 1))


@given(st.integers(2, 6), st.integers(1, 5), st.integers(0, 30))
def test_high_frequency_packets_excite_packets_at_either_end(s, k, more):
    """Example iv for alpha, s > 1, and beta as D^beta_k = D^alpha_2k says; the formula printed for beta has (k + 1) for (2k + 1)."""
    N = 2 * (2 * k + 1) * s + 1 + more
    seeds = range(N - s, N)
    alpha = excitation_sequence(N, seeds, 2 * k, model="alpha")
    for order, modes in enumerate(alpha[1:], 1):
        low, high = ((order - 1) * s, (order + 1) * s) if order % 2 else (N - 1 - (order + 1) * s, N - 1 - (order - 1) * s)
        assert modes == tuple(range(low + 1, high + 1))
    assert excitation_sequence(N, seeds, k, model="beta")[k] == alpha[2 * k]


@each(N=[1], seeds=[(), (1, 1), (8,)], order=[-1, 1.5])
@pytest.mark.parametrize("rule", [excitation_sequence, reachable_modes])
def test_bad_arguments_are_refused_by_name(rule, name, value):
    refused(rule, name, value, N=8, seeds=(1,), order=2)


def test_unknown_models_are_refused():
    with pytest.raises(InputError, match="model"):
        excitation_sequence(8, (1,), 2, model="gamma")


@given(chains(), st.sampled_from(["toda:1/2", "lj:12,6", "poly:1,2"]))
def test_potentials_with_squares_follow_alpha_and_even_ones_beta(chain, potential):
    assert excitation_sequence(*chain, 4, potential=potential) == excitation_sequence(*chain, 4, model="alpha")
    assert excitation_sequence(*chain, 2, potential="poly:0,1,0,3") == excitation_sequence(*chain, 2, model="beta")


@given(chains(), st.sampled_from(["poly:0,1,1", "poly:0,0,1", "poly:0,0,0,1"]))
def test_orders_that_no_powers_make_are_empty_and_the_others_those_of_their_degree(chain, potential):
    """Of c_4 and c_5 orders 2, 3, 4, ..; of c_5 alone 3, 6, ..; of c_6, where V is even, 2, 4, .."""
    made = {"poly:0,1,1": {0, 2, 3, 4, 5}, "poly:0,0,1": {0, 3}, "poly:0,0,0,1": {0, 2, 4}}[potential]
    model = "beta" if potential == "poly:0,0,0,1" else "alpha"
    every = reachable_modes(*chain, 5, model=model)
    expected = [modes if k in made else () for k, modes in enumerate(every)]
    assert reachable_modes(*chain, 5, potential=potential) == expected


@given(chains(most_bonds=10), st.sampled_from(["toda:1", "poly:0,1,0,1", "poly:0,1,1", "poly:0,0,1", "poly:0,0,0,0,0,1"]))
def test_couplings_let_a_mode_in_no_earlier_than_sums_do(chain, potential):
    """With squares neither earlier nor later."""
    sequences = [rule(*chain, 3, potential=potential) for rule in (excitation_sequence, coupling_sequence)]
    by_sums, by_couplings = ({q: k for k, modes in enumerate(found) for q in modes} for found in sequences)
    assert by_couplings.keys() <= by_sums.keys()
    assert all(by_sums[q] <= k for q, k in by_couplings.items())
    if potential == "toda:1":
        assert by_couplings == by_sums


def test_model_and_potential_are_not_both_taken():
    for rule in (excitation_sequence, reachable_modes, coupling_sequence):
        with pytest.raises(InputError, match=r"^model = "):
            rule(8, (1,), 2, model="alpha", potential="toda:1")
        with pytest.raises(InputError, match=r"^potential = "):
            rule(8, (1,), 2, potential=1)


@given(chains(most_seeds=2, most_bonds=12), st.sampled_from(sorted(LENGTH)))
def test_carried_modes_are_those_of_all_products_of_cosines(chain, model):
    """A product of so many factors of each seed, with every sign in time and every sign in space."""
    N, seeds = chain
    least = 2 if model != "beta" else 3
    found = set()
    for r in range(1, 2 * N + 4):
        if model == "beta" and r % 2 == 0:
            continue
        for first in range(r + 1) if len(seeds) == 2 else (r,):
            factors = (first, r - first)[: len(seeds)]
            if max(factors) > 2 * N:
                continue
            spans = [range(-k, k + 1, 2) for k in factors]
            waves = {sum(j * q for j, q in zip(js, seeds, strict=True)) for js in product(*spans)}
            harmonics = [nu for nu in product(*spans) if sum(map(abs, nu)) <= least]
            found |= {(nu, folded(wave, N)) for nu in harmonics for wave in waves}
    harmonics = sorted({nu for nu, _ in found})
    mask = carried_modes(N, seeds, harmonics, even=model == "beta")
    expected = {(nu, q) for nu, q in found if 0 < q < N}
    assert {(harmonics[i], int(q) + 1) for i, q in zip(*mask.nonzero(), strict=True)} == expected


@pytest.mark.parametrize("ends", ["fixed", "periodic"])
@pytest.mark.parametrize("law", ["poly:1", "poly:0,1", "poly:0,1,1", "poly:0,0,0,1", "toda:1"])
def test_a_mode_is_listed_at_the_first_order_that_reaches_it(law, ends):
    """Orders without terms, where c_3 = 0, put it off."""
    sets = reachable_modes(15, (2, 5), 8, potential=law, ends=ends)
    assert excitation_sequence(15, (2, 5), 8, potential=law, ends=ends) == propagation.first_orders(sets)


def test_new_sums_of_a_long_chain_come_from_new_ones_alone(monkeypatch):
    folded = []
    monkeypatch.setattr(propagation, "_folded", lambda total, turn: folded.append(total) or min(total % turn, -total % turn))
    excitation_sequence(10**4, (3, 5), 500)
    assert len(folded) < 100 * 500  # all sums anew would be 500 times as many as orders
