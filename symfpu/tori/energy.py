"""What may be asked of an energy: which one it is, and how it is shared among the seeds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, energy_of


@public
@dataclass(frozen=True, eq=False, repr=False)
class Energy:
    """An energy to ask for, where a number alone does not say enough.

    value : a positive exact number, dimensionless. harmonic : False, it is the total energy H;
    True, the harmonic energy sum E_q over all modes. Both at the angles zero, of a ring averaged
    over the angles.
    amplitude_ratio : weights of the amplitudes A_q, by seed.
    energy_ratio : weights of the averages of E_q of the seeds, by seed (other modes take what the
        torus gives them). At most one of the two; only their ratios count. Left out, what takes
        the energy says how it is shared.

    Raises InputError.

    >>> Energy("0.01", harmonic=True, energy_ratio={1: 2, 2: 1})
    Energy('0.01', harmonic=True, energy_ratio={1: 2, 2: 1})
    """

    value: Number
    harmonic: bool = False
    amplitude_ratio: Mapping[int, Number] | None = None
    energy_ratio: Mapping[int, Number] | None = None

    def __post_init__(self) -> None:
        energy_of(self.value)
        if not isinstance(self.harmonic, (bool, np.bool_)):
            allowed = "True for sum E_q, False for H"
            raise InputError(
                "harmonic", self.harmonic, allowed, "say which energy is meant"
            )
        if self.amplitude_ratio is not None and self.energy_ratio is not None:
            allowed = "only one of amplitude_ratio and energy_ratio"
            raise InputError("energy_ratio", self.energy_ratio, allowed, "leave one out")

    @property
    def exact(self) -> Fraction:
        """The number."""
        return energy_of(self.value)

    def __repr__(self) -> str:
        parts = [repr(self.value)]
        if self.harmonic:
            parts.append("harmonic=True")
        for name in ("amplitude_ratio", "energy_ratio"):
            ratio = getattr(self, name)
            if ratio is not None:
                parts.append(f"{name}={dict(ratio)}")
        return f"Energy({', '.join(parts)})"


def asked_energy(energy: Number | Energy) -> Energy:
    """A number alone is the total energy H; raises InputError for what is no energy."""
    return energy if isinstance(energy, Energy) else Energy(energy)
