"""Independent checker of propagation certificates: mode space, the tensors B and C summed directly, Python integers only.

m = (p_1, n_1, ..) are the exponents of w_i = Omega_i z_i and conj w_i, nu = p - n, u_q = Omega_q Q_q, S = sum B u u or sum C u u u:
u_q^(k)[m] = L_q(nu) (sum_n W_q^(n) u_q^(k-n) - S_q^(k))[m], W_q^(n)[f] = S_q^(n)[f w_q] (Eqs. moda, modb). A coefficient that is not
0 modulo p proves a mode excited for generic frequencies; with symbols for the L_q(nu), a polynomial that is 0 proves a zero.
"""

import hashlib
import json
import re
from itertools import combinations_with_replacement, product
from operator import mul, sub
from pathlib import Path
from typing import Any

PROBABILITY = re.compile(r"1(\.0+)?(e[+-]?0+)?|0\.0*[1-9][0-9]*|[1-9](\.[0-9]+)?e-0*[1-9][0-9]*")  # decimal, above 0 and up to 1
BASES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41)  # with these Miller-Rabin is a proof below 3.3e24
Polynomial = dict[tuple[Any, ...], int]  # sorted symbols -> coefficient; a residue is a constant


class CertificateError(ValueError):
    """Why a certificate is refused, in one line."""


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file; raises CertificateError, with the reason, if it is not right."""
    try:
        return Checker(Path(path)).report()
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError) as error:
        raise error if isinstance(error, CertificateError) else CertificateError(f"no readable certificate: {error!r:.200}") from None


def need(condition: object, reason: str) -> None:
    if not condition:
        raise CertificateError(reason)


def couplings(N: int, *modes: int) -> list[tuple[int, int]]:
    """Each q with B_qlm or C_qlmn, where that is not zero: Eq. transa, with the sums -2N that it leaves out."""
    sums = [sum(map(mul, modes, signs)) for signs in product((1, -1), repeat=len(modes))]
    values = {q: sums.count(-q) - sums.count(2 * N - q) - sums.count(-2 * N - q) for q in {-t % (2 * N) for t in sums}}
    return [(q, value) for q, value in values.items() if value and 0 < q < N]


class Checker:
    def __init__(self, path: Path) -> None:
        """Reads the file, sizes bounded first; as neither floats, booleans nor minus signs are let in, == and < are exact later."""
        need(path.stat().st_size <= 2**26 and path.is_file(), "not a regular file of at most 64 MB")
        text = path.read_text("ascii", "replace")
        bare = re.sub(r'"[^"\\]*"', '"', text)
        need(sum(map(bare.count, ',[{"')) <= 10**6, "the file has more than 10^6 values")
        need(not re.search(r'[^\s0-9{}\[\],:nul"]|[0-9]{21}', bare), "not JSON of plain strings, null and integers of at most 20 digits")
        self.data = data = json.loads(text)
        need(data["format"] == "symfpu propagation certificate", "not a propagation certificate")
        need(data["schema"] == 1, f"schema version {data['schema']!r:.40} is unknown: this checker supports version 1")
        body = json.dumps({key: data[key] for key in data if key != "digest"}, sort_keys=True, separators=(",", ":"))
        need(data["digest"] == hashlib.sha256(body.encode()).hexdigest(), "the digest is not that of the contents")
        rows = data["exceptions"] + data["undecided"] + data["points"] + data["vanishing"] + data["excited"]
        need(bare.count(":") == 15 + 3 * len(rows) + 2 * len(data["excited"]), "a key is missing, unknown or there twice")
        self.N, self.K, self.seeds, self.step, self.steps = data["N"], data["order"], data["seeds"], 1 + (data["model"] == "beta"), 0
        need(1 < self.N <= 4096 and max(1000, self.N) * self.K <= 10**6 and data["model"] in ("alpha", "beta"), "wrong N, order or model")
        need(self.seeds == sorted({q for q in self.seeds if 0 < q < self.N})[:64] != [], "seeds are not 1 to 64 ascending modes")
        self.point = 0, 0, list[int](), dict[Any, Any]()  # prime (0: symbols), root, frequencies, terms so far

    def counted(self, items: Any) -> Any:
        for item in items:
            self.steps += 1
            need(self.steps <= 2 * 10**6, "checking it would take more than 2 million steps")
            yield item

    def add(self, total: dict[int, Polynomial], q: int, x: Polynomial, y: Polynomial, sign: int = 1) -> Polynomial:
        value, p = total.setdefault(q, {}), self.point[0]
        for (a, s), (b, t) in self.counted(product(x.items(), y.items())):
            c = value.get(key := tuple(sorted(a + b)), 0) + sign * s * t
            value[key] = c % p if p else c
        return value

    def products(self, r: int, m: tuple[int, ...]) -> Any:
        """Modes l1 .. lr and value of each u_l1 .. u_lr at monomial m; its degree fixes the sum of the orders."""
        if r == 1:
            yield from (((q,), x) for q, x in self.term(m)[0].items())
        for f in self.counted(product(*(range(e + 1) for e in m))) if r > 1 else ():
            for q, x in self.term(f)[0].items() if 0 < sum(f) < sum(m) else ():
                yield from (((q, *modes), self.add({}, q, x, y)) for modes, y in self.products(r - 1, tuple(map(sub, m, f))))

    def term(self, m: tuple[int, ...]) -> Any:
        """By mode, u[m] and its bracket, computed where first asked for; the bracket is -W at the harmonic of a seed itself."""
        (p, g, omega, terms), nu = self.point, tuple(map(sub, m[::2], m[1::2]))
        if m in terms or sum(m) <= 1 or (sum(m) - 1) % self.step:
            return terms.get(m, ({self.seeds[m.index(1) // 2]: {(): 1}} if sum(m) == 1 else {}, {}))
        u, bracket = terms.setdefault(m, ({}, {}))
        for modes, x in self.products(self.step + 1, m):
            for q, coupling in couplings(self.N, *modes):
                self.add(bracket, q, {(): 1}, x, -coupling)
        for f, (i, q) in product(product(*(range(e + 1) for e in m)), enumerate(self.seeds)):
            if f[::2] == f[1::2] and 0 < sum(f) < sum(m) - 1 and (x := self.term(tuple(map(sub, m, f)))[0].get(q)):
                self.add(bracket, q, self.term((*f[: 2 * i], f[2 * i] + 1, *f[2 * i + 1 :]))[1].get(q, {}), x, -1)
        for q in bracket.keys() - {q for q, e in zip(self.seeds, nu, strict=True) if abs(e) == 1 == sum(map(abs, nu))}:
            L: Polynomial = {((q, max(nu, tuple(-n for n in nu))),): 1}
            if p:
                square = 2 - pow(g, 2 * q, p) - pow(g, -2 * q, p)  # Omega_q^2 = 2 - 2 cos(q pi / N)
                divisor = (omega[self.seeds.index(q)] ** 2 if q in self.seeds else square) - sum(map(mul, nu, omega)) ** 2
                need(divisor % p, f"the divisor of mode {q} at harmonic {nu} is zero modulo {p}")
                L = {(): square * pow(divisor, -1, p)}
            self.add(u, q, L, bracket[q])
        return u, bracket

    def report(self) -> list[str]:
        """Compares what is said of the orders with what follows from it; then checks zeros, points and witnesses."""
        data, N, K, s, seeds = self.data, self.N, self.K, len(self.seeds), self.seeds
        points, excited, zeros, doubts = (data[key] for key in ("points", "excited", "vanishing", "undecided"))
        order = {e["mode"]: e["order"] for e in excited} | dict.fromkeys(seeds, 0)
        for names in ([(e["mode"], e["by"]) for e in zeros], *([e["mode"] for e in rows] for rows in (doubts, excited))):
            need(names == sorted(set(names)), f"not ascending, or twice: {names!r:.200}")
        claims = sorted((e["mode"], j) for e in zeros + doubts for j in e["orders"] or [0] if e["orders"] == sorted(e["orders"]))
        need(claims == [(q, j) for q in range(1, N) for j in range(1, order.get(q, K + 1))], "vanishing, undecided: wrong orders")
        need(all(PROBABILITY.fullmatch(e["error_probability"]) for e in doubts), "an error_probability is not in (0, 1]")
        M, shifts = [set(seeds)], {sum(t) for t in product([*seeds, *(-q for q in seeds)], repeat=self.step)}
        for _ in range(K):
            M.append({min(t % (2 * N), -t % (2 * N)) for t in map(sum, self.counted(product(M[-1], shifts)))})
        rule = [sorted(modes.difference({0, N}, *M[:k])) for k, modes in enumerate(M)]  # Eqs. app, dk, folded at every order
        places, unsure = {q: k for k, modes in enumerate(rule) for q in modes}, {e["mode"] for e in doubts}
        exceptions = [{"mode": q, "predicted": places.get(q), "actual": order.get(q)} for q in range(1, N) if places.get(q) != order.get(q)]
        verdict = "refuted" if {e["mode"] for e in exceptions} - unsure else "undecided" if unsure else "proved"
        actual = [sorted(q for q in order if order[q] == k) for k in range(K + 1)]
        for key, value in (("rule", rule), ("actual", actual), ("exceptions", exceptions), ("verdict", verdict)):
            need(data[key] == value, f"{key} is not {value!r:.200}")
        need(len(order) == s + len(excited) == sum(map(len, actual)), "excited: a mode is a seed, or beyond the order")
        M = [set(seeds)]  # M_k: what B or C couples to the sets before; and seeds reached before, kept by frequency corrections
        for k in range(1, 1 + max((j for e in zeros if e["by"] == "couplings" for j in e["orders"]), default=0)):
            M.append({q for q in seeds if any(q in modes for modes in M[1:])})
            for ls in (ls for ls in self.counted(combinations_with_replacement(range(k), self.step + 1)) if sum(ls) == k - 1):
                M[k].update(q for modes in self.counted(product(*(M[l] for l in ls))) for q, _ in couplings(N, *modes))
        for q, by, j in ((e["mode"], e["by"], j) for e in zeros for j in e["orders"]):
            need(by == "identity" or (by == "couplings" and q not in M[j]), f"mode {q} at order {j} does not vanish by {by!r:.40}")
            for c in combinations_with_replacement(range(2 * s), 1 + j * self.step) if by == "identity" else ():
                need(not any(self.term(tuple(map(c.count, range(2 * s))))[0].get(q, {}).values()), f"mode {q} at order {j} is not zero")
        need(len(points) < 257 and all(e["point"] < len(points) for e in excited) and all(points.count(e) < 2 for e in points), "points")
        for i, (p, g, omega) in enumerate((e["prime"], e["root"], e["frequencies"]) for e in points):
            powers = ([pow(a, p - 1 >> h, p) for h in range(1, ((p - 1) & (1 - p)).bit_length())] for a in BASES)
            need(2**16 < p < 2**64 and p % (4 * N) == 1 and all(x[-1] == 1 or p - 1 in x for x in powers), f"{p} is no prime of use")
            need(g < p and [d for d in range(1, 4 * N + 1) if 4 * N % d == 0 == pow(g, d, p) - 1] == [4 * N], f"{g} is not of order 4N")
            need(omega == [w for w in omega if w < p] and len(omega) == s, f"frequencies are not residues modulo {p}")
            self.point = p, g, omega, {}
            for q, k, m, r in ((e["mode"], e["order"], e["monomial"], e["residue"]) for e in excited if e["point"] == i):
                need(len(m) == 2 * s and sum(m) == 1 + k * self.step, f"mode {q}: the monomial has not the degree of order {k}")
                need(0 < r == self.term(tuple(m))[0].get(q, {}).get(()), f"mode {q}: the residue is not {r}")
        about = f"{data['model']} chain, N = {N}, seeds {seeds}, orders to {K}: rule, orders and exceptions follow; {verdict}"
        witnesses = f"{len(excited)} modes excited: residues computed again, modulo {[e['prime'] for e in points]}, in {self.steps} steps"
        return [about, witnesses, f"{len(claims)} zeros before: by couplings or identity; undecided, not checked: modes {sorted(unsure)}"]
