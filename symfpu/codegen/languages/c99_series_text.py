"""The C99 of exported series that numbers do not change; words in braces or dollars are filled in by c99_series."""

HEADER = """\
/* Machine-written: quasi-periodic solutions of an FPU chain as a series with free amplitudes A,
 *
 *     Q_q(t) = sum over nu of c_q[nu](A) cos(nu.theta),   P_q = dQ_q/dt,   q = 1 .. N-1,
 *
 * with angles theta_i = omega_i t + phi_i.
 *
$facts
 *
 * How to call. Declare in your program what you use of
 *
 *     int ${name}_orbit(size_t count, const double *t,
 *         const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P);
 *     int ${name}_positions(size_t count, const double *t,
 *         const double *amplitudes, const double *phases, const double *frequencies, double *Q);
 *     int ${name}_momenta(size_t count, const double *t,
 *         const double *amplitudes, const double *phases, const double *frequencies, double *P);
 *     void ${name}_corrected_frequencies(const double *amplitudes,
 *         ${divisors}double *omega, double *jacobian);
 *
 * and compile and link this file: cc -std=c99 -O2 -c FILE.c, with -lm at the end of the link.
 * C++ declares the functions extern "C".
 *   t           count times, any real numbers
 *   amplitudes  A of every seed ($seeds), in the order above; A_q multiplies cos(theta_q) in Q_q
 *   phases      phi of every seed ($seeds) in radians, or NULL for zeros
 *   frequencies omega of every seed ($seeds), radians per time,
$frequencies
 *   Q, P        count x (N-1) = count x ${modes}, row-major: mode q at the i-th time is [i * $modes + q - 1];
 *               of ${name}_orbit either may be NULL
 *   omega       corrected frequencies ($seeds): omega(A), the series of the frequencies at these amplitudes
 *   jacobian    $seeds x $seeds, row-major: d omega_i / d A_j is [i * $seeds + j]; or NULL
$returns
 * All quantities are dimensionless. The series is an expansion in small amplitudes; how far it holds is not checked.
$memory
 *
 * Accuracy: omega t is reduced to one turn in two doubles, so nu.(omega t) keeps its digits up to t of 1e15, if omega
 * is the number meant; the sums are those of doubles, some 1e-15 of the largest coordinate. Compile without
 * -ffast-math.
 *
 * Self-test: cc -std=c99 -O2 -D${name}_SELF_TEST FILE.c -lm && ./a.out
 * prints the largest deviation from embedded vectors and fails above $tolerance.
 */
"""

OWN_FREQUENCIES = """\
 *               or NULL for the corrected frequencies omega(A) at these amplitudes"""

GIVEN_FREQUENCIES = """\
 *               which are those of the divisors too; the derivative of omega(A) is taken at fixed ones"""

RETURNS = {
    "straight": " * The functions with a count return 0.",
    "universal": " * The functions with a count return 0, or 2 and do nothing where frequencies is NULL.",
    "tables": " * The functions with a count return 0, or 1 and do nothing where memory cannot be allocated.",
}

STRAIGHT_MEMORY = """\
 * Nothing is allocated and nothing shared is written: the functions may be called from several threads. What depends
 * on the amplitudes alone is computed once a call. A time that is not finite gives NaN."""

TABLE_MEMORY = """\
 * Nothing shared is written: the functions may be called from several threads. A call first sums the powers of the
 * amplitudes, into $work doubles that it allocates and frees, so give it many times at once. It uses about
 * $stack bytes of stack. A time that is not finite gives NaN."""

DECLARATIONS = """
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

int ${name}_orbit(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P);
int ${name}_positions(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q);
int ${name}_momenta(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *P);
void ${name}_corrected_frequencies(const double *amplitudes,
    ${divisors}double *omega, double *jacobian);

enum { $numbers };

/* Turns per time omega / (2 pi) of every seed, as sums of two doubles. */
static void split_turns(const double *omega, double *turns, double *turns_low)
{
    int i;
    for (i = 0; i < SEEDS; i++) {
        turns[i] = omega[i] * 0.15915494309189535;
        turns_low[i] = fma(omega[i], 0.15915494309189535, -turns[i]) + omega[i] * -9.839338337591243e-18;
    }
}
"""

SHORTCUTS = """
int ${name}_positions(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q)
{
    return ${name}_orbit(count, t, amplitudes, phases, frequencies, Q, NULL);
}

int ${name}_momenta(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *P)
{
    return ${name}_orbit(count, t, amplitudes, phases, frequencies, NULL, P);
}
"""

STRAIGHT = """
$constants
/* omega t + phi after whole turns are taken off. */
static double angle(double t, double turns, double turns_low, double phase)
{
    const double turn = t * turns, rest = fma(t, turns, -turn) + t * turns_low;
    return phase + 6.283185307179586 * (turn - floor(turn + 0.5) + rest);
}

void ${name}_corrected_frequencies(const double *amplitudes,
    ${divisors}double *omega, double *jacobian)
{
$correction
    if (jacobian) {
$jacobian
    }
}

int ${name}_orbit(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P)
{
    double ${own}turns[SEEDS], turns_low[SEEDS];
    size_t i;
$default
    split_turns(frequencies, turns, turns_low);
$coefficients
    for (i = 0; i < count; i++) {
$waves
        if (Q) {
            double *const q = Q + i * MODES;
$positions
        }
        if (P) {
            double *const p = P + i * MODES;
$momenta
        }
    }
    return 0;
}
"""

OWN_DEFAULT = """\
    if (!frequencies) {
        ${name}_corrected_frequencies(amplitudes, corrected, NULL);
        frequencies = corrected;
    }"""

REQUIRED = """\
    if (!frequencies)
        return 2;"""

COLLAPSE = """
/* Powers of the scaled amplitudes: x_i^n is x[place[i] + n]. */
static void fill_amplitudes(const double *amplitudes, double *x)
{
    int i, n;
    for (i = 0; i < SEEDS; i++) {
        const double scaled = scales[i] * amplitudes[i];
        x[place[i]] = 1;
        for (n = 1; n <= degrees[i]; n++)
            x[place[i] + n] = x[place[i] + n - 1] * scaled;
    }
}

/* The rates nu.omega of a block, then its coefficients of cos(nu.theta), at the monomials of these amplitudes. */
static void collapse_block(int count, int modes, int width, const short *nu, const int *starts, const int *powers,
                           const double *c, const double *monomials, const double *omega, double *work)
{
    double *sums = work + count;
    int h, i, m, r;
    for (h = 0; h < count; h++, nu += SEEDS, sums += width) {
        work[h] = 0;
        for (i = 0; i < SEEDS; i++)
            work[h] += nu[i] * omega[i];
        for (m = 0; m < width; m++)
            sums[m] = 0;
        for (r = starts[h]; r < starts[h + 1]; r++, c += modes)
            for (m = 0; m < modes; m++)
                sums[m] += c[m] * monomials[powers[r]];
    }
}

/* Everything that depends on amplitudes and frequencies alone; the monomials are behind what the blocks keep. */
static void collapse(const double *amplitudes, const double *omega, double *work)
{
    double x[AMPLITUDE_POWERS], *monomials = work + WORK - MONOMIALS;
    int i, k;
    fill_amplitudes(amplitudes, x);
    for (k = 0; k < MONOMIALS; k++) {
        monomials[k] = 1;
        for (i = 0; i < SEEDS; i++)
            monomials[k] *= x[place[i] + exponents[k][i]];
    }
$collapses
}
"""

TABLE_FUNCTIONS = """
void ${name}_corrected_frequencies(const double *amplitudes,
    double *omega, double *jacobian)
{
    double x[AMPLITUDE_POWERS];
    int i, j, k, f;
    fill_amplitudes(amplitudes, x);
    for (i = 0; i < SEEDS; i++) {
        omega[i] = 0;
        for (j = 0; jacobian && j < SEEDS; j++)
            jacobian[i * SEEDS + j] = 0;
    }
    for (f = TERMS - 1; f >= 0; f--) { /* small terms first */
        const short *e = frequency_exponents[f];
        double monomial = 1;
        for (i = 0; i < SEEDS; i++)
            monomial *= x[place[i] + 2 * e[i]];
        for (i = 0; i < SEEDS; i++)
            omega[i] += frequency_coefficients[f][i] * monomial;
        for (j = 0; jacobian && j < SEEDS; j++) {
            double slope = 2 * e[j] * scales[j];
            if (e[j] == 0)
                continue;
            for (k = 0; k < SEEDS; k++)
                slope *= x[place[k] + 2 * e[k] - (k == j)];
            for (i = 0; i < SEEDS; i++)
                jacobian[i * SEEDS + j] += frequency_coefficients[f][i] * slope;
        }
    }
    for (i = 0; i < SEEDS; i++)
        omega[i] += linear[i];
}

static void trajectories(const double *turns, const double *turns_low, const double *work,
                         size_t count, const double *t, const double *phases, double *Q, double *P)
{
$loop}

int ${name}_orbit(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P)
{
    double corrected[SEEDS], turns[SEEDS], turns_low[SEEDS], *work = malloc(WORK * sizeof(double));
    if (!work)
        return 1;
$default
    split_turns(frequencies, turns, turns_low);
    collapse(amplitudes, frequencies, work);
    trajectories(turns, turns_low, work, count, t, phases, Q, P);
    free(work);
    return 0;
}
"""

GIVEN = """\
const double *turns, const double *turns_low, const double *work,
                     """

SELF_TEST = """
#ifdef ${name}_SELF_TEST
#include <stdio.h>

$tables
$deviation
int main(void)
{
    double Q[$checks * MODES], P[$checks * MODES], omega[SEEDS], jacobian[SEEDS * SEEDS], found[4];
    int bad, i;
    bad = ${name}_orbit($checks, test_times,
        test_amplitudes, test_phases, test_frequencies, Q, P);
    ${name}_corrected_frequencies(test_amplitudes, ${test_divisors}omega, jacobian);
    found[0] = deviation($checks * MODES, Q, &test_positions[0][0]);
    found[1] = deviation($checks * MODES, P, &test_momenta[0][0]);
    found[2] = deviation(SEEDS, omega, test_corrected);
    found[3] = deviation(SEEDS * SEEDS, jacobian, &test_jacobian[0][0]);
    for (i = 0; i < 4; i++)
        bad += !(found[i] <= $tolerance);
    printf("largest deviation: %.2g of the largest coordinate, %.2g of the largest momentum, %.2g of the corrected\\n"
           "frequencies, %.2g of their Jacobian; %s %g\\n",
           found[0], found[1], found[2], found[3], bad ? "ABOVE" : "at most", $tolerance);
    return bad ? 1 : 0;
}
#endif
"""
