"""Which of several wishes counts: the newest, whatever comes back of the older ones.

Nothing here knows processes or pages; seconds are given to it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

PATIENCE = 2.0  # seconds that a newer wish waits for an older one before that is given up


class Wishes:
    """On the side that computes: of each kind the newest wish stands, in the order of arrival.

    >>> wishes = Wishes()
    >>> for kind, wish in (("torus", 1), ("term", 2), ("torus", 3)):
    ...     wishes.add(kind, wish)
    >>> list(wishes.taken())
    [('term', 2), ('torus', 3)]
    """

    def __init__(self) -> None:
        self._waiting: dict[str, Any] = {}

    def add(self, kind: str, wish: Any) -> None:
        """A wish; an older one of its kind is forgotten."""
        self._waiting.pop(kind, None)
        self._waiting[kind] = wish

    def __contains__(self, kind: str) -> bool:
        return kind in self._waiting

    def taken(self) -> Iterator[tuple[str, Any]]:
        """Kinds and wishes, until none is left."""
        while self._waiting:
            kind = next(iter(self._waiting))
            yield kind, self._waiting.pop(kind)


class Newest:
    """On the side that asks: tickets of one kind of wish, and how long the newest one takes.

    >>> newest = Newest()
    >>> old, new = newest.ask(now=0.0), newest.ask(now=1.0)
    >>> newest.current(old), newest.current(new), newest.seconds(now=1.5)
    (False, True, 0.5)
    """

    def __init__(self) -> None:
        self._ticket = 0
        self._asked: float | None = None  # when, as long as it is not done
        self._running = 0  # the ticket that is being computed, 0 for none

    def ask(self, now: float) -> int:
        """A ticket for a new wish: answers to older ones are stale from now on."""
        self._ticket += 1
        self._asked = now
        return self._ticket

    @property
    def ticket(self) -> int:
        """The newest."""
        return self._ticket

    def current(self, ticket: int) -> bool:
        """Whether an answer is to the newest wish."""
        return ticket == self._ticket

    def begun(self, ticket: int) -> None:
        """The computing side has taken this wish."""
        self._running = ticket

    def done(self, ticket: int) -> None:
        """The computing side has ended with this wish."""
        if self._running == ticket:
            self._running = 0
        if self.current(ticket):
            self._asked = None

    def forget(self) -> None:
        """No wish is left, and whatever still comes is stale."""
        self._ticket += 1
        self._asked, self._running = None, 0

    def seconds(self, now: float) -> float:
        """Since the newest wish; 0 where it is done."""
        return 0.0 if self._asked is None else now - self._asked

    def stuck(self, now: float) -> bool:
        """Whether the newest wish has waited too long behind an older one."""
        older = self._running not in (0, self._ticket)
        return older and self.seconds(now) > PATIENCE
