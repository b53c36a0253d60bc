"""The law of one bond: V(r) = r^2/2 + c_3 r^3/3 + c_4 r^4/4 + ..., its V' and its V''.

V' is the tension, V'' the stiffness.

Eq. fpuham has c_3 = alpha and c_4 = beta. `law` is always the tuple (c_3, c_4, ...) in the
arithmetic of r: floats, long doubles or mpf. The functions take numbers and arrays alike.
`tension` and `stiffness` call nothing, so that loops compile the very same functions
(numba.njit(tension)).
"""

from __future__ import annotations

from typing import Any

Law = tuple[Any, ...]


def potential(law: Law, r: Any) -> Any:
    """V(r)."""
    last = len(law) - 1
    value = law[last] / (last + 3)
    for i in range(last - 1, -1, -1):
        value = law[i] / (i + 3) + r * value
    return r * r * (0.5 + r * value)


def tension(law: Law, r: Any) -> Any:
    """V'(r)."""
    last = len(law) - 1
    value = law[last]
    for i in range(last - 1, -1, -1):
        value = law[i] + r * value
    return r * (1 + r * value)


def stiffness(law: Law, r: Any) -> Any:
    """V''(r)."""
    last = len(law) - 1
    value = (last + 2) * law[last]
    for i in range(last - 1, -1, -1):
        value = (i + 2) * law[i] + r * value
    return 1 + r * value


def anharmonic_tension(law: Law, r: Any) -> Any:
    """V'(r) - r, without the cancellation."""
    last = len(law) - 1
    value = law[last]
    for i in range(last - 1, -1, -1):
        value = law[i] + r * value
    return r * r * value


def anharmonic_stiffness(law: Law, r: Any) -> Any:
    """V''(r) - 1, without the cancellation."""
    last = len(law) - 1
    value = (last + 2) * law[last]
    for i in range(last - 1, -1, -1):
        value = (i + 2) * law[i] + r * value
    return r * value
