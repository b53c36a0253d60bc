"""The truncated series of the paper as a torus, to a given order or to the best one."""

from __future__ import annotations

from typing import Any

from symfpu.chain.chain import Chain, require_chain
from symfpu.errors import DidNotConverge, InputError, NoRealAmplitude, SymfpuError, TooLarge
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.at_energy import NoTorusAtEnergy, series_at_energy
from symfpu.tori.best_order import best_order
from symfpu.tori.energy import asked_energy
from symfpu.tori.frequencies import NoSelfConsistentFrequencies, series_at_amplitudes
from symfpu.tori.from_series import FromSeries
from symfpu.tori.orders import Orders, asked_orders
from symfpu.tori.torus import Torus

# powers of the amplitudes, less 1, in a series whose order was not given
DEGREES = (4, 8, 12, 16, 24, 32, 48, 64)
MOST_FAILURES = 3  # orders without a torus, after which no longer series is tried
ENOUGH = 1e-13  # relative residual of doubles with which no more orders are tried
Order = int | Orders | None
# orders that have no torus are passed over
NO_TORUS = (NoRealAmplitude, DidNotConverge, NoTorusAtEnergy, NoSelfConsistentFrequencies)


def series_torus(
    chain: Chain,
    seeds: tuple[int, ...],
    wish: dict[str, Any],
    order: Order,
    digits: int | None,
    progress: Progress,
) -> Torus[FromSeries]:
    """The torus of the series of an order, or of the order with the least residual.

    wish : one of frequencies, amplitudes and energy, as of `torus`.
    """
    if "start" in wish:
        advice = "give amplitudes, or leave method out"
        raise InputError("start", wish["start"], "none with method='series'", advice)
    if chain.periodic and "frequencies" not in wish:
        require_chain(chain)
    if order is not None:
        return _of_order(chain, seeds, wish, asked_orders(order), digits, progress)
    return _best(chain, seeds, wish, digits, progress)


def _of_order(
    chain: Chain,
    seeds: tuple[int, ...],
    wish: dict[str, Any],
    orders: Orders,
    digits: int | None,
    progress: Progress,
    near: Torus[FromSeries] | None = None,
) -> Torus[FromSeries]:
    if "frequencies" in wish:
        omega = wish["frequencies"]
        series = lindstedt(
            chain, seeds, omega, orders.order, digits=digits, progress=progress
        )
        progress("amplitudes", NO_FRACTION)
        K, cut = orders.frequency_order, orders.coordinate_order
        return solve_amplitudes(series, frequency_order=K, order=cut)
    if "amplitudes" in wish:
        given = wish["amplitudes"]
        return series_at_amplitudes(chain, given, orders, digits=digits, near=near)
    energy = asked_energy(wish["energy"])
    return series_at_energy(chain, seeds, energy, orders, digits=digits, near=near)


def _best(
    chain: Chain,
    seeds: tuple[int, ...],
    wish: dict[str, Any],
    digits: int | None,
    progress: Progress,
) -> Torus[FromSeries]:
    """A series twice as long until its best order is not its last; then cut there.

    Of the orders that have a torus it is the one with the least residual.
    """
    best: Torus[FromSeries] | None = None
    failure: SymfpuError | None = None
    failed = 0
    enough = ENOUGH if digits is None else 10.0**-digits
    for degree in DEGREES:
        order = degree // chain.degree_step
        progress(f"series of order {order}", degree / DEGREES[-1])
        try:
            found = _of_order(chain, seeds, wish, Orders(order), digits, progress, best)
        except NO_TORUS as error:
            failure = failure or error
            failed += 1
            if best is not None or failed == MOST_FAILURES:
                break
            continue
        except TooLarge as error:
            failure = failure or error
            break
        last = best_order(found)
        if last < order:
            orders = Orders(order, coordinate_order=last)
            found = _of_order(chain, seeds, wish, orders, digits, progress, found)
        if best is not None and found.residual() >= best.residual():
            break
        best = found
        if last < order or best.residual() <= enough:
            break
    if best is None:
        assert failure is not None
        raise failure
    return best
