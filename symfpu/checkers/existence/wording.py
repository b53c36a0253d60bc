"""What has been proved, in one sentence."""

from fractions import Fraction
from math import floor
from typing import Any

from symfpu.checkers.existence.claim import AMPLITUDE, ENERGY, FREQUENCY, Claim, Force
from symfpu.checkers.existence.reading import stated
from symfpu.checkers.reading import Json
from symfpu.checkers.rounding import scientific

SIGNS = {FREQUENCY: "frequency omega", AMPLITUDE: "amplitude A", ENERGY: "energy H"}


def theorem_text(claim: Claim, data: Json, radius: Fraction, unique: Fraction) -> str:
    """What has been proved, in one sentence."""
    start = f"theorem: {chain_of(claim)} and {law(claim.force)} has"
    moving = "even in time" if not claim.shape.travelling else wave_of(claim)
    where = "of the certificate" if not claim.half_width else "of a line in the certificate"
    only = (
        "it is the only one"
        if not claim.bordered
        else "it and its frequency are the only ones"
    )
    return (
        f"{start} {orbits(claim)}, {moving}, whose bond stretches "
        f"differ from those {where} by at most {scientific(radius)} at all times "
        f"and in the strip |Im omega t| <= log({claim.nu}); with the symmetry of seed "
        f"{claim.shape.seed} "
        f"{only} within {scientific(unique, rounded=floor)} in the weighted norm; "
        f"{', '.join(stated_intervals(claim, data))}"
    )


def chain_of(claim: Claim) -> str:
    """The chain, without its law."""
    if claim.shape.travelling:
        return f"the ring of N = {claim.N} particles with as many bonds"
    return f"the chain of N = {claim.N} bonds with fixed ends"


def wave_of(claim: Claim) -> str:
    """How a wave moves."""
    phase = f"omega t - 2 pi ({claim.shape.seed}) (j + 1/2)/{claim.N}"
    return f"a travelling wave r_j(t) = r({phase}) of an even function r"


def elsewhere(claim: Claim) -> str:
    """Of which other chain it is an orbit."""
    if claim.shape.travelling:
        return "reflected, x_(N-j) -> -x_j, it is a wave of the opposite seed"
    ring = f"the ring of {2 * claim.N} particles"
    return f"unfolded, x_(2N-j) = -x_j, it is a periodic orbit of {ring}"


def orbits(claim: Claim) -> str:
    """One orbit, or a segment of a family."""
    name, value = SIGNS[claim.fixed], shown(claim.value)
    if not claim.half_width:
        return f"a periodic orbit of {name} = {value}"
    ends = [shown(claim.value + x) for x in (-claim.half_width, claim.half_width)]
    return f"for every {name} from {ends[0]} to {ends[1]}, on one analytic curve, a periodic orbit"


def law(force: Force) -> str:
    """V, or V' by its functions."""
    if not force.growths:
        terms = (f"({c}) r^{k + 1}/{k + 1}" for k, c in force.couplings.items())
        return f"V = r^2/2 + {' + '.join(terms)}"
    parts = []
    for weight, slope, rate in force.growths:
        plain = f"exp({rate} r)" if not slope else f"(1 + {slope} r)^({rate / slope})"
        parts.append(f"({weight}) ({plain} - 1)")
    return f"V' = {' + '.join(parts)}"


def stated_intervals(claim: Claim, data: Json) -> list[str]:
    """Of A, H and omega, without what is given."""
    found = []
    if claim.bordered and claim.fixed != FREQUENCY:
        found.append(f"omega = {decimal_interval(data['frequency'])}")
    if claim.fixed != AMPLITUDE:
        found.append(f"A = {decimal_interval(data['amplitude'])}")
    if claim.fixed != ENERGY:
        found.append(f"H = {decimal_interval(data['energy'])}")
    return found


def shown(x: Fraction) -> str:
    """A fraction, or its first digits where it is long."""
    return str(x) if len(str(x)) <= 40 else f"{scientific(x, 20)} (exactly {x})"


def decimal_interval(entry: Any) -> str:
    """Enough digits of the middle +- the radius, rounded up with what those digits are off by."""
    low, high = stated(entry, "interval")
    middle, half = (low + high) / 2, (high - low) / 2
    digits = max(1, len(str(int(abs(middle) / half))) + 1) if half else 40
    text = scientific(middle, digits)
    return f"{text} +- {scientific(half + abs(middle - Fraction(text)))}"
