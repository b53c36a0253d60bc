"""Where a series is cut: the whole, its frequencies, its coordinates."""

from __future__ import annotations

from dataclasses import dataclass

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, order_of


@public
@dataclass(frozen=True, repr=False)
class Orders:
    """Three truncations of a series, where one number for all of them does not say enough.

    The paper's table and captions do not always mean the same one.

    order : of the series. frequency_order : K of the frequency series that gives frequencies or
    amplitudes. coordinate_order : where Q_q(t) is cut. The last two are up to the first, and equal
    to it where they are left out.

    Raises InputError.

    >>> Orders(8, frequency_order=6)
    Orders(8, frequency_order=6, coordinate_order=8)
    """

    order: int
    frequency_order: int = None  # type: ignore[assignment]
    coordinate_order: int = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        whole = order_of(self.order)
        for name, least in (("frequency_order", 1), ("coordinate_order", 0)):
            cut = order_argument(name, getattr(self, name), whole, least)
            object.__setattr__(self, name, cut)
        object.__setattr__(self, "order", whole)

    def __repr__(self) -> str:
        cuts = f"frequency_order={self.frequency_order}"
        return f"Orders({self.order}, {cuts}, coordinate_order={self.coordinate_order})"


def order_argument(name: str, value: int | None, whole: int, least: int = 0) -> int:
    """An order at which a series is cut, by default its own.

    InputError naming the argument if the series ends before.
    """
    if value is None:
        return whole
    if integer(value, name, least) > whole:
        allowed = f"{least}..{whole}, up to the order of the series"
        raise InputError(name, value, allowed, "compute a longer series or lower it")
    return int(value)


def asked_orders(order: int | Orders) -> Orders:
    """A number alone is the order of everything."""
    return order if isinstance(order, Orders) else Orders(order)


def require_shifts(orders: Orders, chain: Chain) -> None:
    """InputError where the frequency series ends before its first correction."""
    first = 2 // chain.degree_step
    for name in ("order", "frequency_order"):
        k = getattr(orders, name)
        if k < first:
            allowed = f"{first} or more, the order of the first frequency correction"
            raise InputError(name, k, allowed, f"take {first} or more")
