"""Proofs of stability: intervals hold the multipliers of another route, bounds are the checker's, and what is no exponent has none."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from symfpu.breathers.balance import breather_at_amplitude, periodic_orbit
from symfpu.breathers.floquet import floquet
from symfpu.certified import enclosures, exponents
from symfpu.certified.enclosures import NoStabilityProof, check_count, enclosed_exponent, slopes_of
from symfpu.certified.existence import prove_existence
from symfpu.certified.sectors import sectors_of
from symfpu.certified.stability_proof import gaps_of, orbit_of, prove_stability
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.files.progress import unheard
from symfpu.proofs import check_stability
from tests.tolerances import MULTIPLIER_OF_PROOF, ROUNDING_OF_RESIDUAL, SAME_BOUNDS

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
}
FIG = Chain(32, alpha="0.33")
# frequencies of Figs. 9, 8 and 7, as in tests/certified/test_existence.py
FIGURES = {"fig 9": (1, "0.09844127049688513"), "fig 8": (25, "1.8830741847088537"), "fig 7": (1, "0.09814109959448596")}


@cache
def orbit(name):
    return breather_at_amplitude(*(STABLE | UNSTABLE)[name])


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


@pytest.mark.parametrize("name", UNSTABLE)
def test_growing_solutions_are_those_of_the_integrator(name):
    found, integrated = proof(name), floquet(orbit(name))
    assert not found.stable
    assert found.gaps == ()
    values, radii = multipliers(found)
    for value, radius in zip(values, radii, strict=True):
        assert abs(integrated.multipliers - value).min() < radius
    rate = np.log(integrated.largest) * float(found.existence.frequency) / (2 * np.pi)
    least, most = found.growth
    assert 0 < least < rate < most


@pytest.mark.parametrize("name", ["alpha", "beta, even seed", "both, three bonds", "quadruple, odd seed", "period doubling"])
def test_the_checker_accepts_what_is_proved(name, tmp_path):
    found = proof(name)
    found.write(tmp_path / "proof.json")
    lines = check_stability.verify(tmp_path / "proof.json")
    assert ("linearly stable" if found.stable else "linearly unstable") in lines[0]


@pytest.mark.parametrize("name", ["alpha", "beta, even seed", "quadruple, odd seed", "period doubling"])
def test_the_checker_agrees_in_every_bound(name):
    """Y, Z, e1, e2 and e3, one in doubles and the other in integers."""
    data, rounded = proof(name).certificate(), orbit_of(proof(name).existence)
    sectors = sectors_of(rounded.chain, rounded.seed)
    found = [guess for sector in sectors for guess in exponents.guesses(rounded, sector)]
    tried = [guess for guess in found if not guess.circle] or found
    _, enclosed = enclosures.enclosed_all(rounded, data["existence"]["radius"], tried, unheard)
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
        gaps_of(rounded.omega, sectors, [one, one])


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
    with pytest.raises(InputError, match="exact frequency"):
        prove_stability(prove_existence(orbit("alpha"), amplitude="0.2"))


@pytest.mark.long
@pytest.mark.parametrize("name", ["fig 8", "fig 7"])
def test_the_breathers_of_the_figures_are_stable(name, tmp_path):
    found = prove_stability(periodic_orbit(FIG, *FIGURES[name]))
    assert found.stable
    assert len(found.exponents) == 30
    found.write(tmp_path / "proof.json")
    assert (tmp_path / "proof.json").stat().st_size < 60_000
    assert "linearly stable" in check_stability.verify(tmp_path / "proof.json")[0]


@pytest.mark.long
def test_the_breather_of_fig_9_is_stable(tmp_path):
    found = prove_stability(periodic_orbit(FIG, *FIGURES["fig 9"]))
    assert found.stable
    assert len(found.exponents) == 30
    assert found.gaps[0].least > 0.0015
    found.write(tmp_path / "proof.json")
    assert (tmp_path / "proof.json").stat().st_size < 100_000
    assert "linearly stable" in check_stability.verify(tmp_path / "proof.json")[0]


@pytest.mark.long
def test_a_large_orbit_with_two_quadruples_and_two_real_pairs():
    """N = 8, beta = 1, A = 3: four exponents that grow, each enclosed."""
    found, integrated = prove_stability(breather_at_amplitude(Chain(8, beta=1), 1, "3")), None
    integrated = floquet(breather_at_amplitude(Chain(8, beta=1), 1, "3"))
    values, radii = multipliers(found)
    assert len(values) == 4
    for value, radius in zip(values, radii, strict=True):
        assert abs(integrated.multipliers - value).min() < radius
