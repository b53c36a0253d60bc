"""Independent checker of propagation certificates: mode space, B and C summed directly, Python integers, nothing else of ours.

A monomial m = (p_1, n_1, ..) holds exponents of w_i = Omega_i z_i and conj w_i, nu = p - n. With u_q = Omega_q Q_q (Eqs. moda, modb)
u_q^(k)[m] = L_q(nu) (sum_n W_q^(n) u_q^(k-n) - S_q^(k))[m], S = sum B u u or sum C u u u, W_q^(n)[f] = S_q^(n)[f w_q]. Over F_p a
residue that is not 0 proves a mode excited for generic frequencies; with symbols for L_q(nu) a zero polynomial proves a zero.
"""

import hashlib
import json
import re
from functools import lru_cache, reduce
from itertools import combinations_with_replacement, pairwise, product
from math import comb, prod
from operator import or_, sub
from pathlib import Path
from typing import Any

KEYS = "N actual digest excited exceptions format model order points rule schema seeds undecided vanishing verdict"
BYTES, PIECES, PARTS, STEPS = 2**26, 10**6, 200_000, 2 * 10**8  # most bytes and values in a file, divisors of a monomial, work
PROBABILITY = re.compile(r"1(\.0+)?(e[+-]?0+)?|0\.0*[1-9]\d*|[1-9]\d?(\.\d+)?e-\d{1,4}(?<!e-0)(?<!e-00)", re.ASCII)  # in (0, 1]
BASES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41)  # Miller-Rabin with these is a proof below 3.3e24
Monomial = tuple[int, ...]
Vector = dict[int, Any]  # mode -> value


class CertificateError(ValueError):
    """Why a certificate is refused, in one line."""


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file; raises CertificateError, with the reason, if it is not right."""
    try:
        return check(load(Path(path)))
    except CertificateError:
        raise
    except (OSError, ValueError, RecursionError) as error:
        raise CertificateError(f"not a readable certificate: {' '.join(str(error).split()):.200}") from error


def need(condition: object, reason: str) -> None:
    if not condition:
        raise CertificateError(reason)


def load(path: Path) -> dict[str, Any]:
    """The object in a file, once its sizes are bounded; every number in it is an integer of at most 20 digits."""
    need(path.stat().st_size <= BYTES and not path.stat().st_mode & 0o170000 ^ 0o100000, f"not a regular file of at most {BYTES} bytes")
    text = path.read_text("ascii")
    need(sum(map(text.count, ',[{"')) <= PIECES, f"the file has more than {PIECES} values")
    data = json.loads(text, parse_int=integer, parse_float=integer, parse_constant=integer)
    need(type(data) is dict and data.get("format") == "symfpu propagation certificate", "not a propagation certificate")
    need(canonical(data.get("schema")) == "1", f"schema version {canonical(data.get('schema')):.40} is unknown; supported is version 1")
    need(" ".join(sorted(data)) == KEYS and canonical(data).count(":") == text.count(":"), f"the keys are not exactly {KEYS}")
    digest = hashlib.sha256(canonical({key: data[key] for key in data.keys() - {"digest"}}).encode()).hexdigest()
    need(data["digest"] == digest, "the digest is not that of the contents")
    return data


def integer(digits: str) -> int:
    need(digits.isdigit() and len(digits) <= 20, f"{digits:.40} is not an integer of at most 20 digits")
    return int(digits)


def canonical(value: Any) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"))
