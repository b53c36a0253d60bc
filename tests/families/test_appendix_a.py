"""Appendix A: the trial frequencies as printed and as they must be, the index placement of its matrices, growth, endings, resuming."""

import itertools
import pickle

import numpy as np
import pytest

from symfpu import Chain, InputError, NoRealAmplitude, Orders, SymfpuError, frequency_shift, lindstedt, solve_amplitudes
from symfpu.families.appendix_a import NoFurtherMember, _Family, appendix_a, appendix_a_members, linear_specific_energy
from symfpu.paper import appendix_a_claims
from symfpu.tori.amplitudes import shifts
from tests.refusals import each, refused
from tests.tolerances import INCREMENT, INCREMENT_OF_H, LINEAR_ENERGY, RELATIVE_SHIFT, SLOPE, SMALL_SHIFT, TEN_ROUNDINGS, TRIAL_AMPLITUDE

LOW = (Chain(32, alpha="0.33"), (1, 2, 3, 4), {1: 0.05, 2: 0.025, 3: 0.0165, 4: 0.012}, 4)
WIDE = (Chain(32, alpha="0.33"), (1, 11, 21, 31), {1: 0.2, 11: 0.02, 21: 0.01, 31: 0.01}, 4)
HIGH = (Chain(64, alpha=1), (60, 61, 62, 63), dict.fromkeys((60, 61, 62, 63), 0.01), 4)
CASES = [
    LOW,
    WIDE,
    HIGH,
    (Chain(2, beta=1), (1,), {1: 0.2}, 3),
    (Chain(16, beta="-0.3"), (1, 3), {1: 0.3, 3: 0.1}, 3),
    (Chain(16, alpha="-0.2", beta="0.3"), (3, 14), {3: 0.1, 14: 0.05}, 4),
]


def family_of(chain, seeds, order):
    return _Family(chain, seeds, Orders(order))


@pytest.fixture(scope="module")
def families():
    return {i: appendix_a(*case, members=5) for i, case in enumerate(CASES)}


def bracket(chain, amplitudes, divisors, *, printed):
    """mu^2 omega^(2) of Eqs. omamid and omafin; divisors : frequencies in the divisors that are not the linear ones, by mode."""
    linear = dict(enumerate(chain.frequencies().tolist(), 1))
    return appendix_a_claims.bracket(chain, amplitudes, linear | divisors, printed=printed)


@pytest.mark.parametrize(
    "case", [LOW, WIDE, HIGH, (Chain(9, alpha="-0.3"), (3, 6), {3: 0.1, 6: 0.1}, 2)], ids=["low", "wide", "high", "mirror"]
)
def test_trial_frequencies_are_the_right_bracket_twice(case):
    chain, seeds, amplitudes, order = case
    middle = bracket(chain, amplitudes, {}, printed=False)
    assert list(middle.values()) == pytest.approx(list(frequency_shift(chain, amplitudes).values()), rel=RELATIVE_SHIFT)
    final = bracket(chain, amplitudes, {q: chain.frequencies()[q - 1] + middle[q] for q in seeds}, printed=False)
    ours = family_of(chain, seeds, order).trial_shifts(np.array(list(amplitudes.values())))
    assert ours == pytest.approx(list(final.values()), rel=SMALL_SHIFT)


def solved(case, shifted):
    chain, seeds, amplitudes, order = case
    frequencies = family_of(chain, seeds, order)._exact(np.array([shifted[q] for q in seeds]))
    return solve_amplitudes(lindstedt(chain, seeds, frequencies, order), guess=amplitudes).amplitudes


def test_printed_bracket_misses_the_trial_amplitudes():
    """Right: to 1%. Printed: A_4 of the low packet 41% off, the high packet 36% off, and no real root for Example 1's seeds."""
    for case, error in ((LOW, 0.40), (HIGH, 0.35), (WIDE, None)):
        chain, seeds, amplitudes, _ = case
        right, wrong = (
            bracket(chain, amplitudes, {q: chain.frequencies()[q - 1] + x for q, x in middle.items()}, printed=p)
            for p, middle in ((p, bracket(chain, amplitudes, {}, printed=p)) for p in (False, True))
        )
        assert solved(case, right) == pytest.approx(amplitudes, rel=TRIAL_AMPLITUDE)
        if error is None:
            with pytest.raises(NoRealAmplitude, match="A_31"):
                solved(case, wrong)
        else:
            found = solved(case, wrong)
            assert max(abs(found[q] / amplitudes[q] - 1) for q in seeds) > error


@pytest.mark.long
@pytest.mark.parametrize("index", range(len(CASES)))
def test_energies_grow_by_the_stated_increment(families, index):
    """Delta epsilon_l of the linear specific energy and N Delta epsilon_l of H (not Delta epsilon_l, as the text has it)."""
    family, chain = families[index], CASES[index][0]
    assert len(family.members) == 5
    assert family.failure is None
    for before, after in itertools.pairwise(family.members[1:]):
        assert after.linear_specific_energy - before.linear_specific_energy == pytest.approx(after.increment, rel=INCREMENT)
        assert after.energy - before.energy == pytest.approx(chain.N * after.increment, rel=INCREMENT_OF_H)
        assert after.harmonic_energy > before.harmonic_energy
    first = family.members[0]
    assert {m.increment for m in family.members} == {first.increment}
    assert first.increment == pytest.approx(0.1 * linear_specific_energy(chain, CASES[index][2]), rel=TEN_ROUNDINGS)


@pytest.mark.long
@pytest.mark.parametrize("index", range(len(CASES)))
def test_linear_mode_energies_grow_alike(families, index):
    """Eq. omeprime with J_omega = J_A^-1: each Omega^2 A^2 / 2 grows by N Delta epsilon_l / s."""
    chain, seeds, *_ = CASES[index]
    for before, after in itertools.pairwise(families[index].members[1:]):
        linear = chain.frequencies()
        gains = [linear[q - 1] ** 2 / 2 * (after.amplitudes[q] ** 2 - before.amplitudes[q] ** 2) for q in seeds]
        assert gains == pytest.approx([chain.N * after.increment / len(seeds)] * len(seeds), rel=INCREMENT)


def test_other_index_placements_do_not_grow_the_modes_alike():
    """The transpose of J_omega, or J_A in its place, sends the modes of the wide packet elsewhere."""
    chain, seeds, _, order = WIDE
    before, last = appendix_a(*WIDE, members=2).members
    family = family_of(chain, seeds, order)
    shift, squares = shifts(last.torus.origin.series), np.array([a**2 for a in last.amplitudes.values()])
    jacobian = family._jacobian(shift, squares, float(np.linalg.norm(shift - shifts(before.torus.origin.series))))
    growth = family._growth(last.increment)
    gains = {
        name: (family._root(shift + step, squares + growth) - squares) / growth if np.all(np.abs(step) < 0.1) else np.full(4, np.inf)
        for name, step in (
            ("right", np.linalg.inv(jacobian) @ growth),
            ("transposed", np.linalg.inv(jacobian).T @ growth),
            ("not inverted", jacobian @ growth),
        )
    }
    assert np.abs(gains["right"] - 1).max() < 0.01
    assert np.abs(gains["transposed"] - 1).max() > 0.2
    assert np.abs(gains["not inverted"] - 1).max() > 0.2


def test_error_of_the_increment_is_of_first_order_in_it():
    """Forward differences over the step itself: the relative error of the gain falls with the increment."""
    errors = []
    increments = np.array([4e-5, 2e-5, 1e-5])
    for increment in increments:
        members = appendix_a(Chain(16, beta="0.3"), (1, 2), {1: 0.6, 2: 0.3}, 3, members=3, increment=increment).members
        errors.append(abs((members[2].linear_specific_energy - members[1].linear_specific_energy) / increment - 1))
    assert np.polyfit(np.log(increments), np.log(errors), 1)[0] == pytest.approx(1, abs=SLOPE)


def test_printed_neighbours_may_have_no_amplitudes():
    """Delta omega, the length of the step in all frequencies, added to one of them alone: A_1^2 would be negative."""
    case = (Chain(16, beta="0.3"), (1, 2, 3), {1: 0.3, 2: 0.2, 3: 0.1}, 3)
    before, last = appendix_a(*case, members=2).members
    family = family_of(case[0], case[1], 3)
    shift = shifts(last.torus.origin.series)
    difference = np.linalg.norm(shift - shifts(before.torus.origin.series))
    with pytest.raises(NoRealAmplitude):
        family._root(shift + np.array([0, 0, difference]), np.array([a**2 for a in last.amplitudes.values()]))
    assert len(appendix_a(*case, members=4).members) == 4


def test_an_interrupted_family_goes_on_as_it_would_have(families):
    chain, seeds, start, order = LOW
    whole = families[0].members
    rest = appendix_a(chain, seeds, start, order, members=2, after=whole[1:3]).members
    assert [m.frequencies for m in rest] == [m.frequencies for m in whole[3:]]
    assert [m.amplitudes for m in rest] == [m.amplitudes for m in whole[3:]]
    steps = appendix_a_members(chain, seeds, start, order)
    assert [next(steps).frequencies for _ in range(2)] == [m.frequencies for m in whole[:2]]


def test_trial_amplitudes_without_a_solution_are_lowered():
    """Order 2 of a hard beta breather, a A^2 - b A^4, is bounded: the trial frequency of A = 12 lies above, that of 6 does not."""
    chain = Chain(16, beta="0.3")
    with pytest.raises(SymfpuError):
        solved((chain, (3,), {3: 12.0}, 2), frequency_shift(chain, {3: 12.0}))
    lowered, direct = (appendix_a(chain, (3,), {3: A}, 2, members=2) for A in (12, 6))
    assert [m.amplitudes for m in lowered.members] == [m.amplitudes for m in direct.members]


def test_a_family_ends_with_its_reason():
    """The same breather followed to the largest frequency that order 2 has, at A^2 = a/(2b)."""
    chain = Chain(16, beta="0.3")
    family = appendix_a(chain, (3,), {3: 6}, 2, members=60)
    assert 2 < len(family.members) < 60
    assert isinstance(family.failure, NoFurtherMember)
    assert family.ending == str(family.failure)
    assert "\n" not in family.ending
    assert f"{len(family.members)} members" in repr(family)
    energies = [m.linear_specific_energy for m in family.members]
    assert energies == sorted(energies)
    for frequency, reached in ((family.members[-1].frequencies[0], True), (family.failure.frequencies[0], False)):
        (linear, a, b), _ = lindstedt(chain, (3,), (frequency,), 2).frequency_terms([1.0])
        assert bool(float(frequency) < linear[0] - a[0] ** 2 / (4 * b[0])) == reached


def test_middle_mode_of_alpha_has_no_family():
    family = appendix_a(Chain(8, alpha=1), (4,), {4: "0.1"}, 2, members=2)
    assert family.members == ()
    assert "no torus for the trial amplitudes" in family.ending


def test_members_have_the_orders_asked_for():
    chain, seeds, start, _ = LOW
    (member,) = appendix_a(chain, seeds, start, 5, members=1, frequency_order=4, coordinate_order=3).members
    assert (member.torus.origin.series.order, member.torus.origin.frequency_order, member.torus.origin.order) == (5, 4, 3)
    assert member.energy == pytest.approx(32 * member.linear_specific_energy, rel=LINEAR_ENERGY)


@each(
    members=[0],
    start_amplitudes=[{1: 0.1}, {1: 0.1, 2: -0.1}],
    increment=[0, "x"],
    seeds=[(1, 9)],
    order=[1],
    frequency_order=[6],
    after=[(1, 2)],
)
def test_bad_arguments_are_refused_by_name(name, value):
    given = {"chain": Chain(8, alpha="0.3"), "seeds": (1, 2), "start_amplitudes": {1: 0.1, 2: 0.1}, "order": 4, "members": 2}
    refused(appendix_a, name, value, **given)


def test_members_of_another_family_are_refused(families):
    with pytest.raises(InputError, match="successive members"):
        appendix_a(*HIGH, members=1, after=families[0].members[-2:])


def test_a_family_goes_to_other_processes():
    found = appendix_a(Chain(8, alpha="0.3"), (1,), {1: 0.05}, 4, members=2)
    returned = pickle.loads(pickle.dumps(found))
    assert repr(returned) == repr(found)
    for one, other in zip(returned.members, found.members, strict=True):
        assert one.torus.amplitudes == other.torus.amplitudes
        assert np.array_equal(one.torus.Q([0.0, 1.7]), other.torus.Q([0.0, 1.7]))
