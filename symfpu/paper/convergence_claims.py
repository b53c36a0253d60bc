"""What section 3.2 gives as reasons for the curves of Fig. 1(b, c), each switched off in turn."""

from __future__ import annotations

import numpy as np

from symfpu.paper.claims import Claim, judged
from symfpu.paper.convergence_fig1 import CancellationStudy, Variant

STATED_ORDER = 30  # "up to our maximum reached expansion order k = 30"
SAME_CURVE = 0.05  # decades that a curve may move where nothing has changed
POLE_MET = 1e-3  # relative, of the growth that the pole predicts
PRINTED, PRECISE, ROUNDED, APPENDED = range(4)  # of the variants, in their order
FIGURE = "Fig. 1(b)"


def convergence_claims(data: CancellationStudy) -> tuple[Claim, ...]:
    """Incommensurable to order 30, and the two reasons that the paper offers."""
    return incommensurable_claim(data), commensurable_claim(data), digits_claim(data)


def incommensurable_claim(data: CancellationStudy) -> Claim:
    """No harmonic of the orders computed comes to rest."""
    first, second = data.coincidence
    order = abs(first) + abs(second) - 1
    text = "the frequencies of Fig. 1 are practically incommensurable up to order 30"
    ours = f"the first harmonic that comes to rest, {first} omega_1 {second:+d} omega_2, "
    ours += f"is at order {order}"
    return Claim("3.2", text, "30", ours, judged(order > STATED_ORDER))


def commensurable_claim(data: CancellationStudy) -> Claim:
    """Fig. 1(b): with incommensurable digits appended the amplitudes would settle further."""
    printed, appended = data.variants[PRECISE], data.variants[APPENDED]
    moved = _settling_moved(printed, appended)
    text = f"the amplitudes stop settling ({FIGURE}) because the frequencies become "
    text += "commensurable at this level of precision"
    ours = "with incommensurable digits from the ninth place on the curve moves by "
    ours += f"{moved:.1e} decades at most; {_reason(data)}"
    return Claim("3.2", text, "", ours, _verdict(data, moved))


def digits_claim(data: CancellationStudy) -> Claim:
    """Fig. 1(c): with more digits of the amplitudes cancellations would go on."""
    precise = data.variants[PRECISE]
    moved = max(
        _sums_moved(precise, data.variants[PRINTED]),
        _sums_moved(precise, data.variants[ROUNDED]),
    )
    text = "the limit of the cancellations (Fig. 1(c)) is due to the finite precision "
    text += "of the amplitudes"
    ours = f"in doubles, with {precise.name} and with {data.variants[ROUNDED].name} "
    ours += f"S_2 is the same within {moved:.1e} decades; {_reason(data)}"
    return Claim("3.2", text, "", ours, _verdict(data, moved))


def _settling_moved(one: Variant, other: Variant) -> float:
    """Decades between the larger Delta A(k) of two variants, at most."""
    found = []
    for k in one.differences.keys() & other.differences.keys():
        a, b = max(one.differences[k]), max(other.differences[k])
        if a > 0 and b > 0:
            found.append(abs(np.log10(a / b)))
    return float(max(found))


def _sums_moved(one: Variant, other: Variant) -> float:
    """Decades between S_2(k) of two variants, at most; of the orders where it is not 0."""
    both = (one.sums > 0) & (other.sums > 0)
    return float(np.abs(np.log10(one.sums[both] / other.sums[both])).max())


def _reason(data: CancellationStudy) -> str:
    last = max(data.ratios)
    return (
        f"a pole of the series at {data.pole**0.5:.3f} mu makes terms grow by "
        f"{1 / data.pole:.5f} every two orders, and they do by {data.ratios[last]:.5f}"
    )


def _verdict(data: CancellationStudy, moved: float) -> str:
    """A reason that can be taken away without effect is none, where another one is met."""
    grown = data.ratios[max(data.ratios)]
    pole_met = abs(grown * data.pole - 1) <= POLE_MET
    return judged(moved > SAME_CURVE, not pole_met)
