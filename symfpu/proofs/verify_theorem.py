"""Independent checker of the theorem for every N: Python integers and fractions only.

It finds the hyperplanes m.q = 2 w N and all flats again, takes a seed set of its own where the
certificate says nothing of a flat, and decides each once more: by sums of seeds that
fold with one sign, by chains of couplings, by the signs of the products of couplings, by residues
that the recursion of `verify` computes again, or by couplings that are zero. The theorems that
make these proofs are in docs/propagation.md. It shares no code with the prover and imports
nothing but the standard library, the checker of certificates of one N and what checkers read with.
"""

import re
from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from itertools import combinations, combinations_with_replacement, islice, pairwise, product
from math import gcd
from operator import mul
from pathlib import Path
from typing import Any, NamedTuple

from symfpu.proofs.reading import (
    CertificateError,
    Json,
    check_digest,
    need,
    outside_strings,
    parsed,
    text_of,
    verified,
)
from symfpu.proofs.verify import (
    MODELS,
    Budget,
    Case,
    Point,
    Recursion,
    check_point,
    coupled_sets,
    couplings,
    folded,
    propagation_rule,
)

FORMAT = "symfpu rule for all N certificate"
KEYS = (
    "count digest exceptions flats format model order points schema seeds_number undecided "
    "verdict witnesses"
)
MOST_SEEDS = 3
LARGEST_DEGREE = {1: 201, 2: 13, 3: 5}  # by number of seeds; beyond, a check takes hours
LARGEST_N = 4096
TRIALS = 400  # pairs of places between which a general point is looked for
LARGEST_TRIAL = 64  # bonds among which it is looked for else
# the last orders at which a chain of couplings holds for the frequencies of every N
CHAINS = {"alpha": 3, "beta": 2}

Row = tuple[int, ...]
Powers = tuple[int, ...]


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked, the theorem first.

    Raises CertificateError, with the reason, if the certificate is not right.
    """
    return verified(path, read_theorem, check_theorem)[1]


# --- the file


def read_theorem(path: Path) -> Json:
    """The contents, without floats, booleans and minus signs: == and < are exact afterwards."""
    text = text_of(path)
    bare = outside_strings(text)
    strange = re.search(r'[^\s0-9{}\[\],:nul"]|[0-9]{21}', bare)
    need(not strange, "not JSON of plain strings, null and integers of at most 20 digits")
    data = parsed(text)
    need(data["format"] == FORMAT, "not a theorem for all N")
    need(data["schema"] == 2, "schema version unknown: this checker supports version 2")
    once = bare.count(":") == len(data)
    need(
        once and " ".join(sorted(data)) == KEYS, "a key is missing, unknown or there twice"
    )
    check_digest(data)
    return data


class Theorem(NamedTuple):
    """What is claimed: the model, how many seeds, the last order."""

    model: str
    s: int
    order: int

    def degree(self, k: int) -> int:
        """How many leaves a term of order k has."""
        return 1 + k * MODELS[self.model][0]

    def case(self, flat: Row) -> Case:
        """The representative of a flat as one case."""
        N, *seeds = flat
        return Case(N, self.order, seeds, *MODELS[self.model])


def read_claim(data: Json) -> Theorem:
    """Model, number of seeds and order, their sizes bounded."""
    model, s, order = data["model"], data["seeds_number"], data["order"]
    fits = model in MODELS and 0 < s <= MOST_SEEDS and order > 0
    need(fits, "wrong model, number of seeds or order")
    claim = Theorem(model, s, order)
    need(claim.degree(order) <= LARGEST_DEGREE[s], f"order {order} is beyond this checker")
    return claim


def read_flats(data: Json, claim: Theorem) -> list[Row]:
    """N and ascending seeds of the flats of which something is said."""
    found = [tuple(row) for row in data["flats"]]
    for N, *seeds in found:
        need(N <= LARGEST_N and len(seeds) == claim.s, "a representative of wrong size")
        need(
            seeds == sorted({q for q in seeds if 0 < q < N}),
            "seeds are not ascending modes",
        )
    need(len(set(found)) == len(found), "a flat is listed twice")
    return found


# --- the flats are all there are


def hyperplanes(claim: Theorem) -> list[Row]:
    """m_1 .. m_s, c of every m.x = c between the corners of 0 < x_1 < .. < x_s < 1.

    c is even, and |m| at most twice the last degree; even in beta.
    """
    most = 2 * claim.degree(claim.order)
    found = set()
    for m in product(range(-most, most + 1), repeat=claim.s):
        size = sum(map(abs, m))
        if 0 < size <= most and (claim.model == "alpha" or size % 2 == 0):
            corners = [sum(m[claim.s - i :]) for i in range(claim.s + 1)]
            for c in range(-most, most + 1):
                if c % 2 == 0 and min(corners) < c < max(corners):
                    found.add(lowest((*m, c)))
    return sorted(found)


def lowest(row: Row) -> Row:
    """In lowest terms, the first number that is not zero positive."""
    shared = gcd(*row)
    if next(filter(None, row)) < 0:
        shared = -shared
    return tuple(c // shared for c in row)


def dot(m: Row, v: Row) -> int:
    """Of the normal of a row with a vector: a value at the end of the row is left out."""
    return sum(map(mul, m, v))


def held(rows: list[Row], flat: Row) -> int:
    """Which hyperplanes hold seeds / N, as bits."""
    N, *seeds = flat
    bits = 0
    for i, row in enumerate(rows):
        if sum(map(mul, row, seeds)) == row[-1] * N:
            bits |= 1 << i
    return bits


class Line(NamedTuple):
    """The points (start + t direction) / scale."""

    start: Row
    scale: int
    direction: Row


class Arrangement(NamedTuple):
    """All flats: the lines and other wide ones by the hyperplanes that hold them, the points.

    wide : one point on each, N and seeds, on no further hyperplane.
    """

    rows: list[Row]
    lines: dict[int, Line]
    wide: dict[int, Row]
    points: set[Row]


def arrangement(claim: Theorem) -> Arrangement:
    """Every intersection of hyperplanes that meets the open simplex, each once.

    That is the whole simplex, each hyperplane, where s = 3 each line, and the points in which
    hyperplanes meet the lines.
    """
    rows = hyperplanes(claim)
    found = Arrangement(rows, {}, {}, set())
    for line in lines(claim, rows):
        mask = line_mask(rows, line)
        places = points_on_line(rows, line)
        found.points.update(places[1:-1])
        found.lines[mask] = line
        found.wide[mask] = between(places[0], places[1])
    if claim.s == 3:
        add_planes(found)
    if claim.s > 1:
        found.wide[0] = general_point(rows, 0, list(found.wide.values()))
    return found


def add_planes(found: Arrangement) -> None:
    """Each plane, from the lines on it."""
    on_plane: dict[int, list[Row]] = {1 << i: [] for i in range(len(found.rows))}
    for mask, place in found.wide.items():
        for i in range(len(found.rows)):
            if mask >> i & 1:
                on_plane[1 << i].append(place)
    for mask, places in on_plane.items():
        found.wide[mask] = general_point(found.rows, mask, places)


def general_point(rows: list[Row], mask: int, places: list[Row]) -> Row:
    """A point on these hyperplanes and no others: between two places on them, or by trial."""
    for first, second in islice(combinations(places, 2), TRIALS):
        place = between(first, second)
        if held(rows, place) == mask:
            return place
    for N in range(2, LARGEST_TRIAL):
        for seeds in combinations(range(1, N), len(rows[0]) - 1):
            if on_all(rows, mask, (N, *seeds)) and held(rows, (N, *seeds)) == mask:
                return N, *seeds
    raise CertificateError("this checker finds no seed set in general position")


def on_all(rows: list[Row], mask: int, flat: Row) -> bool:
    """Whether the hyperplanes of a mask hold a point."""
    N, *seeds = flat
    return all(
        sum(map(mul, row, seeds)) == row[-1] * N
        for i, row in enumerate(rows)
        if mask >> i & 1
    )


def between(first: Row, second: Row) -> Row:
    """A point strictly between two, in lowest terms."""
    place = [a + b for a, b in zip(first, second, strict=True)]
    shared = gcd(*place)
    return tuple(c // shared for c in place)


def lines(claim: Theorem, rows: list[Row]) -> Iterator[Line]:
    """The flats of dimension one."""
    if claim.s == 1:
        yield Line((0,), 1, (1,))
    if claim.s == 2:
        for a, b, c in rows:
            yield Line((c, 0), a, (-b, a)) if a else Line((0, c), b, (1, 0))
    if claim.s == 3:
        for line in sorted(common_lines(rows)):
            if meets_simplex(line):
                yield line


def common_lines(rows: list[Row]) -> set[Line]:
    """In which two planes meet, each once: one point on it is in lowest terms, as its direction."""
    found = set()
    for first, second in combinations(rows, 2):
        direction = cross(first, second)
        if any(direction):
            start, scale = common_point(first, second, direction)
            shared = gcd(scale, *start)
            point = tuple(c // shared for c in start)
            found.add(Line(point, scale // shared, lowest(direction)))
    return found


def cross(a: Row, b: Row) -> Row:
    """Of two normals."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def common_point(a: Row, b: Row, direction: Row) -> tuple[Row, int]:
    """A point of both planes, as integers over a scale: one coordinate is zero."""
    zero = next(i for i in range(3) if direction[i])
    i, j = (zero + 1) % 3, (zero + 2) % 3
    point = [0, 0, 0]
    point[i] = a[3] * b[j] - b[3] * a[j]
    point[j] = a[i] * b[3] - b[i] * a[3]
    scale = direction[zero]
    if scale < 0:
        return tuple(-c for c in point), -scale
    return tuple(point), scale


def meets_simplex(line: Line) -> bool:
    """Whether a line meets 0 < x_1 < .. < x_s < 1: all gaps are positive at some t."""
    bounds = room(line)
    return bounds is not None and bounds[0] < bounds[1]


def room(line: Line) -> tuple[Fraction, Fraction] | None:
    """Between which t all gaps of 0 < x_1 < .. < x_s < 1 are open; None where one never is."""
    ends, slopes = (0, *line.start, line.scale), (0, *line.direction, 0)
    low: list[Fraction] = []
    high: list[Fraction] = []
    for i in range(len(ends) - 1):
        gap, slope = ends[i + 1] - ends[i], slopes[i + 1] - slopes[i]
        if slope == 0 and gap <= 0:
            return None
        if slope:
            (low if slope > 0 else high).append(Fraction(-gap, slope))
    return max(low), min(high)


def line_mask(rows: list[Row], line: Line) -> int:
    """Which hyperplanes hold a line, as bits."""
    bits = 0
    for i, row in enumerate(rows):
        if dot(row, line.direction) == 0 and dot(row, line.start) == row[-1] * line.scale:
            bits |= 1 << i
    return bits


def points_on_line(rows: list[Row], line: Line) -> list[Row]:
    """Where it enters the simplex, meets hyperplanes that do not hold it, and leaves: N, seeds."""
    bounds = room(line)
    need(bounds, "a hyperplane beside the simplex")
    assert bounds is not None
    low, high = bounds
    met = {low, high}
    start, scale, direction = line
    for row in rows:
        slope = sum(map(mul, row, direction))
        if slope:
            rise = row[-1] * scale - sum(map(mul, row, start))
            if slope < 0:
                slope, rise = -slope, -rise
            after = low.numerator * slope < rise * low.denominator
            if after and rise * high.denominator < high.numerator * slope:
                met.add(Fraction(rise, slope))
    return [place_at(line, t) for t in sorted(met)]


def place_at(line: Line, t: Fraction) -> Row:
    """The point of a parameter as N and seeds, in lowest terms."""
    rise, slope = t.as_integer_ratio()
    place = [q * slope + v * rise for q, v in zip(line.start, line.direction, strict=True)]
    shared = gcd(line.scale * slope, *place)
    return (line.scale * slope // shared, *(c // shared for c in place))


def check_flats(found: Arrangement, listed: list[Row], count: int) -> list[int]:
    """There are so many flats, and those listed are among them; returns their dimensions.

    A wide one is listed by its first seed set, of the fewest bonds.
    """
    there_are = len(found.wide) + len(found.points)
    need(count == there_are, f"there are {there_are} flats")
    dimensions = []
    for flat in listed:
        if flat in found.points:
            dimensions.append(0)
            continue
        mask = held(found.rows, flat)
        need(mask in found.wide, f"a representative of no flat: {flat}")
        first = first_on(found, mask)
        need(flat == first, f"the first seed set of its flat is {first}, not {flat}")
        dimensions.append(dimension(found, mask))
    return dimensions


def dimension(found: Arrangement, mask: int) -> int:
    """Of a flat that is no point."""
    if mask in found.lines:
        return 1
    s = len(found.rows[0]) - 1
    return s if mask == 0 else s - 1


def first_on(found: Arrangement, mask: int) -> Row:
    """The seed set of fewest bonds, and of those the least, on these hyperplanes alone."""
    for N in range(2, LARGEST_N):
        for flat in seed_sets_on(found, mask, N):
            if held(found.rows, flat) == mask:
                return flat
    raise CertificateError("a flat without a seed set")


def seed_sets_on(found: Arrangement, mask: int, N: int) -> list[Row]:
    """Those of N bonds, ascending: on a line one coordinate gives the others."""
    if mask not in found.lines:
        every = combinations(range(1, N), len(found.rows[0]) - 1)
        return [(N, *seeds) for seeds in every if on_all(found.rows, mask, (N, *seeds))]
    line = found.lines[mask]
    i = next(i for i, v in enumerate(line.direction) if v)
    flats = []
    for q in range(1, N):
        t = Fraction(q * line.scale - line.start[i] * N, line.direction[i] * N)
        M, *seeds = place_at(line, t)
        if N % M == 0 and seeds[0] > 0 and all(a < b for a, b in pairwise([*seeds, M])):
            flats.append((N, *(c * N // M for c in seeds)))
    return sorted(flats)


# --- what decides a flat


class Signs:
    """Signs of the products of couplings in u_q[p], where all signs of the harmonic p are +."""

    def __init__(self, case: Case) -> None:
        self.case, self.factors = case, case.step + 1
        self.known: dict[Powers, set[tuple[int, int]]] = {}
        self.coupled: dict[Row, list[tuple[int, int]]] = {}

    def of(self, p: Powers) -> set[tuple[int, int]]:
        """Modes with the signs +1 and -1 that occur."""
        if sum(p) == 1:
            return {(self.case.seeds[p.index(1)], 1)}
        if (sum(p) - 1) % self.case.step:
            return set()
        if p not in self.known:
            self.known[p] = set(self.products(p))
        return self.known[p]

    def products(self, p: Powers) -> Iterator[tuple[int, int]]:
        """Of all ways to share p among the factors."""
        for parts in shared(p, self.factors):
            for chosen in product(*map(self.of, parts)):
                modes, sign = [], 1
                for m, s in chosen:
                    modes.append(m)
                    sign *= s
                for q, coupling in self.couplings(tuple(sorted(modes))):
                    yield q, sign if coupling > 0 else -sign

    def couplings(self, modes: Row) -> list[tuple[int, int]]:
        """Eq. transa, remembered."""
        if modes not in self.coupled:
            self.coupled[modes] = couplings(self.case.N, *modes)
        return self.coupled[modes]


def shared(p: Powers, factors: int, least: Powers = ()) -> Iterator[tuple[Powers, ...]]:
    """Ways to write p as a sum of so many powers in ascending order, none of them zero."""
    if factors == 1:
        if any(p) and p >= least:
            yield (p,)
        return
    for part in product(*(range(e + 1) for e in p)):
        if any(part) and part >= least:
            rest = tuple(a - b for a, b in zip(p, part, strict=True))
            for others in shared(rest, factors - 1, part):
                yield (part, *others)


def powers_of_degree(s: int, degree: int) -> list[Powers]:
    """All p with this sum."""
    return [p for p in product(range(degree + 1), repeat=s) if sum(p) == degree]


class Evidence(NamedTuple):
    """What a certificate says of one flat."""

    exceptions: list[tuple[int, Any, Any]]
    witnesses: dict[tuple[int, int], tuple[int, int, Powers]]
    undecided: list[int]


def read_evidence(data: Json, claim: Theorem, count: int) -> list[Evidence]:
    """Exceptions, witnesses and undecided modes, flat by flat, ascending and none twice."""
    found = [Evidence([], {}, []) for _ in range(count)]
    for key in ("exceptions", "undecided", "witnesses"):
        named = [row[:2] if key != "witnesses" else [row[0], row[2]] for row in data[key]]
        need(
            all(a < b for a, b in pairwise(named)),
            f"{key} not ascending",
        )
    for i, mode, rule, actual in data["exceptions"]:
        found[i].exceptions.append((mode, rule, actual))
    for i, point, mode, order, residue, *powers in data["witnesses"]:
        fits = 0 < order <= claim.order and sum(powers) == claim.degree(order)
        need(fits and len(powers) == claim.s, "a witness of wrong degree")
        found[i].witnesses[mode, order] = point, residue, tuple(powers)
    for i, mode in data["undecided"]:
        found[i].undecided.append(mode)
    return found


def check_flat(claim: Theorem, flat: Row, evidence: Evidence, points: list[Row]) -> None:
    """Every mode is excited at its order and at none before, or named as undecided."""
    if not any(evidence) and not odd_sum(claim, flat):
        return  # Theorem 7
    case = claim.case(flat)
    actual = actual_orders(claim, case, evidence)
    shown = shown_by_sums(claim, case, actual, evidence)
    signs, left = Signs(case), dict(evidence.witnesses)
    unsure = []
    for q, k in sorted(actual.items()):
        if q in shown or one_sign(signs, claim, q, k):
            continue
        if (q, k) in left:
            check_residue(case, q, *left.pop((q, k)), points)
        else:
            unsure.append(q)
    need(unsure == evidence.undecided, f"{flat}: undecided modes {unsure}")
    need(not left, f"{flat}: a witness that nothing asks for")


NOTHING = Evidence([], {}, [])


def odd_sum(claim: Theorem, flat: Row) -> bool:
    """Whether fewer than d(K) signed seeds make an odd multiple of N."""
    N, *seeds = flat
    for m in short_sums(claim.s, claim.degree(claim.order) - 1):
        if sum(map(mul, m, seeds)) % (2 * N) == N:
            return True
    return False


@cache
def short_sums(s: int, most: int) -> list[Row]:
    """All m with |m| from 1 up to the most, one of m and -m."""
    found = product(range(-most, most + 1), repeat=s)
    return [m for m in found if 0 < sum(map(abs, m)) <= most and m == lowest_sign(m)]


def lowest_sign(m: Row) -> Row:
    """That of m and -m whose first number which is not zero is positive."""
    return max(m, tuple(-c for c in m))


def shown_by_sums(
    claim: Theorem, case: Case, actual: dict[int, int], evidence: Evidence
) -> set[int]:
    """Modes of D_k of one parity (Theorem 7), and those to which a chain leads (Theorem 8).

    And the seeds, of order 0.
    """
    exceptional = {mode for mode, _, _ in evidence.exceptions}
    shown = last = set(case.seeds)
    for k in range(1, claim.order + 1):
        members = {q for q in actual if actual[q] == k}
        known = (members - exceptional) & one_parity(case, claim.degree(k))
        if k <= CHAINS[claim.model]:
            known |= {q for q in members - known if coupled_to(case, q, last)}
        shown, last = shown | known, known
    return shown


def one_parity(case: Case, degree: int) -> set[int]:
    """Modes that sums with some powers p of the seeds reach, all with w of one parity.

    A sum a.q = +-q + 2wN with |a_i| up to p_i and as odd as p_i.
    """
    found = set()
    for p in powers_of_degree(len(case.seeds), degree):
        parities: dict[int, set[int]] = {}
        for a in product(*(range(-n, n + 1, 2) for n in p)):
            total = sum(map(mul, a, case.seeds))
            w = (total + case.N) // (2 * case.N)
            mode = abs(total - 2 * w * case.N)
            parities.setdefault(mode, set()).add(w % 2)
        found |= {q for q in parities if len(parities[q]) == 1}
    return found


def coupled_to(case: Case, q: int, last: set[int]) -> bool:
    """Whether one of these modes and as many seeds as a product takes are coupled to q."""
    for seeds in combinations_with_replacement(case.seeds, case.step):
        for signs in product((1, -1), repeat=case.step):
            m = folded(q + sum(map(mul, signs, seeds)), case.N)
            if m in last and q in dict(couplings(case.N, m, *seeds)):
                return True
    return False


def actual_orders(claim: Theorem, case: Case, evidence: Evidence) -> dict[int, int]:
    """Those of the rule, with the exceptions; before them the couplings leave a mode nothing."""
    rule = propagation_rule(case, Budget())
    orders = {q: k for k, modes in enumerate(rule) for q in modes}
    need(set(orders) >= set(case.seeds), "the rule lost a seed")
    actual = dict(orders)
    for mode, predicted, found in evidence.exceptions:
        need(
            orders.get(mode) == predicted, f"mode {mode}: the rule does not say {predicted}"
        )
        need(
            predicted and (found is None or predicted < found), f"mode {mode}: no exception"
        )
        del actual[mode]
        if found is not None:
            need(found <= claim.order, f"mode {mode}: order {found}")
            actual[mode] = found
    if evidence.exceptions:
        check_zeros(claim, case, evidence)
    return actual


def check_zeros(claim: Theorem, case: Case, evidence: Evidence) -> None:
    """The couplings leave an exceptional mode nothing at the orders before its own."""
    sets = coupled_sets(case, claim.order, Budget())
    for mode, predicted, found in evidence.exceptions:
        last = claim.order if found is None else found - 1
        for k in range(predicted, last + 1):
            need(mode not in sets[k], f"{case.seeds}: mode {mode} may be excited at {k}")


def one_sign(signs: Signs, claim: Theorem, q: int, k: int) -> bool:
    """Whether all products of some term of order k of the mode have one sign."""
    for p in powers_of_degree(claim.s, claim.degree(k)):
        found = signs.of(p)
        if ((q, 1) in found) != ((q, -1) in found):
            return True
    return False


def check_residue(
    case: Case, q: int, point: int, residue: int, powers: Powers, points: list[Row]
) -> None:
    """The coefficient of these powers is the stated residue, which is not zero."""
    prime, root, *frequencies = points[point]
    at = Point(prime, root, frequencies)
    check_point(case, at)
    monomial = tuple(e for n in powers for e in (n, 0))
    computed = Recursion(case, at, Budget()).coefficients(monomial).get(q, {}).get(())
    need(0 < residue == computed, f"mode {q}: the residue is not {residue}")


# --- the theorem


def check_theorem(data: Json) -> list[str]:
    """Every claim in turn; what was checked."""
    claim = read_claim(data)
    flats = read_flats(data, claim)
    check_points_used(data)
    evidence = read_evidence(data, claim, len(flats))
    need(all(map(any, evidence)), "a flat is listed of which nothing is said")
    there = arrangement(claim)
    dimensions = check_flats(there, flats, data["count"])
    for flat, found in zip(flats, evidence, strict=True):
        check_flat(claim, flat, found, data["points"])
    for flat in unlisted(there, flats):
        check_flat(claim, flat, NOTHING, [])
    exceptional = sum(bool(found.exceptions) for found in evidence)
    undecided = any(found.undecided for found in evidence)
    verdict = "undecided" if undecided else "refuted" if exceptional else "proved"
    need(data["verdict"] == verdict, f"the verdict is {verdict}")
    wide = [
        n for n, found in zip(dimensions, evidence, strict=True) if found.witnesses and n
    ]
    residues = len(data["witnesses"])
    return [
        sentence(claim, verdict, exceptional, data["count"], len(wide)),
        f"{data['count']} flats: all of the arrangement, found again",
        f"{residues} modes by residues, computed again; the others by signs and chains",
    ]


def unlisted(found: Arrangement, listed: list[Row]) -> list[Row]:
    """A seed set of each flat of which the certificate says nothing."""
    named = {held(found.rows, flat) for flat in listed if flat not in found.points}
    wide = [place for mask, place in found.wide.items() if mask not in named]
    return wide + sorted(found.points.difference(listed))


def check_points_used(data: Json) -> None:
    """Each point is there for a witness."""
    used = sorted({row[1] for row in data["witnesses"]})
    need(used == list(range(len(data["points"]))), "points that no witness uses")


def sentence(claim: Theorem, verdict: str, exceptional: int, count: int, gaps: int) -> str:
    """The theorem."""
    plural = "s" * (claim.s > 1)
    sets = f"every set of {claim.s} seed{plural}"
    where = "on"
    if claim.s >= claim.degree(claim.order):
        where = f"at most where {claim.s} of the seeds are on one of"
        sets = f"every set of {claim.s} or more seeds"
    start = f"{claim.model} chains: for every N and {sets}, to order {claim.order},"
    if verdict == "undecided":
        return f"{start} the propagation rule is not decided"
    rule = "the propagation rule holds"
    if exceptional:
        rule += f" except {where} {exceptional} of {count} flats"
    rule += ", for generic frequencies"
    return f"{start} {rule}" + f"; on {gaps} flats for generic L_q(nu) instead" * (gaps > 0)
