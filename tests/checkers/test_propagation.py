"""The checker of certificates, against a prover of its own: full tables over all monomials, tensors by the letter of Eq. transa."""

import copy
import json
import re
from itertools import product
from math import gcd, isqrt

import pytest

from symfpu.checkers.propagation import MODELS, SYMBOLS, Budget, Case, Point, Recursion, couplings, verify
from symfpu.checkers.propagation.couplings import coupling_steps
from symfpu.checkers.reading import CertificateError
from tests.chain.test_propagation import LENGTH, folded, literal_modes
from tests.checkers.certificate_files import parts_of, replaced, sealed


def delta(total, target):
    return int(total == target)


def tensor(N, q, *modes):
    """B_qlm or C_qlmn: Eq. transa with all signs, and the sums -2N."""
    sums = [q + sum(s * l for s, l in zip(signs, modes, strict=True)) for signs in product((1, -1), repeat=len(modes))]
    return sum(delta(t, 0) - delta(t, 2 * N) - delta(t, -2 * N) for t in sums)


def monomials(variables, degree):
    return [m for m in product(range(degree + 1), repeat=variables) if sum(m) == degree]


def plus(m, n):
    return tuple(a + b for a, b in zip(m, n, strict=True))


class Table:
    """All coefficients u_q^(k)[m] and W_q^(k)[f] modulo p, order after order; dictionaries by (mode, monomial)."""

    def __init__(self, N, model, seeds, order, p, g, frequencies):
        self.N, self.seeds, self.p, self.g, self.frequencies = N, seeds, p, g, frequencies
        r = {"alpha": 2, "beta": 3}[model]
        self.coupling = {modes: tensor(N, *modes) for modes in product(range(1, N), repeat=r + 1)}
        self.coupling = {modes: c for modes, c in self.coupling.items() if c}
        self.u, self.W = [{}], [{}]
        for i, q in enumerate(seeds):
            self.u[0][q, self.unit(i, 0)] = self.u[0][q, self.unit(i, 1)] = 1
        for k in range(1, order + 1):
            self.step(k, r)

    def unit(self, i, conjugate):
        return tuple(int(j == 2 * i + conjugate) for j in range(2 * len(self.seeds)))

    def force(self, k, r):
        """S^(k) as the sum over ordered tuples of modes and of orders."""
        products = {((), (0,) * 2 * len(self.seeds), 0): 1}
        for _ in range(r):
            longer = {}
            for (modes, m, n), x in products.items():
                for n2 in range(k - n):
                    for (l, m2), y in self.u[n2].items():
                        key = ((*modes, l), plus(m, m2), n + n2)
                        longer[key] = (longer.get(key, 0) + x * y) % self.p
            products = longer
        S = {}
        for (modes, m, n), x in products.items():
            for q in range(1, self.N) if n == k - 1 else ():
                if (q, *modes) in self.coupling:
                    S[q, m] = (S.get((q, m), 0) + self.coupling[q, *modes] * x) % self.p
        return S

    def step(self, k, r):
        bracket = {key: -x for key, x in self.force(k, r).items()}
        self.W.append({})
        for i, q in enumerate(self.seeds):
            for (mode, m), x in bracket.items():
                f = tuple(a - b for a, b in zip(m, self.unit(i, 0), strict=True))
                if mode == q and f[::2] == f[1::2]:
                    self.W[k][q, f] = -x
        for n in range(1, k):
            for (q, f), W in self.W[n].items():
                for (mode, m), x in self.u[k - n].items():
                    if mode == q:
                        key = q, plus(f, m)
                        bracket[key] = bracket.get(key, 0) + W * x
        self.u.append({(q, m): self.multiplier(q, m) * x % self.p for (q, m), x in bracket.items() if not self.secular(q, m)})

    def secular(self, q, m):
        nu = [a - b for a, b in zip(m[::2], m[1::2], strict=True)]
        return q in self.seeds and nu in ([int(w == q) for w in self.seeds], [-int(w == q) for w in self.seeds])

    def multiplier(self, q, m):
        p = self.p
        square = (2 - pow(self.g, 2 * q, p) - pow(self.g, 4 * self.N - 2 * q, p)) % p
        own = self.frequencies[self.seeds.index(q)] ** 2 if q in self.seeds else square
        phase = sum((a - b) * w for a, b, w in zip(m[::2], m[1::2], self.frequencies, strict=True))
        return square * pow((own - phase**2) % p, -1, p)

    def witness(self, q, k):
        """The first monomial at which the term of a mode does not vanish, with its residue."""
        return next(((m, x) for (mode, m), x in sorted(self.u[k].items()) if mode == q and x), None)


def point(N, seeds, start=2**20):
    """A prime = 1 mod 4N by trial division, an element of order 4N by its powers, and frequencies."""
    p = next(p for p in range(start - start % (4 * N) + 1, 2 * start, 4 * N) if p > 2**16 and all(p % d for d in range(2, isqrt(p) + 1)))
    powers = (pow(a, (p - 1) // (4 * N), p) for a in range(2, p))
    g = next(g for g in powers if len({pow(g, d, p) for d in range(4 * N)}) == 4 * N)
    return {"prime": p, "root": g, "frequencies": [(12345 + 67891 * q * q) % p for q in seeds]}


def rule(N, model, seeds, order):
    """D_0 .. D_order by Eqs. app, dk, over all vectors of signed seeds."""
    sequence, seen = [], set()
    for k in range(order + 1):
        M = literal_modes(N, seeds, LENGTH[model](k))
        sequence.append([q for q in M if q not in seen])
        seen.update(M)
    return sequence


def coupled(N, model, seeds, order):
    """The sets M_k of `couplings`, by all tuples of modes."""
    r, M = {"alpha": 2, "beta": 3}[model], [set(seeds)]
    for k in range(1, order + 1):
        kept = {q for q in seeds if any(q in modes for modes in M[1:])}
        tuples = [modes for ls in product(range(k), repeat=r) if sum(ls) == k - 1 for modes in product(*(M[l] for l in ls))]
        M.append(kept | {q for q in range(1, N) if any(tensor(N, q, *modes) for modes in tuples)})
    return M


def certificate(N, model, seeds, order, *, points=1, identity=(), undecided=()):
    """A certificate from full tables. Zeros of the modes given: identities, or undecided; others: couplings."""
    where = [point(N, seeds, 2**20 + 2**19 * i) for i in range(points)]
    tables = [Table(N, model, seeds, order, *at.values()) for at in where]
    M, place, excited, claims = coupled(N, model, seeds, order), dict.fromkeys(seeds, 0), [], []
    for q in sorted({*range(1, N)} - {*seeds}):
        found = next((k for k in range(1, order + 1) if tables[0].witness(q, k)), None)
        if found is not None:
            i = len(excited) % points
            m, x = tables[i].witness(q, found)
            excited.append({"mode": q, "order": found, "point": i, "monomial": list(m), "residue": x})
            place[q] = found
        orders = list(range(1, found or order + 1))
        assert q in identity or q in undecided or not any(q in M[j] for j in orders)
        claims.append((q, orders, "identity" if q in identity else "undecided" if q in undecided else "couplings"))
    doubts = [{"mode": q, "orders": js, "error_probability": "1.3e-09"} for q, js, by in claims if js and by == "undecided"]
    predicted = rule(N, model, seeds, order)
    expected = {q: k for k, modes in enumerate(predicted) for q in modes}
    exceptions = [{"mode": q, "predicted": expected.get(q), "actual": place.get(q)} for q in range(1, N) if expected.get(q) != place.get(q)]
    decided = {e["mode"] for e in exceptions} - {d["mode"] for d in doubts}
    body = {
        "format": "symfpu propagation certificate",
        "schema": 1,
        "N": N,
        "model": model,
        "seeds": list(seeds),
        "order": order,
        "rule": predicted,
        "actual": [sorted(q for q in place if place[q] == k) for k in range(order + 1)],
        "verdict": "refuted" if decided else "undecided" if doubts else "proved",
        "exceptions": exceptions,
        "undecided": doubts,
        "points": where,
        "excited": excited,
        "vanishing": [{"mode": q, "orders": js, "by": by} for q, js, by in claims if js and by != "undecided"],
    }
    return sealed(body)


CERTIFICATES = {
    "alpha": certificate(7, "alpha", (2, 3), 3, points=2),
    "beta": certificate(7, "beta", (1, 2), 2, identity=(5,)),
    "refuted": certificate(6, "beta", (2, 3), 2),
    "breather": certificate(8, "alpha", (1,), 4),
    "undecided": certificate(6, "beta", (2, 3), 2, undecided=(4,)),
}


@pytest.fixture
def check(tmp_path):
    def run(content):
        path = tmp_path / "certificate.json"
        path.write_bytes(content if isinstance(content, bytes) else json.dumps(content).encode())
        return verify(path)

    return run


def refused(check, content, reason="."):
    with pytest.raises(CertificateError, match=reason) as caught:
        check(content)
    assert str(caught.value).strip()
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 500


# --- certificates that hold


SAYS = {"proved": "the propagation rule holds", "refuted": "does not hold, at modes", "undecided": "is not decided"}


@pytest.mark.parametrize("name", CERTIFICATES)
def test_certificates_of_the_full_table_hold(check, name):
    lines = check(CERTIFICATES[name])
    assert SAYS[CERTIFICATES[name]["verdict"]] in lines[0]
    assert all(str(at["prime"]) in lines[1] for at in CERTIFICATES[name]["points"])


def test_the_refuted_case_is_the_cancellation_of_the_sums_0_and_2N():
    """4 - 3 - 3 + 2 = 0 and 4 + 3 + 3 + 2 = 2N = 12: the rule says order 1 for mode 4."""
    assert CERTIFICATES["refuted"]["exceptions"] == [{"mode": 4, "predicted": 1, "actual": 2}]
    assert tensor(6, 4, 3, 3, 2) == 0


@pytest.mark.parametrize("model", ["alpha", "beta"])
@pytest.mark.parametrize("N", [3, 4, 5, 6])
def test_every_small_case_agrees_with_the_full_table(check, N, model):
    for seeds in [(q,) for q in range(1, N)] + [(1, q) for q in range(2, N)]:
        check(certificate(N, model, seeds, 2))


@pytest.mark.parametrize("N", [2, 5, 6])
def test_couplings_are_the_tensors(N):
    for modes in (*product(range(1, N), repeat=2), *product(range(1, N), repeat=3)):
        values = dict(couplings(N, *modes))
        assert values == {q: tensor(N, q, *modes) for q in range(1, N) if tensor(N, q, *modes)}


@pytest.mark.parametrize(("model", "order"), [("alpha", 4), ("beta", 2)])
def test_the_lazy_recursion_gives_the_full_table_modulo_p_and_in_symbols(model, order):
    """All coefficients, and the polynomials with the residues of L_q(nu) put in; corrections of frequencies are in both."""
    N, seeds = 5, (1, 2)
    body = certificate(N, model, seeds, order, identity=range(N))
    at, case = body["points"][0], Case(N, order, list(seeds), *MODELS[model])
    p, table = at["prime"], Table(N, model, seeds, order, *at.values())
    in_symbols, modulo = (Recursion(case, point, Budget()) for point in (SYMBOLS, Point(*at.values())))
    seen = 0
    for k in range(order + 1):
        for m in monomials(4, case.degree(k)):
            residues = {q: value.get((), 0) for q, value in modulo.coefficients(m).items()}
            for q in range(1, N):
                expected = table.u[k].get((q, m), 0)
                assert residues.get(q, 0) == expected
                total = 0
                for symbols, coefficient in in_symbols.coefficients(m).get(q, {}).items():
                    for mode, nu in symbols:
                        assert nu >= tuple(-n for n in nu)  # L_q(nu) = L_q(-nu) is one symbol
                        harmonic = [e for n in nu for e in (max(n, 0), max(-n, 0))]
                        coefficient *= table.multiplier(mode, harmonic)
                    total += coefficient
                assert total % p == expected
                seen += bool(expected)
    assert seen > 50


def test_identities_are_accepted_where_they_hold_and_refused_where_not(check):
    """Zeros by couplings are identities too; of an excited mode moved out of `actual` the polynomial is not zero."""
    check(certificate(6, "beta", (2, 3), 2, identity=(1, 4, 5)))
    body = copy.deepcopy(CERTIFICATES["breather"])
    last = body["excited"].pop()
    q, k = last["mode"], last["order"]
    body["actual"][k].remove(q)
    body["exceptions"] = [{"mode": q, "predicted": k, "actual": None}]
    body["verdict"] = "refuted"
    body["vanishing"] = sorted(
        [e for e in body["vanishing"] if e["mode"] != q]
        + [{"mode": q, "orders": list(range(1, k)), "by": "couplings"}, {"mode": q, "orders": list(range(k, 5)), "by": "identity"}],
        key=lambda e: (e["mode"], e["by"]),
    )
    refused(check, sealed(body), f"mode {q} at order {k} is not zero")
    body["vanishing"] = [e | {"by": "couplings"} for e in CERTIFICATES["breather"]["vanishing"] if e["mode"] != q]
    body["vanishing"] = sorted([*body["vanishing"], {"mode": q, "orders": [*range(1, 5)], "by": "couplings"}], key=lambda e: e["mode"])
    refused(check, sealed(body), f"mode {q} at order {k} does not vanish by 'couplings'")


# --- certificates that were altered


def alterations(value):
    """What to put in the place of a value."""
    if isinstance(value, int):
        yield from (value + 1, value - 1, value + 0.5, str(value), 10**30)
    elif isinstance(value, str):
        yield from (value + "x", "", value.upper() if value.upper() != value else "y", 0)
    elif isinstance(value, list):
        yield from (value[:-1], value[1:], value[::-1], [*value, *(value[-1:] or [1])], [*value, 1]) if value else ([1], [{}], {}, "")
    elif isinstance(value, dict):
        yield from ({k: v for k, v in value.items() if k != key} for key in value)
        yield value | {"more": 1}
    yield from (None, True, float(value) if isinstance(value, int) else [value], "x", [], {})


def still_true(body, path, value):
    """The alterations that leave a true certificate, by full tables made anew; these are all of them.

    Frequencies that the witnesses of their point do not feel (absent from them, or exchanged in one that is symmetric in both), and
    a witness at the conjugate monomial.
    """
    changed = replaced(body, path, value)
    if path[:1] == ("points",) and path[2:3] == ("frequencies",):
        at, s = changed["points"][path[1]], len(body["seeds"])
        well_formed = isinstance(at["frequencies"], list) and [type(w) for w in at["frequencies"]] == [int] * s
        return well_formed and all(0 <= w < at["prime"] for w in at["frequencies"]) and residues_hold(changed)
    plain = isinstance(value, list) and all(type(e) is int for e in value)
    return path[:1] == ("excited",) and path[2:] == ("monomial",) and plain and residues_hold(changed)


def residues_hold(body):
    tables = [Table(body["N"], body["model"], body["seeds"], body["order"], *at.values()) for at in body["points"]]
    return all(tables[e["point"]].u[e["order"]].get((e["mode"], tuple(e["monomial"]))) == e["residue"] for e in body["excited"])


FIELDS = [(name, path, value) for name, body in CERTIFICATES.items() for path, value in parts_of(body) if path != ("digest",)]


@pytest.mark.long
@pytest.mark.parametrize(("name", "path", "value"), FIELDS)
def test_every_altered_field_is_refused_with_a_right_digest(check, name, path, value):
    body = CERTIFICATES[name]
    for other in alterations(value):
        if json.dumps(other) == json.dumps(value) or (not path and isinstance(other, dict) and "digest" not in other):
            continue
        changed = replaced(body, path, other)
        content = sealed(changed) if isinstance(changed, dict) else changed
        if isinstance(changed, dict) and still_true(body, path, other):
            check(content)
        else:
            refused(check, content)


@pytest.mark.parametrize("probability", ["1.3e-09", "1", "1.0", "1.0e+00", "0.25", "9e-320", "2.5e-1"])
def test_an_error_probability_is_a_claim_that_is_only_read(check, probability):
    """That a term was zero at every point, and with what probability of error, is not checked; the output says so."""
    body = replaced(CERTIFICATES["undecided"], ("undecided", 0, "error_probability"), probability)
    assert "not checked" in check(sealed(body))[-1]


OUTSIDE = "0 0.0 0e-9 0.0e-09 1.1 2 1e1 1.3e+00 1.5e-00 -0.5 nan inf 1/2 1_0e-9 1e- \u0661e-9"


@pytest.mark.parametrize("probability", [*re.split(" ", OUTSIDE), "", " 0.5", "0.5 "])
def test_an_error_probability_outside_0_to_1_is_refused(check, probability):
    refused(check, sealed(replaced(CERTIFICATES["undecided"], ("undecided", 0, "error_probability"), probability)))


def test_couplings_and_identities_may_replace_each_other_where_both_hold(check):
    body = CERTIFICATES["refuted"]
    for i, claim in enumerate(body["vanishing"]):
        check(sealed(replaced(body, ("vanishing", i), claim | {"by": "identity"})))


def test_a_witness_may_be_another_but_not_of_a_seed_or_twice(check):
    body = CERTIFICATES["breather"]
    seed = {"mode": 1, "order": 0, "point": 0, "monomial": [1, 0], "residue": 1}
    refused(check, sealed(body | {"excited": [seed, *body["excited"]]}))
    refused(check, sealed(body | {"excited": [body["excited"][0], *body["excited"]]}))
    conjugate = [e | {"monomial": e["monomial"][::-1]} for e in body["excited"]]
    check(sealed(body | {"excited": conjugate}))


@pytest.mark.parametrize(
    ("prime", "root"),
    [
        (2**20 + 1, 2),
        (73 * 1009, 2),  # composite, = 1 mod 4N
        (41 * 61 * 101, 2),  # a Carmichael number, = 1 mod 4N
        (3215031751, 2),  # strong pseudoprime to 2, 3, 5, 7
        (3825123056546413051, 2),  # strong pseudoprime to 2 .. 23
        (65537, 2),  # not = 1 mod 4N with N = 6
        (97, 5),  # too small, though right modulo 4N
        (2**64 + 13, 2),
        (0, 0),
    ],
)
def test_wrong_primes_are_refused(check, prime, root):
    body = CERTIFICATES["refuted"]
    at = body["points"][0] | {"prime": prime, "root": root, "frequencies": [0, 0]}
    refused(check, sealed(body | {"points": [at]}), "no prime of use|20 digits|a prime is out of its range")


def test_roots_of_another_order_are_refused(check):
    body = CERTIFICATES["refuted"]
    p, g = body["points"][0]["prime"], body["points"][0]["root"]
    for d in range(24):
        changed = sealed(replaced(body, ("points", 0, "root"), pow(g, d, p)))
        if d in (1, 11, 13, 23):
            check(changed)  # the same cos(q pi / N)
        elif gcd(d, 24) > 1:
            refused(check, changed, "not of order 4N")
        else:
            refused(check, changed, "residue")


def test_a_vanishing_divisor_is_refused(check):
    """A breather with 2 omega_1 = Omega_2 modulo p, Omega_q = (g^q - g^-q) / g^N."""
    body = CERTIFICATES["breather"]
    p, g, N = body["points"][0]["prime"], body["points"][0]["root"], body["N"]
    Omega = (pow(g, 2, p) - pow(g, -2, p)) * pow(g, -N, p) % p
    resonant = replaced(body, ("points", 0, "frequencies"), [Omega * pow(2, -1, p) % p])
    refused(check, sealed(resonant), "divisor of mode 2 at harmonic")


def test_residues_are_below_the_prime(check):
    body = CERTIFICATES["refuted"]
    p, g, frequencies = body["points"][0].values()
    refused(check, sealed(replaced(body, ("points", 0, "root"), g + p)))
    refused(check, sealed(replaced(body, ("points", 0, "frequencies"), [frequencies[0] + p, frequencies[1]])))
    refused(check, sealed(replaced(body, ("excited", 0, "residue"), body["excited"][0]["residue"] + p)))


def test_a_claim_without_orders_is_refused(check):
    body = CERTIFICATES["breather"]
    first = [{"mode": 2, "orders": [], "by": "couplings"}]
    refused(check, sealed(body | {"vanishing": first + body["vanishing"]}))


def test_a_witness_of_a_later_order_proves_nothing_of_an_earlier_one(check):
    """The rule upheld by a forger: mode 4 at order 1 as predicted, with the witness of order 2."""
    body = copy.deepcopy(CERTIFICATES["refuted"])
    next(e for e in body["excited"] if e["mode"] == 4)["order"] = 1
    body["vanishing"] = [e for e in body["vanishing"] if e["mode"] != 4]
    refused(check, sealed(body | {"actual": body["rule"], "exceptions": [], "verdict": "proved"}), "degree of order 1")


# --- files that are no certificates


GOOD = json.dumps(CERTIFICATES["refuted"])


@pytest.mark.parametrize(
    "content",
    [
        b"\xff\xfe",
        b"hello",
        b"null",
        b"[]",
        b"{}",
        b"5",
        b'"x"',
        b"NaN",
        b"[" * 900_000,
        b'{"a":' * 200_000,
        b"[" + b"1," * 2_000_000 + b"1]",
        b"1" * 5_000,
        GOOD.replace('"schema": 1', '"schema": NaN').encode(),
        GOOD.replace('"schema": 1', '"schema": 1.0').encode(),
        GOOD.replace('"schema": 1', '"schema": true').encode(),
        GOOD.replace('"schema": 1', '"schema": 1, "schema": 1').encode(),
        GOOD.replace('"mode": 1', '"mode": 1, "mode": 1', 1).encode(),
        GOOD.replace('"order": 2', '"order": ' + "9" * 6_000).encode(),
        GOOD.replace('"order": 2', '"order": -2').encode(),
        GOOD.replace("proved", "pr\\u006fved").encode() + b" x",
        (GOOD + GOOD).encode(),
    ],
    ids=range(21),
)
def test_other_files_are_refused_in_one_line(check, content):
    refused(check, content)


@pytest.mark.parametrize("version", [0, 3, 999, None, "1"])
def test_the_message_names_an_unknown_schema_version_and_the_known_one(check, version):
    body = sealed(CERTIFICATES["refuted"] | {"schema": version, "news": []})
    refused(check, body, re.escape(f"schema version {version!r} is unknown: this checker supports versions 1, 2"))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"N": 4097}, "wrong N"),
        ({"N": 10**19}, "wrong N"),
        ({"order": 1001}, "wrong N, order"),
        ({"N": 4096, "order": 1000}, "wrong N, order"),
        ({"N": 0}, "wrong N"),
        ({"N": 1}, "wrong N"),
        ({"model": "alpha+beta"}, "or model"),
        ({"N": 200, "seeds": list(range(1, 66))}, "seeds"),
        ({"seeds": []}, "seeds"),
        ({"seeds": [3, 2]}, "seeds"),
        ({"seeds": [2, 2]}, "seeds"),
        ({"seeds": [2, 6]}, "seeds"),
        ({"points": [CERTIFICATES["refuted"]["points"][0] | {"frequencies": [i, i + 1]} for i in range(257)]}, "points"),
    ],
    ids=lambda change: str(change)[:40],
)
def test_absurd_sizes_are_refused(check, change, reason):
    refused(check, sealed(CERTIFICATES["refuted"] | change), reason)


@pytest.mark.parametrize(
    "monomial", [[5, 0, 0], [5, 0, 0, 0, 0], [4, 0, 0, 0], [6, -1, 0, 0], [], [5, 0, 0, None], [[5], 0, 0, 0], "5000", {}]
)
def test_absurd_monomials_are_refused(check, monomial):
    i = next(i for i, e in enumerate(CERTIFICATES["refuted"]["excited"]) if e["order"] == 2)
    refused(check, sealed(replaced(CERTIFICATES["refuted"], ("excited", i, "monomial"), monomial)))


LARGE = {
    ("excited", 0, "order"): "the order of a mode",
    ("excited", 0, "mode"): "a mode that is excited",
    ("excited", 0, "monomial", 0): "an exponent of a monomial",
    ("vanishing", 0, "mode"): "a mode that vanishes",
    ("vanishing", 0, "orders", 0): "an order at which a mode vanishes",
    ("points", 0, "prime"): "a prime",
    ("points", 0, "frequencies", 0): "a frequency",
}


@pytest.mark.parametrize("path", LARGE, ids=str)
def test_a_large_number_is_refused_before_it_is_used(check, path):
    """The order of one mode, 10^9, used to take 8.5 GB."""
    certificate = next(c for c in CERTIFICATES.values() if c[path[0]])
    refused(check, sealed(replaced(certificate, path, 10**20 - 1)), LARGE[path])


def test_couplings_of_many_factors_count_as_many_steps():
    """One product of 1000 factors has 4N signed sums for each of them."""
    assert coupling_steps(4096, 2) == coupling_steps(4096, 3) == 0
    assert coupling_steps(4096, 1000) > 1000 * coupling_steps(4096, 8)
    with pytest.raises(CertificateError, match="2 million steps"):
        Budget().spend(coupling_steps(4096, 1000) * 4)


@pytest.mark.long
def test_work_without_end_is_refused(check):
    """A long chain of excited modes whose witness would need a monomial with 10^20 divisors; an identity of high degree."""
    N, seeds, order = 101, list(range(1, 41)), 39
    where = point(N, seeds)
    rest = [q for q in range(1, N) if q not in seeds]
    place = dict.fromkeys(seeds, 0) | {rest[0]: order}
    predicted = rule_by_sums(N, seeds, order)
    expected = {q: k for k, modes in enumerate(predicted) for q in modes}
    body = CERTIFICATES["alpha"] | {
        "N": N,
        "seeds": seeds,
        "order": order,
        "rule": predicted,
        "actual": [seeds, *([] for _ in range(order - 1)), rest[:1]],
        "exceptions": [{"mode": q, "predicted": expected[q], "actual": place.get(q)} for q in rest],
        "verdict": "undecided",
        "points": [where],
        "excited": [{"mode": rest[0], "order": order, "point": 0, "monomial": [1, 0] * 40, "residue": 1}],
        "vanishing": [],
        "undecided": [{"mode": q, "orders": list(range(1, place.get(q, order + 1))), "error_probability": "0.5"} for q in rest],
    }
    refused(check, sealed(body), "2 million steps")
    body["vanishing"] = [e | {"by": "identity"} for e in body["undecided"][:1]]
    del body["vanishing"][0]["error_probability"]
    body |= {"undecided": body["undecided"][1:], "verdict": "refuted"}
    refused(check, sealed(body), "steps|not zero")


def rule_by_sums(N, seeds, order):
    """D_0 .. D_order of the alpha model for many seeds, from the folded sums of the order before."""
    sums, seen, sequence = {folded(q, N) for q in seeds}, {0, N}, []
    for _ in range(order + 1):
        sequence.append(sorted(sums - seen))
        seen |= sums
        sums = {folded(a + sign * q, N) for a in sums for q in seeds for sign in (1, -1)}
    return sequence
