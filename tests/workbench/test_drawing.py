"""Pictures as SVG: what stands in the axes of symfpu.plots stands in them, at the same places."""

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from symfpu import plots
from symfpu.workbench.choice import Choice
from symfpu.workbench.drawing import HEIGHT, WIDTH, NotKnown, picture_svg
from symfpu.workbench.solving import judged, solved
from symfpu.workbench.typesetting import plain, svg_text

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def found():
    return solved(Choice(N="8", values=("0.3903", "0.7657"), order="4"))


@pytest.fixture(scope="module")
def drawn(found):
    """Every picture of the page that is SVG."""
    verdict = judged(found)
    pictures = {
        "spectrum": lambda ax: plots.spectrum(found.torus, ax),
        "residuals": lambda ax: plots.residuals(verdict, ax),
        "divisors": lambda ax: plots.small_divisors(found.torus, ax),
        "section": lambda ax: plots.section(found.torus, ax),
    }
    return {name: picture_svg(draw, name) for name, draw in pictures.items()}


def test_pictures_are_xml_without_tex(drawn):
    for svg in drawn.values():
        texts = [text for element in ET.fromstring(svg).iter() for text in (element.text, element.tail) if text]
        assert texts
        assert not re.search(r"[\\$_^]", "".join(texts))


def test_the_spectrum_has_a_mark_for_each_mode_at_its_place(drawn, found):
    marks = ET.fromstring(drawn["spectrum"]).findall(f".//{SVG}circle")
    places = np.array([(float(m.get("cx")), float(m.get("cy"))) for m in marks])
    tips = np.array([[float(x) for x in m.find(f"{SVG}title").text.split(", ")] for m in marks])
    energies = found.torus.average_spectrum()
    assert tips[:, 0].tolist() == list(range(1, len(marks) + 1))
    shares = energies[: len(marks)] / energies.sum()
    assert [f"{x:.4g}" for x in shares] == [f"{x:.4g}" for x in tips[:, 1]]
    for values, pixels in ((tips[:, 0], places[:, 0]), (np.log10(tips[:, 1]), places[:, 1])):
        slope, start = np.polyfit(values, pixels, 1)
        assert np.abs(slope * values + start - pixels).max() < 1  # pixel
    assert places.min() >= 0
    assert places.max(axis=0).tolist() <= [WIDTH, HEIGHT]


def test_every_line_and_label_is_there(drawn):
    text = "".join(ET.fromstring(drawn["residuals"]).itertext())
    for word in ("equations of motion", "energy", "best order", "resummed", "relative residual"):
        assert word in text


def test_what_is_not_known_is_not_left_out(found):
    with pytest.raises(NotKnown):
        picture_svg(lambda ax: plots.coefficients(found.torus, ax), "coefficients")


@pytest.mark.parametrize(
    ("label", "words"),
    [
        (r"$\overline{E}_q \,/\, \sum \overline{E}_q$", "E\u0304q/\u03a3E\u0304q"),
        (r"$|\lambda_q - (\nu\cdot\omega)^2|$", "|\u03bbq\u2212(\u03bd\u00b7\u03c9)2|"),
        (r"$\mathdefault{10^{-21}}$", "10\u221221"),
        ("order $k$", "orderk"),
        (r"once a period $2\pi/\omega_{12}$", "onceaperiod2\u03c0/\u03c912"),
    ],
)
def test_labels_are_typeset(label, words):
    assert re.sub(r"[\s\u2009]", "", plain(label)) == words


def test_indices_go_down_and_come_back():
    moves = [float(move) for move in re.findall(r'dy="(-?[\d.]+)em"', svg_text("$A_q^2 = 1$"))]
    assert len(moves) == 3
    assert moves[0] > 0 > moves[1]
    assert "<script" not in svg_text("<script>$x$")
