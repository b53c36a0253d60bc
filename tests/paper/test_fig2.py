"""Fig. 2: verdicts with both outcomes; the three printed lines against the laws, by every reading of them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from symfpu import Chain, profile_law
from symfpu.paper import fig2
from symfpu.paper.captions import caption_claim, caption_curve, law_of, printed_line, same_numbers
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.printed import LINES
from tests.paper.cases import exponential, record


@pytest.mark.parametrize(("late", "verdict"), [([1e-5, 1e-5], HOLDS), ([1e-5, 1e-2], PARTLY), ([1e-2, 1e-5], FAILS), ([1e-2, 1e-2], FAILS)])
def test_orbits_are_identical_while_a_picture_cannot_tell(late, verdict):
    times = np.array([0.0, 1.0, 1e3, 1e6])
    torus = SimpleNamespace(Q=lambda t: np.tile([1.0, 0.0], (len(t), 1)))
    Q = np.array([[1.0, 0.0], [1.0, 1e-9], [1.0, late[0]], [1.0, late[1]]])
    assert fig2.identical_claim(torus, record(times, Q)).verdict == verdict


def test_the_line_of_the_caption_is_off_where_its_law_is_not():
    """A spectrum on Eq. eksa2: the printed -2 log kappa is off by up to -4 log kappa, 2.9 decades at mode 6."""
    line = printed_line("Fig. 2a")
    kappa = np.arange(1.0, 32) / 32
    on_the_law = 10 ** law_of(line, line.chains[0])(kappa)
    found = fig2.line_claim(line, on_the_law)
    assert found.verdict == PARTLY
    assert "off by up to 2.9 decades as printed, 0 from" in found.ours
    assert fig2.line_claim(line, on_the_law * kappa**-4).verdict == HOLDS
    assert fig2.line_claim(line, 100 * on_the_law).verdict == FAILS


def test_sums_that_both_fall():
    down, up = 0.5 ** np.arange(12.0), 2.0 ** np.arange(12.0)
    assert [fig2.falling_sums_claim(pair, 11).verdict for pair in ((down, down), (up, down), (up, up))] == [HOLDS, PARTLY, FAILS]


@pytest.mark.parametrize(("residual", "verdict"), [(1e-14, FAILS), (1e-6, HOLDS)])
def test_a_torus_found_by_root_finding_refutes_that_it_cannot_be(residual, verdict):
    assert fig2.root_finding_claim(SimpleNamespace(residual=lambda: residual)).verdict == verdict


@pytest.mark.parametrize(("decades", "verdict"), [(1, HOLDS), (-0.1, FAILS)])
def test_exponential_decay_beyond_the_seeds(decades, verdict):
    exact = SimpleNamespace(chain=Chain(32, alpha="0.33"), seeds=(1, 2, 3, 4), average_spectrum=lambda: exponential(32, decades))
    assert fig2.exponential_claim(exact, lambda exact: 0.0).verdict == verdict


def as_printed_by_the_law(line):
    """The line of the first chain alone, with the digits that its law has."""
    law = profile_law(line.chains[0], line.seeds(line.chains[0]), line.specific_energy)
    return replace(line, chains=line.chains[:1], slope=f"{law.slope:.4f}", intercept=f"{law.intercept:.5f}", power=int(law.power))


@pytest.mark.parametrize("line", LINES, ids=lambda line: line.label)
def test_a_line_that_is_the_law_holds(line):
    assert caption_claim(as_printed_by_the_law(line), "4", {}).verdict == HOLDS


@pytest.mark.parametrize("line", LINES, ids=lambda line: line.label)
@pytest.mark.parametrize("change", ["slope", "intercept", "power"])
def test_a_line_off_in_one_number_does_not_hold(line, change):
    right = as_printed_by_the_law(line)
    wrong = replace(right, **{change: right.power + 1 if change == "power" else f"{float(getattr(right, change)) + 0.01:.4f}"})
    found = caption_claim(wrong, "4", {})
    assert found.verdict == FAILS
    assert "no reading gives the printed digits" in found.ours


@pytest.mark.parametrize("line", LINES, ids=lambda line: line.label)
def test_no_printed_line_is_the_law_with_the_caption_s_parameters(line):
    """Fig. 2(a): another energy and sign of the power; Fig. 4: the law of one size, in (a) with kappa = q/(N-1)."""
    assert caption_claim(line, "4", {}).verdict == FAILS


@pytest.mark.parametrize(
    ("label", "size", "options"),
    [
        ("Fig. 2a", 0, {"specific_energy": 0.000182684 / 32}),
        ("Fig. 4a", 0, {"denominator": 63}),
        ("Fig. 4b", 2, {}),
    ],
)
def test_readings_that_give_every_printed_digit(label, size, options):
    line = printed_line(label)
    law = law_of(line, line.chains[size], **options)
    assert same_numbers(line, law)
    found = caption_claim(line, "4", {"this reading": law})
    assert found.verdict == PARTLY
    assert "comes out with this reading" in found.ours
    assert all(f"N = {chain.N}:" in found.ours for chain in line.chains)
    assert line.slope in found.printed


def test_the_wrong_size_gives_other_digits():
    line = printed_line("Fig. 4b")
    assert not any(same_numbers(line, law_of(line, line.chains[i])) for i in (0, 1, 3))


def test_the_curve_is_the_printed_one():
    curve = caption_curve(printed_line("Fig. 2a"), np.array([0.1, 0.5]))
    assert curve.style == "law"
    assert np.log10(curve.y) == pytest.approx([3.49545 - 3.66613 + 2, 3.49545 - 18.33065 - 2 * np.log10(0.5)])
