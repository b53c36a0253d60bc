"""Section 5 and Fig. 6: the real verdicts, and others where the rule is replaced by a wrong one."""

from dataclasses import replace

import numpy as np
import pytest

from symfpu import excitation_sequence
from symfpu.paper import section5
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.fig6 import excited_by_packets, intervals_claim, pattern_claim, spectrum_claim
from symfpu.paper.printed import EXCITATIONS
from tests.paper.cases import unheard

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together


@pytest.fixture(scope="module")
def section(tmp_path_factory):
    return section5.section5(tmp_path_factory.mktemp("section5"), unheard)


def test_every_example_of_section_5_is_judged(section):
    verdicts = {claim.text.split(":")[0] + claim.text[-12:]: claim.verdict for claim in section.claims}
    assert sum(claim.section == "5" for claim in section.claims) == 14
    assert [claim.verdict for claim in section.claims[:2]] == [HOLDS, PARTLY]  # the proposition, alpha and beta
    assert all(f"example {number}" in " ".join(verdicts) for number in ("i", "ii", "iii", "iv", "v"))
    assert section.panels == ()


def test_misprints_are_found_by_comparison(section):
    """The parities of example i, M_1 of example ii, the beta rules of iii and iv, example v, and D_3 of Example 4 are wrong as printed."""
    wrong = [claim.text for claim in section.claims if claim.verdict == PARTLY]
    assert [text.split(":")[0] for text in wrong] == [
        "Proposition, beta model",
        "example i",
        "example ii",
        "example iii",
        "example iv",
        "example v",
        "D_k of beta is D_2k of alpha for q-breathers",
        "Example 4",
    ]
    example = next(claim for claim in section.claims if claim.text.startswith("Example 4"))
    assert "D_3 differs in 60..68, which are in earlier sets" in example.ours
    assert not any(claim.verdict == FAILS for claim in section.claims)


@pytest.fixture
def wrong_rule(monkeypatch):
    """Every set one mode too high."""

    def shifted(N, seeds, order, *, model="alpha"):
        first, *others = excitation_sequence(N, seeds, order, model=model)
        return [first, *(tuple(q + 1 for q in modes) for modes in others)]

    monkeypatch.setattr(section5, "excitation_sequence", shifted)


def test_a_wrong_rule_is_seen(wrong_rule):
    claims = [
        section5.breathers_claim(),
        section5.parities_claim(),
        *section5.two_seeds_claims(),
        *map(section5.low_packets_claim, ("alpha", "beta")),
    ]
    claims += [section5.high_packets_claim("alpha"), section5.symmetric_claim(), *map(section5.printed_sets_claim, EXCITATIONS)]
    off = [claim for claim in claims if claim.verdict != FAILS]
    assert [claim.text.split(":")[0] for claim in off] == ["example ii", "example ii", "example v"]  # M_1, M_2 and empty sets stay


def test_a_proposition_without_proofs_does_not_hold(monkeypatch):
    right = section5.prove_propagation

    def without_verdict(N, seeds, order, model="alpha"):
        return replace(right(N, seeds, order, model=model), verdict="undecided")

    monkeypatch.setattr(section5, "prove_propagation", without_verdict)
    assert section5.alpha_rule_claim().verdict == FAILS


def test_intervals_of_section_6_3():
    packets = excited_by_packets()
    assert [intervals_claim(packet).verdict for packet in packets.values()] == [HOLDS] * 3
    moved = replace(packets["a"], seeds=tuple(q + 1 for q in packets["a"].seeds))
    claim = intervals_claim(moved)
    assert claim.verdict == FAILS
    assert "all but [1, 2" in claim.ours


@pytest.mark.parametrize(("rate", "verdict"), [(4.0, HOLDS), (-4.0, FAILS)])
def test_patterns_of_spectra(rate, verdict):
    sequence = excitation_sequence(48, (11, 12, 13), 6)
    spectrum = np.ones(47)
    for k, modes in enumerate(sequence):
        spectrum[np.array(modes, dtype=int) - 1] = 10.0 ** (-rate * k)
    assert pattern_claim("1/4", sequence, spectrum).verdict == verdict


def test_the_spectrum_of_a_torus_has_the_pattern():
    assert spectrum_claim("1/2").verdict == HOLDS
