"""The invariance equation against the equations of motion of the chain, pointwise on the torus, and its derivative against itself."""

from itertools import product

import mpmath
import numpy as np
import pytest

from symfpu import Chain
from symfpu.numbers.long_doubles import rational
from symfpu.refinement import invariance, lattice
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import OVERSAMPLING, Lattice, dilated
from tests.tolerances import EPS, LAST_DIGIT, ROUNDING

LONG_EPS = float(np.finfo(np.longdouble).eps)
LONG_ROUNDING = 256 * LONG_EPS  # as ROUNDING

CASES = (
    (Chain(2, alpha=1, beta="-0.5"), (1,)),
    (Chain(2, beta=1), (1,)),
    (Chain(3, alpha="-0.7"), (2,)),
    (Chain(8, alpha="0.4"), (3,)),
    (Chain(5, alpha=1), (3, 4)),
    (Chain(6, beta="0.7"), (4, 5)),
    (Chain(7, alpha="-0.3", beta="0.5"), (6, 2)),
    (Chain(8, alpha="0.3", beta="0.2"), (1, 2, 7)),
    (Chain(5, beta="-0.4"), (1, 3, 4)),
    (Chain(9, alpha="0.5"), (8, 1, 4)),
)

BOTH_KINDS = pytest.mark.parametrize("kind", [np.float64, np.longdouble], ids=["doubles", "long doubles"])


def ball(s, radius):
    """All harmonics with sum |nu_i| <= radius, one of each pair +-nu."""
    inside = [nu for nu in product(range(-radius, radius + 1), repeat=s) if sum(map(abs, nu)) <= radius]
    return np.array([nu for nu in inside if next((n for n in nu if n), 1) > 0])


def equation_and_coefficients(chain, seeds, *, low, radius, seed=1, kind=np.float64):
    """An equation on a ball, and random coefficients where its mask holds, up to harmonics of length `low`."""
    equation = InvarianceEquation(chain, seeds, ball(len(seeds), radius))
    allowed = equation.mask & (np.abs(equation.harmonics).sum(axis=1) <= low)[:, None]
    draws = np.random.default_rng(seed).normal(scale=0.1, size=allowed.shape)
    return equation, np.where(allowed, draws, 0).astype(kind)


def as_mpf(value):
    """A long double at the precision of the moment, at which it is exact here."""
    exact = rational(value)
    return mpmath.mpf(exact.numerator) / exact.denominator


def largest(values):
    return float(np.abs(values).max())


def assert_close(found, expected, tolerance=ROUNDING, scale=None):
    assert largest(found - expected) <= tolerance * (largest(expected) if scale is None else scale)


@pytest.mark.parametrize(("chain", "seeds"), CASES, ids=repr)
def test_the_force_is_that_of_the_chain_at_any_angles(chain, seeds):
    """Products of at most three harmonics of length `low` lie in the ball; were the mask too narrow, a part of them would be lost."""
    low = 2 if len(seeds) < 3 else 1
    equation, c = equation_and_coefficients(chain, seeds, low=low, radius=3 * low)
    cosines = np.cos(np.random.default_rng(2).uniform(0, 2 * np.pi, (40, len(seeds))) @ equation.harmonics.T)
    Q = cosines @ c
    assert_close(-(chain.frequencies() ** 2) * Q - cosines @ equation.force(c), chain.accelerations(Q))
    assert largest(equation.force(c)) > 1e-4  # the check above is one of the force, not of the linear part alone


@pytest.mark.parametrize(("chain", "seeds"), CASES, ids=repr)
def test_the_potential_is_that_of_the_chain(chain, seeds):
    equation = InvarianceEquation(chain, seeds, ball(len(seeds), 1))
    Q = np.random.default_rng(3).normal(size=chain.N - 1)
    c = np.zeros(equation.mask.shape, dtype=np.longdouble)
    c[0] = Q
    energy, (slopes, _) = equation.energy_at_start(c)
    assert float(energy) == pytest.approx(float(chain.energy(Q, 0 * Q)), rel=ROUNDING)
    forces = chain.accelerations(Q)
    assert_close(slopes, np.where(equation.mask, -forces, 0), scale=largest(forces))


def test_long_doubles_have_all_their_digits():
    """Against accelerations of 30 digits at three angles; the harmonic zero takes part."""
    chain, seeds = Chain(5, alpha="1/3", beta="0.7"), (3,)
    equation, c = equation_and_coefficients(chain, seeds, low=2, radius=6, kind=np.longdouble)
    force = equation.force(c)
    with mpmath.workdps(30):
        exact_c, exact_force = (np.vectorize(as_mpf)(x) for x in (c, force))
        linear = np.array([chain.linear_frequency(q) for q in range(1, 5)])
        for theta in (mpmath.mpf("0.3"), mpmath.mpf("1.7"), mpmath.mpf("2.9")):
            cosines = np.array([mpmath.cos(int(n) * theta) for n in equation.harmonics[:, 0]])
            Q = cosines @ exact_c
            difference = chain.accelerations(Q) + linear**2 * Q + cosines @ exact_force
            assert largest(difference) <= LONG_ROUNDING * largest(force)


@BOTH_KINDS
@pytest.mark.parametrize("s", [1, 2, 3])
def test_a_lattice_gives_values_and_takes_them_back(s, kind):
    harmonics = ball(s, 3)
    lattice = Lattice(harmonics)
    c = np.random.default_rng(4).normal(size=(len(harmonics), 2)).astype(kind)
    turn = 8 * np.arctan(np.ones(1, dtype=kind))[0] / lattice.period
    places = np.arange(lattice.points)[:, None] * (harmonics @ lattice.generator) % lattice.period
    rounding = ROUNDING if kind is np.float64 else LONG_ROUNDING
    values = lattice.values(c)
    assert values.dtype == kind
    assert_close(values, (np.cos(places * turn) @ c).T, rounding)
    assert_close(lattice.coefficients(values), c, rounding)


@pytest.mark.parametrize("highest", [(5,), (4, 2), (2, 3, 1), (2, 1, 1, 2)])
def test_no_two_harmonics_of_a_lattice_coincide(highest):
    """Of all up to OVERSAMPLING / 2 times the chosen ones, counted here one by one; nor does one meet the middle of the period."""
    chosen = np.array([nu for nu in ball(len(highest), max(highest)) if sum(abs(n) / k for n, k in zip(nu, highest, strict=True)) <= 1])
    reach = OVERSAMPLING / 2
    tops = [range(-int(reach * k), int(reach * k) + 1) for k in highest]
    larger = [nu for nu in product(*tops) if sum(abs(n) / k for n, k in zip(nu, highest, strict=True)) <= reach + 1e-12]
    assert sorted(map(tuple, dilated(chosen, reach).tolist())) == sorted(larger)
    lattice = Lattice(chosen)
    places = np.array(larger) @ lattice.generator % lattice.period
    assert len(np.unique(places)) == len(larger)
    assert lattice.period // 2 not in places
    assert lattice.period < 4 * len(larger)


def test_a_clash_of_the_last_harmonics_is_found():
    """Where the first ones, in portions that grow, are all different."""
    numbers = np.arange(3 * lattice.FIRST_TRIED)[:, None]
    generator, period = np.array([1]), len(numbers)
    assert lattice._distinct(numbers, generator, period)
    clash = np.append(numbers, [[period]], axis=0)
    assert not lattice._distinct(clash, generator, period)
    assert not lattice._distinct(np.append(numbers, numbers[-1:], axis=0), generator, 2 * period)


def test_all_harmonics_have_a_place_in_the_spectrum():
    """Also those beyond the lattice, which fold onto it, and those whose first number is negative: the mean of f cos(nu.theta)."""
    lattice = Lattice(ball(2, 3))
    half = np.random.default_rng(5).normal(size=lattice.points)
    whole = np.concatenate([half, half[-2:0:-1]])
    spectrum = lattice.spectrum(half[None])[0]
    for nu in product(range(-9, 10), repeat=2):
        turns = np.arange(lattice.period) * int(np.array(nu) @ lattice.generator) % lattice.period / lattice.period
        assert spectrum[lattice.entries(np.array(nu))] == pytest.approx((whole * np.cos(2 * np.pi * turns)).mean(), abs=ROUNDING)


@pytest.mark.parametrize(("chain", "seeds"), CASES, ids=repr)
def test_the_change_of_the_force_is_its_derivative(chain, seeds):
    """The force is cubic: a central difference exceeds its derivative by h^2 times the part of third degree, exactly; nothing for alpha."""
    equation, c = equation_and_coefficients(chain, seeds, low=3, radius=3)
    d = equation_and_coefficients(chain, seeds, low=3, radius=3, seed=6)[1]
    change = equation.force_change(equation.slopes(c), d)
    odd = (equation.force(d) - equation.force(-d)) / 2
    assert (largest(odd) <= EPS * largest(change)) == (not chain.beta)
    for h in (1.0, 0.25):
        difference = (equation.force(c + h * d) - equation.force(c - h * d)) / (2 * h)
        assert_close(difference - h**2 * odd, change, ROUNDING / h)


@pytest.mark.parametrize(("chain", "seeds"), CASES, ids=repr)
def test_a_block_holds_the_products_with_unit_vectors(chain, seeds):
    """Column by column, the harmonic zero among them, with all the folding that a full set of coefficients brings."""
    equation, c = equation_and_coefficients(chain, seeds, low=3, radius=3)
    slopes = equation.slopes(c)
    rows, columns = np.nonzero(equation.mask)
    assert (equation.harmonics[rows] == 0).all(axis=1).any() == bool(chain.alpha and chain.N > 2)
    chosen = np.random.default_rng(7).permutation(len(rows))[:60]
    rows, columns = rows[chosen], columns[chosen]
    block = equation.block(slopes, rows, columns)
    assert_close(equation.diagonal(slopes, rows, columns), np.diag(block), scale=largest(block))
    some = rows[::3], columns[::3]
    assert_close(equation.block(slopes, rows, columns, some), block[:, ::3], scale=largest(block))
    for k, (row, column) in enumerate(zip(rows, columns, strict=True)):
        unit = np.zeros(equation.mask.shape)
        unit[row, column] = 1
        assert_close(block[:, k], equation.force_change(slopes, unit)[rows, columns], scale=largest(block))


@pytest.mark.parametrize(("chain", "seeds"), CASES, ids=repr)
def test_sparse_rows_of_all_harmonics_are_those_of_the_block(chain, seeds, monkeypatch):
    """But for couplings below a thousandth of the largest one of their harmonic (two harmonics meet in an entry, one may be doubled),
    and for folding, which starts between unknowns of longer harmonics.
    """
    monkeypatch.setattr(invariance, "SHARE", 0.0)
    monkeypatch.setattr(invariance, "MOST_SLOPES", 1000)
    equation, c = equation_and_coefficients(chain, seeds, low=1, radius=3)
    slopes = equation.slopes(c)
    rows, columns = np.nonzero(equation.mask)
    block = equation.block(slopes, rows, columns)
    low = np.flatnonzero(np.abs(equation.harmonics[rows]).sum(axis=1) <= 2)
    chosen = np.random.default_rng(8).permutation(low)[:40]
    sparse = equation.sparse_rows(slopes, rows[chosen], columns[chosen]).toarray()
    assert sparse.shape == (len(chosen), len(rows))
    assert_close(sparse[:, low], block[chosen][:, low], 4e-3)


def exact_divisors(equation, shifts):
    """(nu.omega)^2 - Omega_q^2 with 40 digits, and the sizes of what nu.omega - Omega_q is the sum of, for its rounding."""
    chain, moved = equation.chain, list(map(as_mpf, shifts))
    linear = [chain.linear_frequency(q) for q in range(1, chain.N)]
    divisors, condition = np.empty((2, *equation.mask.shape), dtype=object)
    for i, nu in enumerate(equation.harmonics.tolist()):
        base = mpmath.fdot(nu, [linear[q - 1] for q in equation.seeds])
        shift = mpmath.fdot(nu, moved)
        slack = mpmath.fdot(map(abs, nu), map(abs, moved))
        for j, Omega in enumerate(linear):
            divisors[i, j] = (base + shift) ** 2 - Omega**2
            near = base - Omega if abs(base - Omega) < abs(base + Omega) else base + Omega
            condition[i, j] = (abs(near) + slack) / abs(near + shift)
    return divisors, condition


@pytest.mark.parametrize(
    ("chain", "seeds", "shifts"),
    [
        pytest.param(Chain(9, alpha=1), (1, 5), ("3e-6", "-7e-7"), id="exact resonance: Omega_7 = Omega_1 + Omega_5"),
        pytest.param(Chain(40, beta=1), (1, 2), ("1.3e-9", "2.1e-9"), id="low modes, Omega_2 - 2 Omega_1 about 1e-5 Omega_1"),
        pytest.param(Chain(200, alpha=1), (1, 2, 3), ("1e-8", "-3e-9", "1e-11"), id="Omega_3 = 2 Omega_2 - Omega_1 + 1e-7"),
        pytest.param(Chain(8, alpha="0.3", beta="0.2"), (7, 2), ("0.01", "0.02"), id="nothing cancels"),
        pytest.param(Chain(2, alpha=1), (1,), ("-1e-15",), id="tiny shift"),
    ],
)
def test_divisors_keep_their_digits_where_frequencies_cancel(chain, seeds, shifts):
    """Against 40 digits. What is left is the rounding of nu.Omega - Omega_q and of nu.(omega - Omega) before they are added; these
    cancel by up to 1e3 here."""
    equation = InvarianceEquation(chain, seeds, ball(len(seeds), 3))
    with mpmath.workdps(40):
        numbers = np.array([np.longdouble(x) for x in shifts])
        exact, condition = exact_divisors(equation, numbers)
        found = np.vectorize(as_mpf)(equation.divisors(numbers))
        error = np.abs(found / exact - 1)
        assert (error <= 8 * LONG_EPS * condition).all()
        assert error.max() < LAST_DIGIT
        omega = [chain.linear_frequency(q) + as_mpf(x) for q, x in zip(seeds, numbers, strict=True)]
        rates = np.array([mpmath.fdot(nu, omega) for nu in equation.harmonics.tolist()])
        assert largest(np.vectorize(as_mpf)(equation.rates(numbers)) - rates) < 16 * LONG_EPS


@pytest.mark.parametrize(("chain", "seeds"), CASES, ids=repr)
def test_the_seeds_are_unknowns_under_their_own_harmonics(chain, seeds):
    equation = InvarianceEquation(chain, seeds, ball(len(seeds), 2))
    assert (equation.harmonics[equation.seed_rows] == np.eye(len(seeds))).all()
    assert tuple(equation.seed_columns + 1) == seeds
    assert equation.mask[equation.seed_rows, equation.seed_columns].all()
