"""Tables of verdicts in docs/errata.md: written by a program, and held to what the targets compute."""

import importlib.util
from pathlib import Path

import pytest

from symfpu.files.progress import unheard
from symfpu.paper.targets import TARGETS

PAGE = Path(__file__).parents[2] / "docs" / "errata.md"


def loaded():
    spec = importlib.util.spec_from_file_location("make_verdicts", PAGE.parent / "make_verdicts.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


verdicts = loaded()


def claim(text, ours):
    return {"section": "5", "text": text, "printed": "-", "ours": ours, "verdict": "holds"}


def page(*headings):
    return "".join(
        f"### {heading}\n\n{verdicts.HEAD}| 1 | old | **holds** | old |\n| 2 | old | **holds** | old |\n\nWords.\n\n"
        for heading in headings
    )


def test_a_table_is_replaced_and_nothing_beside_it():
    made = verdicts.with_verdicts(page("Fig. 1", "Fig. 10", "Fig. 2"), {"fig1": {"claims": [claim("|x| falls", "|x| = 1")]}})
    row = "| 5 | \\|x\\| falls | **holds** | \\|x\\| = 1 |\n"
    assert made == f"### Fig. 1\n\n{verdicts.HEAD}{row}\nWords.\n\n" + page("Fig. 10", "Fig. 2")


def test_a_figure_without_a_table_is_an_error():
    with pytest.raises(KeyError, match=r"Fig\. 3"):
        verdicts.with_verdicts(page("Fig. 1"), {"fig3": {"claims": [claim("a", "b")]}})


def test_every_target_with_claims_has_a_table():
    assert set(verdicts.TARGETS.values()) == TARGETS.keys() - {"toda"}
    headings = PAGE.read_text().split("## Claims of sections")[1].split("\n### ")[1:]
    assert [part.splitlines()[0] for part in headings] == list(verdicts.TARGETS)


def test_counts_are_of_each_table():
    every = "".join(page(heading) for heading in verdicts.TARGETS)
    head = "| claims about | holds | holds in part | does not hold | undecided |\n| --- | --- | --- | --- | --- |\n"
    made = verdicts.with_counts(f"{head}| old |\n\nWords.\n", every.replace("**holds**", "**holds in part**", 1))
    rows = made.removeprefix(head).splitlines()
    assert rows[0] == "| [Section 5 and the sets of section 6](errata.md#section-5-and-the-sets-of-section-6) | 1 | 1 |  |  |"
    assert rows[3] == "| [Fig. 2](errata.md#fig-2) | 2 |  |  |  |"
    assert rows[-2:] == ["", "Words."]


def test_counts_of_a_page_without_their_table():
    with pytest.raises(KeyError, match=r"paper\.md has no table"):
        verdicts.with_counts("Words.\n", PAGE.read_text())


@pytest.mark.long
@pytest.mark.parametrize("target", ["section5", "fig6"])
def test_cells_are_what_the_target_computes(target, tmp_path):
    """Two targets of seconds, whose evidence is of whole numbers or rounded far above rounding; the others by `make verdicts`."""
    figure = TARGETS[target](tmp_path, unheard)
    record = {target: {"claims": [claim.record() for claim in figure.claims]}}
    assert verdicts.with_verdicts(PAGE.read_text(), record) == PAGE.read_text()
