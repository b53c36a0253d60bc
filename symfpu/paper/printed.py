"""Examples and printed numbers of the paper.

Christodoulidi & Efthymiopoulos, "Low-dimensional q-tori in FPU lattices", Physica D (2013).

Data only. Frequencies, amplitudes and energies are the digits printed in Appendix F (Eq. Table1)
and in the text. `label` names the figure that shows the example; Appendix F's own labels,
`printed_label`, are off by one from Fig. 2 on.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from symfpu.chain.chain import Chain


@dataclass(frozen=True)
class PrintedTorus:
    """One example: chain, seeds, chosen frequencies and coordinate order.

    The amplitudes and the energy are as printed.
    """

    label: str
    printed_label: str
    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[str, ...]
    order: int
    amplitudes: tuple[str, ...]
    energy: str
    energy_source: str


TWO_TORUS = PrintedTorus(
    label="Fig. 1",
    printed_label="section 3.2",
    chain=Chain(N=16, alpha="0.33"),
    seeds=(1, 2),
    frequencies=("0.19626", "0.39046"),
    order=30,
    amplitudes=("0.5848897", "0.4115552"),
    energy="0.02345",
    energy_source="section 3.2, 'total energy'",
)

APPENDIX_F = (
    PrintedTorus(
        label="Fig. 2",
        printed_label="Fig.1",
        chain=Chain(N=32, alpha="0.33"),
        seeds=(1, 2, 3, 4),
        frequencies=(
            "0.09813690483108113",
            "0.19603499627351076",
            "0.29346131418681830",
            "0.39018079936090050",
        ),
        order=11,
        amplitudes=(
            "0.098097447281306230",
            "0.048959912346992665",
            "0.032444239210574590",
            "0.023892612612360370",
        ),
        energy="0.000182466",
        energy_source="caption of Fig. 2, 'E'",
    ),
    PrintedTorus(
        label="Fig. 5a",
        printed_label="Fig.4a",
        chain=Chain(N=32, alpha="0.33"),
        seeds=(1, 11, 21, 31),
        frequencies=(
            "0.09814720863898445",
            "1.0282023436963477",
            "1.7154505429645952",
            "1.9975829222954775",
        ),
        order=11,
        amplitudes=(
            "0.2699420271816366000",
            "0.027437337334704704",
            "0.015901830855243902",
            "0.014550407721151376",
        ),
        energy="0.001563",
        energy_source="section 6.2, Example 1, 'total energy'",
    ),
    PrintedTorus(
        label="Fig. 5b",
        printed_label="Fig.4b",
        chain=Chain(N=64, alpha=1),
        seeds=(60, 61, 62, 63),
        frequencies=(
            "1.9903455323483594",
            "1.9945569202421924",
            "1.9975668544869103",
            "1.9993735255838023",
        ),
        order=8,
        amplitudes=(
            "0.010626655362545707",
            "0.010540492500677328",
            "0.010486090307194270",
            "0.010462240436802113",
        ),
        energy="0.000883",
        energy_source="section 6.2, Example 2, 'energy'",
    ),
    PrintedTorus(
        label="Fig. 5c",
        printed_label="Fig.4c",
        chain=Chain(N=128, alpha=1),
        seeds=(63, 64, 65),
        frequencies=("1.3967520180075357", "1.4142130013133483", "1.4314611496716776"),
        order=16,
        amplitudes=("0.005128073559888574", "0.005045052412361571", "0.004963639646819611"),
        energy="7.63469e-5",
        energy_source="section 6.2, Example 3, 'energy of the system'",
    ),
    PrintedTorus(
        label="Fig. 5d",
        printed_label="Fig.4d",
        chain=Chain(N=128, alpha=1),
        seeds=(94, 95, 96, 97, 98),
        frequencies=(
            "1.8284112766464593",
            "1.8382194182395468",
            "1.8477507307792000",
            "1.8570037790005570",
            "1.8659771693147402",
        ),
        order=9,
        amplitudes=(
            "0.008845316872292220",
            "0.008752766020034742",
            "0.008700391793859069",
            "0.008662026577864702",
            "0.008661383820872627",
        ),
        energy="0.000649478",
        energy_source="section 6.2, Example 4, 'energy'",
    ),
    PrintedTorus(
        label="Fig. 7",
        printed_label="Fig.6",
        chain=Chain(N=32, alpha="0.33"),
        seeds=(1,),
        frequencies=("0.09814109959448596",),
        order=51,
        amplitudes=("0.18574105489382606",),
        energy="0.00016635",
        energy_source="section 6.4.1, 'E'",
    ),
    PrintedTorus(
        label="Fig. 8",
        printed_label="Fig.7",
        chain=Chain(N=32, alpha="0.33"),
        seeds=(25,),
        frequencies=("1.8830741847088537",),
        order=60,
        amplitudes=("0.0512142216322969",),
        energy="0.00465079",
        energy_source="section 6.4.2, 'E'",
    ),
    PrintedTorus(
        label="Fig. 9",
        printed_label="Fig.8",
        chain=Chain(N=32, alpha="0.33"),
        seeds=(1,),
        frequencies=("0.09844127049688513",),
        order=242,
        amplitudes=("1.3009149083500795",),
        energy="0.014915",
        energy_source="section 6.4.3, 'E'",
    ),
)

FIG9_BREATHER = APPENDIX_F[-1]

# "in subsequent calculations we use the values of the amplitudes found at the order k=24"
FIG1_AMPLITUDE_ORDER = 24
# "the cancellation takes place up to four orders of magnitude ... at the order k=14"
FIG1_CANCELLATION_ORDER = 14

# our choice: doubles lose some of their digits in the cancellations of Fig. 1(c)
FIG1_DIGITS = 20

FIG1_CLAIMS = {
    "best_difference": "1e-8 .. 1e-7, at k = 24",
    "cancellation": "four orders of magnitude at k = 14",
    "term_size": "about 1e-5 at k = 14",
    "harmonic_error": "about 1e-2",
    "energy_error": "about 1e-4",
}


@dataclass(frozen=True)
class PrintedExcitation:
    """A sequence of mode excitations D_1, D_2, ... of the alpha model.

    It is printed in sections 6.2 and 6.4.2.
    """

    label: str
    N: int
    seeds: tuple[int, ...]
    sets: tuple[tuple[int, ...], ...]


def _modes(*ranges: tuple[int, int]) -> tuple[int, ...]:
    return tuple(q for first, last in ranges for q in range(first, last + 1))


EXCITATIONS = (
    PrintedExcitation(
        "Example 1",
        32,
        (1, 11, 21, 31),
        (
            (2, 10, 12, 20, 22, 30),
            (3, 9, 13, 19, 23, 29),
            (4, 8, 14, 18, 24, 28),
            (5, 7, 15, 17, 25, 27),
        ),
    ),
    PrintedExcitation(
        "Example 2",
        64,
        (60, 61, 62, 63),
        (_modes((1, 8)), _modes((52, 59)), _modes((9, 16)), _modes((44, 51))),
    ),
    PrintedExcitation(
        "Example 3",
        128,
        (63, 64, 65),
        ((1, 2, 126, 127), (61, 62, 66, 67), (3, 4, 124, 125), (59, 60, 68, 69)),
    ),
    PrintedExcitation(
        "Example 4",
        128,
        (94, 95, 96, 97, 98),
        (
            _modes((1, 4), (60, 68)),
            _modes((26, 38), (90, 93), (99, 102)),
            # printed 56 .. 72, which repeats modes of D_1
            _modes((5, 8), (56, 59), (69, 72), (120, 127)),
            _modes((22, 25), (39, 42), (86, 89), (103, 106)),
        ),
    ),
    PrintedExcitation(
        "q = 25", 32, (25,), tuple((q,) for q in (14, 11, 28, 3, 22, 17, 8, 31, 6, 19))
    ),
)

# our choice: modes and half-width of the packets around N/4, N/2, 3N/4
FIG6_CHAIN, FIG6_WIDTH = 256, 4


@dataclass(frozen=True)
class PrintedLine:
    """log10 e_kappa = slope * kappa + intercept + power * log10 kappa, as a caption has it.

    The seeds are 1 .. s.

    chains : those of the panel. specific_energy : E/N with the caption's E.
    """

    label: str
    slope: str
    intercept: str
    power: int
    chains: tuple[Chain, ...]
    fraction: Fraction
    specific_energy: float

    def seeds(self, chain: Chain) -> int:
        """s, the number of seeds in a chain."""
        return int(self.fraction * chain.N)


_SIZES = (64, 128, 256, 512)
LINES = (
    PrintedLine(
        "Fig. 2a",
        "-36.6613",
        "3.49545",
        -2,
        (Chain(32, alpha="0.33"),),
        Fraction(1, 8),
        0.000182466 / 32,
    ),
    PrintedLine(
        "Fig. 4a",
        "-56.27",
        "4.46",
        2,
        tuple(Chain(N, alpha="0.33") for N in _SIZES),
        Fraction(1, 8),
        1.5625e-8,
    ),
    PrintedLine(
        "Fig. 4b",
        "-78.64",
        "-1.204",
        0,
        tuple(Chain(N, beta="0.3") for N in _SIZES),
        Fraction(1, 16),
        1.5625e-6,
    ),
)

# section 6.4.3, "a nearly complete return to their initial values at the time t=12000"
FIG9_RECURRENCE = 12000.0
# section 6.4.3, widths by the power of eps in the estimate
FIG9_PACKETS = {"1/4": "2.7", "1/5": "4.43"}
