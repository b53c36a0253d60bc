"""HTML of results in notebooks. That every result draws itself: tests/test_results.py."""

import re

from tests import every_result
from tests.elements import read
from tests.plots import cases


def test_numbers_of_the_answer_are_those_of_the_result():
    torus = cases.torus()
    text = read(torus._repr_html_()).text
    for q, A in torus.amplitudes.items():
        assert f"seed {q}" in text
        assert f"{A:.12g}" in text
    assert "N=16, alpha=0.33" in text


def test_signs_of_html_in_an_answer_are_escaped():
    text = cases.unstable().members[-1].multipliers._repr_html_()
    assert "real &gt; 0" in text
    assert not re.search(r"real > 0", text)


def test_borders_are_counted_without_those_that_were_not_found():
    rows = every_result.borders().rows
    assert len(rows.rows) == 4
    assert read(every_result.borders()._repr_html_()).text.lstrip().startswith("Atlas: 3 borders")
