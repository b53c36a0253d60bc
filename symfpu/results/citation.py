"""How to cite symfpu: one record, as text, as BibTeX, and as the file CITATION.cff.

`make citation` writes the file.
"""

from __future__ import annotations

from symfpu import __version__
from symfpu.errors import InputError
from symfpu.numbers.public import public

TITLE = "symfpu: Poincare-Lindstedt series of q-tori in Fermi-Pasta-Ulam chains"
AUTHORS = "The symfpu developers"
LICENSE = "BSD-3-Clause"
KEYWORDS = ("Fermi-Pasta-Ulam", "q-breathers", "q-tori", "Lindstedt series")
PAPER_TITLE = "Low-dimensional q-tori in FPU lattices: dynamics and localization properties"
PAPER_AUTHORS = (("Christodoulidi", "H."), ("Efthymiopoulos", "C."))
JOURNAL, YEAR = "Physica D", 2013


@public
def cite(form: str = "text") -> str:
    """How to cite symfpu and the paper that it implements.

    form : "text", a line for each; "bibtex", an entry for each; "cff", the file CITATION.cff.

    Ours. Raises InputError for another form.

    >>> print(cite())
    The symfpu developers. symfpu: Poincare-Lindstedt series ... (version ...). Software.
    H. Christodoulidi, C. Efthymiopoulos. Low-dimensional q-tori in FPU lattices: ... 2013.
    """
    forms = {"text": _text, "bibtex": _bibtex, "cff": _cff}
    if form not in forms:
        raise InputError("form", form, ", ".join(forms), "choose one of them")
    return forms[form]()


def _text() -> str:
    names = ", ".join(f"{given} {family}" for family, given in PAPER_AUTHORS)
    software = f"{AUTHORS}. {TITLE} (version {__version__}). Software."
    return f"{software}\n{names}. {PAPER_TITLE}. {JOURNAL}, {YEAR}."


def _bibtex() -> str:
    names = " and ".join(f"{family}, {given}" for family, given in PAPER_AUTHORS)
    software = {
        "author": f"{{{AUTHORS}}}",
        "title": f"{{{TITLE}}}",
        "version": __version__,
        "note": f"Software, {LICENSE}",
    }
    paper = {
        "author": names,
        "title": f"{{{PAPER_TITLE}}}",
        "journal": JOURNAL,
        "year": str(YEAR),
    }
    entries = _entry("misc", "symfpu", software), _entry("article", "qtori2013", paper)
    return "\n\n".join(entries)


def _entry(kind: str, key: str, fields: dict[str, str]) -> str:
    lines = [f"  {name} = {{{value}}}," for name, value in fields.items()]
    return "\n".join([f"@{kind}{{{key},", *lines, "}"])


def _cff() -> str:
    """The Citation File Format, version 1.2.0."""
    message = (
        "If you use symfpu in published work, please cite it and the paper it implements."
    )
    lines = [
        "cff-version: 1.2.0",
        f'message: "{message}"',
        f'title: "{TITLE}"',
        "type: software",
        f"version: {__version__}",
        f"license: {LICENSE}",
        "authors:",
        f'  - name: "{AUTHORS}"',
        "keywords:",
        *(f"  - {word}" for word in KEYWORDS),
        "references:",
        "  - type: article",
        f'    title: "{PAPER_TITLE}"',
        "    authors:",
    ]
    for family, given in PAPER_AUTHORS:
        lines += [f"      - family-names: {family}", f"        given-names: {given}"]
    lines += [f'    journal: "{JOURNAL}"', f"    year: {YEAR}"]
    return "\n".join(lines)
