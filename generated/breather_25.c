/* Machine-written: a quasi-periodic solution of an FPU chain,
 *
 *     Q_q(t) = sum over nu of c_q[nu] cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1.
 *
 *  written by: symfpu 0.1.0
 *  made by: symfpu export breather_25.symfpu --lang c -o breather_25
 *  orders: frequencies 12, coordinates 12
 *  amplitudes: A_25 = 0.0512121591740189630941015617021
 *  chain: Chain(N=32, alpha=0.33)
 *  seeds: 25
 *  frequencies: 1.8830741847088537
 *  precision: 30 digits
 *  hash of the coefficients: 1dcd398567a325e662ff3b53541cc134d88044b6eb5a24368358e04cb7f01601
 *
 * How to call. Declare in your program what you use of
 *
 *     void breather_25_positions(size_t count, const double *t, const double *phases, double *Q);
 *     void breather_25_momenta(size_t count, const double *t, const double *phases, double *P);
 *     void breather_25_orbit(size_t count, const double *t, const double *phases, double *Q, double *P);
 *     void breather_25_harmonic_energies(size_t count, const double *t, const double *phases, double *E);
 *     void breather_25_energy(size_t count, const double *t, const double *phases, double *H);
 *
 * and compile and link this file: cc -std=c99 -O2 -c FILE.c, with -lm at the end of the link.
 * C++ declares the functions extern "C".
 *   t       count times, any real numbers
 *   phases  1 angles phi in radians, one a seed in the order above, or NULL for (0.0)
 *   Q, P, E count x (N-1) = count x 31, row-major: mode q at the i-th time is [i * 31 + q - 1]
 *   H       count
 * All quantities are dimensionless. E_q = (P_q^2 + Omega_q^2 Q_q^2) / 2 is the energy of mode q, H the total energy.
 * Nothing is allocated and nothing shared is written: the functions may be called from several threads. They use about
 * 32000 bytes of stack. A time that is not finite gives NaN.
 *
 * Accuracy: omega t is reduced to one turn in two doubles, so nu.(omega t) keeps its digits up to t of 1e15; the sums
 * are those of doubles, some 1e-15 of the largest coordinate. Phases are as good as their own last digit. Compile
 * without -ffast-math.
 *
 * Self-test: cc -std=c99 -O2 -Dbreather_25_SELF_TEST FILE.c -lm && ./a.out
 * prints the largest deviation from embedded vectors and fails above 1e-13.
 */

#include <math.h>
#include <stddef.h>

void breather_25_positions(size_t count, const double *t, const double *phases, double *Q);
void breather_25_momenta(size_t count, const double *t, const double *phases, double *P);
void breather_25_orbit(size_t count, const double *t, const double *phases, double *Q, double *P);
void breather_25_harmonic_energies(size_t count, const double *t, const double *phases, double *E);
void breather_25_energy(size_t count, const double *t, const double *phases, double *H);

enum { BONDS = 32, MODES = 31, SEEDS = 1, ROWS = 32, POWERS = 27, TIMES = 16, CHUNK = 32 };

/* Turns per time omega / (2 pi) of every seed, as sums of two doubles. */
static const double turns[1] = {
0.2997005647051548
};
static const double turns_low[1] = {
-9.350283012835618e-18
};
static const double default_phases[1] = {
0
};
static const int highest[1] = {
13
};
static const int zeroth[1] = {
13
};

/* Row of every mode among the sums; the last row is zero. */
static const int row[31] = {
16,0,17,1,18,2,19,3,20,4,21,5,22,6,23,7,24,8,25,9,26,10,27,11,28,12,29,13,30,14,31
};

/* Linear frequencies Omega_q, cos(k pi / 2N), sqrt(2/N), and the couplings alpha/3 and beta/4. */
static const double linear[31] = {
0.09813534865483603,0.1960342806591212,0.2934609489107235,0.39018064403225655,0.4859603598065278,0.5805693545089248,
0.6737797067844401,0.7653668647301796,0.8551101868605642,0.9427934736519953,1.0282054883864435,1.1111404660392044,
1.1913986089848667,1.268786568327291,1.3431179096940369,1.4142135623730951,1.4819022507099182,1.546020906725474,
1.6064150629612899,1.6629392246050905,1.7154572200005442,1.76384252869671,1.8079785862468867,1.8477590650225735,
1.8830881303660416,1.9138806714644176,1.940062506389088,1.9615705608064609,1.978353019929562,1.9903694533443939,
1.9975909124103448
};
static const double cosines[128] = {
1.0,0.9987954562051724,0.9951847266721969,0.989176509964781,0.9807852804032304,0.970031253194544,0.9569403357322088,
0.9415440651830208,0.9238795325112867,0.9039892931234433,0.881921264348355,0.8577286100002721,0.8314696123025452,
0.8032075314806449,0.773010453362737,0.7409511253549591,0.7071067811865476,0.6715589548470184,0.6343932841636455,
0.5956993044924334,0.5555702330196022,0.5141027441932218,0.47139673682599764,0.4275550934302821,0.3826834323650898,
0.33688985339222005,0.2902846772544624,0.2429801799032639,0.19509032201612828,0.14673047445536175,
0.0980171403295606,0.049067674327418015,0,-0.049067674327418015,-0.0980171403295606,-0.14673047445536175,
-0.19509032201612828,-0.2429801799032639,-0.2902846772544624,-0.33688985339222005,-0.3826834323650898,
-0.4275550934302821,-0.47139673682599764,-0.5141027441932218,-0.5555702330196022,-0.5956993044924334,
-0.6343932841636455,-0.6715589548470184,-0.7071067811865476,-0.7409511253549591,-0.773010453362737,
-0.8032075314806449,-0.8314696123025452,-0.8577286100002721,-0.881921264348355,-0.9039892931234433,
-0.9238795325112867,-0.9415440651830208,-0.9569403357322088,-0.970031253194544,-0.9807852804032304,
-0.989176509964781,-0.9951847266721969,-0.9987954562051724,-1.0,-0.9987954562051724,-0.9951847266721969,
-0.989176509964781,-0.9807852804032304,-0.970031253194544,-0.9569403357322088,-0.9415440651830208,
-0.9238795325112867,-0.9039892931234433,-0.881921264348355,-0.8577286100002721,-0.8314696123025452,
-0.8032075314806449,-0.773010453362737,-0.7409511253549591,-0.7071067811865476,-0.6715589548470184,
-0.6343932841636455,-0.5956993044924334,-0.5555702330196022,-0.5141027441932218,-0.47139673682599764,
-0.4275550934302821,-0.3826834323650898,-0.33688985339222005,-0.2902846772544624,-0.2429801799032639,
-0.19509032201612828,-0.14673047445536175,-0.0980171403295606,-0.049067674327418015,0,0.049067674327418015,
0.0980171403295606,0.14673047445536175,0.19509032201612828,0.2429801799032639,0.2902846772544624,
0.33688985339222005,0.3826834323650898,0.4275550934302821,0.47139673682599764,0.5141027441932218,0.5555702330196022,
0.5956993044924334,0.6343932841636455,0.6715589548470184,0.7071067811865476,0.7409511253549591,0.773010453362737,
0.8032075314806449,0.8314696123025452,0.8577286100002721,0.881921264348355,0.9039892931234433,0.9238795325112867,
0.9415440651830208,0.9569403357322088,0.970031253194544,0.9807852804032304,0.989176509964781,0.9951847266721969,
0.9987954562051724
};
static const double norm = 0.25;
static const double cubic = 0.11;
static const double quartic = 0.0;

/* Modes 2, 4, 6, ...: harmonics nu, rates nu.omega, and coefficients of cos(nu.theta) in every mode. */
static const short harmonics_0[7][1] = {
{0},{2},{4},{6},{8},{10},{12}
};
static const double rates_0[7] = {
0,3.7661483694177074,7.532296738835415,11.298445108253123,15.06459347767083,18.830741847088536,22.596890216506246
};
static const double coefficients_0[7][16] = {
{0,0,-2.7675140646771417e-22,4.2461145535150117e-19,0,0,0.00015117757854294937,0,0,-1.0786315577174035e-26,
3.5508781926641617e-15,0,0,4.504624101242449e-10,0},{0,0,6.475573571247884e-24,-1.1054425924466878e-20,0,0,
-1.9354829168338714e-05,0,0,3.0277387632139386e-27,4.278296790564035e-15,0,0,-5.292931896694843e-10,0},{0,0,
-5.076568596010796e-27,-6.547434405602579e-22,0,0,-1.4244560699063556e-12,0,0,-8.798943565472705e-31,
-4.001853415188579e-17,0,0,9.551077410701395e-13,0},{0,0,3.1250813276403224e-29,1.2259705351549925e-24,0,0,
-1.183771896274435e-19,0,0,1.1935546690289248e-33,3.0741888457648474e-20,0,0,7.692810797179155e-20,0},{0,0,
-3.404492072400157e-32,-5.188629273502791e-28,0,0,-8.135185521021295e-27,0,0,-2.9553264933332913e-36,
2.932636965630418e-27,0,0,5.968105559678107e-27,0},{0,0,1.0417857514940804e-35,-6.110739151851142e-35,0,0,
-5.504373572318875e-34,0,0,2.1473604921341954e-39,2.4194676631029753e-34,0,0,4.184160810296171e-34,0},{0,0,
1.4304130218360944e-42,-5.547002995267631e-42,0,0,-3.58516483825606e-41,0,0,-4.951770626469579e-43,
1.7909980366397718e-41,0,0,2.839524050376225e-41,0}
};

/* Modes 1, 3, 5, ...: harmonics nu, rates nu.omega, and coefficients of cos(nu.theta) in every mode. */
static const short harmonics_1[7][1] = {
{1},{3},{5},{7},{9},{11},{13}
};
static const double rates_1[7] = {
1.8830741847088537,5.6492225541265615,9.415370923544268,13.181519292961976,16.947667662379683,20.71381603179739,
24.4799644012151
};
static const double coefficients_1[7][16] = {
{0,1.0085362127709726e-12,-3.0009165730556703e-29,0,0,5.901180334736764e-07,0,0,-6.263956347261713e-17,
-3.0478218234177374e-24,0,0,0.051212159174018966,0,0,1.9848962258524294e-20},{0,-4.41680461344106e-14,
4.119927956461746e-31,0,0,-3.255064309203764e-09,0,0,-2.8137710311924094e-18,2.8204532207813212e-27,0,0,
6.484677900176531e-09,0,0,-9.677505243551741e-24},{0,3.592700000494951e-17,-8.821734306051385e-35,0,0,
-3.170787737648405e-16,0,0,8.298014009276822e-21,-4.2381937600831196e-30,0,0,5.078046961673205e-16,0,0,
2.3109989565631162e-25},{0,3.953076109854066e-24,1.4941832672044366e-37,0,0,-2.4000856282382192e-23,0,0,
-4.18925397951177e-24,1.4397579899091643e-32,0,0,3.6674735063896916e-23,0,0,-3.393665481940952e-28},{0,
3.277552578540149e-31,-2.6891346357676717e-40,0,0,-1.666762440682117e-30,0,0,-5.066825016153425e-31,
-1.232681963069093e-35,0,0,2.488274267685113e-30,0,0,1.1402004196781838e-31},{0,2.407459837840973e-38,
1.64993122821882e-43,0,0,-1.1151673796019302e-37,0,0,-4.464623590164244e-38,3.06140035403912e-39,0,0,
1.6174572296711147e-37,0,0,1.5188423173611879e-38},{0,1.6707763393820603e-45,-3.307432135185679e-47,0,0,
-7.255980735885705e-45,0,0,-3.4421120634491285e-45,4.595750834750287e-46,0,0,1.0284125712579862e-44,0,0,
1.4511214638955135e-45}
};

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
    for (m = 0; m < width; m += 4) {
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
static void evaluate(size_t count, const double *t, const double *phases, double *q, double *p)
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
    add_block(7, 16, &harmonics_0[0][0], rates_0,
              &coefficients_0[0][0], powers, q + 0 * TIMES, p ? p + 0 * TIMES : NULL);
    add_block(7, 16, &harmonics_1[0][0], rates_1,
              &coefficients_1[0][0], powers, q + 16 * TIMES, p ? p + 16 * TIMES : NULL);
}

void breather_25_orbit(size_t count, const double *t, const double *phases, double *Q, double *P)
{
    double q[(ROWS + 1) * TIMES], p[(ROWS + 1) * TIMES];
    size_t start, j;
    int m;
    for (start = 0; start < count; start += TIMES) {
        const size_t size = count - start < TIMES ? count - start : TIMES;
        evaluate(size, t + start, phases ? phases : default_phases, q, P ? p : NULL);
        for (j = 0; j < size; j++) {
            for (m = 0; m < MODES; m++) {
                if (Q)
                    Q[(start + j) * MODES + m] = q[row[m] * TIMES + j];
                if (P)
                    P[(start + j) * MODES + m] = p[row[m] * TIMES + j];
            }
        }
    }
}

void breather_25_positions(size_t count, const double *t, const double *phases, double *Q)
{
    breather_25_orbit(count, t, phases, Q, NULL);
}

void breather_25_momenta(size_t count, const double *t, const double *phases, double *P)
{
    breather_25_orbit(count, t, phases, NULL, P);
}

void breather_25_harmonic_energies(size_t count, const double *t, const double *phases, double *E)
{
    double Q[TIMES * MODES], P[TIMES * MODES];
    size_t start, i;
    for (start = 0; start < count; start += TIMES) {
        const size_t size = count - start < TIMES ? count - start : TIMES;
        breather_25_orbit(size, t + start, phases, Q, P);
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

void breather_25_energy(size_t count, const double *t, const double *phases, double *H)
{
    double Q[TIMES * MODES], P[TIMES * MODES];
    size_t start, i;
    for (start = 0; start < count; start += TIMES) {
        const size_t size = count - start < TIMES ? count - start : TIMES;
        breather_25_orbit(size, t + start, phases, Q, P);
        for (i = 0; i < size; i++)
            H[start + i] = total_energy(Q + i * MODES, P + i * MODES);
    }
}

#ifdef breather_25_SELF_TEST
#include <stdio.h>

static const double test_times[3] = {
0,1.234375,137.796875
};
static const double test_positions[3][31] = {
{0,0,9.6440409364052e-13,0,-2.959726100310401e-29,-2.7028087824828355e-22,0,4.129035114381462e-19,0,0,
5.86862968847394e-07,0,0,0.00013182274795015445,0,0,-6.544504067905475e-17,0,-3.04500559400546e-24,
-7.759455517715154e-27,0,7.7891871909677e-15,0,0,0.05121216565869737,0,0,-7.787567172724107e-11,0,0,
1.9839515513923868e-20},{0,0,-7.241679553402571e-13,0,2.085251235081777e-29,-2.7715760804947482e-22,0,
4.259631807399359e-19,0,0,-4.06319492161124e-07,0,0,0.0001524067436239879,0,0,4.069823385205482e-17,0,
2.087752789484391e-24,-1.0977724620074538e-26,0,3.318878725767714e-15,0,0,-0.035043730852875585,0,0,
4.83128734278628e-10,0,0,-1.3589683746960516e-20},{0,0,-3.330365598752126e-13,0,9.201257395678256e-30,
-2.8209523602299377e-22,0,4.3349463894918926e-19,0,0,-1.771376638489641e-07,0,0,0.00016714428250076417,0,0,
1.6317659798916568e-17,0,9.039102548579908e-25,-1.328435642606408e-26,0,7.06830281146286e-18,0,0,
-0.01515105813937161,0,0,8.874460005629892e-10,0,0,-5.880112226135846e-21}
};
static const double test_momenta[3][31] = {
{0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0},{0,0,-1.2257722678242292e-12,0,
3.972521578464938e-29,2.4343241552803087e-23,0,-4.0937039815554095e-20,0,0,-7.986230819540658e-07,0,0,
-7.274601515061997e-05,0,0,9.619674303442335e-17,0,4.1749854608382265e-24,1.1380722383753839e-26,0,
1.611804303999065e-14,0,0,-0.07032274297416995,0,0,-1.9902847337896515e-09,0,0,-2.721932753244561e-20},{0,0,
-1.969055196177369e-12,0,5.542475596871481e-29,1.382033677472267e-23,0,-1.891868102921784e-20,0,0,
-1.072906910497186e-06,0,0,-4.119995946184042e-05,0,0,1.0280128098752744e-16,0,5.49224856465438e-24,
6.451238643622989e-27,0,9.3884995959541e-15,0,0,-0.09211927600971585,0,0,-1.1333973049153177e-09,0,0,
-3.5737961449745376e-20}
};
static const double test_energies[3] = {
0.004649999361129205,0.004649999361129205,0.004649999361129205
};

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

int main(void)
{
    double Q[3 * MODES], P[3 * MODES], H[3], found[3];
    int bad = 0, i;
    breather_25_orbit(3, test_times, NULL, Q, P);
    breather_25_energy(3, test_times, NULL, H);
    found[0] = deviation(3 * MODES, Q, &test_positions[0][0]);
    found[1] = deviation(3 * MODES, P, &test_momenta[0][0]);
    found[2] = deviation(3, H, test_energies);
    for (i = 0; i < 3; i++)
        bad += !(found[i] <= 1e-13);
    printf("largest deviation: %.2g of the largest coordinate, %.2g of the largest momentum, %.2g of the energy; "
           "%s %g\n", found[0], found[1], found[2], bad ? "ABOVE" : "at most", 1e-13);
    return bad ? 1 : 0;
}
#endif
