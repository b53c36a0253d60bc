"""Which powers of the stretch act in the force of a bond, as far as the propagation rule asks.

The power r^n of the force adds (n - 1)/step to the order, where step is how much the degree in
the amplitudes grows with the order: 2 where V is even, else 1. Whether it acts, not how strongly,
decides which modes the couplings let in.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from symfpu.chain.potentials.potential import Potential
from symfpu.chain.potentials.typed import potential_given
from symfpu.errors import InputError

MODELS = {"alpha": (1, (1,)), "beta": (2, (1,)), "alpha+beta": (1, (1, 2))}


@dataclass(frozen=True)
class Powers:
    """step : of the degree with the order. adds : whether the power that adds k to it acts."""

    step: int
    adds: Callable[[int], bool]

    def factors(self, added: int) -> int:
        """n of the power r^n that adds so much to the order."""
        return 1 + self.step * added

    def acting(self, order: int) -> Iterator[int]:
        """What the powers that act add to the order, up to this order."""
        return (added for added in range(1, order + 1) if self.adds(added))

    def orders_reached(self, order: int) -> list[bool]:
        """Whether there are terms at orders 0 .. order: sums of what the powers add."""
        if self.adds(1):
            return [True] * (order + 1)
        reached, adds = [True], list(self.acting(order))
        for k in range(1, order + 1):
            reached.append(any(reached[k - added] for added in adds if added <= k))
        return reached


def powers_of(model: str | None, potential: Potential | str | None) -> Powers:
    """The powers that act in one of the MODELS, 'alpha' if none is named, or in a potential.

    InputError for an unknown model, for what is no potential, and where both are given.
    """
    if potential is None:
        if model not in (None, *MODELS):
            allowed = "'alpha', 'beta' or 'alpha+beta'"
            raise InputError("model", model, allowed, "pass one of these, or a potential")
        step, acting = MODELS[model or "alpha"]
        return Powers(step, acting.__contains__)
    if model is not None:
        advice = f"leave it to {potential}"
        raise InputError("model", model, "a model or a potential, not both", advice)
    law = potential_given(potential)
    step = 2 if law.even else 1
    return Powers(step, lambda added: law.coefficient(2 + step * added) != 0)
