"""Energy profiles of orbits (sections 3.2, 4.1).

They are of FPU-trajectories and packets: normalised spectra, and distances between them.

An `Orbit` integrated with averages=True is a running spectrum: its `averages` are Ebar_q(t), its
`harmonic_energies()` E_q(t). The closed form of a torus is `torus.average_spectrum(T)`; PLn is
the orbit from `torus.Q(0)` and `torus.P(0)`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.dynamics.orbits import Orbit
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, double, seed_modes
from symfpu.results.field import Field
from symfpu.results.numbers import fifteen_digits
from symfpu.results.result import Result

Floats = NDArray[np.float64]
SHARES = ("energy", "amplitude")


@public
def fpu_trajectory(
    chain: Chain,
    amplitudes: Mapping[int, Number],
    phases: Mapping[int, Number] | None = None,
) -> tuple[Floats, Floats]:
    """Initial conditions (Q, P), each (N-1,), of the FPU-trajectory with these seeds.

    They are those of Definition 4 of the paper.

    chain : the model. amplitudes, phases : by seed, dimensionless and in radians; phases left out
        are 0.

    Q_q = A_q cos phi_q, P_q = -A_q Omega_q sin phi_q for the seeds, exactly 0 for other modes.
    Raises InputError.

    >>> fpu_trajectory(Chain(N=4, alpha=1), {1: 0.5, 3: "0.25"})
    (array([0.5 , 0.  , 0.25]), array([0., 0., 0.]))
    """
    require_chain(chain)
    seeds = seed_modes(_mapping(amplitudes, "amplitudes"), chain.N)
    angles = _mapping({} if phases is None else phases, "phases")
    for key in angles:
        if key not in amplitudes:
            raise InputError(
                "phases",
                key,
                f"phases of the seeds {seeds}",
                "give that mode an amplitude, or leave its phase out",
            )
    linear = chain.frequencies()
    Q = np.zeros(chain.N - 1)
    P = np.zeros(chain.N - 1)
    for q in seeds:
        A = double(amplitudes[q], f"amplitudes[{q}]")
        phi = double(angles.get(q, 0), f"phases[{q}]")
        Q[q - 1] = A * math.cos(phi)
        P[q - 1] = 0.0 - A * linear[q - 1] * math.sin(phi)  # 0, not -0, for phi = 0
    return Q, P


@public
def packet_amplitudes(
    chain: Chain, seeds: Sequence[int], energy: Number, *, share: str = "energy"
) -> dict[int, float]:
    """Amplitudes by seed of a given harmonic energy, for `fpu_trajectory`.

    That energy is the sum of A_q^2 Omega_q^2 / 2.

    chain, seeds : the model and distinct modes. energy : positive, dimensionless.
    share : energy, the same E_q (Eq. harmonicene) for all seeds; or amplitude, the same A_q.

    Holds for any phases. This is not H, which adds the anharmonic energy of the phases chosen.
    Ours. Raises InputError.

    >>> packet_amplitudes(Chain(N=3, alpha=1), (1, 2), 2, share="amplitude")  # Omega^2 = 1, 3
    {1: 1.0, 2: 1.0}
    """
    require_chain(chain)
    modes = seed_modes(seeds, chain.N)
    total = double(energy, "energy")
    if not total > 0:
        raise InputError(
            "energy", energy, "a positive number", "pass the harmonic energy of the packet"
        )
    if share not in SHARES:
        raise InputError("share", share, ", ".join(SHARES), "choose one of them")
    places = np.array(modes) - 1
    squared_frequencies = chain.frequencies()[places] ** 2
    if share == "energy":
        squared = 2 * total / len(modes) / squared_frequencies
    else:
        of_each = 2 * total / np.sum(squared_frequencies)
        squared = np.full(len(modes), of_each)
    amplitudes = np.sqrt(squared).tolist()
    return dict(zip(modes, amplitudes, strict=True))


@public
def normalised_averages(orbit: Orbit) -> Floats:
    """Running averages of the harmonic energies over the total energy; shape (S, ..., N-1).

    They are Ebar_q(t)/H.

    orbit : integrated with averages=True; its last row is the paper's normalised averaged
        spectrum (section 4), dimensionless.

    Harmonic energies are those of Eq. harmonicene, with the 1/2 that the paper's average leaves
    out. Raises InputError.

    >>> from symfpu.dynamics.orbits import integrate
    >>> chain = Chain(N=4, beta=1)
    >>> orbit = integrate(chain, [0.1, 0, 0], [0, 0, 0], 100, step=0.125, averages=True)
    >>> normalised_averages(orbit)[-1].round(3)
    array([1., 0., 0.])
    """
    if getattr(orbit, "averages", None) is None:
        raise InputError(
            "orbit",
            repr(orbit),
            "an orbit with running averages",
            "integrate with averages=True",
        )
    if not (orbit.energies[0] > 0).all():
        raise InputError(
            "orbit",
            repr(orbit),
            "an orbit of positive energy",
            "divide its averages by another number",
        )
    return np.asarray(orbit.averages / orbit.energies[0][..., None])


@dataclass(frozen=True)
class ProfileDistance(Result):
    """How far two spectra differ. Made by `profile_distance`. Ours.

    distance : largest |log10(a_q/b_q)|, in decades. mode : where it is reached. modes : how many
        of either lie above the floor.

    >>> ProfileDistance(1.0, 2, 2)
    ProfileDistance(1 decades at mode 2, 2 modes above the floor)
    """

    distance: float
    mode: int
    modes: int

    def _fields(self) -> Iterator[Field]:
        yield Field("distance", fifteen_digits(self.distance), "distance")
        yield Field("mode", self.mode, "mode")
        yield Field("modes", self.modes, "modes")

    def __repr__(self) -> str:
        largest = f"{self.distance:.4g} decades at mode {self.mode}"
        return f"ProfileDistance({largest}, {self.modes} modes above the floor)"


@public
def profile_distance(a: ArrayLike, b: ArrayLike, floor: float) -> ProfileDistance:
    """How far two spectra differ: the largest |log10(a_q/b_q)|, in decades, as a ProfileDistance.

    a, b : energies by mode, shape (N-1,), not negative.
    floor : positive, in their units; values below it, rounding, count as the floor, and two modes
        there do not differ.

    Ours. Raises InputError.

    >>> profile_distance([1, 1e-2, 1e-20], [1, 1e-3, 1e-25], 1e-12)
    ProfileDistance(1 decades at mode 2, 2 modes above the floor)
    """
    first = mode_energies(a, "a")
    second = mode_energies(b, "b")
    least = double(floor, "floor")
    if first.ndim != 1 or first.shape != second.shape or not first.size:
        raise InputError(
            "a, b",
            (first.shape, second.shape),
            "two spectra of the same modes, (N-1,)",
            "pass one row of each",
        )
    if not least > 0:
        raise InputError(
            "floor",
            floor,
            "a positive energy",
            "pass what rounding leaves, such as 1e-30 of the whole",
        )
    logs = [np.log10(np.maximum(spectrum, least)) for spectrum in (first, second)]
    ratios = np.abs(logs[0] - logs[1])
    worst = int(np.argmax(ratios))
    above = np.maximum(first, second) > least
    return ProfileDistance(float(ratios[worst]), worst + 1, int(np.sum(above)))


def energy_record(times: ArrayLike, values: ArrayLike, name: str) -> tuple[Floats, Floats]:
    """Times and what was sampled at them, as arrays; raises InputError."""
    array = mode_energies(values, name)
    t = mode_energies(times, "times")
    enough = t.ndim == 1 and len(t) >= 3
    if not enough or not (np.diff(t) > 0).all():
        raise InputError(
            "times", t.shape, "three increasing times or more, (S,)", "pass orbit.times"
        )
    if array.ndim != 2 or len(array) != len(t):
        raise InputError(
            name,
            array.shape,
            f"one row for each of the {len(t)} times, (S, N-1)",
            "pass those of one orbit",
        )
    return t, array


def mode_energies(values: ArrayLike, name: str) -> Floats:
    try:
        array = DOUBLES.array(values)
    except (TypeError, ValueError) as error:
        raise InputError(
            name, values, "an array of numbers", "pass those of an orbit"
        ) from error
    if not (np.isfinite(array) & (array >= 0)).all():
        raise InputError(
            name,
            "an array with nan, infinity or negative numbers",
            "finite numbers, 0 or more",
            "pass those of an orbit",
        )
    return array


def _mapping(values: object, name: str) -> Mapping[int, Number]:
    if not isinstance(values, Mapping):
        allowed = "a mapping from mode to number, such as {1: 0.5}"
        raise InputError(name, values, allowed, "pass a dict")
    return values
