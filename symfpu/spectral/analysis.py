"""Frequency analysis of an orbit: its lines, and the independent frequencies among them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain, require_fixed_ends
from symfpu.dynamics.orbits import Orbit
from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, part
from symfpu.results.attributes import attributes
from symfpu.results.field import Field
from symfpu.results.result import Tabled
from symfpu.results.table import Column, Table, joined
from symfpu.spectral.channels import SPAN, Channel, ChannelBank
from symfpu.spectral.combinations import Basis
from symfpu.spectral.record import LINE_WIDTH, Exponential, Record, one_constant
from symfpu.spectral.samples import Samples
from symfpu.spectral.scheme_shift import scheme_shifts

Floats = NDArray[np.float64]
Numbers = NDArray[Any]

SHORT = 2**13  # samples that are analysed as they are
WHOLE = 2**25  # numbers, of all modes, that may be
FIRST = 2**13  # samples in which the channels of a longer orbit are looked for
VALUES = 2048  # of a channel, at most
LEAST_VALUES = 16  # of a channel
MIRROR = 12  # turns over a channel's window between a line and its mirror image, at least
ROUNDING = 64 * float(np.finfo(float).eps)  # of a mode's coordinate along an orbit
EPS = float(np.finfo(float).eps)
# of a turn: a line that windows see so far apart has unseen ones within its width; and how far a
# line may be off, in what windows differ by, there and elsewhere
UNCLEAN, OF_UNCLEAN, OF_CLEAN = 0.003, 8.0, 2.0
# of the distance to a stronger line: what is left of that one moves with the window, a third of it
MOVING = 0.05
CONSTANT = 0.25  # of a turn: what windows see of a constant, above which it is a slow line
HALF = 0.5  # of a frequency: named so far from where it was seen, a line is an image
# of the record: what lines of these differ by, and from those of the whole, is their error
UNRESOLVED = 0.5  # turns over the orbit between lines of one mode that are seen as one
PARTS = ((0.0, 0.75), (0.125, 0.875), (0.25, 1.0))


@dataclass(frozen=True)
class SpectralLine:
    """A cos(f t + phi) in the coordinate of one mode. Made by `frequency_analysis`; ours.

    mode : q. frequency : f >= 0, dimensionless. amplitude : A > 0, dimensionless.
    phase : phi at time 0, in radians. error : of the frequency: of the analysis, of the scheme
        of the orbit with its step, and of rounding.
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


@public
@dataclass(frozen=True, eq=False)
class FrequencyAnalysis(Tabled):
    """The lines of an orbit. Made by `frequency_analysis` (Laskar's method); dimensionless, ours.

    chain : the model. T : the length of the orbit.
    seeds : the modes that name the independent frequencies: those of their strongest lines.
    frequencies, errors : the independent frequencies, and theirs as of a line; (s,).
    actions : half the sum of nu_i (nu.omega) A^2 over the identified lines; (s,).
    strengths : f A of the strongest line of each, as part of the largest; (s,), falling.
    lines : of all modes, the strongest of each first.
    window_frequencies : of the strongest line of each mode in equal windows; (W, N-1), nan where
        a mode has no line.
    unresolved : how far from combinations of others independent frequencies are that the orbit is
        too short to tell from them, 0 where there are none. Every line then has such neighbours,
        and its error is this at least; orbits of 2 pi over it, and longer, tell them apart.

    >>> import symfpu
    >>> from symfpu import Chain, frequency_analysis, integrate, refine
    >>> torus = symfpu.torus(Chain(N=4, alpha="0.3"), (1,), amplitudes={1: "0.4"})
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
    unresolved: float = 0.0

    def _answer(self) -> str:
        return counted(len(self.seeds), "independent frequency", "independent frequencies")

    def _fields(self) -> Iterator[Field]:
        yield from super()._fields()
        yield Field("", label="to t", shown=f"{self.T:.10g}")
        for q, omega, error in zip(self.seeds, self.frequencies, self.errors, strict=True):
            name = f"\N{GREEK SMALL LETTER OMEGA}_{q}"
            yield Field("", label=name, shown=f"{omega:.15g} \u00b1 {error:.1g}")
        unknown = sum(line.harmonic is None for line in self.lines)
        lines = f"{len(self.lines)}, {unknown} of them unidentified"
        yield Field("", label="lines", shown=lines)
        yield Field("", label="drift", shown=f"{self.drift:.2g}")

    def __repr__(self) -> str:
        by_seed = zip(self.seeds, self.frequencies, self.errors, strict=True)
        shown = ", ".join(f"omega_{q}={w:.15g} +- {e:.1g}" for q, w, e in by_seed)
        unknown = sum(line.harmonic is None for line in self.lines)
        lines = f"{counted(len(self.lines), 'line')}, {unknown} of them unidentified"
        chain = self.chain.label
        independent = counted(
            len(self.seeds), "independent frequency", "independent frequencies"
        )
        found = f"{independent}: {shown}; {lines}, drift {self.drift:.2g}"
        if self.unresolved:
            found += f"; too short to tell lines {self.unresolved:.2g} apart"
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
        return Table(
            columns,
            attributes(
                self, self.chain, T=self.T, seeds=self.seeds, unresolved=self.unresolved
            ),
        )


@public
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
        dimensionless, as all numbers here. A mode whose strongest line is below 1.5e-14 of the
        largest coordinate is at rest: rounding has lines, too.
    windows : equal parts of the time, for the drift.
    progress : called as (label, fraction).

    Laskar's method with the window (1 + cos)^3; lines of one mode are found one after the other
    and then all anew until none moves. Long orbits go through narrow channels around the lines of
    their beginning. Lines nearer to each other than 4 turns over the time are not told apart.
    A line is a combination of stronger ones if one meets it within four times what windows of the
    orbit differ by and fewer than a
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
    if parts > samples.count:
        allowed = f"up to {samples.count}, the samples of the orbit"
        raise InputError("windows", parts, allowed, "take fewer windows")
    bands = list(_bands(samples, most, level, progress or unheard))
    found: list[_Seen] = []
    drifts = np.full((parts, orbit.chain.N - 1), np.nan)
    for mode, own in _moving(bands, most, level).items():
        found += _kept(own[:most], level, samples.T)
        drifts[:, mode] = own[0].band.in_windows(parts, own[0].line.frequency)
    rate = 2 * math.pi / samples.interval
    named = _identified(orbit.chain, samples.T, rate, found, drifts)
    return _with_scheme(named, samples)


class _Seen(NamedTuple):
    """A line, what windows differ by in it, and where it was found."""

    line: SpectralLine
    spread: float
    band: _Band


def _moving(bands: list[_Band], most: int, level: float) -> dict[int, list[_Seen]]:
    """Lines by mode, strongest first; not those that rounding leaves of a mode at rest."""
    by_mode: dict[int, list[_Seen]] = {}
    for band in bands:
        by_mode.setdefault(band.mode, []).extend(band.lines(most, level))
    for own in by_mode.values():
        own.sort(key=lambda seen: -seen.line.amplitude)
    largest = max((own[0].line.amplitude for own in by_mode.values() if own), default=0.0)
    return {
        mode: own
        for mode, own in sorted(by_mode.items())
        if own and own[0].line.amplitude > ROUNDING * largest
    }


def _kept(lines: list[_Seen], level: float, T: float) -> list[_Seen]:
    """Those of one mode above the level; rounding of the strongest is an error of the weak."""
    if not lines:
        return []
    strongest = lines[0].line.amplitude
    noise = ROUNDING * strongest / float(T)
    return [
        _with_rounding(seen, noise)
        for seen in lines
        if seen.line.amplitude > level * strongest
    ]


def _with_rounding(seen: _Seen, noise: float) -> _Seen:
    """With the rounding of the orbit, and of the frequency itself."""
    line, spread, band = seen
    rounding = noise / line.amplitude + EPS * line.frequency
    return _Seen(replace(line, error=line.error + rounding), spread + rounding, band)


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

    def lines(self, most: int, level: float) -> Iterator[_Seen]:
        """Those nearer to this centre than to another."""
        lines = self.record.lines(most, level, self._limits())
        found = one_constant(self.record.settle(lines))
        spreads = self._spreads(found)
        errors = self._errors(found, spreads)
        for line, spread, error in zip(found, spreads, errors, strict=True):
            frequency = self.centre + line.frequency
            if self._is_own(frequency) and abs(line.coefficient) > 0:
                yield _Seen(self._line(line, error), float(spread), self)

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

    def _spreads(self, lines: list[Exponential]) -> Floats:
        """What windows of three quarters of the record and the whole differ by.

        Of a constant, how slow a line may be it: a line that turns less than once over the record
        looks like one, and its height is another in each window.
        """
        n = self.record.n
        all_parts = [[line.frequency for line in lines]]
        heights = []
        for first, last in PARTS:
            part = self.record.part(int(first * n), int(last * n))
            found = part.settle(self._seen_from(part, int(first * n), lines))
            all_parts.append([line.frequency for line in found])
            heights.append([line.coefficient.real for line in found])
        spreads = np.asarray(np.ptp(np.array(all_parts), axis=0))
        apart = (PARTS[1][0] - PARTS[0][0]) * n * self.record.interval
        for i, line in enumerate(lines):
            if self.record.real and line.frequency == 0:
                slow = _rate(*(height[i] for height in heights)) / apart
                spreads[i] = min(slow, self.record.turn)
        return spreads

    def _errors(self, lines: list[Exponential], spreads: Floats) -> list[float]:
        """How far each may be off; half a turn where it may be a part of a stronger one."""
        turn = self.record.turn
        errors = np.where(spreads > UNCLEAN * turn, OF_UNCLEAN, OF_CLEAN) * spreads
        for i, line in enumerate(lines):
            stronger = [x for x in lines if abs(x.coefficient) > abs(line.coefficient)]
            away = (abs(x.frequency - line.frequency) for x in stronger)
            nearest = min(away, default=math.inf)
            if nearest < LINE_WIDTH * turn and spreads[i] > MOVING * nearest:
                errors[i] = max(errors[i], turn / 2)
            if line.frequency == 0:  # a faster line is none
                errors[i] = min(errors[i], turn)
        return [float(x) for x in errors]

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


def _rate(before: float, middle: float, after: float) -> float:
    """f of A cos(f t + phi) with these values at times -1, 0 and 1, about; f small."""
    if middle == 0:
        return math.inf
    bend = abs(before - 2 * middle + after) / abs(middle)
    return math.sqrt(bend) + abs(after - before) / abs(2 * middle)


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
    chain: Chain, T: float, rate: float, found: list[_Seen], drifts: Floats
) -> FrequencyAnalysis:
    """Names every line by the independent frequencies, the strongest first.

    Sums are told by what windows differ by, not by how far a line may be off.
    """
    basis = Basis(rate)
    lines = [seen.line for seen in found]
    errors: list[float] = []
    seeds: list[int] = []
    strengths: list[float] = []
    names: dict[int, tuple[int, ...]] = {}
    order = sorted(
        range(len(lines)), key=lambda i: -lines[i].frequency * lines[i].amplitude
    )
    for i in order:
        line, spread, _ = found[i]
        if line.frequency == 0:
            if spread <= CONSTANT * 2 * math.pi / T:
                names[i] = ()
            continue
        nu = basis.combination(line.frequency, spread)
        free = len(seeds) < chain.N - 1
        if nu is None and free and basis.is_independent(line.frequency, spread):
            strengths.append(line.frequency * line.amplitude)
            basis.add(line.frequency, spread, strengths[-1] / strengths[0])
            errors.append(line.error)
            seeds.append(_name(line.mode, seeds, chain.N))
            nu = (*(0 for _ in seeds[1:]), 1)
        if nu is not None:
            names[i] = nu
    omega = np.array(basis.frequencies)
    apart = basis.meeting(UNRESOLVED * 2 * math.pi / T)
    named = [
        _named(replace(line, error=max(line.error, apart)), names.get(i), omega)
        for i, line in enumerate(lines)
    ]
    return FrequencyAnalysis(
        chain,
        T,
        tuple(seeds),
        omega,
        np.maximum(errors, apart),
        _actions(named, omega),
        np.array(strengths) / max(strengths, default=1.0),
        tuple(named),
        drifts,
        apart,
    )


def _with_scheme(found: FrequencyAnalysis, samples: Samples) -> FrequencyAnalysis:
    """With what the scheme adds to the errors.

    Combinations are those of the computed orbit, without it. A combination is off by what its
    frequencies are.
    """
    seen: dict[int, list[Exponential]] = {}
    for line in found.lines:
        seen.setdefault(line.mode - 1, []).append(_at_time_zero(line))
    shifts = {
        mode: iter(x) for mode, x in scheme_shifts(samples, seen, found.frequencies).items()
    }
    own = [float(next(shifts[line.mode - 1])) for line in found.lines]
    of_omega = np.zeros(len(found.seeds))
    for line, shift in zip(found.lines, own, strict=True):
        independent = np.flatnonzero(found.frequencies == line.frequency)
        of_omega[independent] = shift
    lines = []
    for line, shift in zip(found.lines, own, strict=True):
        nu = line.harmonic
        more = shift if nu is None else float(np.abs(nu) @ of_omega)
        lines.append(replace(line, error=line.error + more))
    return replace(found, lines=tuple(lines), errors=found.errors + of_omega)


def _at_time_zero(line: SpectralLine) -> Exponential:
    value = line.amplitude * np.exp(1j * line.phase)
    return Exponential(line.frequency, value / 2 if line.frequency else value)


def _name(mode: int, taken: list[int], N: int) -> int:
    """The mode, or where it has named a frequency already the next free one."""
    free = [q for q in range(1, N) if q not in taken]
    return min(free or [mode], key=lambda q: (abs(q - mode), q))


def _named(line: SpectralLine, nu: tuple[int, ...] | None, omega: Floats) -> SpectralLine:
    """With its name, and at its own frequency if samples saw it k rates away."""
    if nu is None:
        return line
    if line.frequency == 0:
        return replace(line, harmonic=(0,) * len(omega))
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
