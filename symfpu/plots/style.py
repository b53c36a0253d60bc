"""The one style of all pictures, axes to draw in, and pictures as files.

Matplotlib is loaded when the first picture is drawn.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from importlib.resources import as_file, files
from pathlib import Path
from textwrap import fill
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.files.writing import output_file, write_bytes
from symfpu.numbers.typed import integer

Floats = NDArray[np.float64]
Axes = Any
Kind = TypeVar("Kind")

SUFFIXES = (".png", ".pdf", ".svg")
COLOURS = 5  # of the style file; then they come round
MARKERS = "osD^v<>*P"
SUBJECT, SUBJECT_WIDTH = "subject", 84  # its id in a figure; characters of a line
SHADES = ("0.95", "0.885")  # of neighbouring groups
MARK = "#d55e00"  # the colour of what stands out
NTH = re.compile("C[0-9]+")  # a colour of the style, by its place
QUIET = "0.45"  # and of what does not
EPS = 2.0**-52
MOVED = 0.55  # of the distance of two samples: by how much one may be moved to a step
DATES: dict[str, dict[str, Any]] = {
    ".png": {},
    ".pdf": {"CreationDate": None},
    ".svg": {"Date": None},
}


@lru_cache
def parameters() -> Any:
    """The settings of matplotlib that the style file makes."""
    import matplotlib as mpl

    with as_file(files("symfpu.plots") / "symfpu.mplstyle") as style:
        return mpl.rc_params_from_file(style, use_default_template=False)


@contextmanager
def styled() -> Iterator[None]:
    """Inside of it pictures have the project's style; outside nothing is changed.

    But for what the first figure changes: the backend of notebooks makes itself interactive with
    it, and else would show no second one.
    """
    import matplotlib as mpl

    with mpl.rc_context(parameters()):
        yield
        interactive = mpl.is_interactive()
    mpl.interactive(interactive)


@contextmanager
def axes_for(
    ax: Axes | None, of: str = "", *, projection: str | None = None
) -> Iterator[Axes]:
    """The axes to draw in, in the project's style: those given, or new ones of pyplot.

    of : what `subject` says of the result; it stands above axes that are alone in their figure.
    projection : "3d" where three dimensions are drawn. Raises InputError for what are no axes.
    """
    with styled():
        axes = _new_axes(projection) if ax is None else _given_axes(ax, projection)
        if of and axes.figure.axes == [axes]:
            _say_subject(axes.figure, of)
        before = set(_lines(axes))
        yield axes
        for line in set(_lines(axes)) - before:
            _keep_colours(line)


def subject(
    chain: Chain | str = "", seeds: Sequence[int] = (), energy: float | None = None
) -> str:
    """Of which chain, seeds and energy H a picture is, in a line or two.

    chain : it, or what is known of it, in words.

    >>> from symfpu import Chain
    >>> subject(Chain(16, alpha="0.33"), (1, 2), 0.0234453)
    'N=16, alpha=0.33, seeds 1, 2, H=0.0234453'
    """
    words = chain if isinstance(chain, str) else chain.label
    parts = [words] if words else []
    if seeds:
        parts.append(f"seed{'s' * (len(seeds) > 1)} {', '.join(map(str, seeds))}")
    if energy is not None:
        parts.append(f"H={energy:.6g}")
    return fill(", ".join(parts), SUBJECT_WIDTH)


def of_solution(found: Any) -> str:
    """The subject of a torus or breather."""
    return subject(found.chain, found.seeds, float(found.energy()))


def _say_subject(figure: Any, words: str) -> None:
    """Small words above the axes: those of a second result below, but none beside a title."""
    said = figure.get_suptitle()
    if said and not _is_subject(figure, said):
        return
    if words not in said.split("\n"):
        style = {"fontsize": "small", "color": QUIET, "gid": SUBJECT}
        figure.suptitle("\n".join(filter(None, (said, words))), **style)


def _is_subject(figure: Any, said: str) -> bool:
    return any(
        text.get_text() == said and text.get_gid() == SUBJECT for text in figure.texts
    )


def _lines(axes: Axes) -> list[Any]:
    """All lines of the picture that the axes are in, those of legends and second axes too.

    But those of ticks and grids, which matplotlib would make only to be asked.
    """
    figure = axes.figure
    legends = [*figure.legends, *(found.get_legend() for found in figure.axes)]
    marks = [
        line for legend in legends if legend is not None for line in legend.get_lines()
    ]
    return [*(line for found in figure.axes for line in found.lines), *marks]


def _keep_colours(line: Any) -> None:
    """The n-th colour of a style is read when a picture is drawn, which may be outside of it."""
    from matplotlib.colors import to_hex

    for part in ("color", "markerfacecolor", "markeredgecolor"):
        colour = getattr(line, f"get_{part}")()
        if isinstance(colour, str) and NTH.fullmatch(colour):
            getattr(line, f"set_{part}")(to_hex(colour))


def _new_axes(projection: str | None) -> Axes:
    from matplotlib import pyplot as plt

    return plt.figure().add_subplot(projection=projection)


def _given_axes(ax: Axes, projection: str | None) -> Axes:
    from matplotlib.axes import Axes as AnyAxes

    wanted = "axes of matplotlib, or None for new ones"
    if not isinstance(ax, AnyAxes):
        given = type(ax).__name__
        raise InputError("ax", given, wanted, "pass those of plt.subplots()")
    if (ax.name == "3d") != (projection == "3d"):
        wanted = "axes of three dimensions" if projection else "axes of two dimensions"
        advice = "leave it out, or make them with figure.add_subplot(projection=...)"
        raise InputError("ax", ax.name, wanted, advice)
    return ax


def look(i: int) -> dict[str, Any]:
    """Colour, marker and line of the i-th curve: each pair of curves differs without colours."""
    line = ("-", "--", ":")[i // COLOURS % 3]
    marker = MARKERS[i % len(MARKERS)]
    return {"color": f"C{i % COLOURS}", "marker": marker, "ls": line}


def rounding_below(ax: Axes, level: float, words: str = "rounding") -> None:
    """Shades what lies below a level of the y axis, where numbers say nothing; in view or not."""
    bottom, top = ax.get_ylim()
    if level <= bottom:
        return
    ax.axhspan(bottom, level, color=SHADES[1], zorder=0, lw=0)
    ax.set_ylim(bottom, top)
    place = {"xy": (0.01, level), "xycoords": ("axes fraction", "data")}
    ax.annotate(
        words,
        **place,
        xytext=(2, -3),
        textcoords="offset points",
        va="top",
        color=QUIET,
        fontsize="small",
    )


def whole_numbers(axis: Any) -> None:
    """Ticks of an axis, x or y, at whole numbers only."""
    from matplotlib.ticker import MaxNLocator

    axis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))


def even(times: Floats) -> bool:
    """Whether times (T,) are evenly spaced, but for samples that were moved to a step."""
    spaced = np.linspace(times[0], times[-1], len(times))
    step = abs(spaced[-1] - spaced[0]) / max(1, len(times) - 1)
    return bool(np.max(np.abs(times - spaced)) <= MOVED * step)


def require(result: object, kind: type[Kind], words: str, advice: str) -> Kind:
    """The result, if it is of this kind; InputError otherwise."""
    if isinstance(result, kind):
        return result
    raise InputError("result", type(result).__name__, words, advice)


def chosen_modes(
    chain: Chain, modes: Sequence[int], *, count: int | None = None
) -> list[int]:
    """Different modes of a chain; InputError for others, or for another number of them.

    count : how many.
    """
    known = chain.mode_numbers
    if isinstance(modes, (str, bytes)) or not np.iterable(modes):
        raise InputError("modes", modes, "modes such as (1, 2)", "pass a sequence of them")
    listed = [integer(q, "modes", known[0]) for q in modes]
    different = len(set(listed)) == len(listed)
    if not listed or not different or not set(listed) <= set(known):
        allowed = f"different modes from {known[0]} to {known[-1]}"
        raise InputError("modes", tuple(modes), allowed, "choose among these")
    if count is not None and len(listed) != count:
        raise InputError("modes", tuple(modes), f"{count} modes", "choose so many")
    return listed


def picture_file(argument: str, path: Path) -> Path:
    """The path, if a picture can be written there; InputError before anything is computed."""
    if path.suffix.lower() not in SUFFIXES:
        allowed = f"a name that ends in {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}"
        raise InputError(argument, str(path), allowed, "choose one of these formats")
    return output_file(path, argument, "choose another file")


def write_picture(
    draw: Callable[[Axes], object],
    path: Path,
    *,
    title: str = "",
    size: tuple[float, float] | None = None,
    dpi: float | None = None,
) -> Path:
    """Draws into new axes and writes a file of the format that its suffix says, whole or not."""
    kind = path.suffix.lower()
    write_bytes(path, picture_bytes(draw, kind, title=title, size=size, dpi=dpi))
    return path


def picture_bytes(
    draw: Callable[[Axes], object],
    kind: str,
    *,
    title: str = "",
    size: tuple[float, float] | None = None,
    dpi: float | None = None,
) -> bytes:
    """The same as bytes; no date is in them."""
    from matplotlib.figure import Figure

    stream = io.BytesIO()
    with styled():
        figure = Figure(figsize=size)
        ax = figure.add_subplot()
        draw(ax)
        if title:
            ax.set_title(title)
        options: dict[str, Any] = {} if dpi is None else {"dpi": dpi}
        form = kind.removeprefix(".")
        figure.savefig(stream, format=form, metadata=DATES[kind], **options)
    return stream.getvalue()
