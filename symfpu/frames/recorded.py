"""What results inherit: their answer as a record that JSON can hold."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from symfpu.numbers.public import public

RECORDS = "symfpu.reports.records"  # the records of results, by their kind


@public
class Recorded:
    """A result with a record of its own.

    Records are made far above results: the module that knows them all is imported when the first
    one is asked for.
    """

    def record(self) -> dict[str, Any]:
        """Its answer as a dictionary that JSON can hold, with the keys of the command line.

        `kind` is the class. The chain is as typed, what belongs to a seed is by seed. Numbers that
        need more than 15 digits are strings that lose none; measures of size (residuals, errors)
        are numbers of 15 digits. The keys are in docs/records.md.

        >>> import symfpu
        >>> from symfpu import Chain
        >>> chain = Chain(N=4, alpha=1)
        >>> torus = symfpu.torus(chain, (1,), energy="0.001", method="series", order=2)
        >>> found = torus.record()
        >>> found["kind"], found["origin"], found["N"], found["alpha"], float(found["energy"])
        ('Torus', 'FromSeries', 4, '1', 0.001)
        """
        found: dict[str, Any] = import_module(RECORDS).record(self)
        return found
