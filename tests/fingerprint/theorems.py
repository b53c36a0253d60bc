"""Proofs with their certificates, asymptotic formulas, borders, exported code and files."""

import hashlib
import json
import re
import tempfile
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path

import symfpu
from symfpu import Chain, asymptotic_energy, atlas, lindstedt, prove_existence, prove_stability, solve_amplitudes, sweep_propagation
from tests.fingerprint.cases import case
from tests.fingerprint.entries import exact, noise, sampled

ALPHA = Chain(8, alpha="0.3")
NUMBER = re.compile(r"(?<![\w.])-?(?:\d+\.\d*(?:[eEdD][-+]?\d+)?|\d+[eEdD][-+]?\d+)(?:_\w+)?")


HERE = ThreadPoolExecutor(1)  # no processes: less time


def checksum(text):
    return hashlib.sha256(text.encode()).hexdigest()[:16]


@cache
def orbit():
    return symfpu.torus(ALPHA, (1,), amplitudes={1: "0.3"})


@cache
def torus():
    found = symfpu.torus(Chain(4, alpha="0.3"), (1, 2), amplitudes={1: "0.2", 2: "0.1"}, method="series", order=4)
    return symfpu.refine(found, digits=30)


@case
def propagation():
    for N, seeds, order, law in (
        (8, (1, 4), 3, {"model": "beta"}),
        (16, (3, 5), 4, {"model": "alpha"}),
        (12, (11,), 4, {"model": "alpha"}),
        (9, (1, 2), 3, {"potential": "toda:1/2"}),
        (2, (1,), 3, {"model": "beta"}),
    ):
        proof = symfpu.prove_propagation(N, seeds, order, **law)
        yield f"N = {N}, {seeds}, {law}", proof.record()
        yield f"N = {N}, {seeds}, {law}, certificate", checksum(json.dumps(proof.certificate(), sort_keys=True))
    yield "sweep, alpha", sweep_propagation(range(3, 7), 2, 3, model="alpha", executor=HERE).record()
    yield "sweep, beta", sweep_propagation(range(3, 7), 2, 2, model="beta", executor=HERE).record()


@case
def every_length():
    for model, seeds, order in (("alpha", 1, 3), ("beta", 1, 2), ("beta", 2, 1)):
        proof = symfpu.prove_for_all_N(model, seeds, order)
        yield f"{model}, {seeds}, {order}", proof.record()
    yield "lemma", symfpu.lemma_holds(Chain(16, alpha=1), (1, 2), 3)
    yield "leading term", str(symfpu.leading_term(Chain(16, alpha=1), (1, 2), 5))


@case
def asymptotics():
    chain, beta = Chain("N", alpha="1/3"), Chain("N", beta=1)
    yield "divisor", str(symfpu.asymptotic_divisor(2, (1,), (2,), squared=False))
    yield "divisor, squared", str(symfpu.asymptotic_divisor(3, (1,), (3,)))
    yield "energy", str(asymptotic_energy(chain, (1, 3), 2))
    yield "energy, high", str(asymptotic_energy(beta, ("N-1",), "N-3"))
    yield "term", str(symfpu.asymptotic_term(lindstedt(chain, (1, 2), order=1), 3, 1, terms=1))
    yield "group", str(symfpu.asymptotic_group_energy(chain, 2, 1))
    yield "profile", str(symfpu.asymptotic_profile(chain, 2, 1, terms=3))


@case
def existence():
    proof = prove_existence(orbit())
    yield "breather", proof.record()
    yield "breather, stability", prove_stability(proof).record()
    yield "digits", prove_existence(symfpu.refine(orbit(), digits=30)).record()
    yield "interval", prove_existence(orbit(), amplitude="0.3", half_width="1e-6").record()
    wave = symfpu.torus(Chain(16, beta=1, ends="periodic"), (2,), amplitudes={2: "0.8"})
    yield "wave", prove_existence(wave).record()
    high = symfpu.torus(Chain(6, beta=1), (5,), amplitudes={5: "1.5"})
    yield "unstable", prove_stability(prove_existence(high)).record()


@case
def near_tori():
    yield "residual", symfpu.prove_residual(torus()).record()
    proof = symfpu.prove_stay(torus(), time=1000)
    yield "stay", proof.record()
    yield "stay, half the time", noise(proof.distance_at(500))


@case
def borders():
    high = atlas([{"N": 4, "beta": 1}], ["high:1"], 4, borders=["poles"], reach=1, executor=HERE)
    yield "beta, high", sampled(high.record())
    chains = [{"N": N, "alpha": "0.33"} for N in (8, 10, 12)]
    low = atlas(chains, ["low:1"], 3, borders=["ratio"], reach=1, executor=HERE)
    yield "alpha, low", sampled(low.record())
    yield "law", sampled(low.law("low:1", "ratio").record())


def source(solution, language, **options):
    with tempfile.TemporaryDirectory() as folder:
        return symfpu.export(solution, language, f"{folder}/made", **options).read_text()


def code(text):
    """What is between the numbers, how many there are, their sum and the sum of their squares."""
    text = re.sub(r"symfpu [\d.]+|hash of the .*", "", text)  # of the version, and of all digits
    numbers = [float(re.sub("_.*", "", number).lower().replace("d", "e")) for number in NUMBER.findall(text)]
    words = checksum(re.sub(r"#[#\s,;&.]*", "#", NUMBER.sub("#", text)))  # rows of numbers may break elsewhere
    return words, [len(numbers), float(sum(numbers)), float(sum(x * x for x in numbers))]


@case
def exports():
    series = lindstedt(ALPHA, (1, 2), ("0.3905", "0.7663"), 3)
    universal = lindstedt(ALPHA, (1, 2), order=2)
    made = {"torus": solve_amplitudes(series), "series": series, "universal": universal, "breather": orbit()}
    for name, solution in made.items():
        for language in ("c", "fortran", "numpy", "mpmath", "octave"):
            words, numbers = code(source(solution, language))
            yield f"{name}, {language}", exact(words)
            yield f"{name}, {language}, numbers", numbers
    evaluator = symfpu.compile_evaluator(made["torus"], backend="numpy")
    yield "evaluator", evaluator.Q([0.0, 1.7], {2: 0.5})


@case
def files():
    series = lindstedt(ALPHA, (1, 2), ("0.3905", "0.7663"), 4, digits=30)
    with tempfile.TemporaryDirectory() as folder:
        found = symfpu.saved_file(symfpu.save(Path(folder) / "torus", solve_amplitudes(series), verdict={"verdict": "good"}))
    yield "bundle", found.record()
    yield "test vectors", noise([dict(point._asdict()) for point in found.test_vectors])
