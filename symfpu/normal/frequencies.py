"""Normal frequencies alone, without the eigenfunctions: what a member of a family carries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from symfpu.normal.modes import NoNormalModes, NormalModes, sigma_entry
from symfpu.normal.resonances import LOCKED, ParametricResonance
from symfpu.normal.torus import LENGTH, resonances_near
from symfpu.results.numbers import fifteen_digits
from symfpu.tori.torus import Torus

KEPT_RESONANCES = 10  # the nearest


@dataclass(frozen=True, eq=False)
class NormalFrequencies:
    """Normal frequencies of a torus: `NormalModes` without the eigenfunctions. Ours.

    torus : the torus. frequencies : sigma by mode, floats, or complex with positive imaginary
        parts; dimensionless. signatures : Krein's by mode, 0 if hyperbolic.
    residual : the largest of all modes. resonances : the nearest, by distance.
    missing : by mode, why it could not be told from others.

    >>> from symfpu import Chain, family
    >>> found = family(Chain(N=4, beta=1), (2,), "0.02", from_energy="0.01", normal=True)
    >>> found.members[0].normal
    NormalFrequencies(stable, sigma_1=0.7..., sigma_3=1.8..., residual ...)
    """

    torus: Torus = field(repr=False)
    frequencies: Mapping[int, float | complex]
    signatures: Mapping[int, int]
    residual: float
    resonances: tuple[ParametricResonance, ...] = field(repr=False)
    missing: Mapping[int, str] = field(default_factory=dict)

    def entry(self) -> dict[str, Any]:
        """For the record of a member of a family."""
        return {
            "verdict": self.verdict,
            "stable": self.stable,
            "growth": fifteen_digits(self.growth),
            "normal_frequencies": {
                str(q): sigma_entry(w) for q, w in self.frequencies.items()
            },
            "signatures": {str(q): n for q, n in self.signatures.items()},
            "residual": fifteen_digits(self.residual),
            "missing": {str(q): why for q, why in self.missing.items()},
        }

    def __repr__(self) -> str:
        known = "".join(f", sigma_{q}={_text(w)}" for q, w in self.frequencies.items())
        missing = "".join(f", no sigma_{q}" for q in self.missing)
        return f"NormalFrequencies({self.verdict}{known}{missing}, residual {self.residual:.1g})"

    @property
    def growth(self) -> float:
        """The largest rate of growth; exactly 0 if all that are known are elliptic."""
        return max((abs(complex(w).imag) for w in self.frequencies.values()), default=0.0)

    @property
    def stable(self) -> bool:
        """Whether all modes are known and elliptic."""
        return self.growth == 0 and not self.missing

    @property
    def verdict(self) -> str:
        """In words."""
        if self.growth:
            unstable = (q for q, w in self.frequencies.items() if complex(w).imag)
            return (
                f"unstable: modes {', '.join(map(str, unstable))}, growth {self.growth:.7g}"
            )
        return "undecided" if self.missing else "stable"


def _text(sigma: complex) -> str:
    value = complex(sigma)
    unreal = f" +- {abs(value.imag):.7g}i" if value.imag else ""
    return f"{value.real:.10g}{unreal}"


def frequencies_of(
    found: NormalModes, missing: Mapping[int, NoNormalModes]
) -> NormalFrequencies:
    """Those of normal modes that were found; missing : why others were not."""
    return NormalFrequencies(
        torus=found.torus,
        frequencies=found.frequencies,
        signatures={mode.mode: mode.signature for mode in found.modes},
        residual=found.residual,
        resonances=_nearest(found.resonances),
        missing={q: str(none) for q, none in missing.items()},
    )


def frequencies_again(
    torus: Torus, frequencies: Mapping[int, complex], **known: Any
) -> NormalFrequencies:
    """Those of a record, whose resonances follow from them."""
    real = {q: complex(w).real for q, w in frequencies.items()}
    nearest = _nearest(resonances_near(torus, real, LENGTH))
    return NormalFrequencies(torus, frequencies, resonances=nearest, **known)


def _nearest(resonances: Sequence[ParametricResonance]) -> tuple[ParametricResonance, ...]:
    """All to which directions are locked, and those up to the most that are kept."""
    locked = sum(abs(one.distance) < LOCKED for one in resonances)
    return tuple(resonances[: max(locked, KEPT_RESONANCES)])
