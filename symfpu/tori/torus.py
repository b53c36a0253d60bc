"""A q-torus with numbers in it: a series at chosen amplitudes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from symfpu.algebra.grading import Ints
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.frames.attributes import attributes
from symfpu.frames.table import Table
from symfpu.frames.tabled import Tabled
from symfpu.numbers.arithmetic import Numbers, text, with_digits
from symfpu.numbers.mpfr import at_the_face, inside
from symfpu.numbers.public import public
from symfpu.numbers.typed import order_of
from symfpu.series.series import LindstedtSeries
from symfpu.tori.columns import columns_of
from symfpu.tori.quasiperiodic import QuasiPeriodic, show


@dataclass(frozen=True)
class RootCertificate(Tabled):
    """Whether the truncated system is proved to have exactly one root near the amplitudes.

    By interval Newton in ball arithmetic; ours: the paper proves no root.

    certified : whether it is.
    radius : by seed, dimensionless; in the box of amplitudes within it there is exactly one root
        of Eq. omeser truncated, wherever in its proved error bounds each coefficient of the
        series lies (A^2 of the root is within 10^-digits, relative).
    reason : if not certified, the inequality that failed.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 4, digits=20)
    >>> solve_amplitudes(series).certificate.certified
    True
    >>> RootCertificate(False, {}, "the box does not shrink")
    RootCertificate(not proved: the box does not shrink)
    >>> solve_amplitudes(series).certificate.to_frame().seed.tolist()
    [1]
    """

    certified: bool
    radius: Mapping[int, Any]  # mpf: doubles end at 1e-308
    reason: str = ""

    def __repr__(self) -> str:
        if not self.certified:
            return f"RootCertificate(not proved: {self.reason})"
        radii = ", ".join(f"A_{q} within {text(r, 2)}" for q, r in self.radius.items())
        return f"RootCertificate(exactly one root, {radii})"

    def _table(self) -> Table:
        known = attributes(self, certified=self.certified, reason=self.reason)
        columns = {"seed": list(self.radius), "radius": list(self.radius.values())}
        return Table(columns, known)


@public
@dataclass(frozen=True, eq=False)
class QTorus(QuasiPeriodic):
    """The torus of a series at chosen amplitudes, cut at `order`.

    Q_q(t) = sum over harmonics of c_q[nu] cos(nu.(omega t + phi)); travelling waves on a ring.

    Made by `solve_amplitudes` and others (Eqs. qser, serabs1); dimensionless, phases in radians.

    series : it was solved from. amplitudes, phases : by seed.
    frequency_order : truncation of the frequency series that gave the amplitudes.
        order : truncation of the coordinates.
    history : K -> amplitudes, (s,), by frequency order. root_residual : largest
        |omega_q - truncated series|.
    certificate : whether the root is proved to exist (series with digits only).
    warnings : reasons to doubt that this is a torus.

    harmonics (H, s) and cosines (H, N-1), on a ring (H, 1), follow from the series; with
    digits all numbers are mpf.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 8))
    QTorus(N=8, alpha=0.3, A_1=0.247740186794, frequency order 8, order 8, H=0.004714606926,
    residual ...)
    >>> torus = solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 8))
    >>> dict(torus.to_xarray().sizes)
    {'harmonic': 10, 'seed': 1, 'mode': 7}
    """

    series: LindstedtSeries = field(repr=False)
    amplitudes: Mapping[int, Any]
    phases: Mapping[int, Any]
    frequency_order: int
    order: int
    history: Mapping[int, tuple[Any, ...]] = field(repr=False, default_factory=dict)
    root_residual: float = 0.0
    certificate: RootCertificate | None = None
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        show(self, "amplitudes", "phases", "history")

    def __repr__(self) -> str:
        places = self.digits or 12
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        amplitudes = ", ".join(
            f"A_{q}={text(a, places)}" for q, a in self.amplitudes.items()
        )
        orders = f"frequency order {self.frequency_order}, order {self.order}"
        quality = f"H={float(self.energy()):.10g}, residual {self.residual():.2g}"
        doubts = "".join(f"; {warning}" for warning in self.warnings)
        return f"QTorus({chain}, {amplitudes}, {orders}, {quality}{self._proof()}{doubts})"

    def _proof(self) -> str:
        """What is known of the root, for print."""
        if self.certificate is None:
            return ""
        return ", certified" if self.certificate.certified else ", not certified"

    @property
    def chain(self) -> Chain:
        """The chain."""
        return self.series.chain

    @property
    def travels(self) -> bool:  # type: ignore[override]
        """Series of a ring are of travelling waves."""
        return self.chain.periodic

    @property
    def seeds(self) -> tuple[int, ...]:
        """The seed modes."""
        return self.series.seeds

    @property
    def frequencies(self) -> tuple[Fraction, ...]:
        """The chosen frequency of every seed."""
        assert self.series.frequencies is not None
        return self.series.frequencies

    @property
    def digits(self) -> int | None:
        """Digits of all results; None for doubles."""
        return self.series.digits

    def doubted(self, warnings: tuple[str, ...]) -> QTorus:
        """The same torus with warnings; what was computed of it is kept."""
        doubts = tuple(warnings)
        return self._with_known(replace(self, warnings=doubts), "_terms", "_residual")

    def cut_at(self, order: int) -> QTorus:
        """The same torus up to a lower order of its coordinates; its terms are kept."""
        lower = order_of(order)
        if lower > self.order:
            advice = "make the torus with a higher order"
            raise InputError("order", lower, f"an integer in 0..{self.order}", advice)
        return self._with_known(replace(self, order=lower))

    def _with_known(self, torus: QTorus, *names: str) -> QTorus:
        for name in ("terms_by_order", *names):
            if name in self.__dict__:
                torus.__dict__[name] = self.__dict__[name]
        return torus

    @cached_property
    def terms_by_order(self) -> tuple[tuple[Ints, Numbers], ...]:
        """Harmonics (H, s) and terms of their coefficients (H, C) of every order from 0 on.

        At least up to that of the torus; with digits, MPFR's numbers.
        """
        amplitudes = [self.amplitudes[q] for q in self.seeds]
        orders = range(self.order + 1)
        return tuple(self.series.harmonic_sums(amplitudes, k) for k in orders)

    @cached_property
    def _terms(self) -> tuple[Ints, Numbers]:
        """Harmonics (H, s) and cosine coefficients (H, C), all orders summed."""
        parts = self.terms_by_order[: self.order + 1]
        keys = [self.series.grading.harmonic_keys(nu) for nu, _ in parts]
        _, first, index = np.unique(
            np.concatenate(keys), return_index=True, return_inverse=True
        )
        with self._context():
            columns = parts[0][1].shape[1]
            values = inside(self.numbers).zeros((len(first), columns))
            at = 0
            for nu, part in parts:
                values[index[at : at + len(nu)]] += part
                at += len(nu)
        harmonics = np.concatenate([nu for nu, _ in parts])[first]
        moving = columns_of(self.chain, self.seeds, harmonics, travels=self.travels).moving
        coefficients = with_digits(at_the_face(values[moving]), self.digits)
        return harmonics[moving], coefficients

    @property
    def harmonics(self) -> Ints:
        """The harmonics nu of the solution, one of each pair +-nu; shape (H, s)."""
        return self._terms[0]

    @property
    def cosines(self) -> Numbers:
        """The coefficients c_q[nu] of cos(nu.theta) in Q_q, (H, N-1); of waves (H, 1)."""
        return self._terms[1]


def series_behind(result: object) -> LindstedtSeries:
    """A series, or that of a torus solved from one; raises InputError for what has none."""
    if isinstance(result, LindstedtSeries):
        return result
    return require_series_torus(result, "series").series


def require_series_torus(torus: object, argument: str = "torus") -> QTorus:
    """A torus that was solved from a series; raises InputError for any other solution."""
    if isinstance(torus, QTorus):
        return torus
    judge = "a solution without a series is judged by its residual()"
    advice = f"pass what solve_amplitudes gave; {judge}"
    raise InputError(
        argument, type(torus).__name__, "a QTorus, which has its series", advice
    )
