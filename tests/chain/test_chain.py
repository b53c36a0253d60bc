"""The chain: transform, couplings, energies and expressions against sums over particles and bonds."""

from dataclasses import replace
from fractions import Fraction
from itertools import product

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from symfpu import Chain, InputError
from symfpu.chain import bonds
from symfpu.chain.chain import LARGEST_EXPRESSION
from symfpu.numbers.arithmetic import MULTIPRECISION
from symfpu.numbers.typed import decimal
from tests.refusals import each, refused
from tests.tolerances import INTEGER, ROUNDING

SIZES = range(2, 13)
COUPLINGS = ({"alpha": "0.33"}, {"beta": "-0.7"}, {"alpha": "-1/3", "beta": "0.4"})


def sine_matrix(N):
    """Eq. lintra as a matrix, by its sines."""
    k = np.arange(1, N)
    return np.sqrt(2 / N) * np.sin(np.outer(k, k) * np.pi / N)


def stretch_matrix(N):
    """x_(j+1) - x_j of a unit u_q = Omega_q Q_q, from Eq. lintra with fixed ends; shape (N, N-1)."""
    x = np.vstack([np.zeros(N - 1), sine_matrix(N), np.zeros(N - 1)])
    return np.diff(x, axis=0) / (2 * np.sin(np.arange(1, N) * np.pi / (2 * N)))


def states(N, count=3):
    rng = np.random.default_rng(N)
    return rng.normal(size=(count, N - 1)), rng.normal(size=(count, N - 1))


@pytest.mark.parametrize("N", SIZES)
def test_transform_is_the_sine_sum_and_its_own_inverse(N):
    chain, (Q, _) = Chain(N, 1), states(N)
    assert np.abs(chain.positions(Q) - Q @ sine_matrix(N).T).max() < ROUNDING
    assert np.abs(chain.positions(chain.positions(Q)) - Q).max() < ROUNDING
    assert np.abs(chain.modes(chain.positions(Q)) - Q).max() < ROUNDING


@pytest.mark.parametrize("N", SIZES)
def test_B_is_the_cubic_energy_of_the_bonds(N):
    """(1/3) sum r^3 = (1 / (3 sqrt(2N))) sum B u u u."""
    R = stretch_matrix(N)
    expected = np.sqrt(2 * N) * np.einsum("jq,jl,jm->qlm", R, R, R)
    chain, modes = Chain(N, 1), range(1, N)
    B = np.array([chain.B(q, l, m) for q, l, m in product(modes, repeat=3)]).reshape(expected.shape)
    assert np.abs(B - expected).max() < INTEGER


@pytest.mark.parametrize("N", SIZES)
def test_C_is_the_quartic_energy_of_the_bonds(N):
    """(1/4) sum r^4 = (1 / 8N) sum C u u u u. From N = 4 on sums reach -2N, which Eq. transa leaves out as printed."""
    R = stretch_matrix(N)
    expected = 2 * N * np.einsum("jq,jl,jm,jn->qlmn", R, R, R, R, optimize=True)
    chain, modes = Chain(N, 1), range(1, N)
    C = np.array([chain.C(*indices) for indices in product(modes, repeat=4)]).reshape(expected.shape)
    assert np.abs(C - expected).max() < INTEGER


@pytest.mark.parametrize("N", [2, 3, 6, 9])
def test_coupled_lists_the_couplings(N):
    chain = Chain(N, 1)
    for pair in product(range(1, N), repeat=2):
        assert dict(chain.coupled(*pair)) == {q: chain.B(q, *pair) for q in range(1, N) if chain.B(q, *pair)}
    triple = (1, N - 1, (N + 1) // 2)
    assert dict(chain.coupled(*triple)) == {q: chain.C(q, *triple) for q in range(1, N) if chain.C(q, *triple)}


def bond_energy(chain, Q, P):
    """Eq. fpuham, particle by particle."""
    x = np.concatenate([[0.0], sine_matrix(chain.N) @ Q, [0.0]])
    y = sine_matrix(chain.N) @ P
    r = x[1:] - x[:-1]
    return (y**2).sum() / 2 + (r**2).sum() / 2 + float(chain.alpha) / 3 * (r**3).sum() + float(chain.beta) / 4 * (r**4).sum()


def mode_energy(chain, Q, P):
    """Eq. fpuham2, coupling by coupling."""
    modes = range(1, chain.N)
    Omega = chain.frequencies()
    u = dict(zip(modes, Omega * Q, strict=True))
    cubic = sum(chain.B(q, l, m) * u[q] * u[l] * u[m] for q, l, m in product(modes, repeat=3))
    quartic = sum(chain.C(q, l, m, n) * u[q] * u[l] * u[m] * u[n] for q, l, m, n in product(modes, repeat=4))
    harmonic = (P**2 + Omega**2 * Q**2).sum() / 2
    return harmonic + float(chain.alpha) / (3 * np.sqrt(2 * chain.N)) * cubic + float(chain.beta) / (8 * chain.N) * quartic


@pytest.mark.parametrize("couplings", COUPLINGS, ids=str)
@pytest.mark.parametrize("N", [2, 3, 6, 7])
def test_energy_is_that_of_the_bonds_and_of_the_modes(N, couplings):
    chain, (Q, P) = Chain(N, **couplings), states(N)
    energies = chain.energy(Q, P)
    assert energies.shape == (3,)
    for energy, q, p in zip(energies, Q, P, strict=True):
        assert energy == pytest.approx(bond_energy(chain, q, p), rel=ROUNDING, abs=ROUNDING)
        assert energy == pytest.approx(mode_energy(chain, q, p), rel=ROUNDING, abs=ROUNDING)


@pytest.mark.parametrize("couplings", COUPLINGS, ids=str)
@pytest.mark.parametrize("N", [2, 5, 8, 12])
def test_accelerations_are_minus_the_gradient(N, couplings):
    """A five-point difference is exact for a quartic polynomial: only rounding is left, at any step."""
    chain, (Q, _) = Chain(N, **couplings), states(N, 1)
    step = 0.5
    shifted = {i: chain.energy(Q + i * step * np.eye(N - 1), 0 * np.eye(N - 1)) for i in (-2, -1, 1, 2)}
    gradient = (shifted[-2] - 8 * shifted[-1] + 8 * shifted[1] - shifted[2]) / (12 * step)
    scale = max(np.abs(energies).max() for energies in shifted.values())
    assert np.abs(chain.accelerations(Q[0]) + gradient).max() < ROUNDING * scale


LAWS = [*COUPLINGS, *({"potential": text} for text in ("toda:1/2", "lj:12,6", "morse:1", "poly:1/3,0,1/5", "expr:cosh(r)-1"))]


@pytest.mark.parametrize("law", LAWS, ids=str)
@pytest.mark.parametrize("N", range(2, 7))
def test_expressions_give_the_numbers(N, law):
    chain, (Q, P) = Chain(N, **law), states(N, 1)
    Q = Q if law in COUPLINGS else 0.1 * Q
    values = {f"Q{q}": float(x) for q, x in enumerate(Q[0], 1)} | {f"P{q}": float(x) for q, x in enumerate(P[0], 1)}
    H = chain.hamiltonian()
    near = ROUNDING if law in COUPLINGS else INTEGER
    assert {symbol.name for symbol in H.free_symbols} == set(values)
    assert float(H.subs(values).n(real=True)) == pytest.approx(float(chain.energy(Q[0], P[0])), rel=near)
    motion = chain.equations_of_motion()
    assert list(motion) == list(range(1, N))
    computed = [float(motion[q].subs(values).n(real=True)) for q in motion]
    assert np.allclose(computed, chain.accelerations(Q[0]), rtol=near, atol=near)


def test_expressions_of_long_chains_are_refused():
    with pytest.raises(InputError, match="N = "):
        Chain(LARGEST_EXPRESSION + 1, alpha=1).hamiltonian()


def test_one_argument_is_changed():
    changed = Chain(8, alpha="1/3").at(beta="1/10")
    assert changed == Chain(8, alpha=Fraction(1, 3), beta=Fraction(1, 10))
    assert changed.at(alpha=0) == Chain(8, beta=Fraction(1, 10))
    assert changed.at(N=9) == replace(changed, N=9)
    assert replace(changed, N=np.int64(9)).N == 9
    assert type(replace(changed, N=np.int64(9)).N) is int


@given(st.fractions(max_denominator=10**6))
def test_decimal_text_gives_the_number_back(value):
    assert Fraction(decimal(value)) == value


@pytest.mark.parametrize(
    ("couplings", "model", "step", "mu", "relative"),
    [
        ({"alpha": "0.5"}, "alpha", 1, 0.125, {2: 1}),
        ({"beta": "0.5"}, "beta", 2, 0.03125, {3: 1}),
        ({"alpha": "0.5", "beta": "0.5"}, "alpha+beta", 1, 0.125, {2: 1, 3: 2}),
    ],
)
def test_small_parameter_and_degrees(couplings, model, step, mu, relative):
    chain = Chain(8, **couplings)
    assert (chain.model, chain.degree_step, chain.mu) == (model, step, mu)
    assert chain.relative_couplings(9) == relative


@each(N=[1, 0, 2.5, True], alpha=["x", float("nan"), "0"], beta=[float("inf"), "1/0", None, 1j])
def test_bad_chains_are_refused_in_one_line(name, value):
    refused(Chain, name, value, N=8, **{} if name == "alpha" else {"alpha": 1})


def test_a_chain_has_a_coupling():
    with pytest.raises(InputError, match=r"^alpha, beta = "):
        Chain(8)


@pytest.mark.parametrize("shape", [(), (6,), (7, 3), (8,)])
def test_states_of_another_length_are_refused(shape):
    chain = Chain(8, alpha=1)
    for call in (chain.positions, chain.modes, chain.accelerations, chain.stretches):
        with pytest.raises(InputError):
            call(np.zeros(shape))
    with pytest.raises(InputError):
        chain.energy(np.zeros(7), np.zeros(shape))


@pytest.mark.parametrize("modes", [(0, 1, 1), (1, 8, 1), (1, 1, -1)])
def test_couplings_of_no_mode_are_refused(modes):
    with pytest.raises(InputError, match="mode"):
        Chain(8, alpha=1).B(*modes)


def test_a_chain_gives_its_law_in_the_arithmetic_asked_for():
    chain = Chain(8, alpha="1/3", beta="-1/7")
    assert chain.couplings == (Fraction(1, 3), Fraction(-1, 7))
    assert chain.law() == (1 / 3, -1 / 7)
    with mpmath.workdps(40):
        law = chain.law(MULTIPRECISION)
        assert law == (mpmath.mpf(1) / 3, -mpmath.mpf(1) / 7)
        assert bonds.tension(law, mpmath.mpf(1)) == 1 + law[0] + law[1]
