"""Floquet multipliers of a q-breather: its tangent map over a period, and its stability.

The orbit is even in time, and R = diag(1, -1) on (Q, P) reverses time, on a ring in coordinates of
its own (symfpu.breathers.paths): half a period gives
M = R H^-1 R H with the symplectic inverse of H = [[A, B], [C, D]]. Then M = [[a, b], [c, a^T]] with
a = 1 + 2 B^T C, and M + M^-1 = diag(2a, 2a^T): the multipliers come in pairs with
lambda + 1/lambda = 2 + 4 kappa, kappa an eigenvalue of B^T C. The pair at 1, a Jordan block of M,
is a simple kappa = 0 whose left eigenvector is the acceleration at t = 0, B f = 0. So every pair
is exactly reciprocal, and the double 1 costs no digits.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.paths import PeriodicPath, path_of
from symfpu.chain import bonds
from symfpu.dynamics.scheme import Scheme
from symfpu.dynamics.schemes import particle_scheme
from symfpu.dynamics.tangent import tangent_map_along
from symfpu.numbers.public import public
from symfpu.numbers.typed import decimal
from symfpu.results.attributes import attributes
from symfpu.results.field import (
    Field,
    chain_fields,
    exact_by_seed,
    listed,
    seeds_field,
    shown_number,
)
from symfpu.results.grid import Grid, Variable
from symfpu.results.numbers import fifteen_digits
from symfpu.results.result import Gridded
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
ACCURACY = 1e-12  # of the tangent map, relative to its largest entry
# over the square root of the largest stiffness of a bond; with it halved the error is about 1e-12
FIRST_STEP = 0.1
DOUBLINGS = 5
SAFETY = 8  # times the error that a kappa may have: what it may be off the circle
TRIVIAL, ELLIPTIC = "trivial", "on the circle"
TANGENT, DOUBLING, QUADRUPLE = "real > 0", "real < 0", "complex quadruple"


@dataclass(frozen=True, eq=False)
class Floquet(Gridded):
    """Multipliers of a periodic orbit; dimensionless.

    Made by `floquet`. Ours.

    orbit : the orbit.
    pairs : (lambda, 1/lambda), |lambda| >= 1, shape (N-1, 2), the trivial pair (1, 1) first, then
        by falling size and growing angle.
    kinds : of every pair: "trivial", "on the circle", "real > 0" (tangent bifurcation at +1),
        "real < 0" (period doubling at -1), "complex quadruple" (Krein collision; two pairs make
        one quadruple).
    kappa : (lambda + 1/lambda - 2)/4; tolerance : how far each may be off because of the errors
        of map and orbit; both (N-1,).
    monodromy : M in modes, rows and columns Q_1 .., P_1 ..; shape (2(N-1), 2(N-1)). On a ring by
        real waves: q > 0 the cosine, -q the sine, normalised.
    symplecticity : largest entry of M^T J M - J. map_error : estimated error of the half-period
        map.
    trivial_error : by how much the trivial pair of the computed map misses kappa = 0.

    >>> import symfpu
    >>> import symfpu
    >>> from symfpu import Chain
    >>> floquet(symfpu.torus(Chain(N=4, beta=1), (2,), frequencies=("1.4168",)))
    Floquet(N=4, beta=1, seed 2, omega=1.4168, stable, largest |multiplier| 1,
    symplecticity error ...)
    >>> orbit = symfpu.torus(Chain(N=4, beta=1), (2,), frequencies=("1.4168",))
    >>> floquet(orbit).to_frame()[["pair", "kind"]]
       pair           kind
    0     0        trivial
    1     1  on the circle
    2     2  on the circle
    """

    orbit: Torus
    pairs: NDArray[np.complex128] = field(repr=False)
    kinds: tuple[str, ...]
    kappa: NDArray[np.complex128] = field(repr=False)
    tolerance: Floats = field(repr=False)
    monodromy: Floats = field(repr=False)
    symplecticity: float
    map_error: float
    trivial_error: float

    def _answer(self) -> str:
        return "stable" if self.stable else "unstable"

    def _fields(self) -> Iterator[Field]:
        yield from chain_fields(self.orbit.chain)
        yield seeds_field(self.orbit.seeds)
        yield Field("frequencies", exact_by_seed(self.orbit.omega))
        yield Field("verdict", self.verdict)
        yield from self.multiplier_fields()
        yield Field("symplecticity", fifteen_digits(self.symplecticity))
        yield Field("map_error", fifteen_digits(self.map_error))

    def _lines(self, width: int | None) -> Iterator[str]:
        yield repr(self)
        yield self.multiplier_line

    @property
    def multiplier_line(self) -> str:
        """Whether the orbit is stable, by the largest multiplier, for a reader."""
        kinds = listed(f"{count} {kind}" for kind, count in self.instabilities.items())
        verdict = "stable" if self.stable else f"unstable: {kinds}"
        largest = f"the largest |multiplier| {self.largest:.12g}"
        return f"multipliers        {verdict}, {largest}"

    def multiplier_fields(self) -> Iterator[Field]:
        """Without the orbit; every multiplier as its real and imaginary part."""
        parts = [[repr(float(x.real)), repr(float(x.imag))] for x in self.multipliers]
        yield Field("multipliers", parts)
        yield Field("stable", self.stable)
        kinds = listed(f"{count} {kind}" for kind, count in self.instabilities.items())
        label = "unstable" if kinds else ""
        yield Field("instabilities", self.instabilities, label, kinds)
        largest = fifteen_digits(self.largest)
        shown = shown_number(self.largest)
        yield Field("largest_multiplier", largest, "largest |multiplier|", shown)

    def __repr__(self) -> str:
        chain = self.orbit.chain.label
        which = f"seed {self.orbit.seed}, omega={decimal(self.orbit.frequency)}"
        largest = f"largest |multiplier| {self.largest:.12g}"
        quality = f"symplecticity error {self.symplecticity:.1g}"
        return f"Floquet({chain}, {which}, {self.verdict}, {largest}, {quality})"

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """All 2(N-1) multipliers, pair after pair."""
        return self.pairs.reshape(-1)

    @property
    def stable(self) -> bool:
        """Every multiplier on the unit circle, as far as the errors allow to tell."""
        return not self.instabilities

    @property
    def verdict(self) -> str:
        """'stable', or 'unstable' with the number of unstable pairs by kind."""
        kinds = ", ".join(f"{n} {kind}" for kind, n in self.instabilities.items())
        return f"unstable: {kinds}" if kinds else "stable"

    @property
    def instabilities(self) -> dict[str, int]:
        """Number of unstable pairs, or of quadruples, by kind; empty if stable."""
        counts = Counter(kind for kind in self.kinds if kind not in (TRIVIAL, ELLIPTIC))
        if QUADRUPLE in counts:
            counts[QUADRUPLE] //= 2
        return dict(counts)

    @property
    def largest(self) -> float:
        """Largest |multiplier|; exactly 1 if stable."""
        return 1.0 if self.stable else float(np.max(np.abs(self.pairs)))

    def _grid(self) -> Grid:
        orbit, rows = self.orbit, ("pair",)
        each = [f"{letter}_{q}" for letter in "QP" for q in orbit.chain.mode_numbers]
        return Grid(
            axes={"pair": range(len(self.pairs)), "after": each, "before": each},
            variables={
                "multiplier": Variable(
                    rows, self.pairs[:, 0], "lambda, of modulus 1 or more"
                ),
                "reciprocal": Variable(rows, self.pairs[:, 1], "1 / lambda"),
                "kind": Variable(rows, self.kinds, "where the pair lies"),
                "kappa": Variable(rows, self.kappa, "(lambda + 1/lambda - 2)/4"),
                "tolerance": Variable(rows, self.tolerance, "error that kappa may have"),
                "monodromy": Variable(
                    ("after", "before"), self.monodromy, "map of a period"
                ),
            },
            attributes=attributes(
                self,
                orbit.chain,
                seeds=orbit.seeds,
                frequencies=orbit.frequencies,
                stable=self.stable,
                largest=self.largest,
                map_error=self.map_error,
            ),
            rows=rows,
        )


def monodromy(orbit: Torus, *, scheme: str = "kahan_li8") -> Floats:
    """Tangent map over one period in mode coordinates and momenta, from a state at rest.

    scheme : of the integrator, on T + V. Returns shape (2(N-1), 2(N-1)). Raises InputError.
    """
    path = path_of(orbit)
    half, _ = _half(path, particle_scheme(scheme))
    return _in_modes(path, _whole(half))


@public
def floquet(orbit: Torus, *, scheme: str = "kahan_li8") -> Floquet:
    """Floquet multipliers and stability of a periodic orbit.

    orbit : a solution of one angle, from `torus`, `refine` or others, on a ring also
        from `unfold`; dimensionless. Of a truncated series, multipliers are
        as good as the orbit is.
    scheme : of the integrator, on T + V; with one of lower order errors and tolerances are larger.

    The linearised equations of motion (of Eq. eqmo) over half a period, by the symmetry in time;
    ours. A kappa counts as on the circle if it is real and in -1 .. 0 up to `tolerance`, which is
    SAFETY times its error to first order. Of eigenvectors l and r that is the error of the map
    times |B l| + |C r|, over |l . r|: next to the trivial pair both are small. Raises InputError.

    >>> import symfpu
    >>> from symfpu.chain.chain import Chain
    >>> floquet(symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.1"})).stable
    True
    """
    from scipy.linalg import eig

    path = path_of(orbit)
    half, map_error = _half(path, particle_scheme(scheme))
    n, whole = len(half) // 2, _whole(half)
    B, C = half[:n, n:], half[n:, :n]
    # the velocity, then an orthonormal basis of what is perpendicular to it
    _, _, basis = np.linalg.svd(path.flow[None, :])
    flow, rest = basis.T[:, 0], basis.T[:, 1:]
    trivial = float(np.linalg.norm(C.T @ (B @ flow)))
    sizes = [float(np.linalg.norm(block, 2)) for block in (B, C)]
    error = map_error * sum(sizes) + trivial
    kappa, left, right = eig(rest.T @ B.T @ C @ rest, left=True)
    tilts = np.linalg.norm(B @ rest @ left, axis=0) + np.linalg.norm(
        C @ rest @ right, axis=0
    )
    rounding = float(np.finfo(float).eps) * sizes[0] * sizes[1]
    errors = map_error * tilts + trivial + rounding
    cosines = np.abs(np.einsum("ij,ij->j", left.conj(), right))
    tolerance = SAFETY * errors / np.maximum(cosines, np.finfo(float).tiny)
    kinds = [_kind(k, t) for k, t in zip(kappa, tolerance, strict=True)]
    pairs = np.array(
        [_pair(k, kind) for k, kind in zip(kappa, kinds, strict=True)]
    ).reshape(-1, 2)
    larger = pairs[:, 0]
    order = np.lexsort((np.angle(larger), -np.abs(larger).round(12)))
    return Floquet(
        orbit=orbit,
        pairs=np.vstack([[[1.0, 1.0]], pairs[order]]),
        kinds=(TRIVIAL, *(kinds[i] for i in order)),
        kappa=np.append(0.0, kappa[order]),
        tolerance=np.append(SAFETY * error, tolerance[order]),
        monodromy=_in_modes(path, whole),
        symplecticity=_symplecticity_error(whole),
        map_error=map_error,
        trivial_error=trivial,
    )


def _symplecticity_error(M: Floats) -> float:
    """Largest entry of M^T J M - J."""
    n = len(M) // 2
    zero, one = np.zeros((n, n)), np.eye(n)
    J = np.block([[zero, one], [-one, zero]])
    return float(np.max(np.abs(M.T @ J @ M - J)))


def _half(path: PeriodicPath, scheme: Scheme) -> tuple[Floats, float]:
    """The tangent map over half a period and its estimated error, in the spectral norm."""
    chain, stretches = path.chain, path.stretches
    duration = np.pi / path.omega
    r = stretches(np.linspace(0, duration, 2 * path.harmonics))
    stiffest = float(np.max(np.abs(bonds.stiffness(chain.law(), r))))
    steps = int(np.ceil(duration * np.sqrt(stiffest) / FIRST_STEP))
    coarse = tangent_map_along(chain, stretches, duration, steps, scheme=scheme)
    for _ in range(DOUBLINGS):
        steps *= 2
        fine = tangent_map_along(chain, stretches, duration, steps, scheme=scheme)
        error = float(np.linalg.norm(fine - coarse, 2)) / (2**scheme.order - 1)
        if error <= ACCURACY * max(1.0, float(np.max(np.abs(fine)))):
            break
        coarse = fine
    rounding = float(np.finfo(float).eps * np.linalg.norm(fine, 2))
    if path.frame is not None:
        fine = path.frame @ fine @ path.frame.T
    return fine, error + np.sqrt(steps) * rounding


def _in_modes(path: PeriodicPath, M: Floats) -> Floats:
    """A map back in the coordinates of the modes."""
    return M if path.frame is None else path.frame.T @ M @ path.frame


def _whole(half: Floats) -> Floats:
    """R H^-1 R H with the symplectic inverse."""
    n = len(half) // 2
    upper, lower = half[:n], half[n:]
    A, B = upper[:, :n], upper[:, n:]
    C, D = lower[:, :n], lower[:, n:]
    reversed_half = np.block([[D.T, B.T], [C.T, A.T]])  # R H^-1 R
    return reversed_half @ half


def _kind(kappa: complex, tolerance: float) -> str:
    if abs(kappa.imag) > tolerance:
        return QUADRUPLE
    if kappa.real > tolerance:
        return TANGENT
    return DOUBLING if kappa.real < -1 - tolerance else ELLIPTIC


def _pair(kappa: complex, kind: str) -> tuple[complex, complex]:
    """(lambda, 1/lambda) of lambda + 1/lambda = 2 + 4 kappa, with |lambda| >= 1.

    On the circle they are exp(+-i angle).
    """
    if kind == ELLIPTIC:
        angle = 2 * np.arcsin(np.sqrt(np.clip(-kappa.real, 0.0, 1.0)))
        x, y = np.cos(angle), np.sin(angle)
        return complex(x, y), complex(x, -y)
    if kind != QUADRUPLE:
        kappa = complex(kappa.real, 0.0)
    root = np.sqrt(kappa + 1 + 0j) + np.sqrt(kappa + 0j)
    root = root if abs(root) >= 1 else 1 / root
    value = complex(root**2)
    if kind != QUADRUPLE:
        value = complex(value.real, 0.0)
    return value, 1 / value
