"""Independent checker of propagation certificates: mode space, the tensors B and C summed directly,
Python integers only.

m = (p_1, n_1, ..) are the exponents of w_i = Omega_i z_i and conj w_i, nu = p - n, u_q = Omega_q
Q_q, S = sum B u u or sum C u u u (Eqs. moda, modb):

    u_q^(k)[m] = L_q(nu) (sum_n W_q^(n) u_q^(k-n) - S_q^(k))[m],    W_q^(n)[f] = S_q^(n)[f w_q].

Certificates of version 2 are of other potentials, V' = r + c_3 r^2 + c_4 r^3 + ..., whose
coefficients they name. S then is the sum of g_n T u^n over the powers n, T counting signs as B and
C do, with the g_n of `read_potential`.

A coefficient that is not 0 modulo p proves a mode excited for generic frequencies; with symbols
for the L_q(nu), a polynomial that is 0 proves a zero. Written to be audited: one claim a
function, in the order in which `verify` calls them. The file shares no code with the prover and
imports nothing but the standard library and what checkers read with, `reading.py`.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from itertools import combinations_with_replacement, product
from math import factorial
from operator import mul, sub
from pathlib import Path
from typing import Any, NamedTuple

from symfpu.proofs.reading import (
    EXACT,
    Json,
    check_digest,
    need,
    outside_strings,
    parsed,
    text_of,
    verified,
)

MOST_VALUES = 10**6
MOST_STEPS = 2 * 10**6
MOST_SEEDS = 64
MOST_POINTS = 256
LARGEST_N = 4096
LONGEST_COEFFICIENTS = 10**5  # characters, the longest times the order
MODELS: dict[str, tuple[int, dict[int, Any]]] = {"alpha": (1, {2: 1}), "beta": (2, {3: 1})}
NAMED = re.compile(
    r"([a-z_]+):(-?[0-9.]+(?:/[1-9][0-9]*)?(?:,-?[0-9.]+(?:/[1-9][0-9]*)?)*)"
)
# above 0, up to 1
PROBABILITY = re.compile(
    r"1(\.0+)?(e[+-]?0+)?|0\.0*[1-9][0-9]*|[1-9](\.[0-9]+)?e-0*[1-9][0-9]*"
)
# with these Miller-Rabin is a proof below 3.3e24
BASES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41)

Monomial = tuple[int, ...]
Polynomial = dict[
    tuple[Any, ...], int
]  # sorted symbols -> coefficient; a residue is a constant
ByMode = dict[int, Polynomial]


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file.

    Raises CertificateError, with the reason, if it is not right.
    """
    return verified(path, read_certificate, check_certificate)[1]


# --- the file


def read_certificate(path: Path) -> Json:
    """The contents of a file, its size bounded first.

    As neither floats nor booleans nor minus signs are let in, == and < are exact afterwards.
    """
    text = text_of(path)
    bare = outside_strings(text)
    values = sum(map(bare.count, ',[{"'))
    need(values <= MOST_VALUES, "the file has more than 10^6 values")
    strange = re.search(r'[^\s0-9{}\[\],:nul"]|[0-9]{21}', bare)
    need(not strange, "not JSON of plain strings, null and integers of at most 20 digits")
    data = parsed(text)
    check_header(data)
    check_digest(data)
    check_keys(data, bare.count(":"))
    return data


def check_header(data: Json) -> None:
    """It is a certificate of this kind, of the version that this checker knows."""
    need(
        data["format"] == "symfpu propagation certificate", "not a propagation certificate"
    )
    schema = data["schema"]
    need(
        schema in (1, 2),
        f"schema version {schema!r:.40} is unknown: this checker supports versions 1, 2",
    )


def check_keys(data: Json, colons: int) -> None:
    """No key is missing, unknown or there twice: those we read are as many as the file has."""
    of_three = data["exceptions"] + data["undecided"] + data["points"] + data["vanishing"]
    of_five = data["excited"]
    expected = 13 + 2 * data["schema"] + 3 * len(of_three) + 5 * len(of_five)
    need(colons == expected, "a key is missing, unknown or there twice")


# --- the case


class Case(NamedTuple):
    """N, the last order, the seeds, how much the degree in the amplitudes grows with the order,
    and the force: g_n by power n, where that is not zero.
    """

    N: int
    order: int
    seeds: list[int]
    step: int
    force: Mapping[int, Any]

    def degree(self, k: int) -> int:
        """Of order k in the amplitudes."""
        return 1 + k * self.step

    def added(self, n: int) -> int:
        """How much a product of n factors adds to the sum of their orders."""
        return (n - 1) // self.step


def read_case(data: Json) -> Case:
    """The chain and its seeds, their sizes bounded."""
    N, order, seeds = data["N"], data["order"], data["seeds"]
    fits = 1 < N <= LARGEST_N and max(1000, N) * order <= 10**6
    need(fits, "wrong N, order or model")
    modes = sorted({q for q in seeds if 0 < q < N})
    need(seeds == modes[:MOST_SEEDS] != [], "seeds are not 1 to 64 ascending modes")
    if data["schema"] == 1:
        need(data["model"] in MODELS, "wrong N, order or model")
        return Case(N, order, seeds, *MODELS[data["model"]])
    return Case(N, order, seeds, *read_potential(data, order))


def read_potential(data: Json, order: int) -> tuple[int, dict[int, Any]]:
    """The step of the degree, and g_n = c_(n+1) / unit^((n-1)/step), the unit being the first of
    the coefficients c_(2 + step), c_(2 + 2 step), ..., or 1 where that is zero.
    """
    step, texts = data["step"], data["coefficients"]
    need(step in (1, 2) and len(texts) == step * order, "step or number of coefficients")
    longest = max(map(len, texts), default=0)
    readable = all(map(EXACT.fullmatch, texts)) and longest * order <= LONGEST_COEFFICIENTS
    need(readable, "coefficients are no fractions, or too long")
    coefficients = list(map(Fraction, texts))  # c_3, c_4, ...
    check_name(data["potential"], coefficients)
    need(step == 1 or not any(coefficients[::2]), "step 2, and a coefficient of odd n")
    ordered = coefficients[step - 1 :: step]
    unit = ordered[0] if ordered and ordered[0] else Fraction(1)
    force = {1 + step * k: Fraction(c, unit**k) for k, c in enumerate(ordered, 1) if c}
    return step, force


def check_name(name: str, coefficients: list[Fraction]) -> None:
    """The coefficients are those of the potential named, if it is one of NAMED_POTENTIALS."""
    need(type(name) is str and "\n" not in name, "the potential has no name")
    if is_known(name):
        kind, numbers = parts_of(name)
        for n, c in enumerate(coefficients, 3):
            need(
                c == NAMED_POTENTIALS[kind](n, *numbers), f"c_{n} is not that of {name:.80}"
            )


def is_known(name: str) -> bool:
    """Whether the checker knows the coefficients of a potential of this name by itself."""
    return name.partition(":")[0] in NAMED_POTENTIALS


def parts_of(name: str) -> tuple[str, list[Fraction]]:
    """The kind and the numbers of a name such as toda:1/2."""
    found = NAMED.fullmatch(name)
    need(
        found and len(name) <= LONGEST_COEFFICIENTS,
        "the potential is not named as kind:p,q",
    )
    assert found is not None
    return found[1], [Fraction(number) for number in found[2].split(",")]


def of_polynomial(n: int, *coefficients: Fraction) -> Fraction:
    """c_n as it stands in the name."""
    return coefficients[n - 3] if n - 3 < len(coefficients) else Fraction(0)


def of_toda(n: int, a: Fraction) -> Fraction:
    """V = (e^(2ar) - 1 - 2ar)/(4a^2)."""
    return Fraction((2 * a) ** (n - 2), factorial(n - 1))


def of_lennard_jones(n: int, p: Fraction, q: Fraction) -> Fraction:
    """V = [((1+r)^-p - 1)/p - ((1+r)^-q - 1)/q]/(p - q)."""
    steep, flat = Fraction(binomial(-p, n), p), Fraction(binomial(-q, n), q)
    return Fraction(n * (steep - flat), p - q)


def binomial(power: Fraction, n: int) -> Fraction:
    """The coefficient of r^n in (1 + r)^power."""
    value = Fraction(1)
    for i in range(n):
        value *= Fraction(power - i, i + 1)
    return value


NAMED_POTENTIALS: dict[str, Any] = {
    "polynomial": of_polynomial,
    "toda": of_toda,
    "lennard_jones": of_lennard_jones,
}


class Budget:
    """Counts steps, and refuses a certificate that would take too many."""

    def __init__(self) -> None:
        self.steps = 0

    def counted(self, items: Iterable[Any]) -> Iterator[Any]:
        """The items, each a step."""
        for item in items:
            self.steps += 1
            need(
                self.steps <= MOST_STEPS, "checking it would take more than 2 million steps"
            )
            yield item


def couplings(N: int, *modes: int) -> list[tuple[int, int]]:
    """Each q with B_qlm, C_qlmn or their like, where that is not zero: Eq. transa, with all the
    signed sums, + for those that make 0 modulo 4N with q and - for those that make 2N.
    """
    sums = signed_sums(N, modes)
    found = []
    for q in {-total % (2 * N) for total in sums}:
        value = sums[-q % (4 * N)] - sums[(2 * N - q) % (4 * N)]
        if value and 0 < q < N:
            found.append((q, value))
    return found


def signed_sums(N: int, modes: tuple[int, ...]) -> Counter[int]:
    """How many choices of signs give each sum of the modes, modulo 4N."""
    sums = Counter({0: 1})
    for l in modes:
        longer: Counter[int] = Counter()
        for total, count in sums.items():
            longer[(total + l) % (4 * N)] += count
            longer[(total - l) % (4 * N)] += count
        sums = longer
    return sums


# --- the recursion


class Point(NamedTuple):
    """A prime, an element of order 4N and frequencies modulo it.

    Prime 0 stands for symbols instead of residues.
    """

    prime: int
    root: int
    frequencies: list[int]


SYMBOLS = Point(0, 0, [])


class Recursion:
    """Coefficients u_q[m] at a point, each computed where it is first asked for."""

    def __init__(self, case: Case, point: Point, budget: Budget) -> None:
        self.case, self.point, self.budget = case, point, budget
        self.known: dict[Monomial, tuple[ByMode, ByMode]] = {}

    def coefficients(self, m: Monomial) -> ByMode:
        """u_q[m] by mode, zeros left out."""
        return self.term(m)[0]

    def term(self, m: Monomial) -> tuple[ByMode, ByMode]:
        """By mode, u[m] and its bracket, which is -W at the harmonic of a seed itself."""
        degree = sum(m)
        if degree == 1:
            seed = self.case.seeds[m.index(1) // 2]
            return {seed: {(): 1}}, {}
        if degree < 1 or (degree - 1) % self.case.step:
            return {}, {}
        if m not in self.known:
            self.known[m] = {}, {}
            self.fill(m, *self.known[m])
        return self.known[m]

    def fill(self, m: Monomial, u: ByMode, bracket: ByMode) -> None:
        """The recursion: forces and frequency corrections, times the multiplier L_q(nu)."""
        self.add_forces(m, bracket)
        self.add_corrections(m, bracket)
        nu = harmonic(m)
        secular = {
            q
            for q, e in zip(self.case.seeds, nu, strict=True)
            if abs(e) == 1 == sum(map(abs, nu))
        }
        for q in bracket.keys() - secular:
            self.add(u, q, self.multiplier(q, nu), bracket[q])

    def add_forces(self, m: Monomial, bracket: ByMode) -> None:
        """- sum B u u, or - sum C u u u; of other potentials, - g_n sum T u .. u of all n."""
        for n, g in self.case.force.items():
            if n > sum(m):
                continue
            number = self.number(g)
            for modes, value in self.products(n, m):
                for q, coupling in couplings(self.case.N, *modes):
                    self.add(bracket, q, {(): number}, value, -coupling)

    def number(self, g: Any) -> Any:
        """A coefficient of the force, as a residue or exactly."""
        p = self.point.prime
        if not p:
            return g
        need(g.denominator % p, f"a coefficient of the force has no residue modulo {p}")
        return g.numerator * pow(g.denominator, -1, p) % p

    def add_corrections(self, m: Monomial, bracket: ByMode) -> None:
        """+ sum W_q u_q over the monomials f = |w|^(2e) that divide m, neither of them trivial."""
        for f in divisors_of(m):
            diagonal = f[::2] == f[1::2]
            if not diagonal or not 0 < sum(f) < sum(m) - 1:
                continue
            rest = self.coefficients(quotient(m, f))
            for i, q in enumerate(self.case.seeds):
                if rest.get(q):
                    secular = self.term(raised(f, i))[1].get(q, {})
                    self.add(bracket, q, secular, rest[q], -1)

    def products(
        self, factors: int, m: Monomial
    ) -> Iterator[tuple[tuple[int, ...], Polynomial]]:
        """Modes l1 .. lr and value of each product u_l1 .. u_lr at monomial m.

        Its degree fixes the sum of the orders.
        """
        if factors == 1:
            for q, value in self.coefficients(m).items():
                yield (q,), value
            return
        for f in self.budget.counted(divisors_of(m)):
            if not 0 < sum(f) < sum(m):
                continue
            for q, value in self.coefficients(f).items():
                for modes, others in self.products(factors - 1, quotient(m, f)):
                    yield (q, *modes), self.add({}, q, value, others)

    def add(
        self, total: ByMode, q: int, x: Polynomial, y: Polynomial, sign: int = 1
    ) -> Polynomial:
        """total[q] += sign x y; returns total[q]."""
        value, prime = total.setdefault(q, {}), self.point.prime
        for (a, s), (b, t) in self.budget.counted(product(x.items(), y.items())):
            symbols = tuple(sorted(a + b))
            c = value.get(symbols, 0) + sign * s * t
            value[symbols] = c % prime if prime else c
        return value

    def multiplier(self, q: int, nu: tuple[int, ...]) -> Polynomial:
        """L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2), as a residue or as a symbol.

        L_q(-nu) is the same.
        """
        p, g, omega = self.point
        if not p:
            opposite = tuple(-n for n in nu)
            return {((q, max(nu, opposite)),): 1}
        linear = 2 - pow(g, 2 * q, p) - pow(g, -2 * q, p)  # Omega_q^2 = 2 - 2 cos(q pi / N)
        seeds = self.case.seeds
        own = omega[seeds.index(q)] ** 2 if q in seeds else linear
        divisor = own - sum(map(mul, nu, omega)) ** 2
        need(divisor % p, f"the divisor of mode {q} at harmonic {nu} is zero modulo {p}")
        return {(): linear * pow(divisor, -1, p)}


def harmonic(m: Monomial) -> tuple[int, ...]:
    """nu = p - n."""
    return tuple(map(sub, m[::2], m[1::2]))


def divisors_of(m: Monomial) -> Iterator[Monomial]:
    """All monomials that divide m, 1 and m among them."""
    return product(*(range(e + 1) for e in m))


def quotient(m: Monomial, f: Monomial) -> Monomial:
    """m / f."""
    return tuple(map(sub, m, f))


def raised(f: Monomial, i: int) -> Monomial:
    """f w_i."""
    return (*f[: 2 * i], f[2 * i] + 1, *f[2 * i + 1 :])


# --- the claims


def check_certificate(data: Json) -> list[str]:
    """Every claim in turn; what was checked, in three lines."""
    case, budget = read_case(data), Budget()
    check_names(data)
    orders = excitation_orders(data, case)
    zeros = check_zeros_are_complete(data, case, orders)
    check_probabilities(data)
    rule = propagation_rule(case, budget)
    verdict = check_conclusions(data, case, rule, orders)
    check_zeros_by_couplings(data, case, budget)
    check_zeros_by_identity(data, case, budget)
    check_points(data, case)
    check_witnesses(data, case, budget)
    return report(data, case, verdict, zeros, budget.steps)


def check_names(data: Json) -> None:
    """Each mode is named once in a list, in ascending order.

    Of zeros, once for each way to show them.
    """
    check_ascending([(e["mode"], e["by"]) for e in data["vanishing"]])
    check_ascending([e["mode"] for e in data["undecided"]])
    check_ascending([e["mode"] for e in data["excited"]])


def check_ascending(names: list[Any]) -> None:
    """In ascending order, none twice."""
    need(names == sorted(set(names)), f"not ascending, or twice: {names!r:.200}")


def excitation_orders(data: Json, case: Case) -> dict[int, int]:
    """The order at which each mode is said to be excited: 0 for seeds."""
    witnessed = {e["mode"]: e["order"] for e in data["excited"]}
    return witnessed | dict.fromkeys(case.seeds, 0)


def check_zeros_are_complete(data: Json, case: Case, orders: dict[int, int]) -> int:
    """At each order before its own, a mode is said to vanish or to be undecided.

    Returns how many zeros that are.
    """
    claimed = []
    for e in data["vanishing"] + data["undecided"]:
        if e["orders"] == sorted(e["orders"]):
            claimed += [(e["mode"], k) for k in e["orders"] or [0]]
    expected = []
    for q in range(1, case.N):
        last = orders.get(q, case.order + 1)
        expected += [(q, k) for k in range(1, last)]
    need(sorted(claimed) == expected, "vanishing, undecided: wrong orders")
    return len(expected)


def check_probabilities(data: Json) -> None:
    """Each undecided zero has its probability of error."""
    texts = [e["error_probability"] for e in data["undecided"]]
    need(all(map(PROBABILITY.fullmatch, texts)), "an error_probability is not in (0, 1]")


def propagation_rule(case: Case, budget: Budget) -> list[list[int]]:
    """D_0 .. D_K of the paper's proposition (Eqs. app, dk), folded at every order.

    Of other potentials none at an order which no powers of the force make.
    """
    signed = [*case.seeds, *(-q for q in case.seeds)]
    shifts = {sum(chosen) for chosen in product(signed, repeat=case.step)}
    reached, rule, seen = set(case.seeds), [], {0, case.N}
    made = orders_made(case)
    for k in range(case.order + 1):
        if k:
            pairs = budget.counted(product(reached, shifts))
            reached = {folded(q + shift, case.N) for q, shift in pairs}
        new = reached - seen if k in made else set()
        rule.append(sorted(new))
        seen |= new
    return rule


def orders_made(case: Case) -> set[int]:
    """The orders that are sums of what the powers of the force add to the order."""
    made = {0}
    for k in range(1, case.order + 1):
        if any(k - case.added(n) in made for n in case.force):
            made.add(k)
    return made


def folded(total: int, N: int) -> int:
    """The wave number from 0 to N that is the same as total on the chain."""
    return min(total % (2 * N), -total % (2 * N))


def check_conclusions(
    data: Json, case: Case, rule: list[list[int]], orders: dict[int, int]
) -> str:
    """Rule, actual sets, exceptions and verdict follow from the rest; returns the verdict."""
    predicted = {q: k for k, modes in enumerate(rule) for q in modes}
    unsure = {e["mode"] for e in data["undecided"]}
    exceptions = find_exceptions(case, predicted, orders)
    decided = {e["mode"] for e in exceptions} - unsure
    verdict = "refuted" if decided else "undecided" if unsure else "proved"
    actual = [sorted(q for q in orders if orders[q] == k) for k in range(case.order + 1)]
    conclusions = {
        "rule": rule,
        "actual": actual,
        "exceptions": exceptions,
        "verdict": verdict,
    }
    for key, value in conclusions.items():
        need(data[key] == value, f"{key} is not {value!r:.200}")
    named = len(case.seeds) + len(data["excited"])
    need(
        len(orders) == named == sum(map(len, actual)),
        "excited: a mode is a seed, or beyond the order",
    )
    return verdict


def find_exceptions(
    case: Case, predicted: dict[int, int], orders: dict[int, int]
) -> list[Json]:
    """Modes whose order is not the predicted one."""
    found: list[Json] = []
    for q in range(1, case.N):
        expected, actual = predicted.get(q), orders.get(q)
        if expected != actual:
            found.append({"mode": q, "predicted": expected, "actual": actual})
    return found


def check_zeros_by_couplings(data: Json, case: Case, budget: Budget) -> None:
    """Where a zero is said to follow from the couplings, they leave the mode nothing at that
    order.
    """
    zeros = [e for e in data["vanishing"] if e["by"] == "couplings"]
    last = max((k for e in zeros for k in e["orders"]), default=0)
    sets = coupled_sets(case, last, budget)
    for e in data["vanishing"]:
        q, by = e["mode"], e["by"]
        for k in e["orders"]:
            shown = by == "identity" or (by == "couplings" and q not in sets[k])
            need(shown, f"mode {q} at order {k} does not vanish by {by!r:.40}")


def coupled_sets(case: Case, last: int, budget: Budget) -> list[set[int]]:
    """M_0 .. M_last: what B, C or another power of the force couples to the sets before.

    And seeds reached before, kept by frequency corrections.
    """
    sets = [set(case.seeds)]
    for k in range(1, last + 1):
        reached = {q for q in case.seeds if any(q in modes for modes in sets[1:])}
        for n in case.force:
            before = k - case.added(n)  # the sum of the orders of the factors
            orders = combinations_with_replacement(range(before + 1), n)
            for chosen in budget.counted(orders):
                if sum(chosen) == before:
                    reached |= coupled_modes(case, [sets[j] for j in chosen], budget)
        sets.append(reached)
    return sets


def coupled_modes(case: Case, factors: list[set[int]], budget: Budget) -> set[int]:
    """The modes that products of one mode of each set drive."""
    found = set()
    for modes in budget.counted(product(*factors)):
        found |= {q for q, _ in couplings(case.N, *modes)}
    return found


def check_zeros_by_identity(data: Json, case: Case, budget: Budget) -> None:
    """Where a zero is said to be an identity, every coefficient is the zero polynomial in the
    symbols L_q(nu).
    """
    recursion = Recursion(case, SYMBOLS, budget)
    for e in data["vanishing"]:
        if e["by"] == "identity":
            for k in e["orders"]:
                check_identity(recursion, e["mode"], k)


def check_identity(recursion: Recursion, q: int, k: int) -> None:
    """The term of mode q at order k is zero, monomial by monomial."""
    variables = range(2 * len(recursion.case.seeds))
    degree = recursion.case.degree(k)
    for chosen in combinations_with_replacement(variables, degree):
        m = tuple(map(chosen.count, variables))
        polynomial = recursion.coefficients(m).get(q, {})
        need(not any(polynomial.values()), f"mode {q} at order {k} is not zero")


def check_points(data: Json, case: Case) -> None:
    """Points are few, distinct, and each is one at which residues prove something."""
    points = data["points"]
    distinct = all(points.count(e) == 1 for e in points)
    named = all(e["point"] < len(points) for e in data["excited"])
    need(len(points) <= MOST_POINTS and distinct and named, "points")
    for e in points:
        check_point(case, Point(e["prime"], e["root"], e["frequencies"]))


def check_point(case: Case, point: Point) -> None:
    """p is a prime = 1 mod 4N, the root has order 4N, the frequencies are residues."""
    p, g, omega = point
    useful = 2**16 < p < 2**64 and p % (4 * case.N) == 1
    need(useful and is_prime(p), f"{p} is no prime of use")
    divisors = [d for d in range(1, 4 * case.N + 1) if 4 * case.N % d == 0]
    need(
        g < p and [d for d in divisors if pow(g, d, p) == 1] == [4 * case.N],
        f"{g} is not of order 4N",
    )
    residues = [w for w in omega if w < p]
    need(
        omega == residues and len(omega) == len(case.seeds),
        f"frequencies are not residues modulo {p}",
    )


def is_prime(p: int) -> bool:
    """By Miller and Rabin's test with bases that decide every odd number below 3.3e24."""
    twos = ((p - 1) & (1 - p)).bit_length() - 1  # p - 1 = 2^twos times an odd number
    for base in BASES:
        powers = [pow(base, p - 1 >> h, p) for h in range(1, twos + 1)]
        if powers[-1] != 1 and p - 1 not in powers:
            return False
    return True


def check_witnesses(data: Json, case: Case, budget: Budget) -> None:
    """Each excited mode has a coefficient that is not zero modulo its prime: it is computed
    again.
    """
    for i, e in enumerate(data["points"]):
        point = Point(e["prime"], e["root"], e["frequencies"])
        recursion = Recursion(case, point, budget)
        for witness in data["excited"]:
            if witness["point"] == i:
                check_witness(recursion, witness)


def check_witness(recursion: Recursion, witness: Json) -> None:
    """The monomial belongs to the order, and its coefficient is the stated residue, which is not
    zero.
    """
    q, k, residue = witness["mode"], witness["order"], witness["residue"]
    m, case = tuple(witness["monomial"]), recursion.case
    fits = len(m) == 2 * len(case.seeds) and sum(m) == case.degree(k)
    need(fits, f"mode {q}: the monomial has not the degree of order {k}")
    computed = recursion.coefficients(m).get(q, {}).get(())
    need(0 < residue == computed, f"mode {q}: the residue is not {residue}")


def report(data: Json, case: Case, verdict: str, zeros: int, steps: int) -> list[str]:
    """What was checked."""
    unsure = sorted({e["mode"] for e in data["undecided"]})
    primes = [e["prime"] for e in data["points"]]
    chain = f"{law(data)}, N = {case.N}, seeds {case.seeds}, orders to {case.order}"
    excited = f"{len(data['excited'])} modes excited"
    return [
        f"{chain}: rule, orders and exceptions follow; {verdict}",
        f"{excited}: residues computed again, modulo {primes}, in {steps} steps",
        f"{zeros} zeros before: by couplings or identity; undecided, not checked: modes {unsure}",
    ]


def law(data: Json) -> str:
    """What chain it is, and whether the coefficients are known to be those of its potential."""
    if data["schema"] == 1:
        return f"{data['model']} chain"
    name = data["potential"]
    unknown = (
        "" if is_known(name) else " (its coefficients as written, the name not checked)"
    )
    return f"chain of potential {name:.80}{unknown}"
