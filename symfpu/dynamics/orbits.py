"""Orbits of the chain for long times: many at once, sampled at log-spaced times, with checkpoints
from which they go on bitwise.
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

from symfpu.chain.chain import Chain, require_chain
from symfpu.dynamics.aba864 import ABA864, ABA864_MODES
from symfpu.dynamics.averages import LOOKS, RunningAverages, steps_between_looks
from symfpu.dynamics.blanes_moan6 import BLANES_MOAN6
from symfpu.dynamics.kahan_li8 import KAHAN_LI8
from symfpu.dynamics.motion import Motion
from symfpu.dynamics.scheme import Scheme
from symfpu.dynamics.stopping import (
    EscapedOrbit,
    OrbitStopped,
    UnstableStep,
    require_stable,
    stretch_bounds,
)
from symfpu.dynamics.yoshida4 import YOSHIDA4
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
from symfpu.numbers.typed import decimal, integer

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
SCHEMES = {
    scheme.name: scheme for scheme in (YOSHIDA4, ABA864, BLANES_MOAN6, KAHAN_LI8, ABA864_MODES)
}
# moves of one particle, or products of two modes, between two looks at the clock: a tenth of a
# second, about
BLOCK = 50_000_000
MOST_STEPS = 2**52
WHOLE = 1e-9  # of a step: a time that is a multiple of the step but for rounding


@dataclass(frozen=True, eq=False)
class Orbit:
    """An orbit, or several, at sampled times. Made by `integrate`; dimensionless.

    chain : the model. scheme : of the integrator, its coefficients. step : signed, as taken.
    times : (S,), multiples of the step, from 0. Q, P : mode coordinates and momenta (Eq. lintra), shape
        (S, ..., N-1).
    energies : total energy H (Eq. fpuham2), shape (S, ...).
    averages : time averages of the E_q (Eq. harmonicene) from 0 to each sample, shape (S, ..., N-1), if asked
        for.
    seconds : of this run, without what a checkpoint brought.

    >>> from symfpu import Chain, integrate
    >>> integrate(Chain(N=4, beta=1), [0.1, 0, 0], [0, 0, 0], 100, step=0.125)
    Orbit(N=4, beta=1, T=100, kahan_li8, step 0.125, 129 samples, H=0.00293214917955, energy error ...)
    """

    chain: Chain
    scheme: Scheme
    step: float
    times: Floats = field(repr=False)
    Q: Floats = field(repr=False)
    P: Floats = field(repr=False)
    energies: Floats = field(repr=False)
    averages: Floats | None = field(repr=False, default=None)
    seconds: float = field(repr=False, default=0.0)

    def __repr__(self) -> str:
        many = f"{math.prod(self.Q.shape[1:-1])} orbits, " if self.Q.ndim > 2 else ""
        return (
            f"Orbit({repr(self.chain)[6:-1]}, {many}T={self.times[-1]:.10g}, {self.scheme.name}, step {abs(self.step):.6g}, "
            f"{len(self.times)} samples, H={np.ravel(self.energies)[0]:.12g}, energy error {self.energy_error:.2g})"
        )

    @property
    def energy_error(self) -> float:
        """Largest relative deviation |H(t)/H(0) - 1| of all samples and orbits.

        Absolute for orbits at rest.
        """
        start = np.where(self.energies[0] == 0, 1.0, np.abs(self.energies[0]))
        return float(np.max(np.abs(self.energies - self.energies[0]) / start))

    def harmonic_energies(self) -> Floats:
        """E_q of every sample; shape (S, ..., N-1)."""
        return np.asarray(self.chain.harmonic_energies(self.Q, self.P))


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
    file: str | PathLike[str] | None = None,
    every: float = 10.0,
    workers: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Orbit:
    """The orbit from mode coordinates Q and momenta P at time 0 to T, sampled at multiples of the step.

    chain : the model; Q, P, T and step are dimensionless.
    Q, P : shapes (..., N-1), many orbits at once.
    T : a time, negative for the past.
    step : its length is cut to a whole number of steps.
    scheme : of SCHEMES; aba864_modes splits harmonic + anharmonic, others T + V.
    samples : about how many, log-spaced from one step to T and 0; or times between 0 and T, shape (S,), each
        moved to the nearest step.
    averages : of E_q, by the trapezoid rule over looks at every LOOK time units, or every step if longer;
        samples are then moved to looks.
    file : written every so many seconds, at the end, and when the interrupt key is pressed, whole or not at
        all; with the same arguments an interrupted or killed run goes on from it and ends in the same bits.
        With a larger T, a multiple of the same step, it goes on too. Samples there are stay. A number of
        samples is laid out for the new T, and those beyond the old are taken; times are taken as they are,
        and where they have the old end among them the bits are those of a run to this T from the start.
    every : those seconds.
    workers : threads, among which orbits are shared out.
    progress : called as (steps done, steps).

    Solves Eq. eqmo, in particles or in modes. Section 3.2 averages P^2 + Omega^2 Q^2 without the factor 1/2;
    the averages here are of Eq. harmonicene, with it.
    Raises InputError, also for a file of other parameters or of a longer run, and for times before its end
    that it has not; BundleError for one that is no checkpoint; UnstableStep and EscapedOrbit with time, mode
    and energy; RunInterrupted, a KeyboardInterrupt, where there is a file.

    >>> integrate(Chain(N=2, beta=1), [0.0], [1.0], 100, step=0.125, samples=4).times
    array([  0.   ,   0.125,   1.125,  10.75 , 100.   ])
    """
    Q, P, T, step = _start(chain, Q, P, T, step)
    found, workers = _scheme(scheme), integer(workers, "workers", 1)
    if not isinstance(averages, bool):
        raise InputError("averages", averages, "True or False", "leave it out")
    stride = steps_between_looks(step) if averages else 1
    looks = _whole_steps(T, step * stride)
    run = _Run(chain, found, T, looks * stride, stride * _sample_steps(T, looks, samples), Q, P)
    if averages:
        run.take_averages(stride)
    seconds = seconds_between(every)
    if file is not None:
        run.keep_in(checkpoint_path(file), seconds, exact=not _is_count(samples))
    with ThreadPoolExecutor(workers) as pool:
        run.go(
            map if workers == 1 or run.orbits == 1 else pool.map,
            progress or (lambda done, total: None),
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
        Q: Floats,
        P: Floats,
    ) -> None:
        self.chain, self.scheme, self.T, self.steps, self.shape = chain, scheme, T, steps, Q.shape
        self.step = T / steps
        Q, P = Q.reshape(-1, chain.N - 1), P.reshape(-1, chain.N - 1)
        self.orbits, self.done, self.begun = len(Q), 0, time.perf_counter()
        self.path: Path | None = None
        self.every, self.stride = math.inf, 0
        energies = np.asarray(chain.energy(Q, P))
        for energy in energies:
            require_stable(chain, scheme, self.step, float(energy))
        limits = [stretch_bounds(chain, float(energy)) for energy in energies]
        self.escapes = [
            limit[2] or energy < 0 for limit, energy in zip(limits, energies, strict=True)
        ]
        self.start = chain.harmonic_energies(Q, P)
        bounds = np.array([limit[:2] for limit in limits]).reshape(-1, 2)
        self.motion = Motion(chain, scheme, self.step, bounds)
        self._sample_at(sampled)
        self.Q[0], self.P[0] = Q, P
        self.state = self.motion.coordinates(Q, P)
        stretches = np.asarray(chain.stretches(Q))
        outside = ((stretches < bounds[:, :1]) | (stretches > bounds[:, 1:])).any(axis=1)
        if outside.any():
            self._stop(int(np.argmax(outside)), 0, escaped=True)

    def _sample_at(self, sampled: Ints) -> None:
        self.sampled = sampled
        self.Q, self.P, self.averages = (
            np.zeros((len(sampled), self.orbits, self.chain.N - 1)) for _ in range(3)
        )

    def take_averages(self, stride: int) -> None:
        """Looks at the orbits every so many steps."""
        self.stride, self.running = stride, RunningAverages(self.chain, self.Q[0], self.P[0])
        self.averages[0] = self.running.start

    def keep_in(self, path: Path, every: float, *, exact: bool) -> None:
        """Goes on from the file, if there is one, which may hold a shorter run.

        Exact : as for `marks_of`.
        """
        self.path, self.every = path, every
        chain, scheme = self.chain, self.scheme
        self.parameters = {
            "N": chain.N,
            "alpha": decimal(chain.alpha),
            "beta": decimal(chain.beta),
            "scheme": scheme.name,
            "step": repr(self.step),
            "steps": self.steps,
            "shape": list(self.shape),
            "steps between looks": self.stride,
            "sampled steps": digest(self.sampled),
            "start": digest(np.stack([self.Q[0], self.P[0]])),
        }
        kept = read_checkpoint(path, self.parameters)
        if kept is not None:
            self.done, arrays = kept
            self._sample_at(
                marks_of(
                    path, arrays.get("sampled", np.zeros(0)), self.done, self.sampled, exact=exact
                )
            )
            known = int(np.searchsorted(self.sampled, self.done, side="right"))
            due = {name: values.shape for name, values in self._kept(known).items()}
            if {
                name: values.shape for name, values in arrays.items()
            } != due or self.done > self.steps:
                raise BundleError(
                    path, "is damaged (its arrays are not those of its parameters)", ADVICE
                )
            for name, values in self._kept(known).items():
                values[...] = arrays[name]
            if self.stride:
                self.running.looks = self.done // self.stride

    def _kept(self, known: int) -> dict[str, Floats]:
        """What a checkpoint holds after so many samples, as views of it."""
        marks = self.sampled[:known].astype(np.float64)
        kept = {"sampled": marks, "Q": self.Q[:known], "P": self.P[:known], "state": self.state}
        return (
            kept | {"averages": self.averages[:known], "total": self.running.total}
            if self.stride
            else kept
        )

    def _ends(self) -> Iterator[int]:
        """Where loops end: at samples and after blocks of steps that depend on the chain and the
        scheme alone, so that an interrupted run rounds like one that was not.
        """
        size = (
            self.chain.N
            if not self.scheme.in_modes
            else self.chain.N**2 * (2 if self.chain.beta else 1)
        )
        block = max(1, BLOCK // (size * self.scheme.stages))
        if self.stride:
            block = self.stride * min(LOOKS, max(1, block // self.stride))
        while self.done < self.steps:
            following = int(self.sampled[np.searchsorted(self.sampled, self.done, side="right")])
            yield min(following, (self.done // block + 1) * block)

    def go(self, each: Callable[..., Any], progress: Callable[[int, int], None]) -> None:
        """To the last step. Raises OrbitStopped.

        RunInterrupted where the run is kept in a file.
        """
        with kept_run(self.path, self.every, self._write) as look:
            for end in self._ends():
                self._move_to(end, each)
                place = f"at t = {self.step * end:.6g} of {self.T:.6g}"
                look(place, end == self.steps, partial(progress, end, self.steps))

    def _move_to(self, end: int, each: Callable[..., Any]) -> None:
        before = self.state.copy()
        done = self._moved(end - self.done, each)
        inside = np.isfinite(self.state).all(axis=(1, 2)) & (np.array(done) == end - self.done)
        if not inside.all():
            self._stopped_in_block(before, int(np.argmin(np.where(inside, self.steps, done))), done)
        self.done = end
        place = int(np.searchsorted(self.sampled, end))
        if self.sampled[place] == end:
            self.Q[place], self.P[place] = self.motion.modes(self.state)
            if self.stride:
                self.averages[place] = self.running.now()

    def _write(self) -> None:
        assert self.path is not None
        known = int(np.searchsorted(self.sampled, self.done, side="right"))
        write_checkpoint(self.path, self.parameters, self.done, self._kept(known))

    def _moved(self, steps: int, each: Callable[..., Any]) -> list[int]:
        """The steps done by each orbit."""
        if not self.stride:
            return self.motion.advance(self.state, steps, each)
        done, Q, P = self.motion.look(self.state, steps // self.stride, self.stride, each)
        if min(done) == steps:
            self.running.add(Q, P)
        return done

    def _stopped_in_block(self, before: Floats, row: int, done: list[int]) -> None:
        """Goes to the last step at which all was well, where the numbers are finite, and raises."""
        self.state[row] = before[row]
        if done[row] > 1:
            self.motion.move(self.state[row], self.motion.bounds[row], done[row] - 1)
        self._stop(row, self.done + done[row] - 1, escaped=self.escapes[row])

    def _stop(self, row: int, steps: int, *, escaped: bool) -> None:
        Q, P = (part[0] for part in self.motion.modes(self.state[row : row + 1]))
        growth = np.abs(self.chain.harmonic_energies(Q, P) - (self.start[row] if steps else 0.0))
        kind: type[OrbitStopped]
        kind, reason, advice = (
            UnstableStep,
            f"a step of {abs(self.step):.6g} of {self.scheme.name} loses the energy",
            "take a shorter step",
        )
        if escaped:
            kind, reason, advice = (
                EscapedOrbit,
                "a bond passes the barrier of its potential",
                "start from a state of less energy",
            )
        place = (
            tuple(int(i) for i in np.unravel_index(row, self.shape[:-1]))
            if len(self.shape) > 1
            else ()
        )
        energy, mode = float(self.chain.energy(Q, P)), int(np.argmax(growth)) + 1
        raise kind(
            reason,
            advice,
            time=self.T * (steps / self.steps),
            mode=mode,
            energy=energy,
            orbit=place,
        )

    def result(self) -> Orbit:
        Q, P = (part.reshape(len(self.sampled), *self.shape) for part in (self.Q, self.P))
        energies = np.asarray(self.chain.energy(Q, P))
        times = np.asarray(self.T * (self.sampled / self.steps), dtype=np.float64)
        averages = self.averages.reshape(Q.shape) if self.stride else None
        return Orbit(
            self.chain,
            self.scheme,
            self.step,
            times,
            Q,
            P,
            energies,
            averages,
            time.perf_counter() - self.begun,
        )


def _start(
    chain: Chain, Q: ArrayLike, P: ArrayLike, T: float, step: float
) -> tuple[Floats, Floats, float, float]:
    """The arguments as numbers; raises InputError."""
    require_chain(chain)
    chain.positions(Q), chain.positions(P)  # refuses other shapes
    Q, P = np.array(Q, dtype=np.float64), np.array(P, dtype=np.float64)
    if Q.shape != P.shape:
        raise InputError(
            "P", P.shape, f"the shape of Q, {Q.shape}", "pass one momentum for each coordinate"
        )
    with np.errstate(over="ignore", invalid="ignore"):
        if not Q.size or not np.isfinite(chain.energy(Q, P)).all():
            raise InputError(
                "Q, P",
                "a state whose energy is not finite" if Q.size else (),
                "finite numbers",
                "start from a finite state",
            )
    for name, value in (("T", T), ("step", step)):
        if (
            isinstance(value, bool)
            or not isinstance(value, Real)
            or not math.isfinite(float(value))
            or value == 0
        ):
            raise InputError(name, value, "a finite number other than 0", "pass a time")
    if step < 0:
        raise InputError("step", step, "a positive number", "for the past take a negative T")
    return Q, P, float(T), float(step)


def _whole_steps(T: float, step: float) -> int:
    if not abs(T) / step <= MOST_STEPS:
        raise InputError(
            "T",
            T,
            f"at most 2^52 steps, {step * MOST_STEPS:.3g}",
            "take a shorter time, or a longer step",
        )
    ratio = abs(T) / step
    whole = (
        round(ratio)
        if abs(ratio - round(ratio)) <= max(WHOLE, 4 * np.finfo(float).eps * ratio)
        else math.ceil(ratio)
    )
    return max(1, whole)


def _scheme(name: object) -> Scheme:
    if not isinstance(name, str) or name not in SCHEMES:
        raise InputError("scheme", name, ", ".join(SCHEMES), "choose one of them")
    return SCHEMES[name]


def _is_count(samples: object) -> TypeGuard[int]:
    """Whether samples are so many, not times; True and False are refused as numbers."""
    return isinstance(samples, (bool, int, np.integer))


def _sample_steps(T: float, steps: int, samples: object) -> Ints:
    """Steps after which samples are taken, 0 and the last among them."""
    if _is_count(samples):
        count = min(integer(samples, "samples", 1), steps)
        inner = np.rint(np.geomspace(1, steps, count)) if count > 1 else np.array([steps])
    else:
        try:
            inner = np.rint(np.asarray(samples, dtype=np.float64) / T * steps)
        except (TypeError, ValueError) as error:
            raise InputError(
                "samples", samples, "a whole number, or times between 0 and T", "pass one of them"
            ) from error
        if inner.ndim != 1 or not ((inner >= 0) & (inner <= steps)).all():
            raise InputError(
                "samples",
                samples,
                f"a whole number, or times between 0 and T = {T:.10g}",
                "leave out the others",
            )
    return np.unique(np.concatenate([[0], inner, [steps]]).astype(np.int64))
