"""Alignment indices: known tori, a chaotic orbit, and the same volumes in a hundred digits."""

from functools import cache

import mpmath
import numpy as np
import pytest

from symfpu import Chain, InputError, SymfpuError, alignment_indices, lindstedt, refine, solve_amplitudes
from symfpu.dynamics.alignment import random_frame
from symfpu.dynamics.schemes import particle_scheme
from symfpu.dynamics.tangent import tangent_steps
from tests import tolerances
from tests.refusals import each, refused
from tests.tolerances import ENERGY_STEPS, LOG_SPACING, LYAPUNOV, OBSERVED_ORDER, REGULAR_EXPONENT, SAME_VOLUME, WHOLE_NUMBERS

BETA, ALPHA = Chain(8, beta=1), Chain(8, alpha="0.5")

# Slopes over the last decade and a half: waves around a power law, an order of magnitude below one.
SLOPE = 0.25


@cache
def two_torus():
    """Modes 2 and 5 of an alpha chain of eight bonds, exact to rounding; shifts of a part in 300."""
    linear = ALPHA.frequencies()
    frequencies = [repr(float(linear[q - 1]) - shift) for q, shift in ((2, 0.003), (5, 0.004))]
    torus = refine(solve_amplitudes(lindstedt(ALPHA, (2, 5), frequencies, 6)))
    return torus.Q(0.0), torus.P(0.0)


@cache
def found(name):
    if name == "one mode":  # beta, mode N/2: it excites no other
        return alignment_indices(BETA, [0, 0, 0, 0.3, 0, 0, 0], np.zeros(7), 1e5, frames=1)
    if name == "two modes":
        return alignment_indices(ALPHA, *two_torus(), 1e5, vectors=14, frames=1)
    return alignment_indices(BETA, *chaotic_state(3), 1e3, step=0.1, frames=1)


def chaotic_state(seed=1):
    random = np.random.default_rng(seed)
    return random.normal(size=7), random.normal(size=7)


def test_a_periodic_orbit_has_dimension_one():
    indices = found("one mode")
    for k, slope in enumerate(indices.slopes(), start=2):
        assert slope.k == k
        assert slope.value == pytest.approx(1 - k, abs=SLOPE)
        assert slope.error < SLOPE
    dimension = indices.dimension()
    assert (dimension.verdict, dimension.value) == ("regular, dimension 1", 1)
    assert dimension.error < 0.1
    assert sum(dimension.weights.values()) == pytest.approx(1)
    assert "dimension 1" in repr(indices)


def test_a_two_torus_has_dimension_two_and_all_fourteen_exponents():
    """Constant for k = 2, then t^-(k-2) up to k = 12 = 2n - s, then t^-2(k-7)."""
    indices = found("two modes")
    exponents = [0, *(2 - k for k in range(3, 13)), -12, -14]
    assert [s.value for s in indices.slopes()] == pytest.approx(exponents, abs=SLOPE)
    assert (indices.dimension().verdict, indices.dimension().value) == ("regular, dimension 2", 2)
    assert np.all(np.diff(indices.log10_gali, axis=1) <= 0)
    assert indices.energy_error < tolerances.ENERGY_LONG_STEPS


def test_a_chaotic_orbit_decays_exponentially():
    """log GALI_k falls with t, not log t; the Lyapunov exponent settles at a positive value; vectors of another seed find it too."""
    indices = found("chaotic")
    late = indices.times > 100
    for values in indices.log10_gali[:, 1:].T:
        straight, bent = (np.corrcoef(x[late], values[late])[0, 1] for x in (indices.times, np.log(indices.times)))
        assert straight < -0.98
        assert straight < bent
    assert indices.log10_gali[-1, -1] < -100
    assert 0.15 < indices.lyapunov[-1] < 0.25
    assert indices.energy_error < ENERGY_STEPS
    assert indices.dimension().verdict == "chaotic"
    other = alignment_indices(BETA, *chaotic_state(3), 1e3, step=0.1, seed=5, frames=1)
    assert other.lyapunov[-1] == pytest.approx(indices.lyapunov[-1], abs=LYAPUNOV)
    regular = found("one mode")
    assert regular.lyapunov[-1] == pytest.approx(np.log(1e5) / 1e5, rel=REGULAR_EXPONENT)


def test_volumes_agree_with_a_hundred_digits_where_doubles_underflow_their_accuracy():
    """The maps of single blocks, multiplied and made into volumes in 100 digits: GALI_9 is 1e-33, beyond any double Gram matrix.

    The time is so short that rounding in the orbit grows by e^10 only.
    """
    T, step, steps, vectors = 104.0, 0.25, 16, 9
    indices = alignment_indices(BETA, *chaotic_state(), T, step=step, samples=64, vectors=vectors, frames=1)
    eye, (Q, P) = np.eye(14), chaotic_state()
    with mpmath.workdps(100):
        V = mpmath.matrix(np.hstack(random_frame(vectors, 7, 0)).T.tolist())
        for _ in range(round(T / step) // steps):
            Q, P, dQ, dP = tangent_steps(BETA, Q, P, eye[:, :7], eye[:, 7:], step, steps)
            V = mpmath.matrix(np.hstack([dQ, dP]).T.tolist()) * V
        for j in range(vectors):
            length = mpmath.norm(V[:, j])
            V[:, j] = V[:, j] / length
        volumes = [mpmath.log10(mpmath.det(V[:, :k].T * V[:, :k])) / 2 for k in range(2, vectors + 1)]
    assert indices.times[-1] == T
    assert volumes[-1] < -30
    assert indices.log10_gali[-1] == pytest.approx([float(v) for v in volumes], abs=SAME_VOLUME)


@pytest.mark.parametrize("block", [1, 7, 40])
def test_the_length_of_blocks_does_not_matter(block):
    arguments = (BETA, *chaotic_state(), 100.0)
    one, other = (alignment_indices(*arguments, samples=64, block=b, frames=1) for b in (16, block))
    assert other.log10_gali == pytest.approx(one.log10_gali, abs=SAME_VOLUME)
    assert other.lyapunov == pytest.approx(one.lyapunov, abs=SAME_VOLUME)


def test_times_are_whole_steps_even_in_the_logarithm():
    indices = found("chaotic")
    assert indices.times / indices.step == pytest.approx(np.round(indices.times / indices.step), abs=WHOLE_NUMBERS)
    assert (indices.times[0], indices.times[-1]) == (1.0, 1000.0)
    late = np.diff(np.log(indices.times[indices.times > 300]))
    assert late == pytest.approx(late.mean(), rel=LOG_SPACING)


def test_an_orbit_over_the_barrier_of_the_alpha_model_is_lost():
    with pytest.raises(SymfpuError, match="the orbit is lost before t = "):
        alignment_indices(Chain(8, alpha=1), [3.0] * 7, [0.0] * 7, 1000.0, frames=1)


@each(
    T=[10.0, np.inf, "100", 1e300, 1e17],
    vectors=[1, 15],
    step=[0.0],
    scheme=["aba864_modes", "euler"],
    samples=[10, 10**9],
    seed=[-1],
    block=[0],
    frames=[0, 1.5, 10**6],
    Q=[[0.0] * 7, [0.1] * 6],
    chain=["a chain"],
)
def test_bad_input_is_refused(name, value):
    refused(alignment_indices, name, value, chain=BETA, Q=[0.1] * 7, P=[0.0] * 7, T=100.0)


@pytest.mark.parametrize(("name", "steps"), [("blanes_moan6", (0.4, 0.2)), ("kahan_li8", (0.4, 0.2)), ("aba864", (0.2, 0.1))])
def test_indices_by_another_scheme_differ_by_its_error(name, steps):
    """From those of the scheme of order 8 with short steps; the difference falls as step^order of the scheme."""

    def indices(step, scheme):
        run = alignment_indices(BETA, 0.1 * np.ones(7), np.zeros(7), 100.0, step=step, scheme=scheme, samples=64, vectors=4, frames=1)
        return np.append(run.log10_gali[-1], run.lyapunov[-1])

    exact = indices(0.05, "kahan_li8")
    errors = [np.max(np.abs(indices(step, name) - exact)) for step in steps]
    order = np.log2(errors[0] / errors[1])
    assert errors[0] < 1e-3
    assert order == pytest.approx(particle_scheme(name).order, abs=OBSERVED_ORDER)


def test_bad_decades_are_refused():
    with pytest.raises(InputError, match=r"^decades = "):
        found("chaotic").slopes(0)


def test_an_orbit_that_loses_its_energy_shows_no_dimension():
    coarse = alignment_indices(BETA, *chaotic_state(3), 500.0, vectors=3, step=0.6, frames=1)
    assert coarse.energy_error > 0.1
    assert coarse.dimension().value is None
    assert "take a shorter step than 0.6" in coarse.dimension().reason


def test_two_particles_have_fewer_vectors():
    assert alignment_indices(Chain(2, beta=1), [0.5], [0.0], 200.0, frames=1).vectors == 2
