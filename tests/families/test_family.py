"""Families of tori against orbits found one by one, exact oscillators and located events."""

import re
from functools import lru_cache

import mpmath
import numpy as np
import pytest
from numpy.polynomial import Chebyshev

import symfpu
from symfpu import Chain, InputError, NotInFamily, family, member_at_energy, member_at_frequency
from symfpu.families import continuation
from symfpu.families.beginnings import first_torus
from symfpu.families.members import member
from symfpu.refinement.conditions import Linear
from symfpu.refinement.guesses import shifts_of
from tests import tolerances
from tests.families.cases import ROUND
from tests.oracles.oscillators import cubic_oscillator
from tests.refusals import each, refused
from tests.tolerances import FIXED_ENERGY, LAST_DIGIT, NEWTON_RESIDUAL, OSCILLATOR, RESONANCE_ENERGY, SAME_ORBIT

# A step of at most 0.6 in ln A, thus 1.2 in ln H, is halved eight times.
STABILITY = 0.01

PAIR = Chain(8, alpha="0.3")
WIDE = Chain(6, alpha="0.4")
LOOP = Chain(16, beta=1)
LONG = Chain(32, alpha="0.33")
HARD = Chain(16, beta="0.5")
BARRIER = Chain(3, alpha="0.5")


@lru_cache
def breathers():
    return family(ROUND, (3,), "0.5", from_energy="0.01")


@lru_cache
def folded():
    return family(PAIR, (1, 2), "0.05", from_energy="0.001")


@lru_cache
def resonant():
    return family(LONG, (1,), "0.05", from_energy="0.004")


@lru_cache
def destabilised():
    return family(HARD, (15,), "1.6", from_energy="0.01", multipliers=True)


def omega(member, place=0):
    return float(member.torus.frequencies[place])


def energies(found):
    return np.array([m.energy for m in found.members])


@pytest.mark.long
@pytest.mark.parametrize("found", [breathers, folded, resonant, destabilised])
def test_a_family_reaches_its_energy_with_tori_only(found):
    """It begins and ends where asked for; every member solves the equations of motion, also at other times than its own."""
    result = found()
    first, goal = {breathers: (0.01, 0.5), folded: (0.001, 0.05), resonant: (0.004, 0.05), destabilised: (0.01, 1.6)}[found]
    assert energies(result)[0] == pytest.approx(first, rel=FIXED_ENERGY)
    assert energies(result)[-1] == pytest.approx(goal, rel=FIXED_ENERGY)
    assert (np.diff(energies(result)) > 0).all()
    assert result.ending == "reached the energy asked for"
    for m in result.members:
        assert m.verdict == "torus"
        assert m.residual < NEWTON_RESIDUAL
        assert m.torus.residual(23) < NEWTON_RESIDUAL
        assert m.energy == pytest.approx(float(m.torus.energy()), rel=LAST_DIGIT)
        assert m.harmonic_energy == pytest.approx(float(m.torus.harmonic_energies().sum()), rel=LAST_DIGIT)
    assert f"{len(result.members)} members, H = " in repr(result)


def test_it_begins_where_it_is_asked_to():
    """By default at a thousandth of the goal."""
    begun = family(ROUND, (3,), "0.5", members=1)
    assert begun.members[0].energy == pytest.approx(0.0005, rel=FIXED_ENERGY)
    assert begun.ending == "was left after 1 member, the most asked for"


ENDS = {
    "alpha, far from linear": (Chain(64, alpha="0.33"), (1,), "0.0009", "0.0014", {}),
    "alpha, farther": (Chain(32, alpha="0.33"), (1,), "0.0143", "0.0144", {}),
    "beta, a torus": (Chain(6, beta="0.3"), (1, 3), "0.01", "0.02", {"tolerance": 1e-10}),
    "both, by amplitudes": (Chain(6, alpha="0.3", beta="0.1"), (1, 2), "0.005", "0.01", {"amplitude_ratio": {1: 2, 2: 1}}),
    "appendix-a": (ROUND, (1, 3), "0.002", "0.003", {"method": "appendix-a", "order": 4}),
    "appendix-a, near": (Chain(16, alpha="0.33"), (1, 2), "0.0299", "0.03", {"method": "appendix-a", "order": 4}),
}


SLOW_ENDS = ("alpha, far from linear", "appendix-a, near")  # seconds each


@pytest.mark.long
@pytest.mark.parametrize("harmonic", [False, True])
@pytest.mark.parametrize("case", [pytest.param(case, marks=[pytest.mark.long] * (case in SLOW_ENDS)) for case in ENDS])
def test_both_ends_have_the_energies_asked_for(case, harmonic):
    """The linear estimate is 1.8 and 2.3 times too small in the first two cases."""
    chain, seeds, first, goal, options = ENDS[case]
    found = family(chain, seeds, goal, from_energy=first, harmonic=harmonic, **options)
    measured = [m.harmonic_energy if harmonic else m.energy for m in found.members]
    assert measured[0] == pytest.approx(float(first), rel=FIXED_ENERGY)
    assert measured[-1] == pytest.approx(float(goal), rel=FIXED_ENERGY)
    assert measured == sorted(measured)
    assert found.ending == "reached the energy asked for"
    for energy in (first, goal):
        assert float(member_at_energy(found, energy, harmonic=harmonic).energy()) > 0
    if len(seeds) == 1 and not harmonic:
        ends = [symfpu.torus(chain, (seeds[0],), energy=energy) for energy in (first, goal)]
        assert [omega(found.members[k]) for k in (0, -1)] == pytest.approx([float(o.frequency) for o in ends], rel=SAME_ORBIT)


@pytest.mark.long
def test_a_goal_just_below_a_turn_of_the_energy_is_not_passed_by():
    """A step leads over the turn at H = 0.8127149; both members beside it are below the goal, and the family is not."""
    near = family(LOOP, (1,), "0.8127", from_energy="0.02", tolerance=1e-10)
    assert near.ending == "reached the energy asked for"
    assert energies(near)[-1] == pytest.approx(0.8127, rel=FIXED_ENERGY)
    assert (np.diff(energies(near)) > 0).all()


def test_a_way_down_is_not_followed():
    with pytest.raises(InputError, match=r"^from_energy = .*a family followed upwards has the tori of the way down"):
        family(ROUND, (3,), "0.01", from_energy="0.05")


def test_members_are_the_breathers_of_harmonic_balance():
    for m in breathers().members:
        (amplitude,) = m.amplitudes.values()
        orbit = symfpu.torus(ROUND, (3,), amplitudes={3: amplitude})
        assert omega(m) == pytest.approx(float(orbit.frequency), rel=SAME_ORBIT)
        assert m.energy == pytest.approx(orbit.energy(), rel=SAME_ORBIT)
        assert m.harmonic_energy == pytest.approx(orbit.harmonic_energies().sum(), rel=SAME_ORBIT)
        for (n,), row in zip(m.torus.harmonics, m.torus.cosines, strict=True):
            expected = orbit.cosines[n] if n < len(orbit.cosines) else 0 * row
            assert row == pytest.approx(expected, abs=SAME_ORBIT * amplitude)
    last = breathers().members[-1]
    assert symfpu.torus(ROUND, (3,), frequencies=(last.torus.frequencies[0],)).amplitude == pytest.approx(
        last.amplitudes[3], rel=1e3 * SAME_ORBIT
    )


def averages(torus):
    """Mode energies averaged over a grid of angles that resolves them, (N-1,): no formula of coefficients."""
    points = 4 * np.abs(torus.harmonics).max() + 3
    angles = 2 * np.pi * np.stack(np.meshgrid(*[np.arange(points) / points] * len(torus.seeds)), axis=-1).reshape(-1, len(torus.seeds))
    phase = angles @ torus.harmonics.T
    Q = np.cos(phase) @ torus.cosines
    P = -np.sin(phase) @ ((torus.harmonics @ [float(w) for w in torus.frequencies])[:, None] * torus.cosines)
    return torus.chain.harmonic_energies(Q, P).mean(axis=0)


@pytest.mark.parametrize("ratios", [{"amplitude_ratio": {3: "1/2", 1: 1}}, {"energy_ratio": {1: 3, 3: 1}}], ids=["amplitudes", "energies"])
def test_members_keep_the_ratio_asked_for(ratios):
    for m in family(Chain(6, beta="0.3"), (1, 3), "0.02", from_energy="0.01", **ratios).members:
        if "amplitude_ratio" in ratios:
            assert m.amplitudes[3] / m.amplitudes[1] == pytest.approx(0.5, rel=FIXED_ENERGY)
        else:
            mine = averages(m.torus)
            assert mine[0] / mine[2] == pytest.approx(3, rel=FIXED_ENERGY)


@pytest.mark.long
def test_a_fold_of_a_frequency_is_passed_and_located():
    """omega_2 has a minimum, seen over tori of given energies; its shift changes sign later, and the family goes on beyond both."""
    (fold,) = folded().events
    assert (fold.kind, fold.what) == ("fold", "omega_2")
    near = folded().members[fold.after].torus

    def shift(ln_energy):
        return [
            float(shifts_of(symfpu.refine(near, energy=symfpu.Energy(float(np.exp(x)), energy_ratio={1: 1, 2: 1})))[1]) for x in ln_energy
        ]

    about = np.log(0.003)
    shifts = Chebyshev.interpolate(shift, 10, domain=(about - 0.25, about + 0.25))
    (turn,) = [x.real for x in shifts.deriv().roots() if abs(x.imag) < 1e-9 and abs(x.real - about) < 0.25]
    assert shifts.deriv(2)(turn) > 0
    assert fold.energy == pytest.approx(np.exp(turn), rel=tolerances.FOLD)
    assert fold.value == pytest.approx(float(PAIR.linear_frequency(2)) + shifts(turn), abs=LAST_DIGIT)
    assert folded().members[fold.after].energy <= fold.energy <= folded().members[fold.after + 1].energy
    signs = [float(shifts_of(m.torus)[1]) > 0 for m in folded().members]
    assert signs == sorted(signs)
    assert (signs[0], signs[-1]) == (False, True)
    assert folded().members[signs.index(True)].energy > 2 * fold.energy


@pytest.mark.long
def test_a_resonance_is_named_and_located():
    """15 omega = Omega_17 on the breather of harmonic balance with the energy of the event; d(15 omega)/d ln H is some 0.005 there."""
    event = next(e for e in resonant().events if e.what == "divisor")
    assert (event.mode, event.harmonic, event.interpolated) == (17, (15,), False)
    first, second = resonant().members[event.after : event.after + 2]
    assert first.energy < event.energy < second.energy
    at = symfpu.torus(LONG, (1,), energy=repr(event.energy))
    assert 15 * float(at.frequency) == pytest.approx(LONG.frequencies()[16], abs=RESONANCE_ENERGY * 0.005)
    assert event.value == pytest.approx(at.cosines[15, 16], rel=tolerances.RESONANT_AMPLITUDE)
    assert "resonance of mode 17 with harmonic (15) at H = 0.0392110" in repr(event)


@pytest.mark.long
def test_a_resonance_of_two_frequencies_is_located():
    """|12 omega_1 - 8 omega_2| = Omega_4 on the torus with the energy of the event, and not on its neighbours."""
    found = family(WIDE, (1, 2), "0.5", from_energy="0.25", tolerance=1e-10)
    event = next(e for e in found.events if e.kind == "resonance" and e.harmonic == (12, -8))
    assert (event.mode, event.interpolated) == (4, False)

    def divisor(torus):
        return abs(float(12 * torus.frequencies[0] - 8 * torus.frequencies[1])) - WIDE.frequencies()[3]

    at = member_at_energy(found, repr(event.energy), harmonic=False)
    first, second = (divisor(m.torus) for m in found.members[event.after : event.after + 2])
    assert first * second < 0
    assert abs(divisor(at)) < RESONANCE_ENERGY * abs(second - first)


@pytest.mark.long
def test_a_resonance_between_the_first_members_is_found():
    later = next(e for e in resonant().events if e.what == "divisor")
    found = family(LONG, (1,), "0.043", from_energy="0.039", members=2)
    [event] = [e for e in found.events if e.what == "divisor"]
    assert (event.mode, event.harmonic, event.after) == (17, (15,), 0)
    assert event.energy == pytest.approx(later.energy, rel=RESONANCE_ENERGY)


@pytest.mark.long
def test_a_resonance_that_is_not_located_is_interpolated(monkeypatch):
    """Where Newton's method finds no torus, or another one, the two members tell no more than that it lies between them."""
    other = resonant().members[0].torus

    def none(torus, conditions, **options):
        raise symfpu.NoTorus("tried", other, 1.0)

    def another(torus, conditions, **options):
        return other

    true = continuation.refined_torus
    for refined in (none, another):

        def instead(torus, conditions, refined=refined, **options):
            crossing = isinstance(conditions[0], Linear) and not conditions[0].of_logarithms
            return (refined if crossing else true)(torus, conditions, **options)

        with monkeypatch.context() as patched:
            patched.setattr(continuation, "refined_torus", instead)
            found = family(LONG, (1,), "0.05", from_energy="0.02")
        event = next(e for e in found.events if e.what == "divisor")
        first, second = found.members[event.after : event.after + 2]
        assert (event.mode, event.harmonic, event.interpolated) == (17, (15,), True)
        assert first.energy < event.energy < second.energy
        assert "at H = 0.039" in repr(event)
        assert "(interpolated)" in repr(event)


@pytest.mark.long
def test_a_family_that_comes_back_to_rest_ends_there():
    """Mode 11 takes part on the way back, so that members of less energy and amplitude than the first are not yet those of the linear
    limit; the last one is: the orbit of the same amplitude that harmonic balance finds from there."""
    found = family(LOOP, (1,), "5", from_energy="0.02", tolerance=1e-10)
    assert found.ending == "turned at H = 0.8127149 and returned to the linear limit"
    assert {e.what for e in found.events if e.kind == "fold"} == {"A_1", "omega_1", "H"}
    first, *_, other, last = found.members

    def of_the_limit(m):
        return float(symfpu.torus(LOOP, (1,), amplitudes={1: m.amplitudes[1]}).frequency)

    assert first.energy > other.energy > last.energy
    assert first.amplitudes[1] > other.amplitudes[1] > last.amplitudes[1]
    shift = omega(other) - LOOP.frequencies()[0]
    assert abs(omega(other) - of_the_limit(other)) > 0.01 * shift
    assert omega(last) == pytest.approx(of_the_limit(last), abs=tolerances.LINEAR_LIMIT * shift)


@pytest.mark.long
def test_a_beginning_beyond_the_series_is_led_up_to():
    """At H = 0.5 Newton's method from the lowest order leads to no torus; the first member is the end of a family from below."""
    with pytest.raises(symfpu.NoTorus):
        first_torus(LOOP, {1: np.sqrt(2 * 0.5) / LOOP.frequencies()[0]})
    found = family(LOOP, (1,), "0.6", from_energy="0.5", tolerance=1e-10)
    assert found.ending == "reached the energy asked for"
    assert found.members[0].energy == pytest.approx(0.5, rel=FIXED_ENERGY)
    for m in found.members:
        assert m.verdict == "torus"
        assert omega(m) == pytest.approx(float(symfpu.torus(LOOP, (1,), energy=m.energy).frequency), rel=tolerances.LOOSE_MEMBER)


@pytest.mark.long
def test_a_beginning_that_the_family_does_not_reach_is_refused():
    with pytest.raises(
        NotInFamily, match=r"no member has H = 2: .* to 0\.812.* and turned at H = 0\.8127149 and returned to the linear limit"
    ):
        family(LOOP, (1,), "5", from_energy="2", tolerance=1e-10)


def test_a_change_of_stability_is_located():
    (event,) = [e for e in destabilised().events if e.kind == "stability"]
    assert event.what == "instability (real > 0) begins"
    assert event.energy == pytest.approx(1.3353, rel=STABILITY)
    below, above = (symfpu.floquet(symfpu.torus(HARD, (15,), energy=event.energy * (1 + d))) for d in (-STABILITY, STABILITY))
    assert below.stable
    assert above.instabilities == {"real > 0": 1}
    stable = [m.multipliers.stable for m in destabilised().members]
    assert stable == sorted(stable, reverse=True)
    assert stable[event.after : event.after + 2] == [True, False]
    assert ", stable" in repr(destabilised().members[0])
    assert ", unstable" in repr(destabilised().members[-1])


@pytest.mark.long
def test_a_family_turns_below_a_barrier():
    """x'' + Omega^2 x + b x^2 = 0 has a saddle at H = Omega^6 / 6 b^2. Up to it A turns, since the orbit rests there ever longer; both,
    and omega, are those of the exact oscillator, whose quadrature resolves 48 harmonics."""
    found = family(BARRIER, (2,), "20", from_energy="1.3", members=14)
    assert found.ending == "was left after 14 members, the most asked for"
    with mpmath.workdps(30):
        linear = BARRIER.linear_frequency(2)
        quadratic = mpmath.mpf("0.5") / mpmath.sqrt(6) * linear**3 * BARRIER.B(2, 2, 2)
        barrier = float(linear**6 / (6 * quadratic**2))
        known = [m for m in found.members if omega(m) > 0.75]
        known.append(member(member_at_energy(found, "3.99", harmonic=False), multipliers=False))
        for m in known:
            rate, amplitude = cubic_oscillator(linear**2, quadratic, mpmath.mpf(float(m.torus.Q(0.0)[1])))
            assert omega(m) == pytest.approx(float(rate), rel=OSCILLATOR)
            assert abs(m.amplitudes[2]) == pytest.approx(abs(float(amplitude)), rel=OSCILLATOR)
    assert barrier == pytest.approx(4)
    assert energies(found).max() < barrier * (1 + tolerances.TEN_ROUNDINGS)
    (turn,) = [e for e in found.events if e.kind == "fold"]
    assert turn.what == "A_2"
    assert [m.energy > turn.energy for m in known].count(True) >= 2
    assert omega(found.members[-1]) < 0.6


@pytest.mark.long
def test_a_family_that_cannot_go_on_says_so():
    """Towards the saddle at H = 1 the period grows without end, and so do the harmonics: those that are taken end the family."""
    found = family(Chain(2, beta="-0.5"), (1,), "20", from_energy="0.1", tolerance=1e-9)
    assert found.ending.startswith(f"ended at H = {found.members[-1].energy:.7g}: ")
    assert "::" not in found.ending
    assert found.ending.count(": ") == 1
    assert re.search(r"the family cannot be followed, because \d+ harmonics do not resolve it", found.ending)
    assert all(m.residual < tolerances.LOW_ACCURACY for m in found.members)
    assert energies(found).max() < 2
    with pytest.raises(NotInFamily, match="ended at H = "):
        member_at_energy(found, "20", harmonic=False)


@pytest.mark.long
def test_the_family_goes_on_where_its_series_ends():
    """docs/convergence.md: orbit and fold of the fixed-frequency scheme coincide at A = 1.0812, omega = 0.098352. Before it the roots of
    the truncated series approach the member of their frequency; behind it they do not."""
    at = symfpu.torus(LONG, (1,), amplitudes={1: "1.0812"})
    assert float(at.frequency) == pytest.approx(0.098352, abs=tolerances.SIX_PLACES)
    assert at.energy() == pytest.approx(0.00926, abs=tolerances.FIVE_PLACES)
    before = [m for m in resonant().members if m.amplitudes[1] < 0.95]
    behind = [m for m in resonant().members if m.amplitudes[1] > 1.2]
    assert before
    assert behind[-1].energy == pytest.approx(0.05, rel=FIXED_ENERGY)

    def missed(m, order):
        frequency = m.torus.frequencies[0].limit_denominator(10**14)
        try:
            found = float(symfpu.solve_amplitudes(symfpu.lindstedt(LONG, (1,), (frequency,), order)).amplitudes[1])
        except (symfpu.NoRealAmplitude, symfpu.DidNotConverge):
            return np.inf
        return abs(found / m.amplitudes[1] - 1)

    assert missed(before[-1], 60) < 0.2 * missed(before[-1], 20)
    assert all(missed(m, 60) > 0.01 for m in behind)


@pytest.mark.long
def test_at_energy_is_on_the_family():
    """Not the ratio of the nearest member's amplitudes, which changes along a family of equal energies."""
    torus = member_at_energy(folded(), "0.02", harmonic=False)
    mine = averages(torus)
    assert mine[0] == pytest.approx(mine[1], rel=FIXED_ENERGY)
    assert float(torus.energy()) == pytest.approx(0.02, rel=FIXED_ENERGY)
    assert torus.residual() < NEWTON_RESIDUAL
    harmonic = member_at_energy(folded(), "0.02", harmonic=True)
    assert float(harmonic.harmonic_energies().sum()) == pytest.approx(0.02, rel=FIXED_ENERGY)
    breather = member_at_energy(breathers(), "0.1", harmonic=False)
    assert breather.amplitudes[3] == pytest.approx(symfpu.torus(ROUND, (3,), energy="0.1").amplitude, rel=SAME_ORBIT)


@pytest.mark.parametrize("energy", ["0.0001", "7"])
def test_an_energy_beyond_reach_is_not_in_the_family(energy):
    with pytest.raises(NotInFamily) as failure:
        member_at_energy(breathers(), energy, harmonic=False)
    assert (failure.value.quantity, failure.value.value) == ("H", float(energy))
    assert failure.value.reached == (energies(breathers()).min(), energies(breathers()).max())
    assert type(failure.value.reached[0]) is float
    assert failure.value.ending == "reached the energy asked for"
    assert "follow the family further" in str(failure.value)


@pytest.mark.long
def test_a_frequency_may_have_several_members():
    """omega_2 of the folded family falls and rises again: two tori have one omega_2, with one ratio of the mode energies."""
    family_ = folded()
    lowest = min(float(m.torus.frequencies[1]) for m in family_.members)
    first = float(family_.members[0].torus.frequencies[1])
    wanted = repr((first + lowest) / 2)
    tori = member_at_frequency(family_, 2, wanted)
    assert len(tori) == 2
    for torus in tori:
        assert float(torus.frequencies[1]) == pytest.approx(float(wanted), abs=LAST_DIGIT)
        averages = torus.average_spectrum()
        assert torus.residual() < NEWTON_RESIDUAL
        assert averages[1] / averages[0] == pytest.approx(1, rel=FIXED_ENERGY)
    assert tori[0].energy() < tori[1].energy()
    assert len(member_at_frequency(breathers(), 3, breathers().members[2].torus.frequencies[0])) == 1


def test_a_frequency_beyond_reach_is_not_in_the_family():
    with pytest.raises(NotInFamily, match=r"no member has omega_3 = 9: the family goes from .* follow the family further") as failure:
        member_at_frequency(breathers(), 3, 9)
    assert failure.value.quantity == "omega_3"
    assert failure.value.reached[0] < failure.value.reached[1] < 9
    with pytest.raises(InputError, match=r"^seed = 5"):
        member_at_frequency(breathers(), 5, 1)


def test_appendix_a_ends_honestly():
    found = family(Chain(8, beta="0.3"), (1,), "50", method="appendix-a", order=4)
    last = found.members[-1].energy
    assert found.ending.startswith(f"ended at H = {last:.7g}: no further torus at omega_1 = ")
    assert last < 50
    assert found.members[-1].verdict == "doubtful"
    assert "doubtful" in repr(found)


@each(
    method=["newton"],
    order=[4],
    multipliers=[True],
    amplitude_ratio=[{1: 1}, {}, (1, 2)],
    energy_ratio=[{1: 1, 2: -1}, {1: 1, 2: "x"}, {1: 1, 3: 1}],
    from_energy=["0.2", "0.1", -1, "x"],
    to_energy=[-1, "x", "1e400", "1e-400"],
    members=[0, 2.5],
    seeds=[(1, 8), (), (1, 1)],
    tolerance=[2],
)
def test_bad_arguments_are_named(name, value):
    refused(family, name, value, chain=PAIR, seeds=(1, 2), to_energy="0.1")


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"method": "appendix-a"}, "order"),
        ({"method": "appendix-a", "order": 2.5}, "order"),
        ({"method": "appendix-a", "order": 4, "multipliers": True}, "multipliers"),
        ({"amplitude_ratio": {1: 1, 2: 1}, "energy_ratio": {1: 1, 2: 1}}, "energy_ratio"),
        ({"to_energy": 0, "from_energy": "0.1"}, "to_energy"),
    ],
)
def test_arguments_that_do_not_go_together_are_named(options, named):
    with pytest.raises(InputError, match=rf"^{named} = "):
        family(**{"chain": PAIR, "seeds": (1,), "to_energy": "0.1"} | options)


def test_progress_is_told():
    lines = []
    found = family(ROUND, (3,), "0.1", from_energy="0.05", progress=lambda label, done: lines.append((label, done)))
    assert isinstance(found, symfpu.Family)
    assert lines[0][0].startswith("member 1: ")
    done = [part for _, part in lines]
    assert done == sorted(done)
    assert 0 <= done[0] < done[-1] < 1
