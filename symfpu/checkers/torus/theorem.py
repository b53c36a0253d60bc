"""The claims in order, and what they say."""

from fractions import Fraction

from symfpu.checkers.reading import Json, dyadic, need
from symfpu.checkers.rounding import scientific
from symfpu.checkers.torus.claim import Claim, read_claim
from symfpu.checkers.torus.energy import check_energy
from symfpu.checkers.torus.residual import check_residual, residuals
from symfpu.checkers.torus.stay import check_stay


def check_certificate(data: Json) -> list[str]:
    """What has been proved, in sentences."""
    claim = read_claim(data)
    stated = dyadic(data["residual"], "residual")
    found = residuals(claim)
    check_residual(found, stated)
    lines = [residual_text(claim, data, stated)]
    lines += check_energy(claim, found, data["energy"])
    if data["stay"]:
        return [*lines, *check_stay(data, claim, found)]
    empty = not (data["directions"] or data["weights"])
    need(empty and data["frame_bits"] == data["rate_bits"] == 0, "a frame without a claim")
    return lines


def residual_text(claim: Claim, data: Json, stated: Fraction) -> str:
    """The first theorem."""
    law = " + ".join(f"({c}) r^{k + 1}/{k + 1}" for k, c in claim.couplings.items())
    digits = [scientific(w, 12) for w in claim.omega]
    exact = list(map(Fraction, digits)) == claim.omega
    omega = ", ".join(digits) if exact else f"near {', '.join(digits)} (exact in it)"
    return (
        f"theorem: in the chain of N = {claim.N} bonds with fixed ends and V = r^2/2 + {law} the "
        f"torus of the certificate, {len(data['torus'])} harmonics of {claim.angles} angles with "
        f"frequencies {omega}, leaves |x'' - force| <= {scientific(stated)} of every particle at "
        f"all angles"
    )
