"""The family from rest: it never changes to another one, and what is asked for does not steer it."""

from itertools import islice

import numpy as np
import pytest

import symfpu
from symfpu import Chain, Event, NoBreatherAtEnergy
from symfpu.breathers.curve import Linearisation
from symfpu.breathers.equations import Balance
from symfpu.breathers.from_rest import AVOIDED, FOLLOWED, PASSED, FromRest
from tests.tolerances import PROMISED_RESIDUAL, SAME_ORBIT, SIX_PLACES, TEN_PLACES, TWO_DIGITS

NEAR_FIVE = Chain(8, beta=1)  # 5 omega_1 meets mode 7 near H = 0.15; three orbits have H = 0.171057


def test_the_family_follows_the_wide_gap_of_harmonic_5():
    """A and c_7[5] are those of a continuation in all coefficients with steps of 0.005."""
    orbit = symfpu.torus(NEAR_FIVE, (1,), energy="0.171057")
    assert orbit.amplitude == pytest.approx(1.41476, abs=SIX_PLACES)
    assert orbit.cosines[5, 6] == pytest.approx(-0.0814, abs=1e2 * SIX_PLACES)
    assert symfpu.torus(NEAR_FIVE, (1,), energy="0.3").amplitude == pytest.approx(1.580651, abs=SIX_PLACES)


# chain, seed, H: A, omega, harmonic, mode, coefficient. By pseudo-arclength in all coefficients of harmonic balance, steps of 0.005 from
# A = 0.1 for N = 8; for N = 32 steps of 0.004 to 0.02 from A = 3.66, reached by amplitude over the narrow gaps below. No program of symfpu.
DENSE = {
    "N = 8": (NEAR_FIVE, "2.5944164372390675", 2.99939261817, 0.471634096461, 5, 7, -0.793128217633),
    "N = 32": (Chain(32, alpha="0.33"), "0.748427948262504", 3.74724917047, 0.100903478530, 14, 16, 0.557042600381),
}


@pytest.mark.parametrize("name", ["N = 8", pytest.param("N = 32", marks=pytest.mark.long)])
def test_the_family_is_that_of_a_dense_continuation(name):
    """Far beyond the wide gaps of mode 7 and mode 16, whose harmonics grow to a quarter and a seventh of the amplitude."""
    chain, energy, amplitude, omega, harmonic, mode, coefficient = DENSE[name]
    orbit = symfpu.torus(chain, (1,), energy=energy)
    assert orbit.amplitude == pytest.approx(amplitude, rel=TEN_PLACES)
    assert float(orbit.frequency) == pytest.approx(omega, rel=TEN_PLACES)
    assert orbit.cosines[harmonic, mode - 1] == pytest.approx(coefficient, rel=TEN_PLACES)


def test_energy_amplitude_and_frequency_lead_to_one_orbit():
    by_energy = symfpu.torus(NEAR_FIVE, (1,), energy="0.2")
    for other in (
        symfpu.torus(NEAR_FIVE, (1,), amplitudes={1: by_energy.amplitude}),
        symfpu.torus(NEAR_FIVE, (1,), frequencies=(by_energy.frequency,)),
    ):
        assert other.energy() == pytest.approx(0.2, rel=SAME_ORBIT)
        assert other.cosines[5, 6] == pytest.approx(by_energy.cosines[5, 6], rel=SAME_ORBIT)


def test_a_negative_amplitude_is_the_same_orbit_half_a_period_later():
    orbit, other = (symfpu.torus(Chain(8, alpha="0.4"), (3,), amplitudes={3: A}) for A in ("0.4", "-0.4"))
    assert other.amplitude == -0.4
    assert (other.frequency, other.energy()) == (orbit.frequency, pytest.approx(orbit.energy(), rel=SAME_ORBIT))
    half = np.pi / float(orbit.frequency)
    assert other.Q(0.0) == pytest.approx(orbit.Q(half), abs=SAME_ORBIT)


def walked(chain, seed, steps):
    walk = FromRest(chain, seed)
    for _, _ in zip(range(steps), walk, strict=False):
        pass
    return walk


def test_a_narrow_gap_is_passed_and_named():
    """N = 16, beta = 1: harmonic 9 meets mode 11 at A = 0.77225, over a millionth of the amplitude."""
    walk = walked(Chain(16, beta=1), 1, 6)
    [passage] = walk.passages
    assert passage.what == PASSED
    assert (passage.gap.mode, passage.gap.harmonic) == (11, 9)
    assert passage.gap.amplitude == pytest.approx(0.77225, abs=SIX_PLACES)
    assert passage.gap.width < 10 * SIX_PLACES
    before, after = walk.points[passage.after : passage.after + 2]
    assert before.amplitude < passage.gap.amplitude < after.amplitude
    assert after.index - before.index == 1
    assert symfpu.torus(Chain(16, beta=1), (1,), amplitudes={1: "0.8"}).residual() < PROMISED_RESIDUAL  # beyond it


def test_a_wide_gap_is_followed_and_named():
    walk = walked(NEAR_FIVE, 1, 14)
    [passage] = walk.passages
    assert passage.what == FOLLOWED
    assert (passage.gap.mode, passage.gap.harmonic) == (7, 5)
    assert len({point.index for point in walk.points}) == 1


def test_a_gap_near_the_limit_says_so():
    """Both sides of 1e-3 are named with the width, and the limit is said where another step may decide otherwise."""
    near, far = (Event("resonance", FOLLOWED, 3, 0.1, width, mode=7, harmonic=(5,)) for width in (1.1e-3, 0.015))
    assert repr(near).endswith("followed, its gap is 0.0011 of the amplitude, near the limit 0.001 of narrow ones")
    assert repr(far).endswith("followed, its gap is 0.015 of the amplitude")


@pytest.mark.long
def test_a_family_that_turns_back_at_a_gap_avoids_it():
    """N = 16, beta = 1: A turns at H = 0.773 and the energy at 0.8127; the family comes back along harmonic 9 of mode 11 to where
    its narrow gap was passed."""
    chain = Chain(16, beta=1)
    walk = walked(chain, 1, 44)
    assert [p.what for p in walk.passages] == [PASSED, AVOIDED, PASSED]
    first, wide, last = (p.gap for p in walk.passages)
    assert {(gap.mode, gap.harmonic) for gap in (first, wide, last)} == {(11, 9)}
    assert last.amplitude == pytest.approx(first.amplitude, abs=SIX_PLACES)
    assert max(p.amplitude for p in walk.points) == pytest.approx(4.834316, abs=1e4 * SIX_PLACES)
    with pytest.warns(UserWarning, match=r"A = 4\.83023 is the first orbit of this energy, .* again near A = 4\.5"):
        orbit = symfpu.torus(chain, (1,), energy="0.79")
    assert orbit.amplitude == pytest.approx(4.830228, abs=SIX_PLACES)


@pytest.mark.parametrize("chain", [NEAR_FIVE, pytest.param(Chain(16, alpha="0.33"), marks=pytest.mark.long)], ids=repr)
def test_limit_and_steps_change_neither_gaps_nor_points(chain, monkeypatch):
    """The limit of narrow gaps by a tenth, steps by a third: gaps have the same widths to two digits, and the same orbits follow."""
    energy = "0.3" if chain == NEAR_FIVE else "0.05"

    def found():
        return symfpu.torus(chain, (1,), energy=energy), walked(chain, 1, 12).passages

    orbit, passages = found()
    for name, value in (("NARROW", 0.9e-3), ("NARROW", 1.1e-3), ("LONGEST", 0.7)):
        with monkeypatch.context() as patched:
            patched.setattr(f"symfpu.breathers.from_rest.{name}", value)
            same, others = found()
        assert same.amplitude == pytest.approx(orbit.amplitude, rel=SAME_ORBIT)
        for passage, other in zip(passages, others, strict=False):
            assert (other.what, other.gap.mode, other.gap.harmonic) == (passage.what, passage.gap.mode, passage.gap.harmonic)
            assert other.gap.width == pytest.approx(passage.gap.width, rel=TWO_DIGITS)


def test_the_index_counts_the_negative_eigenvalues():
    balance = Balance(Chain(6, alpha="0.3"), 1, 7)
    z = np.linspace(1, 0.1, len(balance.n) + 1) / 10
    slopes, gradient = balance.slopes(z), (balance.n**2 * z[:-1])[:, None]
    jacobian = np.column_stack([balance.image(slopes, z, unit) for unit in np.eye(len(balance.n))])
    matrix = np.block([[balance.weights[:, None] * jacobian, gradient], [gradient.T, np.zeros((1, 1))]])
    assert matrix == pytest.approx(matrix.T, abs=SAME_ORBIT)
    assert Linearisation(balance, z).index == (np.linalg.eigvalsh(matrix) < 0).sum()


def test_energies_beyond_a_turn_are_refused():
    """V = r^2/2 - r^4/4 has a maximum: no oscillation is above it."""
    with pytest.raises(NoBreatherAtEnergy, match="ended because") as failure:
        symfpu.torus(Chain(4, beta=-1), (2,), energy="5")
    assert failure.value.reached < 5


def test_an_orbit_of_the_walk_is_found_by_its_own_frequency():
    """Up to near a barrier, where energies are alike to rounding; what lies on a point of the walk has no direction from it."""
    chain = Chain(6, alpha="0.4")
    for point in list(islice(FromRest(chain, 4), 22))[9::4]:
        found = symfpu.torus(chain, (4,), frequencies=(point.balance.frequency(point.z),))
        assert found.amplitude == pytest.approx(point.amplitude, rel=TEN_PLACES)
