"""Speed of proofs of existence and of their independent checks: the orbits of docs/existence.md. Measured and printed, not asserted."""

import pytest

import symfpu
from symfpu import Chain, prove_existence, refine
from symfpu.checkers.verify import verify as verify_certificate

SHORT = Chain(N=32, alpha="0.33")
CASES = {
    "Fig. 9, omega": (lambda: symfpu.torus(SHORT, (1,), frequencies=("0.09844127049688513",)), 32, {}),
    "Fig. 9, A": (lambda: symfpu.torus(SHORT, (1,), frequencies=("0.09844127049688513",)), 32, {"amplitude": "1.27153895251014"}),
    "H = 0.014915, H": (lambda: symfpu.torus(SHORT, (1,), energy="0.014915"), 30, {"energy": "0.014915"}),
    "H = 0.75 from rest, omega": (lambda: symfpu.torus(SHORT, (1,), energy="0.75"), 30, {}),
    "H = 0.75 from rest, H": (lambda: symfpu.torus(SHORT, (1,), energy="0.75"), 30, {"energy": "0.75"}),
    "toda:1/3, A = 1/2": (lambda: symfpu.torus(Chain(32, potential="toda:1/3"), (1,), amplitudes={1: "1/2"}), 30, {"amplitude": "1/2"}),
    "N = 64, A = 1": (lambda: symfpu.torus(Chain(64, alpha="0.33"), (1,), amplitudes={1: "1"}), 20, {}),
    "N = 128, A = 1": (lambda: symfpu.torus(Chain(128, alpha="0.33"), (1,), amplitudes={1: "1"}), 20, {}),
}


@pytest.fixture(scope="module", params=list(CASES))
def case(request):
    make, digits, given = CASES[request.param]
    orbit = refine(make(), digits=digits)
    return request.param, orbit, given, prove_existence(orbit, **given)


def test_proof(benchmark, record, case):
    name, orbit, given, _ = case
    proof = benchmark.pedantic(prove_existence, (orbit,), given, rounds=2)
    record(f"proof of existence, {name}", note=f"r = {proof.radius:.0e}, block {proof.block}")


def test_check(benchmark, record, case, tmp_path):
    name, _, _, proof = case
    file = tmp_path / "proof.json"
    proof.write(file)
    benchmark.pedantic(verify_certificate, (file,), rounds=1)
    record(f"its check, {name}", note=f"{file.stat().st_size:,} bytes")
