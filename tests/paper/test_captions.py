"""The three printed lines against the laws: which reading gives every printed digit, and what the claim says where none does."""

from dataclasses import replace

import numpy as np
import pytest

from symfpu.localization.laws import profile_law
from symfpu.paper.captions import caption_claim, caption_curve, law_of, printed_line, same_numbers
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.printed import LINES


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
