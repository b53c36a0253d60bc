"""Orbits of the chain for long times: many at once, sampled at log-spaced times.

Checkpoints let them go on bitwise.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from numbers import Real
from os import PathLike
from pathlib import Path
from typing import Any, TypeGuard

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain, require_any_chain
from symfpu.dynamics.averages import (
    LOOK,
    LOOKS,
    RunningAverages,
    steps_between_looks,
)
from symfpu.dynamics.motion import Motion
from symfpu.dynamics.scheme import Scheme
from symfpu.dynamics.schemes import scheme_of
from symfpu.dynamics.stopping import (
    EscapedOrbit,
    OrbitStopped,
    UnstableStep,
    require_stable,
)
from symfpu.dynamics.wells import (
    leaving_bond,
    nearest_to_wall,
    require_within_walls,
    stretch_bounds,
    wall_of,
)
from symfpu.errors import InputError
from symfpu.files.archive import BundleError
from symfpu.files.checkpoint import (
    ADVICE,
    checkpoint_path,
    digest,
    marks_of,
    read_checkpoint,
    seconds_between,
    write_checkpoint,
)
from symfpu.files.interruption import kept_run
from symfpu.files.locking import one_run
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.arithmetic import DOUBLES, Numbers
from symfpu.numbers.public import public
from symfpu.numbers.room import require_room
from symfpu.numbers.typed import double, integer
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, chain_fields, listed, shown_number
from symfpu.results.grid import Grid, Variable
from symfpu.results.numbers import fifteen_digits
from symfpu.results.result import Gridded

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
# moves of one particle, or products of two modes, between two looks at the clock: a tenth of a
# second, about
BLOCK = 50_000_000
MOST_STEPS = 2**52
STEP_ROUNDING = 1e-9  # of a step: a time that is a multiple of the step but for rounding
SAMPLE_BYTES = 100  # of a sample beside its modes


@public
@dataclass(frozen=True, eq=False)
class Orbit(Gridded):
    """An orbit, or several, at sampled times. Made by `integrate`; dimensionless.

    chain : the model. scheme : of the integrator, its coefficients. step : signed, as taken.
    times : (S,), multiples of the step, from 0. Q, P : mode coordinates and momenta (Eq. lintra),
        shape (S, ..., N-1); of a ring complex, of chain.mode_numbers, as `Chain` has them.
    energies : total energy H (Eq. fpuham2), shape (S, ...).
    averages : time averages of the E_q (Eq. harmonicene) from 0 to each sample, shape
        (S, ..., N-1), if asked for.
    seconds : of this run, without what a checkpoint brought.

    >>> from symfpu import Chain, integrate
    >>> integrate(Chain(N=4, beta=1), [0.1, 0, 0], [0, 0, 0], 100, step=0.125)
    Orbit(N=4, beta=1, T=100, kahan_li8, step 0.125, 129 samples, H=0.00293214917955,
    energy error ...)
    >>> orbit = integrate(Chain(N=4, beta=1), [0.1, 0, 0], [0, 0, 0], 100, step=0.125)
    >>> dict(orbit.to_xarray().sizes), list(orbit.to_frame())
    ({'time': 129, 'mode': 3}, ['time', 'mode', 'Q', 'P', 'harmonic_energy', 'energy'])
    """

    chain: Chain
    scheme: Scheme
    step: float
    times: Floats = field(repr=False)
    Q: Numbers = field(repr=False)
    P: Numbers = field(repr=False)
    energies: Floats = field(repr=False)
    averages: Floats | None = field(repr=False, default=None)
    seconds: float = field(repr=False, default=0.0)

    def _answer(self) -> str:
        return f"energy error {self.energy_error:.2g}"

    def _fields(self) -> Iterator[Field]:
        """Time averages are those at the end; energy is that of the first of several states."""
        yield from chain_fields(self.chain)
        if self.chain.periodic:  # in the order of the spectra
            yield Field("modes", list(self.chain.mode_numbers))
        step = f"{self.scheme.name}, step {abs(self.step):.6g}"
        yield Field("scheme", self.scheme.name, "scheme", step)
        yield Field("step", fifteen_digits(self.step))
        end = f"{self.times[-1]:.10g}, {len(self.times)} samples"
        yield Field("time", fifteen_digits(self.times[-1]), "to t", end)
        yield Field("samples", len(self.times))
        energies = self.energies[0].reshape(-1)
        shown = listed(map(shown_number, energies[:3]))
        yield Field("energy", repr(float(energies[0])), "energy H", shown)
        yield Field("energy_error", fifteen_digits(self.energy_error))
        average = None
        if self.averages is not None and self.averages.ndim == 2:
            average = [fifteen_digits(value) for value in self.averages[-1]]
        yield Field("average_spectrum", average)
        yield Field("seconds", round(self.seconds, 3))

    def __repr__(self) -> str:
        model = self.chain.label
        orbits = math.prod(self.Q.shape[1:-1])
        many = f"{orbits} orbits, " if self.Q.ndim > 2 else ""
        end = f"{many}T={self.times[-1]:.10g}"
        integrator = f"{self.scheme.name}, step {abs(self.step):.6g}"
        first_energy = np.ravel(self.energies)[0]
        samples = f"{len(self.times)} samples, H={first_energy:.12g}"
        error = f"energy error {self.energy_error:.2g}"
        return f"Orbit({model}, {end}, {integrator}, {samples}, {error})"

    @property
    def energy_error(self) -> float:
        """Largest relative deviation |H(t)/H(0) - 1| of all samples and orbits.

        Absolute for orbits at rest.
        """
        return float(np.max(self.energy_errors))

    @property
    def energy_errors(self) -> Floats:
        """The same of each orbit; shape (...)."""
        first = self.energies[0]
        scale = np.where(first == 0, 1.0, np.abs(first))
        deviations = np.abs(self.energies - first) / scale
        return np.asarray(np.max(deviations, axis=0))

    def harmonic_energies(self) -> Floats:
        """E_q of every sample; shape (S, ..., N-1)."""
        return np.asarray(self.chain.harmonic_energies(self.Q, self.P))

    def _grid(self) -> Grid:
        several = self.Q.ndim - 2
        names = ["orbit"] if several == 1 else [f"orbit_{i + 1}" for i in range(several)]
        axes: dict[str, ArrayLike] = {"time": self.times}
        axes |= {name: range(n) for name, n in zip(names, self.Q.shape[1:-1], strict=True)}
        each = (*axes, "mode")
        variables = {
            "Q": Variable(each, self.Q, "coordinate of a mode"),
            "P": Variable(each, self.P, "momentum of a mode"),
            "harmonic_energy": Variable(
                each, self.harmonic_energies(), "harmonic energy E_q"
            ),
            "energy": Variable(each[:-1], self.energies, "total energy H"),
        }
        if self.averages is not None:
            average = "average of the harmonic energy E_q from 0 to this time"
            variables["average_energy"] = Variable(each, self.averages, average)
        return Grid(
            axes=axes | {"mode": self.chain.mode_numbers},
            variables=variables,
            attributes=attributes(
                self,
                self.chain,
                scheme=self.scheme.name,
                step=self.step,
                energy_error=self.energy_error,
            ),
            rows=each,
        )


@public
def integrate(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    T: float,
    *,
    step: float,
    scheme: str = "kahan_li8",
    samples: int | ArrayLike = 200,
    averages: bool = False,
    look: float = LOOK,
    file: str | PathLike[str] | None = None,
    every: float = 10.0,
    workers: int = 1,
    progress: Progress | None = None,
) -> Orbit:
    """The orbit from mode coordinates Q and momenta P at time 0 to time T.

    It is sampled at multiples of the step.

    chain : the model, with either ends; Q, P, T and step are dimensionless.
    Q, P : shapes (..., N-1), many orbits at once: eight go together as one vector of the processor,
        each in the bits that it has alone; those of aba864_modes go one by one. On a ring complex,
        Q_(-q) = conj Q_q, of total momentum 0, which particles keep to rounding.
    T : a time, negative for the past.
    step : its length is cut to a whole number of steps.
    scheme : of symfpu.dynamics.schemes; aba864_modes splits harmonic + anharmonic and is for
        polynomial potentials with fixed ends, others split T + V.
    samples : about how many, log-spaced from one step to T and 0; or times between 0 and T, shape
        (S,), each moved to the nearest step.
    averages : of E_q, by the trapezoid rule over looks; samples are then moved to looks.
    look : the time between two of them, at most, or one step if that is longer. A longer one than
        the default is for long times: one look costs as much as several steps.
    file : written every so many seconds, at the end, and when the interrupt key is pressed, whole
        or not at all; with the same arguments an interrupted or killed run goes on from it and
        ends in the same bits. With a larger T, a multiple of the same step, it goes on too.
        Samples there are stay. A number of samples is laid out for the new T, and those beyond
        the old are taken; times are taken as they are, and where they have the old end among them
        the bits are those of a run to this T from the start.
    every : those seconds.
    workers : threads, among which orbits are shared out; for more than eight orbits.
    progress : called as (label, fraction done).

    Solves Eq. eqmo, in particles or in modes. Section 3.2 averages P^2 + Omega^2 Q^2 without the
    factor 1/2; the averages here are of Eq. harmonicene, with it.
    Raises InputError, also for a file of other parameters or of a longer run, and for times
    before its end that it has not; BundleError for one that is no checkpoint; UnstableStep and
    EscapedOrbit with time, mode, bond and energy; RunInterrupted, a KeyboardInterrupt, where there
    is a file.

    >>> integrate(Chain(N=2, beta=1), [0.0], [1.0], 100, step=0.125, samples=4).times
    array([  0.   ,   0.125,   1.125,  10.75 , 100.   ])
    """
    Q, P, T, step = _start(chain, Q, P, T, step)
    found, workers = scheme_of(chain, scheme), integer(workers, "workers", 1)
    if not isinstance(averages, bool):
        raise InputError("averages", averages, "True or False", "leave it out")
    stride = steps_between_looks(step, _look(look)) if averages else 1
    looks = _whole_steps(T, step * stride)
    marks = stride * _sample_steps(T, looks, samples, np.size(Q))
    run = _Run(chain, found, T, looks * stride, marks, Q, P, workers)
    if averages:
        run.take_averages(stride)
    seconds = seconds_between(every)
    path = None if file is None else checkpoint_path(file)
    with one_run(path), ThreadPoolExecutor(workers) as pool:
        if path is not None:
            run.keep_in(path, seconds, exact=not _is_count(samples))
        run.go(
            map if workers == 1 or run.orbits == 1 else pool.map,
            progress or unheard,
        )
    return run.result()


class _Run:
    """The state of an integration: its coordinates after so many steps, and the samples so far."""

    def __init__(
        self,
        chain: Chain,
        scheme: Scheme,
        T: float,
        steps: int,
        sampled: Ints,
        Q: Numbers,
        P: Numbers,
        workers: int,
    ) -> None:
        self.chain, self.scheme = chain, scheme
        self.T, self.steps, self.step = T, steps, T / steps
        self.shape = Q.shape
        Q, P = Q.reshape(-1, chain.N - 1), P.reshape(-1, chain.N - 1)
        self.orbits, self.done = len(Q), 0
        self.begun = time.perf_counter()
        self.path: Path | None = None
        self.every, self.stride = math.inf, 0
        energies = np.asarray(chain.energy(Q, P))
        for energy in energies:
            require_stable(chain, scheme, self.step, float(energy))
        limits = [stretch_bounds(chain, float(energy)) for energy in energies]
        can_escape = [escapes for _, _, escapes in limits]
        self.escapes = [
            can or energy < 0 for can, energy in zip(can_escape, energies, strict=True)
        ]
        self.start = chain.harmonic_energies(Q, P)
        bounds = np.array([limit[:2] for limit in limits]).reshape(-1, 2)
        self.motion = Motion(chain, scheme, self.step, bounds, workers)
        self._sample_at(sampled)
        self.Q[0], self.P[0] = Q, P
        self.state = self.motion.coordinates(Q, P)
        stretches = np.asarray(chain.stretches(Q))
        below, above = stretches < bounds[:, :1], stretches > bounds[:, 1:]
        outside = (below | above).any(axis=1)
        if outside.any():
            self._stop(int(np.argmax(outside)), 0, escaped=True)

    def _sample_at(self, sampled: Ints) -> None:
        self.sampled = sampled
        shape = (len(sampled), self.orbits, self.chain.N - 1)
        kind = self.chain.kind_of_ends.mode_type
        self.Q: Numbers = np.zeros(shape, kind)
        self.P: Numbers = np.zeros(shape, kind)
        self.averages = np.zeros(shape)

    def take_averages(self, stride: int) -> None:
        """Looks at the orbits every so many steps."""
        self.stride, self.running = (
            stride,
            RunningAverages(self.chain, self.Q[0], self.P[0]),
        )
        self.averages[0] = self.running.start

    def keep_in(self, path: Path, every: float, *, exact: bool) -> None:
        """Goes on from the file, if there is one, which may hold a shorter run.

        exact : as for `marks_of`.
        """
        self.path, self.every = path, every
        chain, scheme = self.chain, self.scheme
        self.parameters = {
            **chain.typed,
            "scheme": scheme.name,
            "step": repr(self.step),
            "steps": self.steps,
            "shape": list(self.shape),
            "steps between looks": self.stride,
            "sampled steps": digest(self.sampled),
            "start": digest(np.stack([self.Q[0], self.P[0]])),
        }
        kept = read_checkpoint(path, self.parameters)
        if kept is None:
            return
        self.done, arrays = kept
        marks = marks_of(path, arrays["sampled"], self.done, self.sampled, exact=exact)
        self._sample_at(marks)
        room = self._kept()
        shapes = {name: values.shape for name, values in arrays.items()}
        due = {name: values.shape for name, values in room.items()}
        if shapes != due or self.done > self.steps:
            reason = "is damaged (its arrays are not those of its parameters)"
            raise BundleError(path, reason, ADVICE)
        for name, values in room.items():
            values[...] = arrays[name]
        if self.stride:
            self.running.looks = self.done // self.stride

    def _known_marks(self) -> Floats:
        """Numbers of steps at which there are samples by now, as a checkpoint holds them."""
        return self.sampled[self.sampled <= self.done].astype(np.float64)

    def _kept(self) -> dict[str, Floats]:
        """What a checkpoint holds, but for its first array as views of it.

        A complex number is two numbers there.
        """
        marks = self._known_marks()
        known = len(marks)
        kept = {
            "sampled": marks,
            "Q": self.Q[:known].view(np.float64),
            "P": self.P[:known].view(np.float64),
            "state": self.state,
        }
        if self.stride:
            kept["averages"] = self.averages[:known]
            kept["total"] = self.running.total
        return kept

    def _ends(self) -> Iterator[int]:
        """Where loops end: at samples, and after blocks of steps.

        Blocks depend on the chain and the scheme alone, so that an interrupted run rounds like
        one that was not.
        """
        size = self.motion.moves_a_kick
        block = max(1, BLOCK // (size * self.scheme.stages))
        if self.stride:
            block = self.stride * min(LOOKS, max(1, block // self.stride))
        while self.done < self.steps:
            place = np.searchsorted(self.sampled, self.done, side="right")
            blocks = self.done // block + 1
            yield min(int(self.sampled[place]), blocks * block)

    def go(self, each: Callable[..., Any], progress: Progress) -> None:
        """To the last step. Raises OrbitStopped.

        RunInterrupted where the run is kept in a file.
        """
        with kept_run(self.path, self.every, self._write) as look:
            for end in self._ends():
                self._move_to(end, each)
                place = f"at t = {self.step * end:.6g} of {self.T:.6g}"
                look(place, end == self.steps, partial(progress, "orbit", end / self.steps))

    def _move_to(self, end: int, each: Callable[..., Any]) -> None:
        before = self.state.copy()
        steps = end - self.done
        done = np.array(self._moved(steps, each))
        finite = np.isfinite(self.state).all(axis=(1, 2))
        well = np.where(finite, done, np.minimum(done, steps - 1))
        if well.min() < steps:
            row = int(well.argmin())
            self._stopped_in_block(before, row, int(well[row]))
        self.done = end
        place = int(np.searchsorted(self.sampled, end))
        if self.sampled[place] == end:
            self.Q[place], self.P[place] = self.motion.modes(self.state)
            if self.stride:
                self.averages[place] = self.running.now()

    def _write(self) -> None:
        assert self.path is not None
        write_checkpoint(self.path, self.parameters, self.done, self._kept())

    def _moved(self, steps: int, each: Callable[..., Any]) -> list[int]:
        """The steps of each orbit at which all was well."""
        if not self.stride:
            return self.motion.advance(self.state, steps, each)
        done, Q, P = self.motion.look(self.state, steps // self.stride, self.stride, each)
        if min(done) == steps:
            self.running.add(Q, P)
        return done

    def _stopped_in_block(self, before: Floats, row: int, well: int) -> None:
        """Goes to the last step at which all was well, where the numbers are finite, and raises."""
        crossed = self.motion.beyond_wall(self.state[row])
        self.state[row] = before[row]
        self.motion.move(self.state[row], self.motion.bounds[row], well)
        steps = self.done + well
        self._stop(row, steps, escaped=self.escapes[row], crossed=crossed)

    def _stop(self, row: int, steps: int, *, escaped: bool, crossed: bool = False) -> None:
        Q, P = (part[0] for part in self.motion.modes(self.state[row : row + 1]))
        r, speeds = (np.asarray(self.chain.stretches(part)) for part in (Q, P))
        bond = leaving_bond(r, speeds, self.motion.bounds[row])
        begun_with = self.start[row] if steps else 0.0
        growth = np.abs(self.chain.harmonic_energies(Q, P) - begun_with)
        place: tuple[int, ...] = ()
        if len(self.shape) > 1:
            place = tuple(int(i) for i in np.unravel_index(row, self.shape[:-1]))
        kind: type[OrbitStopped] = UnstableStep
        reason = f"a step of {abs(self.step):.6g} of {self.scheme.name} loses the energy"
        advice = "take a shorter step"
        if escaped:
            kind = EscapedOrbit
            reason = f"bond {bond} passes the barrier of its potential"
            advice = "start from a state of less energy"
        elif crossed:
            ahead = r + self.step * speeds
            if math.isinf(wall_of(self.chain, ahead[bond])):  # none on that side
                bond = nearest_to_wall(self.chain, ahead)
            wall = f"the wall r = {wall_of(self.chain, ahead[bond]):.12g} of its potential"
            reason = f"a step of {abs(self.step):.6g} takes bond {bond} across {wall}"
        raise kind(
            reason,
            advice,
            time=self.T * (steps / self.steps),
            mode=self.chain.mode_numbers[int(np.argmax(growth))],
            energy=float(self.chain.energy(Q, P)),
            orbit=place,
            bond=bond,
        )

    def result(self) -> Orbit:
        shape = len(self.sampled), *self.shape
        Q = self.Q.reshape(shape)
        P = self.P.reshape(shape)
        energies = np.asarray(self.chain.energy(Q, P))
        times = np.asarray(self.T * (self.sampled / self.steps), dtype=np.float64)
        averages = self.averages.reshape(Q.shape) if self.stride else None
        seconds = time.perf_counter() - self.begun
        return Orbit(
            self.chain, self.scheme, self.step, times, Q, P, energies, averages, seconds
        )


def _start(
    chain: Chain, Q: ArrayLike, P: ArrayLike, T: float, step: float
) -> tuple[Numbers, Numbers, float, float]:
    """The arguments as numbers; raises InputError."""
    kind = require_any_chain(chain).kind_of_ends.mode_type
    chain.positions(Q), chain.positions(P)  # refuses other shapes
    Q, P = np.array(Q, dtype=kind), np.array(P, dtype=kind)
    require_within_walls(chain, Q)
    if Q.shape != P.shape:
        advice = "pass one momentum for each coordinate"
        raise InputError("P", P.shape, f"the shape of Q, {Q.shape}", advice)
    with np.errstate(over="ignore", invalid="ignore"):
        if not Q.size or not np.isfinite(chain.energy(Q, P)).all():
            given = "a state whose energy is not finite" if Q.size else ()
            raise InputError("Q, P", given, "finite numbers", "start from a finite state")
    for name, value in (("T", T), ("step", step)):
        is_number = isinstance(value, Real) and not isinstance(value, bool)
        if not is_number or not math.isfinite(float(value)) or value == 0:
            raise InputError(name, value, "a finite number other than 0", "pass a time")
    if step < 0:
        raise InputError(
            "step", step, "a positive number", "for the past take a negative T"
        )
    return Q, P, float(T), float(step)


def _look(look: float) -> float:
    """The time between two looks; raises InputError."""
    found = double(look, "look")
    if not found > 0:
        raise InputError("look", look, "a positive number", "leave it out")
    return found


def _whole_steps(T: float, step: float) -> int:
    ratio = abs(T) / step
    if not ratio <= MOST_STEPS:
        allowed = f"at most 2^52 steps, {step * MOST_STEPS:.3g}"
        raise InputError("T", T, allowed, "take a shorter time, or a longer step")
    nearest = round(ratio)
    rounding = max(STEP_ROUNDING, 4 * np.finfo(float).eps * ratio)
    whole = nearest if abs(ratio - nearest) <= rounding else math.ceil(ratio)
    return max(1, whole)


def _is_count(samples: object) -> TypeGuard[int]:
    """Whether samples are so many, not times; True and False are refused as numbers."""
    return isinstance(samples, (bool, int, np.integer))


def _sample_steps(T: float, steps: int, samples: object, modes: int) -> Ints:
    """Steps after which samples are taken, 0 and the last among them."""
    allowed = "a whole number, or times between 0 and T"
    if _is_count(samples):
        count = min(integer(samples, "samples", 1), steps)
        require_room("samples", count, lambda count: (SAMPLE_BYTES + 24 * modes) * count)
        inner = np.rint(np.geomspace(1, steps, count)) if count > 1 else np.array([steps])
    else:
        try:
            inner = np.rint(DOUBLES.array(samples) / T * steps)
        except (TypeError, ValueError) as error:
            raise InputError("samples", samples, allowed, "pass one of them") from error
        if inner.ndim != 1 or not ((inner >= 0) & (inner <= steps)).all():
            raise InputError(
                "samples", samples, f"{allowed} = {T:.10g}", "leave out the others"
            )
    marks = np.concatenate([[0], inner, [steps]])
    return np.unique(marks.astype(np.int64))
