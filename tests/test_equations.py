"""The index of equations: every label of the paper has a place, every citation a label, and the page is what its generator writes."""

import pytest

from tests.scripts import DOCS, loaded

index = loaded("make_equations")
ITEMS = index.items()
CITED = index.citations()


@pytest.mark.parametrize("label", ITEMS)
def test_a_label_has_a_place_or_a_reason(label):
    assert (label in CITED) != ("unused" in ITEMS[label])


@pytest.mark.parametrize("label", ITEMS)
def test_what_lives_somewhere_is_cited_there(label):
    assert bool(index.homes(ITEMS[label])) != ("unused" in ITEMS[label])
    assert set(index.homes(ITEMS[label])) <= set(CITED.get(label, ()))


def test_no_docstring_cites_what_the_paper_does_not_have():
    assert {label: places for label, places in CITED.items() if label not in ITEMS} == {}


def test_the_page_is_what_the_generator_writes():
    assert index.PAGE.read_text() == index.page(), "run `make equations`"


@pytest.mark.parametrize("page", sorted(DOCS.glob("*.md")), ids=lambda page: page.name)
def test_pages_cite_labels_of_the_paper(page):
    equations = {label for label in index.cited(page.read_text(), list(ITEMS)) if not label.startswith("section")}
    assert equations <= ITEMS.keys()


@pytest.mark.parametrize(
    ("text", "labels"),
    [
        ("by Eq. omeser, and no other", ["omeser"]),
        ("(Eqs. moda, modb), once", ["moda", "modb"]),
        ("Eqs. delome to omeprime", ["delome", "jacome", "omeprime"]),
        ("Eqs. eksa (alpha) and\n    eksp (beta): such", ["eksa", "eksp"]),
        ("Eqs. app, misspelled", ["app", "misspelled"]),
        ("Yoshida, Eq. 4.5 with weights of Eq. 2.11", []),
        ("sections 3.2 and 4. The Lemma of Appendix C, Definition 4", ["Lemma", "Appendix C", "Definition 4", "section 3.2", "section 4"]),
    ],
)
def test_citations_are_read(text, labels):
    assert index.cited(text, list(ITEMS)) == labels
