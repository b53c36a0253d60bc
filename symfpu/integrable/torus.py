"""Tori of the Toda chain on which only the gaps of the seeds are open, with their exact energy.

The heights of the seeds' gaps (`symfpu.integrable.discriminant`) are s free numbers, which
`symfpu.integrable.search` finds; all other gaps are closed by construction. The energy needs no
integral. With the critical points c_j of the discriminant, sum c_j = 0, and its bottom edge

    H = (n/(n-2) sum c_j^2 - n/2) / (2 a^2)    (ring of n),
    H = -N (1 + bottom) / (4 a^2)              (fixed ends),

by the coefficient of lambda^(n-2), which holds the trace of the squared matrix of Flaschka.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.integrable.coupling import gap_numbers, toda_coupling
from symfpu.integrable.curve import SpectralCurve
from symfpu.integrable.discriminant import Edges
from symfpu.integrable.inverse import ring_state
from symfpu.integrable.search import Found, Search, guard_digits
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers, with_digits
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, decimal, exact, integer
from symfpu.results.attributes import attributes
from symfpu.results.result import Tabled
from symfpu.results.table import Columns, Table

MOST_DIGITS = 10000
SMALLEST_RING = 3  # particles: of two the mean stretch of both bonds is one number


@public
@dataclass(frozen=True)
class TodaTorus(Tabled):
    """A torus of the Toda chain on which only the gaps of the seeds are open; see `toda_torus`.

    N, a, ends, seeds, digits : as asked, a exact. energy : H of the torus. frequencies, actions,
    gaps, heights : by seed; a gap is an interval of the spectrum of Flaschka's matrix, 2 cosh of
    its height the extremum of the discriminant there.
    normal_frequencies : of small oscillations about the torus, by every other mode: Floquet
        exponents where there is one seed.
    bands : centres and half widths of all gaps and the outer edges; of lambda on a ring, of
        2 lambda^2 - 1 with fixed ends; arrays (N-1,), the uppermost first.

    All numbers are mpf that print `digits` digits and carry some more. Dimensionless. Ours.

    >>> from symfpu import Chain, toda_torus
    >>> torus = toda_torus(Chain(3, potential="toda:1/2"), (1,), actions=("0.1",), digits=12)
    >>> torus
    TodaTorus(N=3, a=0.5, fixed ends, seeds=1, H = 0.100410622492, omega_1 = ...)
    >>> torus.normal_frequencies
    {2: mpf('1.7322702939')}
    >>> torus.to_frame()[["mode", "seed", "action"]]
       mode   seed action
    0     1   True    0.1
    1     2  False    0.0
    """

    N: int
    a: Fraction
    ends: str
    seeds: tuple[int, ...]
    digits: int
    energy: Any
    frequencies: Mapping[int, Any]
    actions: Mapping[int, Any]
    gaps: Mapping[int, Any]
    heights: Mapping[int, Any]
    normal_frequencies: Mapping[int, Any]
    bands: Edges

    def __repr__(self) -> str:
        seeds = ",".join(map(str, self.seeds))
        omega = ", ".join(f"omega_{q} = {self.frequencies[q]}" for q in self.seeds)
        return (
            f"TodaTorus(N={self.N}, a={decimal(self.a)}, {self.ends} ends, seeds={seeds}, "
            f"H = {self.energy}, {omega})"
        )

    @property
    def omega(self) -> dict[int, Any]:
        """The frequencies by seed, by the name that they have in every result."""
        return dict(self.frequencies)

    def particles(self, phases: Mapping[int, int] | None = None) -> tuple[Numbers, Numbers]:
        """Displacements x and momenta p of one state on the torus, as mpf.

        phases : by seed 0 or 1, in half turns; 0 where not named. Phase 0 is that of
            cos(omega_q t): Q_q is largest; on a ring x_j ~ sin(2 pi q j / N).

        Returns two arrays: fixed ends (N-1,), all momenta zero; ring (N,), where x is odd and p
        even about particle 0. Raises InputError for other phases.
        """
        half_turns = self._half_turns(phases or {})
        with mpmath.workdps(self._working_digits()):
            bonds, diagonal = ring_state(self._spectrum(half_turns))
            a = MULTIPRECISION.number(self.a)
            stretches = np.array([mpmath.log(2 * b) / a for b in bonds], dtype=object)
            if self.ends == "fixed":
                x, p = stretches.cumsum()[: self.N - 1], diagonal[1 : self.N] * 0
            else:
                x, p = np.append(a * 0, stretches.cumsum()[:-1]), diagonal / a
        return with_digits((x, p), self.digits)

    def state(self, phases: Mapping[int, int] | None = None) -> tuple[Numbers, Numbers]:
        """Mode coordinates Q and momenta P of a state on the torus with fixed ends, shapes (N-1,).

        phases : as in `particles`. Q_q = sqrt(2/N) sum_j x_j sin(q j pi / N); P is zero. Raises
        InputError for a ring.
        """
        if self.ends != "fixed":
            raise InputError("ends", self.ends, "'fixed'", "take particles() of a ring")
        x, p = self.particles(phases)
        with mpmath.workdps(self._working_digits()):
            j = np.arange(1, self.N)
            sines = [mpmath.sinpi(mpmath.mpf(k) / self.N) for k in range(2 * self.N)]
            table = np.array(sines, dtype=object)[np.outer(j, j) % (2 * self.N)]
            Q = table @ x * mpmath.sqrt(mpmath.mpf(2) / self.N)
        return with_digits((Q, p), self.digits)

    def _working_digits(self) -> int:
        return self.digits + guard_digits(_least_logarithm(self.heights.values()))

    def _half_turns(self, phases: Mapping[int, int]) -> dict[int, int]:
        wrong = set(phases) - set(self.seeds)
        if wrong:
            raise InputError(
                "phases", sorted(wrong), f"seeds {self.seeds}", "name seeds of the torus"
            )
        for q, phase in phases.items():
            if phase not in (0, 1):
                raise InputError(
                    f"phases, mode {q}", phase, "0 or 1 half turns", "take 0 or 1"
                )
        return {q: int(phases.get(q, 0)) for q in self.seeds}

    def _spectrum(self, half_turns: Mapping[int, int]) -> Numbers:
        """Eigenvalues without particle 0, each at an edge of its gap."""
        z = self.bands.centres.copy()
        ring = self.ends == "periodic"
        sign = -1 if (self.a > 0) != ring else 1
        for q, half_turn in half_turns.items():
            k = (-q % self.N if ring else q) - 1
            side = -sign if half_turn else sign
            z[k] += side * self.bands.half_widths[k]
        if ring:
            return z
        upper = MULTIPRECISION.sqrt((z + 1) / 2)
        return np.concatenate([upper, [z[0] * 0], -upper[::-1]])

    def _table(self) -> Table:
        """One row for each mode; gaps of modes that are no seeds are closed."""
        modes = sorted([*self.seeds, *self.normal_frequencies])
        rates = {**self.frequencies, **self.normal_frequencies}
        closed = 0 * self.energy
        columns: Columns = {
            "mode": modes,
            "seed": [q in self.seeds for q in modes],
            "frequency": [rates[q] for q in modes],
            "action": [self.actions.get(q, closed) for q in modes],
            "gap": [self.gaps.get(q, closed) for q in modes],
            "height": [self.heights.get(q, closed) for q in modes],
        }
        known = attributes(
            self,
            N=self.N,
            a=self.a,
            ends=self.ends,
            seeds=self.seeds,
            energy=self.energy,
            digits=self.digits,
        )
        return Table(columns, known)


@public
def toda_torus(
    chain: Chain,
    seeds: Sequence[int],
    *,
    frequencies: Sequence[Number] | None = None,
    actions: Sequence[Number] | None = None,
    a: Number | None = None,
    digits: int = 15,
) -> TodaTorus:
    """The torus of the Toda chain with the gaps of the seeds open and all others closed.

    It is the exact form of the torus that a series in the seeds' amplitudes begins. Its spectral
    curve gives energy, actions, and frequencies of the seeds and of small oscillations about it.

    chain : gives N, ends and, unless given, a = c_3: a Toda chain, or one to compare with Toda's.
        On a ring total momentum and mean stretch are zero.
    seeds : distinct modes; on a ring q is the wave cos(2 pi q j / N - omega_q t).
    frequencies, actions : one of them, numbers in the order of the seeds. For small amplitudes an
        action is the harmonic energy of the mode divided by its frequency.
    a : of V = (e^(2ar) - 1 - 2ar)/(4a^2), not zero. digits : of the results.

    Returns TodaTorus. Dimensionless. Raises InputError for arguments outside their ranges,
    NoTodaTorus where no torus is found, NoDiscriminant or BandsTooNarrow at energies that are too
    large. Source: ours; see `symfpu.integrable.curve`.

    >>> from symfpu import Chain, toda, toda_torus
    >>> chain = Chain(8, potential=toda("1/2"))
    >>> toda_torus(chain, (1,), frequencies=("0.392",), digits=12)
    TodaTorus(N=8, a=0.5, fixed ends, seeds=1, H = 0.0246829996771, omega_1 = 0.392)
    """
    coupling = toda_coupling(chain, a)
    N: int = chain.N
    if chain.periodic and N < SMALLEST_RING:
        allowed = f"at least {SMALLEST_RING} on a ring"
        raise InputError("N", N, allowed, "take more particles")
    places = integer(digits, "digits", 1)
    if places > MOST_DIGITS:
        raise InputError("digits", digits, f"at most {MOST_DIGITS}", "ask for fewer digits")
    listed = chain.seeds_of(seeds)
    given = _given(listed, frequencies, actions)
    gaps = dict(zip(chain.mode_numbers, gap_numbers(chain), strict=True))
    by_gap = sorted(zip((gaps[seed] for seed in listed), given, strict=True))
    search = Search(
        N=N,
        a=coupling,
        fixed=not chain.periodic,
        seeds=tuple(gap for gap, _ in by_gap),
        given=tuple(number for _, number in by_gap),
        by_action=actions is not None,
    )
    return _torus(search, search.run(places), gaps, tuple(sorted(listed)), places)


def _given(
    seeds: tuple[int, ...],
    frequencies: Sequence[Number] | None,
    actions: Sequence[Number] | None,
) -> tuple[Fraction, ...]:
    """The numbers asked for, exact and positive."""
    if (frequencies is None) == (actions is None):
        both = (frequencies, actions)
        allowed = "exactly one of the two"
        raise InputError(
            "frequencies, actions", both, allowed, "give frequencies= or actions="
        )
    name, values = ("frequencies", frequencies) if actions is None else ("actions", actions)
    assert values is not None
    if isinstance(values, str) or len(values) != len(seeds):
        allowed = f"a sequence of {len(seeds)} numbers, one a seed"
        raise InputError(name, values, allowed, "give one number for every seed")
    numbers = tuple(exact(value, name) for value in values)
    for value, number in zip(values, numbers, strict=True):
        if number <= 0:
            raise InputError(name, value, "a positive number", "take a larger one")
    return numbers


def _torus(
    search: Search,
    found: Found,
    places: Mapping[int, int],
    seeds: tuple[int, ...],
    digits: int,
) -> TodaTorus:
    """places : the gap of every mode."""
    with mpmath.workdps(
        digits + guard_digits(_least_logarithm(found.heights[found.heights > 0]))
    ):
        frequencies = found.curve.frequencies()
        actions = found.curve.actions()
        gaps = _widths(found.curve)
        energy = _energy(search, found)
    others = [q for q in places if q not in seeds]

    def of(values: Numbers, modes: Sequence[int]) -> dict[int, Any]:
        return with_digits({q: values[places[q] - 1] for q in modes}, digits)

    return TodaTorus(
        N=search.N,
        a=search.a,
        ends="fixed" if search.fixed else "periodic",
        seeds=seeds,
        digits=digits,
        energy=with_digits(energy, digits),
        frequencies=of(frequencies, seeds),
        actions=of(actions, seeds),
        gaps=of(gaps, seeds),
        heights=of(found.heights, seeds),
        normal_frequencies=of(frequencies, others),
        bands=found.curve.edges,
    )


def _least_logarithm(heights: Iterable[Any]) -> float:
    """Of the squared heights."""
    return 2 * float(mpmath.log(min(heights)))


def _widths(curve: SpectralCurve) -> Numbers:
    """Gaps in lambda, the spectrum of Flaschka's matrix."""
    centres, half = curve.edges.centres, curve.edges.half_widths
    if not curve.fixed:
        return 2 * half
    upper = MULTIPRECISION.sqrt((centres + half + 1) / 2)
    lower = MULTIPRECISION.sqrt((centres - half + 1) / 2)
    return np.asarray(half / (upper + lower))


def _energy(search: Search, found: Found) -> Any:
    a_square = MULTIPRECISION.number(search.a**2)
    n = mpmath.mpf(search.N)
    if search.fixed:
        return -n * (1 + found.bands.bottom) / (4 * a_square)
    squares = (found.points**2).sum()
    return (n / (n - 2) * squares - n / 2) / (2 * a_square)
