"""Legends that cover nothing: inside of the axes where there is room, else beside them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from symfpu.plots.style import Axes

LONGEST_LEGEND = 15  # rows of a column
MOST_INSIDE = 6  # labels; more stand beside the axes
ABOVE_COLUMNS = 3  # of a legend above the axes
ROOM = 3.0  # points about a legend in which nothing is drawn
PLACES = (
    "upper right",
    "upper left",
    "lower left",
    "lower right",
    "center right",
    "center left",
    "upper center",
    "lower center",
    "center",
)


def legend(
    ax: Axes,
    *,
    title: str | None = None,
    most: int = MOST_INSIDE,
    first: str = PLACES[0],
) -> None:
    """A legend that covers no point, line or word; none without labels.

    most : labels that may stand inside. first : the place inside that is tried first. A picture
    has to be complete when its legend is asked for.
    """
    handles, _ = ax.get_legend_handles_labels()
    if not handles:
        return
    if len(handles) <= most:
        made = ax.legend(title=title, loc=first)
        if _finds_room(ax, made, first):
            return
    if _right_is_taken(ax):
        above = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0)}
        columns = min(ABOVE_COLUMNS, len(handles))
        ax.legend(title=title, fontsize="small", ncols=columns, **above)
    else:
        columns = 1 + (len(handles) - 1) // LONGEST_LEGEND
        beside = {"loc": "center left", "bbox_to_anchor": (1.0, 0.5)}
        ax.legend(title=title, fontsize="small", ncols=columns, **beside)
    leave_room_beside(ax)


def leave_room_beside(ax: Axes, kind: str = "constrained") -> None:
    """A layout for a figure that has none, so that nothing beside its axes is cut.

    kind : "compressed" for axes whose units are of one length. Axes that were put at a place of
    the reader's own stay there.
    """
    figure = ax.figure.canvas.figure
    engine = figure.get_layout_engine()
    replaced = engine is None or (kind == "compressed" and figure.axes == [ax])
    if replaced and ax.get_subplotspec() is not None:
        figure.set_layout_engine(kind)


def _finds_room(ax: Axes, made: Any, first: str) -> bool:
    """Whether the legend has found a place inside, the first that is free."""
    figure = ax.figure.canvas.figure
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
    ax.apply_aspect()
    for place in (first, *(other for other in PLACES if other != first)):
        made.set_loc(place)
        if not covered(ax, made):
            return True
    return False


def covered(ax: Axes, made: Any) -> bool:
    """Whether the legend's box lies over a point, a line or a word of the axes."""
    box = made.get_window_extent().padded(ROOM * ax.figure.dpi / 72)
    inside = ax.bbox
    if box.x0 < inside.x0 or box.x1 > inside.x1 or box.y0 < inside.y0 or box.y1 > inside.y1:
        return True
    there = list(_sharing(ax))
    lines = [line for other in there for line in other.lines]
    words = [text for other in there for text in other.texts]
    return (
        any(_meets(line, box) for line in lines)
        or any(text.get_window_extent().overlaps(box) for text in words)
        or any(path.intersects_bbox(box, filled=False) for path in _paths(there))
    )


def _sharing(ax: Axes) -> Iterator[Axes]:
    """The axes, and others at the same place, as a second scale has them."""
    for other in ax.figure.axes:
        if other is ax or other.bbox.bounds == ax.bbox.bounds:
            yield other


def _meets(line: Any, box: Any) -> bool:
    """Whether a marker or a piece of a line is in the box."""
    path = line.get_transform().transform_path(line.get_path())
    if not len(path.vertices):
        return False
    if line.get_marker() not in ("None", "none", None, "", " "):
        size = line.get_markersize() / 2 * line.figure.dpi / 72
        if box.padded(size).count_contains(path.vertices):
            return True
    drawn = line.get_linestyle() not in ("None", "none", None, "", " ")
    return drawn and bool(path.intersects_bbox(box, filled=False))


def _paths(axes: list[Axes]) -> Iterator[Any]:
    """Paths of collections of lines, on the screen."""
    from matplotlib.collections import LineCollection

    for one in axes:
        for collection in one.collections:
            if isinstance(collection, LineCollection):
                transform = collection.get_transform()
                yield from map(transform.transform_path, collection.get_paths())


def _right_is_taken(ax: Axes) -> bool:
    """Whether other axes have their numbers beside these: a second scale, a scale of colours."""
    return any(other is not ax and _beside(ax, other) for other in ax.figure.axes)


def _beside(ax: Axes, other: Axes) -> bool:
    same = other.bbox.bounds == ax.bbox.bounds
    return same or bool(other.get_label() == "<colorbar>")
