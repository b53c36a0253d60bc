"""mpmath: a series with free amplitudes as one module that carries the digits of the series and evaluates at any mp.dps."""

from __future__ import annotations

import sympy
from sympy.printing.pycode import MpmathPrinter

from symfpu.codegen.languages.numpy_series import Waves, check_constants, filled, series_docstring, straight_functions, table_constants
from symfpu.codegen.series_program import SeriesProgram
from symfpu.codegen.torus_program import TOLERANCE, number

EXTENSION = "py"

FIRST = """

def _given(name, values):
    numbers = [mp.mpf(x) for x in values]
    if len(numbers) != len(SEEDS):
        raise ValueError("%s must be one number for each of the seeds %s" % (name, SEEDS))
    return numbers


def _numbers(text):
    return [mp.mpf(word) for word in text.split()]


def _rows(items, columns):
    return [items[i : i + columns] for i in range(0, len(items), columns)]

"""

TABLES = '''
def _power(x, exponents):
    return mp.fprod(a**n for a, n in zip(x, exponents))


def _coefficients(amplitudes, frequencies):
    """Modes, harmonics, and coefficients of cosines in Q and of sines in P at these amplitudes."""
    x = [c * a for c, a in zip(_numbers(_SCALES), amplitudes)]
    monomials = [_power(x, e) for e in _rows([int(n) for n in _POWERS.split()], len(SEEDS))]
    parts = []
    for modes, harmonics, starts, powers, values in _BLOCKS:
        rows, which = _rows(_numbers(values), len(modes)), [int(n) for n in powers.split()]
        first = [int(n) for n in starts.split()]
        for nu, start, end in zip(_rows([int(n) for n in harmonics.split()], len(SEEDS)), first, first[1:] + [len(rows)]):
            cosines = [mp.fsum(rows[r][m] * monomials[which[r]] for r in range(start, end)) for m in range(len(modes))]
            rate = mp.fsum(n * w for n, w in zip(nu, frequencies))
            parts.append((modes, nu, cosines, [-rate * c for c in cosines]))
    return parts


def _sums(theta, coefficients):
    """Q and P, lists of N-1, at s angles."""
    Q, P = [mp.mpf(0)] * (N - 1), [mp.mpf(0)] * (N - 1)
    for modes, nu, cosines, sines in coefficients:
        cosine, sine = mp.cos_sin(mp.fsum(n * x for n, x in zip(nu, theta)))
        for q, c, d in zip(modes, cosines, sines):
            Q[q - 1] += c * cosine
            P[q - 1] += d * sine
    return Q, P


def corrected_frequencies(amplitudes):
    """omega(A) of the seeds, s mpf, and its Jacobian d omega_i / d A_j, s lists of s mpf."""
    scales = _numbers(_SCALES)
    x = [c * a for c, a in zip(scales, _given("amplitudes", amplitudes))]
    omega, s = _numbers(_LINEAR), len(SEEDS)
    jacobian = [[mp.mpf(0)] * s for _ in SEEDS]
    for e, row in zip(_rows([int(n) for n in _FREQUENCY_POWERS.split()], s), _rows(_numbers(_FREQUENCY_COEFFICIENTS), s)):
        value = _power(x, [2 * n for n in e])
        slopes = [_power(x, [2 * n - (i == j) for i, n in enumerate(e)]) * 2 * e[j] * scales[j] if e[j] else 0 for j in range(s)]
        for i, c in enumerate(row):
            omega[i] += c * value
            jacobian[i] = [have + c * slope for have, slope in zip(jacobian[i], slopes)]
    return omega, jacobian
'''

FUNCTIONS = '''

def orbit($parameters):
    """Mode coordinates and momenta at one time, two lists of N-1 mpf; mode q stands at place q-1.

    amplitudes : s numbers A, in the order of SEEDS. phases : s angles in radians; default zeros. frequencies : s rates of the
    angles, theta = omega t + phi; $frequencies. All quantities are dimensionless.
    """
    time, A = mp.mpf(t), _given("amplitudes", amplitudes)
    chosen = [mp.mpf(0)] * len(SEEDS) if phases is None else _given("phases", phases)
    extra = int(max(0, mp.ceil(mp.log(1 + abs(time), 10)))) + 5
    with mp.extradps(extra):
        omega = $omega
        Q, P = _sums([w * time + p for w, p in zip(omega, chosen)], _coefficients(A, omega))
    return [+x for x in Q], [+x for x in P]


def positions($parameters):
    """Mode coordinates Q_q(t), q = 1 .. N-1; see orbit."""
    return orbit($arguments)[0]


def momenta($parameters):
    """Mode momenta P_q = dQ_q/dt; see orbit."""
    return orbit($arguments)[1]


def self_test():
    """Largest deviation from the embedded test vectors, each relative to the largest value of its kind."""
    worst = mp.mpf(0)
    with mp.workdps(DIGITS + 5):
        amplitudes, phases, rates = (_numbers(text) for text in (_CHECK_AMPLITUDES, _CHECK_PHASES, _CHECK_FREQUENCIES))
        orbits = [orbit(t, $test) for t in _CHECK_TIMES.split()]
        corrected, jacobian = corrected_frequencies(amplitudes$rates)
        results = [[x for pair in orbits for x in pair[part]] for part in (0, 1)] + [corrected, [x for row in jacobian for x in row]]
        for ours, text in zip(results, (_CHECK_POSITIONS, _CHECK_MOMENTA, _CHECK_CORRECTED, _CHECK_JACOBIAN)):
            known = _numbers(text)
            worst = max(worst, max(abs(a - b) for a, b in zip(ours, known)) / (max(abs(b) for b in known) or 1))
    return worst


if __name__ == "__main__":
    deviation = self_test()
    print("largest deviation %s, allowed %s" % (mp.nstr(deviation, 2), mp.nstr(TOLERANCE, 2)))
    raise SystemExit(0 if deviation <= TOLERANCE else 1)
'''

ENDS = (
    "return [mp.mpf(q) for q in Q], [mp.mpf(p) for p in P]",
    "return [mp.mpf(w) for w in corrected], [[mp.mpf(x) for x in row] for row in jacobian]",
)


class _Printer(Waves, MpmathPrinter):  # type: ignore[misc]
    """mpmath by its context `mp`; numbers as decimal text."""

    module = "mp"

    def __init__(self) -> None:
        super().__init__({"fully_qualified_modules": False})

    def _print_Float(self, value: sympy.Float) -> str:
        return f'mp.mpf("{value!s}")'

    def _print_Rational(self, value: sympy.Rational) -> str:
        return f"(mp.mpf({value.p}) / {value.q})"


def emit_series(program: SeriesProgram) -> str:
    """The module as text; the same bytes for the same program."""
    digits = program.digits or 17
    tolerance = "mp.mpf(%r)" % (str(TOLERANCE) if program.digits is None else f"1e-{program.digits - 2}")
    constants = [
        f"N, DIGITS = {program.N}, {digits}",
        f"SEEDS = {program.seeds!r}",
        f"TOLERANCE = {tolerance}",
        *check_constants(program),
        *([] if program.tables is None else table_constants(program.tables, lambda x: number(x, digits + 3))),
    ]
    body = TABLES if program.straight is None else straight_functions(program, _Printer(), lambda _, text: text, ENDS)
    header = f'"""{series_docstring(program)}"""\n\nfrom mpmath import mp\n'
    return header + "\n" + "\n".join(constants) + "\n" + FIRST + body + filled(FUNCTIONS, program)
