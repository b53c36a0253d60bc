"""Results show themselves: `plot()`, and HTML in notebooks."""

import base64
import re
from html.parser import HTMLParser

import pytest
from matplotlib.figure import Figure

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.notebook import Shown
from symfpu.plots import usual
from symfpu.series.lindstedt import lindstedt
from tests.plots import cases

RESULTS = {
    "QTorus": (cases.torus, "residual"),
    "RefinedTorus": (cases.refined, "residual"),
    "PeriodicOrbit": (cases.one_mode, "residual"),
    "RingTorus": (cases.ring, "differ by 0.6%"),
    "LindstedtSeries": (cases.series, "order 12"),
    "AmplitudeHistory": (cases.history, "6 of 6 orders"),
    "Assessment": (cases.assessment, "undecided"),
    "Orbit": (cases.orbit, "energy error"),
    "AlignmentIndices": (cases.indices, "dimension 2"),
    "ForetoldIndices": (cases.foretold, "slope -1, settled from t"),
    "FrequencyAnalysis": (cases.lines_found, "independent frequencies"),
    "FrequencyMap": (cases.mapped, "frequencies"),
    "Atlas": (cases.borders_found, "3 borders"),
    "Floquet": (cases.stable_floquet, "stable"),
    "Family": (cases.pair, "reached"),
    "PropagationProof": (cases.proof, "refuted"),
    "TodaInvariants": (cases.invariants, "gaps"),
}


class Elements(HTMLParser):
    """Elements that are opened and closed in their order."""

    def __init__(self):
        super().__init__()
        self.open, self.images, self.text = [], [], ""

    def handle_starttag(self, tag, attributes):
        if tag == "img":
            self.images.append(dict(attributes))
        else:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def read(page):
    elements = Elements()
    elements.feed(page)
    assert elements.open == []
    return elements


@pytest.mark.parametrize("kind", RESULTS)
def test_a_result_draws_its_usual_picture(kind):
    make, _ = RESULTS[kind]
    ax = Figure().add_subplot()
    assert type(make()).__name__ == kind
    assert make().plot(ax) is ax
    assert ax.get_xlabel()
    assert ax.get_lines()


@pytest.mark.long
@pytest.mark.parametrize("kind", RESULTS)
def test_a_result_answers_in_html(kind):
    make, verdict = RESULTS[kind]
    page = read(make()._repr_html_())
    assert page.text.lstrip().startswith(f"{kind}: ")
    assert verdict in page.text.replace("\n", " ")
    (image,) = page.images
    content = base64.b64decode(image["src"].removeprefix("data:image/png;base64,"))
    assert content.startswith(b"\x89PNG")
    assert len(content) < 60_000
    assert image["alt"].endswith(f"of this {kind}")


def test_numbers_of_the_answer_are_those_of_the_result():
    torus = cases.torus()
    text = read(torus._repr_html_()).text
    for q, A in torus.amplitudes.items():
        assert f"seed {q}" in text
        assert f"{A:.12g}" in text
    assert "N=16, alpha=0.33" in text


def test_a_result_without_a_picture_still_answers():
    universal = lindstedt(Chain(8, alpha=1), (1,), order=2)
    assert read(universal._repr_html_()).images == []
    with pytest.raises(InputError, match="frequencies="):
        universal.plot(Figure().add_subplot())


def test_signs_of_html_in_an_answer_are_escaped():
    text = cases.unstable().members[-1].multipliers._repr_html_()
    assert "real &gt; 0" in text
    assert not re.search(r"real > 0", text)


def test_what_has_no_usual_picture_says_so():
    with pytest.raises(InputError, match=r"see symfpu\.plots"):
        usual.picture(3)


def test_every_result_that_shows_itself_has_an_entry():
    def kinds(kind):
        return {kind}.union(*map(kinds, kind.__subclasses__()))

    for kind in kinds(Shown) - {Shown}:
        assert any(issubclass(kind, entry.kind) for entry in usual.USUAL), kind
