"""Birkhoff's normal form: dH/dI is omega exactly, in two fields; and tori have the energy that it gives."""

import numpy as np
import pytest
import symengine as se

import symfpu
from symfpu import Chain, InputError, actions, birkhoff_form, lindstedt, refine, toda, toda_torus, twist_at_rest
from symfpu.action_angle.birkhoff import chain_series, normal_form, symbolic_series
from symfpu.algebra.truncated import Truncated
from tests.tolerances import HIGH_PRECISION, SLOPE

CHAINS = {"alpha": {"alpha": 1}, "beta": {"beta": 1}, "both": {"alpha": 1, "beta": "1/3"}, "toda": {"potential": toda(1)}}


def derivative(H, place):
    """By a variable; one degree less is known."""
    found = [{} for _ in H.parts[1:]]
    for e, c in H.items():
        if e[place]:
            found[sum(e) - 1][tuple(n - (i == place) for i, n in enumerate(e))] = c * e[place]
    return Truncated(found, H.size)


def series(law, N, seeds, degree):
    chain = Chain(N, **CHAINS[law])
    return lindstedt(chain, seeds, order=2 * (degree - 1) // chain.degree_step, ring="nested")


@pytest.mark.parametrize(
    ("law", "N", "seeds", "degree"),
    [
        ("alpha", 8, (1, 2), 3),
        ("alpha", 8, (1,), 7),
        pytest.param("alpha", 8, (1, 2), 6, marks=pytest.mark.long),
        pytest.param("beta", 6, (1, 5), 3, marks=pytest.mark.long),
        pytest.param("both", 8, (1, 2, 4), 3, marks=pytest.mark.long),
        pytest.param("toda", 8, (1, 3), 4, marks=pytest.mark.long),
    ],
)
def test_the_gradient_is_omega_in_the_field_of_the_chain(law, N, seeds, degree):
    H, omega = normal_form(chain_series(series(law, N, seeds, degree)), degree)
    for place, rate in enumerate(omega):
        slope = derivative(H, place)
        assert slope.top == rate.top == degree - 1
        assert not slope - rate
        assert rate.parts[-1]


@pytest.mark.parametrize(("law", "seeds"), [("alpha", (2, 6)), ("beta", (1, 2, 3)), pytest.param("both", (1, 2), marks=pytest.mark.long)])
def test_the_gradient_is_omega_whatever_the_linear_frequencies(law, seeds):
    """Omega_q as independent symbols; the second degree."""
    expanded, _ = symbolic_series(series(law, 8, seeds, 2))
    H, omega = normal_form(expanded, 2)
    for place, rate in enumerate(omega):
        assert not derivative(H, place) - rate
        assert rate.parts[1]


@pytest.mark.long
def test_energy_and_frequencies_of_tori():
    """What degree 3 leaves of the energy falls as A^8, of the frequencies as A^6."""
    chain = Chain(8, alpha="0.3", beta="0.1")
    form = birkhoff_form(chain, (1, 2), 3, digits=20)
    left = []
    for size in ("0.1", "0.2"):
        torus = refine(symfpu.torus(chain, (1, 2), amplitudes={1: size, 2: size}, method="series", order=8))
        found = actions(torus)
        rates = form.frequencies_at(found)
        gaps = [float(rates[q]) - float(w) for q, w in zip((1, 2), torus.frequencies, strict=True)]
        left.append([float(form.energy_at(found)) - torus.energy(), *gaps])
    orders = np.log2(np.abs(left[1]) / np.abs(left[0]))
    assert orders == pytest.approx([8, 6, 6], abs=SLOPE)


@pytest.mark.long
def test_toda_by_its_spectral_curve():
    chain = Chain(4, potential=toda("1/2"))
    form = birkhoff_form(chain, (1, 2), 4, digits=25)
    gaps = []
    for size in ("0.001", "0.002"):
        exact = toda_torus(chain, (1, 2), actions=(size, size), digits=25)
        gaps.append(abs(form.energy_at({1: size, 2: size}) - exact.energy))
    assert float(np.log2(float(gaps[1] / gaps[0]))) == pytest.approx(5, abs=SLOPE)


def test_degree_two_is_the_twist_at_rest():
    chain = Chain(6, alpha=1, beta="1/3")
    seeds = (1, 3, 5)
    form, at_rest = birkhoff_form(chain, seeds, 2), twist_at_rest(chain, seeds)
    linear = {se.Symbol(f"Omega_{q}"): 2 * se.sin(q * se.pi / 12) for q in range(1, 6)}
    for i in range(3):
        for j in range(i, 3):
            e = tuple(int(i == k) + int(j == k) for k in range(3))
            expected = at_rest.formula()[i][j].subs(linear) / (2 if i == j else 1)
            assert abs((form.coefficients[e] - expected).n(150, real=True)) < HIGH_PRECISION


@pytest.mark.long
def test_one_seed_for_every_length():
    """The frequency by the other expansion, its amplitude turned into the action."""
    form = birkhoff_form(Chain("N", alpha=1), (1,), 2)
    shift = symfpu.frequency_expansion(Chain("N", alpha=1), (1,), 1, 2)
    A, W, N = (se.Symbol(name) for name in ("A1", "Omega_1", "N"))
    by_first = {se.Symbol("Omega_2"): se.sqrt(4 * W**2 - W**4)}
    coefficient = form.coefficients[2,].subs(by_first)
    difference = coefficient * W - shift / A**2 / (2 * N)
    values = {W: se.Rational(1, 3), N: 7}
    assert se.expand(difference.subs(values)) == 0
    assert se.expand(coefficient.subs(values)) != 0


def test_bad_input_is_named():
    with pytest.raises(InputError, match="over"):
        birkhoff_form(Chain(4, alpha=1), (1,), 2, over="reals")
    with pytest.raises(InputError, match="digits"):
        birkhoff_form(Chain("N", alpha=1), (1,), 2, digits=10)
    with pytest.raises(InputError, match="digits"):
        birkhoff_form(Chain(4, alpha=1), (1,), 2).energy_at({1: "0.1"})
    with pytest.raises(InputError, match="actions"):
        birkhoff_form(Chain(4, alpha=1), (1,), 1, digits=10).energy_at({1: "x"})


@pytest.mark.parametrize(
    ("N", "seeds", "degree", "options", "fitting"),
    [
        (8, (1, 2), 12, {}, 8),
        (8, (1,), 1000, {"over": "symbols"}, 16),
        (8, (1, 2, 3, 4, 5), 40, {"digits": 50}, 5),
        (3000, (1,), 10, {}, 2),
    ],
)
def test_a_form_of_too_much_work_is_refused_before_it_begins(monkeypatch, N, seeds, degree, options, fitting):
    """With the largest degree that is taken; the series is not asked for."""
    begun = []
    monkeypatch.setattr("symfpu.action_angle.birkhoff.lindstedt", lambda *_, **__: begun.append(1))
    with pytest.raises(InputError, match=rf"operations.*take degree {fitting} or less"):
        birkhoff_form(Chain(N, alpha=1), seeds, degree, **options)
    assert not begun


def test_squares_of_frequencies_of_the_field_are_squares():
    expanded = chain_series(series("alpha", 9, (1,), 2))
    assert not expanded.squares[1] - expanded.linear[0] * expanded.linear[0]
    cosines = [1.0, *(2 * np.cos(np.pi * np.arange(1, 18) / 18))]
    squares = [sum(p / r * c for (p, r), c in zip(x.by_cosines(), cosines, strict=False)) for x in expanded.squares.values()]
    assert squares == pytest.approx(Chain(9, alpha=1).frequencies() ** 2)
