"""mpmath: one module whose coefficients carry the digits of the series and which evaluates at any mp.dps."""

from __future__ import annotations

from symfpu.codegen.languages.numpy_source import module_docstring, text_constant
from symfpu.codegen.torus_program import TOLERANCE, TorusProgram, number
from symfpu.numbers.arithmetic import text
from symfpu.numbers.typed import decimal

EXTENSION = "py"
FUNCTIONS = '''

def _rational(text):
    numerator, _, denominator = text.partition("/")
    return mp.mpf(numerator) / mp.mpf(denominator or 1)


def _numbers(text):
    return [mp.mpf(word) for word in text.split()]


def _rows(items, columns):
    return [items[i : i + columns] for i in range(0, len(items), columns)]


def _linear(q):
    return 2 * mp.sinpi(mp.mpf(q) / (2 * N))


def orbit(t, phases=None):
    """Mode coordinates and momenta at one time, two lists of N-1 mpf; mode q stands at place q-1.

    phases : s angles in radians, in the order of SEEDS; default PHASES. All quantities are dimensionless.
    """
    omega = [_rational(w) for w in FREQUENCIES]
    chosen = _numbers(" ".join(PHASES)) if phases is None else [mp.mpf(p) for p in phases]
    if len(chosen) != len(SEEDS):
        raise ValueError("phases must be one angle for each of the seeds %s" % (SEEDS,))
    time = mp.mpf(t)
    extra = int(max(0, mp.ceil(mp.log(1 + abs(time), 10)))) + 5
    Q, P = [mp.mpf(0)] * (N - 1), [mp.mpf(0)] * (N - 1)
    with mp.extradps(extra):
        theta = [w * time + p for w, p in zip(omega, chosen)]
        for modes, harmonics, coefficients in _BLOCKS:
            nus = _rows([int(n) for n in harmonics.split()], len(SEEDS))
            for nu, row in zip(nus, _rows(_numbers(coefficients), len(modes))):
                cosine, sine = mp.cos_sin(mp.fsum(n * x for n, x in zip(nu, theta)))
                rate = mp.fsum(n * w for n, w in zip(nu, omega))
                for q, c in zip(modes, row):
                    Q[q - 1] += c * cosine
                    P[q - 1] -= c * rate * sine
    return [+x for x in Q], [+x for x in P]


def positions(t, phases=None):
    """Mode coordinates Q_q(t), q = 1 .. N-1; see orbit."""
    return orbit(t, phases)[0]


def momenta(t, phases=None):
    """Mode momenta P_q = dQ_q/dt; see orbit."""
    return orbit(t, phases)[1]


def harmonic_energies(t, phases=None):
    """E_q = (P_q^2 + Omega_q^2 Q_q^2) / 2 of every mode."""
    Q, P = orbit(t, phases)
    return [(P[q - 1] ** 2 + (_linear(q) * Q[q - 1]) ** 2) / 2 for q in range(1, N)]


def energy(t, phases=None):
    """Total energy H of the chain."""
    Q, P = orbit(t, phases)
    alpha, beta = _rational(ALPHA), _rational(BETA)
    total = mp.fsum(p**2 for p in P) / 2
    for j in range(N):
        angles = [mp.cospi(mp.mpf(q * (2 * j + 1)) / (2 * N)) for q in range(1, N)]
        r = mp.sqrt(mp.mpf(2) / N) * mp.fsum(_linear(q) * Q[q - 1] * angles[q - 1] for q in range(1, N))
        total += r**2 / 2 + alpha * r**3 / 3 + beta * r**4 / 4
    return total


def self_test():
    """Largest deviation from the embedded test vectors, relative to the largest coordinate or momentum."""
    worst = mp.mpf(0)
    with mp.workdps(DIGITS + 5):
        orbits = [orbit(t) for t in _CHECK_TIMES.split()]
        for part, text in enumerate((_CHECK_POSITIONS, _CHECK_MOMENTA)):
            known = _numbers(text)
            ours = [x for pair in orbits for x in pair[part]]
            worst = max(worst, max(abs(a - b) for a, b in zip(ours, known)) / max(abs(b) for b in known))
    return worst


if __name__ == "__main__":
    deviation = self_test()
    print("largest deviation %s, allowed %s" % (mp.nstr(deviation, 2), mp.nstr(TOLERANCE, 2)))
    raise SystemExit(0 if deviation <= TOLERANCE else 1)
'''


def emit_torus(program: TorusProgram) -> str:
    """The module as text; the same bytes for the same program."""
    digits = program.digits or 17
    tolerance = "mp.mpf(%r)" % (str(TOLERANCE) if program.digits is None else f"1e-{program.digits - 2}")
    blocks = []
    constants = [
        f"N, DIGITS = {program.N}, {digits}",
        f"SEEDS = {program.seeds!r}",
        f"FREQUENCIES = {tuple(map(decimal, program.frequencies))!r}",
        f"PHASES = {tuple(text(p, digits) for p in program.phases)!r}",
        f"ALPHA, BETA = {decimal(program.alpha)!r}, {decimal(program.beta)!r}",
        f"TOLERANCE = {tolerance}",
    ]
    for p, block in enumerate(program.blocks):
        constants.append(text_constant(f"_HARMONICS_{p}", (str(n) for n in block.harmonics.flat)))
        constants.append(text_constant(f"_COEFFICIENTS_{p}", (number(c, digits + 3) for c in block.coefficients.flat)))
        blocks.append(f"({list(block.modes)!r}, _HARMONICS_{p}, _COEFFICIENTS_{p})")
    constants.append(f"_BLOCKS = [{', '.join(blocks)}]")
    constants.append(text_constant("_CHECK_TIMES", program.check.times))
    constants.append(text_constant("_CHECK_POSITIONS", (x for row in program.check.positions for x in row)))
    constants.append(text_constant("_CHECK_MOMENTA", (x for row in program.check.momenta for x in row)))
    return f'"""{module_docstring(program)}"""\n\nfrom mpmath import mp\n\n' + "\n".join(constants) + "\n" + FUNCTIONS
