"""When an orbit is stopped.

The reasons are a step beyond stability, an escape over a barrier of the potential of the bonds,
and numbers that overflow.
"""

from __future__ import annotations

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.dynamics.scheme import Scheme
from symfpu.errors import SymfpuError


class OrbitStopped(SymfpuError):
    """An orbit that cannot be followed further; base of EscapedOrbit and UnstableStep.

    Raised by `integrate` and its users. Ours.

    time : of the stop; mode : of the largest (growth of) harmonic energy; energy : total;
        dimensionless.
    orbit : its place among several, () for one. bond : j of the bond that went too far, its
        stretch r_j = x_(j+1) - x_j, j = 0 .. N-1; None where no bond is to blame.
    """

    def __init__(
        self,
        reason: str,
        advice: str,
        *,
        time: float,
        mode: int,
        energy: float,
        orbit: tuple[int, ...] = (),
        bond: int | None = None,
    ) -> None:
        self.time, self.mode, self.energy, self.orbit = time, mode, energy, orbit
        self.bond = bond
        place = f" of orbit {orbit}" if orbit else ""
        super().__init__(
            f"{reason} at time {time:.10g} in mode {mode}{place}, energy {energy:.6g}; {advice}"
        )


class EscapedOrbit(OrbitStopped):
    """A bond went over a barrier of its potential, beyond which it falls without bound.

    Raised by `integrate`; the potential is that of Eq. fpuham or another of `Chain`.

    time, mode, energy, orbit, bond : as in OrbitStopped; dimensionless.
    """


class UnstableStep(OrbitStopped):
    """The step is beyond the stability of the scheme, or too coarse to conserve the energy.

    A step too coarse may also take a bond across the wall of its potential, r = -1 of Lennard and
    Jones, which the motion never reaches. Raised by `integrate`. Ours.

    time, mode, energy, orbit, bond : as in OrbitStopped; dimensionless.
    """


def require_stable(chain: Chain, scheme: Scheme, step: float, energy: float) -> None:
    """Raises UnstableStep for a step that lets a harmonic mode grow."""
    Omega = chain.frequencies()
    unstable = abs(step) * Omega > scheme.stable_phase
    if unstable[-1]:
        slowest = int(np.argmin(np.where(unstable, Omega, np.inf)))
        largest = scheme.stable_phase / Omega[-1]
        raise UnstableStep(
            f"a step of {abs(step):.6g} of {scheme.name} is unstable",
            f"take a step below {largest:.4g}, and a fraction of it for accuracy",
            time=0.0,
            mode=chain.mode_numbers[slowest],
            energy=energy,
        )
