"""Pictures against those in the folder baseline, which `python -m tests.plots.pictures` draws anew.

Curves, areas and colours are compared as pixels, averaged over small squares, without words and at a fixed place of the axes: so
that fonts and edges, which releases of matplotlib draw differently, do not count, and a curve at another place does. Words are
compared as words.
"""

import json
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import imread, imsave
from matplotlib.legend import Legend
from matplotlib.text import Text

from symfpu import plots
from symfpu.plots.style import styled
from tests import every_result
from tests.plots import cases

BASELINE = Path(__file__).parent / "baseline"
SIZE, DPI, SQUARE = (4.8, 3.4), 50, 4
# where ticks stand, and with them the lines of the grid, is a matter of releases
SIZES = [f"{axis}tick.{kind}.size" for axis in "xy" for kind in ("major", "minor")]
BARE = {"axes.grid": False, "axes3d.grid": False} | dict.fromkeys(SIZES, 0)
PLACE = (0.05, 0.05, 0.9, 0.9)

PICTURES = {
    "spectrum": lambda ax: plots.spectrum(cases.torus(), ax),
    "spectrum-several": lambda ax: plots.spectrum([cases.torus(), cases.refined()], ax, groups=2),
    "spectrum-beta": lambda ax: plots.spectrum(cases.breather(), ax),
    "time-series": lambda ax: plots.time_series(cases.torus(), ax),
    "time-series-orbit": lambda ax: plots.time_series(cases.orbit("aba864_modes"), ax, quantity="E"),
    "space-time": lambda ax: plots.space_time(cases.toda_torus(), ax),
    "section": lambda ax: plots.section(cases.torus(), ax, modes=(2, 3, 4)),
    "section-breather": lambda ax: plots.section(cases.breather(), ax, modes=(2, 6)),
    "torus": lambda ax: plots.torus(cases.torus(), ax),
    "torus-breather": lambda ax: plots.torus(cases.breather(), ax, modes=(2, 4, 6)),
    "coefficients": lambda ax: plots.coefficients(cases.torus(), ax),
    "small-divisors": lambda ax: plots.small_divisors(cases.series(), ax),
    "small-divisors-refined": lambda ax: plots.small_divisors(cases.refined(), ax),
    "amplitudes": lambda ax: plots.amplitudes(cases.history(), ax),
    "residuals": lambda ax: plots.residuals(cases.assessment(), ax),
    "family-frequencies": lambda ax: plots.family_frequencies(cases.pair(), ax),
    "family-amplitudes": lambda ax: plots.family_amplitudes(cases.unstable(), ax),
    "family-multipliers": lambda ax: plots.family_multipliers(cases.unstable(), ax),
    "family-spectra": lambda ax: plots.family_spectra(cases.pair(), ax),
    "normal-frequencies": lambda ax: plots.normal_frequencies(cases.normal(), ax),
    "family-normal-frequencies": lambda ax: plots.family_normal_frequencies(every_result.normal_line(), ax),
    "lines": lambda ax: plots.lines(cases.lines_found(), ax),
    "atlas-borders": lambda ax: plots.atlas_borders(every_result.borders(), ax),
    "atlas-map": lambda ax: plots.atlas_map(every_result.borders(), ax, N=8, border="poles"),
    "frequency-map": lambda ax: plots.frequency_map(every_result.mapped(), ax),
    "frequency-drift": lambda ax: plots.frequency_drift(every_result.mapped(), ax),
    "multipliers": lambda ax: plots.multipliers(cases.stable_floquet(), ax),
    "multipliers-unstable": lambda ax: plots.multipliers(cases.unstable().members[-1].multipliers, ax),
    "alignment": lambda ax: plots.alignment(cases.indices(), ax),
    "foretold": lambda ax: plots.foretold(cases.foretold(), ax, observed=cases.integrated()),
    "lyapunov": lambda ax: plots.lyapunov(cases.indices(), ax),
    "propagation": lambda ax: plots.propagation(cases.sequence(), ax, N=32),
    "proof": lambda ax: plots.propagation(cases.proof(), ax),
    "toda-gaps": lambda ax: plots.toda_gaps(cases.invariants(), ax),
    "toda-gaps-orbit": lambda ax: plots.toda_gaps(cases.gaps(), ax, times=cases.even_orbit().times),
}
THREE = {"torus", "torus-breather"}


def drawn(name, draw=None, **style):
    """Axes, and the pixels of a picture without words, (height, width, 3), from 0 to 1; style : settings besides ours."""
    import matplotlib as mpl

    with styled(), mpl.rc_context(BARE | style):
        figure = Figure(figsize=SIZE, dpi=DPI, layout="none")
        ax = figure.add_axes(PLACE, projection="3d" if name in THREE else None)
        (draw or PICTURES[name])(ax)
        found = words(figure)
        hidden = dict.fromkeys(("labelleft", "labelright", "labelbottom", "labeltop"), False)
        for axes in figure.axes:
            axes.tick_params(axis="both", which="both", **hidden)
        for text in figure.findobj(Text):
            text.set_visible(False)
        for legend in figure.findobj(Legend):
            legend.set_visible(False)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
    return found, np.asarray(canvas.buffer_rgba())[..., :3] / 255


def words(figure):
    """Everything that is written, but for the numbers at ticks: labels, titles, legends, notes."""
    found = [figure.get_suptitle()]
    for ax in figure.axes:
        axes = [ax.xaxis, ax.yaxis, *([ax.zaxis] if ax.name == "3d" else [])]
        found += [ax.get_title(), *(axis.get_label_text() for axis in axes), *(text.get_text() for text in ax.texts)]
        if ax.get_legend():
            found += [text.get_text() for text in ax.get_legend().get_texts()]
    return [text for text in found if text]


def averaged(pixels):
    """Means over squares."""
    height, width = (n // SQUARE * SQUARE for n in pixels.shape[:2])
    squares = pixels[:height, :width].reshape(height // SQUARE, SQUARE, width // SQUARE, SQUARE, 3)
    return squares.mean(axis=(1, 3))


def distance(one, other):
    """Root of the mean square of what the averages of two pictures differ by."""
    return float(np.sqrt(np.mean((averaged(one) - averaged(other)) ** 2)))


def kept(name):
    """Words and pixels."""
    written = json.loads((BASELINE / "words.json").read_text())
    return written[name], imread(BASELINE / f"{name}.png")[..., :3]


def main():
    BASELINE.mkdir(exist_ok=True)
    written = {}
    for name in PICTURES:
        written[name], pixels = drawn(name)
        imsave(BASELINE / f"{name}.png", pixels)
    (BASELINE / "words.json").write_text(json.dumps(written, indent=1) + "\n")


if __name__ == "__main__":
    main()
