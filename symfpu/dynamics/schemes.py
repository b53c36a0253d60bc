"""The list of schemes, by name: a new one is a file with its coefficients, and an entry here."""

from __future__ import annotations

from symfpu.chain.chain import Chain
from symfpu.chain.potentials.polynomial import Polynomial
from symfpu.dynamics.aba864 import ABA864, ABA864_MODES
from symfpu.dynamics.blanes_moan6 import BLANES_MOAN6
from symfpu.dynamics.kahan_li8 import KAHAN_LI8
from symfpu.dynamics.scheme import Scheme
from symfpu.dynamics.yoshida4 import YOSHIDA4
from symfpu.errors import InputError

_LIST = (YOSHIDA4, ABA864, BLANES_MOAN6, KAHAN_LI8, ABA864_MODES)
SCHEMES = {scheme.name: scheme for scheme in _LIST}
PARTICLE_SCHEMES = {name: scheme for name, scheme in SCHEMES.items() if not scheme.in_modes}


def scheme_of(chain: Chain, name: object) -> Scheme:
    """Any scheme that moves such a chain; raises InputError.

    In modes kicks are products of standing waves: of polynomials in the stretches, between walls.
    """
    polynomial = isinstance(chain.potential, Polynomial)
    in_modes = polynomial and not chain.periodic
    known = SCHEMES if in_modes else PARTICLE_SCHEMES
    if isinstance(name, str) and name in known:
        return known[name]
    advice = "choose one of them"
    if isinstance(name, str) and name in SCHEMES:
        other = "ends='periodic'" if polynomial else str(chain.potential)
        served = "fixed ends" if polynomial else "polynomial potentials"
        advice += f": {name} is for {served}, not for {other}"
    raise InputError("scheme", name, ", ".join(known), advice)


def particle_scheme(name: object) -> Scheme:
    """A scheme on T + V, as deviations from an orbit need one; raises InputError."""
    if isinstance(name, str) and name in PARTICLE_SCHEMES:
        return PARTICLE_SCHEMES[name]
    advice = "choose one of them: deviations are moved on T + V"
    if isinstance(name, str) and name in SCHEMES:
        advice += f"; {name} is for integrate alone"
    raise InputError("scheme", name, ", ".join(PARTICLE_SCHEMES), advice)
