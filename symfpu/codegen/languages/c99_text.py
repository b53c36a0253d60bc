"""The C99 that is the same in every exported file; words in braces or dollars are filled in by symfpu.codegen.languages.c99."""

HEADER = """\
/* Machine-written: a quasi-periodic solution of an FPU chain,
 *
 *     Q_q(t) = sum over nu of c_q[nu] cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1.
 *
$facts
 *
 * How to call. Declare in your program what you use of
 *
 *     void ${name}_positions(size_t count, const double *t, const double *phases, double *Q);
 *     void ${name}_momenta(size_t count, const double *t, const double *phases, double *P);
 *     void ${name}_orbit(size_t count, const double *t, const double *phases, double *Q, double *P);
 *     void ${name}_harmonic_energies(size_t count, const double *t, const double *phases, double *E);
 *     void ${name}_energy(size_t count, const double *t, const double *phases, double *H);
 *
 * and compile and link this file: cc -std=c99 -O2 -c FILE.c, with -lm at the end of the link.
 * C++ declares the functions extern "C".
 *   t       count times, any real numbers
 *   phases  $seeds angles phi in radians, one a seed in the order above, or NULL for ($default)
 *   Q, P, E count x (N-1) = count x ${modes}, row-major: mode q at the i-th time is [i * $modes + q - 1]
 *   H       count
 * All quantities are dimensionless. E_q = (P_q^2 + Omega_q^2 Q_q^2) / 2 is the energy of mode q, H the total energy.
 * Nothing is allocated and nothing shared is written: the functions may be called from several threads. They use about
 * $stack bytes of stack. A time that is not finite gives NaN.
 *
 * Accuracy: omega t is reduced to one turn in two doubles, so nu.(omega t) keeps its digits up to t of 1e15; the sums
 * are those of doubles, some 1e-15 of the largest coordinate. Phases are as good as their own last digit. Compile
 * without -ffast-math.
 *
 * Self-test: cc -std=c99 -O2 -D${name}_SELF_TEST FILE.c -lm && ./a.out
 * prints the largest deviation from embedded vectors and fails above $tolerance.
 */
"""

DECLARATIONS = """
#include <math.h>
#include <stddef.h>

void ${name}_positions(size_t count, const double *t, const double *phases, double *Q);
void ${name}_momenta(size_t count, const double *t, const double *phases, double *P);
void ${name}_orbit(size_t count, const double *t, const double *phases, double *Q, double *P);
void ${name}_harmonic_energies(size_t count, const double *t, const double *phases, double *E);
void ${name}_energy(size_t count, const double *t, const double *phases, double *H);

enum { BONDS = $bonds, MODES = $modes, SEEDS = $seeds, ROWS = $rows, POWERS = $powers, TIMES = $times, CHUNK = $chunk };
"""

KERNEL = """
/* A vector of doubles that need no alignment. The code below is the same for one double. */
#if defined(__GNUC__) && defined(__AVX512F__)
typedef double lane __attribute__((vector_size(64), aligned(8), may_alias));
#elif defined(__GNUC__) && defined(__AVX__)
typedef double lane __attribute__((vector_size(32), aligned(8), may_alias));
#elif defined(__GNUC__)
typedef double lane __attribute__((vector_size(16), aligned(8), may_alias));
#else
typedef double lane;
#endif
enum { LANES = sizeof(lane) / sizeof(double) };

/* sums[m][j] += sum over h of c[h][m] x[h][j]; modes four by four, times two vectors by two. */
static void accumulate(int count, int width, const double *x, const double *c, double *sums)
{
    int m, j, h;
    for (m = 0; m < width; m += $tile) {
        for (j = 0; j < TIMES; j += 2 * LANES) {
            lane *s0 = (lane *)(sums + m * TIMES + j), *s1 = (lane *)(sums + (m + 1) * TIMES + j);
            lane *s2 = (lane *)(sums + (m + 2) * TIMES + j), *s3 = (lane *)(sums + (m + 3) * TIMES + j);
            lane a0 = s0[0], a1 = s1[0], a2 = s2[0], a3 = s3[0];
            lane b0 = s0[1], b1 = s1[1], b2 = s2[1], b3 = s3[1];
            const double *factor = c + m, *value = x + j;
            for (h = 0; h < count; h++) {
                const lane *v = (const lane *)value;
                lane u = v[0], w = v[1];
                a0 += u * factor[0];
                b0 += w * factor[0];
                a1 += u * factor[1];
                b1 += w * factor[1];
                a2 += u * factor[2];
                b2 += w * factor[2];
                a3 += u * factor[3];
                b3 += w * factor[3];
                factor += width;
                value += TIMES;
            }
            s0[0] = a0, s1[0] = a1, s2[0] = a2, s3[0] = a3;
            s0[1] = b0, s1[1] = b1, s2[1] = b2, s3[1] = b3;
        }
    }
}

/* z = x y; complex numbers at TIMES times, real parts first. */
static void multiply(const double *x, const double *y, double *z)
{
    int j;
    for (j = 0; j < TIMES; j += LANES) {
        const lane a = *(const lane *)(x + j), b = *(const lane *)(x + TIMES + j);
        const lane c = *(const lane *)(y + j), d = *(const lane *)(y + TIMES + j);
        *(lane *)(z + j) = a * c - b * d;
        *(lane *)(z + TIMES + j) = a * d + b * c;
    }
}

/* e^(i m theta) of one seed for |m| <= top, around `zero`. */
static void fill_powers(const double *theta, int top, double *zero)
{
    int m, j;
    for (j = 0; j < TIMES; j++) {
        zero[j] = 1;
        zero[TIMES + j] = 0;
        if (top > 0) {
            zero[2 * TIMES + j] = cos(theta[j]);
            zero[3 * TIMES + j] = sin(theta[j]);
        }
    }
    for (m = 2; m <= top; m++)
        multiply(zero + m / 2 * 2 * TIMES, zero + (m - m / 2) * 2 * TIMES, zero + m * 2 * TIMES);
    for (m = 1; m <= top; m++) {
        const double *plus = zero + m * 2 * TIMES;
        double *minus = zero - m * 2 * TIMES;
        for (j = 0; j < TIMES; j++) {
            minus[j] = plus[j];
            minus[TIMES + j] = -plus[TIMES + j];
        }
    }
}

/* Adds the harmonics of one parity to the sums for Q, and to those for P unless p is NULL. */
static void add_block(int count, int width, const short *nu, const double *rate, const double *c,
                      const double *powers, double *q, double *p)
{
    double leading[SEEDS][2 * TIMES], z[2 * TIMES], cosine[CHUNK * TIMES], slope[CHUNK * TIMES];
    int start, h, i, j;
    for (j = 0; j < TIMES; j++) {
        leading[0][j] = 1;
        leading[0][TIMES + j] = 0;
    }
    for (start = 0; start < count; start += CHUNK) {
        const int size = count - start < CHUNK ? count - start : CHUNK;
        for (h = 0; h < size; h++, nu += SEEDS) {
            i = 0; /* the first seed whose number differs from the harmonic before */
            if (start + h > 0)
                while (i < SEEDS - 1 && nu[i] == nu[i - SEEDS])
                    i++;
            for (; i < SEEDS - 1; i++)
                multiply(leading[i], powers + (zeroth[i] + nu[i]) * 2 * TIMES, leading[i + 1]);
            multiply(leading[i], powers + (zeroth[i] + nu[i]) * 2 * TIMES, z);
            for (j = 0; j < TIMES; j++) {
                cosine[h * TIMES + j] = z[j];
                slope[h * TIMES + j] = -rate[start + h] * z[TIMES + j];
            }
        }
        accumulate(size, width, cosine, c + start * width, q);
        if (p)
            accumulate(size, width, slope, c + start * width, p);
    }
}

/* Sums q[row][j] and p[row][j] at up to TIMES times; p may be NULL. */
static void evaluate(${given}size_t count, const double *t, const double *phases, double *q, double *p)
{
    double powers[POWERS * 2 * TIMES], theta[TIMES];
    int i, j;
    for (i = 0; i < SEEDS; i++) {
        for (j = 0; j < TIMES; j++) {
            const double time = (size_t)j < count ? t[j] : 0, turn = time * turns[i];
            const double rest = fma(time, turns[i], -turn) + time * turns_low[i];
            theta[j] = phases[i] + 6.283185307179586 * (turn - floor(turn + 0.5) + rest);
        }
        fill_powers(theta, highest[i], powers + zeroth[i] * 2 * TIMES);
    }
    for (i = 0; i < (ROWS + 1) * TIMES; i++) {
        q[i] = 0;
        if (p)
            p[i] = 0;
    }
$calls
}
"""

LOOP = """\
    double q[(ROWS + 1) * TIMES], p[(ROWS + 1) * TIMES];
    size_t start, j;
    int m;
    for (start = 0; start < count; start += TIMES) {
        const size_t size = count - start < TIMES ? count - start : TIMES;
        evaluate(${passed}size, t + start, phases ? phases : default_phases, q, P ? p : NULL);
        for (j = 0; j < size; j++) {
            for (m = 0; m < MODES; m++) {
                if (Q)
                    Q[(start + j) * MODES + m] = q[row[m] * TIMES + j];
                if (P)
                    P[(start + j) * MODES + m] = p[row[m] * TIMES + j];
            }
        }
    }
"""

FUNCTIONS = """
void ${name}_orbit(size_t count, const double *t, const double *phases, double *Q, double *P)
{
$loop}

void ${name}_positions(size_t count, const double *t, const double *phases, double *Q)
{
    ${name}_orbit(count, t, phases, Q, NULL);
}

void ${name}_momenta(size_t count, const double *t, const double *phases, double *P)
{
    ${name}_orbit(count, t, phases, NULL, P);
}

void ${name}_harmonic_energies(size_t count, const double *t, const double *phases, double *E)
{
    double Q[TIMES * MODES], P[TIMES * MODES];
    size_t start, i;
    for (start = 0; start < count; start += TIMES) {
        const size_t size = count - start < TIMES ? count - start : TIMES;
        ${name}_orbit(size, t + start, phases, Q, P);
        for (i = 0; i < size * MODES; i++) {
            const double u = linear[i % MODES] * Q[i];
            E[start * MODES + i] = 0.5 * (P[i] * P[i] + u * u);
        }
    }
}

/* H by the stretches of the bonds, r_j = sqrt(2/N) sum_q Omega_q Q_q cos(q (2j + 1) pi / 2N). */
static double total_energy(const double *Q, const double *P)
{
    double sum = 0;
    int j, m;
    for (m = 0; m < MODES; m++)
        sum += 0.5 * P[m] * P[m];
    for (j = 0; j < BONDS; j++) {
        double r = 0;
        int angle = 0;
        for (m = 0; m < MODES; m++) {
            angle = (angle + 2 * j + 1) % (4 * BONDS);
            r += linear[m] * Q[m] * cosines[angle];
        }
        r *= norm;
        sum += r * r * (0.5 + r * (cubic + r * quartic));
    }
    return sum;
}

void ${name}_energy(size_t count, const double *t, const double *phases, double *H)
{
    double Q[TIMES * MODES], P[TIMES * MODES];
    size_t start, i;
    for (start = 0; start < count; start += TIMES) {
        const size_t size = count - start < TIMES ? count - start : TIMES;
        ${name}_orbit(size, t + start, phases, Q, P);
        for (i = 0; i < size; i++)
            H[start + i] = total_energy(Q + i * MODES, P + i * MODES);
    }
}
"""

DEVIATION = """\
/* Largest deviation of the values relative to the largest of the expected ones. */
static double deviation(int count, const double *values, const double *expected)
{
    double worst = 0, largest = 0;
    int i;
    for (i = 0; i < count; i++) {
        const double off = fabs(values[i] - expected[i]);
        if (!(off <= worst) && worst == worst) /* a NaN stays */
            worst = off;
        largest = fmax(largest, fabs(expected[i]));
    }
    return largest > 0 ? worst / largest : worst;
}
"""

SELF_TEST = """
#ifdef ${name}_SELF_TEST
#include <stdio.h>

$tables
$deviation
int main(void)
{
    double Q[$checks * MODES], P[$checks * MODES], H[$checks], found[3];
    int bad = 0, i;
    ${name}_orbit($checks, test_times, NULL, Q, P);
    ${name}_energy($checks, test_times, NULL, H);
    found[0] = deviation($checks * MODES, Q, &test_positions[0][0]);
    found[1] = deviation($checks * MODES, P, &test_momenta[0][0]);
    found[2] = deviation($checks, H, test_energies);
    for (i = 0; i < 3; i++)
        bad += !(found[i] <= $tolerance);
    printf("largest deviation: %.2g of the largest coordinate, %.2g of the largest momentum, %.2g of the energy; "
           "%s %g\\n", found[0], found[1], found[2], bad ? "ABOVE" : "at most", $tolerance);
    return bad ? 1 : 0;
}
#endif
"""
