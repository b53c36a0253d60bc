"""Proofs of stability, for JSON and for the terminal."""

from __future__ import annotations

from symfpu.certified.stability_proof import StabilityProof
from symfpu.numbers.counted import counted
from symfpu.numbers.one_sided import above, below
from symfpu.numbers.typed import decimal

MOST_GAPS = 5


def stability_text(proof: StabilityProof) -> str:
    """The theorem, the smallest gaps or the growth, and the bounds."""
    orbit = proof.existence
    chain = orbit.chain.label
    word = "linearly stable" if proof.stable else "linearly unstable"
    given = f"omega = {decimal(orbit.frequency)}"
    if orbit.fixed != "frequency":
        given = f"{orbit.condition}, {given} +- {above(orbit.frequency_radius, 1)}"
    first = f"{chain}, seed {orbit.seed}, {given}: {word}, proved"
    lines = [first, f"  {proof.theorem}"]
    for gap in proof.gaps[:MOST_GAPS]:
        left, right = gap.between
        lines.append(
            f"  gap {below(gap.least, 6)} .. {above(gap.most, 6)} omega: {left}; {right}"
        )
    for one in proof.exponents:
        if not one.circle:
            least, most = one.growth
            lines.append(
                f"  sigma = {one.sigma:.10g} within {above(one.radius, 2)}: "
                f"grows with a rate of {below(least, 9)} .. {above(most, 9)}"
            )
    count = counted(len(proof.exponents), "exponent")
    largest = max((e.block for e in proof.exponents), default=0)
    linear = max((e.linear for e in proof.exponents), default=0.0)
    lines.append(f"  {count}; Z up to {linear:.3g}, blocks up to {largest}")
    return "\n".join(lines)
