"""Gaps, actions and frequencies of Toda's chain for a state of any chain.

A chain that is not Toda's is judged by the Toda chain with the same cubic term: a = c_3. Along its
orbits the gaps drift, and how much they do shows how far the orbit is from an integrable one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.integrable.coupling import gap_numbers, toda_coupling
from symfpu.integrable.curve import SpectralCurve
from symfpu.integrable.discriminant import Edges
from symfpu.integrable.lax import jacobi_entries, odd_edges, ring_edges
from symfpu.numbers.arithmetic import (
    DOUBLES,
    MULTIPRECISION,
    Arithmetic,
    Numbers,
    with_digits,
)
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, decimal, integer
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, shown_number
from symfpu.results.result import Tabled
from symfpu.results.table import Columns, Table

MOST_DIGITS = 10000
LARGEST_EXPONENT = 300.0  # of e^(a r): beyond it the edges of bands are out of range


@dataclass(frozen=True)
class TodaInvariants(Tabled):
    """The gaps of a state, its actions and frequencies in the Toda chain; see `toda_invariants`.

    N, a, digits : as asked, a exact. modes : q in the order of the arrays. gaps, actions,
    frequencies : by mode, shapes (N-1,), doubles or mpf. Dimensionless. Ours.

    >>> from symfpu import Chain, toda_invariants
    >>> found = toda_invariants(Chain(3, alpha="1/2"), [0.1, 0], [0, 0])
    >>> found
    TodaInvariants(N=3, a=0.5, widest gap 0.0408 of mode 1, sum of actions 0.005)
    >>> found.frequencies.round(6)
    array([1.000416, 1.732052])
    >>> found.to_frame().round(4)
       mode     gap  action  frequency
    0     1  0.0408   0.005     1.0004
    1     2  0.0008   0.000     1.7321
    """

    N: int
    a: Fraction
    digits: int | None
    modes: tuple[int, ...]
    gaps: Numbers
    actions: Numbers
    frequencies: Numbers

    def _answer(self) -> str:
        return "gaps and actions"

    def _fields(self) -> Iterator[Field]:
        yield from super()._fields()
        yield Field("", label="chain", shown=f"N={self.N}, a={decimal(self.a)}")
        for label, value in (
            ("widest gap", max(self.gaps)),
            ("sum of actions", sum(self.actions)),
        ):
            yield Field("", label=label, shown=shown_number(value, self.digits))

    def __repr__(self) -> str:
        place = int(np.argmax(self.gaps))
        widest, largest = self.modes[place], float(self.gaps[place])
        total = float(self.actions.sum())
        return (
            f"TodaInvariants(N={self.N}, a={decimal(self.a)}, widest gap {largest:.3g} "
            f"of mode {widest}, sum of actions {total:.3g})"
        )

    def _table(self) -> Table:
        columns: Columns = {
            "mode": self.modes,
            "gap": self.gaps,
            "action": self.actions,
            "frequency": self.frequencies,
        }
        return Table(columns, attributes(self, N=self.N, a=self.a, digits=self.digits))


@public
def toda_gaps(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    *,
    a: Number | None = None,
    digits: int | None = None,
) -> Numbers:
    """All gaps of Toda's spectral curve for states of a chain, one a mode.

    A gap is an interval of lambda between two bands of Flaschka's periodic matrix of the ring of 2N
    particles whose odd states are those of the chain. They are constant along orbits of the Toda
    chain, and all are zero but those of the seeds on a torus of it. Ring gaps q and 2N - q are
    equal, that is gap q here, and gap N is closed always. For small amplitudes the gap is
    sqrt(2/N) |a| Omega_q A_q: the harmonic energy of mode q is N gap^2 / (4 a^2).

    chain : a Chain; Q, P : mode coordinates and momenta, shapes (..., N-1): states, orbits, tori.
        On a ring gaps are those of its own matrix, mode q that of cos(2 pi q j / N - omega_q t).
    a : of V = (e^(2ar) - 1 - 2ar)/(4a^2); default: c_3 of the chain. digits : None for
        doubles, exact to a few times 1e-16 absolutely; else mpf with so many decimal places.

    Returns an array (..., N-1). Dimensionless. Raises InputError for arguments outside their
    ranges and states beyond the range of e^(a r). Source: ours, after Flaschka; see
    `symfpu.integrable.lax`.

    >>> toda_gaps(Chain(4, alpha="1/2"), [0.1, 0, 0], [0, 0, 0.02]).round(5)
    array([0.02706, 0.0009 , 0.00707])
    """
    numbers = _arithmetic(digits)
    coupling = toda_coupling(chain, a)
    _require_doubles_on_a_ring(chain, digits)
    with numbers.context(digits):
        _, upper, lower, _ = _edges(chain, Q, P, coupling, numbers)
        gaps = (upper - lower)[..., _order(chain)]
    return with_digits(gaps, digits)


@public
def toda_invariants(
    chain: Chain,
    Q: ArrayLike,
    P: ArrayLike,
    *,
    a: Number | None = None,
    digits: int | None = None,
) -> TodaInvariants:
    """Gaps, actions and frequencies of one state in the Toda chain, from its spectral curve.

    chain, a, digits : as in `toda_gaps`; Q, P : of one state, shapes (N-1,).

    The action of a mode is, for small amplitudes, its harmonic energy divided by its frequency; the
    frequency is dH/dI, and where a gap is closed that of small oscillations. Dimensionless.

    Returns TodaInvariants. Raises InputError as `toda_gaps` does, and BandsTooNarrow at energies so
    large that a band cannot be told from a point. Source: ours; see `symfpu.integrable.curve`.

    >>> toda_invariants(Chain(4, alpha="1/2"), [0.1, 0, 0], [0, 0, 0.02])
    TodaInvariants(N=4, a=0.5, widest gap 0.0271 of mode 1, sum of actions 0.00393)
    """
    numbers = _arithmetic(digits)
    coupling = toda_coupling(chain, a)
    _require_doubles_on_a_ring(chain, digits)
    with numbers.context(digits):
        top, upper, lower, bottom = _edges(chain, Q, P, coupling, numbers)
        if top.ndim:
            advice = "pass one state; toda_gaps takes many"
            raise InputError("Q", upper.shape, f"shape ({chain.N - 1},)", advice)
        if chain.periodic:
            centres, half_widths = (upper + lower) / 2, (upper - lower) / 2
            bands = Edges(centres, half_widths, top[()], bottom[()])
        else:
            centres, half_widths = (
                upper**2 + lower**2 - 1,
                (upper - lower) * (upper + lower),
            )
            bands = Edges(centres, half_widths, 2 * top[()] ** 2 - 1, bottom)
        curve = SpectralCurve(bands, chain.N, not chain.periodic, coupling, numbers)
        order = _order(chain)
        return TodaInvariants(
            N=chain.N,
            a=coupling,
            digits=digits,
            modes=chain.mode_numbers,
            gaps=with_digits((upper - lower)[order], digits),
            actions=with_digits(curve.actions()[order], digits),
            frequencies=with_digits(curve.frequencies()[order], digits),
        )


def _arithmetic(digits: int | None) -> Arithmetic:
    if digits is None:
        return DOUBLES
    if integer(digits, "digits", 1) > MOST_DIGITS:
        raise InputError("digits", digits, f"at most {MOST_DIGITS}", "ask for fewer digits")
    return MULTIPRECISION


def _edges(
    chain: Chain, Q: ArrayLike, P: ArrayLike, a: Fraction, numbers: Arithmetic
) -> tuple[Numbers, Numbers, Numbers, Any]:
    """Top edge (...), upper and lower edges of the gaps (..., N-1), bottom edge.

    Of lambda; with fixed ends the bottom is that of 2 lambda^2 - 1.
    """
    if chain.periodic:
        stretches, momenta = chain.stretches(Q), chain.positions(P)
        if numbers is DOUBLES:  # a state of many digits is rounded, as with fixed ends
            stretches, momenta = numbers.array(stretches), numbers.array(momenta)
    else:
        stretches = chain.stretches(_read(Q, "Q", numbers))
        momenta = chain.positions(_read(P, "P", numbers))
    if stretches.shape[:-1] != momenta.shape[:-1]:
        shapes = (np.shape(Q), np.shape(P))
        raise InputError(
            "Q, P", shapes, "two arrays of one shape", "pass Q and P of a state"
        )
    exponents = np.abs(stretches * numbers.number(a))
    if not numbers.finite(momenta):
        raise InputError("P", np.shape(P), "finite numbers", "pass the momenta of a state")
    if not (exponents < LARGEST_EXPONENT).all():
        largest: Any = exponents.max()
        allowed = f"|a r| below {LARGEST_EXPONENT} on every bond"
        raise InputError("a r", float(largest), allowed, "take a smaller state or a")
    bonds, diagonal = jacobi_entries(stretches, momenta, a, numbers)
    if chain.periodic:
        return ring_edges(bonds, diagonal, numbers)
    return *odd_edges(bonds, diagonal, numbers), numbers.number(Fraction(-1))


def _order(chain: Chain) -> list[int]:
    """Where the gap of every mode stands."""
    return [k - 1 for k in gap_numbers(chain)]


def _require_doubles_on_a_ring(chain: Chain, digits: int | None) -> None:
    if chain.periodic and digits is not None:
        advice = "leave digits=None: states of a ring are complex doubles"
        raise InputError("digits", digits, "None on a ring", advice)


def _read(values: ArrayLike, argument: str, numbers: Arithmetic) -> Numbers:
    try:
        return numbers.array(values)
    except (TypeError, ValueError) as error:
        allowed = "an array of real numbers"
        raise InputError(argument, values, allowed, "pass numbers") from error
