"""States to start orbits from: random ones, packets of modes, and particles as they stand.

Each is (Q, P) of the modes, as `integrate` and `alignment_indices` take them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain, require_any_chain
from symfpu.dynamics.wells import beyond_walls
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import Numbers
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, double, random_seed

Floats = NDArray[np.float64]
State = tuple[Numbers, Numbers]

SCALES = 80  # of the way along a direction, on which the energy is looked at
STRETCHED = 4.0  # times the scale of the linear chain, where the looking ends
HALVINGS = 54  # of an interval of scales: as many as a double has places
LARGEST_ERROR = 1e-12  # of the energy, relative
DRIFT = 1e-12  # sum of the momenta over the sum of their sizes, that rounding may leave


@public
def random_state(chain: Chain, energy: Number, seed: int) -> State:
    """A random state (Q, P) with the energy H; all directions of the linear chain are alike.

    chain : the model, of any potential and ends. energy : H > 0. seed : of the random numbers, 0
        or more; the same one gives the same state.

    P_q and Omega_q Q_q are normal numbers of one variance, scaled together until H is the energy;
    of several scales it is the smallest. Shapes (N-1,) each, complex on a ring, whose momentum is
    zero. Dimensionless. Ours. Raises InputError, also where no scale has that energy: in a well
    that ends below it.

    >>> chain = Chain(N=8, alpha="0.25")
    >>> Q, P = random_state(chain, "0.1", seed=1)
    >>> Q.shape, round(float(chain.energy(Q, P)), 12)
    ((7,), 0.1)
    """
    chain = require_any_chain(chain)
    target = _positive(energy)
    generator = np.random.default_rng(random_seed(seed))
    kind = chain.kind_of_ends
    x, p = generator.standard_normal((2, kind.particles))
    Q = chain.modes(x) / chain.frequencies()
    return _scaled(chain, Q, chain.modes(p), target)


@public
def packet_state(
    chain: Chain,
    seeds: Sequence[int],
    energy: Number,
    *,
    shares: Mapping[int, Number] | None = None,
    phases: Mapping[int, Number] | None = None,
) -> State:
    """A state (Q, P) in which only some modes move, with the energy H.

    chain : the model, of any potential and ends. seeds : its modes; on a ring waves that travel
        to larger j (q > 0) or to smaller ones (q < 0).
    energy : H > 0. shares : of the harmonic energy, by seed, positive; only their ratios count;
        default equal ones.
    phases : by seed, radians; those left out are 0.

    With fixed ends Q_q = A_q cos phi_q and P_q = -A_q Omega_q sin phi_q, as `fpu_trajectory`; on
    a ring x_j = N^(-1/2) sum A_q sin(2 pi q j/N - Omega_q t - phi_q) at t = 0. All A_q are scaled
    together until H is the energy; of several scales it is the smallest. Dimensionless. Ours.
    Raises InputError, also where no scale has that energy.

    >>> chain = Chain(N=8, beta="0.5")
    >>> Q, P = packet_state(chain, (1, 2), "0.1")
    >>> bool(Q[2:].any()), round(float(chain.energy(Q, P)), 12)
    (False, 0.1)
    """
    chain = require_any_chain(chain)
    modes = chain.kind_of_ends.seeds(seeds)
    if not modes:
        raise InputError("seeds", seeds, "one mode or more", "name the modes that move")
    weights = _by_mode("shares", shares, modes, 1.0)
    angles = _by_mode("phases", phases, modes, 0.0)
    if shares is not None and (set(shares) != set(modes) or min(weights.values()) <= 0):
        allowed = f"a positive number for each of the seeds {modes}"
        raise InputError("shares", shares, allowed, "name every seed once")
    add = _wave_on_a_ring if chain.periodic else _standing_mode
    Q: Numbers = np.zeros(chain.N - 1, dtype=chain.kind_of_ends.mode_type)
    P = Q.copy()
    for q in modes:
        frequency = float(chain.linear_frequency(q))
        amplitude = np.sqrt(2 * weights[q]) / frequency
        add(chain, Q, P, q, amplitude, angles[q], frequency)
    return _scaled(chain, Q, P, _positive(energy))


@public
def particle_state(chain: Chain, displacements: ArrayLike, momenta: ArrayLike) -> State:
    """The state (Q, P) of particles in real space (Eq. lintra inverted).

    chain : the model, of any potential and ends. displacements, momenta : x_1 .. x_(N-1) and
        their momenta, (N-1,) each; on a ring x_0 .. x_(N-1), (N,), with momenta of sum zero. The
        mean displacement of a ring is no mode and is left out. Dimensionless.

    Raises InputError for other lengths, numbers that are not finite, and a ring that drifts.

    >>> chain = Chain(N=4, alpha=1)
    >>> Q, P = particle_state(chain, [0.1, 0.0, 0.0], [0.0, 0.0, 0.2])
    >>> round(float(chain.energy(Q, P) - chain.energy(Q, 0 * P)), 12)
    0.02
    """
    chain = require_any_chain(chain)
    x = _real("displacements", displacements, chain)
    p = _real("momenta", momenta, chain)
    drift = abs(float(p.sum()))
    if chain.periodic and drift > DRIFT * float(np.abs(p).sum()):
        allowed = "momenta of sum zero on a ring: its centre rests"
        raise InputError("momenta", f"sum {p.sum():.6g}", allowed, "subtract their mean")
    return chain.modes(x), chain.modes(p)


def _real(name: str, values: ArrayLike, chain: Chain) -> Floats:
    """One state of the particles, as doubles."""
    array, _ = chain.kind_of_ends.displacements(values, name)
    x = np.asarray(array, dtype=np.float64)
    if x.ndim != 1 or not np.isfinite(x).all():
        allowed = f"{chain.kind_of_ends.particles} finite numbers"
        raise InputError(
            name, x.shape if x.ndim != 1 else "nan or inf", allowed, "one state"
        )
    return x


def _positive(energy: Number) -> float:
    value = double(energy, "energy")
    if not value > 0:
        raise InputError("energy", energy, "a positive number", "pass the energy H")
    return value


def _by_mode(
    name: str, values: Mapping[int, Number] | None, modes: tuple[int, ...], default: float
) -> dict[int, float]:
    """Numbers of all modes; InputError for those of others."""
    given = {} if values is None else values
    if not isinstance(given, Mapping):
        allowed = "a mapping from modes to numbers"
        raise InputError(name, values, allowed, "write it as {mode: number}")
    for q in given:
        if q not in modes:
            raise InputError(name, q, f"numbers of the seeds {modes}", "leave it out")
    return {q: double(given.get(q, default), f"{name}[{q}]") for q in modes}


def _standing_mode(
    chain: Chain, Q: Numbers, P: Numbers, q: int, A: float, phase: float, frequency: float
) -> None:
    Q[q - 1] += A * np.cos(phase)
    P[q - 1] += 0.0 - A * frequency * np.sin(phase)  # 0, not -0, for phase 0


def _wave_on_a_ring(
    chain: Chain, Q: Numbers, P: Numbers, q: int, A: float, phase: float, frequency: float
) -> None:
    """A sin(2 pi q j/N - phase) in modes q and -q, which are one where 2 |q| = N."""
    ends = chain.kind_of_ends
    there = ends.place(q)
    back = there if 2 * abs(q) == chain.N else ends.place(-q)
    half = -0.5j * A * np.exp(-1j * phase)
    velocity = -1j * frequency * half
    Q[there] += half
    Q[back] += half.conjugate()
    P[there] += velocity
    P[back] += velocity.conjugate()


def _scaled(chain: Chain, Q: Numbers, P: Numbers, target: float) -> State:
    """The state times the smallest number that gives it the energy; raises InputError."""
    harmonic = float(np.sum(chain.harmonic_energies(Q, P)))
    linear = np.sqrt(target / harmonic)

    def missing(scale: float) -> float:
        """H - energy; not a number beyond a wall."""
        near = scale * linear * Q
        if beyond_walls(chain.potential, np.asarray(chain.stretches(near))).any():
            return float("nan")
        with np.errstate(all="ignore"):
            return float(chain.energy(near, scale * linear * P)) / target - 1

    low, high = _bracket(missing, target)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if missing(middle) < 0 else (low, middle)
    if not abs(missing(high)) <= LARGEST_ERROR:
        raise _no_such_energy(target, (1 + missing(low)) * target)
    return high * linear * Q, high * linear * P


def _bracket(missing: Callable[[float], float], target: float) -> tuple[float, float]:
    """Scales between which the energy is passed for the first time."""
    low, most = 0.0, -1.0
    for step in range(1, SCALES + 1):
        high = STRETCHED * step / SCALES
        left = missing(high)
        if not left < 0:  # reached, or beyond a wall
            return low, high
        low, most = high, max(most, left)
    raise _no_such_energy(target, (1 + most) * target)


def _no_such_energy(target: float, reached: float) -> InputError:
    allowed = f"what states in this direction have, at most {reached:.6g}"
    return InputError("energy", f"{target:.6g}", allowed, "take less, or other modes")
