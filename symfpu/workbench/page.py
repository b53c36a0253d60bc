"""The page: controls, pictures, lines to copy, files in and out. Each tab has its own."""

from __future__ import annotations

import base64
import json
import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from symfpu.errors import SymfpuError
from symfpu.files.writing import write_bytes
from symfpu.workbench.choice import Choice
from symfpu.workbench.controls import FULL, SHAPE, Controls
from symfpu.workbench.formulas import FORMS, NUMBERS, Formula, Term
from symfpu.workbench.parts import (
    DIVISORS,
    RESIDUALS,
    SECTION,
    SPECTRUM,
    SURFACE,
    File,
    Numbers,
    Picture,
    Problem,
    Verdict,
    languages,
)
from symfpu.workbench.server import TITLE, panel
from symfpu.workbench.texts import (
    CSS,
    lines_html,
    numbers_html,
    problem_html,
    verdict_html,
)
from symfpu.workbench.worker import DONE, FILE, TERM, TORUS, Asker, Died, Spares, Told

TITLES = {
    SPECTRUM: "Spectrum, over the groups D<sub>k</sub>",
    RESIDUALS: "Residual of the series, by order",
    SECTION: "The orbit on the torus, once a period",
    SURFACE: "The torus",
    DIVISORS: "Smallest divisors",
}
GRID = {
    "display": "grid",
    "grid-template-columns": "repeat(auto-fit, minmax(min(100%, 400px), 1fr))",
    "gap": "10px",
    "align-items": "stretch",
}
PALE = ":host { transition: opacity 0.2s 0.4s; } :host(.stale) { opacity: 0.45; }"
SLOW = 1.0  # seconds from which a computation is said to go on
LOOK = 300  # milliseconds between two looks at it
DOWNLOAD = """
if (cb_obj.value) {
  const parcel = JSON.parse(cb_obj.value);
  const link = document.createElement('a');
  link.href = 'data:application/octet-stream;base64,' + parcel.content;
  link.download = parcel.name;
  link.click();
}
"""
CARD = {
    "background": "white",
    "border": "1px solid #d9dee4",
    "border-radius": "6px",
    "padding": "10px 12px",
    "box-sizing": "border-box",
    "min-width": "0",
}


class Page:
    """One tab: its controls, its computing process, and what is shown."""

    def __init__(self, spares: Spares) -> None:
        pn = panel()
        self._document = pn.state.curdoc
        self._folder = tempfile.TemporaryDirectory()
        self._stale = False
        self._asked_term: Any = None
        self._make_shown(pn)
        self._make_buttons(pn)
        self.controls = Controls(Choice(), self.changed)
        self.asker = Asker(self.hear, spares)
        self._make_term(pn)
        pn.state.add_periodic_callback(self._look, period=LOOK)
        pn.state.on_session_destroyed(lambda context: self.end())
        pn.state.onload(lambda: self.changed(self.controls.choice))

    def _make_shown(self, pn: Any) -> None:
        html = partial(pn.pane.HTML, "", stylesheets=[CSS], sizing_mode="stretch_width")
        self.numbers, self.verdict = html(margin=0), html(margin=0)
        self.problem, self.notice = html(margin=0), html(margin=0)
        self.formula, self.lines = html(margin=0), html(margin=0)
        self.pictures = {name: html(margin=0, min_height=150) for name in TITLES}
        self.grid = pn.Column(
            styles=GRID, stylesheets=[PALE], margin=0, sizing_mode="stretch_width"
        )
        self.busy = html(margin=(6, 10), styles={"color": "#5b6673"})
        self.python = pn.widgets.TextInput(value="", visible=False)
        self.parcel = pn.widgets.TextInput(value="", visible=False)
        self.parcel.jscallback(value=DOWNLOAD)

    def _make_buttons(self, pn: Any) -> None:
        button = partial(pn.widgets.Button, sizing_mode="stretch_width", margin=(3, 6))
        self.refine = button(name="Refine by Newton's method", button_type="primary")
        self.refine.on_click(lambda event: self._refine())
        self.save = button(name="Save as bundle")
        self.save.on_click(lambda event: self._file(""))
        self.language = pn.widgets.Select(
            options=list(languages()), margin=(3, 6), sizing_mode="stretch_width"
        )
        self.export = button(name="Export code")
        self.export.on_click(lambda event: self._file(self.language.value))
        self.copy = button(name="Copy the Python lines")
        copying = "navigator.clipboard.writeText(lines.value)"
        self.copy.js_on_click(args={"lines": self.python}, code=copying)
        self.load = pn.widgets.FileInput(
            accept=".symfpu", description="Load a bundle", **FULL
        )
        self.load.param.watch(lambda event: self._load(event.new), "value")
        self.cancel = pn.widgets.Button(
            name="Cancel", button_type="warning", visible=False, margin=(3, 6)
        )
        self.cancel.on_click(lambda event: self._cancel())

    def _make_term(self, pn: Any) -> None:
        narrow = {"width": 80, "margin": (2, 6)}
        self.term = {
            "what": pn.widgets.Select(
                name="term", options={"Q": "Q", "ω": "omega"}, **narrow
            ),
            "q": pn.widgets.TextInput(name="mode q", value="3", **narrow),
            "order": pn.widgets.TextInput(name="order k", value="2", **narrow),
            "form": pn.widgets.Select(
                name="form", options=list(FORMS), width=130, margin=(2, 6)
            ),
        }
        for widget in self.term.values():
            widget.param.watch(lambda event: self._ask_term(), "value")

    def changed(self, choice: Choice) -> None:
        """Another choice: asks for it, and while it is computed says by which lines it is made."""
        self.asker.ask(TORUS, choice)
        with panel().io.hold(self._document):
            self.problem.object = ""
            self._mark_stale(True)
            self.busy.css_classes = ["busy"]
            self._show_lines(choice, "")
            self._ask_term()

    def _show_lines(self, choice: Choice, command: str) -> None:
        try:
            python = choice.python()
            command = command or choice.command()
        except SymfpuError:
            python = command = ""  # what is wrong is said by computing it
        self.python.value = python
        self.lines.object = lines_html(python) + (lines_html(command) if command else "")

    def _mark_stale(self, stale: bool) -> None:
        """Pale as long as what is shown belongs to another choice and nothing new has come."""
        if stale == self._stale:
            return
        self._stale = stale
        self.grid.css_classes = ["stale"] if stale else []

    def _ask_term(self) -> None:
        """Asks for the formula, if it is another than the one that is shown."""
        term = Term(**{name: str(widget.value) for name, widget in self.term.items()})
        choice = self.controls.choice
        typed = [getattr(choice, name) for name in SHAPE]
        numbers = (choice.given, choice.values) if term.form == NUMBERS else ()
        asked = (term, typed, numbers)
        if asked != self._asked_term:
            self._asked_term = asked
            self.asker.ask(TERM, choice, term)

    def _refine(self) -> None:
        choice = replace(self.controls.choice, refined=True)
        self.controls.choice = choice
        self.changed(choice)

    def _file(self, language: str) -> None:
        self.notice.object = ""
        self.asker.ask(FILE, self.controls.choice, language)

    def _load(self, content: bytes | None) -> None:
        """Puts an uploaded file where it can be read, and shows what it holds."""
        if content is None:
            return
        path = Path(self._folder.name) / Path(self.load.filename or "torus.symfpu").name
        try:
            write_bytes(path, content)
        except SymfpuError as error:
            self.notice.object = problem_html(str(error))
            return
        choice = self.controls.choice.changed(bundle=str(path))
        self.controls.choice = choice
        self.changed(choice)

    def _cancel(self) -> None:
        self.asker.cancel()
        self._asked_term = None
        self.problem.object = problem_html(
            "cancelled: what is shown belongs to an earlier choice"
        )
        self._look()

    def _look(self) -> None:
        """Says how long it takes, where it takes long."""
        seconds = self.asker.seconds()
        slow = seconds > SLOW
        if slow or self.busy.object:
            self.busy.object = f"computing, {seconds:.0f} s ..." if slow else ""
        if self.cancel.visible != slow:
            self.cancel.visible = slow

    def hear(self, kind: str, ticket: int, part: Any) -> None:
        """Called by a thread: what has come is shown by the page's own loop."""
        self._document.add_next_tick_callback(partial(self._show, kind, ticket, part))

    def _show(self, kind: str, ticket: int, part: Any) -> None:
        if not self.asker.current(kind, ticket):
            return  # something else was wished since it was heard
        with panel().io.hold(self._document):  # one message to the browser
            self._show_part(kind, part)

    def _show_part(self, kind: str, part: Any) -> None:
        if part == DONE:
            if kind == TORUS:
                self.busy.css_classes = ["idle"]
        elif isinstance(part, Told):
            self._tell(part)
        elif isinstance(part, Died):
            self._asked_term = None  # what was asked of it is lost
            self.problem.object = problem_html(part.message)
        elif kind == TORUS:
            self._mark_stale(False)
            self._show_torus(part)
        elif kind == TERM:
            self._show_term(part)
        else:
            self._show_file(part)

    def _tell(self, part: Told) -> None:
        if self.asker.seconds() > SLOW:
            known = part.fraction == part.fraction
            share = f", {part.fraction:.0%}" if known else ""
            self.busy.object = (
                f"computing, {self.asker.seconds():.0f} s ... {part.label}{share}"
            )

    def _show_torus(self, part: Any) -> None:
        if isinstance(part, Problem):
            self.problem.object = problem_html(part.message)
            self._mark_stale(True)
        elif isinstance(part, Numbers):
            self.numbers.object = numbers_html(part)
            self.controls.show(part)
            self._show_lines(self.controls.choice, part.command)
            if part.choice is not None:
                self._ask_term()
        elif isinstance(part, Verdict):
            self.verdict.object = verdict_html(part)
        elif isinstance(part, Picture):
            shown = part.html or f'<p class="quiet">{part.problem}</p>'
            self.pictures[part.name].object = shown

    def _show_term(self, part: Formula | Problem) -> None:
        if isinstance(part, Problem):
            self.formula.object = problem_html(part.message)
            return
        shown = f'<div class="formula" tabindex="0">{part.svg}</div>' if part.svg else ""
        self.formula.object = shown + problem_html(part.problem) + lines_html(part.python)

    def _show_file(self, part: File | Problem) -> None:
        if isinstance(part, Problem):
            self.notice.object = problem_html(part.message)
            return
        content = base64.b64encode(part.content).decode()
        self.parcel.value = json.dumps({"name": part.name, "content": content})
        size = len(part.content) / 1000
        self.notice.object = f'<p class="quiet">{part.name}, {size:.0f} kB</p>'

    def end(self) -> None:
        """The tab is closed."""
        self.asker.end()
        self._folder.cleanup()

    def layout(self) -> Any:
        """Controls to the left, pictures in as many columns as there is room for."""
        pn = panel()
        cards = [
            self._card("Torus", self.numbers),
            self._card("Verdict on the series", self.verdict),
            *(self._card(title, self.pictures[name]) for name, title in TITLES.items()),
            self._card("A term of the series", self._term_row(pn)),
            self._card("The same in Python and on the command line", self.lines),
        ]
        self.grid.objects = cards
        styles = {"flex": "1 1 520px", "min-width": "0"}
        main = pn.Column(self.problem, self.grid, styles=styles, margin=0)
        return pn.FlexBox(
            self._side(pn),
            main,
            gap="12px",
            styles={"padding": "12px", "background": "#eef1f4", "font-size": "14px"},
            margin=0,
            align_items="flex-start",
            sizing_mode="stretch_width",
        )

    def _term_row(self, pn: Any) -> Any:
        return pn.Column(
            pn.FlexBox(*self.term.values(), margin=0),
            self.formula,
            margin=0,
            sizing_mode="stretch_width",
        )

    def _card(self, title: str, content: Any) -> Any:
        pn = panel()
        head = pn.pane.HTML(
            f'<p class="card-title">{title}</p>', stylesheets=[CSS], margin=0
        )
        return pn.Column(head, content, styles=CARD, margin=0, sizing_mode="stretch_width")

    def _side(self, pn: Any) -> Any:
        title = pn.pane.HTML(f"<h1>{TITLE}</h1>", stylesheets=[CSS], margin=(0, 6))
        fields = self.controls.fields

        def head(text: str) -> Any:
            return pn.pane.HTML(f"<h2>{text}</h2>", stylesheets=[CSS], margin=(6, 6, 0, 6))

        return pn.Column(
            title,
            head("Chain"),
            fields["N"],
            pn.Row(fields["alpha"], fields["beta"], margin=0, sizing_mode="stretch_width"),
            fields["potential"],
            self.controls.ends,
            head("Torus"),
            fields["seeds"],
            self.controls.given,
            self.controls.sliders,
            self.controls.order,
            pn.Row(
                self.busy, self.cancel, margin=0, min_height=40, sizing_mode="stretch_width"
            ),
            self.refine,
            self.copy,
            self.save,
            pn.Row(self.export, self.language, margin=0, sizing_mode="stretch_width"),
            head("Load a bundle"),
            self.load,
            self.notice,
            self.python,
            self.parcel,
            styles={**CARD, "flex": "1 0 300px", "max-width": "max(340px, 24vw)"},
            margin=0,
        )


def page(spares: Spares) -> Any:
    """What the server shows to a new tab."""
    return Page(spares).layout()
