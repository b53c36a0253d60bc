"""Every claim of a theorem for every N in turn."""

from pathlib import Path

from symfpu.checkers.every_length.arrangement import arrangement
from symfpu.checkers.every_length.claim import Theorem, read_claim, read_flats
from symfpu.checkers.every_length.deciding import check_flat
from symfpu.checkers.every_length.evidence import NOTHING, read_evidence
from symfpu.checkers.every_length.flats import check_flats, unlisted
from symfpu.checkers.every_length.reading import read_theorem
from symfpu.checkers.reading import Json, need, verified


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


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked, the theorem first.

    Raises CertificateError, with the reason, if the certificate is not right.
    """
    return verified(path, read_theorem, check_theorem)[1]
