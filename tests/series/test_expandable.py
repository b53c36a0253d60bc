"""Terms whose symbols open: the page is well formed, and every symbol on it is explained."""

import re
from xml.etree import ElementTree as ET

import pytest
import symengine as se

from symfpu import Chain, InputError, expandable_term, lindstedt
from symfpu.notebook import Meaning, OpenableFormulas
from symfpu.series.expandable import MOST_OPENINGS
from tests.tolerances import ROUNDING

OMEGA = ("0.3905",)
ELEMENTS = {"style", "div", "span", "details", "summary", "i", "sub", "sup"}
HOSTILE = ["<script>alert(1)</script>", "a&b", "L_{<b>}(1)", '"quoted"', "A{</details>}", "x1<y"]


ANY_INDEX = re.compile(r"(\w)_?\{(.*)\}(.*)")


def tree(html):
    """The page as XML; it has none of the elements that HTML leaves open, nor its named characters."""
    return ET.fromstring(f"<body>{html}</body>")


def text(element):
    return "".join(element.itertext())


def series(order=4, seeds=(1,), N="N"):
    return lindstedt(Chain(N, alpha=1), seeds, order=order)


TERMS = {
    "every N": lambda: expandable_term(series(), 5, 4),
    "one N": lambda: expandable_term(series(N=8), 5, 4),
    "numbers": lambda: expandable_term(series(N=8), 5, 4, OMEGA),
    "two ends": lambda: expandable_term(series(2, (1, "N-1")), "N-2", 2),
    "both couplings": lambda: expandable_term(lindstedt(Chain(8, alpha=1, beta=2), (1, 2), order=3), 3, 3, ("0.391", "0.766")),
    "zero": lambda: expandable_term(series(), 3, 0),
}


@pytest.mark.parametrize("name", TERMS)
def test_page_is_well_formed_and_has_no_scripts(name):
    assert {element.tag for element in tree(TERMS[name]()._repr_html_()).iter()} <= {"body"} | ELEMENTS


@pytest.mark.parametrize("name", TERMS)
def test_every_symbol_is_explained_down_to_the_last(name):
    term = TERMS[name]()
    explained = {str(meaning.symbol) for meaning in term.meanings}
    used = set(map(str, term.parts.expression.free_symbols))
    for meaning in term.meanings:
        if not isinstance(meaning.stands_for, str):
            used |= set(map(str, meaning.stands_for.free_symbols))
    assert used == explained
    letters = [i for i in tree(term.html()).iter("i") if i.text not in ("π", "Q")]
    summaries = [text(summary) for summary in tree(term.html()).iter("summary")]
    openings = OpenableFormulas(term.meanings).openings(term.parts.expression)
    assert len(summaries) == openings
    assert len(letters) == 2 * openings, "in the summary, and before what it stands for"


def test_names_say_what_the_whole_term_says():
    term = TERMS["every N"]()
    named = {meaning.symbol: meaning.stands_for for meaning in term.meanings if str(meaning.symbol).startswith("x")}
    expression = term.parts.expression
    while expression.free_symbols & named.keys():
        expression = expression.subs(named)
    assert se.expand(expression - series().term(5, 4)) == 0


@pytest.mark.parametrize("name", ["numbers", "both couplings"])
def test_numbers_follow_from_what_symbols_stand_for(name):
    term = TERMS[name]()
    numbers = {meaning.symbol: meaning.number for meaning in term.meanings if meaning.number is not None}
    checked = [m for m in term.meanings if m.number is not None and not isinstance(m.stands_for, str)]
    assert {str(m.symbol)[0] for m in checked} >= {"L", "O", "x"}
    for meaning in checked:
        value = float(meaning.stands_for.subs(numbers))
        condition = 1e3 if str(meaning.symbol).startswith("L") else 1  # of the divisors here
        assert value == pytest.approx(meaning.number, rel=condition * ROUNDING)


def test_without_frequencies_the_numbers_are_those_of_the_chain():
    def numbers(term):
        return {str(meaning.symbol)[0] for meaning in term.meanings if meaning.number is not None}

    assert numbers(TERMS["every N"]()) == set()
    assert numbers(TERMS["one N"]()) == {"N", "O"}


def test_a_multiplier_of_a_seed_has_its_chosen_frequency():
    omega, Omega = se.symbols("omega_1 Omega_1")
    term = expandable_term(series(2), 1, 2)
    assert term.meaning("L_{1}(3)").stands_for == Omega**2 / (omega**2 - 9 * omega**2)


def test_signs_and_fractions_are_written():
    x, y = se.symbols("x y")
    page = OpenableFormulas([]).page("Q_{N-1}^(2)", 3 * y**2 - 2 * x * (y - 1) ** 2 / (3 * y))
    lines = [text(line) for line in tree(page).iter("div") if line.get("class")]
    assert lines == ["QN\u22121(2) = 3\u2009y2", "\u2003 \u2212 2\u2009x\u2009(y \u2212 1)2 / (3\u2009y)"]


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_names_are_only_text(name):
    symbol = se.Symbol(name)
    formulas = OpenableFormulas([Meaning(symbol, name), Meaning(se.Symbol("y"), 2 * symbol)])
    page = formulas.page(name, symbol + se.Symbol("y") + se.cos(se.Symbol(name * 2)))
    assert {element.tag for element in tree(page).iter()} <= {"body"} | ELEMENTS
    assert "<script" not in page
    summary, *_ = tree(formulas.line(symbol)).iter("summary")
    opened, *_ = tree(formulas.line(symbol)).iter("details")
    plain = text(summary).replace("\u2212", "-")
    assert plain == (name if not ANY_INDEX.fullmatch(name) else ANY_INDEX.sub(r"\1\2\3", name))
    assert text(opened).endswith(f" = {name}"), "words are kept as they are"


def test_too_long_a_term_is_refused_before_it_is_written():
    with pytest.raises(InputError, match=f"at most {MOST_OPENINGS} symbols to open") as refused:
        expandable_term(series(9), 10, 9)
    assert refused.value.argument == "order"


@pytest.mark.parametrize(
    ("arguments", "argument"),
    [((9, 1), "q"), ((2, 5), "order"), ((2, 1, ("0.4", "0.5")), "frequencies"), ((2, 1, OMEGA), "N")],
)
def test_what_cannot_be_opened_is_refused(arguments, argument):
    with pytest.raises(InputError) as refused:
        expandable_term(series(), *arguments)
    assert refused.value.argument == argument


def test_a_series_with_frequencies_has_no_symbols():
    with pytest.raises(InputError, match="universal"):
        expandable_term(lindstedt(Chain(8, alpha=1), (1,), OMEGA, 2), 2, 1)


def test_meanings_are_asked_for_by_name():
    with pytest.raises(InputError, match="name a symbol of this term"):
        TERMS["every N"]().meaning("L_{9}(9)")
