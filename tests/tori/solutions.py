"""What every kind of solution has to do, as tests that are inherited; and one cheap case of each kind, N = 8.

A new kind is a case in CASES and a class of its own in test_solutions.py.
"""

import copy
import importlib.util
import pickle
from dataclasses import replace
from functools import cache

import mpmath
import numpy as np
import pytest
from scipy.integrate import simpson

from symfpu.breathers.balance import breather_at_amplitude, periodic_orbit
from symfpu.breathers.digits import periodic_orbit_digits
from symfpu.breathers.floquet import Floquet, floquet
from symfpu.breathers.shooting import shoot
from symfpu.bundles.bundle import load, save
from symfpu.chain.chain import Chain
from symfpu.codegen.evaluator import compile_evaluator
from symfpu.codegen.export import export
from symfpu.dynamics.alignment import alignment_indices
from symfpu.dynamics.orbits import integrate
from symfpu.errors import InputError
from symfpu.localization.floors import spectrum_floor
from symfpu.refinement.tori import RefinedTorus, refine, refine_at_energy
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import amplitude_history, solve_amplitudes
from symfpu.tori.quasiperiodic import FourierTorus
from symfpu.tori.resummation import resum
from symfpu.tori.verdict import assess
from tests.bundles.test_bundle import same
from tests.tolerances import (
    DIFFERENCE,
    DOUBLE_MULTIPLIER,
    FIXED_ENERGY,
    GRID_AVERAGE,
    NEWTON_RESIDUAL,
    QUADRATURE,
    ROUNDING,
    SERIES_RESIDUAL,
)

CHAIN = Chain(8, alpha="0.3", beta="0.1")
PHASES = {1: 0.4, 2: -1.3}
SEED, FREQUENCY = 3, "1.1140"
TIMES = [0.0, 1.7, 40.0]
MORE_ANGLES = "more than one angle"


@cache
def series_torus():
    series = lindstedt(CHAIN, (1, 2), ("0.3904", "0.7658"), 8)
    return solve_amplitudes(series, phases=PHASES)


@cache
def breather():
    return periodic_orbit(CHAIN, SEED, FREQUENCY)


@cache
def digits_torus():
    series = lindstedt(CHAIN, (SEED,), (FREQUENCY,), 9, digits=20)
    return solve_amplitudes(series, phases={SEED: 0.5})


# by name: how to make one
CASES = {
    "QTorus": series_torus,
    "QTorus, digits": digits_torus,
    "RefinedTorus": cache(lambda: refine(series_torus())),
    "RefinedTorus, one angle": cache(lambda: refine(digits_torus())),
    "ResummedTorus": cache(lambda: resum(series_torus())),
    "ResummedTorus, digits": cache(lambda: resum(digits_torus())),
    "FourierTorus": cache(lambda: refine(series_torus()).in_doubles()),
    "PeriodicOrbit": breather,
    "PreciseOrbit": cache(lambda: periodic_orbit_digits(breather(), 25)),
    "PreciseTorus": cache(lambda: refine(digits_torus(), digits=20)),
    "ShotOrbit": cache(lambda: shoot(CHAIN, SEED, FREQUENCY)),
}


class SolutionTests:
    """name : of the case. residual : of the equations of motion, relative, that it stays below; all else follows from it."""

    name = ""
    residual = 1e-12
    with_series = False

    @pytest.fixture
    def solution(self):
        return CASES[self.name]()

    @property
    def one_angle(self):
        return len(CASES[self.name]().seeds) == 1

    @property
    def close(self):
        """Of energies and orbits over some periods, relative."""
        return max(100 * self.residual, 1e-12)

    # what it is

    def test_the_class_is_the_one_named(self, solution):
        assert type(solution).__name__ == self.name.partition(",")[0]

    def test_shapes(self, solution):
        H, s = solution.harmonics.shape
        assert s == len(solution.seeds) == len(solution.frequencies) == len(solution.phases)
        assert solution.cosines.shape == (H, 7)
        for along in (solution.positions, solution.momenta, solution.harmonic_energies):
            assert along(1.0).shape == (7,)
            assert along(TIMES).shape == (3, 7)
            assert along([]).shape == (0, 7)
        assert solution.energy(TIMES).shape == solution.energy_error(TIMES).shape == (3,)
        assert np.ndim(solution.energy()) == 0
        assert solution.average_spectrum().shape == solution.residuals(5).shape == (7,)

    @pytest.mark.parametrize("t", [[[0.0, 1.0]], float("nan"), [0.0, float("inf")], "later"])
    def test_bad_times_are_refused(self, solution, t):
        with pytest.raises(InputError, match=r"^t = "):
            solution.positions(t)

    def test_numbers_have_the_digits_that_it_says(self, solution):
        numbers = solution.positions(TIMES), solution.average_spectrum(), solution.cosines
        kind = float if solution.digits is None else mpmath.mpf
        assert all(isinstance(x, kind) for values in numbers for x in values.flat)
        assert isinstance(solution.energy(), kind)

    def test_amplitudes_are_the_coefficients_of_the_seeds(self, solution):
        assert tuple(solution.amplitudes) == solution.seeds
        for i, q in enumerate(solution.seeds):
            row = (solution.harmonics == np.eye(len(solution.seeds))[i]).all(axis=1)
            [coefficient] = solution.cosines[row, q - 1]
            assert float(solution.amplitudes[q]) == pytest.approx(float(coefficient), rel=ROUNDING)
            assert abs(coefficient) > 0.01

    def test_one_angle_has_one_seed_frequency_and_amplitude(self, solution):
        if self.one_angle:
            (seed,), (omega,) = solution.seeds, solution.frequencies
            assert (solution.seed, solution.frequency) == (seed, omega)
            assert solution.amplitude == solution.amplitudes[seed]
            table = solution.by_harmonic()
            assert len(table) == solution.harmonics.max() + 1
            assert all((table[n] == row).all() for (n,), row in zip(solution.harmonics, solution.cosines, strict=True))
            return
        for one in ("seed", "frequency", "amplitude"):
            with pytest.raises(InputError, match=rf"^{one} = 'of 2 angles'"):
                getattr(solution, one)
        with pytest.raises(InputError, match="of 2 angles"):
            solution.by_harmonic()

    def test_repr_is_an_answer(self, solution):
        text = repr(solution)
        assert text.startswith(f"{type(solution).__name__}(")
        assert "N=8, alpha=0.3, beta=0.1" in text
        assert len(text.splitlines()) == 1

    # what it does

    def test_momenta_are_the_derivative_of_positions(self, solution):
        """Eighth-order central difference."""
        solution = solution.in_doubles()
        h, t = 0.02, np.linspace(0.0, 20.0, 11)
        weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
        differences = [w * (solution.positions(t + i * h) - solution.positions(t - i * h)) for i, w in weights.items()]
        assert np.abs(solution.momenta(t) - sum(differences) / h).max() < DIFFERENCE

    def test_the_equations_of_motion_hold(self, solution):
        assert 0 < solution.residual() < self.residual
        forces = solution.chain.accelerations(solution.in_doubles().positions(np.linspace(0, 50, 200)))
        assert float(solution.residuals().max()) < 2 * self.residual * np.abs(forces).max()
        assert solution.residual() == solution.residual()
        assert solution.residual(7) < self.residual

    def test_the_energy_is_constant(self, solution):
        assert np.abs(solution.energy_error(np.linspace(0, 100, 23)).astype(float)).max() < self.close
        Q, P = solution.state(2.0)
        assert float(solution.energy(2.0)) == pytest.approx(float(CHAIN.energy(Q, P)), rel=ROUNDING)

    def test_harmonic_energies_are_those_of_the_state(self, solution):
        Q, P = solution.state(2.0)
        Omega = 2 * np.sin(np.arange(1, 8) * np.pi / 16)
        expected = (P**2 + Omega**2 * Q**2) / 2
        assert np.allclose(solution.harmonic_energies(2.0).astype(float), expected, rtol=ROUNDING, atol=0)

    def test_the_average_is_the_one_over_the_angles(self, solution):
        """An equidistant grid with more points than the squares have harmonics integrates them exactly."""
        points = 2 * int(np.abs(solution.harmonics).max()) + 1
        angles = 2 * np.pi * np.arange(points) / points
        doubles = solution.in_doubles()
        grid = np.stack(np.meshgrid(*[angles] * len(solution.seeds)), axis=-1).reshape(-1, len(solution.seeds))
        shifted = (replace(doubles, phases=dict(zip(solution.seeds, theta, strict=True))) for theta in grid)
        mean = sum(torus.harmonic_energies() for torus in shifted) / len(grid)
        spectrum = solution.average_spectrum().astype(float)
        assert np.allclose(spectrum, mean, rtol=GRID_AVERAGE, atol=GRID_AVERAGE * mean.max())

    def test_the_average_of_a_time_is_a_quadrature(self, solution):
        t = np.linspace(0.0, 30.0, 3001)
        expected = simpson(solution.in_doubles().harmonic_energies(t), x=t, axis=0) / 30.0
        found = solution.average_spectrum(30.0)
        assert np.allclose(found, expected, rtol=QUADRATURE, atol=QUADRATURE * expected.max())

    def test_its_spectrum_knows_where_it_ends(self, solution):
        floor, spectrum = spectrum_floor(solution), solution.average_spectrum().astype(float)
        assert floor.shape == (7,)
        assert all(0 < floor[q - 1] < self.close * spectrum[q - 1] for q in solution.seeds)

    def test_doubles_are_the_same_solution(self, solution):
        doubles = solution.in_doubles()
        assert type(doubles) is FourierTorus
        assert doubles.digits is None
        assert np.allclose(doubles.positions(TIMES), solution.positions(TIMES).astype(float), atol=ROUNDING)
        assert doubles.average_spectrum().dtype == np.float64

    def test_phases_shift_the_angles(self, solution):
        doubles, t0 = solution.in_doubles(), 5.3
        turned = {q: doubles.phases[q] + float(w) * t0 for q, w in zip(solution.seeds, solution.frequencies, strict=True)}
        moved = replace(doubles, phases=turned)
        later = [t + t0 for t in TIMES]
        assert np.abs(moved.positions(TIMES) - doubles.positions(later)).max() < ROUNDING

    def test_the_state_is_in_doubles(self, solution):
        Q, P = solution.state(1.7)
        assert Q.dtype == P.dtype == np.float64
        assert same(Q, solution.positions(1.7).astype(float))
        assert same(P, solution.momenta(1.7).astype(float))
        assert same(solution.state(), solution.state(0.0))
        with pytest.raises(InputError, match=r"^t = "):
            solution.state([0.0, 1.0])

    # the doors

    def test_copies_are_the_same(self, solution):
        for other in (pickle.loads(pickle.dumps(solution)), copy.copy(solution), copy.deepcopy(solution)):
            assert same(other, solution)
            assert same(other.positions(TIMES), solution.positions(TIMES))

    def test_files_keep_it(self, solution, tmp_path):
        with mpmath.workdps(5):  # the precision of the moment is not the file's
            bundle = load(save(tmp_path / "solution", solution, verdict={"good": True}))
        loaded = bundle.torus
        assert same(loaded, solution)
        for answer in ("positions", "momenta", "energy", "harmonic_energies"):
            assert same(getattr(loaded, answer)(TIMES), getattr(solution, answer)(TIMES))
        assert same(loaded.cosines, solution.cosines)
        assert same(dict(loaded.amplitudes), dict(solution.amplitudes))
        assert (bundle.series is not None, bundle.verdict) == (self.with_series, {"good": True})
        assert len(bundle.test_vectors) == 3
        assert type(solution).__name__ in repr(bundle)
        assert "saved" in repr(bundle)
        assert save(tmp_path / "again", loaded).stat().st_size > 0

    def test_exported_python_evaluates_it(self, solution, tmp_path):
        file = export(solution, "numpy", tmp_path / "solution.py")
        specification = importlib.util.spec_from_file_location("solution", file)
        module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
        expected = solution.positions(TIMES).astype(float)
        assert np.abs(module.positions(TIMES) - expected).max() < ROUNDING

    @pytest.mark.parametrize("language", ["c", "fortran", "octave", "mpmath"])
    def test_every_language_takes_it(self, solution, language, tmp_path):
        assert export(solution, language, tmp_path / "solution").stat().st_size > 1000

    def test_a_compiled_evaluator_is_the_same(self, solution):
        evaluator = compile_evaluator(solution, backend="numpy")
        assert np.abs(evaluator.positions(TIMES) - solution.positions(TIMES).astype(float)).max() < ROUNDING
        assert float(evaluator.energy()) == pytest.approx(float(solution.energy()), rel=ROUNDING)

    def test_its_orbit_stays_on_it(self, solution):
        orbit = integrate(CHAIN, *solution.state(), 30.0, step=0.05, samples=20)
        there = solution.positions(orbit.times).astype(float)
        assert np.abs(orbit.Q - there).max() < self.close * np.abs(there).max()

    def test_alignment_indices_start_from_it(self, solution):
        found = alignment_indices(CHAIN, *solution.state(), 100.0, vectors=2, samples=64, frames=1)
        assert np.isfinite(found.log10_gali).all()
        assert found.times[-1] == pytest.approx(100.0)

    def test_it_is_refined(self, solution):
        refined = refine(solution)
        assert type(refined) is RefinedTorus
        assert refined.frequencies == solution.frequencies
        assert refined.residual() < NEWTON_RESIDUAL
        expected = solution.positions(TIMES).astype(float)
        assert np.abs(refined.positions(TIMES) - expected).max() < self.close * np.abs(expected).max()
        energy = 1.02 * float(solution.energy())
        raised = refine_at_energy(solution, energy, harmonic=False)
        assert float(raised.energy()) == pytest.approx(energy, rel=FIXED_ENERGY)

    def test_multipliers_belong_to_one_angle(self, solution):
        if self.one_angle:
            found = floquet(solution)
            assert isinstance(found, Floquet)
            assert found.orbit is solution
            assert found.stable
            assert np.allclose(found.kappa[1:], floquet(breather()).kappa[1:], atol=DOUBLE_MULTIPLIER + self.close)
            return
        with pytest.raises(InputError, match=r"^orbit = 'a torus of 2 angles'.*normal_modes\(solution\)"):
            floquet(solution)

    def test_many_digits_of_one_angle(self, solution):
        if self.one_angle:
            precise = periodic_orbit_digits(solution, 20)
            assert precise.bound < SERIES_RESIDUAL
            assert precise.frequency == solution.frequency
            expected = precise.positions(TIMES).astype(float)
            assert np.abs(solution.positions(TIMES).astype(float) - expected).max() < self.close
            return
        with pytest.raises(InputError, match=r"^orbit = 'a torus of 2 angles'.*refine\(torus, digits="):
            periodic_orbit_digits(solution, 20)

    def test_it_is_a_guess_for_harmonic_balance(self, solution):
        if self.one_angle:
            orbit = breather_at_amplitude(CHAIN, SEED, float(solution.amplitude) * 1.01, solution)
            assert orbit.residual() < NEWTON_RESIDUAL
            return
        with pytest.raises(InputError, match=r"^guess = 'a torus of 2 angles'.*one seed"):
            periodic_orbit(CHAIN, SEED, FREQUENCY, solution)

    def test_the_series_behind_it_is_judged(self, solution):
        if self.with_series:
            assert assess(solution.series, solution).word == "converged"
            assert resum(solution).seeds == solution.seeds
            assert same(dict(amplitude_history(solution).amplitudes), dict(amplitude_history(solution.series).amplitudes))
            return
        series = series_torus().series
        for door in (lambda: assess(series, solution), lambda: resum(solution), lambda: amplitude_history(solution)):
            with pytest.raises(InputError, match=rf"= '{type(solution).__name__}'.*solve_amplitudes.*residual\(\)"):
                door()
