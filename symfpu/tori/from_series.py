"""A torus of a series at chosen amplitudes, cut at an order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from symfpu.algebra.grading import Ints
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Numbers, text, with_digits
from symfpu.numbers.mpfr import at_the_face, inside
from symfpu.numbers.typed import order_of
from symfpu.results.attributes import attributes
from symfpu.results.field import Field
from symfpu.results.numbers import fifteen_digits, number_text
from symfpu.results.result import Tabled
from symfpu.results.table import Table
from symfpu.series.series import LindstedtSeries, require_any_series
from symfpu.series.sums import require_frequencies
from symfpu.tori.columns import columns_of
from symfpu.tori.torus import Origin, Torus, comes_from


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
    >>> solve_amplitudes(series).origin.certificate.certified
    True
    >>> RootCertificate(False, {}, "the box does not shrink")
    RootCertificate(not proved: the box does not shrink)
    >>> solve_amplitudes(series).origin.certificate.to_frame().seed.tolist()
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


@dataclass(frozen=True, eq=False, repr=False)
class FromSeries(Origin):
    """Where a torus comes from: a series at chosen amplitudes, cut at an order.

    Eqs. qser and serabs1.

    series : it was solved from. amplitudes : (s,), in the order of the seeds. `torus(phases,
        warnings)` makes the torus.
    frequency_order : truncation of the frequency series that gave the amplitudes.
    order : truncation of the coordinates; the two are independent.
    history : K -> amplitudes, (s,), by frequency order. root_residual : largest
        |omega_q - truncated series|, dimensionless.
    certificate : whether the root is proved to exist (series with digits only).

    Raises InputError for what is no series with frequencies.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 8)).origin
    FromSeries(frequency order 8, order 8)
    """

    name: ClassVar[str] = "series"

    series: LindstedtSeries
    amplitudes: tuple[Any, ...]
    frequency_order: int
    order: int
    history: Mapping[int, tuple[Any, ...]] = field(default_factory=dict)
    root_residual: float = 0.0
    certificate: RootCertificate | None = None

    def __post_init__(self) -> None:
        digits = require_any_series(self.series).digits
        require_frequencies(self.series)
        if digits is not None:
            for name in ("amplitudes", "history"):
                shown = with_digits(getattr(self, name), digits)
                object.__setattr__(self, name, shown)

    def chosen_amplitudes(self) -> tuple[Any, ...]:
        return self.amplitudes

    def facts(self) -> tuple[str, ...]:
        orders = f"frequency order {self.frequency_order}", f"order {self.order}"
        if self.certificate is None:
            return orders
        return (*orders, "certified" if self.certificate.certified else "not certified")

    def fields(self, torus: Torus) -> Iterator[Field]:
        digits, proof, history = torus.digits, self.certificate, {}
        for k, values in self.history.items():
            history[str(k)] = [number_text(a, digits) for a in values]
        yield Field("order", self.order)
        yield Field("frequency_order", self.frequency_order)
        yield Field("guard_digits", None if digits is None else self.series.guard_digits)
        yield Field("certified", None if proof is None else proof.certified)
        yield Field("history", history)
        yield Field("root_residual", fifteen_digits(self.root_residual))
        divisors = [divisor.entry() for divisor in self.series.smallest_divisors]
        yield Field("smallest_divisors", divisors)

    @property
    def terms_by_order(self) -> tuple[tuple[Ints, Numbers], ...]:
        """Harmonics (H, s) and terms of their coefficients (H, C) of the orders 0 .. order.

        With digits, MPFR's numbers.
        """
        return self._known_terms[: self.order + 1]

    @cached_property
    def _known_terms(self) -> tuple[tuple[Ints, Numbers], ...]:
        orders = range(self.order + 1)
        return tuple(self.series.harmonic_sums(list(self.amplitudes), k) for k in orders)

    def lines(self, known: Mapping[str, Any]) -> Iterator[str]:
        """For a reader. known : the record of the torus."""
        yield f"orders             frequency order {self.frequency_order}, order {self.order}"
        if self.certificate is not None and self.certificate.certified:
            radius = text(max(self.certificate.radius.values()), 2)
            yield f"root               exactly one within {radius}: certified"
        elif self.certificate is not None:
            yield f"root               not certified: {self.certificate.reason}"

    def require_whole(self, torus: Torus) -> None:
        """Its orders and its seeds are those of the series."""
        series, order = self.series, max(order_of(self.order), self.frequency_order)
        if order > series.order or self.frequency_order < 0:
            orders = f"order {self.order} and frequency order {self.frequency_order}"
            raise ValueError(f"no torus of {orders} can come from this series")
        ours = series.chain, series.seeds, series.frequencies, series.digits
        if ours != (torus.chain, torus.seeds, torus.frequencies, torus.digits):
            raise ValueError("the series is one of another torus")
        counts = {len(values) for values in (self.amplitudes, *self.history.values())}
        if counts != {len(series.seeds)}:
            raise ValueError(f"amplitudes do not fit the seeds {series.seeds}")

    def cut_at(self, order: int) -> FromSeries:
        """The same up to a lower order of the coordinates; its terms are kept."""
        lower = order_of(order)
        if lower > self.order:
            advice = "make the torus with a higher order"
            raise InputError("order", lower, f"an integer in 0..{self.order}", advice)
        return self._with_known(replace(self, order=lower))

    def judged(
        self, history: Mapping[int, tuple[Any, ...]], certificate: RootCertificate | None
    ) -> FromSeries:
        """The same with what is known of the root; its terms are kept."""
        return self._with_known(replace(self, history=history, certificate=certificate))

    def _with_known(self, origin: FromSeries) -> FromSeries:
        if "_known_terms" in self.__dict__:
            origin.__dict__["_known_terms"] = self.__dict__["_known_terms"]
        return origin

    def terms(self) -> tuple[Ints, Numbers]:
        """Harmonics (H, s) and cosine coefficients (H, C), all orders summed."""
        series, parts = self.series, self.terms_by_order
        keys = [series.grading.harmonic_keys(nu) for nu, _ in parts]
        _, first, index = np.unique(
            np.concatenate(keys), return_index=True, return_inverse=True
        )
        with series.numbers.context(series.digits):
            columns = parts[0][1].shape[1]
            values = inside(series.numbers).zeros((len(first), columns))
            at = 0
            for nu, part in parts:
                values[index[at : at + len(nu)]] += part
                at += len(nu)
        harmonics = np.concatenate([nu for nu, _ in parts])[first]
        chain, seeds = series.chain, series.seeds
        moving = columns_of(chain, seeds, harmonics, travels=chain.periodic).moving
        return harmonics[moving], at_the_face(values[moving])

    def torus(
        self, phases: Mapping[int, Any] | None = None, warnings: Sequence[str] = ()
    ) -> Torus[FromSeries]:
        """The torus with these terms; phases : by seed, radians, 0 where left out.

        On a ring its waves travel.

        >>> from symfpu import Chain, lindstedt, solve_amplitudes
        >>> torus = solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 8))
        >>> torus.origin.cut_at(4).torus().residual() > torus.residual()
        True
        """
        series = self.series
        assert series.frequencies is not None
        return Torus(
            series.chain,
            series.seeds,
            series.frequencies,
            *self.terms(),
            phases or {},
            series.digits,
            series.chain.periodic,
            tuple(warnings),
            self,
        )


def series_behind(result: object) -> LindstedtSeries:
    """A series, or that of a torus solved from one; raises InputError for what has none."""
    if isinstance(result, LindstedtSeries):
        return result
    return require_series_torus(result, "series").origin.series


def require_series_torus(torus: object, argument: str = "torus") -> Torus[FromSeries]:
    """A torus that was solved from a series; raises InputError for any other solution."""
    if comes_from(torus, FromSeries):
        return torus
    given = f"Torus of {torus.origin}" if isinstance(torus, Torus) else type(torus).__name__
    judge = "a solution without a series is judged by its residual()"
    advice = f"pass what solve_amplitudes gave; {judge}"
    raise InputError(argument, given, "a torus of a series", advice)
