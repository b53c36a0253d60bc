"""q-tori by Newton's method, which solve the equations of motion to rounding.

Their series only approximate them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from numbers import Real
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.numbers.arithmetic import text
from symfpu.numbers.typed import Number, exact
from symfpu.refinement.conditions import (
    Amplitude,
    Condition,
    Energy,
    FrequencyShift,
    ratio_conditions,
    seed_amplitudes,
)
from symfpu.refinement.invariance import (
    DIGITS,
    OVERSAMPLING,
    Floats,
    Ints,
    InvarianceEquation,
    long,
    rational,
)
from symfpu.refinement.newton import Iterate, NewtonStep, newton
from symfpu.tori.quasiperiodic import QuasiPeriodic, amplitudes_of, require_solution

# residual of the equations of motion, relative to the largest acceleration, that ends the search
# for harmonics
TOLERANCE = 1e-13
SMALLEST_KEPT = 1e-18  # of the largest coefficient: smaller ones of a guess are left out
MARGIN = 1e-3  # of the tolerance, to which coefficients are kept
LARGEST_GRID = 60_000_000  # values of half of the bonds; arrays of 480 MB
MOST_HARMONICS = 40_000
ROUNDS = 8  # choices of harmonics
SHOWN_DIVISORS = 10
LEAST_SIZE = Fraction(1, 10**40)  # of amplitudes and coefficients


@dataclass(frozen=True)
class NearResonance:
    """A small divisor (nu.omega)^2 - Omega_q^2 of a torus, and the coefficient under it.

    The coefficient is c_q[nu].
    """

    mode: int
    harmonic: tuple[int, ...]
    divisor: float
    coefficient: float

    def __repr__(self) -> str:
        harmonic = ",".join(map(str, self.harmonic))
        place = f"mode {self.mode}, harmonic ({harmonic})"
        return f"{self.divisor:.2g} at {place}, coefficient {self.coefficient:.2g}"


@dataclass(frozen=True, eq=False)
class RefinedTorus(QuasiPeriodic):
    """A torus found by Newton's method, Q_q(t) = sum c_q[nu] cos(nu.(omega t + phi)).

    Made by `refine` and its sisters; dimensionless, phases in radians. Ours: the paper has series
    alone.

    chain, seeds : the model and the s seeds. frequencies : omega of every seed, exact, shape (s,).
    amplitudes : by seed, of cos(theta_q) in Q_q. phases : by seed.
    harmonics : the nu, shape (H, s). cosines : c_q[nu] in doubles, shape (H, N-1).
    steps : of Newton's method with the final harmonics.
    near_resonances : the smallest divisors (nu.omega)^2 - Omega_q^2, with the coefficients under
        them.
    warnings : reasons to doubt it. digits : None, of doubles.

    >>> from symfpu import Chain, lindstedt, refine, solve_amplitudes
    >>> refine(solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)))
    RefinedTorus(N=8, alpha=0.3, omega_1=0.3905, A_1=0.4051586230417, H=0.0127984220834,
    20 harmonics, residual ..., smallest divisor 0.024 at mode 2, harmonic (2), coefficient 0.031)
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    amplitudes: Mapping[int, float]
    phases: Mapping[int, float]
    harmonics: Ints = field(repr=False)
    cosines: Floats = field(repr=False)
    steps: tuple[NewtonStep, ...] = field(repr=False)
    near_resonances: tuple[NearResonance, ...] = field(repr=False)
    warnings: tuple[str, ...] = ()
    digits: int | None = None

    @property
    def verdict(self) -> str:
        """'torus', or 'doubtful' with the reasons in `warnings`."""
        return "doubtful" if self.warnings else "torus"

    def __repr__(self) -> str:
        chain = repr(self.chain)[6:-1]
        amplitudes = ", ".join(f"A_{q}={a:.13g}" for q, a in self.amplitudes.items())
        by_seed = zip(self.seeds, self.frequencies, strict=True)
        rates = ", ".join(f"omega_{q}={float(w):.16g}" for q, w in by_seed)
        energy = float(self.energy())
        doubts = "".join(f"; {warning}" for warning in self.warnings)
        nearest = (
            f", smallest divisor {self.near_resonances[0]}" if self.near_resonances else ""
        )
        found = f"{len(self.harmonics)} harmonics, residual {self.residual():.2g}"
        return (
            f"RefinedTorus({chain}, {rates}, {amplitudes}, H={energy:.12g}, "
            f"{found}{nearest}{doubts})"
        )


class NoTorus(SymfpuError):
    """Newton's method found no torus: raised by `refine`, its sisters and `family`.

    iterate : the best one, a RefinedTorus; residual : what it leaves of the equations of motion,
        relative to the largest acceleration, dimensionless; reason : why it ended. Ours.
    """

    def __init__(self, reason: str, iterate: RefinedTorus, residual: float) -> None:
        self.reason, self.iterate, self.residual = reason, iterate, residual
        left = f"the best iterate leaves {residual:.2g} of the largest acceleration"
        advice = "start from a torus nearer to it, such as one of less energy"
        super().__init__(
            f"no torus of the seeds {iterate.seeds}: {reason}; {left}; {advice}"
        )


def refine(
    torus: QuasiPeriodic, *, tolerance: float = TOLERANCE, progress: Progress | None = None
) -> RefinedTorus:
    """The torus with the same frequencies that solves the equations of motion.

    A given torus is the guess.

    torus : of a series, resummed, or any other; its phases (radians) are kept.
    tolerance : of the residual of the equations of motion, relative to the largest acceleration,
        dimensionless; harmonics are added until it is reached.
    progress : called as (label, NO_FRACTION) on every step.

    Newton's method on the invariance equation (omega.d/dtheta)^2 Q = force(Q): Eq. eqmo on a
    torus, which the paper solves by series. Raises InputError, and NoTorus with the best iterate.

    >>> from symfpu.tori.amplitudes import solve_amplitudes
    >>> from symfpu.series.lindstedt import lindstedt
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)
    >>> breather = refine(solve_amplitudes(series))
    >>> breather.residual() < 1e-13
    True
    """
    require_solution(torus, "torus")
    conditions = [FrequencyShift(i, shift) for i, shift in enumerate(shifts_of(torus))]
    refined = refined_torus(torus, conditions, tolerance=tolerance, progress=progress)
    return replace(refined, frequencies=tuple(torus.frequencies))


def refine_at_amplitudes(
    torus: QuasiPeriodic,
    amplitudes: Mapping[int, Number],
    *,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
) -> RefinedTorus:
    """The torus with the given amplitude of every seed; its frequencies are found.

    torus : the guess, of the same seeds; its phases (radians) are kept.
    amplitudes : A_q by seed, exact numbers, dimensionless; of cos(theta_q) in Q_q.
    tolerance : of the residual of the equations of motion, relative to the largest acceleration.
    progress : called as (label, NO_FRACTION) on every step.

    As `refine`, Eq. eqmo with the s frequencies among the unknowns. Raises InputError, also for a
    seed left out, and NoTorus with the best iterate.

    >>> from symfpu import Chain, torus_at_amplitudes
    >>> guess = torus_at_amplitudes(Chain(N=8, alpha="0.3"), {1: "0.4"}, order=4)
    >>> round(float(refine_at_amplitudes(guess, {1: "0.41"}).frequencies[0]), 9)
    0.390507682
    """
    require_solution(torus, "torus")
    values = [
        long(a) for a in _by_seed("amplitudes", amplitudes, torus, signed=True).values()
    ]
    return refined_torus(
        torus,
        [Amplitude(i, a) for i, a in enumerate(values)],
        tolerance=tolerance,
        progress=progress,
    )


def refine_at_energy(
    torus: QuasiPeriodic,
    energy: Number,
    *,
    harmonic: bool,
    amplitude_ratio: Mapping[int, Number] | None = None,
    energy_ratio: Mapping[int, Number] | None = None,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
) -> RefinedTorus:
    """The torus with the given energy and ratio of amplitudes or mode energies.

    Its frequencies are found.

    torus : the guess, of the same seeds; its phases (radians) are kept.
    energy : an exact number, dimensionless.
    harmonic : False for the total energy H, True for the harmonic energy sum E_q, both at the
        angles zero.
    amplitude_ratio, energy_ratio : by seed, at most one of them; energy_ratio is of E_q of the
        seeds averaged over the torus. Left out, the amplitudes keep the ratio they have in
        `torus`.
    tolerance : of the residual of the equations of motion, relative to the largest acceleration.
    progress : called as (label, NO_FRACTION) on every step.

    As `refine`, Eq. eqmo with the s frequencies among the unknowns. Raises InputError, and
    NoTorus with the best iterate.

    >>> from symfpu import Chain, torus_at_amplitudes
    >>> guess = torus_at_amplitudes(Chain(N=8, alpha="0.3"), {1: "0.4"}, order=4)
    >>> round(float(refine_at_energy(guess, "0.012", harmonic=False).energy()), 12)
    0.012
    """
    require_solution(torus, "torus")
    value = exact(energy, "energy")
    if value <= 0:
        raise InputError(
            "energy", energy, "a positive number", "take one near the energy of the torus"
        )
    if not isinstance(harmonic, (bool, np.bool_)):
        raise InputError(
            "harmonic",
            harmonic,
            "True for sum E_q, False for H",
            "say which energy is meant",
        )
    if amplitude_ratio is not None and energy_ratio is not None:
        raise InputError(
            "energy_ratio",
            energy_ratio,
            "only one of amplitude_ratio and energy_ratio",
            "leave one out",
        )
    if energy_ratio is not None:
        ratio = _by_seed("energy_ratio", energy_ratio, torus, signed=False)
    elif amplitude_ratio is not None:
        ratio = _by_seed("amplitude_ratio", amplitude_ratio, torus, signed=True)
    else:
        ratio = {q: exact(float(a), "amplitude") for q, a in amplitudes_of(torus).items()}
    numbers = {q: float(x) for q, x in ratio.items()}
    conditions = [
        Energy(long(value), bool(harmonic)),
        *ratio_conditions(torus.seeds, numbers, energies=energy_ratio is not None),
    ]
    return refined_torus(torus, conditions, tolerance=tolerance, progress=progress)


def _by_seed(
    argument: str, values: object, torus: QuasiPeriodic, *, signed: bool
) -> dict[int, Fraction]:
    """A number for each seed, not 0 and not beyond doubles; positive unless signed."""
    kind = "number that is not 0" if signed else "positive number"
    allowed = f"a {kind} for each of the seeds {torus.seeds}, by seed"
    if not isinstance(values, Mapping) or set(values) != set(torus.seeds):
        advice = "write it as {seed: number} and name every seed"
        raise InputError(argument, values, allowed, advice)
    numbers = {q: exact(values[q], f"{argument}, {q}") for q in torus.seeds}
    sizes = [abs(x) if signed else x for x in numbers.values()]
    if not all(LEAST_SIZE < size < 1 / LEAST_SIZE for size in sizes):
        advice = "leave out a seed that is at rest"
        raise InputError(argument, dict(values), f"{allowed}, of moderate size", advice)
    return numbers


def unit_harmonics(s: int) -> list[tuple[int, ...]]:
    """e_1 .. e_s."""
    return [tuple(row) for row in np.eye(s, dtype=np.int64).tolist()]


def refined_torus(
    torus: QuasiPeriodic,
    conditions: Sequence[Condition],
    *,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
) -> RefinedTorus:
    """The torus near a guess that meets as many conditions as it has angles.

    With as many harmonics as the tolerance needs.
    """
    require_solution(torus, "torus")
    if not isinstance(tolerance, Real) or not 0 < tolerance < 1:
        raise InputError(
            "tolerance", tolerance, "a number between 0 and 1", "take 1e-13 or more"
        )
    tell = progress or unheard
    chain, seeds = torus.chain, torus.seeds
    known = _rows(torus.harmonics, _moderate_coefficients(torus))
    shifts = shifts_of(torus)
    before = np.inf
    for attempt in range(ROUNDS):
        least = tolerance * MARGIN / 10**attempt
        harmonics, full = chosen_harmonics(known, chain, len(seeds), least)
        equation = InvarianceEquation(chain, seeds, harmonics)
        none = np.zeros(chain.N - 1)
        rows = [known.get(tuple(nu), none) for nu in harmonics.tolist()]
        cosines = np.array(rows, dtype=np.longdouble)
        tell(f"{len(harmonics)} harmonics, {equation.grid.points} points", NO_FRACTION)
        guess = np.where(equation.mask, cosines, 0)
        found = newton(equation, conditions, guess, shifts, tell)
        refined = _result(torus, equation, found)
        residual = refined.residual()
        if found.failure:
            raise NoTorus(found.failure, refined, residual)
        tell(f"residual {residual:.1e} between the grid points", NO_FRACTION)
        if residual <= tolerance:
            return refined
        if full or residual > before / 2:
            reason = "as many harmonics as fit" if full else "more harmonics change nothing"
            left = (
                f"leave a residual of {residual:.2g}, above the tolerance {tolerance:.0e}"
            )
            return replace(refined, warnings=(f"{reason} {left}",))
        before, shifts = residual, found.shifts
        known = _rows(harmonics, np.asarray(found.cosines))
    warning = f"the residual is {residual:.2g} after {ROUNDS} choices of harmonics"
    return replace(refined, warnings=(warning,))


def _moderate_coefficients(torus: QuasiPeriodic) -> Floats:
    """The coefficients in doubles; InputError where they are all 0 or of no moderate size."""
    with np.errstate(over="ignore"):
        coefficients = torus.cosines.astype(float)
    largest = float(np.abs(coefficients).max(initial=0))
    if not LEAST_SIZE < largest < 1 / LEAST_SIZE:  # also where it is not a number
        given = f"coefficients up to {largest:.3g}"
        allowed = "coefficients not all 0 and of moderate size"
        raise InputError("torus", given, allowed, "take another guess")
    return coefficients


def shifts_of(torus: QuasiPeriodic) -> Floats:
    """omega - Omega of the seeds in long doubles; shape (s,)."""
    with mpmath.workdps(2 * DIGITS):
        linear = [torus.chain.linear_frequency(q) for q in torus.seeds]
        chosen = [mpmath.mpf(w.numerator) / w.denominator for w in torus.frequencies]
        shifts = [w - x for w, x in zip(chosen, linear, strict=True)]
    return np.array([long(shift) for shift in shifts])


def _rows(harmonics: Ints, cosines: Floats) -> dict[tuple[int, ...], Floats]:
    """Coefficients by harmonic, the first number that is not 0 positive.

    A small part left out.
    """
    largest = np.abs(cosines).max()
    rows: dict[tuple[int, ...], Floats] = {}
    for nu, row in zip(harmonics.tolist(), cosines, strict=True):
        if np.abs(row).max() > SMALLEST_KEPT * largest:
            sign = -1 if next((n for n in nu if n), 1) < 0 else 1
            rows[tuple(sign * n for n in nu)] = row
    return rows


def chosen_harmonics(
    known: Mapping[tuple[int, ...], Floats], chain: Chain, s: int, tolerance: float
) -> tuple[Ints, bool]:
    """Harmonics whose coefficients are expected above the tolerance.

    The second result says whether more would not fit.

    ln |c[nu]| is fitted by a - sum w_i |nu_i|; all harmonics within the reach of the fit are
    taken, one of each pair +-nu.
    """
    size = {nu: float(np.abs(row).max()) for nu, row in known.items()}
    largest = max(size.values())
    used = {nu: x for nu, x in size.items() if x > 1e-16 * largest}
    table = np.array([[1, *(-abs(n) for n in nu)] for nu in used], dtype=float)
    heights = np.log([x / largest for x in used.values()])
    determined = len(used) > s + 1
    solution = np.full(s + 1, 3.0)
    if determined:
        solution = np.linalg.lstsq(table, heights, rcond=None)[0]
    weights = np.clip(solution[1:], 0.2, 12.0)
    above = heights - table[:, 1:] @ weights
    offset = float(np.quantile(above, 0.98)) if determined else 0.0
    reach = max(-np.log(tolerance) + max(offset, 0.0), 3.5 * weights.max())
    full = False
    while not _fits(weights, reach, chain):
        reach, full = 0.95 * reach, True
    inside = _inside(tuple(weights.tolist()), reach)
    chosen = sorted({*inside, *unit_harmonics(s)})
    return np.array(chosen, dtype=np.int64), full


def _fits(weights: Floats, reach: float, chain: Chain) -> bool:
    """Whether the harmonics fit, and half of the bonds on the points of their lattice.

    The lattice has about twice as many points as the cross-polytope of harmonics.
    """
    s, half = len(weights), (chain.N + 1) // 2
    polytope = float(np.prod(2 * reach / weights + 1)) / math.factorial(s)
    points = 1.2 * OVERSAMPLING**s / 2**s * polytope
    return bool(points * half <= LARGEST_GRID and polytope / 2 <= MOST_HARMONICS)


def _inside(
    weights: tuple[float, ...], reach: float, *, positive: bool = True
) -> Iterator[tuple[int, ...]]:
    """All harmonics with sum w_i |nu_i| <= reach, the first number that is not 0 positive."""
    top = int(reach / weights[0])
    lowest = 0 if positive else -top
    for n in range(lowest, top + 1):
        if len(weights) == 1:
            yield (n,)
            continue
        rest = reach - weights[0] * abs(n)
        for others in _inside(weights[1:], rest, positive=positive and n == 0):
            yield n, *others


def _result(
    torus: QuasiPeriodic, equation: InvarianceEquation, found: Iterate
) -> RefinedTorus:
    with mpmath.workdps(2 * DIGITS):
        linear = [torus.chain.linear_frequency(q) for q in torus.seeds]
        pairs = zip(linear, found.shifts, strict=True)
        frequencies = [_fraction(w + _mpf(shift)) for w, shift in pairs]
    amplitudes = map(float, seed_amplitudes(equation, found.cosines))
    return RefinedTorus(
        chain=torus.chain,
        seeds=torus.seeds,
        frequencies=tuple(frequencies),
        amplitudes=dict(zip(torus.seeds, amplitudes, strict=True)),
        phases={q: float(phi) for q, phi in torus.phases.items()},
        harmonics=equation.harmonics,
        cosines=found.cosines.astype(float),
        steps=found.steps,
        near_resonances=_near_resonances(equation, found),
    )


def _mpf(value: np.longdouble) -> Any:
    number = rational(value)
    return mpmath.mpf(number.numerator) / number.denominator


def _fraction(value: Any) -> Fraction:
    return Fraction(text(value, 25))


def _near_resonances(
    equation: InvarianceEquation, found: Iterate
) -> tuple[NearResonance, ...]:
    every = equation.divisors(found.shifts).astype(float)
    divisors = np.where(equation.mask, every, np.inf)
    divisors[equation.seed_rows, equation.seed_columns] = np.inf
    order = np.argsort(np.abs(divisors), axis=None)[:SHOWN_DIVISORS]
    rows, columns = np.unravel_index(order, divisors.shape)
    nearest = []
    for r, q in zip(rows, columns, strict=True):
        if np.isfinite(divisors[r, q]):
            harmonic = tuple(equation.harmonics[r].tolist())
            divisor, coefficient = float(divisors[r, q]), float(found.cosines[r, q])
            nearest.append(NearResonance(int(q) + 1, harmonic, divisor, coefficient))
    return tuple(nearest)
