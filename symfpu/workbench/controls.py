"""The left side of the page: what is chosen, as widgets, and the choice that they make."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from symfpu.errors import SymfpuError
from symfpu.numbers.typed import double
from symfpu.workbench.choice import AMPLITUDES, ENERGY, FREQUENCIES, Choice
from symfpu.workbench.parts import Numbers
from symfpu.workbench.ranges import Range, energies, ranges, typed
from symfpu.workbench.server import panel
from symfpu.workbench.texts import subscript

LAST_ORDER = 20
SHAPE = ("N", "alpha", "beta", "potential", "ends", "seeds")
FULL = {"sizing_mode": "stretch_width", "margin": (2, 6)}


class Controls:
    """Widgets of a choice; changed : called with each new one."""

    def __init__(self, choice: Choice, changed: Callable[[Choice], None]) -> None:
        self.choice, self._changed = choice, changed
        self._quiet = False  # while widgets are set from here
        self._found: Numbers | None = None
        pn = panel()
        self.fields = {
            name: pn.widgets.TextInput(name=label, **FULL) for name, label in LABELS.items()
        }
        self.fields["potential"].placeholder = "toda:0.33   poly:0.33,0,1/5   lj:12,6"
        self.ends = pn.widgets.RadioButtonGroup(
            name="ends", options={"fixed ends": "fixed", "ring": "periodic"}, **FULL
        )
        words = {
            "frequencies ω": FREQUENCIES,
            "amplitudes A": AMPLITUDES,
            "energy H": ENERGY,
        }
        self.given = pn.widgets.RadioButtonGroup(name="given", options=words, **FULL)
        self.order = _prompt(
            pn.widgets.IntSlider(
                name="order k of the series", start=1, end=LAST_ORDER, **FULL
            )
        )
        self.sliders = pn.Column(margin=0, sizing_mode="stretch_width")
        self.message = pn.pane.HTML("", **FULL)
        self._values: list[Any] = []
        self._energy: Any = None
        self._set(choice)
        for name, field in self.fields.items():
            field.param.watch(
                lambda event, name=name: self._typed(name, event.new), "value"
            )
        self.ends.param.watch(lambda event: self._typed("ends", event.new), "value")
        self.given.param.watch(lambda event: self._given(event.new), "value")
        self.order.param.watch(lambda event: self._moved(), "value")
        self._make_sliders(self._first_ranges(), choice.values)

    def show(self, found: Numbers) -> None:
        """Remembers what was found, for the next kind of sliders; of a file, sets all of them."""
        self._found = found
        if found.choice is not None:
            self.choice = found.choice
            self._set(found.choice)
            self._make_sliders(self._first_ranges(), found.choice.values)

    def _set(self, choice: Choice) -> None:
        self._quiet = True
        for name, field in self.fields.items():
            field.value = getattr(choice, name)
        self.ends.value, self.given.value = choice.ends, choice.given
        self.order.end = max(LAST_ORDER, int(choice.order))
        self.order.value = int(choice.order)
        self._disable()
        self._quiet = False

    def _disable(self) -> None:
        """Couplings are of no meaning beside a potential."""
        for name in ("alpha", "beta"):
            self.fields[name].disabled = bool(self.choice.potential.strip())

    def _typed(self, name: str, value: str) -> None:
        """A field of the chain or of the seeds: sliders begin anew."""
        if self._quiet:
            return
        self.choice = self.choice.changed(**{name: value.strip()})
        self._disable()
        self._found = None
        self._begin()

    def _given(self, given: str) -> None:
        """Another kind of sliders, which begin at the torus that is there."""
        if self._quiet:
            return
        self.choice = self.choice.changed(given=given)
        self._begin()

    def _begin(self) -> None:
        """New sliders, and the choice that they make; what is wrong is said by computing it."""
        found = self._first_ranges()
        if not found:
            self._changed(self.choice)
            return
        self._make_sliders(found, self._values_found(found))
        self._moved()

    def _first_ranges(self) -> tuple[Range, ...]:
        try:
            return ranges(self.choice.chain, self.choice.seed_modes, self.choice.given)
        except SymfpuError:
            return ()

    def _values_found(self, first: tuple[Range, ...]) -> tuple[str, ...]:
        """Where new sliders stand: at the torus that was found, else where they stand first."""
        values = [limits.value for limits in first]
        by_seed = {s.q: s for s in self._found.seeds} if self._found else {}
        if set(by_seed) != set(self.choice.seed_modes) or self.choice.given == ENERGY:
            return tuple(typed(value) for value in values)
        seeds = [by_seed[q] for q in self.choice.seed_modes]
        chosen = self.choice.given == FREQUENCIES
        return tuple(typed(s.omega if chosen else s.amplitude) for s in seeds)

    def _make_sliders(self, found: tuple[Range, ...], values: tuple[str, ...]) -> None:
        if not found:
            return
        pn = panel()
        names = self._slider_names()
        pairs = zip(names, found, values, strict=True)
        self._values = [
            _slider(name, limits, float(_real(value))) for name, limits, value in pairs
        ]
        widgets = list(self._values)
        self._energy = None
        if self.choice.given == ENERGY:
            self._energy = self._energy_slider(pn)
            widgets.insert(0, self._energy)
        for widget in widgets:
            widget.param.watch(lambda event: self._moved(), "value")
        self.sliders[:] = widgets

    def _slider_names(self) -> list[str]:
        chain = self.choice.chain
        linear = dict(zip(chain.mode_numbers, chain.frequencies().tolist(), strict=True))
        if self.choice.given == FREQUENCIES:
            return [
                f"{subscript('ω', q)}   ({subscript('Ω', q)} = {linear[q]:.7g})"
                for q in self.choice.seed_modes
            ]
        letter = {AMPLITUDES: "A", ENERGY: "share of E"}[self.choice.given]
        return [subscript(letter, q) for q in self.choice.seed_modes]

    def _energy_slider(self, pn: Any) -> Any:
        least, largest = energies(self.choice.chain, self.choice.seed_modes)
        value = largest - 1.5
        if self._found is not None:
            value = min(max(_log(self._found.energy), least), largest)
        limits = {"start": round(least, 2), "end": round(largest, 2), "step": 0.01}
        name = "log₁₀ of the energy H"
        return _prompt(
            pn.widgets.FloatSlider(name=name, value=round(value, 2), **limits, **FULL)
        )

    def _moved(self) -> None:
        """A slider stands elsewhere."""
        if self._quiet:
            return
        changes: dict[str, Any] = {"order": str(self.order.value)}
        if len(self._values) == len(self.choice.seeds.split(",")):
            changes["values"] = tuple(typed(widget.value) for widget in self._values)
        if self._energy is not None:
            changes["energy"] = typed(float(f"{10**self._energy.value:.4g}"))
        self.choice = self.choice.changed(**changes)
        self._changed(self.choice)


LABELS = {
    "N": "N, bonds",
    "alpha": "\N{GREEK SMALL LETTER ALPHA}",
    "beta": "β",
    "potential": "or another potential V(r)",
    "seeds": "seeds D₀",
}


def _slider(name: str, limits: Range, value: float) -> Any:
    pn = panel()
    places = max(0, len(f"{limits.step:.12f}".rstrip("0").partition(".")[2]))
    slider = pn.widgets.EditableFloatSlider(
        name=name,
        start=min(limits.start, value),
        end=max(limits.end, value),
        step=limits.step,
        value=value,
        format=f"0.{'0' * (places + 1)}",
        **FULL,
    )
    return _prompt(slider)


def _prompt(widget: Any) -> Any:
    """The widget, heard at once: Panel waits 50 ms for more changes; here the newest wins."""
    for part in widget.select(lambda part: hasattr(part, "_debounce")):
        part._debounce = 0
    return widget


def _real(text: str) -> float:
    return double(text, "value")


def _log(energy: float) -> float:
    return math.log10(energy) if energy > 0 else -math.inf
