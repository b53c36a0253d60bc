"""Pictures of symfpu.plots as SVG that the browser letters: many times quicker than matplotlib's.

A function of symfpu.plots fills axes of matplotlib, which are never rendered; what stands in them,
lines, marks, bands, words and ticks, is read and written as SVG. What is not known here is drawn by
matplotlib itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from html import escape
from typing import Any

import numpy as np

from symfpu.plots.style import Axes, Floats, styled
from symfpu.workbench.typesetting import plain, svg_text

WIDTH, HEIGHT, DPI = 480, 320, 100  # of a picture, in pixels of its own
TOP, RIGHT, BOTTOM, LEFT = 26, 12, 44, 66  # margins
LETTER = 6.2  # width of a letter of a tick, about
LEGEND_ROW, LEGEND_LETTER = 18, 6.6
FONT = 12.5
GRID, FRAME = "#e3e3e3", "#333333"
MOST_TIPS = 200  # marks that say their numbers where the pointer rests
SHAPES = {
    "o": None,
    "s": ((-1, -1), (1, -1), (1, 1), (-1, 1)),
    "D": ((0, -1.3), (1.3, 0), (0, 1.3), (-1.3, 0)),
    "^": ((-1, 0.9), (1, 0.9), (0, -1)),
    "v": ((-1, -0.9), (1, -0.9), (0, 1)),
    "<": ((0.9, -1), (0.9, 1), (-1, 0)),
    ">": ((-0.9, -1), (-0.9, 1), (1, 0)),
    "*": ((0, -1.3), (0.8, 1.1), (-1.2, -0.4), (1.2, -0.4), (-0.8, 1.1)),
    "P": ((-1, -0.4), (1, -0.4), (1, 0.4), (-1, 0.4)),
}
DASHES = {"--": "6 3", ":": "1.5 2.5", "-.": "6 3 1.5 3"}
GRID_NAMES = ("gridOn", "grid_visible")  # of the grid among the settings of ticks
NO_MARK = (None, "None", "none", "", " ")


class NotKnown(Exception):
    """Axes hold what this file does not read."""


class Sheets:
    """Empty axes: they take as long as what is drawn in them, so one waits for the next picture."""

    def __init__(self) -> None:
        self._ready: Axes | None = None

    def prepare(self) -> None:
        """Makes the next ones, at a time when nobody waits."""
        if self._ready is None:
            self._ready = _empty_axes()

    def take(self) -> Axes:
        """Axes that nothing was drawn in."""
        taken, self._ready = self._ready, None
        return _empty_axes() if taken is None else taken


def _empty_axes() -> Axes:
    from matplotlib.figure import Figure

    with styled():
        figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI)
        figure.set_layout_engine("none")
        return figure.add_axes((0.1, 0.1, 0.8, 0.8))


def picture_svg(
    draw: Callable[[Axes], object], name: str, sheets: Sheets | None = None
) -> str:
    """An SVG of what `draw` puts into axes; raises NotKnown, and what `draw` raises.

    name : of the picture, for those who do not see it. sheets : where axes are from.
    """
    ax = _empty_axes() if sheets is None else sheets.take()
    with styled():
        draw(ax)
        _require_known(ax.figure, ax)
        return _Page(ax, name).svg()


def _require_known(figure: Any, ax: Axes) -> None:
    shapes = {line.get_marker() for line in ax.lines} - {*SHAPES, *NO_MARK}
    strange = [*ax.collections, *ax.images, *ax.tables, *ax.artists, *shapes]
    if len(figure.axes) > 1 or strange:
        raise NotKnown(f"{len(figure.axes)} axes, {strange}")


class _Page:
    """One picture on its way to SVG; its axes are moved to where the labels leave room."""

    def __init__(self, ax: Axes, name: str) -> None:
        self.ax, self.name = ax, name
        self.legend = _entries(ax.get_legend())
        self.y_ticks = _ticks(ax.yaxis, ax.get_ylim())
        self.rows = self._legend_rows()
        longest = max((len(plain(label)) for _, label in self.y_ticks), default=0)
        left = max(LEFT, 34 + LETTER * longest)
        bottom = BOTTOM + LEGEND_ROW * len(self.rows)
        self.box = (left, TOP, WIDTH - RIGHT, HEIGHT - bottom)  # left, top, right, bottom
        wide, high = self.box[2] - left, self.box[3] - TOP
        place = (left / WIDTH, bottom / HEIGHT, wide / WIDTH, high / HEIGHT)
        ax.set_position(place)
        self.x_ticks = _ticks(ax.xaxis, ax.get_xlim())

    def _legend_rows(self) -> list[list[tuple[Any, str]]]:
        """Entries below the picture, as many in a row as there is room for."""
        rows: list[list[tuple[Any, str]]] = []
        room = 0.0
        for handle, label in self.legend:
            width = 40 + LEGEND_LETTER * len(plain(label))
            if not rows or width > room:
                rows.append([])
                room = WIDTH - 30.0
            rows[-1].append((handle, label))
            room -= width
        return rows

    def svg(self) -> str:
        left, top, right, bottom = self.box
        frame = (
            f'x="{left:.1f}" y="{top}" width="{right - left:.1f}" height="{bottom - top}"'
        )
        clip = f"inside-{self.name.replace(' ', '-')}"
        inside = [*self._bands(), *self._grid(), *self._lines()]
        outside = [*self._words(), *self._tick_labels(), *self._axis_labels()]
        return "\n".join(
            [
                f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
                f'role="img" aria-label="{escape(self.name)}" class="picture" '
                f'font-family="DejaVu Sans, Verdana, sans-serif" font-size="{FONT}">',
                f'<clipPath id="{clip}"><rect {frame}/></clipPath>',
                f'<g clip-path="url(#{clip})">',
                *inside,
                "</g>",
                f'<rect {frame} fill="none" stroke="{FRAME}" stroke-width="0.9"/>',
                *outside,
                *self._legend(),
                "</svg>",
            ]
        )

    def _points(self, artist: Any, values: Any) -> Floats:
        """Pixels of a picture, y downwards, of data of an artist."""
        xy = np.asarray(artist.get_transform().transform(np.asarray(values, dtype=float)))
        return np.column_stack([xy[:, 0], HEIGHT - xy[:, 1]])

    def _bands(self) -> Iterator[str]:
        for patch in sorted(self.ax.patches, key=lambda patch: patch.get_zorder()):
            corners = self._points(patch, patch.get_path().vertices)
            fill = f'fill="{_hex(patch.get_facecolor())}"'
            yield f'<path d="{_path(corners)}Z" {fill}{_opacity(patch)}/>'

    def _grid(self) -> Iterator[str]:
        left, top, right, bottom = self.box
        for x in self._x_places() if _gridded(self.ax.xaxis) else ():
            yield f'<path d="M{x:.1f} {top}V{bottom}" stroke="{GRID}"/>'
        for y in self._y_places() if _gridded(self.ax.yaxis) else ():
            yield f'<path d="M{left:.1f} {y:.1f}H{right}" stroke="{GRID}"/>'

    def _x_places(self) -> list[float]:
        data = self.ax.get_xaxis_transform()
        return [float(data.transform((x, 0))[0]) for x, _ in self.x_ticks]

    def _y_places(self) -> list[float]:
        data = self.ax.get_yaxis_transform()
        return [HEIGHT - float(data.transform((0, y))[1]) for y, _ in self.y_ticks]

    def _lines(self) -> Iterator[str]:
        for line in self.ax.lines:
            data = line.get_xydata()
            if not len(data):
                continue
            points = self._points(line, data)
            if line.get_linestyle() not in NO_MARK:
                yield f'<path d="{_path(points)}" fill="none" {_stroke(line)}/>'
            if line.get_marker() not in NO_MARK:
                yield from _marks(line, points, data)

    def _words(self) -> Iterator[str]:
        for text in self.ax.texts:
            if text.get_text():
                x, y = self._anchor(text)
                yield _word(text.get_text(), x, y, text)
        title = self.ax.get_title()
        if title:
            middle = (self.box[0] + self.box[2]) / 2
            yield _label(title, middle, TOP - 9)

    def _anchor(self, text: Any) -> tuple[float, float]:
        """Where a word or a note stands; a note may be moved by points."""
        if not hasattr(text, "xyann"):
            x, y = self._points(text, [text.get_position()])[0]
            return float(x), float(y)
        coordinates = text.xycoords
        data = self.ax.transData
        across = data if coordinates == "data" else self.ax.get_yaxis_transform()
        x, y = across.transform(text.xy)
        dx, dy = (DPI / 72 * d for d in text.xyann)
        return float(x + dx), float(HEIGHT - y - dy)

    def _tick_labels(self) -> Iterator[str]:
        left, _, _, bottom = self.box
        taken: list[tuple[float, float]] = []  # from where to where labels stand
        for x, (_, label) in zip(self._x_places(), self.x_ticks, strict=True):
            half = LETTER * len(plain(label)) / 2
            if all(x + half < start or x - half > end for start, end in taken):
                taken.append((x - half, x + half))
                yield _label(label, x, bottom + 16)
        for y, (_, label) in zip(self._y_places(), self.y_ticks, strict=True):
            yield _label(label, left - 6, y + 4.5, "end")

    def _axis_labels(self) -> Iterator[str]:
        left, top, right, bottom = self.box
        yield _label(self.ax.get_xlabel(), (left + right) / 2, bottom + 36)
        middle = (top + bottom) / 2
        turned = f' transform="rotate(-90 14 {middle:.1f})"'
        yield _label(self.ax.get_ylabel(), 14, middle + 2, more=turned)

    def _legend(self) -> Iterator[str]:
        first = HEIGHT - LEGEND_ROW * len(self.rows) + 10
        for i, row in enumerate(self.rows):
            x, y = 20.0, first + LEGEND_ROW * i
            for handle, label in row:
                yield from _sample(handle, x, y - 4)
                yield _label(label, x + 30, y, "start", size=11)
                x += 40 + LEGEND_LETTER * len(plain(label))


def _entries(legend: Any) -> list[tuple[Any, str]]:
    """What stands in a legend; nothing where there is none."""
    if legend is None:
        return []
    words = [text.get_text() for text in legend.get_texts()]
    return list(zip(legend.legend_handles, words, strict=True))


def _ticks(axis: Any, limits: Sequence[float]) -> list[tuple[float, str]]:
    """Places in view and their labels; small ones where matplotlib writes theirs."""
    low, high = sorted(limits)
    found = []
    for places, formatter in (
        (axis.get_majorticklocs(), axis.get_major_formatter()),
        (axis.get_minorticklocs(), axis.get_minor_formatter()),
    ):
        pairs = zip(
            np.asarray(places).tolist(), formatter.format_ticks(places), strict=True
        )
        found += [(x, label) for x, label in pairs if label and low <= x <= high]
    return found


def _gridded(axis: Any) -> bool:
    """Whether an axis has its grid; asking a line of it would make all ticks."""
    known = axis.get_tick_params()
    for name in GRID_NAMES:
        if name in known:
            return bool(known[name])
    return bool(axis.get_gridlines()[0].get_visible())


def _path(points: Floats) -> str:
    """Moves and lines through points; gaps where a number is none."""
    words, joined = [], False
    for x, y in points.tolist():
        known = np.isfinite(x) and np.isfinite(y)
        if known:
            words.append(f"{'L' if joined else 'M'}{x:.1f} {y:.1f}")
        joined = known
    return "".join(words)


def _hex(colour: Any) -> str:
    from matplotlib.colors import to_hex

    return str(to_hex(colour))


def _opacity(artist: Any) -> str:
    alpha = artist.get_alpha()
    return "" if alpha is None else f' opacity="{alpha:g}"'


def _stroke(line: Any) -> str:
    dash = DASHES.get(line.get_linestyle())
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    width = f'stroke-width="{line.get_linewidth() * 1.2:.2g}"'
    return f'stroke="{_hex(line.get_color())}" {width}{dashes}{_opacity(line)}'


def _marks(line: Any, points: Floats, data: Any) -> Iterator[str]:
    """The marks of a curve; of many small ones a single path."""
    size = line.get_markersize() * DPI / 144
    if len(points) > MOST_TIPS:
        dots = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in points.tolist())
        colour = _hex(line.get_color())
        width = f'stroke-width="{2 * size:.2g}" stroke-linecap="round"'
        yield f'<path d="{dots}" stroke="{colour}" {width}/>'
        return
    look = _mark_look(line)
    for (x, y), (a, b) in zip(points.tolist(), np.asarray(data).tolist(), strict=True):
        if np.isfinite(x) and np.isfinite(y):
            tip = f"<title>{a:.6g}, {b:.4g}</title>"
            yield _mark(line.get_marker(), x, y, size, look, tip)


def _mark_look(line: Any) -> str:
    face = line.get_markerfacecolor()
    fill = "none" if isinstance(face, str) and face == "none" else _hex(face)
    edge, width = _hex(line.get_markeredgecolor()), line.get_markeredgewidth()
    return f'fill="{fill}" stroke="{edge}" stroke-width="{width:g}"{_opacity(line)}'


def _mark(shape: Any, x: float, y: float, size: float, look: str, tip: str = "") -> str:
    corners = SHAPES[shape]
    if corners is None:
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{size:.2g}" {look}>{tip}</circle>'
    places = " ".join(f"{x + size * dx:.1f},{y + size * dy:.1f}" for dx, dy in corners)
    return f'<polygon points="{places}" {look}>{tip}</polygon>'


def _sample(handle: Any, x: float, y: float) -> Iterator[str]:
    """The line and mark, or the colour, of an entry of a legend."""
    if not hasattr(handle, "get_marker"):
        fill = _hex(handle.get_facecolor())
        yield f'<rect x="{x}" y="{y - 5:.1f}" width="24" height="9" fill="{fill}"/>'
        return
    if handle.get_linestyle() not in NO_MARK:
        yield f'<path d="M{x} {y:.1f}h24" {_stroke(handle)}/>'
    if handle.get_marker() not in NO_MARK:
        size = min(handle.get_markersize(), 8) * DPI / 144
        yield _mark(handle.get_marker(), x + 12, y, size, _mark_look(handle))


ANCHORS = {"center": "middle", "left": "start", "right": "end"}
DROPS = {
    "center": 0.35,
    "top": 0.9,
    "bottom": -0.3,
    "baseline": 0.0,
    "center_baseline": 0.35,
}


def _word(content: str, x: float, y: float, text: Any) -> str:
    size = text.get_fontsize() * DPI / 72 * 0.85
    drop = DROPS[text.get_verticalalignment()] * size
    anchor = ANCHORS[text.get_horizontalalignment()]
    fill = f' fill="{_hex(text.get_color())}"'
    return _label(content, x, y + drop, anchor, size=size, more=fill)


def _label(
    content: str,
    x: float,
    y: float,
    anchor: str = "middle",
    *,
    size: float = FONT,
    more: str = "",
) -> str:
    place = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size:.3g}"'
    return f"<text {place}{more}>{svg_text(content)}</text>"
