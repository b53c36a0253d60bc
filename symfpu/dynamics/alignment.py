"""Alignment indices GALI_k of an orbit, all k at once and in logarithms, its maximal Lyapunov exponent, the dimension of its torus.

The paper's G_r of sections 3.2 and 4.

GALI_k is the k-volume of k unit deviation vectors (Skokos, Bountis, Antonopoulos, Physica D 231 (2007) 30; Eur. Phys. J. Special
Topics 165 (2008) 5). On a torus of dimension s in a phase space of dimension 2n, n = N - 1, it goes as
    t^0 for k <= s,    t^-(k-s) for s < k <= 2n - s,    t^-2(k-n) for k > 2n - s,
on a chaotic orbit as exp(-t sum_{j<=k} (chi_1 - chi_j)). Logarithms are to base 10, as in the captions of the paper.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Real
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.dynamics.frame_run import FrameRun, Progress, seconds_a_step
from symfpu.dynamics.tangent import moving_frame, step_length
from symfpu.errors import InputError
from symfpu.files.checkpoint import checkpoint_path, seconds_between
from symfpu.numbers.typed import integer

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STEP, SAMPLES, VECTORS, BLOCK = 0.4, 400, 7, 40
MOST_VECTORS, MOST_SAMPLES, MOST_STEPS = 64, 1_000_000, 2**52
LOST_ENERGY = 1e-3  # relative: an orbit that has lost so much is not one of the chain
DECADES = 1.5  # of time, the last ones, in which slopes are fitted
PARTS = 8  # of that range, left out one at a time for the uncertainty of a slope
FEWEST = 4 * PARTS  # samples in it
FEWEST_SAMPLES = 2 * FEWEST  # in all: rounding to steps unites some of the first
SHORTEST = 100  # time, and steps
FLOOR = 0.1  # least uncertainty of a slope in the choice of a dimension: transients and log-periodic waves that one window cannot show
ODD = 1 / 3  # a slope so far from every integer it should be decides nothing
SURE = 0.95  # weight of a dimension that is called decided
CHAOTIC_GROWTH = 3.0  # d log |v| / d log t: 1 on a torus, lambda t on a chaotic orbit


@dataclass(frozen=True)
class Slope:
    """d log GALI_k / d log t with its uncertainty."""

    k: int
    value: float
    error: float

    def __repr__(self) -> str:
        return f"GALI_{self.k}: {self.value:.2f} +- {self.error:.2f}"


@dataclass(frozen=True)
class TorusDimension:
    """What the slopes say of the torus under an orbit.

    verdict : 'regular, dimension s', 'regular, dimension s or more' if no index falls, 'chaotic' or 'undecided'. value : s, None for a
    chaotic or undecided orbit. error : the standard deviation of s over the weights; weights : of each s, normalised, also where
    nothing is decided. reason : the numbers behind the verdict.
    """

    verdict: str
    value: int | None
    error: float
    weights: Mapping[int, float] = field(repr=False)
    reason: str


@dataclass(frozen=True, eq=False)
class AlignmentIndices:
    """log10 GALI_k and Lyapunov exponent of an orbit in time (section 3.2, Fig. 1(e)).

    Made by `alignment_indices`; times are dimensionless, in units of the chain.

    chain : the model. times : (S,), spaced evenly in log t.
    log10_gali : (S, vectors-1), for k = 2 .. vectors. lyapunov : (S,), log |v_1| / t of the first vector.
    step : of the integrator. energy_error : |H(T) - H(0)| / H(0) of the orbit.

    Its methods look at the last decades of time.

    >>> from symfpu import Chain, alignment_indices
    >>> found = alignment_indices(Chain(N=4, alpha=1), [0.1, 0, 0], [0, 0, 0], 1e3, vectors=2)
    >>> found.times.shape, found.log10_gali.shape, found.lyapunov.shape
    ((274,), (274, 1), (274,))
    >>> found
    AlignmentIndices(N=4, alpha=1, t = 1e+03, ... energy error ...)
    """

    chain: Chain
    times: Floats
    log10_gali: Floats
    lyapunov: Floats
    step: float
    energy_error: float

    def __repr__(self) -> str:
        slopes = ", ".join(f"{s.value:.2f}" for s in self.slopes())
        return (
            f"AlignmentIndices({repr(self.chain)[6:-1]}, t = {self.times[-1]:.3g}, {self.dimension().verdict}: slopes of "
            f"GALI_2..{self.vectors} {slopes}, Lyapunov exponent {self.lyapunov[-1]:.2g}, energy error {self.energy_error:.1g})"
        )

    @property
    def vectors(self) -> int:
        """The number of deviation vectors."""
        return int(self.log10_gali.shape[1]) + 1

    def slopes(self, decades: float = DECADES) -> tuple[Slope, ...]:
        """d log GALI_k / d log t over the last decades of time for k = 2 .. vectors.

        The uncertainty is that of the delete-a-block jackknife over PARTS stretches of the window: it sees waves longer than the
        samples are apart, and bends. decades : of time, cut to what the samples span and widened to FEWEST of them. Raises InputError.
        """
        return tuple(Slope(k, *found) for k, found in enumerate(self._fits(self.log10_gali, decades), start=2))

    def dimension(self, decades: float = DECADES) -> TorusDimension:
        """The dimension s of the torus, from how each further vector changes the slope (sections 3.2, 4).

        log GALI_j - log GALI_(j-1) has the slope 0 for j <= s, -1 for s < j <= 2n-s, -2 above. Each s has the weight exp(-chi^2/2)
        of these differences, whose uncertainties are at least FLOOR and are enlarged where no s fits. The orbit is called chaotic if
        the first vector grows faster than t^CHAOTIC_GROWTH (by three standard errors) and an index falls faster than a torus allows;
        undecided if a slope is off its integer by more than ODD, if no s has the weight SURE, if the first vector does not yet grow as t
        does (before that time indices stay constant on every torus), or if the orbit has lost LOST_ENERGY of its energy.
        """
        if not self.energy_error <= LOST_ENERGY:
            reason = f"the orbit is off by {self.energy_error:.1g} of its energy: take a shorter step than {self.step:g}"
            return TorusDimension("undecided", None, math.nan, {}, reason)
        growth, doubt = self._fits((self.lyapunov * self.times / math.log(10))[:, None], decades)[0]
        steps = np.array(self._fits(np.diff(self.log10_gali, axis=1, prepend=0.0), decades))
        reason = f"|v| grows as t^{growth:.2f} +- {doubt:.2f}"
        if growth - 3 * doubt > CHAOTIC_GROWTH and steps[:, 0].min() < -2 - ODD:
            return TorusDimension("chaotic", None, 0.0, {}, reason)
        n, errors = self.chain.N - 1, np.maximum(steps[:, 1], FLOOR)
        offsets = {s: steps[:, 0] - _expected(s, n, self.vectors) for s in range(1, min(self.vectors, n) + 1)}
        squares = {s: float(np.sum((off / errors) ** 2)) for s, off in offsets.items()}
        best = min(squares, key=lambda s: squares[s])
        scale = max(1.0, squares[best] / len(errors))
        weights = {s: math.exp((squares[best] - square) / (2 * scale)) for s, square in squares.items()}
        weights = {s: w / sum(weights.values()) for s, w in weights.items()}
        error = math.sqrt(sum(w * (s - best) ** 2 for s, w in weights.items()))
        j = int(np.argmax(np.abs(offsets[best])))
        if abs(growth - 1) > ODD:
            return TorusDimension("undecided", None, error, weights, f"{reason}, on a torus as t^1 in the end: take a longer time")
        reason += (
            f"; log GALI_{j + 2} - log GALI_{j + 1}, the farthest from its integer, has the slope {steps[j, 0]:.2f} +- {steps[j, 1]:.2f}, "
            f"on a torus of dimension {best} it is {_expected(best, n, self.vectors)[j]}"
        )
        if abs(offsets[best][j]) > ODD or weights[best] < SURE:
            return TorusDimension("undecided", None, error, weights, f"{reason}: take a longer time")
        more = " or more" if best == self.vectors < n else ""
        return TorusDimension(f"regular, dimension {best}{more}", best, error, weights, reason)

    def _fits(self, values: Floats, decades: float) -> list[tuple[float, float]]:
        """Slopes of columns against log10 t over the last decades, with jackknife errors."""
        x = np.log10(self.times)
        first = min(int(np.searchsorted(x, x[-1] - _span(x, decades) - 1e-9)), max(0, len(x) - FEWEST))
        x, values = x[first:], values[first:]
        part = np.arange(len(x)) * PARTS // len(x)
        whole = np.polyfit(x, values, 1)[0]
        without = np.array([np.polyfit(x[part != i], values[part != i], 1)[0] for i in range(PARTS)])
        errors = np.sqrt((PARTS - 1) / PARTS * np.sum((without - without.mean(axis=0)) ** 2, axis=0))
        return list(zip(whole.tolist(), errors.tolist(), strict=True))


def _span(log_time: Floats, decades: float) -> float:
    if not decades > 0:
        raise InputError("decades", decades, "a positive number", "take one or two")
    return min(decades, float(log_time[-1] - log_time[0]))


def _expected(s: int, n: int, vectors: int) -> Ints:
    """Slopes of log GALI_j - log GALI_(j-1), j = 2 .. vectors, on a torus of dimension s in a phase space of dimension 2n."""
    j = np.arange(2, vectors + 1)
    return -np.add(j > s, j > 2 * n - s, dtype=np.int64)


def alignment_indices(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    T: float,
    *,
    vectors: int | None = None,
    step: float = STEP,
    samples: int = SAMPLES,
    seed: int = 0,
    block: int = BLOCK,
    file: str | PathLike[str] | None = None,
    every: float = 10.0,
    progress: Progress | None = None,
) -> AlignmentIndices:
    """GALI_2 .. GALI_vectors and the maximal Lyapunov exponent of an orbit (sections 3.2 and 4).

    chain : the model; Q, P, T and step are dimensionless.
    Q, P : the state, mode coordinates and momenta, (N-1,).
    T : the last time.
    vectors : 2 to 2(N-1), default VECTORS or as many as there are, orthonormal at random at t = 0.
    step : of the integrator, Blanes-Moan 6 on T + V. Its orbit lies on tori of the integrator, off those of
        the chain by a part step^6: near a torus of low dimension it shows this dimension up to some time
        only, a longer one with a shorter step; the energy error is in the result.
    samples : times, even in log t from 1 to T; each is a whole number of steps.
    seed : of numpy's default generator, for the vectors.
    block : the most steps between two orthonormalisations, halved where the frame is squeezed.
    file : written every so many seconds and at the end, whole or not at all; with the same arguments a killed
        run goes on from it and ends in the same bits; another T has other samples and is another run.
    every : those seconds.
    progress : called as (label, fraction done).

    Raises InputError, also for a file of other parameters; BundleError for one that is no checkpoint;
    OrbitLost.

    Where vectors have aligned, doubles keep nothing of the volume between them: evolved as they are, vectors
    give GALI down to about 1e-16 for a direction, and an upper bound after that. So a frame is evolved
    instead: M_i B_(i-1) = B_i R_i, a QR factorisation after each block, and the vectors are V = B R with R =
    R_i ... R_1. R is upper triangular, so the first k columns of V span the volume R_11 ... R_kk, and with
    unit columns
        log GALI_k = sum_{j<=k} (log R_jj - log |R e_j|),    log |v_1| = log R_11.
    The diagonal of the product is the product of the diagonals: sums of logarithms, which neither underflow
    nor cancel. The columns R e_j are propagated as unit vectors with their lengths in logarithms; a column
    loses entries below 1e-300 of its length, which do not count for its length. Each block's R_jj is right to
    EPS times the squeeze of the frame in one block, kept above 1e-5.

    >>> from symfpu import Chain
    >>> found = alignment_indices(Chain(N=4, alpha=1), [0.1, 0, 0], [0, 0, 0], 1e3, vectors=2)
    >>> bool(found.lyapunov[-1] < 1e-3)
    True
    """
    require_chain(chain)
    n, h = chain.N - 1, abs(step_length(step))
    count, last = _vectors(n, vectors), _steps(T, h)
    longest = integer(block, "block", 1)
    marks = _marks(last, h, _samples(samples))
    frame = moving_frame(chain, Q, P, *_random_frame(count, n, integer(seed, "seed", 0)), h)
    if not np.any(frame.x) and not np.any(frame.p):
        raise InputError("Q, P", 0.0, "a state other than the equilibrium", "start from an orbit")
    before = float(chain.energy(*frame.orbit()))
    run = FrameRun(frame, marks, h, longest, seconds_between(every))
    if file is not None:
        run.keep_in(checkpoint_path(file))
    run.go(progress or (lambda label, done: None))
    times, volumes = np.asarray(marks * h, dtype=np.float64), np.cumsum(run.volumes, axis=1)[:, 1:] / math.log(10)
    error = abs(float(chain.energy(*frame.orbit())) - before) / abs(before)
    return AlignmentIndices(chain, times, volumes, run.growth / times, h, error)


def seconds_needed(chain: Chain, T: float, *, vectors: int | None = None, step: float = STEP) -> float:
    """Processor time in seconds that `alignment_indices` of such a chain will take.

    chain : the model. T : the last time, step : of the integrator, both dimensionless.
    vectors : 2 to 2(N-1), default as there.

    From a trial of a fraction of a second, a small oscillation: an orbit so chaotic that it squeezes the
    frame within BLOCK steps takes longer. Ours.
    Raises InputError.

    >>> from symfpu import Chain
    >>> 0 < seconds_needed(Chain(N=4, alpha=1), 1e4, vectors=2) < 60
    True
    """
    require_chain(chain)
    n, h = chain.N - 1, abs(step_length(step))
    count, last = _vectors(n, vectors), _steps(T, h)
    small = np.where(np.arange(n) == 0, 1e-3, 0.0)
    return last * seconds_a_step(moving_frame(chain, small, small, *_random_frame(count, n, 0), h), BLOCK)


def _samples(samples: int) -> int:
    count = integer(samples, "samples", FEWEST_SAMPLES)
    if count > MOST_SAMPLES:
        raise InputError("samples", count, f"{FEWEST_SAMPLES} to {MOST_SAMPLES}", "a few hundred show all there is")
    return count


def _vectors(n: int, vectors: int | None) -> int:
    count = min(VECTORS, 2 * n) if vectors is None else integer(vectors, "vectors", 2)
    if count > min(2 * n, MOST_VECTORS):
        raise InputError("vectors", count, f"2 to {min(2 * n, MOST_VECTORS)}", "the phase space holds no more")
    return count


def _steps(T: float, h: float) -> int:
    """Steps to T, the last one perhaps beyond it."""
    if isinstance(T, bool) or not isinstance(T, Real) or not SHORTEST * max(1.0, h) <= float(T) < math.inf:
        raise InputError("T", T, f"a finite time from {SHORTEST * max(1.0, h):g} up", "slopes need two decades of time")
    if not float(T) / h <= MOST_STEPS:
        raise InputError("T", T, f"at most 2^52 steps, {h * MOST_STEPS:.3g}", "take a shorter time, or a longer step")
    return math.ceil(float(T) / h - 1e-9)


def _random_frame(vectors: int, n: int, seed: int) -> tuple[Floats, Floats]:
    """Orthonormal vectors of a phase space of dimension 2n as rows."""
    rows = np.linalg.qr(np.random.default_rng(seed).normal(size=(2 * n, vectors)))[0].T
    return rows[:, :n], rows[:, n:]


def _marks(last: int, h: float, samples: int) -> Ints:
    """Numbers of steps at which there are samples."""
    found: Ints = np.unique(np.geomspace(max(1.0, 1 / h), last, samples).round().astype(np.int64))
    return found
