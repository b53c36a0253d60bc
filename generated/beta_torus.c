/* Machine-written: a quasi-periodic solution of an FPU chain,
 *
 *     Q_q(t) = sum over nu of c_q[nu] cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1.
 *
 *  written by: symfpu 0.1.0
 *  made by: symfpu export beta_torus.symfpu --lang c -o beta_torus
 *  orders: frequencies 4, coordinates 4
 *  amplitudes: A_2 = 1.0698561286266385574614614919, A_3 = 0.475072727565501947642675048312
 *  chain: Chain(N=16, beta=0.6)
 *  seeds: 2, 3
 *  frequencies: 0.3925, 0.5845
 *  precision: 30 digits
 *  hash of the coefficients: 816ffccbf87cd120a22414d1e438a6fc46961271b76e7510d561bae48db510b3
 *
 * How to call. Declare in your program what you use of
 *
 *     void beta_torus_positions(size_t count, const double *t, const double *phases, double *Q);
 *     void beta_torus_momenta(size_t count, const double *t, const double *phases, double *P);
 *     void beta_torus_orbit(size_t count, const double *t, const double *phases, double *Q, double *P);
 *     void beta_torus_harmonic_energies(size_t count, const double *t, const double *phases, double *E);
 *     void beta_torus_energy(size_t count, const double *t, const double *phases, double *H);
 *
 * and compile and link this file: cc -std=c99 -O2 -c FILE.c, with -lm at the end of the link.
 * C++ declares the functions extern "C".
 *   t       count times, any real numbers
 *   phases  2 angles phi in radians, one a seed in the order above, or NULL for (0.0, 0.0)
 *   Q, P, E count x (N-1) = count x 15, row-major: mode q at the i-th time is [i * 15 + q - 1]
 *   H       count
 * All quantities are dimensionless. E_q = (P_q^2 + Omega_q^2 Q_q^2) / 2 is the energy of mode q, H the total energy.
 * Nothing is allocated and nothing shared is written: the functions may be called from several threads. They use about
 * 26880 bytes of stack. A time that is not finite gives NaN.
 *
 * Accuracy: omega t is reduced to one turn in two doubles, so nu.(omega t) keeps its digits up to t of 1e15; the sums
 * are those of doubles, some 1e-15 of the largest coordinate. Phases are as good as their own last digit. Compile
 * without -ffast-math.
 *
 * Self-test: cc -std=c99 -O2 -Dbeta_torus_SELF_TEST FILE.c -lm && ./a.out
 * prints the largest deviation from embedded vectors and fails above 1e-13.
 */

#include <math.h>
#include <stddef.h>

void beta_torus_positions(size_t count, const double *t, const double *phases, double *Q);
void beta_torus_momenta(size_t count, const double *t, const double *phases, double *P);
void beta_torus_orbit(size_t count, const double *t, const double *phases, double *Q, double *P);
void beta_torus_harmonic_energies(size_t count, const double *t, const double *phases, double *E);
void beta_torus_energy(size_t count, const double *t, const double *phases, double *H);

enum { BONDS = 16, MODES = 15, SEEDS = 2, ROWS = 16, POWERS = 38, TIMES = 16, CHUNK = 32 };

/* Turns per time omega / (2 pi) of every seed, as sums of two doubles. */
static const double turns[2] = {
0.06246831516356892,0.09302606423721282
};
static const double turns_low[2] = {
5.095628619569908e-19,-6.024339816229183e-19
};
static const double default_phases[2] = {
0,0
};
static const int highest[2] = {
9,9
};
static const int zeroth[2] = {
9,28
};

/* Row of every mode among the sums; the last row is zero. */
static const int row[15] = {
8,0,9,1,10,2,11,3,12,4,13,5,14,6,15
};

/* Linear frequencies Omega_q, cos(k pi / 2N), sqrt(2/N), and the couplings alpha/3 and beta/4. */
static const double linear[15] = {
0.1960342806591212,0.39018064403225655,0.5805693545089248,0.7653668647301796,0.9427934736519953,1.1111404660392044,
1.268786568327291,1.4142135623730951,1.546020906725474,1.6629392246050905,1.76384252869671,1.8477590650225735,
1.9138806714644176,1.9615705608064609,1.9903694533443939
};
static const double cosines[64] = {
1.0,0.9951847266721969,0.9807852804032304,0.9569403357322088,0.9238795325112867,0.881921264348355,
0.8314696123025452,0.773010453362737,0.7071067811865476,0.6343932841636455,0.5555702330196022,0.47139673682599764,
0.3826834323650898,0.2902846772544624,0.19509032201612828,0.0980171403295606,0,-0.0980171403295606,
-0.19509032201612828,-0.2902846772544624,-0.3826834323650898,-0.47139673682599764,-0.5555702330196022,
-0.6343932841636455,-0.7071067811865476,-0.773010453362737,-0.8314696123025452,-0.881921264348355,
-0.9238795325112867,-0.9569403357322088,-0.9807852804032304,-0.9951847266721969,-1.0,-0.9951847266721969,
-0.9807852804032304,-0.9569403357322088,-0.9238795325112867,-0.881921264348355,-0.8314696123025452,
-0.773010453362737,-0.7071067811865476,-0.6343932841636455,-0.5555702330196022,-0.47139673682599764,
-0.3826834323650898,-0.2902846772544624,-0.19509032201612828,-0.0980171403295606,0,0.0980171403295606,
0.19509032201612828,0.2902846772544624,0.3826834323650898,0.47139673682599764,0.5555702330196022,0.6343932841636455,
0.7071067811865476,0.773010453362737,0.8314696123025452,0.881921264348355,0.9238795325112867,0.9569403357322088,
0.9807852804032304,0.9951847266721969
};
static const double norm = 0.3535533905932738;
static const double cubic = 0.0;
static const double quartic = 0.15;

/* Modes 2, 4, 6, ...: harmonics nu, rates nu.omega, and coefficients of cos(nu.theta) in every mode. */
static const short harmonics_0[25][2] = {
{1,-8},{1,-6},{1,-4},{1,-2},{1,0},{1,2},{1,4},{1,6},{1,8},{3,-6},{3,-4},{3,-2},{3,0},{3,2},{3,4},{3,6},{5,-4},{5,
-2},{5,0},{5,2},{5,4},{7,-2},{7,0},{7,2},{9,0}
};
static const double rates_0[25] = {
-4.2835,-3.1145,-1.9455,-0.7765,0.3925,1.5615,2.7305,3.8995,5.0685,-2.3295,-1.1605,0.0085,1.1775,2.3465,3.5155,
4.6845,-0.3755,0.7935,1.9625,3.1315,4.3005,1.5785,2.7475,3.9165,3.5325
};
static const double coefficients_0[25][8] = {
{2.8302238645434437e-12,1.1991668604142802e-11,5.6444404461950915e-12,-7.191867219761109e-13,4.187075353260169e-12,
1.811618401882488e-11,-4.918255811024869e-12},{4.980840942274048e-09,1.2951097495414267e-08,7.2322343550657104e-09,
1.1610164570607939e-08,8.442189593040542e-08,2.704254236287319e-08,-3.4197772396439364e-08},{4.083386143622958e-06,
1.7333352233706366e-05,4.856237181096689e-06,2.4639349753312074e-07,7.323427680331526e-05,8.575621319606264e-07,
-3.100505186200855e-05},{0.0008748527521014925,0.04149818785445686,-0.00011861667746938282,-0.0005811466553832342,
-4.946767675924288e-05,5.178185817926572e-06,2.5469846799117657e-06},{1.0698561286266386,-0.001759396198140792,
-0.0011302707527465479,-0.0006640074162311713,-1.8075401463140064e-05,4.5825068681227415e-06,1.759103549344113e-06},
{0.00015616360920068525,0.0002490905506518396,1.1175331351266614e-05,0.0018266030733849541,3.7831231156514445e-06,
-3.394841172937906e-05,-7.654207535519238e-06},{2.2243671074463058e-07,3.579435063455107e-07,3.3157545244089587e-07,
2.2640280525846628e-06,1.2973564161846178e-06,-8.16697266792394e-08,3.6579309583370264e-06},{5.113057553662059e-10,
8.807089238284664e-10,5.675696915547771e-10,2.2495417084788124e-09,1.5488683711949387e-09,-3.231935545945086e-09,
6.4282981662010615e-09},{4.480187735897143e-13,7.085210087500059e-13,-1.0451545212671757e-12,1.9643074259425673e-12,
7.738860862355865e-13,-3.5994500394333412e-12,3.2115676974471955e-12},{1.0652430162815639e-08,
3.3131678898079446e-08,8.707619602627386e-08,-6.202091782998592e-09,-5.911973641311906e-09,2.4977450565549606e-07,
3.493460351787117e-09},{2.960595564387645e-06,5.8498001966132635e-06,0.00013940059923382798,-6.401092995949138e-06,
-1.0813325258725579e-05,2.4823283750471288e-08,6.453737794181994e-07},{-0.0001702384139898851,
-0.0002802947943986869,-7.920176752797836e-05,-4.318163271063003e-05,-2.7375293512313928e-06,2.4714793406078357e-07,
1.8144344200920993e-07},{0.00035341054605683464,5.9845569878516725e-05,0.0035007303841861183,
-3.0913799184634456e-06,-2.124536285895287e-05,-1.6233227225191674e-05,-8.960854626738402e-07},
{1.320552447632199e-06,1.5405869286538477e-06,6.319869530348747e-06,1.2251366108941273e-05,3.1582563150254525e-07,
2.4059441743512017e-05,-1.8325497266862355e-07},{6.813313437661335e-09,1.0959017741270891e-08,
1.3046509965900474e-08,2.5744089291530857e-08,1.4686865738447244e-08,6.18640256097962e-08,-1.4844575053507146e-08},
{1.5458661199630528e-11,2.292042842946128e-11,2.817362045262367e-11,8.331194149731643e-13,3.2389518918416615e-11,
9.743142067955855e-12,-4.755709506453521e-11},{-9.340230199554065e-06,-3.318390116304304e-07,-3.850686195200686e-07,
-9.718901048525326e-08,-3.1983260303335005e-08,-6.027835193931115e-09,-1.315805019684188e-09},
{3.431480537216844e-06,9.02660273664372e-05,-1.9691888321354624e-06,-9.567824783547923e-07,-2.0170851071442853e-06,
-4.2468552446968934e-07,-7.311402393646674e-08},{1.1749247245010143e-06,1.0583485329712518e-06,
9.605214577381939e-06,1.2573168014227335e-06,2.1500255999588858e-05,-1.636589308329886e-06,0.00024058804365274802},
{1.962195442823033e-08,2.800687229750416e-08,4.42927643390508e-08,6.254841383943915e-08,9.591353151412356e-08,
2.0363586926848677e-07,3.590858183219837e-08},{1.0383243917847236e-10,1.5699675405368226e-10,2.6636237562889883e-10,
4.124878627329909e-10,-3.3807667121297066e-10,6.235725165881385e-10,-4.895623941996867e-10},{1.5790006420700413e-08,
1.1815684252480749e-07,5.53266105891842e-08,5.988266071391369e-07,2.245797265453711e-07,5.3276134758937136e-08,
-2.3931825213310692e-08},{1.0012140871614876e-08,7.428246465513957e-09,2.0965182568491855e-08,1.209544764356208e-08,
1.3177227950799216e-07,-5.907577756299058e-09,1.6493991437518551e-07},{1.5203296947858315e-10,
2.0197494248960037e-10,4.509575490293856e-10,5.263761043519167e-10,5.183144816162941e-10,-2.9701788456276883e-10,
5.417565862171922e-10},{3.470148020894801e-11,0,1.213740287854052e-10,0,1.689840434121323e-10,0,
1.3369274288429567e-10}
};

/* Modes 1, 3, 5, ...: harmonics nu, rates nu.omega, and coefficients of cos(nu.theta) in every mode. */
static const short harmonics_1[25][2] = {
{0,1},{0,3},{0,5},{0,7},{0,9},{2,-7},{2,-5},{2,-3},{2,-1},{2,1},{2,3},{2,5},{2,7},{4,-5},{4,-3},{4,-1},{4,1},{4,3},
{4,5},{6,-3},{6,-1},{6,1},{6,3},{8,-1},{8,1}
};
static const double rates_1[25] = {
0.5845,1.7535,2.9225,4.0915,5.2605,-3.3065,-2.1375,-0.9685,0.2005,1.3695,2.5385,3.7075,4.8765,-1.3525,-0.1835,
0.9855,2.1545,3.3235,4.4925,0.6015,1.7705,2.9395,4.1085,2.5555,3.7245
};
static const double coefficients_1[25][8] = {
{0.0009953635181760812,0.47507272756550195,-0.00023856921361186772,-0.0013375729998029555,-0.0002811562393769177,
2.588002756212151e-06,5.233747046496365e-06,7.777584924432812e-07},{6.5149803912517255e-06,8.481492852437997e-05,
4.741095673391732e-05,3.057120805255016e-06,0.00048406088616783656,2.0847935488983406e-07,-2.1565722933876097e-05,
-2.910085780405204e-06},{1.4482686430012026e-08,8.055249067706336e-08,6.539953356486206e-08,1.1059249898776605e-07,
5.55348108063357e-07,1.7970442075056825e-07,-5.197323022888742e-09,6.773398875033675e-07},{1.7496609805124955e-11,
1.1678620304231895e-10,9.518819951093406e-11,1.2928179755723584e-10,3.228331576572243e-10,-3.292605520369455e-10,
1.9929856646126717e-10,7.379654536412667e-10},{0,6.453728759560904e-14,-4.333165264508764e-14,0,
1.697442953620819e-13,-1.9408980458885258e-13,0,2.2042122454919518e-13},{1.0127392313002968e-10,
4.225496521527254e-10,8.54366383818074e-10,2.3540353350946717e-11,1.4620582983927197e-09,5.939898287811301e-09,
-8.332706119415648e-10,-5.605442108340877e-09},{1.1788069711715153e-07,5.967828775481525e-07,1.8723817768151149e-06,
1.9301599477709478e-07,-1.1479069636050233e-07,6.3927420695702e-06,5.865960794365492e-08,-1.3646806531006528e-07},
{3.493117081472463e-05,9.20905713628213e-05,0.002956851896509229,-4.704778060185328e-05,-0.00010577076721201259,
-4.3602370870641405e-06,2.542950555286815e-06,6.669804174611093e-07},{0.12085018845807008,-0.0029584662601610627,
-0.0002854428194644343,-0.0005732411943593463,-5.0466867196192407e-05,-1.0361784114189189e-07,
1.6069324987741608e-06,1.8946141166543047e-07},{7.961726619606619e-05,0.0005201307886881595,3.161382699317015e-05,
0.0037185253449564986,5.266666749510718e-06,-3.682525579700871e-05,-1.3989075360497566e-05,-5.323034479728007e-07},
{2.4859929210365006e-07,1.0001418811028621e-06,7.799548892754158e-07,5.062486258009248e-06,5.337088714488328e-06,
-5.6168487708882135e-08,1.1640080274532302e-05,7.773321833281631e-08},{7.986126043406925e-10,3.734279380632517e-09,
2.991271402613176e-09,6.442533618935761e-09,9.274070572854422e-09,3.746979390117346e-09,4.0711736075900385e-09,
1.3865182157445287e-08},{9.455460597937719e-13,5.515737087920731e-12,2.770762865435438e-12,-1.5689185650118984e-12,
1.3759289892119817e-11,-4.755916625704242e-12,-9.191680695900018e-12,1.2912535558524093e-11},{6.03113674280751e-08,
1.0891348522036124e-07,7.245725950150871e-08,3.2549529230664093e-06,-3.8939385078919517e-07,-5.114533083147251e-07,
3.95976140563538e-08,4.915579377843706e-08},{-0.00046188147979332885,-1.2554047643560782e-05,-1.861844389564753e-05,
-3.843471674355999e-06,-2.0684852673771035e-06,-1.2935229212692226e-07,2.213322347199751e-08,5.098225839451471e-09},
{2.6406750550294628e-05,4.5181734878291805e-05,0.0009144039961961977,-8.825623742604376e-06,-4.961133829543576e-06,
-9.650721736602926e-06,-9.131584113379427e-07,-6.937686542961933e-08},{6.266974227820934e-07,2.025148735608004e-06,
3.9206739262528386e-06,1.5623200615841362e-05,1.0126982167652324e-06,3.0567805968382414e-05,-5.725900461676669e-07,
4.0281366008930695e-07},{5.33190083690273e-09,2.112799349497293e-08,2.1025866241011502e-08,4.419091402756946e-08,
3.401192471426043e-08,1.0013362202225814e-07,1.3524941746305954e-07,-1.5125966558332745e-07},{1.869149133520751e-11,
7.198583407804192e-11,7.255413747562109e-11,1.7310587659540771e-10,-9.262626937440935e-11,1.659507609349946e-10,
1.914030149189337e-11,-2.94437532509943e-10},{2.854122134320058e-08,4.58852251637184e-06,2.2696926374156594e-07,
-8.162460339697948e-08,-1.4426423624091982e-07,-3.6818358754527626e-08,-1.3483893581001808e-08,
-9.286813050023111e-10},{1.3059425346348047e-07,2.4315241659257655e-07,1.9583091929876805e-06,6.32778452131202e-07,
6.519971856222066e-06,-1.625400990682938e-05,-3.421874614899323e-08,-4.507737197656399e-07},{6.588879083381528e-09,
2.4945520311387698e-08,2.3482447207916845e-08,5.212487900429932e-08,8.366056190449163e-08,2.0249176202460143e-07,
6.72475032538973e-09,2.7805725432412127e-07},{6.286478730431726e-11,2.1886626156282077e-10,2.661352918520233e-10,
5.956016360303394e-10,4.5029506365139727e-10,-3.02121922116108e-10,6.877149492263201e-10,-6.930977828492761e-10},
{7.033722251326846e-10,1.700180160020992e-09,3.766067167601426e-09,-3.0949131198498935e-09,1.922778739330407e-08,
-1.688538883523966e-08,2.3435841858592774e-08,-1.5810871398821956e-08},{3.325873953993893e-11,
1.1976860505027806e-10,1.3871897019758222e-10,3.826522850236695e-10,1.487846470631188e-10,5.827927053250652e-10,
-5.666334299111087e-10,1.1611250890171977e-09}
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
    add_block(25, 8, &harmonics_0[0][0], rates_0,
              &coefficients_0[0][0], powers, q + 0 * TIMES, p ? p + 0 * TIMES : NULL);
    add_block(25, 8, &harmonics_1[0][0], rates_1,
              &coefficients_1[0][0], powers, q + 8 * TIMES, p ? p + 8 * TIMES : NULL);
}

void beta_torus_orbit(size_t count, const double *t, const double *phases, double *Q, double *P)
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

void beta_torus_positions(size_t count, const double *t, const double *phases, double *Q)
{
    beta_torus_orbit(count, t, phases, Q, NULL);
}

void beta_torus_momenta(size_t count, const double *t, const double *phases, double *P)
{
    beta_torus_orbit(count, t, phases, NULL, P);
}

void beta_torus_harmonic_energies(size_t count, const double *t, const double *phases, double *E)
{
    double Q[TIMES * MODES], P[TIMES * MODES];
    size_t start, i;
    for (start = 0; start < count; start += TIMES) {
        const size_t size = count - start < TIMES ? count - start : TIMES;
        beta_torus_orbit(size, t + start, phases, Q, P);
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

void beta_torus_energy(size_t count, const double *t, const double *phases, double *H)
{
    double Q[TIMES * MODES], P[TIMES * MODES];
    size_t start, i;
    for (start = 0; start < count; start += TIMES) {
        const size_t size = count - start < TIMES ? count - start : TIMES;
        beta_torus_orbit(size, t + start, phases, Q, P);
        for (i = 0; i < size; i++)
            H[start + i] = total_energy(Q + i * MODES, P + i * MODES);
    }
}

#ifdef beta_torus_SELF_TEST
#include <stdio.h>

static const double test_times[3] = {
0,5.921875,661.140625
};
static const double test_positions[3][15] = {
{0.12153238142864169,1.071074238957232,0.4728526209590643,0.039883719111257494,0.003416599040645137,
0.002342205134851312,0.0017759477637466152,0.0005444478422317647,5.782919776596873e-05,-3.7101283261972815e-06,
-2.7695360961871712e-05,-1.679413919104885e-05,-1.5780367652721243e-05,0.00020970378310515578,
-1.1334243074999728e-06},{0.04408417268585588,-0.7321613842742701,-0.4521704778899922,-0.00398471988516082,
0.003428332014773975,0.0035225158335643937,7.284811220165109e-05,-0.0013268968035132513,-0.00013321656793747815,
3.427919458371313e-05,3.8812825138250485e-05,2.2974720070171557e-05,3.4174769215455755e-06,0.0001280714411193124,
2.0065313446092123e-06},{0.09817826378200359,-0.3329144074489002,-0.4769966102868333,-0.011058289552538937,
0.0021855615641016616,0.0032657874724035013,0.0037802268244002874,-0.0003075362069777145,-0.00032447927153819137,
-4.6365195971256456e-05,-3.092465408708311e-05,1.8171195582402622e-05,1.806480042360915e-05,-0.00023349353789375464,
1.6474725053028719e-06}
};
static const double test_momenta[3][15] = {
{0,0,0,0,0,0,0,0,0,0,0,0,0,0,0},{-0.02228060806925355,-0.3058580142042001,0.08733075637341797,0.0324997507786882,
0.0019196639683479264,-0.0024763859675428846,-0.005105683886145811,-0.0007796961391469021,0.0005940181852116886,
0.0001459103244427382,5.990581733835577e-06,-3.275760634764902e-05,-2.958769164804685e-05,0.0003393514239772625,
-8.882339656958589e-07},{-0.013847413747081533,-0.3984140660571915,0.005784458493870334,0.03137391580922297,
0.002416792351640725,0.0026293577880176252,-0.003058552747238747,-0.002845568868191084,-2.5728804152690148e-05,
9.393558126942361e-05,0.00011753586460495745,7.322348828892282e-05,-9.950259365740138e-06,-5.21298066790258e-05,
5.418317693728114e-07}
};
static const double test_energies[3] = {
0.1271824483018574,0.12717340170807748,0.127170966335134
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
    beta_torus_orbit(3, test_times, NULL, Q, P);
    beta_torus_energy(3, test_times, NULL, H);
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
