"""The law of one bond: V(r) = r^2/2 + c_3 r^3/3 + c_4 r^4/4 + ..., its V' and its V''.

V' is the tension, V'' the stiffness.

A law is what a potential (symfpu.chain.potentials) makes of itself in the arithmetic of r:
floats, long doubles or mpf. It is the tuple (c_3, c_4, ...) of a polynomial (Eq. fpuham has c_3 =
alpha and c_4 = beta), or a named tuple of parameters with the five functions below as its own.
They take numbers and arrays alike; loops compile them through symfpu.chain.bond_loops.
"""

from __future__ import annotations

from typing import Any

Law = tuple[Any, ...]


def potential(law: Law, r: Any) -> Any:
    """V(r)."""
    closed = getattr(law, "potential", None)
    return closed(r) if closed else polynomial_potential(law, r)


def tension(law: Law, r: Any) -> Any:
    """V'(r)."""
    closed = getattr(law, "tension", None)
    return closed(r) if closed else polynomial_tension(law, r)


def stiffness(law: Law, r: Any) -> Any:
    """V''(r)."""
    closed = getattr(law, "stiffness", None)
    return closed(r) if closed else polynomial_stiffness(law, r)


def anharmonic_tension(law: Law, r: Any) -> Any:
    """V'(r) - r, without the cancellation."""
    closed = getattr(law, "anharmonic_tension", None)
    return closed(r) if closed else polynomial_anharmonic_tension(law, r)


def anharmonic_stiffness(law: Law, r: Any) -> Any:
    """V''(r) - 1, without the cancellation."""
    closed = getattr(law, "anharmonic_stiffness", None)
    return closed(r) if closed else polynomial_anharmonic_stiffness(law, r)


def cast(law: Law, kind: Any) -> Law:
    """A law with its numbers as another type of NumPy."""
    numbers = [number.astype(kind) for number in law]
    make = getattr(law, "_make", tuple)
    return make(numbers)


def polynomial_potential(law: Law, r: Any) -> Any:
    """V(r) by the coefficients (c_3, c_4, ...)."""
    last = len(law) - 1
    value = law[last] / (last + 3)
    for i in range(last - 1, -1, -1):
        value = law[i] / (i + 3) + r * value
    return r * r * (0.5 + r * value)


def polynomial_tension(law: Law, r: Any) -> Any:
    """V'(r) by the coefficients."""
    last = len(law) - 1
    value = law[last]
    for i in range(last - 1, -1, -1):
        value = law[i] + r * value
    return r * (1 + r * value)


def polynomial_stiffness(law: Law, r: Any) -> Any:
    """V''(r) by the coefficients."""
    last = len(law) - 1
    value = (last + 2) * law[last]
    for i in range(last - 1, -1, -1):
        value = (i + 2) * law[i] + r * value
    return 1 + r * value


def polynomial_anharmonic_tension(law: Law, r: Any) -> Any:
    """V'(r) - r by the coefficients."""
    last = len(law) - 1
    value = law[last]
    for i in range(last - 1, -1, -1):
        value = law[i] + r * value
    return r * r * value


def polynomial_anharmonic_stiffness(law: Law, r: Any) -> Any:
    """V''(r) - 1 by the coefficients."""
    last = len(law) - 1
    value = (last + 2) * law[last]
    for i in range(last - 1, -1, -1):
        value = (i + 2) * law[i] + r * value
    return r * value
