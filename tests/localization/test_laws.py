"""The paper's localization laws: against their algebra, hand-computed numbers and exact tori; and fitted lines with honest errors."""

import math
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

import symfpu
from symfpu import Chain, ProfileLine, breather_law, fit_profile, least_packet, middle_modes, packet_parameter, profile_law, rounding_floor
from tests.tolerances import HUNDRED_ROUNDINGS, LEAST_SQUARES, ROUNDING, SCATTER, THOUSAND_ROUNDINGS

ALPHA, BETA = Chain(N=64, alpha="0.33"), Chain(N=64, beta="0.3")
FIG_4A, FIG_4B = 1.5625e-8, 1.5625e-6  # specific energies


def test_parameters_by_hand():
    # 0.33^2 * 1.5625e-8 * 8^4 / pi^4 and 0.3 * 1.5625e-6 * 16^2 / pi^2, with pi^4 = 97.40909103400244, pi^2 = 9.869604401089358
    assert packet_parameter(ALPHA, 8, FIG_4A) == pytest.approx(6.9696e-6 / 97.40909103400244, rel=ROUNDING)
    assert packet_parameter(BETA, 4, FIG_4B) == pytest.approx(1.2e-4 / 9.869604401089358, rel=ROUNDING)
    assert packet_parameter(ALPHA.at(alpha="-0.33"), 8, FIG_4A) == packet_parameter(ALPHA, 8, FIG_4A)


def test_profile_laws_follow_from_the_group_energies():
    """Eq. eksa2 from eksa with k + 1/2 = kappa/M, and eksp2 from eksp with 2k = kappa/M, both with E = N eps: as printed."""
    alpha, beta, eps, M, N, kappa = sp.symbols("alpha beta epsilon M N kappa", positive=True)
    lam = alpha**2 * eps / sp.pi**4 / M**4
    k = kappa / M - sp.Rational(1, 2)
    e = (k + sp.Rational(1, 2)) ** 2 * eps / M * (alpha**2 * N**4 * eps / sp.pi**4 / (M * N) ** 4) ** k / (N * eps)
    printed = sp.log(lam) / M * kappa + 2 * sp.log(kappa) - sp.log(sp.sqrt(lam) * M**3 * N)
    assert sp.simplify(sp.expand_log(sp.log(e) - printed, force=True)) == 0
    e = eps / M * (beta**2 * eps**2 / sp.pi**4 / M**4) ** (kappa / M / 2) / (N * eps)
    printed = sp.log(beta * eps / sp.pi**2 / M**2) / M * kappa - sp.log(M * N)
    assert sp.simplify(sp.expand_log(sp.log(e) - printed, force=True)) == 0


@pytest.mark.parametrize(("chain", "s", "epsilon"), [(ALPHA, 8, FIG_4A), (BETA, 4, FIG_4B), (Chain(N=31, alpha=2), 5, 1e-3)])
def test_lines_are_the_group_energies(chain, s, epsilon):
    k = np.arange(1, 4)
    q = (k + 0.5) * s if chain.alpha else 2 * k * s
    expected = np.log10(symfpu.group_energy(chain, s, epsilon, k) / (chain.N * epsilon))
    for denominator in (None, chain.N, chain.N - 1):
        line = profile_law(chain, s, epsilon, denominator=denominator)
        assert line(q / (denominator or chain.N)) == pytest.approx(expected, rel=HUNDRED_ROUNDINGS)  # sums of a few terms up to 60


def test_caption_of_figure_2a():
    """The total energy H gives every printed digit; the harmonic energy, which the caption names, does not. The sign of 2 log is wrong."""
    chain = Chain(N=32, alpha="0.33")
    line = profile_law(chain, 4, 0.000182684 / 32)
    assert (f"{line.slope:.4f}", f"{line.intercept:.5f}", line.power) == ("-36.6613", "3.49545", 2.0)
    named = profile_law(chain, 4, 0.000182466 / 32)
    assert (f"{named.slope:.4f}", f"{named.intercept:.5f}") == ("-36.6654", "3.49571")


def test_caption_of_figure_4():
    """(a) is of N = 64 with kappa = q/(N-1), (b) of N = 256: the law's intercept depends on N."""
    a, b = profile_law(ALPHA, 8, FIG_4A, denominator=63), profile_law(Chain(N=256, beta="0.3"), 16, FIG_4B)
    assert (f"{a.slope:.2f}", f"{a.intercept:.2f}", a.power) == ("-56.27", "4.46", 2.0)
    assert (f"{b.slope:.2f}", f"{b.intercept:.3f}", b.power) == ("-78.64", "-1.204", 0.0)
    with_n = profile_law(ALPHA, 8, FIG_4A)
    assert (f"{with_n.slope:.2f}", f"{with_n.intercept:.2f}") == ("-57.16", "4.48")
    assert profile_law(replace(ALPHA, N=128), 16, FIG_4A).intercept == pytest.approx(with_n.intercept - math.log10(2), rel=ROUNDING)


def test_width_at_which_lambda_is_one():
    """lambda < 1 is s > alpha^(1/2) eps^(1/4) N / pi, or (beta eps)^(1/2) N / pi; the paper leaves out 1/pi."""
    assert least_packet(ALPHA, FIG_4A) == pytest.approx(64 * 0.33**0.5 * FIG_4A**0.25 / math.pi, rel=ROUNDING)
    assert least_packet(BETA, FIG_4B) == pytest.approx(64 * (0.3 * FIG_4B) ** 0.5 / math.pi, rel=ROUNDING)
    for chain, width in ((ALPHA, 7), (BETA, 3)):
        epsilon = math.pi**4 * (width / 64) ** 4 / 0.33**2 if chain.alpha else math.pi**2 * (width / 64) ** 2 / 0.3
        assert least_packet(chain, epsilon) == pytest.approx(width, rel=ROUNDING)
        assert packet_parameter(chain, width + 1, epsilon) < 1 < packet_parameter(chain, width - 1, epsilon)


def test_breather_law_is_the_leading_order():
    """Low energy, long chain: E_q/E_1 of the series, up to corrections of the linear frequencies, of relative size (pi q/N)^2."""
    chain = Chain(N=64, alpha="0.33")
    energy = 1e-9  # gamma is 3e-7
    spectrum = symfpu.torus(chain, (1,), energy=symfpu.Energy(energy, harmonic=True), method="series", order=4).average_spectrum()
    law = breather_law(chain, energy)
    assert spectrum[:4] / law[:4] == pytest.approx(np.ones(4), abs=(4 * math.pi / 64) ** 2)
    assert breather_law(chain, energy, 2 * energy) == pytest.approx(2 * law)


def test_almost_resonant_detuning():
    """Appendix E, iii: pi^3 m^3/(24 N^3) leaves out the seeds' own part, 1 - sum n^3/m^3: 3/4 for m = 2n, 1 only for m much above s."""
    Omega = Chain(N=1024, alpha=1).frequencies()
    for m, seeds in ((2, (1, 1)), (12, (5, 7)), (20, (6, 7, 7)), (60, (8,) * 7 + (4,))):
        detuning = abs(Omega[m - 1] - sum(Omega[n - 1] for n in seeds))
        ratio = detuning / (math.pi**3 * m**3 / (24 * 1024**3))
        assert ratio == pytest.approx(1 - sum(n**3 for n in seeds) / m**3, rel=(m * math.pi / 1024) ** 2)


def test_groups_and_their_middles():
    assert symfpu.packet_groups(Chain(N=16, alpha=1), 4) == (range(1, 5), range(5, 9), range(9, 13), range(13, 16))
    assert symfpu.packet_groups(Chain(N=16, beta=1), 2) == (range(1, 3), range(3, 7), range(7, 11), range(11, 15), range(15, 16))
    assert middle_modes(Chain(N=16, alpha=1), 4) == (6, 10, 14)
    assert middle_modes(Chain(N=16, beta=1), 2) == (4, 8, 12)
    assert middle_modes(Chain(N=5, alpha=1), 1) == (2, 3, 4)  # the only modes of D_k
    assert symfpu.packet_groups(Chain(N=5, alpha=1), 4) == (range(1, 5),)


@pytest.mark.parametrize("power", [2.0, None])
def test_fit_recovers_a_line(power):
    line = ProfileLine(-50.0, 3.0, 2.0)
    e = 10 ** line(np.arange(1, 64) / 64)
    e[:8] = (1 - e[8:].sum()) / 8  # a share each: the sum is 1
    fit = fit_profile(ALPHA, 7.0 * e, 8, power=power, floor=0.0)
    assert (fit.line.slope, fit.line.intercept, fit.line.power) == pytest.approx(
        (-50.0, 3.0, 2.0), rel=LEAST_SQUARES
    )  # lstsq, condition 1e3
    assert fit.modes == tuple(range(9, 64))
    assert max(fit.errors) < LEAST_SQUARES
    assert fit.scatter < THOUSAND_ROUNDINGS
    middle = fit_profile(ALPHA, e, 8, modes="middle", power=2.0, floor=0.0)
    assert middle.modes == middle_modes(ALPHA, 8)
    assert repr(middle).startswith("ProfileFit(log10 e = (-50 +- ")
    assert "+ 2 log10 kappa, 7 modes 12..60" in repr(middle)


def test_error_bars_are_those_of_repeated_draws():
    """Residuals common to a group, as in a staircase: the scatter of 300 fitted slopes is the error that the fits state."""
    chain, s, generator = Chain(N=128, alpha=1), 8, np.random.default_rng(3)
    line = ProfileLine(-100.0, 0.0)(np.arange(1, 128) / 128)  # steep: the sum is that of the seeds
    block, scatter = np.repeat(np.arange(16), 8)[:127], 0.3 * (np.arange(16) > 0)
    fits = [fit_profile(chain, 10 ** (line + (scatter * generator.standard_normal(16))[block]), s, floor=0.0) for _ in range(300)]
    for i, values in enumerate(([f.line.slope for f in fits], [f.line.intercept for f in fits])):
        stated = math.sqrt(np.mean([f.errors[i] ** 2 for f in fits]))
        # 300 draws: 4 %; the jackknife over 15 blocks is high by about 1/15, more at the ends: 20 % in all
        assert stated == pytest.approx(np.std(values), rel=SCATTER)


def test_modes_below_the_floor_are_never_used():
    kappa = np.arange(1, 64) / 64
    e = 10 ** ProfileLine(-50.0, 0.0)(kappa)
    noisy = np.maximum(e, 1e-23 * e[0])
    higher, highest = (tuple(q for q in range(9, 64) if e[q - 1] > floor) for floor in (1e-22 * e[0], 1e-18))
    fit = fit_profile(ALPHA, noisy, 8)
    assert fit.modes == higher
    assert fit.line.slope == pytest.approx(-50.0, rel=LEAST_SQUARES)
    assert fit_profile(ALPHA, noisy, 8, floor=np.full(63, 1e-18)).modes == highest
    assert fit_profile(ALPHA, noisy, 8, floor=0.0).line.slope > -35


def test_rounding_floor_is_what_rounding_leaves():
    """Modes without energy on T + V against the expected noise: a mean over twenty modes of random walks, within a factor 2."""
    chain, T = Chain(N=64, alpha="0.33"), 3e4
    Q, P = symfpu.fpu_trajectory(chain, symfpu.packet_amplitudes(chain, range(1, 9), FIG_4A * 64))
    orbit = symfpu.integrate(chain, Q, P, T, step=0.5, samples=1, averages=True)
    assert orbit.averages is not None
    noise = orbit.averages[-1][40:60] / rounding_floor(chain, orbit.averages[-1], T, step=0.5)[40:60]
    assert 0.5 < noise.mean() < 2
    assert not rounding_floor(chain, orbit.averages[-1], T, step=0.5, scheme="aba864_modes").any()


def test_line_prints_as_the_captions():
    assert repr(ProfileLine(-36.6613, 3.49545, -2.0)) == "log10 e = -36.6613 kappa + 3.49545 - 2 log10 kappa"
    assert float(ProfileLine(1.0, 2.0, 3.0)(0.1)) == pytest.approx(-0.9)


SPECTRUM = 10.0 ** -np.arange(63)
BAD = [
    (lambda: packet_parameter(Chain(N=8, alpha=1, beta=1), 2, 1e-3), "chain"),
    (lambda: profile_law("chain", 1, 1e-8), "chain"),
    (lambda: fit_profile(None, [1.0], 1), "chain"),
    (lambda: packet_parameter(ALPHA, 64, 1e-3), "s"),
    (lambda: packet_parameter(ALPHA, 8, -1e-3), "specific_energy"),
    (lambda: profile_law(ALPHA, 8, math.nan), "specific_energy"),
    (lambda: profile_law(ALPHA, 8, 1e-3, denominator=0), "denominator"),
    (lambda: breather_law(BETA, 1.0), "chain"),
    (lambda: breather_law(ALPHA, 0.0), "energy"),
    (lambda: symfpu.natural_packet(ALPHA, 1e-3, "1/3"), "chain, exponent"),
    (lambda: middle_modes(ALPHA, 0), "s"),
    (lambda: fit_profile(ALPHA, SPECTRUM[:5], 8), "spectrum"),
    (lambda: fit_profile(ALPHA, -SPECTRUM, 8), "spectrum"),
    (lambda: fit_profile(ALPHA, np.zeros(63), 8), "spectrum"),
    (lambda: fit_profile(ALPHA, SPECTRUM, 8, modes="all"), "modes"),
    (lambda: fit_profile(ALPHA, SPECTRUM, 8, modes=[5, 20, 30]), "modes"),
    (lambda: fit_profile(ALPHA, SPECTRUM, 8, modes=[9, 10, 11]), "modes"),
    (lambda: fit_profile(ALPHA, SPECTRUM, 8, modes="middle", floor=1e-20), "modes"),
    (lambda: fit_profile(ALPHA, SPECTRUM, 8, power=math.inf), "power"),
    (lambda: fit_profile(ALPHA, SPECTRUM, 8, floor=-1.0), "floor"),
    (lambda: fit_profile(ALPHA, SPECTRUM, 8, floor=np.ones(3)), "floor"),
    (lambda: rounding_floor(ALPHA, SPECTRUM, 0.0, step=0.5), "T"),
    (lambda: rounding_floor(ALPHA, SPECTRUM, 1e3, step=0.5, scheme="euler"), "scheme"),
]


@pytest.mark.parametrize(("call", "argument"), BAD)
def test_bad_input_is_named(call, argument):
    with pytest.raises(symfpu.InputError) as caught:
        call()
    assert caught.value.argument == argument
