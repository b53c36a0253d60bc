"""Every kind of solution passes the same tests."""

import importlib.util
import inspect
from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from scipy.integrate import simpson

import symfpu
from symfpu import InputError, Origin, Torus, amplitude_history, assess, compile_evaluator, export, floquet, refine, resum, save
from tests import tolerances
from tests.store.test_saved_file import same
from tests.tolerances import DIFFERENCE, FIXED_ENERGY, GRID_AVERAGE, NEWTON_RESIDUAL, QUADRATURE, ROUNDING, SERIES_RESIDUAL
from tests.tori.solutions import CASES, ON_A_RING, TIMES, breather, series_torus

# of the equations of motion, relative, that it stays below; all else follows from it
RESIDUALS = {
    "Resummed": 2e-7,
    **dict.fromkeys(("FromSeries, digits", "Resummed, digits"), 1e-9),
    **dict.fromkeys(("Newton", "Newton, one angle", "Origin", "HarmonicBalance"), 1e-12),
    "FromSeries": 1e-7,
    "IterativeRefinement, breather": 1e-25,
    "IterativeRefinement": 1e-20,
}
RESIDUALS |= {"FromSeries, waves": 1e-7, "IterativeRefinement, waves": 1e-20, "Origin, standing, digits": 1e-20}
RESIDUALS |= dict.fromkeys(("Newton, waves", "Origin, waves", "Origin, standing"), 1e-12)
WITH_SERIES = {"FromSeries", "FromSeries, digits"}


class Asked:
    """A solution by its name, and how well it solves the equations of motion."""

    def made(self, name):
        self.name, self.residual = name, RESIDUALS[name]
        self.solved = (CASES | ON_A_RING)[name]()
        return self.solved

    @property
    def one_angle(self):
        return len(self.solved.seeds) == 1

    @property
    def close(self):
        """Of energies and orbits over some periods, relative."""
        return max(100 * self.residual, 1e-12)

    def in_doubles(self, values):
        """Real with fixed ends, complex on a ring."""
        return values.astype(self.solved.chain.kind_of_ends.mode_type)


class TestEverySolution(Asked):
    """Whatever its kind, with fixed ends and of travelling and standing waves on a ring."""

    @pytest.fixture(params=[*CASES, *ON_A_RING])
    def solution(self, request):
        return self.made(request.param)

    # what it is

    def test_shapes(self, solution):
        H, s = solution.harmonics.shape
        assert s == len(solution.seeds) == len(solution.frequencies) == len(solution.phases)
        n = solution.chain.N - 1
        columns = 1 if solution.travels else n if not solution.chain.periodic else n // 2
        assert solution.cosines.shape == (H, columns)
        for along in (solution.Q, solution.P, solution.harmonic_energies):
            assert along(1.0).shape == (n,)
            assert along(TIMES).shape == (3, n)
            assert along([]).shape == (0, n)
        assert solution.x(TIMES).shape == solution.p(TIMES).shape == (3, solution.chain.kind_of_ends.particles)
        assert solution.energy(TIMES).shape == solution.energy_error(TIMES).shape == (3,)
        assert np.ndim(solution.energy()) == 0
        assert solution.average_spectrum().shape == solution.residuals(5).shape == (n,)

    @pytest.mark.parametrize("t", [[[0.0, 1.0]], float("nan"), [0.0, float("inf")], "later"])
    def test_bad_times_are_refused(self, solution, t):
        with pytest.raises(InputError, match=r"^t = "):
            solution.Q(t)

    def test_numbers_have_the_digits_that_it_says(self, solution):
        numbers = solution.x(TIMES), solution.average_spectrum(), solution.cosines
        kind = float if solution.digits is None else mpmath.mpf
        assert all(isinstance(x, kind) for values in numbers for x in values.flat)
        either = (kind, complex if solution.digits is None else mpmath.mpc)
        assert all(isinstance(x, either) for x in solution.Q(TIMES).flat)
        assert isinstance(solution.energy(), kind)

    def test_amplitudes_are_the_coefficients_of_the_seeds(self, solution):
        assert tuple(solution.amplitudes) == solution.seeds
        for i, q in enumerate(solution.seeds):
            row = (solution.harmonics == np.eye(len(solution.seeds))[i]).all(axis=1)
            [coefficient] = solution.cosines[row, solution.column(q)]
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

    # what it does

    def test_momenta_are_the_derivative_of_positions(self, solution):
        """Eighth-order central difference."""
        solution = solution.in_doubles()
        h, t = 0.02, np.linspace(0.0, 20.0, 11)
        weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
        differences = [w * (solution.Q(t + i * h) - solution.Q(t - i * h)) for i, w in weights.items()]
        assert np.abs(solution.P(t) - sum(differences) / h).max() < DIFFERENCE

    def test_particles_are_the_transform_of_the_modes(self, solution):
        """By sums over the modes, not by the chain."""
        chain, t = solution.chain, 1.3
        sites = np.arange(chain.N) if chain.periodic else np.arange(1, chain.N)
        turns = np.pi / chain.N * np.outer(sites, chain.mode_numbers)
        shapes = np.exp(2j * turns) / np.sqrt(chain.N) if chain.periodic else np.sqrt(2 / chain.N) * np.sin(turns)
        for modes, particles in ((solution.Q, solution.x), (solution.P, solution.p)):
            assert np.allclose(shapes @ self.in_doubles(modes(t)), particles(t).astype(float), rtol=0, atol=ROUNDING)

    def test_the_equations_of_motion_hold(self, solution):
        assert 0 < solution.residual() < self.residual
        forces = solution.chain.accelerations(solution.in_doubles().Q(np.linspace(0, 50, 200)))
        assert float(solution.residuals().max()) < 2 * self.residual * np.abs(forces).max()
        assert solution.residual() == solution.residual()
        assert solution.residual(7) < self.residual

    def test_the_energy_is_constant(self, solution):
        assert np.abs(solution.energy_error(np.linspace(0, 100, 23)).astype(float)).max() < self.close
        Q, P = solution.state(2.0)
        assert float(solution.energy(2.0)) == pytest.approx(float(solution.chain.energy(Q, P)), rel=ROUNDING)

    def test_harmonic_energies_are_those_of_the_state(self, solution):
        Q, P = solution.state(2.0)
        Omega = 2 * np.sin(np.abs(solution.chain.mode_numbers) * np.pi / solution.chain.turn)
        expected = (np.abs(P) ** 2 + Omega**2 * np.abs(Q) ** 2) / 2
        assert np.allclose(solution.harmonic_energies(2.0).astype(float), expected, rtol=ROUNDING, atol=ROUNDING**2)

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

    def test_doubles_are_the_same_solution(self, solution):
        doubles = solution.in_doubles()
        assert type(doubles.origin) is Origin
        assert doubles.digits is None
        assert np.allclose(doubles.Q(TIMES), self.in_doubles(solution.Q(TIMES)), atol=ROUNDING)
        assert doubles.average_spectrum().dtype == np.float64

    def test_phases_shift_the_angles(self, solution):
        doubles, t0 = solution.in_doubles(), 5.3
        turned = {q: doubles.phases[q] + float(w) * t0 for q, w in zip(solution.seeds, solution.frequencies, strict=True)}
        moved = replace(doubles, phases=turned)
        later = [t + t0 for t in TIMES]
        assert np.abs(moved.Q(TIMES) - doubles.Q(later)).max() < ROUNDING

    def test_the_state_is_in_doubles(self, solution):
        Q, P = solution.state(1.7)
        assert Q.dtype == P.dtype == self.solved.chain.kind_of_ends.mode_type
        assert same(Q, self.in_doubles(solution.Q(1.7)))
        assert same(P, self.in_doubles(solution.P(1.7)))
        assert same(solution.state(), solution.state(0.0))
        with pytest.raises(InputError, match=r"^t = "):
            solution.state([0.0, 1.0])

    def test_its_orbit_stays_on_it(self, solution):
        orbit = symfpu.integrate(solution.chain, *solution.state(), 30.0, step=0.05, samples=20)
        there = self.in_doubles(solution.Q(orbit.times))
        assert np.abs(orbit.Q - there).max() < self.close * np.abs(there).max()


class TestWithFixedEnds(Asked):
    """Every kind at the doors that take fixed ends alone, or that name its kind."""

    @pytest.fixture(params=CASES)
    def solution(self, request):
        return self.made(request.param)

    def test_its_spectrum_knows_where_it_ends(self, solution):
        floor, spectrum = symfpu.spectrum_floor(solution), solution.average_spectrum().astype(float)
        assert floor.shape == (7,)
        assert all(0 < floor[q - 1] < self.close * spectrum[q - 1] for q in solution.seeds)

    def test_exported_python_evaluates_it(self, solution, tmp_path):
        file = export(solution, "numpy", tmp_path / "solution.py")
        specification = importlib.util.spec_from_file_location("solution", file)
        module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
        expected = solution.Q(TIMES).astype(float)
        assert np.abs(module.positions(TIMES) - expected).max() < ROUNDING

    @pytest.mark.parametrize("language", ["c", "fortran", "octave", "mpmath"])
    def test_every_language_takes_it(self, solution, language, tmp_path):
        assert export(solution, language, tmp_path / "solution").stat().st_size > 1000

    def test_a_compiled_evaluator_is_the_same(self, solution):
        evaluator = compile_evaluator(solution, backend="numpy")
        assert np.abs(evaluator.Q(TIMES) - solution.Q(TIMES).astype(float)).max() < ROUNDING
        assert float(evaluator.energy()) == pytest.approx(float(solution.energy()), rel=ROUNDING)

    def test_it_is_refined(self, solution):
        refined = refine(solution)
        assert type(refined.origin) is symfpu.Newton
        assert refined.frequencies == solution.frequencies
        assert refined.residual() < NEWTON_RESIDUAL
        expected = solution.Q(TIMES).astype(float)
        assert np.abs(refined.Q(TIMES) - expected).max() < self.close * np.abs(expected).max()
        energy = 1.02 * float(solution.energy())
        raised = symfpu.refine(solution, energy=energy)
        assert float(raised.energy()) == pytest.approx(energy, rel=FIXED_ENERGY)

    def test_multipliers_belong_to_one_angle(self, solution):
        if self.one_angle:
            found = floquet(solution)
            assert isinstance(found, symfpu.Floquet)
            assert found.orbit is solution
            assert found.stable
            assert np.allclose(found.kappa[1:], floquet(breather()).kappa[1:], atol=tolerances.DOUBLE_MULTIPLIER + self.close)
            return
        with pytest.raises(InputError, match=r"^orbit = 'a torus of 2 angles'.*normal_modes\(solution\)"):
            floquet(solution)

    def test_many_digits(self, solution):
        precise = refine(solution, digits=20)
        assert precise.origin.bound < SERIES_RESIDUAL
        assert precise.frequencies == solution.frequencies
        expected = precise.Q(TIMES).astype(float)
        assert np.abs(solution.Q(TIMES).astype(float) - expected).max() < self.close

    def test_it_is_a_guess_for_newtons_method(self, solution):
        wanted = {q: float(A) * 1.01 for q, A in solution.amplitudes.items()}
        assert refine(solution, amplitudes=wanted).residual() < NEWTON_RESIDUAL

    def test_the_series_behind_it_is_judged(self, solution):
        if self.name in WITH_SERIES:
            assert assess(solution.origin.series, solution).word == "converged"
            assert resum(solution).seeds == solution.seeds
            assert same(dict(amplitude_history(solution).amplitudes), dict(amplitude_history(solution.origin.series).amplitudes))
            return
        series = series_torus().origin.series
        for door in (lambda: assess(series, solution), lambda: resum(solution), lambda: amplitude_history(solution)):
            with pytest.raises(InputError, match=r"= 'Torus of .*solve_amplitudes.*residual\(\)"):
                door()


def test_every_origin_has_its_tests():
    ours = {"Origin", *(origin.__name__ for origin in Origin.__subclasses__() if origin.__module__.startswith("symfpu."))}
    assert RESIDUALS.keys() == CASES.keys() | ON_A_RING.keys()
    assert ours == {name.partition(",")[0] for name in CASES}
    assert ours == {"Origin", *(kind.__name__ for kind in Origin.__subclasses__())}
    public = {name for name in symfpu.__all__ if inspect.isclass(getattr(symfpu, name))}
    assert ours <= public


@pytest.mark.parametrize("door", [refine, compile_evaluator, lambda x: export(x, "c", "x"), lambda x: save("x", x)])
def test_what_is_no_solution_is_refused_at_every_door(door):
    with pytest.raises(InputError, match=r"a (solution: a torus or a breather|result that symfpu computed)"):
        door(np.ones((3, 7)))


def mode(q, *harmonic):
    """A solution of one harmonic in one mode, seeds 1 and 2, at the linear frequencies."""
    cosines = np.zeros((1, 7))
    cosines[0, q - 1] = 1.0
    chain = symfpu.Chain(8, alpha="0.3")
    frequencies = tuple(map(Fraction, chain.frequencies()[:2].tolist()))
    return Torus(chain, (1, 2), frequencies, np.array([harmonic]), cosines, {1: 0.5})


def test_phases_left_out_are_zero():
    assert mode(1, 1, 0).phases == {1: 0.5, 2: 0.0}


def test_amplitudes_are_found_under_either_sign_of_a_harmonic_and_zero_where_there_is_none():
    assert mode(2, 0, -1).amplitudes == {1: 0.0, 2: 1.0}


def test_a_harmonic_in_modes_of_the_other_parity_is_not_exported(tmp_path):
    """Sources have no place for it: it was left out in silence."""
    with pytest.raises(InputError, match=r"^solution = .*nu.seeds - q even"):
        export(mode(2, 1, 0), "numpy", tmp_path / "mode")


def test_files_refuse_kinds_they_do_not_know(tmp_path):
    class Strange(Origin):
        pass

    strange = replace(CASES["Origin"](), origin=Strange())
    with pytest.raises(InputError, match=r"^result = 'Strange'.*in_doubles"):
        save(tmp_path / "strange", strange)
