"""Proofs of stability: intervals hold the multipliers of another route, bounds are the checker's, and what is no exponent has none."""

import copy
from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, NoStabilityProof, floquet, prove_existence, prove_stability
from symfpu.certified import enclosures, exponents
from symfpu.certified.enclosures import check_count, enclosed_exponent, slopes_of
from symfpu.certified.exponent_bounds import Attempt
from symfpu.certified.sectors import sectors_of
from symfpu.certified.stability_proof import Interval, gaps_of, orbit_of
from symfpu.checkers import stability as check_stability
from symfpu.numbers.one_sided import above, below
from tests.breather import breather_of
from tests.tolerances import MOVED_INVERSE, MULTIPLIER_OF_PROOF, ROUNDING_OF_RESIDUAL, SAME_BOUNDS

STABLE = {
    "alpha": (Chain(4, alpha="0.3"), 1, "0.2"),
    "alpha, even seed": (Chain(8, alpha="0.3"), 2, "0.2"),
    "alpha, wrapped modes": (Chain(7, alpha="0.4"), 5, "0.1"),
    "two bonds": (Chain(2, beta=1), 1, "0.3"),
    "beta, even seed": (Chain(6, beta="0.5"), 2, "0.2"),
    "beta, a bond at rest": (Chain(5, beta="0.5"), 1, "0.3"),
    "beta, odd seed": (Chain(4, beta="0.5"), 3, "0.2"),
    "both, three bonds": (Chain(3, alpha="0.3", beta="1/7"), 1, "0.3"),
    "a polynomial": (Chain(5, potential="poly:0.3,0.1,-1/5,0,1/9"), 2, "0.2"),
    "toda": (Chain(6, potential="toda:1/2"), 1, "0.3"),
    "morse, even seed": (Chain(6, potential="morse:1"), 2, "0.1"),
    "lennard-jones": (Chain(5, potential="lj:12,6"), 1, "0.01"),
}
# found by floquet along families: two complex quadruples and one real multiplier below -1
UNSTABLE = {
    "quadruple, even seed": (Chain(6, beta=1), 4, "0.6"),
    "quadruple, odd seed": (Chain(8, beta=1), 3, "0.8"),
    "period doubling": (Chain(4, alpha="0.5", beta=1), 2, "2"),
    "two quadruples, real pair": (Chain(8, beta=1), 1, "3"),
}
GROWING = {"two quadruples, real pair": 3}  # exponents with a real part
FIG = Chain(32, alpha="0.33")
# frequencies of Figs. 9, 8 and 7, as in tests/certified/test_existence.py
FIGURES = {"fig 9": (1, "0.09844127049688513"), "fig 8": (25, "1.8830741847088537"), "fig 7": (1, "0.09814109959448596")}


@cache
def orbit(name):
    return breather_of(*(STABLE | UNSTABLE)[name])


@cache
def proof(name):
    return prove_stability(orbit(name))


def multipliers(found):
    """exp(2 pi i sigma / omega) and how far each may be from the true one."""
    omega = float(found.existence.frequency)
    values = np.array([one.multiplier(omega) for one in found.exponents])
    radii = np.array([one.radius for one in found.exponents]) * 2 * np.pi / omega
    return values, radii * abs(values) * 1.01 + MULTIPLIER_OF_PROOF


@pytest.mark.parametrize("name", STABLE)
def test_every_multiplier_of_a_stable_orbit_is_in_one_interval(name):
    found, integrated = proof(name), floquet(orbit(name))
    assert found.stable
    assert integrated.stable
    assert len(found.exponents) == orbit(name).chain.N - 2
    values, radii = multipliers(found)
    for pair in integrated.pairs[1:]:
        inside = np.abs(values[:, None] - pair).min(axis=1) < radii
        assert inside.sum() == 1


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in GROWING)) for name in UNSTABLE])
def test_growing_solutions_are_those_of_the_integrator(name):
    found, integrated = proof(name), floquet(orbit(name))
    assert not found.stable
    assert found.gaps == ()
    values, radii = multipliers(found)
    assert len(values) == GROWING.get(name, 1)
    for value, radius in zip(values, radii, strict=True):
        assert abs(integrated.multipliers - value).min() < radius
    rate = np.log(integrated.largest) * float(found.existence.frequency) / (2 * np.pi)
    least, most = found.growth
    assert 0 < least < rate < most


def checked(found, folder):
    """Whether the checker accepts the proof; the bytes of its file."""
    file = folder / "proof.json"
    found.write(file)
    assert ("linearly stable" if found.stable else "linearly unstable") in check_stability.verify(file)[0]
    return file.stat().st_size


FOUR = ["alpha", "beta, even seed", "quadruple, odd seed", "period doubling"]


@pytest.mark.parametrize("name", [*FOUR, "both, three bonds"])
def test_the_checker_accepts_what_is_proved(name, tmp_path):
    assert checked(proof(name), tmp_path)


def enclosed_again(name):
    """A certificate; the slopes and the exponents enclosed, as the prover does."""
    data, rounded = proof(name).certificate(), orbit_of(proof(name).existence)
    sectors = sectors_of(rounded.chain, rounded.seed)
    found = [guess for sector in sectors for guess in exponents.guesses(rounded, sector)]
    tried = [guess for guess in found if not guess.circle] or found
    return data, *enclosures.enclosed_all(rounded, data["existence"]["radius"], tried, lambda *told: None)


@pytest.mark.parametrize("name", FOUR)
def test_the_checker_agrees_in_every_bound(name):
    """Y, Z, e1, e2 and e3, one in doubles and the other in integers."""
    data, _, enclosed = enclosed_again(name)
    orbit_of_file = check_stability.orbit_of(data["existence"])
    slopes = check_stability.Slopes(orbit_of_file, data["slope_harmonics"])
    for entry, one in zip(data["exponents"], enclosed, strict=True):
        exponent = check_stability.read_exponent(entry, orbit_of_file, data["free"])
        bounds = check_stability.Bounds(slopes, exponent, data["free"])
        theirs = [1 + bounds.linear(), *bounds.curvature()]
        ours = [1 + one.bounds.linear, *one.bounds.curvatures]
        np.testing.assert_allclose(ours, list(map(float, theirs)), rtol=SAME_BOUNDS)
        assert 1 - SAME_BOUNDS < one.bounds.residual / float(bounds.residual()) < ROUNDING_OF_RESIDUAL


def test_gaps_are_the_distances_between_exponents():
    found = proof("alpha, even seed")
    omega = float(found.existence.frequency)
    for sector in (0, 1):
        own = sorted(one.sigma.real / omega for one in found.exponents if one.sector == sector)
        distances = np.diff([0.0, *own, 0.5])
        gaps = sorted((gap for gap in found.gaps if gap.sector == sector), key=lambda gap: gap.least)
        for gap, distance in zip(gaps, sorted(distances), strict=True):
            assert gap.least < distance < gap.most


def one_guess(name):
    """The slopes of an orbit and the guesses of its first sector."""
    found = prove_existence(orbit(name))
    rounded = orbit_of(found)
    slopes = slopes_of(rounded, 0 * rounded.omega, enclosures.FIRST_CUT, enclosures.FIRST_REACH)
    return rounded, slopes, exponents.guesses(rounded, sectors_of(rounded.chain, rounded.seed)[0])


def test_what_is_no_exponent_is_refused():
    """A guess halfway between two exponents: Newton's method leaves it."""
    _, slopes, guesses = one_guess("alpha")
    middle = sum(guess.value for guess in guesses) / 2
    with pytest.raises(NoStabilityProof, match="Newton") as caught:
        enclosed_exponent(slopes, replace(guesses[0], value=middle), abs(guesses[0].value - middle) / 4)
    assert caught.value.value > caught.value.needed


def test_a_wrong_linearisation_has_no_proof(monkeypatch):
    """Solutions of other equations, slopes wrong by 1 in 1000, do not meet Y."""
    _, slopes, guesses = one_guess("alpha")
    whole = enclosures.FourierSystem

    def wrong(sector, omega, linear, coupling, harmonics):
        return whole(sector, omega, linear, 1.001 * coupling, harmonics)

    monkeypatch.setattr(enclosures, "FourierSystem", wrong)
    with pytest.raises(NoStabilityProof) as caught:
        enclosed_exponent(slopes, guesses[0], 1e-3)
    assert caught.value.bound in ("Y", "gap")


def test_a_missing_exponent_and_a_collision_are_named():
    rounded, slopes, guesses = one_guess("alpha")
    sectors = sectors_of(rounded.chain, rounded.seed)
    with pytest.raises(NoStabilityProof, match="number of exponents"):
        check_count(sectors, [guesses[1:]])
    one = enclosed_exponent(slopes, guesses[0], 0.1)
    with pytest.raises(NoStabilityProof, match="gap"):
        gaps_of(Interval(rounded.omega, Fraction(0)), sectors, [one, one])


def test_an_orbit_that_is_not_well_known_has_no_proof():
    """Its own radius enters: a ball as wide as the exponents' distances encloses nothing."""
    rounded, _, guesses = one_guess("alpha")
    wide = slopes_of(rounded, rounded.omega / 20, enclosures.FIRST_CUT, enclosures.FIRST_REACH)
    with pytest.raises(NoStabilityProof):
        enclosed_exponent(wide, guesses[0], 0.1)


def test_a_proof_of_existence_is_not_made_again():
    found = prove_existence(orbit("alpha"))
    assert prove_stability(found).existence is found


def test_what_the_theorem_is_not_about_is_refused():
    with pytest.raises(InputError, match="not a segment"):
        prove_stability(prove_existence(orbit("alpha"), amplitude="0.2", half_width="1e-6"))
    with pytest.raises(InputError, match="beside a proof"):
        prove_stability(prove_existence(orbit("alpha")), amplitude="0.2")


@cache
def middle_mode():
    """Mode N/2 in alpha alone moves harmonically: every amplitude has the frequency sqrt(2)."""
    return symfpu.torus(Chain(4, alpha="1/2"), (2,), amplitudes={2: "1"})


@pytest.mark.parametrize("given", [{"amplitude": "1"}, {"energy": "1"}])
def test_a_mode_whose_frequency_does_not_change_is_proved_by_its_amplitude(given, tmp_path):
    with pytest.raises(symfpu.NoExistenceProof, match="amplitude= or energy="):
        prove_stability(middle_mode())
    found = prove_stability(middle_mode(), **given)
    integrated = floquet(middle_mode())
    least, most = found.growth
    assert least < np.log(integrated.largest) * np.sqrt(2) / (2 * np.pi) < most
    assert (below(least, 6), above(most, 6)) == ("0.0487994", "0.0487995")
    assert not found.stable
    assert checked(found, tmp_path)


@pytest.mark.parametrize("name", FOUR)
def test_a_frequency_in_an_interval_gives_the_same_exponents(name, tmp_path):
    amplitude = (STABLE | UNSTABLE)[name][-1]
    exact, given = proof(name), prove_stability(orbit(name), amplitude=amplitude)
    assert given.stable == exact.stable
    for a, b in zip(exact.exponents, given.exponents, strict=True):
        assert abs(a.sigma - b.sigma) <= a.radius + b.radius
    for a, b in zip(exact.gaps, given.gaps, strict=True):
        assert a.least < b.most
        assert b.least < a.most
    assert checked(given, tmp_path)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("name", FOUR)
def test_bounds_hold_for_every_frequency_of_the_interval(name, sign):
    """Y and Z at the ends of an interval of 1e-6, with and without the interval in the bounds; the checker's, too."""
    off = Fraction(1, 10**6)
    data, slopes, enclosed = enclosed_again(name)
    known = check_stability.orbit_of(data["existence"])
    there, wide = known._replace(omega=known.omega + sign * off), known._replace(omega_off=off)
    both = check_stability.Slopes(known, data["slope_harmonics"])
    for entry, one in zip(data["exponents"], enclosed, strict=True):
        at_end = replace(slopes, omega=slopes.omega + sign * float(off))
        ends, within = (Attempt(changed, one.zero).bounds(one.choice) for changed in (at_end, replace(slopes, omega_off=float(off))))
        assert ends.residual < within.residual * MOVED_INVERSE < 10 * ends.residual
        assert ends.linear < within.linear * MOVED_INVERSE
        theirs = []
        for changed in (there, wide):
            exponent = check_stability.read_exponent(entry, changed, data["free"])
            theirs.append(check_stability.Bounds(both_of(both, changed), exponent, data["free"]))
        assert theirs[0].residual() < theirs[1].residual() * Fraction(MOVED_INVERSE)
        assert theirs[1].residual() < within.residual * (1 + SAME_BOUNDS)
        assert theirs[0].linear() < theirs[1].linear() * Fraction(MOVED_INVERSE)


def both_of(slopes, changed):
    """The same slopes, which do not depend on the frequency, of another orbit."""
    other = copy.copy(slopes)
    other.orbit = changed
    return other


@pytest.mark.long
@pytest.mark.parametrize(("name", "size", "gap"), [("fig 8", 60_000, 0.0), ("fig 7", 60_000, 0.0), ("fig 9", 100_000, 0.0015)])
def test_the_breathers_of_the_figures_are_stable(name, size, gap, tmp_path):
    """Fig. 9 takes three minutes: the theorem of docs/existence.md, of the largest orbit and the narrowest gap."""
    seed, frequency = FIGURES[name]
    found = prove_stability(symfpu.torus(FIG, (seed,), frequencies=(frequency,)))
    assert found.stable
    assert len(found.exponents) == 30
    assert found.gaps[0].least > gap
    assert checked(found, tmp_path) < size
