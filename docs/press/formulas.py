"""Formulas as MathML, which browsers draw by themselves: no script, nothing from elsewhere.

docutils translates LaTeX; what it does not know is put into its words first.
"""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util import logging

LOGGER = logging.getLogger(__name__)
SAID_OTHERWISE = {
    r"\dots": r"\ldots",
    r"\big(": r"\left(",
    r"\big)": r"\right)",
    r"\displaystyle": "",
    r"\limits": "",
    r"\nonumber": "",
    "&&": "&",
}
APPLIED, SPACED = "<mo>&ApplyFunction;</mo>", '<mo rspace="0.17em">&ApplyFunction;</mo>'
ROWS = re.compile(r"\\begin\{(align|eqnarray|gather)(\*?)\}(.*?)\\end\{\1\2\}", re.DOTALL)


def mathml(latex: str, *, block: bool) -> str:
    """A formula as MathML. Raises MathError."""
    for theirs, ours in SAID_OTHERWISE.items():
        latex = re.sub(
            rf"{re.escape(theirs)}(?![A-Za-z])", lambda _, ours=ours: ours, latex
        )
    latex = latex.strip().strip("$").strip()
    latex = ROWS.sub(lambda found: rf"\begin{{aligned}}{found[3]}\end{{aligned}}", latex)
    return str(tex2mathml(latex, as_block=block)).replace(APPLIED, SPACED)


def _written(translator: Any, node: nodes.Element, *, block: bool) -> None:
    latex = node.astext()
    try:
        translator.body.append(mathml(latex, block=block))
    except MathError as error:
        LOGGER.warning("no MathML for %r: %s", latex[:200], error, location=node)
    raise nodes.SkipNode


def _inline(translator: Any, node: nodes.Element) -> None:
    _written(translator, node, block=False)


def _block(translator: Any, node: nodes.Element) -> None:
    translator.body.append('<div class="math">')
    try:
        _written(translator, node, block=True)
    finally:
        translator.body.append("</div>")


def setup(app: Any) -> dict[str, bool]:
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True}
