"""The twist at rest: its closed form, its signature for every chain, and where it is definite."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symfpu import Chain, InputError, actions, frequency_shift, lindstedt, solve_amplitudes, twist_at_rest
from symfpu.action_angle.at_rest import definite_range
from tests.tolerances import NEXT_ORDER_OF_ACTIONS, RANGE_END, ROUNDING


@st.composite
def packets(draw):
    N = draw(st.integers(2, 14))
    modes = draw(st.sets(st.integers(1, N - 1), min_size=1))
    return N, tuple(sorted(modes))


@settings(max_examples=10, deadline=None)
@given(packets(), st.integers(-6, 6), st.integers(-6, 6).filter(bool))
def test_the_shift_of_the_frequencies(packet, alpha, beta):
    N, seeds = packet
    chain = Chain(N, alpha=alpha, beta=beta)
    found = twist_at_rest(chain, seeds).matrix
    linear = chain.frequencies()[np.array(seeds) - 1]
    for column, n in enumerate(seeds):
        one = dict.fromkeys(seeds, 0.0) | {n: 1.0}
        shifts = frequency_shift(chain, one)
        expected = [shifts[q] * 2 / linear[column] for q in seeds]
        assert found[:, column] == pytest.approx(expected, abs=ROUNDING * max(1, alpha**2 + abs(beta)))


@settings(max_examples=10, deadline=None)
@given(packets())
def test_the_signature_of_the_beta_chain(packet):
    """p + 1 positive and s - p - 1 negative eigenvalues, p pairs q + n = N."""
    N, seeds = packet
    pairs = sum(N - q in seeds for q in seeds if 2 * q < N)
    expected = (pairs + 1, len(seeds) - pairs - 1, 0)
    assert twist_at_rest(Chain(N, beta=2), seeds).signature == expected
    assert twist_at_rest(Chain(N, beta=-2), seeds).signature == (expected[1], expected[0], 0)


def test_exact_zeros():
    """beta/alpha^2 = -2/9 and Omega = 1; the middle mode without beta; two of three at once."""
    assert twist_at_rest(Chain(12, alpha=3, beta=-2), (4,)).signature == (0, 0, 1)
    assert twist_at_rest(Chain(12, alpha=3, beta=-2), (4, 8)).signature == (1, 1, 0)
    assert twist_at_rest(Chain(2, alpha=1)).signature == (0, 0, 1)


@settings(max_examples=10, deadline=None)
@given(packets(), st.fractions(-3, 3, max_denominator=7))
def test_the_signature_is_that_of_the_eigenvalues(packet, ratio):
    """Where doubles tell their signs."""
    N, seeds = packet
    chain = Chain(N, alpha=1, beta=ratio)
    found = twist_at_rest(chain, seeds)
    values = np.linalg.eigvalsh(found.matrix)
    clear = np.abs(values) > ROUNDING
    if clear.all():
        assert found.signature == ((values > 0).sum(), (values < 0).sum(), 0)


def test_the_range_of_two_neighbours():
    """Ends are 2/3 - 2/(3g), g the eigenvalues of a 2 x 2 matrix."""
    a, b = (2 * np.sin(np.pi * q / 64) for q in (1, 2))
    mean, root = 3 / 8 * (a**2 + b**2), np.sqrt((3 / 8 * (a**2 - b**2)) ** 2 + (a * b) ** 2)
    expected = [2 / 3 - 2 / (3 * (mean + root)), 2 / 3 - 2 / (3 * (mean - root))]
    assert definite_range(32, (1, 2)) == pytest.approx(expected, abs=RANGE_END)
    inside, outside = (twist_at_rest(Chain(32, alpha=1, beta=b), (1, 2)).definiteness for b in (-15, -17))
    assert (inside, outside) == ("positive definite", "indefinite (1 positive, 1 negative)")


def test_a_linear_chain_is_refused():
    with pytest.raises(InputError, match="birkhoff_form"):
        twist_at_rest(Chain(8, potential="poly:0,0,1"))


def published_hessian(N, alpha, beta, modes):
    """Of odd periodic chains at rest, in our units: Henrici and Kappeler, arXiv:nlin/0611063, Theorem 1.1.

    Theirs is V = x^2/2 - alpha' x^3/3! + beta' x^4/4!, so that alpha'^2 = 4 alpha^2 and beta' = 6 beta, and
    H_4 = 1/(4N) sum (alpha'^2 + g s_k^2) I_k^2 + g/(2N) sum_(l != m) s_l s_m I_l I_m, g = beta' - alpha'^2, s_k = |sin k pi/N|.
    """
    squared = 4 * alpha**2
    g, s = 6 * beta - squared, np.abs(np.sin(np.pi * np.array(modes) / N))
    return (g * np.outer(s, s) + np.diag((squared - g * s**2) / 2)) / N


@pytest.mark.parametrize(("alpha", "beta"), [(0.3, 0.0), (0.0, 0.5), (0.3, 0.2)])
@pytest.mark.parametrize(("N", "modes"), [(5, (1, 2)), (7, (1, -1)), (9, (2, -3)), (11, (1, 2, -2))])
def test_waves_of_rings_have_the_published_hessian(N, modes, alpha, beta):
    """Frequencies by their normal form, actions by our series: what is left falls with the actions."""
    chain = Chain(N, alpha=str(alpha), beta=str(beta), ends="periodic")
    linear = 2 * np.abs(np.sin(np.pi * np.array(modes) / N))
    for size in (1e-3, 1e-4):
        wanted = size * np.arange(1.0, len(modes) + 1)
        omega = linear + published_hessian(N, alpha, beta, modes) @ wanted
        series = lindstedt(chain, modes, tuple(f"{w:.17f}" for w in omega), 2)
        found = actions(solve_amplitudes(series))
        assert [float(found[q]) for q in modes] == pytest.approx(wanted, rel=NEXT_ORDER_OF_ACTIONS * size)


@pytest.mark.parametrize(("alpha", "beta"), [(0.3, 0.0), (0.0, 0.5), (0.3, 0.2)])
@pytest.mark.parametrize(("N", "modes"), [(7, (1, 2, 4)), (8, (1, 2, 3)), (32, (3, 9, 30, 31))])
def test_fixed_ends_are_the_published_form_folded(N, modes, alpha, beta):
    """A standing wave is two waves of its action each, and the ring of 2N bonds has twice the energy: Lambda_(q,n) + Lambda_(q,-n).

    The formula is theirs of odd rings; in the even ring of 2N it holds where no two modes add up to N.
    """
    ring = published_hessian(2 * N, alpha, beta, (*modes, *(-q for q in modes)))
    half = len(modes)
    folded = ring[:half, :half] + ring[:half, half:]
    found = twist_at_rest(Chain(N, alpha=str(alpha), beta=str(beta)), modes)
    assert found.matrix == pytest.approx(folded, rel=ROUNDING)
