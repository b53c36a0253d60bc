"""Functions of symfpu.plots: what they draw, of which results, and what they refuse."""

import inspect
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

import symfpu
from symfpu import Atlas, Chain, InputError, SweepRows, excitation_sequence, floquet, integrate, lindstedt, plots, spectrum_floor, toda_gaps
from symfpu.plots.legends import legend
from symfpu.plots.style import EPS, parameters, styled
from symfpu.sweeps.rows import SweepRow
from tests.plots import cases
from tests.tolerances import LAST_DIGIT, ROUNDING

PUBLIC = {name: getattr(plots, name) for name in vars(plots) if inspect.isfunction(getattr(plots, name))}


@pytest.fixture
def ax():
    return Figure().add_subplot()


@pytest.fixture
def ax3():
    return Figure().add_subplot(projection="3d")


def labelled(ax):
    """The lines of the legend, by label."""
    return {line.get_label(): line for line in ax.get_lines() if not line.get_label().startswith("_")}


# what holds for all


@pytest.mark.parametrize("name", PUBLIC)
def test_a_wrong_result_is_refused_with_what_would_be_right(name):
    with pytest.raises(InputError) as refused:
        PUBLIC[name]("torus")
    assert refused.value.argument in ("result", "results")


@cache
def two_orbits():
    return integrate(Chain(4, beta=1), [[0.1, 0, 0], [0.2, 0, 0]], np.zeros((2, 3)), 10, step=0.1, averages=True)


def no_frequencies():
    return lindstedt(Chain(8, alpha=1), (1,), order=2)


def pair_of_tori():
    return [cases.torus(), cases.torus()]


# a function, the result that it is given, options, and what is said
REFUSED = [
    *((plots.spectrum, cases.torus, {"ax": wrong}, "ax =") for wrong in ("axes", 3, Figure())),
    (plots.spectrum, cases.torus, {"ax": Figure().add_subplot(projection="3d")}, "two dimensions"),
    (plots.torus, cases.torus, {}, "three dimensions"),
    *((plots.spectrum, pair_of_tori, {"labels": labels}, "labels") for labels in (["one"], "ab")),
    (plots.spectrum, lambda: [cases.torus(), cases.breather()], {}, "one length"),
    (plots.spectrum, list, {}, "at least one"),
    (plots.spectrum, cases.even_orbit, {}, "averages=True"),
    (plots.spectrum, cases.torus, {"groups": -1}, "groups"),
    (plots.time_series, cases.torus, {"quantity": "P"}, "quantity ="),
    *((plots.time_series, cases.torus, {"modes": wrong}, "modes =") for wrong in ((16,), (1, 1), (), 3, (1.5,))),
    *((plots.time_series, cases.torus, {"times": wrong}, "times =") for wrong in (3.0, [1.0])),
    (plots.time_series, cases.orbit, {"times": [0, 1]}, "samples=times"),
    *((draw, two_orbits, {}, "one by one") for draw in (plots.time_series, plots.spectrum, plots.space_time)),
    *((draw, cases.orbit, {}, "evenly spaced") for draw in (plots.space_time, plots.animation)),
    (plots.section, cases.torus, {"seed": 3}, "seed ="),
    (plots.section, cases.torus, {"points": 0}, "points ="),
    (plots.section, cases.torus, {"modes": (0,)}, "modes ="),
    (plots.torus, cases.one_mode, {"ax": None}, "section"),
    (plots.torus, cases.torus, {"ax": None, "modes": (1,)}, "two modes or three"),
    *((plots.coefficients, cases.torus, {"mode": mode}, "mode =") for mode in (0, 16)),
    (plots.coefficients, cases.single_beta, {"mode": 2}, "excites"),
    (plots.small_divisors, no_frequencies, {}, "frequencies="),
    (plots.amplitudes, lambda: cases.history(2), {}, "longer series"),
    *((plots.propagation, lambda wrong=wrong: wrong, {}, "result =") for wrong in ([], [3], [("a",)], ["ab"], 3, None)),
    (plots.propagation, cases.sequence, {"N": 8}, "N ="),
    *((plots.toda_gaps, lambda: np.ones(8), {"modes": wrong}, "modes =") for wrong in ((1, 2), (1,) * 8, "12345678")),
    (plots.lines, lambda: 3, {}, "FrequencyAnalysis"),
    (plots.family_multipliers, cases.pair, {}, "multipliers=True"),
    (plots.toda_gaps, cases.gaps, {}, "times ="),
    (plots.toda_gaps, cases.invariants, {"times": [0.0]}, "times ="),
    (plots.toda_gaps, cases.gaps, {"times": [0.0, 1.0]}, "one for each state"),
    (plots.toda_gaps, lambda: SimpleNamespace(gaps=1), {}, "result ="),
]


@pytest.mark.parametrize(("draw", "result", "options", "said"), REFUSED)
def test_what_does_not_fit_is_refused_by_name(draw, result, options, said, ax):
    with pytest.raises(InputError, match=said):
        draw(result(), **{"ax": ax} | options)


@pytest.mark.parametrize("result", [cases.toda_torus, cases.three_seeds])
def test_coefficients_of_other_chains_and_seeds_are_drawn(result, ax):
    assert plots.coefficients(result(), ax) is ax


def test_new_axes_have_our_style_and_others_keep_theirs():
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    before = dict(mpl.rcParams)
    ax = plots.spectrum(cases.torus())
    assert dict(mpl.rcParams) == before
    assert list(ax.figure.get_size_inches()) == [6.0, 4.2]
    assert plt.fignum_exists(ax.figure.number)
    plt.close(ax.figure)


# colours


def test_colours_stay_those_of_the_style_when_it_is_left(ax):
    own = ax.plot([0, 1], color="C3")[0]
    plots.propagation(excitation_sequence(8, (1, 4), 2), ax)
    drawn = [line for line in ax.get_lines() if line is not own]
    assert own.get_color() == "C3"
    assert {line.get_color() for line in drawn} <= {entry["color"] for entry in parameters()["axes.prop_cycle"]}


def test_a_backend_that_makes_itself_interactive_stays_so():
    """That of notebooks does with the first figure; else the second one is not shown."""
    import matplotlib as mpl

    before = mpl.is_interactive()
    try:
        mpl.interactive(False)
        with styled():
            mpl.interactive(True)
        assert mpl.is_interactive()
    finally:
        mpl.interactive(before)


# spectra


def test_a_spectrum_is_normalised_and_leaves_out_rounding(ax):
    breather = cases.breather()
    assert plots.spectrum(breather, ax) is ax
    line, limits = ax.get_lines()[:2]
    energies = breather.average_spectrum()
    known = np.flatnonzero(energies > spectrum_floor(breather))
    assert line.get_xdata().tolist() == (known + 1).tolist()
    assert line.get_ydata() == pytest.approx(energies[known] / energies.sum(), rel=LAST_DIGIT)
    assert not set(limits.get_xdata()) & set(line.get_xdata())
    assert (ax.get_yscale(), ax.get_xlabel()) == ("log", "$q$")


@pytest.mark.long
def test_orbits_of_particles_have_a_floor_and_those_of_modes_none(ax):
    plots.spectrum([cases.orbit(), cases.orbit("aba864_modes")], ax, labels=("particles", "modes"))
    particles, modes = labelled(ax).values()
    orbit = cases.orbit()
    floor = EPS**2 * orbit.scheme.stages * orbit.times[-1] / orbit.step
    assert min(particles.get_ydata()) > floor
    assert len(particles.get_ydata()) < len(modes.get_ydata()) == 15


def test_groups_are_those_of_the_rule(ax):
    plots.spectrum(cases.torus(), ax)
    sequence = excitation_sequence(16, (1, 2), 16)
    named = [text.get_text() for text in ax.texts]
    assert named == [f"$D_{{{k}}}$" for k, modes in enumerate(sequence) if modes]
    assert len(ax.patches) == len(named)
    bare = Figure().add_subplot()
    plots.spectrum(cases.torus(), bare, groups=0)
    assert not bare.patches


@pytest.mark.parametrize("result", [cases.one_mode, cases.toda_torus, cases.ring, cases.three_seeds, cases.refined])
def test_spectra_of_all_kinds_of_chains(result, ax):
    found = result()
    plots.spectrum(found, ax)
    line = ax.get_lines()[0]
    assert set(line.get_xdata()) <= set(found.chain.mode_numbers)
    assert sum(line.get_ydata()) == pytest.approx(1, rel=ROUNDING)


# motion


def test_time_series_are_those_of_the_result(ax):
    times = np.linspace(0, 9, 40)
    plots.time_series(cases.toda_torus(), ax, modes=(3, 1), times=times)
    found = labelled(ax)
    assert list(found) == ["$q = 3$", "$q = 1$"]
    assert found["$q = 3$"].get_ydata() == pytest.approx(cases.toda_torus().Q(times)[:, 2], rel=LAST_DIGIT)


def test_samples_of_growing_distances_get_a_logarithmic_axis(ax):
    plots.time_series(cases.orbit(), ax, quantity="E", modes=(1, 2))
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert labelled(ax)["$q = 2$"].get_ydata().tolist() == cases.orbit().harmonic_energies()[1:, 1].tolist()
    linear_axes = Figure().add_subplot()
    plots.time_series(cases.even_orbit(), linear_axes)
    assert linear_axes.get_xscale() == "linear"


@pytest.mark.parametrize("result", [cases.one_mode, cases.breather, cases.ring])
@pytest.mark.parametrize("quantity", ["Q", "E"])
def test_time_series_of_small_and_odd_chains(result, quantity, ax):
    plots.time_series(result(), ax, quantity=quantity)
    assert len(labelled(ax)) == min(4, result().chain.N - 1)
    assert all(np.isfinite(line.get_ydata()).all() for line in ax.get_lines())


@pytest.mark.parametrize(("result", "columns"), [(cases.one_mode, 3), (cases.breather, 10), (cases.ring, 9)])
def test_space_and_time_have_every_particle_and_both_ends(result, columns, ax):
    times = np.linspace(0, 5, 7)
    plots.space_time(result(), ax, times=times)
    (mesh,) = ax.collections
    values = np.asarray(mesh.get_array()).reshape(7, -1)
    assert values.shape == (7, columns)
    if not result().chain.periodic:
        assert not values[:, [0, -1]].any()
        x = result().chain.positions(result().Q(times))
        assert values[:, 1:-1] == pytest.approx(x, rel=LAST_DIGIT)
    low, high = mesh.get_clim()
    assert low == -high


def test_an_animation_moves_and_is_written(tmp_path, ax):
    breather = cases.breather()
    times = np.linspace(0, 4, 3)
    moving = plots.animation(breather, ax, times=times)
    file = tmp_path / "chain.gif"
    moving.save(file, writer="pillow", dpi=30)
    assert file.read_bytes().startswith(b"GIF89a")
    line = ax.get_lines()[0]
    last = breather.chain.positions(breather.Q(times[-1]))
    assert line.get_ydata()[1:-1] == pytest.approx(last, rel=LAST_DIGIT)


# tori


@pytest.mark.parametrize(("result", "mode", "seed"), [(cases.torus, 3, 2), (cases.ring, -2, 1)])
def test_a_section_is_taken_once_a_period(result, mode, seed, ax):
    """Of a ring, the real parts."""
    found = result()
    plots.section(found, ax, modes=(mode,), seed=seed, points=5)
    (line,) = ax.get_lines()
    times = 2 * np.pi / float(found.frequencies[found.seeds.index(seed)]) * np.arange(5)
    column = found.chain.mode_numbers.index(mode)
    assert line.get_xdata() == pytest.approx(found.Q(times)[:, column].real, rel=LAST_DIGIT)
    assert line.get_ydata() == pytest.approx(found.P(times)[:, column].real, rel=LAST_DIGIT)
    assert ("Re" in ax.get_xlabel()) == found.chain.periodic


def test_faces_of_a_torus_have_as_many_corners(ax3, monkeypatch):
    """matplotlib fills the corners that some faces lack with what the memory holds."""
    drawn = []
    monkeypatch.setattr(ax3, "plot_surface", lambda *parts, rstride, cstride, **style: drawn.append((parts[0].shape, rstride, cstride)))
    plots.torus(cases.torus(), ax=ax3)
    ((rows, columns), down, across), *others = drawn
    assert (rows - 1) % down == 0 == (columns - 1) % across
    assert others == []


def test_a_torus_of_a_ring_is_seen_along_modes_of_different_wave_length(ax3):
    plots.torus(cases.ring(), ax3)
    assert "Q_{1}" in ax3.get_xlabel()
    assert "Q_{2}" in ax3.get_zlabel().replace("-", "")


# series


def test_colours_are_the_largest_coefficients(ax):
    plots.coefficients(cases.torus(), ax, mode=3)
    table = np.ma.filled(ax.collections[0].get_array(), np.nan).reshape(-1, 13)
    torus = cases.torus()
    nu, values = torus.origin.series.harmonic_terms(list(torus.amplitudes.values()), 5)
    sizes = np.abs(values[:, 2]) * torus.chain.frequencies()[2]
    for length in range(7):
        of_length = sizes[np.abs(nu).sum(axis=1) == length]
        largest = of_length.max(initial=0)
        if largest:
            assert table[length, 5] == pytest.approx(np.log10(largest), rel=LAST_DIGIT)
        else:
            assert np.isnan(table[length, 5])


def near_resonances():
    return [abs(r.divisor) for r in cases.refined().origin.near_resonances]


def divisors(series):
    return [d.size for d in series.smallest_divisors]


@pytest.mark.parametrize(
    ("result", "expected"),
    [
        (cases.torus, lambda: divisors(cases.series())),
        (cases.refined, near_resonances),
        (cases.ring, lambda: divisors(cases.ring().origin.series)),
        (lambda: cases.ring().origin.series, lambda: divisors(cases.ring().origin.series)),
    ],
)
def test_small_divisors_are_those_of_the_series_or_of_newtons_method(result, expected, ax):
    plots.small_divisors(result(), ax)
    assert ax.get_lines()[0].get_xdata().tolist() == expected()


def test_amplitudes_are_differences_by_order(ax):
    plots.amplitudes(cases.history(), ax)
    expected = cases.history().differences()
    line = ax.get_lines()[0]
    assert line.get_xdata().tolist() == list(expected)
    assert line.get_ydata().tolist() == [first for first, _ in expected.values()]
    for same in (cases.torus(), cases.assessment()):
        other = Figure().add_subplot()
        plots.amplitudes(same, other)
        assert other.get_lines()[0].get_ydata().tolist() == line.get_ydata().tolist()


@pytest.mark.long
def test_orders_without_a_root_are_shaded(ax):
    failed = sorted(cases.lost().failures)
    assert failed
    plots.amplitudes(cases.lost(), ax)
    assert len(ax.patches) == len(failed)
    assert [text.get_text() for text in ax.get_legend().get_texts()][-1] == "no real root"


def test_residuals_by_order_with_the_best_and_the_rounding_of_doubles(ax):
    plots.residuals(cases.converged(), ax)
    line = ax.get_lines()[0]
    assert line.get_ydata().tolist() == cases.converged().residuals.tolist()
    assert "rounding" in [text.get_text() for text in ax.texts]
    other = Figure().add_subplot()
    plots.residuals(cases.assessment(), other)
    assert f"best order, $k = {cases.assessment().best_order}$" in labelled(other)


# stability and indices


def test_multipliers_lie_where_they_are_and_are_counted(ax):
    found = cases.stable_floquet()
    plots.multipliers(found, ax)
    drawn = {complex(x, y) for line in labelled(ax).values() for x, y in zip(*line.get_data(), strict=True)}
    assert drawn == set(found.multipliers.tolist())
    assert ax.get_title() == "stable"
    assert ax.get_aspect() == 1


def test_large_multipliers_stand_at_the_edge_with_their_number(ax):
    found = floquet(symfpu.torus(Chain(16, beta=1), (8,), amplitudes={8: "8"}))
    assert found.largest > 3
    plots.multipliers(found, ax)
    assert any(f"{found.largest:.3g}" in text.get_text() for text in ax.texts)
    assert max(ax.get_xlim()) < 4


def test_indices_have_their_slopes(ax):
    plots.alignment(cases.indices(), ax)
    written = [f"$G_{{{s.k}}}$: ${s.value:.2f} \\pm {s.error:.2f}$" for s in cases.indices().slopes()]
    assert list(labelled(ax)) == [text.replace("-0.00 ", "0.00 ") for text in written]
    assert ax.get_title() == cases.indices().dimension().verdict
    short = Figure().add_subplot()
    plots.alignment(cases.short_indices(), short)
    assert len(labelled(short)) == 1


# propagation and Toda


def test_the_map_has_every_mode_of_every_order(ax):
    plots.propagation(cases.sequence(), ax)
    points = set(zip(*ax.get_lines()[0].get_data(), strict=True))
    assert points == {(k, q) for k, modes in enumerate(cases.sequence()) for q in modes}


def test_exceptions_of_a_proof_stand_out(ax):
    plots.propagation(cases.proof(), ax)
    found = labelled(ax)
    odd = {(e.actual, e.mode) for e in cases.proof().exceptions}
    assert set(zip(*found["against the rule"].get_data(), strict=True)) == odd == {(2, 7)}


def test_gaps_of_states_and_orbits(ax):
    plots.toda_gaps(cases.invariants(), ax)
    assert ax.get_lines()[0].get_ydata().tolist() == cases.invariants().gaps.tolist()
    orbit = Figure().add_subplot()
    plots.toda_gaps(cases.gaps(), orbit, times=cases.even_orbit().times)
    lines = list(labelled(orbit).values())
    assert len(lines) == 6
    for line in lines:
        assert np.ptp(line.get_ydata()) < ROUNDING  # Toda's chain keeps them
    alone = Figure().add_subplot()
    plots.toda_gaps(toda_gaps(Chain(2, alpha=1), [0.1], [0.0]), alone)
    assert len(alone.get_lines()[0].get_ydata()) == 1


def test_gaps_of_a_ring_stand_at_their_modes(ax):
    modes = cases.RING.mode_numbers
    plots.toda_gaps(np.geomspace(1e-3, 1, 8), ax, modes=modes)
    assert ax.get_lines()[0].get_xdata().tolist() == list(modes)


@pytest.mark.parametrize(("curves", "columns"), [(6, 1), (7, 1), (15, 1), (31, 3)])
def test_a_long_legend_is_beside_the_axes_in_columns(curves, columns):
    ax = Figure().add_subplot()
    for i in range(curves):
        ax.plot([0, 1], label=f"q={i}")
    legend(ax)
    ax.figure.draw_without_rendering()
    frame = ax.get_legend().get_window_extent()
    assert bool(frame.x0 >= ax.bbox.x1) is (curves > 6)
    assert ax.get_legend()._ncols == columns
    assert frame.height <= 1.2 * ax.bbox.height


def test_a_border_of_chaos_is_drawn_with_the_spread_of_its_draws(ax):
    """From the lowest draw to the highest, or to the border where that is not known; phases 0 have no length."""
    spreads = {"chaos": ([1.0, 4.0], 2.0), "in-phase": ([3.0, 3.0], 3.0)}
    rows = []
    for N, highest in ((8, 4.0), (16, None)):
        borders = {name: {"energy": H, "between": [low, highest and high], "draws": 3} for name, ((low, high), H) in spreads.items()}
        case = {"chain": {"N": N, "beta": "1"}, "packet": "low:1", "order": 1}
        rows.append(SweepRow(case, {"modes": [1], "points": [], "newton": [], "borders": borders}))
    plots.atlas_borders(Atlas(SweepRows("a.function", {}, tuple(rows))), ax)
    ends = [segment[:, 1].tolist() for lines in ax.collections for segment in lines.get_segments()]
    assert ends.count([1.0, 4.0]) == 1
    assert ends.count([1.0, 2.0]) == 1
    assert ends.count([3.0, 3.0]) == len(ends) - ends.count([2.0, 2.0]) - 2
