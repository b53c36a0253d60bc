"""Universal series in tables of operations: cases, and what their files are to give, by the series itself."""

from functools import cache

import numpy as np

from symfpu import Chain, lindstedt, sample_series
from symfpu.codegen.series_program import series_facts, series_program

DIGITS = 30  # of the series at the frequencies

# chain, seeds, frequencies (exact in doubles), order, frequency order, derivatives asked for: large ones have them anyway
CASES = {
    "large": (Chain(16, alpha="0.33"), (1, 2), (0.19921875, 0.39453125), 8, 8, False),
    "both couplings": (Chain(8, alpha="-0.3", beta="0.1"), (1, 2, 5), (0.390625, 0.765625, 1.671875), 3, 2, True),
    "beta": (Chain(9, beta="-0.6"), (2, 3), (0.703125, 1.0390625), 3, 3, True),
    "one seed": (Chain(8, alpha="0.3"), (1,), (0.3984375,), 6, 5, True),
    "one mode": (Chain(2, alpha="0.2", beta="0.3"), (1,), (1.421875,), 5, 4, True),
    "wrapped, cut": (Chain(4, alpha="-0.3"), (2, 3), (1.421875, 1.859375), 1, 0, True),
    "toda": (Chain(6, potential="toda:-1/3"), (1, 2), (0.515625, 1.0078125), 3, 2, True),
    "even polynomial": (Chain(6, potential="poly:0,1/3,0,1/5"), (2,), (1.0078125,), 2, 2, True),
    "nothing but the seeds": (Chain(5, alpha="0.25"), (2,), (1.1796875,), 0, 0, True),
}
TIMES = np.array([0.0, 2.5, -13.0625])


@cache
def series(name):
    """The universal series, of one order more than its file keeps where that is low."""
    chain, seeds, _, order, frequency_order, _ = CASES[name]
    return lindstedt(chain, seeds, order=max(order, frequency_order, 1))


@cache
def program(name, called="sample"):
    """What the languages are given."""
    _, _, _, order, frequency_order, derivatives = CASES[name]
    cuts = {"order": order, "frequency_order": frequency_order}
    facts = series_facts(series(name), **cuts)
    return series_program(series(name), called, facts, **cuts, derivatives=derivatives)


def given(name):
    """Amplitudes and phases (s,), frequencies (s,) of a case."""
    s = len(CASES[name][1])
    return 0.25 - 0.0625 * np.arange(s), 0.5 - 0.375 * np.arange(s), np.array(CASES[name][2])


@cache
def expected(name):
    """Q, P (T, N-1), omega (s,), jacobian (s, s), dQ, dP (s, T, N-1) and slopes (s, s)."""
    amplitudes, phases, frequencies = given(name)
    _, seeds, _, order, frequency_order, _ = CASES[name]
    numeric = series(name).at([repr(w) for w in frequencies.tolist()], digits=DIGITS)
    terms = [numeric.harmonic_terms(amplitudes, k) for k in range(order + 1)]
    nu, values = (np.concatenate(parts) for parts in zip(*terms, strict=True))
    values = values.astype(float)
    roots, by_squares = numeric.frequency_terms(amplitudes**2, frequency_order)
    changes = [slopes_of_harmonics(name, q) for q in seeds]
    found = [*summed(nu, values, phases, frequencies), roots.sum(axis=0), by_squares.sum(axis=0) * 2 * amplitudes]
    found += [np.stack(parts) for parts in zip(*(moved(nu, values, changes[j], j, name) for j in range(len(seeds))), strict=True)]
    return [np.asarray(x, dtype=float) for x in [*found, slopes_of_frequencies(name)]]


def waves(nu, phases, frequencies):
    theta = TIMES[:, None] * frequencies + phases
    return np.cos(theta @ nu.T), np.sin(theta @ nu.T)


def summed(nu, values, phases, frequencies):
    """Q and P of cosine coefficients."""
    cosine, sine = waves(nu, phases, frequencies)
    return cosine @ values, -sine @ (values * (nu @ frequencies)[:, None])


def moved(nu, values, change, j, name):
    """dQ and dP by frequency number j, times and phases fixed."""
    _, phases, frequencies = given(name)
    cosine, sine = waves(nu, phases, frequencies)
    rate, turned = (nu @ frequencies)[:, None], values * nu[:, [j]]
    t = TIMES[:, None]
    return (
        cosine @ change - t * (sine @ turned),
        -sine @ (rate * change + turned) - t * (cosine @ (rate * turned)),
    )


def slopes_of_harmonics(name, q):
    """Derivatives by omega_q of the cosine coefficients, (H, N-1), from the derivatives of the sampled series."""
    whole, (amplitudes, _, frequencies) = series(name), given(name)
    chain, seeds, _, order, _, _ = CASES[name]
    coordinates, _ = sample_series(whole, frequencies[None]).derivatives_by_frequency(q)
    kappa = abs(chain.mu) ** (1 / chain.degree_step)
    x = kappa * chain.frequencies()[np.array(seeds) - 1] * amplitudes / 2
    rows = []
    for k in range(order + 1):
        nu, index = whole.grading.harmonics(whole.degree(k))
        sign = -1 if chain.mu < 0 and k % 2 else 1
        monomials = sign / kappa * np.prod(x ** whole.grading.powers(whole.degree(k)), axis=1)
        sums = np.zeros((len(nu), chain.N - 1))
        np.add.at(sums, index, coordinates[k][:, :, 0] * monomials[:, None] / chain.frequencies())
        rows.append(sums * np.where(nu.any(axis=1), 2, 1)[:, None])
    return np.concatenate(rows)


def slopes_of_frequencies(name):
    """d omega_i(A) / d omega_j, (s, s), by the sampled series of the frequencies' order."""
    chain, seeds, frequencies, _, order, _ = CASES[name]
    if order == 0:
        return np.zeros((len(seeds), len(seeds)))
    amplitudes, *_ = given(name)
    sampled = sample_series(lindstedt(chain, seeds, order=order), np.array(frequencies)[None])
    return sampled.frequencies_at(amplitudes).by_frequencies[0]
