"""Tori of chains of any potential: series against Newton's method, frequencies by order, energies, certificates, families."""

import itertools
import math

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.families.appendix_a import appendix_a
from symfpu.families.following import family
from symfpu.localization.laws import middle_modes, packet_groups, packet_parameter
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.tori import refine, refine_at_amplitudes, refine_at_energy
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.at_energy import torus_at_energy
from symfpu.tori.frequencies import torus_at_amplitudes
from symfpu.tori.resummation import resum
from symfpu.tori.verdict import assess
from tests.tolerances import FIXED_ENERGY, FOUR_DIGITS, PROMISED_RESIDUAL, SLOPE

# laws with an amplitude at which series converge
LAWS = {"toda:1/2": 0.2, "lj:12,6": 0.01, "poly:1/3,0,1/5,-1/4": 0.2, "poly:0,1/2,0,1/3": 0.4}
EVERY_LAW = pytest.mark.parametrize("law", LAWS)


@EVERY_LAW
@pytest.mark.parametrize(("N", "seeds"), [(2, (1,)), (8, (1, 2)), (9, (2, 5))])
def test_refined_tori_solve_the_closed_equations_of_motion(law, N, seeds):
    chain = Chain(N, potential=law)
    guess = torus_at_amplitudes(chain, {q: LAWS[law] / q for q in seeds}, order=4)
    torus = refine(guess)
    assert torus.residual() < PROMISED_RESIDUAL
    assert guess.residual() > 1e3 * torus.residual()
    assert not torus.warnings


@pytest.mark.long
@EVERY_LAW
def test_frequencies_of_series_err_by_the_next_order(law):
    """As A^(K+2), or A^(2K+2) where V is even: omega goes by squares of the amplitudes."""
    chain = Chain(8, potential=law)
    errors = {}
    for K, part in itertools.product((2, 4), (1, 0.5)):
        amplitudes = {1: part * LAWS[law], 2: part * LAWS[law] / 2}
        series = torus_at_amplitudes(chain, amplitudes, order=K)
        exact = refine_at_amplitudes(series, amplitudes)
        off = [float(a - b) for a, b in zip(series.frequencies, exact.frequencies, strict=True)]
        errors[K, part] = max(map(abs, off))
    for K in (2, 4):
        rate = math.log2(errors[K, 1] / errors[K, 0.5])
        due = 2 * K + 2 if chain.potential.even else K + 2
        # the even one falls by 2^10 at K = 4, to some rounding of omega - Omega
        assert rate == pytest.approx(due, abs=5 * SLOPE), K


@EVERY_LAW
def test_a_torus_has_the_energy_asked_for_and_its_verdict(law):
    chain = Chain(8, potential=law)
    energy = "1e-6" if law == "lj:12,6" else "3e-4"
    torus = torus_at_energy(chain, (1, 2), energy, harmonic=False, order=6)
    assert float(torus.energy()) == pytest.approx(float(energy), rel=FIXED_ENERGY)
    assert assess(torus.series, torus).word == "converged"
    assert resum(torus).residual() < 10 * torus.residual()
    refined = refine_at_energy(torus, energy, harmonic=False)
    assert float(refined.energy()) == pytest.approx(float(energy), rel=FIXED_ENERGY)


@EVERY_LAW
def test_roots_are_certified(law):
    chain = Chain(8, potential=law)
    exact = refine_at_amplitudes(torus_at_amplitudes(chain, {1: LAWS[law]}, order=4), {1: LAWS[law]})
    torus = solve_amplitudes(lindstedt(chain, (1,), exact.frequencies, 8, digits=30))
    assert torus.certificate.certified
    assert float(torus.amplitudes[1]) == pytest.approx(LAWS[law], rel=FOUR_DIGITS)


@pytest.mark.parametrize(("law", "odd_alone"), [("poly:0,1/2,0,1/3", True), ("poly:0,0,1/5", False), ("toda:1", False)])
def test_even_potentials_leave_harmonics_of_even_length_out(law, odd_alone):
    harmonics = np.array([[1, 0], [0, 1], [1, 1], [2, 0], [2, 1]])
    mask = InvarianceEquation(Chain(6, potential=law), (1, 2), harmonics).mask
    assert mask.any(axis=1).tolist() == [True, True, not odd_alone, not odd_alone, True]


@pytest.mark.parametrize("law", ["toda:1/2", "poly:0,1/2,0,1/3"])
def test_families_and_appendix_a_serve_every_potential(law, tmp_path):
    chain = Chain(6, potential=law)
    members = family(chain, (1,), "0.02", folder=tmp_path / "kept").members
    energies = [float(member.torus.energy()) for member in members]
    assert energies == sorted(energies)
    assert max(member.torus.residual() for member in members) < PROMISED_RESIDUAL
    again = family(chain, (1,), "0.02", folder=tmp_path / "kept").members
    assert [float(member.torus.energy()) for member in again] == energies
    with pytest.raises(InputError, match="the same family"):
        family(chain.at(N=7), (1,), "0.02", folder=tmp_path / "kept")
    steps = appendix_a(chain, (1, 2), {1: "0.1", 2: "0.05"}, 3, members=3)
    assert len(steps.members) == 3


def test_groups_of_packets_go_by_parity():
    assert packet_groups(Chain(8, potential="toda:1"), 2) == packet_groups(Chain(8, alpha=1), 2)
    assert packet_groups(Chain(12, potential="poly:0,1,0,1"), 2) == packet_groups(Chain(12, beta=1), 2)
    assert middle_modes(Chain(12, potential="poly:0,1,0,1"), 3) == middle_modes(Chain(12, beta=1), 3)
    assert middle_modes(Chain(12, potential="poly:0,0,1"), 3) == middle_modes(Chain(12, alpha=1), 3)


def test_laws_of_alpha_and_beta_refuse_other_potentials_by_name():
    with pytest.raises(InputError, match=r"chain = Chain\(N=8, potential=toda\(1\)\)"):
        packet_parameter(Chain(8, potential="toda:1"), 2, 1e-3)
