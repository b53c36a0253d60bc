"""The record of every result: one dictionary that JSON can hold, with the same keys everywhere."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from numbers import Integral
from typing import Any

import mpmath
import numpy as np

from symfpu.action_angle.twist import Twist
from symfpu.borders.atlas import Atlas
from symfpu.borders.laws import BorderLaw
from symfpu.breathers.floquet import Floquet
from symfpu.bundles.bundle import Bundle
from symfpu.certified.existence import ExistenceProof
from symfpu.certified.residual import ResidualProof
from symfpu.certified.stability_proof import StabilityProof
from symfpu.certified.stay import StayProof
from symfpu.chain.length import label_entry
from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.dynamics.orbits import Orbit
from symfpu.errors import InputError
from symfpu.families.family import Family
from symfpu.families.members import Event, Member
from symfpu.families.normal_events import NormalEvent
from symfpu.families.normal_family import NormalFamily
from symfpu.frames.attributes import exact_text
from symfpu.frames.tabled import Tabled
from symfpu.localization.laws import ProfileLine
from symfpu.localization.profiles import ProfileDistance
from symfpu.normal.modes import NormalModes
from symfpu.numbers.arithmetic import text
from symfpu.proofs.certificates import PropagationProof
from symfpu.proofs.sweeps import Sweep
from symfpu.proofs.theorem import RuleForAllN
from symfpu.reports.action_angle import twist_record
from symfpu.reports.borders import atlas_record, law_record
from symfpu.reports.certified import residual_proof_record, stay_record
from symfpu.reports.dynamics import alignment_record, orbit_record
from symfpu.reports.existence import existence_record
from symfpu.reports.family import event_record, family_record, member_record
from symfpu.reports.head import headed
from symfpu.reports.normal import normal_event_record, normal_family_record, normal_record
from symfpu.reports.proofs import proof_record, sweep_record
from symfpu.reports.series import assessment_record, series_record
from symfpu.reports.solution import floquet_record, solution_record
from symfpu.reports.stability_proof import stability_record
from symfpu.reports.tables import fifteen_digits
from symfpu.series.series import LindstedtSeries
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment

Json = dict[str, Any]

LARGEST_NUMBER = 10**15  # of whole numbers in JSON: what all readers keep
BITS_A_DIGIT = 3.33


def record(result: object) -> Json:
    """The record of a result; raises InputError for what is none."""
    for kind, made in KINDS:
        if isinstance(result, kind):
            return headed({"kind": type(result).__name__} | made(result))
    if isinstance(result, Tabled):
        return headed({"kind": type(result).__name__} | _columns(result))
    allowed = "a result with a record"
    raise InputError("result", type(result).__name__, allowed, "pass what symfpu computed")


def _columns(result: Tabled) -> Json:
    """What holds for its whole table, and the columns, as docs/tables.md has them."""
    table = result._table()
    found: Json = {}
    chain, seeds = getattr(result, "chain", None), getattr(result, "seeds", None)
    if chain is not None:
        found |= chain.typed
    if isinstance(seeds, tuple):
        found["seeds"] = list(map(label_entry, seeds))
    if hasattr(result, "verdict"):
        found["verdict"] = result.verdict
    about = table.attributes.items()
    left_out = {"result", "units", "chain", "symfpu_version", *found}
    found["about"] = {key: plain(value) for key, value in about if key not in left_out}
    columns = table.columns.items()
    found["columns"] = {name: plain(list(values)) for name, values in columns}
    return found


def plain(value: Any) -> Any:
    """A value of a result as JSON can hold it.

    Whole numbers stay numbers, all others become text that loses no digit; complex ones are their
    real and imaginary parts.

    >>> plain([1, 0.5, None, Fraction(1, 3), 1 + 2j, {1: True}])
    [1, '0.5', None, '1/3', ['1.0', '2.0'], {'1': True}]
    """
    if value is None or isinstance(value, bool | str):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, tuple | list | np.ndarray):
        return [plain(item) for item in value]
    return _number(value)


def _number(value: Any) -> Any:
    if isinstance(value, Integral):
        return int(value) if abs(int(value)) < LARGEST_NUMBER else str(int(value))
    if isinstance(value, Fraction):
        return exact_text(value)
    if isinstance(value, mpmath.mpf):
        return text(value, max(17, int(value.man.bit_length() / BITS_A_DIGIT)))
    if isinstance(value, complex | np.complexfloating):
        return [repr(float(value.real)), repr(float(value.imag))]
    if isinstance(value, float | np.floating):
        return repr(float(value))
    return str(value)


def _sweep_record(sweep: Sweep) -> Json:
    """What the verb prints, and every seed set by column."""
    return sweep_record(sweep) | {"columns": _columns(sweep)["columns"]}


def _theorem_record(proof: RuleForAllN) -> Json:
    """The theorem, and every family of seed sets that it excepts."""
    return {
        "model": proof.model,
        "seeds_number": proof.seeds_number,
        "order": proof.order,
        "verdict": proof.verdict,
        "reason": proof.reason,
        "theorem": proof.theorem,
        "flats": proof.flats,
        "exceptional_flats": [plain(vars(flat)) for flat in proof.exceptional_flats],
        "gaps": [[found.flat.N, *found.flat.seeds] for found in proof.gaps],
    }


def _bundle_record(bundle: Bundle) -> Json:
    """What the file holds, and what made it."""
    return record(bundle.result) | {
        "provenance": dict(bundle.provenance),
        "assessment": bundle.verdict,
        "test_vectors": [plain(point._asdict()) for point in bundle.test_vectors],
    }


def _line_record(line: ProfileLine) -> Json:
    return {name: fifteen_digits(value) for name, value in vars(line).items()}


def _distance_record(found: ProfileDistance) -> Json:
    size = fifteen_digits(found.distance)
    return {"distance": size, "mode": found.mode, "modes": found.modes}


KINDS: tuple[tuple[type, Callable[[Any], Json]], ...] = (
    (Torus, solution_record),
    (ExistenceProof, existence_record),
    (StabilityProof, stability_record),
    (ResidualProof, residual_proof_record),
    (StayProof, stay_record),
    (LindstedtSeries, series_record),
    (Assessment, assessment_record),
    (Family, family_record),
    (Member, member_record),
    (Event, event_record),
    (Floquet, floquet_record),
    (Orbit, orbit_record),
    (AlignmentIndices, alignment_record),
    (PropagationProof, proof_record),
    (RuleForAllN, _theorem_record),
    (Sweep, _sweep_record),
    (NormalModes, normal_record),
    (NormalEvent, normal_event_record),
    (NormalFamily, normal_family_record),
    (Twist, twist_record),
    (ProfileLine, _line_record),
    (ProfileDistance, _distance_record),
    (Bundle, _bundle_record),
    (Atlas, atlas_record),
    (BorderLaw, law_record),
)
