"""The fields of a result: each is declared once, for its record, its text and its HTML."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from symfpu.numbers.arithmetic import text
from symfpu.results.attributes import SomeChain
from symfpu.results.numbers import exact_text, number_text

PLACES = 12  # digits of doubles that readers see
LONGEST = 44  # characters of a number; longer ones are cut


class Field(NamedTuple):
    """One thing that a result says of itself.

    key : in its record; empty for what readers alone see. value : there, as JSON holds it. label :
    in front of it where readers see it; empty for what the record alone has. shown : what they see
    of the value, where that is not the value itself.
    """

    key: str
    value: Any = None
    label: str = ""
    shown: str = ""

    @property
    def text(self) -> str:
        """What readers see."""
        return self.shown or str(self.value)


def chain_fields(chain: SomeChain) -> Iterator[Field]:
    """A chain, as it is typed."""
    yield Field("", label="chain", shown=chain.label)
    yield from (Field(key, value) for key, value in chain.typed.items())


def fields_of(record: Mapping[str, Any]) -> Iterator[Field]:
    """Those of a record, with its keys as labels of what is short."""
    for key, value in record.items():
        short = not isinstance(value, dict | list)
        yield Field(key, value, key.replace("_", " ") if short else "")


def seeds_field(seeds: Any) -> Field:
    """The seed modes; those that are counted from the end as text."""
    known = [q if type(q) is int else str(q) for q in seeds]
    return Field("seeds", known, "seeds", ", ".join(map(str, known)))


def numbers_by_seed(values: Mapping[Any, Any], digits: int | None) -> dict[str, str]:
    """Numbers by seed or mode that lose no digit."""
    return {str(q): number_text(x, digits) for q, x in values.items()}


def exact_by_seed(omega: Mapping[Any, Fraction] | None) -> dict[str, str] | None:
    """Frequencies by seed, exact; None where none are chosen."""
    return None if omega is None else {str(q): exact_text(w) for q, w in omega.items()}


def shown_number(value: Any, digits: int | None = None) -> str:
    """A number as readers see it, cut where it is too long."""
    written = text(value, digits or PLACES)
    return written if len(written) <= LONGEST else f"{written[:LONGEST]}..."


def shown_frequency(omega: Fraction) -> str:
    """As it is typed, cut where it is too long; a long fraction as a double."""
    typed = exact_text(omega)
    if len(typed) <= LONGEST:
        return typed
    return f"{float(omega):.15g}" if "/" in typed else f"{typed[:LONGEST]}..."


def listed(values: Iterable[Any]) -> str:
    """Values in a row."""
    return ", ".join(map(str, values))
