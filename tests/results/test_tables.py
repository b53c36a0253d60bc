"""What stands in tables: from their numbers alone the solution is put together again."""

import subprocess
import sys
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
import symengine as se

from symfpu import (
    Chain,
    SymfpuError,
    floquet,
    integrate,
    lindstedt,
    prove_propagation,
    sample_series,
    solve_amplitudes,
    toda_gaps,
    toda_invariants,
)
from symfpu.results.attributes import attributes, plain
from symfpu.results.grid import ROUNDED, Grid, Variable
from tests.store.test_saved_file import same
from tests.tolerances import COEFFICIENT, FORTY_DIGITS, ROUNDING

CHAIN, SEEDS = Chain(8, alpha="0.3", beta="0.1"), (1, 2)
RING = Chain(8, alpha="0.3", ends="periodic")
PHASES = {1: 0.3, 2: 1.1}


def torus(digits=None):
    series = lindstedt(CHAIN, SEEDS, ("0.3905", "0.7663"), 4, digits=digits)
    return solve_amplitudes(series, phases=PHASES)


def summands(table, solution):
    """mu^k prod A^power times the coefficient, of every row."""
    mu = solution.chain.small_parameter(solution.numbers)
    found = table["value"].to_numpy() * np.array([mu ** int(k) for k in table["order"]])
    for q, A in solution.amplitudes.items():
        found = found * np.array([A ** int(p) for p in table[f"power_{q}"]])
    return found


@pytest.mark.parametrize(("digits", "close"), [(None, COEFFICIENT), (40, FORTY_DIGITS)])
def test_the_table_of_a_series_is_the_series(digits, close):
    """Its rows give the orbit at t = 0 and the chosen frequencies."""
    found = torus(digits)
    table = found.origin.series.to_frame()
    with found.numbers.context(digits):
        coordinates = table[table.quantity == "coordinate"]
        angles = sum(coordinates[f"nu_{q}"].to_numpy() * found.phases[q] for q in SEEDS)
        terms = summands(coordinates, found) * found.numbers.cos(np.asarray(angles))
        for q, Q in zip(CHAIN.mode_numbers, found.Q(0), strict=True):
            assert abs(terms[coordinates["mode"] == q].sum() - Q) < close
        frequencies = table[table.quantity == "frequency"]
        terms = summands(frequencies, found)
        for q, omega in zip(SEEDS, found.frequencies, strict=True):
            assert abs(terms[frequencies["mode"] == q].sum() - found.numbers.number(omega)) < close


def test_the_table_of_a_universal_series_holds_its_terms():
    series = lindstedt(CHAIN, SEEDS, order=2)
    table = series.to_frame()
    A, theta = se.symbols("A1 A2"), se.symbols("theta1 theta2")
    rows = table[(table.quantity == "coordinate") & (table["mode"] == 3) & (table.order == 2)]
    total = 0
    for row in rows.itertuples():
        angle = int(row.nu_1) * theta[0] + int(row.nu_2) * theta[1]
        total += row.value * A[0] ** int(row.power_1) * A[1] ** int(row.power_2) * se.cos(angle)
    assert len(rows) > 1
    assert se.expand(total - series.term(3, 2)) == 0


def test_the_table_of_waves_is_their_series():
    """Its rows give the stretches at t = 0 and the frequencies, up to the orders left out."""
    series = lindstedt(RING, (1, -2), ("0.766", "1.416"), 6)
    found = replace(solve_amplitudes(series), phases={1: 0.3, -2: 1.1})
    table = series.to_frame()
    coordinates = table[table.quantity == "coordinate"]
    terms = summands(coordinates, Waves(series, found.amplitudes))
    terms *= 2 * np.abs(np.sin(np.pi * coordinates["mode"].to_numpy() / 8))
    waves = 0.0
    for q, phi in found.phases.items():
        places = 2 * np.pi * q * (np.arange(8) + 0.5) / 8 - phi
        waves = waves + np.outer(coordinates[f"nu_{q}"], places)
    r = terms @ np.cos(waves) / np.sqrt(8)
    x = found.x(0.0)
    assert r == pytest.approx(np.roll(x, -1) - x, abs=COEFFICIENT)
    frequencies = table[table.quantity == "frequency"]
    terms = summands(frequencies, Waves(series, found.amplitudes))
    omega, _ = series.frequency_terms([A**2 for A in found.amplitudes.values()])
    for i, q in enumerate(series.seeds):
        mine = terms[(frequencies["mode"] == q).to_numpy()].sum()
        assert mine == pytest.approx(omega[:, i].sum(), abs=ROUNDING)


def test_the_unit_of_a_table_leaves_no_trace():
    """A long series keeps its coefficients in another unit of amplitudes."""
    near = ("0.765368",)
    long, short = (lindstedt(RING, (1,), near, order) for order in (60, 4))
    assert (long.unit, short.unit) == (8, 1)
    table = long.to_frame()
    first = table[table.order <= 4]
    assert first.value.to_numpy() == pytest.approx(short.to_frame().value.to_numpy(), rel=COEFFICIENT)


class Waves:
    """What `summands` asks for."""

    def __init__(self, series, amplitudes):
        self.chain, self.numbers, self.amplitudes = series.chain, series.numbers, amplitudes


def test_the_table_at_many_points_is_that_of_each():
    universal = lindstedt(CHAIN, SEEDS, order=2)
    points = [("0.3905", "0.7663"), ("0.391", "0.767")]
    sampled = sample_series(universal, [[float(w) for w in point] for point in points])
    table = sampled.to_frame()
    for number, point in enumerate(points):
        alone = universal.at(point).to_frame()
        mine = table[(table.point == number) & (table.quantity == "coordinate")]
        other = alone[alone.quantity == "coordinate"]
        for name in ("order", "mode", "nu_1", "nu_2", "power_1", "power_2"):
            assert mine[name].tolist() == other[name].tolist()
        assert mine.value.to_numpy() == pytest.approx(other.value.to_numpy(), rel=COEFFICIENT)


def test_a_data_set_of_a_torus_gives_its_orbit():
    found = torus()
    data = found.to_xarray()
    angles = (data.nu * (data.frequency * 7.0 + data.phase)).sum("seed")
    Q = (data.cosine * np.cos(angles)).sum("harmonic")
    assert Q.dims == ("mode",)
    assert Q.values == pytest.approx(found.Q(7.0), abs=ROUNDING)
    assert data.cosine.sel(harmonic="1,0", mode=1).item() == found.amplitudes[1]
    assert "precision" not in data.cosine.attrs


def test_numbers_of_many_digits_stay_in_tables_and_are_rounded_in_data_sets():
    found = torus(40)
    table, data = found.to_frame(), found.to_xarray()
    assert table.cosine.tolist() == found.cosines.reshape(-1).tolist()
    assert data.cosine.dtype == np.float64
    assert data.cosine.attrs["precision"] == ROUNDED
    assert data.attrs["energy"] == str(found.energy())
    assert same(found.Q(3.0), torus(40).Q(3.0)), "a table leaves no rounded numbers behind"


def test_a_table_of_a_grid_takes_variables_in_any_order_of_axes():
    values = np.arange(6.0).reshape(2, 3)
    both = {"across": Variable(("b", "a"), values, ""), "own": Variable(("a",), [7, 8, 9], ""), "one": Variable(("c",), [1], "")}
    grid = Grid({"a": [1, 2, 3], "b": ["x", "y"], "c": [0]}, both, {}, ("a", "b"))
    columns = {name: list(column) for name, column in grid.table().columns.items()}
    assert columns == {
        "a": [1, 1, 2, 2, 3, 3],
        "b": ["x", "y"] * 3,
        "across": [0, 3, 1, 4, 2, 5],
        "own": [7, 7, 8, 8, 9, 9],
    }


def test_an_orbit_has_its_axes_and_so_have_several():
    start = np.array([[0.1, 0, 0], [0, 0.2, 0]])
    orbit = integrate(Chain(4, beta=1), start, 0 * start, 10.0, step=0.125, averages=True)
    data, table = orbit.to_xarray(), orbit.to_frame()
    assert dict(data.sizes) == {"time": len(orbit.times), "orbit": 2, "mode": 3}
    assert data.energy.dims == ("time", "orbit")
    assert data.average_energy.sel(mode=2).values.tolist() == orbit.averages[:, :, 1].tolist()
    assert len(table) == orbit.Q.size
    row = table[(table.time == orbit.times[5]) & (table.orbit == 1) & (table["mode"] == 2)]
    assert row.P.item() == orbit.P[5, 1, 1]
    assert row.energy.item() == orbit.energies[5, 1]


def test_an_orbit_of_a_ring_has_complex_modes_with_their_signs():
    Q = np.where(np.abs(RING.mode_numbers) == 1, 0.05 + 0.02j * np.sign(RING.mode_numbers), 0)
    orbit = integrate(RING, Q, 0 * Q, 10.0, step=0.125)
    data = orbit.to_xarray()
    both = data.Q_real.sel(mode=-1) + 1j * data.Q_imaginary.sel(mode=-1)
    assert both.values.tolist() == orbit.Q[:, RING.mode_numbers.index(-1)].tolist()
    assert data.attrs["ends"] == "periodic"


def test_complex_numbers_are_two_variables():
    found = floquet(torus_of_one())
    data = found.to_xarray()
    both = data.multiplier_real.values + 1j * data.multiplier_imaginary.values
    assert both.tolist() == found.pairs[:, 0].tolist()
    assert data.monodromy.sel(after="Q_1", before="P_2").item() == found.monodromy[0, 8]


def torus_of_one():
    return solve_amplitudes(lindstedt(CHAIN, (1,), ("0.3905",), 8))


def test_orders_that_do_not_exist_are_holes_of_whole_numbers():
    found = prove_propagation(8, (2,), 1, model="alpha").to_frame()
    assert str(found.actual.dtype) == "Int64"
    assert found.actual.isna().tolist() == [q not in (2, 4) for q in range(1, 8)]


def test_the_modes_of_a_ring_have_their_signs():
    Q, P = np.zeros((2, 7), dtype=complex)
    places = {q: i for i, q in enumerate(RING.mode_numbers)}
    Q[places[1]], Q[places[-1]] = 0.05, 0.05
    found = toda_invariants(RING, Q, P)
    table = found.to_frame()
    assert table["mode"].tolist() == list(RING.mode_numbers)
    assert table.gap.tolist() == toda_gaps(RING, Q, P).tolist()
    assert abs(table["mode"][table.gap.idxmax()]) == 1
    assert "of mode 1" in repr(found) or "of mode -1" in repr(found)


def test_attributes_are_what_was_typed():
    known = attributes(object(), CHAIN, seeds=SEEDS, nothing=None, third=Fraction(1, 3))
    assert known["chain"] == "Chain(N=8, alpha=0.3, beta=0.1)"
    assert (known["alpha"], known["beta"], known["N"], known["ends"]) == ("0.3", "0.1", 8, "fixed")
    assert (known["seeds"], known["third"]) == ("1, 2", "1/3")
    assert "nothing" not in known
    assert attributes(object(), Chain(8, potential="toda:1/2"))["potential"] == "toda:0.5"


def test_a_very_long_fraction_is_written_whole():
    fraction = Fraction(3**9100 + 1, 3**9101)
    above, _, below = plain(fraction).partition("/")
    assert Fraction(int(above, 16), int(below, 16)) == fraction


@pytest.mark.parametrize(("package", "method"), [("pandas", "to_frame"), ("xarray", "to_xarray")])
def test_without_the_package_one_line_says_what_to_install(package, method, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(SymfpuError, match=rf"^{package} is not installed; pip install 'symfpu\[data\]'$"):
        getattr(torus_of_one(), method)()


@pytest.mark.long
def test_results_are_made_without_the_packages():
    code = "import sys; from symfpu import Chain, lindstedt, solve_amplitudes, integrate, family, floquet; "
    code += "solve_amplitudes(lindstedt(Chain(8, alpha='0.3'), (1,), ('0.3905',), 4)); "
    code += "print([name for name in ('pandas', 'xarray', 'h5netcdf') if name in sys.modules])"
    finished = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert finished.stdout.strip() == "[]"
