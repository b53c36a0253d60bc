"""Proofs of existence: the true orbit is where they say, their bounds are those of another route, and what is no orbit has none."""

import json
import re
from dataclasses import replace
from fractions import Fraction
from functools import cache
from types import SimpleNamespace

import flint
import mpmath
import numpy as np
import psutil
import pytest

import symfpu
from symfpu import Chain, InputError, prove_existence, refine
from symfpu.certified.bond_balls import SPARE_BITS, BondBalls
from symfpu.certified.contraction import Attempt, places_of
from symfpu.certified.existence_bounds import linear_part, strip
from symfpu.certified.layout import layout_of
from symfpu.certified.rounded_orbit import rounded_orbit
from symfpu.checkers import existence as check_existence
from symfpu.checkers.reading import dyadic
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.invariance import InvarianceEquation
from tests.breather import breather_of
from tests.checkers.certificate_files import bounds_of
from tests.tolerances import (
    FREE,
    NO_HARMONIC,
    OF_DOUBLES,
    PROVED_FREQUENCY,
    PROVED_RADIUS,
    SAME_BOUNDS,
    SAME_FREQUENCY,
    SQUEEZED,
    THOUSAND_ROUNDINGS,
)

FIG9 = Chain(N=32, alpha="0.33")
CASES = {
    "alpha": (Chain(8, alpha="0.3"), 1, "0.4"),
    "two bonds": (Chain(2, beta=1), 1, "0.3"),
    "beta, even seed": (Chain(6, beta="0.5"), 2, "-0.2"),
    "a bond at rest": (Chain(3, beta="0.3"), 1, "0.2"),
    "wrapped modes": (Chain(7, alpha="0.4"), 5, "0.1"),
    "both": (Chain(5, alpha="1/3", beta="-1/7"), 3, "0.2"),
    "a polynomial": (Chain(5, potential="poly:0.3,0.1,-1/5,0,1/9"), 2, "0.2"),
    "toda": (Chain(4, potential="toda:1/2"), 1, "0.1"),
    "morse": (Chain(3, potential="morse:1"), 1, "0.1"),
    "lennard-jones": (Chain(3, potential="lj:12,6"), 1, "0.01"),
    "an expression": (Chain(3, potential=symfpu.from_expression("exp(r) - 1 - r")), 1, "0.1"),
    "amplitude": (Chain(6, alpha="0.3"), 1, "0.4"),
    "energy": (Chain(5, alpha="0.3", beta="0.2"), 1, "0.4"),
    "energy, toda": (Chain(3, potential="toda:1/2"), 1, "0.2"),
}
GIVEN = {
    "amplitude": {"amplitude": "0.4"},
    "energy": {"energy": "0.0299"},
    "energy, toda": {"energy": "0.02"},
}


@cache
def orbit(name):
    if "energy" in GIVEN.get(name, {}):
        chain, seed = CASES[name][:2]
        return symfpu.torus(chain, (seed,), energy=GIVEN[name]["energy"])
    return breather_of(*CASES[name])


@cache
def proof(name):
    return prove_existence(orbit(name), **GIVEN.get(name, {}))


def checked(found, folder):
    found.write(folder / "proof.json")
    return check_existence.verify(folder / "proof.json")


QUICK = ("alpha", "two bonds", "beta, even seed", "a bond at rest", "both", "toda", "amplitude", "energy, toda")
EACH = [pytest.param(name, marks=[] if name in QUICK else [pytest.mark.long]) for name in CASES]
OF_FREQUENCY = [case for case in EACH if case.values[0] not in GIVEN]


def stretches_of(solution):
    """c_q = sqrt(2/N) Omega_q Q_q by harmonic, mpf."""
    chain = solution.chain
    units = [mpmath.sqrt(mpmath.mpf(2) / chain.N) * chain.linear_frequency(q) for q in chain.mode_numbers]
    return solution.by_harmonic() * np.array(units, dtype=object)


def rows_of(found, key, length):
    """Rows of a certificate as a table of mpf, those of harmonics beyond the length left out."""
    chain, body = found.chain, found.body
    table = np.zeros((length, chain.N - 1), dtype=object)
    places = places_of(layout_of(chain, found.seed), len(body[key]) - 1)
    values = (x for row in body[key] for x in row)
    for n, q, x in zip(places.n, places.q, values, strict=True):
        if n < length:
            table[n, q - 1] = mpmath.ldexp(x, -body["bits"])
    return table


@pytest.mark.parametrize("name", OF_FREQUENCY)
def test_the_true_orbit_is_where_the_theorem_says(name):
    """Forty digits are the true orbit as far as radii of doubles can see."""
    found, precise = proof(name), refine(orbit(name), digits=40)
    with mpmath.workdps(50):
        rows = stretches_of(precise)
        distance = np.abs(rows - rows_of(found, "orbit", len(rows))).sum()
        assert 0 < distance < found.radius < found.unique
        assert abs(precise.amplitude - found.amplitude) < found.amplitude_radius
        assert abs(precise.energy() - found.energy) < found.energy_radius


@pytest.mark.parametrize("name", GIVEN)
def test_the_frequency_is_where_the_theorem_says(name):
    """The orbits at the ends of its interval have values on the two sides of the given one."""
    found, excess = proof(name), []
    assert 0 < found.frequency_radius < PROVED_FREQUENCY
    for sign in (-1, 1):
        omega = found.frequency + sign * Fraction(found.frequency_radius)
        near = replace(orbit(name), frequencies=(omega,))
        precise = refine(near, digits=40)
        own = precise.amplitude if found.fixed == "amplitude" else precise.energy()
        with mpmath.workdps(50):
            excess.append(own - mpmath.mpf(found.value.numerator) / found.value.denominator)
    assert excess[0] * excess[1] < 0


@pytest.mark.parametrize("given", [{}, {"amplitude": "0.4"}, {"energy": None}])
def test_members_of_a_segment_are_on_its_line(given):
    """Harmonic balance at the ends and inside: within the radius of the line, outside a tenth of the middle's distance."""
    middle = orbit("alpha")
    kind = next(iter(given), "frequency")
    value = {"frequency": middle.frequency, "amplitude": Fraction("0.4"), "energy": Fraction(str(middle.energy()))}[kind]
    width = {"frequency": Fraction(1, 10**7), "amplitude": Fraction(1, 10**5), "energy": Fraction(1, 10**7)}[kind]
    found = prove_existence(middle, **dict.fromkeys(given, value), half_width=width)
    for s in (-1, Fraction(1, 2), 1):
        member = {
            "frequency": lambda x: refine(middle, frequencies=(x,)),
            "amplitude": lambda x: symfpu.torus(middle.chain, (1,), amplitudes={1: x}),
            "energy": lambda x: symfpu.torus(middle.chain, (1,), energy=x),
        }[kind](value + s * width)
        rows = stretches_of(member)
        centre = rows_of(found, "orbit", len(rows))
        line = centre + mpmath.mpf(s.numerator) / s.denominator * rows_of(found, "direction", len(rows))
        distance = np.abs(rows - line).sum()
        assert distance < found.radius
        assert distance < np.abs(rows - centre).sum() / 10
        assert abs(member.amplitude - found.amplitude) < found.amplitude_radius
        assert abs(member.energy() - found.energy) < found.energy_radius
        assert abs(member.frequency - found.frequency) <= max(found.frequency_radius, width)


def test_a_fold_in_omega_is_an_ordinary_point_of_its_amplitude(tmp_path):
    """The frequency of this oscillator falls and rises again: at its least, near A = 0.633383, DF is nearly singular.

    The segment about it holds the fold: its ends have higher frequencies than its middle, by proof.
    """
    chain, A, width = Chain(2, potential="poly:0,-1,0,3/2"), Fraction("0.633383"), Fraction(1, 200)
    fold = symfpu.torus(chain, (1,), amplitudes={1: A})
    alone, given = prove_existence(fold), prove_existence(fold, amplitude=A)
    assert alone.unique < SQUEEZED < FREE < given.unique
    assert checked(prove_existence(fold, amplitude=A, half_width=width), tmp_path)
    for end in (A - width, A + width):
        proved = prove_existence(symfpu.torus(chain, (1,), amplitudes={1: end}), amplitude=end)
        rise = proved.frequency - given.frequency
        assert rise > proved.frequency_radius + given.frequency_radius


def test_a_segment_too_long_says_how_long_one_may_be():
    with pytest.raises(symfpu.NoExistenceProof, match="of this one can be proved") as caught:
        prove_existence(orbit("alpha"), amplitude="0.4", half_width="1e-2")
    share = float(re.search(r"a half width of ([0-9.e-]+) of this", str(caught.value))[1])
    assert prove_existence(orbit("alpha"), amplitude="0.4", half_width=0.9 * share * 1e-2)


WAVES = {
    "wave": (Chain(16, alpha="0.3", ends="periodic"), 1, {"amplitude": "0.5"}, {}),
    "wave, mirrored": (Chain(9, alpha="0.3", beta="1/5", ends="periodic"), -4, {"amplitude": "0.3"}, {"amplitude": "0.3"}),
    "wave, long period": (Chain(7, beta=1, ends="periodic"), 2, {"energy": "0.1"}, {"energy": "0.1"}),
    "wave, three particles": (Chain(3, potential="toda:1/2", ends="periodic"), 1, {"amplitude": "0.3"}, {}),
    "wave, shortest": (Chain(8, beta=-1, ends="periodic"), 4, {"amplitude": "0.3"}, {"amplitude": "0.3"}),
    "wave, harmonics at rest": (Chain(6, alpha="0.4", ends="periodic"), 2, {"energy": "0.03"}, {"energy": "0.03"}),
}


def wave(chain, seed, made):
    """Of an amplitude or an energy."""
    [(name, value)] = made.items()
    asked = {"amplitudes": {seed: value}} if name == "amplitude" else {name: value}
    return symfpu.torus(chain, (seed,), **asked)


@cache
def wave_proof(name):
    chain, seed, made, given = WAVES[name]
    return prove_existence(wave(chain, seed, made), **given)


@pytest.mark.parametrize(("name", "border"), [("two bonds", False), ("amplitude", True)])
def test_the_theorem_names_its_norm(name, border, tmp_path):
    """With the unknown m where the checker has one."""
    found = proof(name)
    found.write(tmp_path / "proof.json")
    claim = check_existence.read_claim(json.loads((tmp_path / "proof.json").read_text()))
    assert claim.bordered == ("v_0 |m| + " in found.norm) == border
    assert found.norm.endswith("sum v nu^n |c_q[n]|")
    assert found.norm in found.theorem
    assert found.norm in found.text()


@pytest.mark.parametrize("name", [*EACH, *(pytest.param(name, marks=[pytest.mark.long] * (name == "wave")) for name in WAVES)])
def test_the_checker_agrees_in_every_bound(name, tmp_path):
    found = wave_proof(name) if name in WAVES else proof(name)
    theorem, *_ = checked(found, tmp_path)
    assert f"N = {found.chain.N} {'particles' if name in WAVES else 'bonds'}" in theorem
    data = json.loads((tmp_path / "proof.json").read_text())
    _, bounds = bounds_of(data)
    radius = dyadic(data["unique"], "unique")
    assert bounds.length() == 0
    ours = [found.residual, 1 + found.linear, found.curvature]
    theirs = [bounds.residual(), 1 + bounds.linear(), bounds.curvature(radius)]
    np.testing.assert_allclose(ours, list(map(float, theirs)), rtol=SAME_BOUNDS)


@pytest.mark.parametrize("name", ["alpha", "both"])
def test_the_derivative_is_that_of_the_invariance_equation(name):
    """Another route to the same matrix: that equation takes points of the angle, with roots in its unknowns, here enough of them that
    nothing folds."""
    of_doubles = orbit(name)
    rounded = rounded_orbit(of_doubles)
    with flint.ctx.workprec(rounded.bits + SPARE_BITS):
        part = linear_part(BondBalls(rounded, strip(rounded)), 1e-300)
    attempt = Attempt(part, 6)
    numbers = np.arange(attempt.columns + 1)
    apart = np.arange(-2 * attempt.columns, 2 * attempt.columns + 1)
    equation = InvarianceEquation(of_doubles.chain, of_doubles.seeds, numbers[:, None], apart[:, None])
    cosines = np.zeros(equation.mask.shape)
    cosines[: len(of_doubles.cosines)] = of_doubles.cosines
    rows, columns = np.nonzero(equation.mask)
    inside = attempt.inside
    assert (inside.n == rows).all()
    assert (inside.q == columns + 1).all()
    linear = of_doubles.chain.frequencies()[columns]
    ours = attempt.force[: attempt.count] + np.diag(attempt.divisors[: attempt.count])
    divisors = equation.divisors(shifts_of(of_doubles)).astype(float)[rows, columns]
    force = equation.block(equation.slopes(cosines), rows, columns)
    scaled = (force - np.diag(divisors)) / linear[:, None] / linear
    np.testing.assert_allclose(ours, scaled, rtol=0, atol=THOUSAND_ROUNDINGS * np.abs(scaled).max())


def test_the_radius_falls_with_the_digits():
    near = orbit("alpha")
    radii = [prove_existence(refine(near, digits=digits)).radius for digits in (20, 40)]
    for digits, radius in zip((20, 40), radii, strict=True):
        assert 10.0 ** (-digits - 8) < radius < 10.0**-digits


@pytest.mark.parametrize("name", ["wave", "wave, mirrored", "wave, long period"])
@pytest.mark.parametrize("digits", [20, 40])
def test_the_radius_of_waves_falls_with_the_digits_asked_for(name, digits, tmp_path):
    chain, seed, made, given = WAVES[name]
    own = wave(chain, seed, made)
    found = prove_existence(own, digits=digits, **given)
    assert found.radius < 10.0**-digits
    assert given or found.frequency == own.frequency
    assert checked(found, tmp_path)


def test_digits_asked_for_are_those_of_the_other_route():
    """A double refined by the proof's own Newton method, and by the sums of harmonic balance in many digits."""
    near = orbit("alpha")
    asked, made = prove_existence(near, digits=40), prove_existence(refine(near, digits=40))
    assert asked.frequency == made.frequency
    assert abs(asked.energy - made.energy) < asked.energy_radius + made.energy_radius
    with pytest.raises(InputError, match="digits"):
        prove_existence(near, digits=0)


@pytest.mark.long
@pytest.mark.parametrize(("guess", "word"), [(0.786, "converged"), (2.09, "not a torus")])
def test_spurious_roots_do_not_certify(guess, word):
    """Two roots of one truncated series: the one that assess calls spurious is no orbit, the other is one to its residual."""
    series = symfpu.lindstedt(Chain(8, beta="0.5"), (3,), ("1.14",), 8)
    torus = symfpu.solve_amplitudes(series, guess={3: guess})
    assert symfpu.assess(series, torus).word == word
    if word == "converged":
        assert prove_existence(torus).radius < 1e-3 * torus.amplitude
        return
    with pytest.raises(symfpu.NoExistenceProof, match="Newton step") as caught:
        prove_existence(torus)
    assert caught.value.value > torus.amplitude


def test_an_orbit_with_too_few_harmonics_says_so():
    cut = orbit("alpha").cosines[:4]
    with pytest.raises(symfpu.NoExistenceProof) as caught:
        prove_existence(orbit_cut(cut))
    assert caught.value.bound == "Y"
    assert caught.value.value > caught.value.needed


def orbit_cut(cosines):
    whole = orbit("alpha")
    return replace(whole, cosines=cosines, harmonics=np.arange(len(cosines))[:, None])


def cnoidal(N, q, kappa, modulus):
    """Omega and the stretch of the Toda ring's periodic wave: theta -> d + log(1 + s (dn^2(K theta/pi) - E/K)) / kappa.

    Toda, Theory of Nonlinear Lattices, with the pressure that makes the mean stretch zero: an overall stretch d is a stiffer spring.
    """
    K, E = mpmath.ellipk(modulus), mpmath.ellipe(modulus)
    turned = mpmath.ellipfun("sn", 2 * K * q / N, m=modulus)
    s = 1 / (1 / turned**2 - 1 + E / K)

    def tension(theta):
        return mpmath.log(1 + s * (mpmath.ellipfun("dn", K * theta / mpmath.pi, m=modulus) ** 2 - E / K)) / kappa

    points = 128
    values = [tension(2 * mpmath.pi * k / points) for k in range(points)]
    d = -mpmath.fsum(values) / points
    omega = mpmath.pi * mpmath.sqrt(s) / K * mpmath.exp(kappa * d / 2)
    angles = [2 * mpmath.pi * k / points for k in range(points)]
    cosines = [2 * mpmath.fsum(v * mpmath.cos(n * x) for v, x in zip(values, angles, strict=True)) / points for n in range(30)]
    return omega, cosines


@pytest.mark.parametrize(("N", "q"), [(16, 1), (9, 4), (12, -2)])
def test_the_wave_of_the_toda_ring_is_where_the_theorem_says(N, q):
    """Against Jacobi's elliptic functions: frequency given to 40 places, amplitude and stretch from the closed form."""
    with mpmath.workdps(50):
        omega, cosines = cnoidal(N, abs(q), mpmath.mpf(1), mpmath.mpf("0.3"))  # toda:1/2 has exp(r)
        wave = symfpu.torus(Chain(N, potential="toda:1/2", ends="periodic"), (q,), frequencies=(mpmath.nstr(omega, 40),))
        found = prove_existence(wave)
        linear = 2 * mpmath.sin(mpmath.pi * abs(q) / N)
        A = mpmath.sqrt(N) * cosines[1] / linear
        assert abs(A) > 0.05
        sign = 1 if A * found.amplitude > 0 else -1  # half a period of the phase
        assert abs(sign * A - found.amplitude) < found.amplitude_radius < OF_DOUBLES
        claim = check_existence.read_claim(json.loads(json.dumps(found.certificate())))
        ours = {n: mpmath.ldexp(c, -claim.bits) for (n, _), c in claim.orbit.items()}
        distance = mpmath.fsum(abs(sign**n * cosines[n] - ours.get(n, 0)) for n in range(1, 30) if n * q % N)
        assert 0 < distance < found.radius
        assert all(abs(cosines[n]) < NO_HARMONIC for n in range(1, 30) if n * q % N == 0)


def test_the_wave_has_the_energy_of_its_particles():
    for name in WAVES:
        chain, seed, made, _ = WAVES[name]
        H = wave(chain, seed, made).energy()
        assert abs(float(wave_proof(name).energy) - H) < THOUSAND_ROUNDINGS * abs(H)


def test_members_of_a_segment_of_waves_are_in_its_intervals(tmp_path):
    chain, seed, made, _ = WAVES["wave"]
    width = Fraction(1, 10**5)
    found = prove_existence(wave(chain, seed, made), amplitude="0.5", half_width=width)
    assert "for every amplitude A" in checked(found, tmp_path)[0]
    for s in (-1, Fraction(1, 3), 1):
        member = symfpu.torus(chain, (seed,), amplitudes={seed: Fraction("0.5") + s * width})
        assert abs(member.frequency - found.frequency) < found.frequency_radius
        assert abs(member.energy() - float(found.energy)) < found.energy_radius


def test_what_the_theorem_is_not_about_is_refused():
    with pytest.raises(InputError, match="half the ring with fixed ends"):
        prove_existence(symfpu.unfold(orbit("alpha")))
    with pytest.raises(InputError, match="a chain with fixed ends"):
        symfpu.prove_stability(symfpu.torus(Chain(6, alpha="0.3", ends="periodic"), (1,), amplitudes={1: "0.1"}))
    with pytest.raises(InputError, match="polynomial"):
        prove_existence(symfpu.torus(Chain(4, potential=symfpu.from_expression("1 - cos(r)")), (1,), amplitudes={1: "0.1"}))
    torus = symfpu.solve_amplitudes(symfpu.lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3905", "0.7663"), 2))
    with pytest.raises(InputError, match="2 angles"):
        prove_existence(torus)
    with pytest.raises(InputError, match="str"):
        prove_existence("breather")
    with pytest.raises(InputError, match="one of the two"):
        prove_existence(orbit("alpha"), amplitude="0.4", energy="0.1")
    with pytest.raises(InputError, match=r"about that of the orbit, 0\.4"):
        prove_existence(orbit("alpha"), amplitude="0.3")
    with pytest.raises(InputError, match="from 0 to 1"):
        prove_existence(orbit("alpha"), half_width="-1")


@cache
def of_figure(seed, omega):
    return refine(symfpu.torus(FIG9, (seed,), frequencies=(omega,)), digits=32)


@cache
def of_energy(energy):
    """At H = 0.75 the family from rest follows harmonic 14 of mode 16, and has 115 harmonics."""
    return refine(symfpu.torus(FIG9, (1,), energy=energy), digits=30)


FIGURE_9 = (of_figure, 1, "0.09844127049688513")
OF_THE_PAPER = {  # an orbit, what is given exactly, the most bytes of the certificate
    "Fig. 7": ((of_figure, 1, "0.09814109959448596"), {}, 100_000),
    "Fig. 8": ((of_figure, 25, "1.8830741847088537"), {}, 100_000),
    "Fig. 9": (FIGURE_9, {}, 100_000),
    "Fig. 9, A": (FIGURE_9, {"amplitude": "1.27153895251014"}, 100_000),  # all digits that are printed
    "H = 0.014915": ((of_energy, "0.014915"), {}, 100_000),
    "H = 0.014915, H": ((of_energy, "0.014915"), {"energy": "0.014915"}, 100_000),
    "H = 0.75, H": ((of_energy, "0.75"), {"energy": "0.75"}, 150_000),
}


@pytest.mark.long
@pytest.mark.parametrize("name", OF_THE_PAPER)
def test_the_breathers_of_the_figures_exist(name, tmp_path):
    (make, *of), given, size = OF_THE_PAPER[name]
    orbit = make(*of)
    found = prove_existence(orbit, **given)
    assert found.radius < PROVED_RADIUS
    assert abs(found.frequency - orbit.frequency) < SAME_FREQUENCY
    assert checked(found, tmp_path)
    assert (tmp_path / "proof.json").stat().st_size < size


@pytest.mark.parametrize(("door", "of"), [(prove_existence, orbit), (symfpu.prove_stability, orbit), (symfpu.prove_stability, proof)])
def test_a_proof_that_would_not_fit_is_refused_before_it_is_begun(door, of, monkeypatch):
    given = of("alpha")
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=10_000))
    with pytest.raises(InputError, match="unknowns at once and needs about") as caught:
        door(given)
    assert caught.value.argument == "orbit"
