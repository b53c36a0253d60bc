"""The exact resonances of a ring: where the orders of a series of travelling waves have no meaning.

A harmonic nu lives in the mode q = nu.q_seeds modulo N. Omega_q = Omega_(-q): where nu.Omega =
Omega_q exactly and nu is no seed itself, the divisor is as small as the frequency shifts, and the
series has no orders. With waves q and -q such harmonics exist: 2 omega_(-q) - omega_q at q = N/4.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Ints
from symfpu.algebra.selection import Modes
from symfpu.algebra.waves import signed
from symfpu.chain.chain import Chain, linear_by_wave
from symfpu.chain.commensurability import frequencies_cancel
from symfpu.errors import ResonantDivisor

SUSPECT = 1e-9  # of nu.Omega - Omega_q, below which it is decided exactly


def refuse_resonances(
    chain: Chain, space: Modes, harmonics: Ints, wanted: NDArray[np.bool_], order: int
) -> None:
    """ResonantDivisor for one of the linear frequencies, whatever frequencies are chosen.

    harmonics : (H, s). wanted : which of them have a multiplier, (H,).
    """
    linear = linear_by_wave(chain.N, chain.ends)
    waves = space.wave_numbers(harmonics)[:, 0]
    drive = harmonics @ linear[np.array(space.seeds) % chain.N]
    near = np.abs(np.abs(drive) - linear[waves]) < SUSPECT
    for row in np.flatnonzero(wanted & near):
        direction = 1 if drive[row] > 0 else -1
        mode = signed(direction * int(waves[row]), chain.N)
        nu = tuple((direction * harmonics[row]).tolist())
        if resonant(chain, space.seeds, nu, mode):
            way_out = _way_out(chain, space.seeds, mode, order)
            raise ResonantDivisor(mode, nu, space.seeds, order, exact=True, way_out=way_out)


def resonant(chain: Chain, seeds: Sequence[int], nu: Sequence[int], mode: int) -> bool:
    """Whether nu.Omega = +-Omega_mode exactly."""
    signs = (1, -1)
    return any(_cancels(chain.turn, seeds, nu, mode, sign) for sign in signs)


def _cancels(
    turn: int, seeds: Sequence[int], nu: Sequence[int], mode: int, sign: int
) -> bool:
    combination = {abs(mode): -sign}
    for q, n in zip(seeds, nu, strict=True):
        combination[abs(q)] = combination.get(abs(q), 0) + n
    return frequencies_cancel(turn, combination)


def _way_out(chain: Chain, seeds: Sequence[int], mode: int, order: int) -> str:
    """What to do about a resonance that drives a mode."""
    driven = f"waves of mode {mode} are driven in resonance"
    lower = f"stop at order {order - 1}" if order > 1 else "choose other seeds"
    modes = sorted({abs(q) for q in (*seeds, mode)})
    if chain.N % 2 or chain.N // 2 in modes:
        return f"{driven}; {lower}"
    fixed = f"Chain(N={chain.N // 2}, ...) with fixed ends, seeds {tuple(modes)}"
    return f"{driven}; {lower}, or seed all partners as standing waves: {fixed}, and unfold"
