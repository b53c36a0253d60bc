"""Parts of the page as HTML: the table of seeds, the verdict, messages, lines to copy."""

from __future__ import annotations

from html import escape

from symfpu.workbench.parts import Numbers, Verdict

SUBSCRIPTS = str.maketrans("0123456789-", "₀₁₂₃₄₅₆₇₈₉₋")
WORDS = {"converged": "good", "asymptotic": "fair", "not a torus": "bad"}

CSS = """
:host { --ink: #1d2733; --quiet: #5b6673; --line: #d9dee4; --accent: #004f8a; }
.picture { width: 100%; height: auto; display: block; }
.card-title { font-weight: 600; margin: 0 0 4px; }
.quiet { color: var(--quiet); font-weight: 400; }
table.seeds { border-collapse: collapse; font-variant-numeric: tabular-nums;
  display: block; max-width: 100%; overflow-x: auto; }
table.seeds th, table.seeds td { text-align: right; padding: 2px 14px 2px 0;
  white-space: nowrap; }
table.seeds th { font-weight: 400; color: var(--quiet); }
dl.numbers { display: flex; flex-wrap: wrap; gap: 4px 22px; margin: 8px 0 0; }
dl.numbers div { white-space: nowrap; }
dl.numbers dt { display: inline; color: var(--quiet); }
dl.numbers dd { display: inline; margin: 0 0 0 5px; font-variant-numeric: tabular-nums; }
.verdict { font-size: 1.25em; font-weight: 600; }
.good { color: #00714f; } .fair { color: #8a5a00; } .bad { color: #b03a00; }
ul.reasons { margin: 4px 0 0; padding-left: 1.2em; }
.problem { border-left: 4px solid #b03a00; background: #fdf1ea; padding: 8px 12px; margin: 0; }
.warning { border-left: 4px solid #d59a00; background: #fff8e6; padding: 4px 10px;
  margin: 6px 0 0; }
pre { margin: 0; padding: 8px 10px; background: #f5f7f9; border: 1px solid var(--line);
  overflow-x: auto; font-size: 12.5px; line-height: 1.45; }
.formula { overflow-x: auto; } .formula svg { max-width: none; height: auto; }
h1 { font-size: 1.3em; margin: 0; } h2 { font-size: 1em; margin: 6px 0 0; }
"""


def subscript(letter: str, index: int) -> str:
    """A letter with an index below it, in plain text.

    >>> subscript("A", 12)
    'A₁₂'
    """
    return letter + str(index).translate(SUBSCRIPTS)


def numbers_html(found: Numbers) -> str:
    """The seeds in a table, and what is one number of the torus."""
    rows = "".join(
        f"<tr><td><i>q</i> = {s.q}</td><td>{s.linear:.10g}</td><td>{s.omega:.12g}</td>"
        f"<td>{s.omega / s.linear - 1:.3e}</td><td>{s.amplitude:.10g}</td></tr>"
        for s in found.seeds
    )
    head = "".join(
        f"<th>{word}</th>"
        for word in (
            "seed",
            "Ω<sub>q</sub>",
            "ω<sub>q</sub>",
            "ω<sub>q</sub>/Ω<sub>q</sub> &minus; 1",
            "A<sub>q</sub>",
        )
    )
    single = {
        "μ": f"{found.mu:.6g}",
        "energy H": f"{found.energy:.10g}",
        "harmonic energy Σ E<sub>q</sub>": f"{found.harmonic_energy:.10g}",
        "residual": f"{found.residual:.2g}",
    }
    listed = "".join(f"<div><dt>{k}</dt><dd>{v}</dd></div>" for k, v in single.items())
    doubts = "".join(f'<p class="warning">{escape(text)}</p>' for text in found.warnings)
    table = (
        f'<table class="seeds"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>'
    )
    return f'{table}<dl class="numbers">{listed}</dl>{doubts}'


def verdict_html(found: Verdict) -> str:
    """The verdict on the series with its reasons."""
    first = found.headline.split(",")[0]
    reasons = "".join(f"<li>{escape(reason)}</li>" for reason in found.reasons)
    word = f'<span class="verdict {WORDS.get(first, "")}">{escape(found.headline)}</span>'
    return f'{word}<ul class="reasons">{reasons}</ul>'


def problem_html(message: str) -> str:
    """An error of the package as text."""
    return f'<p class="problem" role="alert">{escape(message)}</p>' if message else ""


def lines_html(text: str) -> str:
    """Lines to be copied."""
    return f'<pre tabindex="0">{escape(text)}</pre>'
