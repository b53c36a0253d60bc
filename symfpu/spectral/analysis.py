"""Frequency analysis of an orbit: its lines, and the independent frequencies among them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain, require_fixed_ends
from symfpu.dynamics.orbits import Orbit
from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.frames.attributes import attributes
from symfpu.frames.table import Column, Table, joined
from symfpu.frames.tabled import Tabled
from symfpu.notebook import Shown
from symfpu.numbers.counted import counted
from symfpu.numbers.typed import integer, part
from symfpu.spectral.channels import SPAN, Channel, ChannelBank
from symfpu.spectral.combinations import Basis
from symfpu.spectral.record import LINE_WIDTH, Exponential, Record
from symfpu.spectral.samples import Samples

Floats = NDArray[np.float64]
Numbers = NDArray[Any]

SHORT = 2**13  # samples that are analysed as they are
WHOLE = 2**25  # numbers, of all modes, that may be
FIRST = 2**13  # samples in which the channels of a longer orbit are looked for
VALUES = 2048  # of a channel, at most
LEAST_VALUES = 16  # of a channel
MIRROR = 12  # turns over a channel's window between a line and its mirror image, at least
ROUNDING = 16 * float(np.finfo(float).eps)  # of a mode's coordinate along an orbit
EPS = float(np.finfo(float).eps)
HALF = 0.5  # of a frequency: named so far from where it was seen, a line is an image
PARTS = ((0.0, 0.75), (0.25, 1.0))  # of the record, whose difference is the error


@dataclass(frozen=True)
class SpectralLine:
    """A cos(f t + phi) in the coordinate of one mode. Made by `frequency_analysis`; ours.

    mode : q. frequency : f >= 0, dimensionless. amplitude : A > 0, dimensionless.
    phase : phi at time 0, in radians. error : of the frequency, what two windows of three
        quarters of the time differ by, and rounding.
    harmonic : nu with f = nu.omega, as the independent frequencies stand; None where no
        combination is beyond accident. Such a line may be the image, below pi a sample, of one
        above it.

    >>> from symfpu import Chain, frequency_analysis, integrate
    >>> orbit = integrate(Chain(N=2, beta=1), [0.2], [0.0], 200, step=0.1)
    >>> frequency_analysis(orbit).lines[1]
    SpectralLine(mode 1: 4.305733926... +- ..., amplitude 0.00024272..., nu=(3))
    """

    mode: int
    frequency: float
    amplitude: float
    phase: float
    error: float
    harmonic: tuple[int, ...] | None = None

    def __repr__(self) -> str:
        name = "?" if self.harmonic is None else f"({joined(self.harmonic)})"
        rate = f"{self.frequency:.15g} +- {self.error:.1g}"
        size = f"amplitude {self.amplitude:.6g}"
        return f"SpectralLine(mode {self.mode}: {rate}, {size}, nu={name})"


@dataclass(frozen=True, eq=False)
class FrequencyAnalysis(Shown, Tabled):
    """The lines of an orbit. Made by `frequency_analysis` (Laskar's method); dimensionless, ours.

    chain : the model. T : the length of the orbit.
    seeds : the modes that name the independent frequencies: those of their strongest lines.
    frequencies, errors : the independent frequencies, and what two windows differ by; (s,).
    actions : half the sum of nu_i (nu.omega) A^2 over the identified lines; (s,).
    strengths : f A of the strongest line of each, as part of the largest; (s,), falling.
    lines : of all modes, the strongest of each first.
    window_frequencies : of the strongest line of each mode in equal windows; (W, N-1), nan where
        a mode has no line.

    >>> from symfpu import Chain, frequency_analysis, integrate, refine, torus_at_amplitudes
    >>> torus = refine(torus_at_amplitudes(Chain(N=4, alpha="0.3"), {1: "0.4"}, order=4))
    >>> orbit = integrate(torus.chain, *torus.state(), 1000, step=0.1)
    >>> found = frequency_analysis(orbit)
    >>> found
    FrequencyAnalysis(N=4, alpha=0.3, T=1000, 1 independent frequency: omega_1=... +- ...; ...)
    >>> bool(abs(found.frequencies[0] - float(torus.frequency)) < 1e-12)
    True
    """

    chain: Chain
    T: float
    seeds: tuple[int, ...]
    frequencies: Floats
    errors: Floats
    actions: Floats
    strengths: Floats
    lines: tuple[SpectralLine, ...] = field(repr=False)
    window_frequencies: Floats = field(repr=False)

    def __repr__(self) -> str:
        by_seed = zip(self.seeds, self.frequencies, self.errors, strict=True)
        shown = ", ".join(f"omega_{q}={w:.15g} +- {e:.1g}" for q, w, e in by_seed)
        unknown = sum(line.harmonic is None for line in self.lines)
        lines = f"{counted(len(self.lines), 'line')}, {unknown} of them unidentified"
        chain = repr(self.chain)[6:-1]
        independent = counted(
            len(self.seeds), "independent frequency", "independent frequencies"
        )
        found = f"{independent}: {shown}; {lines}, drift {self.drift:.2g}"
        return f"FrequencyAnalysis({chain}, T={self.T:.10g}, {found})"

    @property
    def omega(self) -> dict[int, float]:
        """The independent frequencies by the modes that name them, as everywhere by seed."""
        return dict(zip(self.seeds, self.frequencies.tolist(), strict=True))

    def count(self, level: float) -> int:
        """How many independent frequencies are stronger than this part of the strongest.

        level : between 0 and 1, dimensionless. Raises InputError for any other.
        """
        return int((self.strengths > part(level, "level")).sum())

    @property
    def drift(self) -> float:
        """Largest relative change of the frequency of a mode between windows."""
        known = self.window_frequencies[:, ~np.isnan(self.window_frequencies).any(axis=0)]
        if not known.size:
            return 0.0
        middle = np.abs(known).mean(axis=0)
        moving = middle > 0
        spread = np.ptp(known, axis=0)[moving]
        return float((spread / middle[moving]).max(initial=0.0))

    def _table(self) -> Table:
        lines = self.lines
        names = [None if x.harmonic is None else joined(x.harmonic) for x in lines]
        columns: dict[str, Column] = {
            "mode": [line.mode for line in lines],
            "frequency": [line.frequency for line in lines],
            "error": [line.error for line in lines],
            "amplitude": [line.amplitude for line in lines],
            "phase": [line.phase for line in lines],
            "harmonic": names,
        }
        return Table(columns, attributes(self, self.chain, T=self.T, seeds=self.seeds))


def frequency_analysis(
    orbit: Orbit,
    *,
    lines: int = 4,
    level: float = 1e-6,
    windows: int = 8,
    progress: Progress | None = None,
) -> FrequencyAnalysis:
    """Fundamental frequencies and leading lines of an orbit, by windowed Fourier analysis.

    orbit : one orbit, forward in time; it is integrated anew from its first sample with its own
        scheme and step and looked at every half unit of time, so that its samples may be few.
        None of it is kept: memory does not grow with T.
    lines : at most, of each mode. level : of a mode's strongest line, below which none is taken;
        dimensionless, as all numbers here. A mode whose strongest line is below 4e-15 of the
        largest coordinate is at rest: rounding has lines, too.
    windows : equal parts of the time, for the drift.
    progress : called as (label, fraction).

    Laskar's method with the window (1 + cos)^3; lines of one mode are found one after the other
    and then all anew until none moves. Long orbits go through narrow channels around the lines of
    their beginning. Lines nearer to each other than 4 turns over the time are not told apart.
    A line is a combination of stronger ones if one meets it within the errors and fewer than a
    hundredth would by accident; else it is an independent frequency, where combinations to order
    3 at least could have been told. Ours; the paper has alignment indices for it.
    Raises InputError, also for an orbit that is shorter than 5.3 turns of its slowest mode: of the
    lowest that has a thousandth of the energy at the first sample.

    >>> from symfpu import Chain, integrate
    >>> found = frequency_analysis(integrate(Chain(N=2, beta=1), [0.2], [0.0], 200, step=0.1))
    >>> found.seeds, [line.harmonic for line in found.lines]
    ((1,), [(1,), (3,), (5,)])
    """
    _require_one_orbit(orbit)
    most = integer(lines, "lines", 1)
    parts = integer(windows, "windows", 1)
    if not 0 < level < 1:
        raise InputError("level", level, "a number between 0 and 1", "take 1e-6")
    samples = Samples(orbit)
    bands = list(_bands(samples, most, level, progress or unheard))
    found: list[SpectralLine] = []
    drifts = np.full((parts, orbit.chain.N - 1), np.nan)
    for mode, own in _moving(bands, most, level).items():
        found += _kept([line for line, _ in own[:most]], level, samples.T)
        drifts[:, mode] = own[0][1].in_windows(parts, own[0][0].frequency)
    rate = 2 * math.pi / samples.interval
    return _identified(orbit.chain, samples.T, rate, found, drifts)


def _moving(
    bands: list[_Band], most: int, level: float
) -> dict[int, list[tuple[SpectralLine, _Band]]]:
    """Lines by mode, strongest first; not those that rounding leaves of a mode at rest."""
    by_mode: dict[int, list[tuple[SpectralLine, _Band]]] = {}
    for band in bands:
        by_mode.setdefault(band.mode, []).extend(band.lines(most, level))
    for own in by_mode.values():
        own.sort(key=lambda pair: -pair[0].amplitude)
    largest = max((own[0][0].amplitude for own in by_mode.values() if own), default=0.0)
    return {
        mode: own
        for mode, own in sorted(by_mode.items())
        if own and own[0][0].amplitude > ROUNDING * largest
    }


def _kept(lines: list[SpectralLine], level: float, T: float) -> list[SpectralLine]:
    """Those of one mode above the level; rounding of the strongest is an error of the weak."""
    if not lines:
        return []
    strongest = lines[0].amplitude
    kept = [line for line in lines if line.amplitude > level * strongest]
    noise = ROUNDING * strongest / T
    return [replace(line, error=_whole_error(line, noise)) for line in kept]


def _whole_error(line: SpectralLine, noise: float) -> float:
    """With the rounding of the orbit, and of the frequency itself."""
    return line.error + noise / line.amplitude + EPS * line.frequency


def _require_one_orbit(orbit: Orbit) -> None:
    if not isinstance(orbit, Orbit):
        raise InputError("orbit", orbit, "an Orbit", "make one with integrate")
    require_fixed_ends(orbit.chain)
    if orbit.Q.ndim != 2:
        given = f"{math.prod(orbit.Q.shape[1:-1])} orbits"
        raise InputError("orbit", given, "one orbit", "integrate them one by one")
    if not orbit.times[-1] > 0:
        raise InputError(
            "orbit", f"T = {orbit.times[-1]:.6g}", "T > 0", "integrate forward"
        )


class _Band:
    """A record of one mode and the frequencies around a centre."""

    def __init__(
        self,
        mode: int,
        record: Record,
        centre: float,
        first: float,
        bank: ChannelBank | None,
    ) -> None:
        self.mode, self.record, self.centre, self.bank = mode, record, centre, bank
        self.middle = first + record.interval * (record.n - 1) / 2
        self.rivals: list[float] = []  # centres of the other channels of the mode

    def _limits(self) -> tuple[float, float]:
        if self.bank is None:
            return 0.0, math.pi / self.record.interval
        lowest = 0.0 if self.record.real else -self.bank.band
        return lowest, self.bank.band

    def lines(self, most: int, level: float) -> Iterator[tuple[SpectralLine, _Band]]:
        """Those nearer to this centre than to another."""
        found = self.record.settle(self.record.lines(most, level, self._limits()))
        errors = self._errors(found)
        for line, error in zip(found, errors, strict=True):
            frequency = self.centre + line.frequency
            if self._is_own(frequency) and abs(line.coefficient) > 0:
                yield self._line(line, error), self

    def _is_own(self, frequency: float) -> bool:
        own = abs(frequency - self.centre)
        return all(own <= abs(frequency - other) for other in self.rivals)

    def _line(self, line: Exponential, error: float) -> SpectralLine:
        frequency = self.centre + line.frequency
        value = line.coefficient * np.exp(-1j * line.frequency * self.middle)
        if self.bank is not None:
            value /= self.bank.response(line.frequency)
        if frequency < 0:
            frequency, value = -frequency, np.conj(value)
        twice = 1 if frequency == 0 else 2
        amplitude, phase = float(twice * abs(value)), float(np.angle(value))
        return SpectralLine(self.mode + 1, frequency, amplitude, phase, error)

    def _errors(self, lines: list[Exponential]) -> list[float]:
        """The difference of two windows of three quarters of the record."""
        n = self.record.n
        both = []
        for first, last in PARTS:
            part = self.record.part(int(first * n), int(last * n))
            both.append(part.settle(self._seen_from(part, int(first * n), lines)))
        return [abs(a.frequency - b.frequency) for a, b in zip(*both, strict=True)]

    def _seen_from(
        self, part: Record, first: int, lines: list[Exponential]
    ) -> list[Exponential]:
        """The same lines, with their coefficients at the middle of a part."""
        middle = first + (part.n - 1) / 2 - (self.record.n - 1) / 2
        shift = middle * self.record.interval
        return [
            Exponential(x.frequency, x.coefficient * np.exp(1j * x.frequency * shift))
            for x in lines
        ]

    def in_windows(self, windows: int, frequency: float) -> Floats:
        """The frequency of the line next to this one in equal windows; (W,)."""
        edges = np.linspace(0, self.record.n, windows + 1).astype(int)
        found = np.full(windows, np.nan)
        for i in range(windows):
            part = self.record.part(int(edges[i]), int(edges[i + 1]))
            if part.n >= 2 * LINE_WIDTH:
                line = part.climb(part.y, frequency - self.centre)
                found[i] = self.centre + line.frequency
        return found


def _bands(
    samples: Samples, most: int, level: float, progress: Progress
) -> Iterator[_Band]:
    blocks = samples.blocks(progress)
    if _is_short(samples):
        whole = np.concatenate(list(blocks))
        for mode in range(whole.shape[1]):
            yield _Band(mode, Record(whole[:, mode], samples.interval), 0.0, 0.0, None)
        return
    bank = _bank(samples, most, level, blocks)
    for block in blocks:
        bank.feed(block)
    values = bank.records()
    spacing = bank.hop * samples.interval
    for place, channel in enumerate(bank.channels):
        y = values[:, place]
        record = Record(y.real if channel.frequency == 0 else y, spacing)
        band = _Band(channel.mode, record, channel.frequency, bank.first_time, bank)
        others = [bank.channels[i] for i in bank.by_mode[channel.mode] if i != place]
        band.rivals = [other.frequency for other in others]
        yield band


def _is_short(samples: Samples) -> bool:
    """Whether it is analysed as it is: channels of slow chains want many samples for a value.

    InputError for one that is neither short nor has enough of them.
    """
    least = (SPAN + LEAST_VALUES) * _hop(samples)
    if samples.count <= SHORT:
        return True
    if samples.count >= least:
        return False
    if samples.count * (samples.orbit.chain.N - 1) <= WHOLE:
        return True
    given, allowed = f"T = {samples.T:.6g}", f"at least {least * samples.interval:.6g}"
    advice = "integrate a longer one: the channels of a chain so slow want more samples"
    raise InputError("orbit", given, allowed, advice)


def _bank(
    samples: Samples, most: int, level: float, blocks: Iterator[Numbers]
) -> ChannelBank:
    """Channels around the lines of the beginning, which they have been fed with."""
    beginning = [next(blocks)]
    while sum(map(len, beginning)) < FIRST:
        beginning.append(next(blocks))
    start = np.concatenate(beginning)
    hop = _hop(samples)
    width = 2 * math.pi / (hop * samples.interval)
    channels: list[Channel] = []
    for mode in range(start.shape[1]):
        record = Record(start[:, mode], samples.interval)
        band = (0.0, math.pi / samples.interval)
        lines = record.lines(most, level, band)
        centres: list[float] = []
        for line in lines:
            near = [abs(line.frequency - centre) < width / 4 for centre in centres]
            if not any(near):
                centres.append(line.frequency)
        channels += [Channel(mode, centre) for centre in centres]
    bank = ChannelBank(channels, hop, samples.interval)
    bank.feed(start)
    return bank


def _hop(samples: Samples) -> int:
    """Samples a hop: few values, and windows long enough to lose the mirror image of a line."""
    lowest = float(np.min(samples.orbit.chain.frequencies()))
    mirror = 2 * math.pi * MIRROR / (2 * lowest * SPAN * samples.interval)
    return max(math.ceil(samples.count / VALUES), math.ceil(mirror))


def _identified(
    chain: Chain, T: float, rate: float, lines: list[SpectralLine], drifts: Floats
) -> FrequencyAnalysis:
    """Names every line by the independent frequencies, the strongest first."""
    basis = Basis(rate)
    seeds: list[int] = []
    strengths: list[float] = []
    names: dict[int, tuple[int, ...]] = {}
    order = sorted(
        range(len(lines)), key=lambda i: -lines[i].frequency * lines[i].amplitude
    )
    for i in order:
        line = lines[i]
        nu = basis.combination(line.frequency, line.error)
        free = line.frequency > 0 and len(seeds) < chain.N - 1
        if nu is None and free and basis.can_tell(line.error):
            strengths.append(line.frequency * line.amplitude)
            basis.add(line.frequency, line.error, strengths[-1] / strengths[0])
            seeds.append(_name(line.mode, seeds, chain.N))
            nu = (*(0 for _ in seeds[1:]), 1)
        if nu is not None:
            names[i] = nu
    omega = np.array(basis.frequencies)
    named = [_named(line, names.get(i), omega) for i, line in enumerate(lines)]
    return FrequencyAnalysis(
        chain,
        T,
        tuple(seeds),
        omega,
        np.array(basis.errors),
        _actions(named, omega),
        np.array(strengths) / max(strengths, default=1.0),
        tuple(named),
        drifts,
    )


def _name(mode: int, taken: list[int], N: int) -> int:
    """The mode, or where it has named a frequency already the next free one."""
    free = [q for q in range(1, N) if q not in taken]
    return min(free or [mode], key=lambda q: (abs(q - mode), q))


def _named(line: SpectralLine, nu: tuple[int, ...] | None, omega: Floats) -> SpectralLine:
    """With its name, and at its own frequency if samples saw it k rates away."""
    if line.frequency == 0:
        return replace(line, harmonic=(0,) * len(omega))
    if nu is None:
        return line
    whole = (*nu, *(0 for _ in range(len(omega) - len(nu))))
    frequency = float(np.dot(whole, omega))
    moved = abs(frequency - line.frequency) > HALF * line.frequency
    phase = line.phase
    if frequency < 0:
        frequency, phase = -frequency, -phase
        whole = tuple(-n for n in whole)
    if not moved:
        frequency = line.frequency
    return replace(line, frequency=frequency, phase=phase, harmonic=whole)


def _actions(lines: list[SpectralLine], omega: Floats) -> Floats:
    total = np.zeros(len(omega))
    for line in lines:
        if line.harmonic is not None:
            nu = np.array(line.harmonic, dtype=float)
            total += 0.5 * nu * (nu @ omega) * line.amplitude**2
    return total
