"""The twist: symmetric, and that of Toda's spectral curve, and that of two tori nearby."""

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, actions, refine, twist
from symfpu.refinement import iterative_refinement
from symfpu.refinement.linear_system import SMALLEST_BLOCK
from tests.action_angle.test_actions import SEEDS, refined_toda
from tests.tolerances import NEWTON_TWIST, PRECISE_TWIST, ROUNDING, SLOPE, TWIST_DIFFERENCE

CASES = {"alpha": {"alpha": "0.3"}, "beta": {"beta": "-0.3"}, "both": {"alpha": "0.3", "beta": "0.2"}}


@pytest.mark.long
def test_toda_by_its_spectral_curve():
    torus = refined_toda()
    found = twist(torus)
    exact = {q: mpmath.mpf(x) for q, x in actions(torus).items()}
    step = mpmath.mpf("1e-8")
    for column, q in enumerate(SEEDS):
        ends = []
        for sign in (1, -1):
            with mpmath.workdps(40):
                moved = [exact[n] + sign * step * (n == q) for n in SEEDS]
                typed = [mpmath.nstr(x, 30) for x in moved]
            ends.append(symfpu.toda_torus(torus.chain, SEEDS, actions=typed, digits=30).frequencies)
        slopes = [float((ends[0][n] - ends[1][n]) / (2 * step)) for n in SEEDS]
        assert found.matrix[:, column] == pytest.approx(slopes, rel=TWIST_DIFFERENCE)
    assert found.definiteness == "positive definite"


@pytest.mark.parametrize("N", [2, 5])
def test_a_breather_has_the_twist_of_the_normal_form(N):
    """Of degree 3 in the actions: what is left falls as A^4."""
    chain = Chain(N, alpha="0.3", beta="0.5")
    form = symfpu.birkhoff_form(chain, (1,), 3, digits=20).coefficients
    misses = []
    for A in ("0.05", "0.1"):
        found = twist(symfpu.torus(chain, (1,), amplitudes={1: A}))
        expected = 2 * form[2,] + 6 * form[3,] * found.actions[0]
        misses.append(abs(found.matrix[0, 0] - float(expected)))
    assert np.log2(misses[1] / misses[0]) == pytest.approx(4, abs=SLOPE)


def test_determinants_of_two_angles():
    found = twist(refine(symfpu.torus(Chain(4, beta=1), (1, 2), amplitudes={1: "0.1", 2: "0.1"}, method="series", order=2)))
    (a, b), (_, d) = found.matrix
    assert found.asymmetry < NEWTON_TWIST
    first, second = found.frequencies
    bordered = 2 * first * second * b - first**2 * d - second**2 * a
    assert found.isoenergetic_determinant == pytest.approx(bordered, rel=ROUNDING)
    assert found.determinant == pytest.approx(np.prod(found.eigenvalues), rel=ROUNDING)
    assert found.signature == (1, 1, 0)


def moved(amplitudes, seed, part):
    with mpmath.workdps(40):
        return {**amplitudes, seed: mpmath.nstr(mpmath.mpf(amplitudes[seed]) * (1 + mpmath.mpf(part)), 30)}


def missed(found, ends):
    """|domega - Lambda dI| of two tori over the largest domega."""
    with mpmath.workdps(60):
        exact = [[mpmath.mpf(w.numerator) / w.denominator for w in torus.frequencies] for torus in ends]
        turned = np.array(exact[0]) - np.array(exact[1])
        further = np.array(list(actions(ends[0]).values())) - np.array(list(actions(ends[1]).values()))
        return float(abs(turned - found.matrix @ further).max() / abs(turned).max())


@pytest.mark.parametrize(
    ("law", "seed"), [pytest.param("alpha", 1, marks=pytest.mark.long), pytest.param("beta", 2, marks=pytest.mark.long)]
)
def test_digits_of_a_torus(law, seed):
    """Symmetric to them, and what two tori nearby have."""
    chain, amplitudes = Chain(4, **CASES[law]), {1: "0.1", 2: "0.1"}
    guess = symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=4)
    found = twist(refine(guess, amplitudes=amplitudes, digits=30))
    assert (found.digits, found.method, found.matrix[0, 1].digits) == (30, "Newton", 30)
    assert found.asymmetry < mpmath.mpf(10) ** -30
    nearby = [moved(amplitudes, seed, part) for part in ("1e-12", "-1e-12")]
    ends = [refine(guess, amplitudes=given, digits=40) for given in nearby]
    assert missed(found, ends) < PRECISE_TWIST


def test_digits_of_a_breather():
    chain, given = Chain(5, alpha="0.3", beta="0.2"), {2: "0.4"}
    orbit = symfpu.torus(chain, (2,), amplitudes={2: "0.4"})
    found = twist(refine(orbit, digits=30, amplitudes={2: "0.4"}))
    nearby = [moved(given, 2, part)[2] for part in ("1e-12", "-1e-12")]
    ends = [refine(orbit, digits=40, amplitudes={2: A}) for A in nearby]
    assert missed(found, ends) < PRECISE_TWIST


def test_steps_that_gain_nothing_are_named(monkeypatch):
    orbit = refine(symfpu.torus(Chain(4, beta=1), (2,), amplitudes={2: "0.1"}), digits=20)
    monkeypatch.setattr(iterative_refinement, "MOST_STEPS", 1)
    with pytest.raises(symfpu.NoTwist, match=r"iterative refinement stops at a residual or update of 1e-.*in_doubles"):
        twist(orbit)


def test_an_even_potential_with_more_harmonics_than_a_block_has():
    """Many digits keep odd harmonics alone; the slopes V''(r) - 1 have even ones alone."""
    amplitudes = {1: "0.1", 2: "0.1"}
    guess = symfpu.torus(Chain(4, beta="0.5"), tuple(amplitudes), amplitudes=amplitudes, method="series", order=4)
    torus = refine(guess, amplitudes=amplitudes, digits=30)
    assert np.count_nonzero(torus.cosines) > SMALLEST_BLOCK
    assert (torus.harmonics.sum(axis=1) % 2 == 1).all()
    expected = twist(refine(guess, amplitudes=amplitudes))
    for again in (torus, torus.in_doubles()):
        assert twist(again).matrix.astype(float) == pytest.approx(expected.matrix, rel=NEWTON_TWIST)


def test_what_is_not_refined_is_refused():
    torus = symfpu.torus(Chain(8, alpha="0.3"), (1,), amplitudes={1: "0.8"}, method="series", order=4)
    rough = symfpu.Torus(torus.chain, torus.seeds, torus.frequencies, torus.harmonics, torus.cosines)
    precise = symfpu.torus(Chain(8, alpha="0.3"), (1,), amplitudes={1: "0.8"}, method="series", order=4, digits=20)
    for solution in (torus, rough, precise):
        with pytest.raises(symfpu.InputError, match=r"residual .*: allowed is .* to 1e-08.*refine\(solution\)"):
            twist(solution)
