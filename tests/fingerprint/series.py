"""Series over every ring: doubles, digits, symbols, every N; of chains, potentials and rings; sums of them."""

from math import pi, sin

import symfpu
from symfpu import Chain, assess, closed_form, lindstedt, pade_poles, resum, same_series, sample_series, series_bytes, solve_amplitudes
from tests.fingerprint.cases import case
from tests.fingerprint.entries import exact, noise, solver

SERIES = {
    "alpha, two seeds": (Chain(16, alpha="0.33"), (1, 2), ("0.19626", "0.39046"), 8),
    "alpha, N odd": (Chain(9, alpha="0.3"), (1, 4), ("0.348", "1.285"), 6),
    "beta, one seed": (Chain(9, beta=1), (1,), ("0.3475",), 6),
    "beta, two seeds": (Chain(8, beta="-0.1"), (1, 2), ("0.3900", "0.7650"), 5),
    "both": (Chain(8, alpha="1/3", beta="0.7"), (1, 2), ("0.39053", "0.765895"), 5),
    "one high seed": (Chain(32, alpha="0.33"), (25,), ("1.8830741847088537",), 6),
    "four seeds": (Chain(16, alpha="0.33"), (1, 2, 3, 4), ("0.1961", "0.3903", "0.5807", "0.7655"), 3),
    "N = 2": (Chain(2, beta=1), (1,), ("1.4613",), 6),
    "toda": (Chain(8, potential="toda:1/2"), (1, 2), ("0.390427", "0.765496"), 5),
    "morse": (Chain(7, potential="morse:1/3"), (1,), ("0.4448",), 5),
    "lennard_jones": (Chain(6, potential="lennard_jones:12,6"), (2,), ("0.999",), 4),
    "polynomial": (Chain(7, potential="polynomial:0.3,0.2,0,0.1"), (2, 3), ("0.8680", "1.2475"), 4),
    "cosh": (Chain(8, potential=symfpu.from_expression("cosh(r) - 1")), (1,), ("0.3904",), 6),
}
DIGITS = ("alpha, two seeds", "beta, two seeds", "both", "N = 2", "toda")


def made(name, **options):
    chain, seeds, frequencies, order = SERIES[name]
    return lindstedt(chain, seeds, frequencies, order, **options)


def sums(series):
    """Of every order: terms of the frequencies, and sums of the coordinates and of their squares."""
    amplitudes = [0.3 / (1 + i) for i in range(len(series.seeds))]
    squares = [a * a for a in amplitudes]
    yield "frequency terms", series.frequency_terms(squares)[0]
    for order in range(series.order + 1):
        _, terms = series.harmonic_terms(amplitudes, order)
        yield f"Q^({order})", [sum((terms**2).ravel()), *terms.sum(axis=0)]


@case
def in_doubles():
    for name in SERIES:
        series = made(name)
        yield name, series.record()
        for what, value in sums(series):
            yield f"{name}, {what}", value


@case
def in_digits():
    for name in DIGITS:
        series = made(name, digits=30)
        yield name, series.record()
        yield f"{name}, order 3", series.harmonic_terms([0.3, 0.15][: len(series.seeds)], 3)[1].sum(axis=0)
        harmonics, values = series.coefficients(series.seeds[0], 2)
        yield f"{name}, coefficients", [[list(map(int, harmonics[0])), values[0]], [list(map(int, harmonics[-1])), values[-1]]]


@case
def with_symbols():
    chain = Chain(8, alpha="0.3", beta="1/7")
    series = lindstedt(chain, (1, 2), order=3)
    yield "term", str(series.term(3, 1))
    yield "frequency correction", str(series.frequency_correction(1, 2))
    numbers = series.at(("0.3905", "0.7663"))
    yield "at frequencies", numbers.frequency_terms([0.09, 0.04])[0]
    yield "same series", exact(same_series(series, lindstedt(chain, (1, 2), order=3, ring="nested")))
    yield "named parts", [str(part) for _, part in lindstedt(Chain(8, alpha="0.3"), (1,), order=4).term(5, 4, form="cse").names]
    yield "expandable", sorted(map(str, symfpu.expandable_term(lindstedt(Chain(8, alpha="0.3"), (1,), order=2), 3, 2).meanings))
    yield "bytes", exact(series_bytes(Chain(32, alpha="0.33"), (1, 2, 3, 4), 11))


@case
def for_every_length():
    series = lindstedt(Chain("N", alpha="1/3"), (1, 2), order=3)
    yield "term", str(series.term(3, 1))
    yield "frequency correction", str(series.frequency_correction(2, 2))
    yield "at N = 16", series.at_length(N=16).at(("0.19626", "0.39046")).frequency_terms([0.3, 0.2])[0]
    high = lindstedt(Chain("N", beta=1), (1, "N-1"), order=2)
    yield "both ends", str(high.frequency_correction(1, 1))
    yield "expansion", str(symfpu.frequency_expansion(Chain("N", beta=1), (1,), 1, 2))
    closed = closed_form(series.term(3, 1), Chain("N", alpha="1/3"), (1, 2))
    yield "closed form", str(closed)
    terms = symfpu.collect_terms(closed, [x for x in closed.free_symbols if str(x) == "A1"])
    yield "collected", {str(power): str(term) for power, term in terms.items()}


@case
def waves():
    for name, chain, seeds, frequencies in (
        ("even", Chain(8, alpha="0.3", ends="periodic"), (1,), ("0.766",)),
        ("odd", Chain(9, alpha="0.3", ends="periodic"), (1, 2), ("0.6835", "1.2845")),
        ("beta", Chain(8, beta=1, ends="periodic"), (1,), ("0.7665",)),
    ):
        series = symfpu.lindstedt(chain, seeds, frequencies, 5)
        yield name, series.record()
        amplitudes = [0.2, 0.1][: len(seeds)]
        yield f"{name}, frequency terms", series.frequency_terms([a * a for a in amplitudes])[0]
        harmonics, terms = series.harmonic_terms(amplitudes, 3)
        stretches = terms[:, 0] * [2 * sin(pi * (nu @ seeds) / chain.N) for nu in harmonics]
        yield f"{name}, order 3", (stretches**2).sum()


@case
def sampled():
    series = lindstedt(Chain(8, alpha="0.3"), (1, 2), order=3)
    found = sample_series(series, [[0.3905, 0.7663], [0.391, 0.767]])
    yield "series", found.record()
    yield "frequencies", found.frequencies_at([0.1, 0.05]).record()


@case
def tori_of_series():
    for name in ("alpha, two seeds", "beta, one seed", "both", "N = 2", "toda"):
        for digits in (None, 30):
            series = made(name, digits=digits)
            kind = name if digits is None else f"{name}, {digits} digits"
            torus = solve_amplitudes(series, phases={series.seeds[0]: 0.4})
            yield f"{kind}, torus", torus.record()
            yield f"{kind}, positions", solver(torus.Q([0.0, 1.7])) if digits is None else torus.Q([0.0, 1.7])
            yield f"{kind}, spectrum", solver(torus.average_spectrum()) if digits is None else torus.average_spectrum()


@case
def verdicts():
    long = lindstedt(Chain(16, alpha="0.33"), (1, 2), ("0.19626", "0.39046"), 14)
    short = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3903",), 16)
    for name, series in (("asymptotic", long), ("converged", short)):
        torus = solve_amplitudes(series)
        yield name, assess(series, torus).record()
        yield f"{name}, history", symfpu.amplitude_history(series).record()
    near = symfpu.torus(Chain(8, beta=1), (1, 3), amplitudes={1: "0.3", 3: "0.2"}, method="series", order=6)
    yield "diverging", assess(near.origin.series, near).record()


@case
def pade_sums():
    series = made("alpha, two seeds", digits=30)
    torus = solve_amplitudes(series)
    yield "frequencies", symfpu.pade_frequencies(series, torus.amplitudes).record()
    yield "amplitudes", noise(symfpu.pade_amplitudes(series, torus.amplitudes))
    yield "poles", noise(sorted(abs(pade_poles(series, 1, torus.amplitudes)))[:2])
    yield "torus", resum(torus).record()
