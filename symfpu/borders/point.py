"""One point of an atlas: a torus on a ray of growing energy, and what tells whether it is one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import SymfpuError
from symfpu.numbers.counted import short
from symfpu.tori.amplitudes import steps_of_frequencies
from symfpu.tori.at_energy import series_at_energy
from symfpu.tori.energy import Energy
from symfpu.tori.frequencies import series_at_amplitudes
from symfpu.tori.from_series import FromSeries
from symfpu.tori.orders import Orders
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import RATIO_ORDERS, Assessment, assess

DIGITS = 8  # of the places at which tori are looked for
RATIO, SUMS, POLES = "ratio", "sums", "poles"
ESTIMATES = (RATIO, SUMS, POLES)
FOLD_POWER = 1.5  # of 1/k in the terms of a series that ends at a square root
ENERGY, AMPLITUDE = "energy", "amplitude"


@dataclass(frozen=True)
class Ray:
    """Tori of one ratio of mode energies, or of one amplitude, that grow from the linear chain.

    by : "energy", places are H in equal mode energies; "amplitude", the A_q that all seeds have.
    order : of the series.
    """

    chain: Chain
    seeds: tuple[int, ...]
    order: int
    by: str = ENERGY

    @property
    def degree(self) -> int:
        """Energies go as place^degree while they are small."""
        return 1 if self.by == ENERGY else 2

    def torus(self, place: float, near: Torus[FromSeries] | None) -> Torus[FromSeries]:
        """The torus of the series at a place; raises what `series_at_energy` raises."""
        name, orders = f"{place:.{DIGITS}g}", Orders(self.order)
        if self.by == ENERGY:
            energy = Energy(name)
            return series_at_energy(self.chain, self.seeds, energy, orders, near=near)
        amplitudes = dict.fromkeys(self.seeds, name)
        return series_at_amplitudes(self.chain, amplitudes, orders, near=near)


@dataclass(frozen=True, eq=False)
class Point:
    """What is known of the torus at one place; dimensionless.

    place : on the ray, its energy or amplitude. torus : of the series; None if there is none, then
    failure says why. assessment : of the torus. exponent : places go as mu^exponent.
    """

    place: float
    torus: Torus[FromSeries] | None
    assessment: Assessment | None
    exponent: float = 1.0
    failure: str = ""
    radii: Mapping[str, float] = field(default_factory=dict)

    @property
    def residual(self) -> float:
        """Of the series at its best order; infinite where there is no torus."""
        if self.assessment is None:
            return math.inf
        return float(self.assessment.residuals[self.assessment.best_order])

    def record(self) -> dict[str, Any]:
        """As JSON holds it."""
        if self.torus is None or self.assessment is None:
            return {"place": self.place, "failure": self.failure}
        found = self.assessment
        return {
            "place": self.place,
            "energy": short(float(self.torus.energy())),
            "amplitudes": [short(float(A)) for A in self.torus.amplitudes.values()],
            "frequencies": [round(float(w), 12) for w in self.torus.frequencies],
            "verdict": found.word,
            "best_order": found.best_order,
            "radius": {name: short(radius) for name, radius in self.radii.items()},
            "residual": short(self.residual),
            "residual_resummed": short(found.resummed_residual),
            **singularity(found),
        }


def point_at(ray: Ray, place: float, near: Torus[FromSeries] | None) -> Point:
    """The point at a place, from a torus near it or from rest; a failure is a point, too."""
    try:
        torus = ray.torus(place, near)
        found = assess(torus.origin.series, torus)
    except SymfpuError as error:
        return Point(place, None, None, failure=f"{type(error).__name__}: {error}")
    step = steps_of_frequencies(torus.origin.series)
    exponent = step / ray.degree
    return Point(place, torus, found, exponent, radii=_radii(found, step))


def _radii(found: Assessment, step: int) -> dict[str, float]:
    """Radius of convergence by three estimates, in units of the actual mu."""
    largest = {term.order: term.size for term in found.terms}
    moduli = np.sum([of_seed for of_seed, _ in found.sums.values()], axis=0)
    sums = dict(enumerate(moduli.tolist()))
    return {
        RATIO: _radius(largest, found.order, step),
        SUMS: _radius(sums, found.order, step),
        POLES: found.pole_radius,
    }


def _radius(sizes: Mapping[int, float], order: int, step: int) -> float:
    """R of the terms k^(-3/2) R^-k nearest to the last ones of one parity, by their logarithms.

    Such are the terms of a series whose nearest singularity is a square root: a fold.
    """
    orders = range(order, 0, -step)[:RATIO_ORDERS]
    known = [k for k in orders if sizes.get(k, 0) > 0]
    if len(known) < 2:
        return math.inf
    logarithms = [math.log(sizes[k]) + FOLD_POWER * math.log(k) for k in known]
    slope = np.polyfit(known, logarithms, 1)[0]
    return float(np.exp(-slope))


def singularity(found: Assessment) -> dict[str, Any]:
    """What carries the last order, and the nearest pole of the frequencies, as JSON holds them.

    mode, harmonic, divisor : of the largest term of the last order. pole : the argument of the
    nearest pole in units of pi: 0 lies on the ray itself, 1 on its continuation to negative
    squares of the amplitudes.
    """
    nearest = [poles[0] for poles in found.poles.values() if len(poles)]
    pole = None
    if nearest:
        first = min(nearest, key=abs)
        pole = short(abs(np.angle(first)) / math.pi)
    if not found.terms:
        return {"mode": None, "harmonic": None, "divisor": None, "pole": pole}
    last = found.terms[-1]
    divisor = short(last.divisor)
    return {
        "mode": last.mode,
        "harmonic": list(last.harmonic),
        "divisor": divisor,
        "pole": pole,
    }
