/* Machine-written: quasi-periodic solutions of an FPU chain as a series with free amplitudes A,
 *
 *     Q_q(t) = sum over nu of c_q[nu](A) cos(nu.theta),   P_q = dQ_q/dt,   q = 1 .. N-1,
 *
 * with angles theta_i = omega_i t + phi_i.
 *
 *  written by: symfpu 0.1.0
 *  made by: symfpu export two_torus.symfpu --lang c -o two_torus_series --series --order 3 --frequency-order 4
 *  chain: Chain(N=16, alpha=0.33)
 *  seeds: 1, 2
 *  frequencies of the divisors: 0.19626, 0.39046
 *  orders: frequencies 4, coordinates 3
 *  precision: 30 digits
 *  hash of the series: 1978bc5725bd9fa9918f10cf37fc7ccee026a7cb89aa0e44b5289a02f8ed0182
 *
 * How to call. Declare in your program what you use of
 *
 *     int two_torus_series_orbit(size_t count, const double *t,
 *         const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P);
 *     int two_torus_series_positions(size_t count, const double *t,
 *         const double *amplitudes, const double *phases, const double *frequencies, double *Q);
 *     int two_torus_series_momenta(size_t count, const double *t,
 *         const double *amplitudes, const double *phases, const double *frequencies, double *P);
 *     void two_torus_series_corrected_frequencies(const double *amplitudes,
 *         double *omega, double *jacobian);
 *
 * and compile and link this file: cc -std=c99 -O2 -c FILE.c, with -lm at the end of the link.
 * C++ declares the functions extern "C".
 *   t           count times, any real numbers
 *   amplitudes  A of every seed (2), in the order above; A_q multiplies cos(theta_q) in Q_q
 *   phases      phi of every seed (2) in radians, or NULL for zeros
 *   frequencies omega of every seed (2), radians per time,
 *               or NULL for the corrected frequencies omega(A) at these amplitudes
 *   Q, P        count x (N-1) = count x 15, row-major: mode q at the i-th time is [i * 15 + q - 1];
 *               of two_torus_series_orbit either may be NULL
 *   omega       corrected frequencies (2): omega(A), the series of the frequencies at these amplitudes
 *   jacobian    2 x 2, row-major: d omega_i / d A_j is [i * 2 + j]; or NULL
 * The functions with a count return 0.
 * All quantities are dimensionless. The series is an expansion in small amplitudes; how far it holds is not checked.
 * Nothing is allocated and nothing shared is written: the functions may be called from several threads. What depends
 * on the amplitudes alone is computed once a call. A time that is not finite gives NaN.
 *
 * Accuracy: omega t is reduced to one turn in two doubles, so nu.(omega t) keeps its digits up to t of 1e15, if omega
 * is the number meant; the sums are those of doubles, some 1e-15 of the largest coordinate. Compile without
 * -ffast-math.
 *
 * Self-test: cc -std=c99 -O2 -Dtwo_torus_series_SELF_TEST FILE.c -lm && ./a.out
 * prints the largest deviation from embedded vectors and fails above 1e-13.
 */

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

int two_torus_series_orbit(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P);
int two_torus_series_positions(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q);
int two_torus_series_momenta(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *P);
void two_torus_series_corrected_frequencies(const double *amplitudes,
    double *omega, double *jacobian);

enum { MODES = 15, SEEDS = 2 };

/* Turns per time omega / (2 pi) of every seed, as sums of two doubles. */
static void split_turns(const double *omega, double *turns, double *turns_low)
{
    int i;
    for (i = 0; i < SEEDS; i++) {
        turns[i] = omega[i] * 0.15915494309189535;
        turns_low[i] = fma(omega[i], 0.15915494309189535, -turns[i]) + omega[i] * -9.839338337591243e-18;
    }
}


/* omega t + phi after whole turns are taken off. */
static double angle(double t, double turns, double turns_low, double phase)
{
    const double turn = t * turns, rest = fma(t, turns, -turn) + t * turns_low;
    return phase + 6.283185307179586 * (turn - floor(turn + 0.5) + rest);
}

void two_torus_series_corrected_frequencies(const double *amplitudes,
    double *omega, double *jacobian)
{
    const double A1 = amplitudes[0];
    const double A2 = amplitudes[1];
    const double y0 = (A1*A1);
    const double y1 = (A1*A1*A1*A1);
    const double y2 = (A2*A2);
    const double y3 = (A2*A2*A2*A2);
    const double y4 = y0*y2;
    const double y5 = (A1*A1*A1);
    const double y6 = (A2*A2*A2);
    const double y7 = A2*y0;
    omega[0] = 0.000592160852870222*y0 + 0.00039529957083372116*y1 - 9.294742582813598e-05*y2 +
        0.0021470587971840756*y3 - 0.001402329305497235*y4 + 0.1960342806591212;
    omega[1] = -4.6698579337598625e-05*y0 - 0.0004451823698547334*y1 + 0.0011298915795266533*y2 +
        0.00018810304175985085*y3 + 0.0021023772176948768*y4 + 0.39018064403225655;
    if (jacobian) {
        jacobian[0] = -0.00280465861099447*A1*y2 + 0.001184321705740444*A1 + 0.0015811982833348847*y5;
        jacobian[1] = -0.00018589485165627196*A2 + 0.008588235188736302*y6 - 0.00280465861099447*y7;
        jacobian[2] = 0.0042047544353897535*A1*y2 - 9.339715867519725e-05*A1 - 0.0017807294794189336*y5;
        jacobian[3] = 0.0022597831590533066*A2 + 0.0007524121670394034*y6 + 0.0042047544353897535*y7;
    }
}

int two_torus_series_orbit(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P)
{
    double corrected[SEEDS], turns[SEEDS], turns_low[SEEDS];
    size_t i;
    if (!frequencies) {
        two_torus_series_corrected_frequencies(amplitudes, corrected, NULL);
        frequencies = corrected;
    }
    split_turns(frequencies, turns, turns_low);
    const double phase1 = phases ? phases[0] : 0;
    const double phase2 = phases ? phases[1] : 0;
    const double A1 = amplitudes[0];
    const double A2 = amplitudes[1];
    const double omega1 = frequencies[0];
    const double omega2 = frequencies[1];
    const double x0 = (A1*A1);
    const double x1 = (A1*A1*A1*A1);
    const double x2 = (A2*A2);
    const double x3 = x0*x2;
    const double x4 = (A2*A2*A2*A2);
    const double x5 = A2*x0;
    const double x6 = (A2*A2*A2);
    const double x7 = (A1*A1*A1);
    const double x8 = A1*x2;
    const double x9 = 2*omega2;
    const double x10 = -omega2;
    const double x11 = A1*A2;
    const double x12 = A2*x7;
    const double x13 = A1*x6;
    const double x14 = 2*omega1;
    const double x15 = 3*omega2;
    const double x16 = -x9;
    const double x17 = 3*omega1;
    const double c0_2 = -0.0028687032351990722*x0 + 3.981975731204928e-05*x1 - 0.0035713364733041936*x3;
    const double c0_4 = -0.000406708251684491*x1 - 0.005801906708236072*x2 - 0.0001028515026733883*x3 +
        7.667301950445486e-05*x4;
    const double c0_6 = -0.0010408166713117288*x3;
    const double c0_8 = -0.00020060716303406162*x4;
    const double rate1 = omega2;
    const double c1_2 = 1.0*A2;
    const double d1_2 = -c1_2*rate1;
    const double c1_4 = -0.004039781598349474*x5;
    const double d1_4 = -c1_4*rate1;
    const double c1_6 = -0.002320270331342854*x6;
    const double d1_6 = -c1_6*rate1;
    const double rate2 = omega1;
    const double c2_1 = 1.0*A1;
    const double d2_1 = -c2_1*rate2;
    const double c2_3 = 0.009609144222270698*A1*x2 - 0.002303123425996099*x7;
    const double d2_3 = -c2_3*rate2;
    const double c2_5 = -0.005047163976846871*x8;
    const double d2_5 = -c2_5*rate2;
    const double rate3 = x9;
    const double c3_2 = -0.004792413558393184*x3;
    const double d3_2 = -c3_2*rate3;
    const double c3_4 = 0.14131948233035063*x2 - 0.14695492167776708*x3 + 0.014368474457199321*x4;
    const double d3_4 = -c3_4*rate3;
    const double c3_6 = -0.0013476891206633246*x3;
    const double d3_6 = -c3_6*rate3;
    const double c3_8 = -0.0003951786865153717*x4;
    const double d3_8 = -c3_8*rate3;
    const double rate4 = omega1 + x10;
    const double c4_1 = 1.1173455145685154*A1*x6 - 1.087489189529932*x11 - 0.6363185137238475*x12;
    const double d4_1 = -c4_1*rate4;
    const double c4_3 = -0.008653976202413236*x11 + 4.7364636676905825e-06*x12 + 9.728805847404313e-05*x13;
    const double d4_3 = -c4_3*rate4;
    const double c4_5 = 0.006211803094997529*A1*x6 - 0.0013302049702459508*x12;
    const double d4_5 = -c4_5*rate4;
    const double c4_7 = -0.0009241366554937783*x13;
    const double d4_7 = -c4_7*rate4;
    const double rate5 = omega1 + omega2;
    const double c5_1 = 0.002861155751656057*x11 - 0.0008970374368847945*x12 + 4.721718220062921e-06*x13;
    const double d5_1 = -c5_1*rate5;
    const double c5_3 = 0.36082081426335916*x11 - 0.013108564194709953*x12 + 0.03162233624033316*x13;
    const double d5_3 = -c5_3*rate5;
    const double c5_5 = 0.00213343820329272*A1*x6 - 0.0018278113797905548*x12;
    const double d5_5 = -c5_5*rate5;
    const double c5_7 = -0.0015661664830180406*x13;
    const double d5_7 = -c5_7*rate5;
    const double rate6 = x14;
    const double c6_2 = 0.27115700844456897*x0 + 0.12035153297272662*x1 - 0.22278126771983983*x3;
    const double d6_2 = -c6_2*rate6;
    const double c6_4 = 0.004469710359303185*x0*x2 - 0.0008095643183902094*x1;
    const double d6_4 = -c6_4*rate6;
    const double c6_6 = -0.00218467016492829*x3;
    const double d6_6 = -c6_6*rate6;
    const double rate7 = x15;
    const double c7_2 = 0.0007875878368247138*x6;
    const double d7_2 = -c7_2*rate7;
    const double c7_6 = 0.019895233780180387*x6;
    const double d7_6 = -c7_6*rate7;
    const double rate8 = omega1 + x16;
    const double c8_1 = -0.003210142951212994*x8;
    const double d8_1 = -c8_1*rate8;
    const double c8_3 = -0.44037557830840124*x8;
    const double d8_3 = -c8_3*rate8;
    const double c8_5 = -0.0019347032245652866*x8;
    const double d8_5 = -c8_5*rate8;
    const double rate9 = omega1 + x9;
    const double c9_1 = 0.0010227658453562675*x8;
    const double d9_1 = -c9_1*rate9;
    const double c9_3 = 0.0011743413403160225*x8;
    const double d9_3 = -c9_3*rate9;
    const double c9_5 = 0.0857534662498305*x8;
    const double d9_5 = -c9_5*rate9;
    const double rate10 = x10 + x14;
    const double c10_2 = 0.006386591341743735*x5;
    const double d10_2 = -c10_2*rate10;
    const double c10_4 = -0.0030714067691627327*x5;
    const double d10_4 = -c10_4*rate10;
    const double rate11 = omega2 + x14;
    const double c11_2 = 0.002034796453570815*x5;
    const double d11_2 = -c11_2*rate11;
    const double c11_4 = 0.13481870681336375*x5;
    const double d11_4 = -c11_4*rate11;
    const double rate12 = x17;
    const double c12_1 = 0.0007697256811581401*x7;
    const double d12_1 = -c12_1*rate12;
    const double c12_3 = 0.07316275581276288*x7;
    const double d12_3 = -c12_3*rate12;
    const double rate13 = 4*omega2;
    const double c13_4 = 0.00021065985386560155*x4;
    const double d13_4 = -c13_4*rate13;
    const double c13_8 = 0.0027180982348453714*x4;
    const double d13_8 = -c13_8*rate13;
    const double rate14 = omega1 - x15;
    const double c14_1 = -0.0012595569830263697*x13;
    const double d14_1 = -c14_1*rate14;
    const double c14_3 = -0.0013218139253162947*x13;
    const double d14_3 = -c14_3*rate14;
    const double c14_5 = -0.10510386728889293*x13;
    const double d14_5 = -c14_5*rate14;
    const double c14_7 = -0.00034578434218557493*x13;
    const double d14_7 = -c14_7*rate14;
    const double rate15 = omega1 + x15;
    const double c15_1 = 0.00014396810949383098*x13;
    const double d15_1 = -c15_1*rate15;
    const double c15_3 = 0.0007011495712170275*x13;
    const double d15_3 = -c15_3*rate15;
    const double c15_5 = 0.00026112212247840586*x13;
    const double d15_5 = -c15_5*rate15;
    const double c15_7 = 0.01662447386665833*x13;
    const double d15_7 = -c15_7*rate15;
    const double rate16 = x14 + x16;
    const double c16_2 = 0.22587682658901168*x3;
    const double d16_2 = -c16_2*rate16;
    const double c16_4 = 0.004972073555398954*x3;
    const double d16_4 = -c16_4*rate16;
    const double c16_6 = -0.0006089354170374815*x3;
    const double d16_6 = -c16_6*rate16;
    const double rate17 = x14 + x9;
    const double c17_2 = 0.0009665139899628146*x3;
    const double d17_2 = -c17_2*rate17;
    const double c17_4 = 0.0009260643965836509*x3;
    const double d17_4 = -c17_4*rate17;
    const double c17_6 = 0.04075813463519515*x3;
    const double d17_6 = -c17_6*rate17;
    const double rate18 = x10 + x17;
    const double c18_1 = -0.08393514749379542*x12;
    const double d18_1 = -c18_1*rate18;
    const double c18_3 = 0.0025559028660708237*x12;
    const double d18_3 = -c18_3*rate18;
    const double c18_5 = -0.0010087211758185608*x12;
    const double d18_5 = -c18_5*rate18;
    const double rate19 = omega2 + x17;
    const double c19_1 = 0.00048470538167331154*x12;
    const double d19_1 = -c19_1*rate19;
    const double c19_3 = 0.0011166044853950544*x12;
    const double d19_3 = -c19_3*rate19;
    const double c19_5 = 0.04629444016810897*x12;
    const double d19_5 = -c19_5*rate19;
    const double rate20 = 4*omega1;
    const double c20_2 = 0.0004100749283565843*x1;
    const double d20_2 = -c20_2*rate20;
    const double c20_4 = 0.020381730629727663*x1;
    const double d20_4 = -c20_4*rate20;
    for (i = 0; i < count; i++) {
        const double theta1 = angle(t[i], turns[0], turns_low[0], phase1);
        const double theta2 = angle(t[i], turns[1], turns_low[1], phase2);
        const double cos1 = cos(theta2);
        const double sin1 = sin(theta2);
        const double cos2 = cos(theta1);
        const double sin2 = sin(theta1);
        const double cos3 = cos(2*theta2);
        const double sin3 = sin(2*theta2);
        const double cos4 = cos(theta1 - theta2);
        const double sin4 = sin(theta1 - theta2);
        const double cos5 = cos(theta1 + theta2);
        const double sin5 = sin(theta1 + theta2);
        const double cos6 = cos(2*theta1);
        const double sin6 = sin(2*theta1);
        const double cos7 = cos(3*theta2);
        const double sin7 = sin(3*theta2);
        const double cos8 = cos(theta1 - 2*theta2);
        const double sin8 = sin(theta1 - 2*theta2);
        const double cos9 = cos(theta1 + 2*theta2);
        const double sin9 = sin(theta1 + 2*theta2);
        const double cos10 = cos(2*theta1 - theta2);
        const double sin10 = sin(2*theta1 - theta2);
        const double cos11 = cos(2*theta1 + theta2);
        const double sin11 = sin(2*theta1 + theta2);
        const double cos12 = cos(3*theta1);
        const double sin12 = sin(3*theta1);
        const double cos13 = cos(4*theta2);
        const double sin13 = sin(4*theta2);
        const double cos14 = cos(theta1 - 3*theta2);
        const double sin14 = sin(theta1 - 3*theta2);
        const double cos15 = cos(theta1 + 3*theta2);
        const double sin15 = sin(theta1 + 3*theta2);
        const double cos16 = cos(2*theta1 - 2*theta2);
        const double sin16 = sin(2*theta1 - 2*theta2);
        const double cos17 = cos(2*theta1 + 2*theta2);
        const double sin17 = sin(2*theta1 + 2*theta2);
        const double cos18 = cos(3*theta1 - theta2);
        const double sin18 = sin(3*theta1 - theta2);
        const double cos19 = cos(3*theta1 + theta2);
        const double sin19 = sin(3*theta1 + theta2);
        const double cos20 = cos(4*theta1);
        const double sin20 = sin(4*theta1);
        if (Q) {
            double *const q = Q + i * MODES;
            q[0] = c12_1*cos12 + c14_1*cos14 + c15_1*cos15 + c18_1*cos18 + c19_1*cos19 + c2_1*cos2 + c4_1*cos4 +
                c5_1*cos5 + c8_1*cos8 + c9_1*cos9;
            q[1] = c0_2 + c10_2*cos10 + c11_2*cos11 + c16_2*cos16 + c17_2*cos17 + c1_2*cos1 + c20_2*cos20 + c3_2*
                cos3 + c6_2*cos6 + c7_2*cos7;
            q[2] = c12_3*cos12 + c14_3*cos14 + c15_3*cos15 + c18_3*cos18 + c19_3*cos19 + c2_3*cos2 + c4_3*cos4 +
                c5_3*cos5 + c8_3*cos8 + c9_3*cos9;
            q[3] = c0_4 + c10_4*cos10 + c11_4*cos11 + c13_4*cos13 + c16_4*cos16 + c17_4*cos17 + c1_4*cos1 + c20_4*
                cos20 + c3_4*cos3 + c6_4*cos6;
            q[4] = c14_5*cos14 + c15_5*cos15 + c18_5*cos18 + c19_5*cos19 + c2_5*cos2 + c4_5*cos4 + c5_5*cos5 + c8_5*
                cos8 + c9_5*cos9;
            q[5] = c0_6 + c16_6*cos16 + c17_6*cos17 + c1_6*cos1 + c3_6*cos3 + c6_6*cos6 + c7_6*cos7;
            q[6] = c14_7*cos14 + c15_7*cos15 + c4_7*cos4 + c5_7*cos5;
            q[7] = c0_8 + c13_8*cos13 + c3_8*cos3;
            q[8] = 0;
            q[9] = 0;
            q[10] = 0;
            q[11] = 0;
            q[12] = 0;
            q[13] = 0;
            q[14] = 0;
        }
        if (P) {
            double *const p = P + i * MODES;
            p[0] = d12_1*sin12 + d14_1*sin14 + d15_1*sin15 + d18_1*sin18 + d19_1*sin19 + d2_1*sin2 + d4_1*sin4 +
                d5_1*sin5 + d8_1*sin8 + d9_1*sin9;
            p[1] = d10_2*sin10 + d11_2*sin11 + d16_2*sin16 + d17_2*sin17 + d1_2*sin1 + d20_2*sin20 + d3_2*sin3 +
                d6_2*sin6 + d7_2*sin7;
            p[2] = d12_3*sin12 + d14_3*sin14 + d15_3*sin15 + d18_3*sin18 + d19_3*sin19 + d2_3*sin2 + d4_3*sin4 +
                d5_3*sin5 + d8_3*sin8 + d9_3*sin9;
            p[3] = d10_4*sin10 + d11_4*sin11 + d13_4*sin13 + d16_4*sin16 + d17_4*sin17 + d1_4*sin1 + d20_4*sin20 +
                d3_4*sin3 + d6_4*sin6;
            p[4] = d14_5*sin14 + d15_5*sin15 + d18_5*sin18 + d19_5*sin19 + d2_5*sin2 + d4_5*sin4 + d5_5*sin5 + d8_5*
                sin8 + d9_5*sin9;
            p[5] = d16_6*sin16 + d17_6*sin17 + d1_6*sin1 + d3_6*sin3 + d6_6*sin6 + d7_6*sin7;
            p[6] = d14_7*sin14 + d15_7*sin15 + d4_7*sin4 + d5_7*sin5;
            p[7] = d13_8*sin13 + d3_8*sin3;
            p[8] = 0;
            p[9] = 0;
            p[10] = 0;
            p[11] = 0;
            p[12] = 0;
            p[13] = 0;
            p[14] = 0;
        }
    }
    return 0;
}

int two_torus_series_positions(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q)
{
    return two_torus_series_orbit(count, t, amplitudes, phases, frequencies, Q, NULL);
}

int two_torus_series_momenta(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *P)
{
    return two_torus_series_orbit(count, t, amplitudes, phases, frequencies, NULL, P);
}

#ifdef two_torus_series_SELF_TEST
#include <stdio.h>

static const double test_times[4] = {
0,2.75,-13.0625,160.5
};
static const double test_amplitudes[2] = {
0.182861328125,0.06884765625
};
static const double test_phases[2] = {
0.5,0.125
};
static const double test_frequencies[2] = {
0.1972370147705078,0.3924131393432617
};
static const double test_positions[4][15] = {
{0.14756933146808632,0.07320359857917257,0.0032371865341353006,0.0007099071145282463,4.087248729871165e-05,
6.6974629388337556e-06,4.883248016341078e-07,4.04833514934644e-08,0,0,0,0,0,0,0},{0.07846192519682088,
0.020117360126198514,-0.0034758632725270665,-0.0008343810268248418,-7.49647189093679e-05,-7.3905944562408346e-06,
-3.5705977692847776e-08,8.438529920267048e-09,0,0,0,0,0,0,0},{-0.07498274623781943,0.0146644712907736,
0.003765805257268794,-0.0008856115080729567,6.613252920376465e-05,-5.161480036256058e-06,-2.2772925003915494e-07,
2.765514360190719e-08,0,0,0,0,0,0,0},{0.12257154512285746,0.06700043393993033,0.0016425690802491647,
0.00043233578849052233,-6.569065957243631e-06,3.590819079522843e-07,-1.1528901354948065e-07,1.5529201196980878e-08,
0,0,0,0,0,0,0}
};
static const double test_momenta[4][15] = {
{-0.018293958133367805,-0.006405229666236184,-0.0018941334653236957,-0.0003617395078126652,-6.922903111402821e-05,
-9.861449653670686e-06,-1.0208118122642846e-06,-4.423247890361152e-08,0,0,0,0,0,0,0},{-0.030719217768438785,
-0.02837244310029081,-0.0018674191469785098,-0.0002850031093426471,4.5444713955013254e-05,1.142348194110401e-05,
1.4169722236341332e-06,1.0000197985706274e-07,0,0,0,0,0,0,0},{0.030976134246780824,-0.028968375116062574,
0.0016645665444151502,-0.0001917626734269054,-5.717063060217741e-05,1.3079815310952006e-05,-1.385218926174085e-06,
9.145358015518136e-08,0,0,0,0,0,0,0},{-0.0255669671635807,-0.010942105830984037,-0.002538167515238409,
-0.000507814422844626,-8.040096959357961e-05,-1.216894106854717e-05,-1.3198021611507606e-06,-8.18602583302943e-08,0,
0,0,0,0,0,0}
};
static const double test_corrected[2] = {
0.19605390888520602,0.39018427787984444
};
static const double test_jacobian[2][2] = {
{0.00022380400734081573,-1.6452492579182644e-05},{-2.432259159760542e-05,0.00016550627415271873}
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
    double Q[4 * MODES], P[4 * MODES], omega[SEEDS], jacobian[SEEDS * SEEDS], found[4];
    int bad, i;
    bad = two_torus_series_orbit(4, test_times,
        test_amplitudes, test_phases, test_frequencies, Q, P);
    two_torus_series_corrected_frequencies(test_amplitudes, omega, jacobian);
    found[0] = deviation(4 * MODES, Q, &test_positions[0][0]);
    found[1] = deviation(4 * MODES, P, &test_momenta[0][0]);
    found[2] = deviation(SEEDS, omega, test_corrected);
    found[3] = deviation(SEEDS * SEEDS, jacobian, &test_jacobian[0][0]);
    for (i = 0; i < 4; i++)
        bad += !(found[i] <= 1e-13);
    printf("largest deviation: %.2g of the largest coordinate, %.2g of the largest momentum, %.2g of the corrected\n"
           "frequencies, %.2g of their Jacobian; %s %g\n",
           found[0], found[1], found[2], found[3], bad ? "ABOVE" : "at most", 1e-13);
    return bad ? 1 : 0;
}
#endif
