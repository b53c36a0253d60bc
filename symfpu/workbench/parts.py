"""What the page shows of a choice, part by part, each as soon as it is there."""

from __future__ import annotations

import base64
import io
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from html import escape
from pathlib import Path
from typing import Any

from symfpu.chain.chain import require_fixed_ends
from symfpu.codegen.export import LANGUAGES
from symfpu.codegen.export import export as export_source
from symfpu.errors import SymfpuError
from symfpu.files.progress import Progress, unheard
from symfpu.plots.series import residuals, small_divisors
from symfpu.plots.spectra import spectrum
from symfpu.plots.style import Axes, styled
from symfpu.plots.tori import section
from symfpu.plots.tori import torus as torus_surface
from symfpu.store.saved_file import save
from symfpu.tori.verdict import Assessment
from symfpu.workbench.choice import Choice
from symfpu.workbench.drawing import HEIGHT, WIDTH, NotKnown, Sheets, picture_svg
from symfpu.workbench.solving import Solved, described, judged, solved

SPECTRUM, RESIDUALS, SECTION = "spectrum", "residual by order", "section"
DIVISORS, SURFACE = "small divisors", "torus"
PICTURES = (SPECTRUM, RESIDUALS, SECTION, DIVISORS, SURFACE)
SURFACE_DPI = 120
NO_SERIES = "no series: what was found another way has no orders"


@dataclass(frozen=True)
class Seed:
    """A row of the table: a seed with its linear and chosen frequencies and its amplitude."""

    q: int
    linear: float
    omega: float
    amplitude: float


@dataclass(frozen=True)
class Numbers:
    """What is known at once: the seeds, mu, H, sum E_q, residual and doubts.

    command : the command line of the torus. choice : what a file holds, None where there is none.
    """

    kind: str
    seeds: tuple[Seed, ...]
    mu: float
    energy: float
    harmonic_energy: float
    residual: float
    warnings: tuple[str, ...]
    command: str
    choice: Choice | None


@dataclass(frozen=True)
class Picture:
    """HTML of a picture by its name, or the reason why there is none."""

    name: str
    html: str
    problem: str = ""


@dataclass(frozen=True)
class Verdict:
    """The verdict on the series: a word or two, the reasons."""

    headline: str
    reasons: tuple[str, ...]


@dataclass(frozen=True)
class Problem:
    """Why nothing can be shown, as the package says it."""

    message: str


@dataclass(frozen=True)
class File:
    """A file to be handed to the browser."""

    name: str
    content: bytes


Part = Numbers | Picture | Verdict | Problem


class Bench:
    """The computing side: remembers the last torus, from which the next one begins."""

    def __init__(self) -> None:
        self.last: Solved | None = None
        self._sheets = Sheets()

    def prepare(self) -> None:
        """What the next answer needs whatever it is, at a time when nobody waits."""
        self._sheets.prepare()

    def parts(self, choice: Choice, progress: Progress | None = None) -> Iterator[Part]:
        """What is shown of a choice; errors of the package are parts too."""
        tell = progress or unheard
        try:
            found = self.solved(choice, tell)
            yield _numbers(found)
        except SymfpuError as error:
            yield Problem(_without_folder(str(error), choice))
            return
        yield from _pictures(found, tell, self._sheets)

    def solved(self, choice: Choice, progress: Progress | None = None) -> Solved:
        """The torus of a choice, computed once."""
        if self.last is None or self.last.choice != choice:
            self.last = solved(choice, self.last, progress)
        return self.last

    def file(self, choice: Choice, language: str = "") -> File | Problem:
        """The torus as a file: a bundle, or source code in a language."""
        try:
            found = self.solved(choice)
            with tempfile.TemporaryDirectory() as folder:
                return _written(found, language, Path(folder))
        except SymfpuError as error:
            return Problem(_without_folder(str(error), choice))


def _without_folder(message: str, choice: Choice) -> str:
    """A message that names a loaded file without the folder where it was put for a while."""
    folder = str(Path(choice.bundle).parent) + "/"
    return message.replace(folder, "") if choice.bundle else message


def _numbers(found: Solved) -> Numbers:
    torus = found.best
    chain = torus.chain
    linear = dict(zip(chain.mode_numbers, chain.frequencies().tolist(), strict=True))
    omega = dict(zip(torus.seeds, torus.frequencies, strict=True))
    seeds = [
        Seed(q, linear[q], float(omega[q]), float(torus.amplitudes[q])) for q in torus.seeds
    ]
    choice, bundle = found.choice, found.choice.bundle
    return Numbers(
        kind=torus.origin.name,
        seeds=tuple(seeds),
        mu=chain.mu,
        energy=float(torus.energy()),
        harmonic_energy=float(torus.harmonic_energies().sum()),
        residual=float(torus.residual()),
        warnings=tuple(torus.warnings),
        command=choice.command(
            dict(zip(found.torus.seeds, found.torus.frequencies, strict=True))
        ),
        choice=described(torus, bundle) if bundle else None,
    )


def _pictures(found: Solved, tell: Progress, sheets: Sheets) -> Iterator[Part]:
    best = found.best
    both = found.torus if found.refined is None else [found.torus, found.refined]
    yield _picture(SPECTRUM, partial(spectrum, both), sheets)
    verdict = judged(found, tell)
    yield from _judgement(found, verdict)
    yield _picture(SECTION, partial(section, best))
    yield _picture(DIVISORS, partial(small_divisors, best))
    yield _surface(best)


def _judgement(found: Solved, verdict: Assessment | None) -> Iterator[Part]:
    refined = () if found.refined is None else (_refined_text(found),)
    if verdict is None:
        yield Verdict(NO_SERIES, refined)
        yield Picture(RESIDUALS, "", NO_SERIES)
        return
    yield Verdict(verdict.verdict, (*refined, *verdict.reasons))
    yield _picture(RESIDUALS, partial(residuals, verdict))


def _refined_text(found: Solved) -> str:
    assert found.refined is not None
    count = len(found.refined.harmonics)
    left = float(found.refined.residual())
    terms = "waves" if found.refined.chain.periodic else "harmonics"
    return f"Newton's method leaves a residual of {left:.2g}, with {count} {terms}"


def _picture(
    name: str, draw: Callable[[Axes], object], sheets: Sheets | None = None
) -> Picture:
    try:
        return Picture(name, picture_svg(draw, name, sheets))
    except NotKnown:
        return Picture(name, _image(draw, name))
    except SymfpuError as error:
        return Picture(name, "", str(error))


def _surface(torus: Any) -> Picture:
    try:
        draw = partial(torus_surface, torus)
        return Picture(SURFACE, _image(draw, SURFACE, projection="3d"))
    except SymfpuError as error:
        return Picture(SURFACE, "", str(error))


def _image(draw: Callable[[Axes], object], name: str, projection: str | None = None) -> str:
    """A picture as matplotlib renders it, with everything it can draw."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    stream = io.BytesIO()
    with styled():
        size = WIDTH / 100, HEIGHT / 100
        figure = Figure(figsize=size, dpi=SURFACE_DPI)
        figure.set_layout_engine("none")
        ax = figure.add_axes((0.0, 0.04, 1.0, 0.96), projection=projection)
        draw(ax)
        canvas: Any = FigureCanvasAgg(figure)
        canvas.print_png(stream)  # savefig would cut the margins off
    content = base64.b64encode(stream.getvalue()).decode()
    return (
        f'<img class="picture" alt="{escape(name)}" src="data:image/png;base64,{content}">'
    )


def _written(found: Solved, language: str, folder: Path) -> File:
    torus = found.best
    if not language:
        verdict = judged(found)
        record = None if verdict is None or found.refined is not None else verdict.record()
        command = found.choice.command(
            dict(zip(found.torus.seeds, found.torus.frequencies, strict=True))
        )
        path = save(folder / "torus.symfpu", torus, verdict=record, command=command)
    else:
        require_fixed_ends(torus.chain)
        path = export_source(torus, language, folder / "torus")
    return File(path.name, path.read_bytes())


def languages() -> tuple[str, ...]:
    """Names of the languages of exported code."""
    return tuple(LANGUAGES)
