"""One normal frequency, by Newton's method on a small matrix.

With r orthonormal vectors W, let X solve W^T X = 1 with L(sigma) X in the span of W. Then L is
singular where the r by r matrix E(sigma) = X^T L X is, and E' = X^T L' X: as L is symmetric,
errors of X enter E by their square. A step solves (E + d E') v = 0 for d. W comes from a block,
the unknowns with the smallest divisors, which also preconditions the Krylov solutions for X: it
holds what is nearest to the mode itself, and where that does not do, all that the block nearly
annihilates. So near-resonant unknowns are treated together, as a small invariant subspace, and
what remains is well conditioned.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from symfpu.chain.projections.projection import Mask
from symfpu.normal.linearised import Linearised, Values
from symfpu.refinement.lattice import Floats

LARGEST_BLOCK, SMALLEST_BLOCK = 600, 150  # unknowns
NEARNESS = 1.0  # divisors up to so many times the largest slope belong to the block
# eigenvalues of the block up to these parts of Omega_q^2 are deflated, one try after the other
DEFLATED = (0.0, 1e-4, 0.1)
MOST_DEFLATED = 12
MIXED = (
    4  # vectors, deflated too, into which the mode is mixed most, over their eigenvalues
)
TINY = 1e-100
KRYLOV, RESTARTS = 60, 4
ROUGH, FINE = 1e-4, 1e-11  # accuracies of Krylov solutions, over Omega_q^2
ITERATIONS = 9
STEP = 1e-14  # relative change of sigma that ends the iteration
NEARLY = 1e-4  # change from which on Krylov solutions are fine
REAL = 1e-11  # imaginary parts up to this, over |sigma|, are rounding
ROUNDING = 1e-13  # of L, and what a torus in doubles makes of it, over Omega_q^2
LARGEST_ROUNDING = 1e-5  # of sigma, relative: with more it is not known
LARGEST_STEP = 0.2  # of sigma, relative, that a step may take
SURE = 0.5  # share of the main coefficient in the eigenfunction that tells the mode
# action over sigma, at least, of an elliptic direction: its conjugate has the negative one, and
# what turns as the torus does, or meets another direction, has none
LEAST_ACTION = 1e-6
# of the coupling: the first step of a continuation, and the least
FIRST_PART, LEAST_PART = 1 / 8, 1 / 512
LEAST_OVERLAP = 0.6  # of the eigenfunctions of two steps
# of those of two tori: above the root of a half, which no two directions share that are
# perpendicular
LEAST_FOLLOWED = 0.75


@dataclass(frozen=True, eq=False)
class Reduced:
    """A normal frequency with its eigenfunction.

    coefficients : p (F, C), of norm 1. share : |p_q[0]| of the mode that it is named after.
    residual : of L p, at all harmonics of the lattice, over Omega_q^2. action : sum of
    (sigma + nu.omega) |p|^2. deflated : r. products : with L. rounding : of sigma, about.
    """

    mode: int
    sigma: complex
    coefficients: Values
    share: float
    residual: float
    action: float
    deflated: int
    products: int
    rounding: float


class Block:
    """L among the unknowns with the smallest divisors, the main one first of all.

    mask : of all unknowns, shape (F, N-1). inside : places of the block's among them. sizes : how
    many they are, at least and at most.
    """

    def __init__(
        self,
        flow: Linearised,
        q: int,
        sigma: float,
        sizes: tuple[int, int] = (SMALLEST_BLOCK, LARGEST_BLOCK),
    ) -> None:
        self.flow, self.q, self.mask = flow, q, flow.allowed(q)
        linear = np.maximum(flow.linear.astype(float), TINY)
        self.size = flow.frequency(q) ** 2
        diagonal = flow.divisors(sigma) + flow.means
        weights = np.where(self.mask, np.abs(diagonal) / linear**2, np.inf)
        weights[0, flow.column(q)] = 0
        least, largest = sizes
        near = int((weights < NEARNESS * np.abs(flow.slopes).max()).sum())
        count = min(max(near, least), largest, int(self.mask.sum()))
        chosen = np.sort(np.argpartition(weights, count - 1, axis=None)[:count])
        self.rows, self.columns = np.unravel_index(chosen, self.mask.shape)
        self.inside = (np.cumsum(self.mask, axis=None) - 1)[chosen]
        self.rates = flow.rates[self.rows].astype(float)
        self.coupling = flow.block(self.rows, self.columns)

    def matrix(self, sigma: complex) -> Values:
        """L(sigma) within the block."""
        divisors = self.flow.divisors(sigma)[self.rows, self.columns]
        return np.asarray(self.coupling + np.diag(divisors))

    def guess(self, sigma: float, like: Values) -> tuple[float, Floats]:
        """Newton's method within the block, from what is likest to a vector; W of one column."""
        w = self.deflation(sigma, 0, like)
        rates, found = self.rates, sigma
        for _ in range(ITERATIONS):
            bordered = np.block([[self.matrix(found), w], [w.T, np.zeros((1, 1))]])
            right = np.append(np.zeros(len(w)), 1.0)
            x = np.linalg.solve(bordered, right)
            v, E = x[:-1], -x[-1]
            change = float(E / (v @ (2 * (found + rates) * v)))
            found += change
            if not abs(found - sigma) < 0.05 * sigma:
                return sigma, w
            if abs(change) < NEARLY**2 * sigma:
                break
        return found, (v / np.linalg.norm(v))[:, None]

    def deflation(self, sigma: float, part: float, like: Values) -> Floats:
        """Orthonormal vectors W within the block, the likest to a vector first; shape (m, r)."""
        from scipy import linalg

        values, vectors = linalg.eigh(self.matrix(sigma))
        overlaps = np.abs(like.conj() @ vectors)
        own = int(np.argmax(overlaps))
        if not part:
            return np.asarray(vectors[:, [own]])
        sizes = np.abs(values)
        nearest = np.argsort(sizes)[:MOST_DEFLATED]
        small = [i for i in nearest.tolist() if sizes[i] < part * self.size]
        mixed = np.argsort(-(overlaps**2) / np.maximum(sizes, TINY))[:MIXED].tolist()
        others = [i for i in dict.fromkeys([*mixed, *small]) if i != own]
        return np.asarray(vectors[:, [own, *others]])


class Bordered:
    """L(sigma) among what is perpendicular to W; vectors hold the unknowns of the mask."""

    def __init__(self, block: Block, W: Floats) -> None:
        self.block, self.flow, self.mask, self.W = block, block.flow, block.mask, W
        self.products = 0
        self.n = int(self.mask.sum())
        self._outside = np.setdiff1d(np.arange(self.n), block.inside)
        self._means = np.broadcast_to(self.flow.means, self.mask.shape)[self.mask]
        rates = self.flow.rates.astype(float)[:, None]
        self.rates = np.broadcast_to(rates, self.mask.shape)[self.mask]

    def take(self, sigma: complex) -> None:
        """From now on L is that of this sigma."""
        from scipy import linalg

        self._divisors = self.flow.divisors(sigma)[self.mask]
        m, r = self.W.shape
        matrix = np.zeros((m + r, m + r), dtype=self._divisors.dtype)
        matrix[:m, :m] = self.block.matrix(sigma)
        matrix[:m, m:] = self.W
        matrix[m:, :m] = self.W.T
        self._factors = linalg.lu_factor(matrix, overwrite_a=True, check_finite=False)
        diagonal = self._divisors + self._means
        diagonal[diagonal == 0] = self.block.size
        self._inverse = 1 / diagonal[self._outside]

    def multiply(self, vector: Values) -> Values:
        """L v."""
        self.products += 1
        coupled = self.flow.coupling(self.table(vector))
        return np.asarray(self._divisors * vector + coupled[self.mask])

    def table(self, vector: Values) -> Values:
        """The unknowns as coefficients (F, N-1)."""
        table = np.zeros(self.mask.shape, dtype=vector.dtype)
        table[self.mask] = vector
        return table

    def start(self) -> Floats:
        """W among all unknowns; shape (n, r)."""
        X = np.zeros((self.n, self.W.shape[1]))
        X[self.block.inside] = self.W
        return X

    def _project(self, vector: Values) -> Values:
        """Without the part in W."""
        inside = self.block.inside
        result = vector.copy()
        result[inside] -= self.W @ (self.W.T @ vector[inside])
        return result

    def _precondition(self, vector: Values) -> Values:
        """Nearly the inverse among what is perpendicular to W."""
        from scipy import linalg

        inside, (m, r) = self.block.inside, self.W.shape
        right = np.concatenate([vector[inside], np.zeros(r, dtype=vector.dtype)])
        near = linalg.lu_solve(self._factors, right, check_finite=False)
        result = np.empty(self.n, dtype=np.result_type(vector, near))
        result[inside] = near[:m]
        result[self._outside] = self._inverse * vector[self._outside]
        return result

    def improved(self, X: Values, accuracy: float) -> tuple[Values, Values]:
        """X that solves to the accuracy, over Omega_q^2, and L X."""
        real = not np.iscomplexobj(self._divisors)
        # of a real sigma X is real: its part in W is 1
        X = X.real.copy() if real else X.astype(complex)
        images = np.empty_like(X)
        for k in range(X.shape[1]):
            image = self.multiply(X[:, k])
            left = -self._project(image)
            goal = accuracy * self.block.size / float(np.linalg.norm(left))
            if goal < 1:
                X[:, k] += self._solution(left, goal)
                image = self.multiply(X[:, k])
            images[:, k] = image
        return X, images

    def _solution(self, right: Values, accuracy: float) -> Values:
        from scipy.sparse.linalg import LinearOperator, gmres

        def product(vector: Values) -> Values:
            return self._project(self.multiply(self._precondition(vector)))

        operator = LinearOperator((self.n, self.n), matvec=product, dtype=right.dtype)
        limits = {"rtol": accuracy, "atol": 0.0, "restart": KRYLOV, "maxiter": RESTARTS}
        found, _ = gmres(operator, right, **limits)
        return self._precondition(found)


def reduced(flow: Linearised, q: int, guess: float) -> Reduced | None:
    """The normal mode that continues the linear mode q; None where no way leads to one.

    guess : of its frequency, in real numbers.
    """
    for part in DEFLATED:
        found = _found(flow, _Aim(q, guess, flow.column(q)), part)
        if found and found.share > SURE:
            return found
    return continued(flow, q)


def followed(flow: Linearised, q: int, sigma: complex, like: Values) -> Reduced | None:
    """The one that continues that of a torus nearby; None where it cannot be told.

    sigma : a guess. like : its eigenfunction there, at the harmonics of this flow. Through an
    onset, where two solutions become one, the sign of the action tells them apart.
    """
    aim = _Aim(q, sigma, flow.column(q), like)
    hyperbolic = bool(complex(sigma).imag)
    for part in DEFLATED[1:] if hyperbolic else DEFLATED:
        found = _found(flow, aim, part)
        if found and aim.overlap(found) > LEAST_FOLLOWED:
            return found
    return None


def continued(flow: Linearised, q: int) -> Reduced | None:
    """The same from no coupling to the whole one, step by step; each begins with the last."""
    aim = _Aim(q, flow.frequency(q), flow.column(q))
    part, step = 0.0, FIRST_PART
    last: Reduced | None = None
    while part < 1:
        step = min(step, 1 - part)
        found = _found(flow.scaled(part + step), aim, DEFLATED[-1])
        if found is None or aim.overlap(found) < LEAST_OVERLAP:
            step /= 2
            if step < LEAST_PART:
                return None
            continue
        part, last = part + step, found
        aim = _Aim(q, found.sigma, flow.column(q), found.coefficients)
        step *= 1.5
    return last


class _Aim:
    """What is looked for: a mode near a frequency, most like a function."""

    def __init__(
        self, q: int, sigma: complex, column: int, like: Values | None = None
    ) -> None:
        self.q, self.sigma, self._column, self._like = q, sigma, column, like

    def vector(self, mask: Mask) -> Values:
        """The function as a vector of the unknowns, of norm 1."""
        if self._like is not None:
            return np.asarray(self._like[mask])
        table = np.zeros(mask.shape)
        table[0, self._column] = 1
        return table[mask]

    def overlap(self, found: Reduced) -> float:
        """Of what was found with the function."""
        if self._like is None:
            return found.share
        return float(abs(np.vdot(self._like, found.coefficients)))


def _found(flow: Linearised, aim: _Aim, part: float) -> Reduced | None:
    """With a part of the block deflated; None where Newton's method does not converge.

    And where it leads to a conjugate, nu.omega - sigma of an elliptic direction.
    """
    sigma, near = aim.sigma, float(complex(aim.sigma).real)
    block = Block(flow, aim.q, near)
    like = aim.vector(block.mask)
    inside = like[block.inside]
    if part:
        W = block.deflation(near, part, inside)
    else:
        sigma, W = block.guess(near, inside)
    found = _iterated(Bordered(block, W), sigma, like)
    return None if found and _is_conjugate(found) else found


def _is_conjugate(found: Reduced) -> bool:
    """Whether it is elliptic and turns backwards, which none does at rest."""
    turns = not complex(found.sigma).imag
    return turns and found.action < -LEAST_ACTION * found.sigma.real


def _iterated(system: Bordered, guess: complex, like: Values) -> Reduced | None:
    """Newton's method from a guess to what is most like a vector."""
    sigma, size = guess, abs(guess)
    X: Values = system.start()
    accuracy = ROUGH
    for step in range(ITERATIONS):
        system.take(sigma)
        fine = accuracy == FINE
        X, images = system.improved(X, accuracy)
        slope = -2 * (sigma + system.rates)
        steps, vectors = steps_of(X.T @ images, X.T @ (slope[:, None] * X))
        shares = np.where(
            _of_this_sign(steps, X @ vectors, sigma, system), shares_of(X, vectors, like), 0
        )
        at = _nearest(steps, shares, first=step == 0)
        change, v = steps[at], vectors[:, at]
        if not np.isfinite(change) or abs(change) > LARGEST_STEP * size:
            return None
        sigma = _tidied(sigma + complex(change))
        vector = X @ v
        rounding = _rounding(system, vector, slope)
        if fine and abs(change) < max(STEP * size, rounding):
            if rounding > LARGEST_ROUNDING * size:
                return None
            image = images @ v + change * slope * vector
            return _result(system, sigma, vector, image, rounding)
        accuracy = FINE if abs(change) < NEARLY * size else ROUGH
    return None


def steps_of(E: Values, slope: Values) -> tuple[Values, Values]:
    """All d and v with (E + d E') v = 0, v of norm 1."""
    from scipy import linalg

    steps, vectors = linalg.eig(-E, slope)
    return steps, vectors / np.linalg.norm(vectors, axis=0)


def shares_of(X: Values, vectors: Values, like: Values) -> Floats:
    """How much of a vector is in p = X v, for each v."""
    gram = X.conj().T @ X
    norms = np.sqrt(np.einsum("ri,rs,si->i", vectors.conj(), gram, vectors).real)
    return np.asarray(np.abs((like.conj() @ X) @ vectors) / norms)


def _of_this_sign(steps: Values, p: Values, sigma: complex, system: Bordered) -> Mask:
    """Which of some solutions p (n, r) are hyperbolic, or turn forwards; all, if none does."""
    weights = np.abs(p) ** 2
    rates = complex(sigma).real + system.rates
    actions = rates @ weights / weights.sum(axis=0)
    forwards = actions > LEAST_ACTION * abs(sigma)
    chosen = forwards | (steps.imag != 0)
    return np.asarray(chosen if chosen.any() else ~chosen)


def _nearest(steps: Values, shares: Floats, *, first: bool) -> int:
    """The one that is most alike, then the nearest; of a conjugate pair the growing one."""
    if first:
        falling = steps.imag < 0
        return int(np.argmax(np.where(falling, 0.999, 1.0) * shares))
    candidates = shares > 0.5 * shares.max()
    return int(np.argmin(np.where(candidates, np.abs(steps), np.inf)))


def _rounding(system: Bordered, vector: Values, slope: Values) -> float:
    """What rounding of L makes of sigma: its part in p^T L p over p^T L' p.

    That vanishes where two directions collide.
    """
    weights = vector**2 / np.linalg.norm(vector) ** 2
    by_sigma = float(abs(slope @ weights))
    return max(ROUNDING * system.block.size / max(by_sigma, TINY), REAL)


def _tidied(sigma: complex) -> complex:
    """As a float where the imaginary part is rounding."""
    sigma = complex(sigma)
    return sigma if abs(sigma.imag) > REAL * abs(sigma) else float(sigma.real)


def _result(
    system: Bordered, sigma: complex, vector: Values, image: Values, rounding: float
) -> Reduced:
    size = float(np.linalg.norm(vector))
    p = system.table(vector / size)
    main = p[0, system.flow.column(system.block.q)]
    p = p / _phase(main)
    if complex(sigma).imag < 0:
        sigma, p = complex(sigma).conjugate(), p.conj()
    inside = float(np.linalg.norm(image)) / size
    outside = system.flow.left_out(p)
    weights = np.abs(vector / size) ** 2
    action = float(((complex(sigma).real + system.rates) * weights).sum())
    return Reduced(
        mode=system.block.q,
        sigma=sigma,
        coefficients=p,
        share=float(abs(main)),
        residual=float(np.hypot(inside, outside)) / system.block.size,
        action=action,
        deflated=system.W.shape[1],
        products=system.products,
        rounding=rounding,
    )


def _phase(value: complex) -> complex:
    """The factor of modulus 1 that makes the main coefficient positive."""
    return value / abs(value) if value else 1.0
