"""The slope of natural packets, section 6.1.1: trajectories of one seed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.files.progress import unheard
from symfpu.localization.laws import natural_packet
from symfpu.localization.profiles import fpu_trajectory, packet_amplitudes
from symfpu.paper.claims import Claim, judged
from symfpu.paper.starts import integrated_orbit

Floats = NDArray[np.float64]

CHAIN = Chain(64, alpha="0.33")
ENERGIES = (2.2e-4, 1.1e-3, 5.5e-3)  # eps of packets of 4.5 to 10 modes
TIME = 1e4
FIRST_WIDTHS, LAST_SHARE = (
    2.0,
    0.6,
)  # modes of the tail: beyond so many packets, below so much of N
LEAST_SHARE = 1e-24  # of the energy
POWER_TOLERANCE = 0.1


def natural_slopes() -> tuple[Floats, Floats]:
    """x = alpha^(-1/2) eps^(-1/4), and sigma of e_kappa ~ exp(-sigma kappa)."""
    x, slopes = [], []
    for epsilon in ENERGIES:
        amplitudes = packet_amplitudes(CHAIN, [1], epsilon * CHAIN.N)
        start = fpu_trajectory(CHAIN, amplitudes)
        orbit = integrated_orbit("slopes", CHAIN, start, TIME, unheard, samples=1)
        assert orbit.averages is not None
        width = natural_packet(CHAIN, epsilon)
        x.append(CHAIN.N / width)
        slopes.append(tail_slope(orbit.averages[-1], width))
    return np.array(x), np.array(slopes)


def tail_slope(spectrum: Floats, width: float) -> float:
    """-d log e_kappa / d kappa beyond a packet of so many modes."""
    shares = spectrum / spectrum.sum()
    N = len(shares) + 1
    q = np.arange(1, N)
    tail = (q > FIRST_WIDTHS * width) & (q < LAST_SHARE * N) & (shares > LEAST_SHARE)
    slope, _ = np.polyfit(q[tail] / N, np.log(shares[tail]), 1)
    return float(-slope)


def natural_slopes_claim(x: Floats, slopes: Floats) -> Claim:
    """Whether sigma is proportional to a power 1 of x."""
    power, _ = np.polyfit(np.log(x), np.log(slopes), 1)
    ratios = ", ".join(f"{value:.2f}" for value in slopes / x)
    ours = (
        f"N = {CHAIN.N}, alpha = {CHAIN.alpha}, seed 1, packets of {CHAIN.N / x[0]:.1f} to "
    )
    ours += (
        f"{CHAIN.N / x[-1]:.1f} modes, averages to t = {TIME:.0e}: slope ~ x^{power:.2f}, "
    )
    ours += f"slope/x = {ratios} for x = alpha^(-1/2) eps^(-1/4)"
    text = "the slope of the spectra of natural packets depends linearly on "
    text += "alpha^(-1/2) eps^(-1/4)"
    linear = abs(power - 1) <= POWER_TOLERANCE
    return Claim("6.1.1", text, "", ours, judged(bool(linear), bool(power > 0)))
