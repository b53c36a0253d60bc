"""The symbols of a mode: amplitude, phase, linear and chosen frequency, energy, coordinate."""

from __future__ import annotations

from typing import Any

import symengine as se

from symfpu.chain.length import HighMode


def amplitude_symbol(q: int) -> Any:
    """A_q, written A1, or A_{N-1} for a mode counted from the end."""
    return se.Symbol(f"A{_after_letter(q)}")


def phase_symbol(q: int) -> Any:
    """theta_q, written theta1 or theta_{N-1}."""
    return se.Symbol(f"theta{_after_letter(q)}")


def linear_symbol(q: int) -> Any:
    """Omega_q, written Omega_1 or Omega_{N-1}."""
    return se.Symbol(f"Omega_{_after_line(q)}")


def chosen_symbol(q: int) -> Any:
    """omega_q, written omega_1 or omega_{N-1}."""
    return se.Symbol(f"omega_{_after_line(q)}")


def energy_symbol(q: int) -> Any:
    """E_q, written E1 or E_{N-1}."""
    return se.Symbol(f"E{_after_letter(q)}")


def coordinate_symbol(q: int) -> Any:
    """Q_q, written Q_1 or Q_{N-1}."""
    return se.Symbol(f"Q_{_after_line(q)}")


def _after_letter(q: int) -> str:
    return f"_{{{q}}}" if isinstance(q, HighMode) else str(q)


def _after_line(q: int) -> str:
    return f"{{{q}}}" if isinstance(q, HighMode) else str(q)
