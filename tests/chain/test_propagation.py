"""The propagation rule: the examples of the paper's section 5, and Eq. app over all sign vectors."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symfpu.chain.propagation import coupling_sequence, excitation_sequence, reachable_modes
from symfpu.errors import InputError

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


@given(chains(most_seeds=6, most_bonds=80), st.sampled_from(["alpha", "beta"]), st.integers(0, 12))
def test_modes_are_plain_ascending_integers_of_the_chain(chain, model, order):
    N, seeds = chain
    for modes in (*reachable_modes(N, seeds, order, model=model), *excitation_sequence(N, seeds, order, model=model)):
        assert list(modes) == sorted(set(modes))
        assert all(type(q) is int and 0 < q < N for q in modes)


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


@given(st.integers(2, 100), st.data())
def test_even_breathers_excite_even_modes_and_odd_ones_odd_modes_in_beta(N, data):
    q0 = data.draw(st.integers(1, N - 1))
    for model in ("beta", "alpha") if q0 % 2 == 0 else ("beta",):
        assert all((q - q0) % 2 == 0 for modes in excitation_sequence(N, [q0], 10, model=model) for q in modes)


@given(st.integers(2, 100), st.data())
def test_odd_breathers_excite_both_parities_in_alpha(N, data):
    q0 = data.draw(st.integers(1, N - 1).filter(lambda q: q % 2))
    modes = [q for modes in excitation_sequence(N, [q0], 2 * N, model="alpha") for q in modes]
    if modes != [q0]:
        assert {q % 2 for q in modes} == {0, 1}


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


@pytest.mark.parametrize("model", ["alpha", "beta"])
@pytest.mark.parametrize(("multiple", "divisor"), [(1, 2), (2, 3)])
def test_symmetric_modes_stay_alone(model, multiple, divisor):
    """Example v: N/2 and 2N/3 in both models."""
    for N in (divisor * n for n in range(1, 30)):
        if N > 1:
            seed = multiple * N // divisor
            assert excitation_sequence(N, [seed], 12, model=model) == [(seed,)] + [()] * 12


def test_one_third_stays_alone_in_beta_and_excites_two_thirds_in_alpha():
    for N in range(3, 91, 3):
        assert excitation_sequence(N, [N // 3], 12, model="beta") == [(N // 3,)] + [()] * 12
        assert excitation_sequence(N, [N // 3], 12, model="alpha") == [(N // 3,), (2 * N // 3,)] + [()] * 11


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ((1, (1,), 2), "N"),
        ((8, (), 2), "seeds"),
        ((8, (1, 1), 2), "seeds"),
        ((8, (8,), 2), "seeds"),
        ((8, (1,), -1), "order"),
        ((8, (1,), 1.5), "order"),
    ],
)
def test_bad_arguments_are_refused_by_name(arguments, named):
    for rule in (excitation_sequence, reachable_modes):
        with pytest.raises(InputError) as caught:
            rule(*arguments)
        assert caught.value.argument == named


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
