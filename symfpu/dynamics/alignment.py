"""Alignment indices GALI_k of an orbit, all k at once and in logarithms.

With them its maximal Lyapunov exponent and the dimension of its torus: the paper's G_r of
sections 3.2 and 4.

GALI_k is the k-volume of k unit deviation vectors (Skokos, Bountis, Antonopoulos, Physica D 231
(2007) 30; Eur. Phys. J. Special Topics 165 (2008) 5). On a torus of dimension s in a phase space
of dimension 2n, n = N - 1, it goes as
    t^0 for k <= s,    t^-(k-s) for s < k <= 2n - s,    t^-2(k-n) for k > 2n - s,
on a chaotic orbit as exp(-t sum_{j<=k} (chi_1 - chi_j)). Logarithms are to base 10, as in the
captions of the paper.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from numbers import Real
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain, require_any_chain
from symfpu.dynamics.blanes_moan6 import BLANES_MOAN6
from symfpu.dynamics.dimension import (
    DECADES,
    LEAST_SAMPLES,
    Evidence,
    TorusDimension,
    fits,
    torus_dimension,
)
from symfpu.dynamics.frame_run import FrameRun, seconds_a_step
from symfpu.dynamics.scheme import Scheme
from symfpu.dynamics.schemes import particle_scheme
from symfpu.dynamics.several_frames import together
from symfpu.dynamics.tangent import MovingFrame, moving_frame, step_length
from symfpu.dynamics.wells import require_within_walls
from symfpu.errors import InputError
from symfpu.files.checkpoint import checkpoint_path, digest, seconds_between
from symfpu.files.locking import one_run
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.arithmetic import Numbers
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, random_seed
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, chain_fields
from symfpu.results.grid import Grid, Variable
from symfpu.results.numbers import fifteen_digits
from symfpu.results.result import Gridded

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STEP, SAMPLES, VECTORS, BLOCK = 0.4, 400, 7, 40
FRAMES, MOST_FRAMES = 4, 1000
SCHEME = BLANES_MOAN6.name
MOST_VECTORS, MOST_SAMPLES, MOST_STEPS = 64, 1_000_000, 2**52
LOST_ENERGY = 1e-3  # relative: an orbit that has lost so much is not one of the chain
FEWEST_SAMPLES = 2 * LEAST_SAMPLES  # in all: rounding to steps unites some of the first
SHORTEST_RUN = 100  # time, and steps


@dataclass(frozen=True)
class Slope:
    """d log GALI_k / d log t with its uncertainty."""

    k: int
    value: float
    error: float

    def __repr__(self) -> str:
        return f"GALI_{self.k}: {self.value:.2f} +- {self.error:.2f}"


@public
@dataclass(frozen=True, eq=False)
class AlignmentIndices(Gridded):
    """log10 GALI_k and Lyapunov exponent of an orbit in time (section 3.2, Fig. 1(e)).

    Made by `alignment_indices`; times are dimensionless, in units of the chain.

    chain : the model. times : (S,), spaced evenly in log t.
    log10_gali : (S, vectors-1), for k = 2 .. vectors. lyapunov : (S,), log |v_1| / t of the first
        vector.
    step : of the integrator. energy_error : |H(T) - H(0)| / H(0) of the orbit. scheme : its
        coefficients.
    others : indices of further frames along the same orbit, each for itself; the arrays above are
        those of the first frame.

    Its methods look at the last decades of time, in all frames.

    >>> from symfpu import Chain, alignment_indices
    >>> found = alignment_indices(Chain(N=4, alpha=1), [0.1, 0, 0], [0, 0, 0], 1e3, vectors=2)
    >>> found.times.shape, found.log10_gali.shape, found.lyapunov.shape
    ((274,), (274, 1), (274,))
    >>> found
    AlignmentIndices(N=4, alpha=1, t = 1e+03, ... energy error ...)
    >>> found.to_xarray().log10_gali.dims
    ('time', 'k')
    """

    chain: Chain
    times: Floats
    log10_gali: Floats
    lyapunov: Floats
    step: float
    energy_error: float
    scheme: Scheme = BLANES_MOAN6
    others: tuple[AlignmentIndices, ...] = ()

    @property
    def verdict(self) -> str:
        """That of `dimension()`: 'regular, dimension s', 'chaotic' or 'undecided'."""
        return self.dimension().verdict

    def _fields(self) -> Iterator[Field]:
        """`dimension` is None where nothing is decided, and in chaos."""
        dimension = self.dimension()
        yield from chain_fields(self.chain)
        end = f"{self.times[-1]:.10g}"
        yield Field("time", fifteen_digits(float(self.times[-1])), "to t", end)
        yield Field("scheme", self.scheme.name)
        yield Field("step", fifteen_digits(self.step))
        slopes = {}
        for slope in self.slopes():
            value, error = fifteen_digits(slope.value), fifteen_digits(slope.error)
            slopes[str(slope.k)] = {"value": value, "error": error}
            shown = f"{slope.value:z.2f} \u00b1 {slope.error:.2f}"
            yield Field("", label=f"slope of G_{slope.k}", shown=shown)
        yield Field("slopes", slopes)
        last = enumerate(self.log10_gali[-1].tolist(), start=2)
        yield Field("log10_gali", {str(k): fifteen_digits(index) for k, index in last})
        decided = dimension.value is not None
        yield Field("dimension", dimension.value)
        yield Field("dimension_error", fifteen_digits(dimension.error) if decided else None)
        yield Field("supported_dimension", dimension.supported)
        yield Field("dimension_by_frame", list(dimension.frames))
        yield Field("verdict", dimension.verdict)
        yield Field("reason", dimension.reason)
        exponent = float(self.lyapunov[-1])
        shown = f"{exponent:.2g}"
        yield Field("lyapunov", fifteen_digits(exponent), "Lyapunov exponent", shown)
        shown = f"{self.energy_error:.1g}"
        yield Field(
            "energy_error", fifteen_digits(self.energy_error), "energy error", shown
        )

    def __repr__(self) -> str:
        model = self.chain.label
        dimension = self.dimension()
        verdict = dimension.verdict
        if verdict == "undecided" and dimension.supported is not None:
            verdict += f", best supported dimension {dimension.supported}"
        if self.others:
            verdict += f" by {counted(len(self.frames), 'frame')}"
        values = ", ".join(f"{s.value:.2f}" for s in self.slopes())
        slopes = f"slopes of GALI_2..{self.vectors} {values}"
        exponent = f"Lyapunov exponent {self.lyapunov[-1]:.2g}"
        error = f"energy error {self.energy_error:.1g}"
        answer = f"t = {self.times[-1]:.3g}, {verdict}: {slopes}, {exponent}, {error}"
        return f"AlignmentIndices({model}, {answer})"

    @property
    def vectors(self) -> int:
        """The number of deviation vectors."""
        return int(self.log10_gali.shape[1]) + 1

    @property
    def frames(self) -> tuple[AlignmentIndices, ...]:
        """Each frame of deviation vectors for itself."""
        return (replace(self, others=()), *self.others)

    def slopes(self, decades: float = DECADES) -> tuple[Slope, ...]:
        """d log GALI_k / d log t over the last decades of time for k = 2 .. vectors.

        The uncertainty is that of the delete-a-block jackknife over PARTS stretches of the
        window: it sees waves longer than the samples are apart, and bends. Of several frames the
        mean, with the standard error of it if that is larger. decades : of time, cut to what the
        samples span and widened to LEAST_SAMPLES of them. Raises InputError.
        """
        frames, last = self.frames, float(decades)
        every = [fits(one.times, one.log10_gali, last) for one in frames]
        fitted = np.array(every)  # (frames, vectors - 1, 2)
        values = fitted[:, :, 0].mean(axis=0)
        errors = np.sqrt((fitted[:, :, 1] ** 2).mean(axis=0) / len(frames))
        if len(frames) > 1:
            among = fitted[:, :, 0].std(axis=0, ddof=1) / math.sqrt(len(frames))
            errors = np.maximum(errors, among)
        pairs = zip(values.tolist(), errors.tolist(), strict=True)
        return tuple(Slope(k, *pair) for k, pair in enumerate(pairs, start=2))

    def dimension(self, decades: float = DECADES) -> TorusDimension:
        """The dimension s of the torus by how each further vector changes the slope.

        The answer may also be chaos, or neither yet (sections 3.2, 4).

        Chaotic is an orbit whose first vector has outgrown t^POWER by more than OUTGROWN
        e-foldings: that is never taken back. Otherwise log GALI_j - log GALI_(j-1) has the slope
        0 for j <= s, -1 for s < j <= 2n-s, -2 above, and each s the weight exp(-chi^2/2) of these
        differences, whose uncertainties are at least FLOOR and are enlarged where no s fits.
        Regular asks for the weight SURE, slopes within ODD of their integers in the window and in
        its second half, and a first vector that grows as t, in every decade of the last LOW ones
        for a torus of low dimension (an index falls, 2 s <= n) or with N = 2, of the last FULL
        ones for others: see symfpu.dynamics.dimension. Undecided is everything else, and an orbit
        that has lost LOST_ENERGY of its energy; the reason says what it would take, and
        `supported` what the indices that have settled say. Several frames: chaotic if one is,
        regular if half of them are and none with another dimension; `frames` has the dimension
        of each. Raises InputError.
        """
        if not self.energy_error <= LOST_ENERGY:
            lost = f"the orbit is off by {self.energy_error:.1g} of its energy"
            reason = f"{lost}: take a shorter step than {self.step:g}"
            return TorusDimension("undecided", None, math.nan, {}, reason)
        return together([one._dimension(float(decades)) for one in self.frames])

    def _dimension(self, decades: float) -> TorusDimension:
        """By the first frame alone."""
        growth = self.lyapunov * self.times
        return torus_dimension(
            Evidence(self.times, growth, self.log10_gali, self.chain.N - 1, decades)
        )

    def _grid(self) -> Grid:
        slopes = self.slopes()
        found = "slope of log GALI_k with log t over the last decades"
        return Grid(
            axes={"time": self.times, "k": range(2, self.vectors + 1)},
            variables={
                "log10_gali": Variable(("time", "k"), self.log10_gali, "log10 of GALI_k"),
                "lyapunov": Variable(("time",), self.lyapunov, "log |v_1| / t"),
                "slope": Variable(("k",), [slope.value for slope in slopes], found),
                "slope_error": Variable(
                    ("k",), [slope.error for slope in slopes], "of the slope"
                ),
            },
            attributes=attributes(
                self,
                self.chain,
                scheme=self.scheme.name,
                step=self.step,
                energy_error=self.energy_error,
                verdict=self.dimension().verdict,
                frames=len(self.frames),
            ),
            rows=("time", "k"),
        )


@public
def alignment_indices(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    T: float,
    *,
    vectors: int | None = None,
    step: float = STEP,
    scheme: str = SCHEME,
    samples: int = SAMPLES,
    seed: int = 0,
    frames: int = FRAMES,
    block: int = BLOCK,
    file: str | PathLike[str] | None = None,
    every: float = 10.0,
    progress: Progress | None = None,
) -> AlignmentIndices:
    """GALI_2 .. GALI_vectors and the maximal Lyapunov exponent of an orbit (sections 3.2 and 4).

    chain : the model, with either ends; Q, P, T and step are dimensionless.
    Q, P : the state, mode coordinates and momenta, (N-1,); on a ring complex, Q_(-q) = conj Q_q.
        Deviations do not move the ring as a whole either: n = N - 1 degrees of freedom.
    T : the last time.
    vectors : 2 to 2(N-1), default VECTORS or as many as there are, orthonormal at random at t = 0.
    step : of the integrator. Its orbit lies on tori of the integrator, off those of the chain by
        a part step^6, or step^order of another scheme: near a torus of low dimension it shows
        this dimension up to some time only, a longer one with a shorter step; the energy error is
        in the result.
    scheme : of the integrator, on T + V: those of symfpu.dynamics.schemes but for aba864_modes.
    samples : times, even in log t from 1 to T; each is a whole number of steps.
    seed : of numpy's default generator, for the vectors of the first frame; the next frames have
        the next seeds.
    frames : of deviation vectors, one after the other along the same orbit. How soon indices
        settle depends on the frame; `dimension()` gives the spread. Each costs as much as one.
    block : the most steps between two orthonormalisations, halved where the frame is squeezed.
    file : written every so many seconds, at the end, and when the interrupt key is pressed, whole
        or not at all; with the same arguments an interrupted or killed run goes on from it and
        ends in the same bits. Further frames have files of their own beside it: gali.zip,
        gali-2.zip, ... . With a larger T it goes on too: the samples there are stay, later
        ones are chosen for the new T, so that bits are not those of a run to this T from the
        start.
    every : those seconds.
    progress : called as (label, fraction done).

    Raises InputError, also for a file of other parameters or of a longer run; BundleError for one
    that is no checkpoint; OrbitLost; RunInterrupted, a KeyboardInterrupt, where there is a file.

    Where vectors have aligned, doubles keep nothing of the volume between them: evolved as they
    are, vectors give GALI down to about 1e-16 for a direction, and an upper bound after that. So
    a frame is evolved instead: M_i B_(i-1) = B_i R_i, a QR factorisation after each block, and
    the vectors are V = B R with R = R_i ... R_1. R is upper triangular, so the first k columns of
    V span the volume R_11 ... R_kk, and with unit columns
        log GALI_k = sum_{j<=k} (log R_jj - log |R e_j|),    log |v_1| = log R_11.
    The diagonal of the product is the product of the diagonals: sums of logarithms, which neither
    underflow nor cancel. The columns R e_j are propagated as unit vectors with their lengths in
    logarithms; a column loses entries below 1e-300 of its length, which do not count for its
    length. Each block's R_jj is right to EPS times the squeeze of the frame in one block, kept
    above 1e-5.

    >>> from symfpu import Chain
    >>> found = alignment_indices(Chain(N=4, alpha=1), [0.1, 0, 0], [0, 0, 0], 1e3, vectors=2)
    >>> bool(found.lyapunov[-1] < 1e-3)
    True
    """
    n = require_any_chain(chain).N - 1
    h, integrator = abs(step_length(step)), particle_scheme(scheme)
    count, last = frame_size(n, vectors), _steps(T, h)
    longest = integer(block, "block", 1)
    marks = _marks(last, h, sample_count(samples))
    drawn, many = random_seed(seed), frame_count(frames)
    require_within_walls(chain, np.asarray(Q, dtype=chain.kind_of_ends.mode_type))
    path = None if file is None else checkpoint_path(file)
    kind: Any = chain.kind_of_ends.mode_type
    state = digest(np.concatenate([np.ravel(np.asarray(part, kind)) for part in (Q, P)]))
    files = [] if path is None else [_path_of(path, number) for number in range(many)]
    runs = []
    for number in range(many):
        vectors_drawn = _first_frame(chain, count, drawn + number)
        frame = moving_frame(chain, Q, P, *vectors_drawn, h, scheme=integrator)
        runs.append(FrameRun(frame, marks, h, longest, seconds_between(every)))
        before = _energy_of(frame)
    found = []
    with one_run(*files):
        for number, kept in enumerate(files):
            runs[number].keep_in(kept, {"start": state, "seed": drawn + number})
        for number, run in enumerate(runs):
            run.go(_part(progress or unheard, number, many))
            found.append(_indices(run, before))
    return replace(found[0], others=tuple(found[1:]))


def _energy_of(frame: MovingFrame) -> float:
    if not np.any(frame.x) and not np.any(frame.p):
        raise InputError(
            "Q, P", 0.0, "a state other than the equilibrium", "start from an orbit"
        )
    return float(frame.chain.energy(*frame.orbit()))


def _indices(run: FrameRun, before: float) -> AlignmentIndices:
    """Of one frame at the end of its run. before : the energy at its beginning."""
    error = abs(_energy_of(run.frame) - before) / abs(before)
    times = np.asarray(run.marks * run.step, dtype=np.float64)
    logarithms = np.cumsum(run.volumes, axis=1)
    return AlignmentIndices(
        chain=run.frame.chain,
        times=times,
        log10_gali=logarithms[:, 1:] / math.log(10),
        lyapunov=run.growth / times,
        step=run.step,
        energy_error=error,
        scheme=run.frame.scheme,
    )


def _path_of(path: Path, i: int) -> Path:
    """The file of a frame, the first being 0."""
    return path if i == 0 else path.with_stem(f"{path.stem}-{i + 1}")


def _part(progress: Progress, i: int, many: int) -> Progress:
    """Progress of one of many frames."""
    if many == 1:
        return progress
    name = f"frame {i + 1} of {many}"
    return lambda label, fraction: progress(f"{name}, {label}", (i + fraction) / many)


@public
def seconds_needed(
    chain: Chain,
    T: float,
    *,
    vectors: int | None = None,
    step: float = STEP,
    scheme: str = SCHEME,
    frames: int = FRAMES,
) -> float:
    """Processor time in seconds that `alignment_indices` of such a chain will take.

    chain : the model. T : the last time, step : of the integrator, both dimensionless.
    vectors : 2 to 2(N-1), default as there. scheme, frames : as there.

    From a trial of a fraction of a second, a small oscillation: an orbit so chaotic that it
    squeezes the frame within BLOCK steps takes longer. Ours.
    Raises InputError.

    >>> from symfpu import Chain
    >>> 0 < seconds_needed(Chain(N=4, alpha=1), 1e4, vectors=2) < 60
    True
    """
    n = require_any_chain(chain).N - 1
    h, integrator = abs(step_length(step)), particle_scheme(scheme)
    count, last = frame_size(n, vectors), _steps(T, h)
    slowest = np.abs(chain.mode_numbers) == 1
    small = np.where(slowest, 1e-3, 0.0)
    vectors_drawn = _first_frame(chain, count, 0)
    frame = moving_frame(chain, small, small, *vectors_drawn, h, scheme=integrator)
    return frame_count(frames) * last * seconds_a_step(frame, BLOCK)


def sample_count(samples: int) -> int:
    count = integer(samples, "samples", FEWEST_SAMPLES)
    if count > MOST_SAMPLES:
        allowed = f"{FEWEST_SAMPLES} to {MOST_SAMPLES}"
        raise InputError("samples", count, allowed, "a few hundred show all there is")
    return count


def frame_count(frames: int) -> int:
    """The number of frames, checked."""
    count = integer(frames, "frames", 1)
    if count > MOST_FRAMES:
        raise InputError("frames", count, f"1 to {MOST_FRAMES}", "a few show the spread")
    return count


def frame_size(n: int, vectors: int | None) -> int:
    count = min(VECTORS, 2 * n) if vectors is None else integer(vectors, "vectors", 2)
    most = min(2 * n, MOST_VECTORS)
    if count > most:
        raise InputError("vectors", count, f"2 to {most}", "the phase space holds no more")
    return count


def last_time(T: object, h: float = 1.0) -> float:
    """A time that slopes can be seen in, with steps h."""
    shortest = SHORTEST_RUN * max(1.0, h)
    is_number = isinstance(T, Real) and not isinstance(T, bool)
    if not is_number or not shortest <= float(T) < math.inf:  # type: ignore[arg-type]
        allowed = f"a finite time from {shortest:g} up"
        raise InputError("T", T, allowed, "slopes need two decades of time")
    return float(T)  # type: ignore[arg-type]


def _steps(T: float, h: float) -> int:
    """Steps to T, the last one perhaps beyond it."""
    steps = last_time(T, h) / h
    if not steps <= MOST_STEPS:
        allowed = f"at most 2^52 steps, {h * MOST_STEPS:.3g}"
        raise InputError("T", T, allowed, "take a shorter time, or a longer step")
    return math.ceil(steps - 1e-9)


def _first_frame(chain: Chain, vectors: int, seed: int) -> tuple[Numbers, Numbers]:
    """Orthonormal vectors in modes, (vectors, N-1) each."""
    x, p = drawn_frame(chain, vectors, seed)
    return (chain.modes(x), chain.modes(p)) if chain.periodic else (x, p)


def drawn_frame(chain: Chain, vectors: int, seed: int) -> tuple[Floats, Floats]:
    """Orthonormal vectors as rows: modes of fixed ends, (vectors, N-1); particles of a ring, N."""
    if chain.periodic:
        return _random_ring_frame(vectors, chain.N, seed)
    return random_frame(vectors, chain.N - 1, seed)


def random_frame(vectors: int, n: int, seed: int) -> tuple[Floats, Floats]:
    """Orthonormal vectors of a phase space of dimension 2n as rows."""
    random = np.random.default_rng(seed)
    columns = random.normal(size=(2 * n, vectors))
    rows = np.linalg.qr(columns)[0].T
    return rows[:, :n], rows[:, n:]


def _random_ring_frame(vectors: int, N: int, seed: int) -> tuple[Floats, Floats]:
    """The same of the N particles of a ring that does not move as a whole."""
    x, p = np.random.default_rng(seed).normal(size=(2, N, vectors))
    columns = np.vstack([x - x.mean(axis=0), p - p.mean(axis=0)])
    rows = np.linalg.qr(columns)[0].T
    return rows[:, :N], rows[:, N:]


def _marks(last: int, h: float, samples: int) -> Ints:
    """Numbers of steps at which there are samples."""
    even_in_log = np.geomspace(max(1.0, 1 / h), last, samples)
    found: Ints = np.unique(even_in_log.round().astype(np.int64))
    return found
