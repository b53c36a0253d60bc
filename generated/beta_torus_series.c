/* Machine-written: quasi-periodic solutions of an FPU chain as a series with free amplitudes A,
 *
 *     Q_q(t) = sum over nu of c_q[nu](A) cos(nu.theta),   P_q = dQ_q/dt,   q = 1 .. N-1,
 *
 * with angles theta_i = omega_i t + phi_i.
 *
 *  written by: symfpu 0.1.0
 *  made by: symfpu export beta_torus.symfpu --lang c -o beta_torus_series --series --order 3 --frequency-order 4
 *  chain: Chain(N=16, beta=0.6)
 *  seeds: 2, 3
 *  frequencies of the divisors: 0.3925, 0.5845
 *  orders: frequencies 4, coordinates 3
 *  precision: 30 digits
 *  hash of the series: 5e6359b305a6978828c49c95d096b2ffc089f1aff62c088fc538117ba5ae9a9b
 *
 * How to call. Declare in your program what you use of
 *
 *     int beta_torus_series_orbit(size_t count, const double *t,
 *         const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P);
 *     int beta_torus_series_positions(size_t count, const double *t,
 *         const double *amplitudes, const double *phases, const double *frequencies, double *Q);
 *     int beta_torus_series_momenta(size_t count, const double *t,
 *         const double *amplitudes, const double *phases, const double *frequencies, double *P);
 *     void beta_torus_series_corrected_frequencies(const double *amplitudes,
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
 *               of beta_torus_series_orbit either may be NULL
 *   omega       corrected frequencies (2): omega(A), the series of the frequencies at these amplitudes
 *   jacobian    2 x 2, row-major: d omega_i / d A_j is [i * 2 + j]; or NULL
 * The functions with a count return 0, or 1 and do nothing where memory cannot be allocated.
 * All quantities are dimensionless. The series is an expansion in small amplitudes; how far it holds is not checked.
 * Nothing shared is written: the functions may be called from several threads. A call first sums the powers of the
 * amplitudes, into 308 doubles that it allocates and frees, so give it many times at once. It uses about
 * 20880 bytes of stack. A time that is not finite gives NaN.
 *
 * Accuracy: omega t is reduced to one turn in two doubles, so nu.(omega t) keeps its digits up to t of 1e15, if omega
 * is the number meant; the sums are those of doubles, some 1e-15 of the largest coordinate. Compile without
 * -ffast-math.
 *
 * Self-test: cc -std=c99 -O2 -Dbeta_torus_series_SELF_TEST FILE.c -lm && ./a.out
 * prints the largest deviation from embedded vectors and fails above 1e-13.
 */

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

int beta_torus_series_orbit(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P);
int beta_torus_series_positions(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q);
int beta_torus_series_momenta(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *P);
void beta_torus_series_corrected_frequencies(const double *amplitudes,
    double *omega, double *jacobian);

enum { MODES = 15, SEEDS = 2, ROWS = 16, POWERS = 30, TIMES = 16, CHUNK = 32,
       AMPLITUDE_POWERS = 18, MONOMIALS = 20, TERMS = 14, WORK = 308 };

/* Turns per time omega / (2 pi) of every seed, as sums of two doubles. */
static void split_turns(const double *omega, double *turns, double *turns_low)
{
    int i;
    for (i = 0; i < SEEDS; i++) {
        turns[i] = omega[i] * 0.15915494309189535;
        turns_low[i] = fma(omega[i], 0.15915494309189535, -turns[i]) + omega[i] * -9.839338337591243e-18;
    }
}

static const double default_phases[2] = {
0,0
};
static const int highest[2] = {
7,7
};
static const int zeroth[2] = {
7,22
};

/* Row of every mode among the sums; the last row is zero. */
static const int row[15] = {
8,0,9,1,10,2,11,3,12,4,13,5,14,6,15
};

/* Scales of the amplitudes x_i = scale_i A_i, their highest powers, and the powers that are needed together. */
static const double scales[2] = {
0.584466494136728,0.8696570176479649
};
static const int degrees[2] = {
8,8
};
static const int place[2] = {
0,9
};
static const short exponents[20][2] = {
{0,1},{0,3},{0,5},{0,7},{1,0},{1,2},{1,4},{1,6},{2,1},{2,3},{2,5},{3,0},{3,2},{3,4},{4,1},{4,3},{5,0},{5,2},{6,1},
{7,0}
};

/* omega_i(A) = linear_i + sum of coefficients times powers of x^2. */
static const double linear[2] = {
0.39018064403225655,0.5805693545089248
};
static const short frequency_exponents[14][2] = {
{0,1},{1,0},{0,2},{1,1},{2,0},{0,3},{1,2},{2,1},{3,0},{0,4},{1,3},{2,2},{3,1},{4,0}
};
static const double frequency_coefficients[14][2] = {
{0.00489069361059761,0.005457831281548994},{0.003668020207948207,0.007277108375398658},{0.00019490294531185223,
-4.807603280703011e-05},{0.0002389422426901928,0.0006028153491451335},{-1.990274238097673e-05,
0.0001663652704592263},{0.00021635519458816063,2.8808669803948566e-06},{0.000942383684268711,0.0009717416076450349},
{0.00030161466895159026,0.0014012938446772852},{5.168944311824107e-06,0.00014801040355992632},
{0.00017777739467668652,-5.4277456425477874e-08},{0.0013799251042064576,0.0010654693171952487},
{0.0015196976919415563,0.0030857101204708995},{0.00021325938835412765,0.0015009513736843458},{8.8587324503835e-07,
7.841392654177493e-05}
};

/* Modes 2, 4, 6, ...: harmonics nu, the first row of each, powers and coefficients of the rows in every mode. */
static const short harmonics_0[16][2] = {
{1,-6},{1,-4},{1,-2},{1,0},{1,2},{1,4},{1,6},{3,-4},{3,-2},{3,0},{3,2},{3,4},{5,-2},{5,0},{5,2},{7,0}
};
static const int starts_0[17] = {
0,1,4,10,20,26,29,30,31,34,40,43,44,45,48,49,50
};
static const int powers_0[50] = {
7,6,7,13,5,6,7,12,13,17,4,5,6,7,11,12,13,16,17,19,5,6,7,12,13,17,6,7,13,7,13,12,13,17,11,12,13,16,17,19,12,13,17,13,
17,16,17,19,17,19
};
static const double coefficients_0[50][7] = {
{6.979866798947515e-07,1.988311415596763e-06,0,9.119402808640352e-07,1.199790309211563e-05,2.6508093797265297e-06,
-5.9094071495081276e-06},{9.733550388522214e-05,0.00044854899471722065,0,8.089557630571547e-06,0.00155894832727701,
0,-0.0007340155277822909},{8.121947957066062e-05,0.00036466397601587184,0,-5.51569421636937e-06,
0.0012848797389865573,9.824616206398052e-05,0.0009725903550895344},{0.0001537814457261982,0.0006422997371768461,
0.0003482807854381274,9.986184794639793e-06,0.003140440923996439,3.7008227845787046e-05,-0.0018593633958978208},
{0.007273288636438459,0.18654608381001372,0,-0.0042353040047702385,0,0,0},{0.0013902876122248108,
0.15510860445148963,0,0.000224634816101567,-0.0013214121956375286,0,7.982832619360657e-05},{0.0012663789348974952,
0.1317355662832163,0,1.0420833822847853e-05,-0.0010952346938213882,-2.8244124510869606e-06,4.170925342104466e-07},
{0.0006899210181329601,0.20842074805028143,-0.0016598232440025794,-0.0016023099486573633,0,0.00011325298867228622,
0},{0.002505367973257222,0.38472912367454243,-0.0023397089633997474,-0.0013990245059607013,-0.0018070972823867935,
1.0485698444077756e-05,9.064220352124106e-05},{0.00048151585663780075,0.20358636067564256,-0.0009935991264881444,
-0.00200788967645477,2.313976977567924e-05,9.02003955128439e-06,0},{1.7109620654594164,0,0,0,0,0,0},{0,
-0.01483433480165009,0,-0.006410728312203719,0,0,0},{0,-0.0025182137355665964,0,0.000125751261555187,
-0.0004065540397375715,0,8.172957619452413e-05},{0,-0.002537771506669365,0,-3.0131318808683652e-05,
-0.00043920303565512554,2.3258181198232944e-06,-1.1593488645284852e-05},{0,0,-0.004302235031381684,0,0,0,0},{0,
-0.0008405660853608734,-0.0010731130169016163,0.0004987122425962393,0,0.00013189839952537096,0},{0,
-0.005047411758187794,-0.0016660602187841028,-0.00021179010858123892,-0.0007579836917694284,-2.270089868251734e-05,
1.9154708603424645e-05},{0,0,3.538366185795958e-05,0,1.1987987280219369e-05,0,0},{0,-0.0012028923060462828,
-0.0007212383897700012,-3.565727624094263e-05,-4.008770868718185e-06,-4.534307525218833e-05,0},{0,0,
-2.5096019231886437e-05,0,-8.049666512928422e-06,0,-5.335028990731746e-07},{0.001429346385052389,
0.0017285950403937698,0,0.013500254528743181,0,0,0},{2.4059836300734977e-05,-3.9597981818285155e-05,0,
0.0012206190449172221,0.00027824422496047947,0,-0.00025375715034992973},{3.429205821109349e-06,
-8.046674197677835e-06,0,0.00019506388053886568,-4.702737938433818e-05,-1.7340383469462388e-05,
-2.1095293806051198e-05},{5.276726278147977e-05,0.0008519225931923145,0.00015124084991500762,0.0049129054907151625,
0,-0.0006747783132746656,0},{5.697247830701376e-05,0.0006302917645488518,0.0002805472757306545,0.004700258179710831,
0.00019488867093052936,-0.0001381574806680973,-0.0002861891688229227},{9.097233910523794e-06,0.0008945993483898559,
5.328470389458344e-05,0.004113689868580609,-0.0001786133915026552,-0.00018447681601576138,0},{7.901980519003311e-06,
9.757213745236447e-06,0,8.043804519358607e-05,2.45793802942348e-05,0,9.823912925108438e-05},{5.171641271156756e-07,
6.228274627078093e-07,0,6.827680243695332e-06,2.635005181252224e-06,1.5349732142475964e-06,6.491316905253625e-06},
{6.442332504192633e-06,1.4613851302322105e-05,2.6657148195004336e-05,6.773498776024037e-05,6.923995423036765e-05,
-8.665228047413775e-06,0.00015319262954673277},{8.722915534906275e-08,1.3506465472572493e-07,0,
3.8376156576741545e-07,1.9181578442441924e-07,-5.494916708499865e-07,1.0018121380573444e-06},
{0.00018639366119820958,0.00044480029190167,0.009335500452665972,-0.0004307040032705917,-0.0007735994759435497,
1.9237815315294284e-05,4.8035717642893445e-05},{-0.002304793649275954,-0.003627638771363674,-0.0011198168200524435,
-0.0004609839966042593,0,1.097012285050994e-05,0},{-0.0029528193472755115,-0.003807617251187078,
-0.0017197671225275372,-0.0006458391829745498,-0.00017539697114261104,-2.0338131111999427e-06,
1.519357862409607e-05},{-0.0017615660783809528,-0.0034536897458006875,-0.0005576486012350809,-0.000637822680602946,
-8.224217928383846e-06,-1.0239208843934518e-05,0},{0.0013245771332478715,0,0.010203464337468899,0,0,0,0},
{0.0003845504106570438,0.0008146732266347507,0.012345043788984298,1.9843784804640853e-05,0,-0.0003182376980905307,
0},{0.0003695025505165028,0.0009785600591848817,0.011659559837074182,-0.00015040643950960908,
-1.6993949948274666e-05,-0.00021565923253609256,-8.850339411369497e-05},{3.858159811455979e-05,0,
0.001688416704119413,0,-0.0001352546428389541,0,0},{0.000249906051221987,0.0006736850001633668,0.008408222187195238,
-0.00013581692784517927,-0.00029822950835418194,-4.405948615077425e-05,0},{6.588271095336114e-06,0,
0.00034274296456036153,0,-2.3104251754947978e-05,0,2.6946593935245304e-06},{2.784064973289521e-05,
2.5452044034149695e-05,0.00012081304167559436,0.00023863536679885665,0,0.00044910871724671345,0},
{7.496200246151247e-06,1.0128092367129838e-05,8.477279769380189e-05,5.4316766039556386e-05,3.2973040570011656e-05,
0.0002237100766717974,-1.2898126289489346e-05},{3.950358301834779e-06,1.375080705897901e-05,2.0740556274723643e-05,
7.530901189989052e-05,-2.7996446903410324e-06,0.000127761241933239,0},{7.35189672913262e-07,1.0326769379830996e-06,
1.2558060448697919e-06,2.86716950289005e-06,8.937907566201126e-07,6.690426386864721e-06,-1.6915062839355492e-06},
{0.00011653685228407712,0.0029326010668346224,-8.964856679951056e-05,-2.2176851849433402e-05,-7.808618927170913e-05,
-1.413994928354752e-05,0},{8.523813018826834e-06,0,6.171800482247129e-05,0,0.00010879831180291874,0,0},
{1.2304045292088296e-05,4.14494157091973e-05,0.00013549637357123748,4.6473738871194934e-05,0.0003977185652040505,
-4.7353385367356236e-05,0},{1.4153902761280567e-06,0,1.1192441460919682e-05,0,2.2334598526017525e-05,0,
0.0005632559673549528},{9.502022857689556e-07,1.1797621957953177e-06,2.085794572692974e-06,2.6887962499626197e-06,
3.961946399229252e-06,1.0368831695694732e-05,0},{1.5952275814448626e-07,0,3.9363577162875524e-07,0,
1.3955681027660072e-06,0,1.2405463068561448e-06}
};

/* Modes 1, 3, 5, ...: harmonics nu, the first row of each, powers and coefficients of the rows in every mode. */
static const short harmonics_1[16][2] = {
{0,1},{0,3},{0,5},{0,7},{2,-5},{2,-3},{2,-1},{2,1},{2,3},{2,5},{4,-3},{4,-1},{4,1},{4,3},{6,-1},{6,1}
};
static const int starts_1[17] = {
0,10,16,19,20,21,24,30,36,39,40,41,44,47,48,49,50
};
static const int powers_1[50] = {
0,1,2,3,8,9,10,14,15,18,1,2,3,9,10,15,2,3,10,3,10,9,10,15,8,9,10,14,15,18,8,9,10,14,15,18,9,10,15,10,15,14,15,18,14,
15,18,15,18,18
};
static const double coefficients_1[50][8] = {
{0,1.1498786069760638,0,0,0,0,0,0},{0,0,0,0,-0.003157560436735104,0,0,0},{0,0,0,0,9.003413115274546e-05,0,0,
3.368644528215712e-05},{0,0,0,0,-6.580937321148392e-06,6.868356563220691e-07,0,-3.0926285234181836e-06},
{0.005410011379124535,0,0,-0.00837179944366146,0,0,0,0},{0.0009079242592353203,0,-0.002550429389049733,
0.0004001568311743342,-0.0010083886444433097,0,0.00018667118961051483,0},{0.0008973446203084002,0,
-0.00292400980095204,-7.834077790547438e-06,-0.0010785244559127873,-0.0001770836682609037,-2.247443801084666e-05,
3.9427606614753255e-05},{0.0006457658323512312,0,-0.0007977782828423099,0.0001693775998696097,0,
7.706881619740112e-05,0,0},{0.0021074863646413857,0,-0.0045532082258904465,-0.0002770543729719465,
-0.0014459704863846565,2.580731581364804e-06,-4.661656790214277e-06,9.768788136971393e-06},{0.00038843931849321116,
0,-0.0004958696944645766,-5.691696931409394e-05,1.9866940612670614e-06,-1.693779622044248e-05,0,
-2.4893478344818403e-06},{0,0.0008887424637014205,0,0,0.003149558818049213,0,0,0},{0,8.526647698611387e-06,0,0,
0.00015209074967819606,0,0,-6.831860921770245e-05},{0,5.751947868066146e-07,0,0,1.5168883447452334e-05,
-8.667658853761808e-05,0,-2.188682701458237e-06},{0.00011633928504664656,0.000436641675990056,0.0008082171436306321,
7.51505133205173e-05,0.00472559270430846,0,-0.0005163875675954658,0},{9.823666597936748e-05,0.00032693810109337334,
0.0006335474219874454,3.728714760900149e-05,0.0038553920817855736,0.0018579230361394819,-9.341254772110104e-05,
-0.00016904563513303047},{0.00014918949094418834,0.0004508981344135604,0.0011774044278056023,4.1237652076196924e-05,
0.0058817151530472156,-0.0015528887860535607,-0.00037662386475206165,-6.831055192262742e-05},{0,
2.847705513285098e-06,0,0,1.6153738549459205e-05,0,0,1.3263604350547352e-05},{0,1.0414110587947528e-07,0,0,
7.807133733962935e-07,2.420151321711951e-07,0,2.261062819801562e-07},{1.493840932524506e-06,5.585831770639417e-06,
6.574975976493299e-06,1.1441135030017723e-05,4.3440450930662836e-05,1.784393237378454e-05,-1.5131982115783428e-06,
5.616706899653524e-05},{0,2.4337872051934457e-08,0,0,6.309979658872427e-08,-5.021834306179765e-08,0,
1.179349301255772e-07},{1.1417748062893117e-05,5.6103248468157786e-05,0.00020211509540133811,-2.807342050886771e-06,
-1.3634916516364294e-05,0.0006246714248362427,4.716602079885391e-06,-2.405097531217726e-05},{0.0006406077673136705,
0.001573458856569919,0.045845317410093914,-0.000904599687926032,-0.0018278751501550662,0,5.0185136063225175e-05,0},
{0.0006716564928490624,0.0017247972891764728,0.06277318447343495,-0.0008894192092993597,-0.0014578242975025306,
-0.0005475275753914304,1.009427446187154e-05,7.228641447055683e-05},{0.0007147848318079309,0.0020383744279328115,
0.0673526805958048,-0.0008940269612620331,-0.0025760805610050147,3.9466171348902384e-05,5.87614160402291e-05,
2.8473126515878782e-06},{0.4631702976827162,-0.016116252520412377,0,-0.003382011945903908,0,0,0,0},
{0.4500343854291488,-0.0026740125751768965,-0.003060979486600142,-0.0009664933063921881,-0.0008497570216632526,0,
6.034866306011516e-05,0},{0.44088311832364774,-0.002661045805790524,-0.00329812061866441,-0.0009472504102443814,
-0.0009195589193968935,-8.454843504000882e-05,-5.751743875442107e-06,2.015594271328636e-05},{0.25028488482767186,
-0.001997900218131126,-0.0013630205880446427,0.00021770631546660915,0,2.1921799442847762e-05,0,0},{0.60713197874246,
-0.0057281647742176535,-0.003979515545515355,-0.0005168568783511007,-0.001192394552498642,-7.733256469685714e-06,
-1.4006771378400253e-05,3.9148325088557396e-06},{0.14142834125740547,-0.0011898418460394241,-0.0007532053926835357,
-4.904978599968892e-06,-5.1072277330130025e-06,-1.9112803728044726e-05,0,-8.998370575933411e-07},
{0.00044645724586459397,0.0031671652854853394,0,0.01997837004852909,0,0,0,0},{0.00014004222864397528,
-4.8229496373475616e-05,0.00039541706089236484,0.006133437003613427,0.00029090471597244537,0,-0.0004132165264094225,
0},{0.0001287903708169865,-5.95199870126757e-06,0.0004814881498143094,0.0039057113550134436,-0.00010029957492554982,
-3.983045213221539e-06,-0.00012004140564839629,-5.094612588283795e-05},{1.3573619908172651e-05,
0.00010289600255685413,8.5933851642821e-05,0.002932019130007617,0,-0.0004758529251763336,0,0},
{0.00011169689734870887,0.00013947037756880754,0.0006366711826372068,0.005512678972821207,-9.823164474131066e-05,
-0.0003090048592193651,-0.0001221013248870991,-5.070300916755103e-05},{1.683622152980671e-06,2.3186012663611328e-05,
3.1787612548011025e-05,0.0006447956088451786,-3.780231399303351e-05,-7.144829907659624e-05,0,
1.5245923579409232e-05},{5.7158005971684595e-06,2.9579959760162796e-05,8.086722764136753e-06,0.00014902875149399057,
0.00012526328637954762,0,0.0002950197243677654,0},{1.4935220783225336e-06,2.1884172689909303e-06,
3.5302772341762126e-06,3.476847496436016e-05,1.2523860002675868e-05,7.815694867981513e-06,6.173147380672512e-05,
-1.9122031608327445e-06},{4.566356057777404e-06,1.0426833516924296e-05,2.8941203784045678e-05,
4.7000094645667555e-05,0.00010615581734161036,-7.152725239763975e-06,0.00017967382489409673,1.1721946815361116e-05},
{8.879836396055359e-08,5.43462085912931e-07,2.4092454851090655e-07,9.28304172249559e-07,1.175935796204984e-06,
1.4445815540775276e-07,9.65157577083743e-07,1.4201938393787567e-06},{-0.023063950277129572,-0.0006015194781860019,
-0.0009456797142795032,-0.0001655501800134619,-9.430664270659937e-05,-3.0539508703822035e-06,1.4721752466610398e-06,
1.1308797965693078e-07},{0.00025808616289760327,0.0004037525268715705,0.008141669712635385,-7.184508968299486e-05,0,
-9.496703785635733e-05,0,0},{0.0002993635788049711,0.0006043995737528794,0.011453755678213953,-0.000170829605926407,
-3.653669555756787e-05,-0.0002132644281363984,-4.959652401155428e-05,-8.581002488196918e-06},
{0.00015182059908937475,0.00027829796116282175,0.0059460328189251035,-5.8450833425849903e-05,
-0.00010676890751338492,-1.3653860349815632e-05,0,4.137165084787386e-06},{6.86492697103418e-06,
2.638286569840342e-05,3.583696133473631e-05,0.0001999549671095648,0,0.0003468067813127862,0,0},
{9.867370649748856e-06,1.531386887535959e-05,9.25440908088544e-05,0.00013007307624778166,5.692896078008398e-05,
0.00042538575012397234,-3.666457050532383e-05,-1.148084646102274e-05},{1.1604171725472173e-06,3.643684976241e-06,
6.568459991276992e-06,3.401587221063637e-05,-2.7551304180057174e-07,6.489139020568414e-05,0,4.967248619011219e-06},
{3.6245521760635186e-07,1.5707754532595737e-06,1.2934353232417763e-06,3.471696979122892e-06,2.1998631429237163e-06,
7.071758761104191e-06,9.67323570306563e-06,-1.0674782724165068e-05},{3.1650377382805764e-06,5.042397615703901e-06,
4.9530247938499445e-05,1.4521915393231646e-05,0.00014725127520194488,-0.00017843477844738573,0,
-3.6376389003077184e-06},{1.62831752812008e-07,6.988126580342836e-07,4.962463558345477e-07,1.6319641088662708e-06,
9.163810703332781e-07,5.910229012242176e-06,0,5.4040257582759836e-06}
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
static void evaluate(const double *turns, const double *turns_low, const double *work,
                     size_t count, const double *t, const double *phases, double *q, double *p)
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
    add_block(16, 8, &harmonics_0[0][0], work + 0, work + 16, powers,
              q + 0 * TIMES, p ? p + 0 * TIMES : NULL);
    add_block(16, 8, &harmonics_1[0][0], work + 144, work + 160, powers,
              q + 8 * TIMES, p ? p + 8 * TIMES : NULL);
}

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
    collapse_block(16, 7, 8, &harmonics_0[0][0], starts_0, powers_0,
                   &coefficients_0[0][0], monomials, omega, work + 0);
    collapse_block(16, 8, 8, &harmonics_1[0][0], starts_1, powers_1,
                   &coefficients_1[0][0], monomials, omega, work + 144);
}

void beta_torus_series_corrected_frequencies(const double *amplitudes,
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
    double q[(ROWS + 1) * TIMES], p[(ROWS + 1) * TIMES];
    size_t start, j;
    int m;
    for (start = 0; start < count; start += TIMES) {
        const size_t size = count - start < TIMES ? count - start : TIMES;
        evaluate(turns, turns_low, work, size, t + start, phases ? phases : default_phases, q, P ? p : NULL);
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

int beta_torus_series_orbit(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q, double *P)
{
    double corrected[SEEDS], turns[SEEDS], turns_low[SEEDS], *work = malloc(WORK * sizeof(double));
    if (!work)
        return 1;
    if (!frequencies) {
        beta_torus_series_corrected_frequencies(amplitudes, corrected, NULL);
        frequencies = corrected;
    }
    split_turns(frequencies, turns, turns_low);
    collapse(amplitudes, frequencies, work);
    trajectories(turns, turns_low, work, count, t, phases, Q, P);
    free(work);
    return 0;
}

int beta_torus_series_positions(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *Q)
{
    return beta_torus_series_orbit(count, t, amplitudes, phases, frequencies, Q, NULL);
}

int beta_torus_series_momenta(size_t count, const double *t,
    const double *amplitudes, const double *phases, const double *frequencies, double *P)
{
    return beta_torus_series_orbit(count, t, amplitudes, phases, frequencies, NULL, P);
}

#ifdef beta_torus_series_SELF_TEST
#include <stdio.h>

static const double test_times[4] = {
0,2.75,-13.0625,160.5
};
static const double test_amplitudes[2] = {
0.25439453125,0.128173828125
};
static const double test_phases[2] = {
0.5,0.125
};
static const double test_frequencies[2] = {
0.3934764862060547,0.5864534378051758
};
static const double test_positions[4][15] = {
{0.0007634460509301834,0.22326749815351632,0.127152748999394,0.0003242039604266192,8.51768599929871e-07,
-1.0109821515804954e-05,-4.446886441023421e-06,3.9853674154002814e-07,-2.2847023570915476e-07,
-3.3315744413955284e-09,-1.5097513122259932e-08,-1.518461241584868e-08,-1.05700451672185e-08,
-1.7868602987400648e-08,-3.9027925066734196e-10},{0.00016628466202986707,-0.00286870793615945,-0.021303135907921978,
-0.00011186697010533983,-7.22823445856218e-07,1.3202000635814112e-06,1.1571897627134912e-05,1.1141722161569662e-05,
2.9220897638965134e-06,3.4305503205903724e-08,-8.803000232273546e-09,-1.7891119465396978e-08,
-1.6121526797295257e-08,-1.4856488827488497e-08,-9.330090193827453e-10},{-0.0001978614100803048,
-0.018458017631426824,0.04013098143027455,-0.0001869322023803936,1.043042144984591e-06,8.427805474406224e-06,
-2.7199464852087692e-05,2.145856676678359e-05,-5.102621929977346e-06,5.1412484362892294e-08,2.3583901257029196e-08,
-3.758112917524491e-08,2.9632634155460427e-08,-2.3982774026566005e-08,1.5385167950856827e-09},
{-6.667654942845726e-05,0.1733520813722706,0.12817661958990903,0.0002284437078257197,-6.373358380940141e-07,
-3.6297815465842816e-05,-2.3728460466034857e-05,3.5893106712144513e-06,1.1583660058142818e-07,
6.5450055259343656e-09,-8.191293205386868e-09,-1.6591390803068574e-08,-1.0358321429495342e-08,
-1.2495161707813481e-08,-4.291273342866579e-10}
};
static const double test_momenta[4][15] = {
{-0.00018233812549022627,-0.047995036479096934,-0.009375882855269626,7.056114102761198e-05,3.9937415396430295e-07,
-3.760242864421288e-05,-5.86981628070412e-05,-2.6198914592678795e-05,-2.637504763303559e-06,-1.0718197042001297e-08,
2.0611793193421416e-09,2.097893572320556e-09,3.551831896110832e-09,3.294681711866335e-11,4.114557601038758e-10},
{-0.00023830564587465366,-0.10009283945281024,-0.07410250628304202,-0.0002483481288887493,-6.566920077731828e-07,
4.5941847581354466e-05,8.044759304201435e-05,4.756482321643334e-05,9.572049195995568e-06,6.526799131171247e-08,
-8.352179809453371e-08,-1.0261966674917262e-07,-6.731227652100448e-08,-4.482684582741538e-08,
-2.916905653441316e-09},{0.00023708200690003708,-0.09983527770769532,0.0713703368038318,-0.0002205200276183809,
3.8704773171652755e-07,4.499524397317009e-05,-7.403177809892439e-05,3.973679052344927e-05,-7.089077863776016e-06,
3.1264326644718935e-08,7.390206823985598e-08,-8.191515321117061e-08,4.7225577127027496e-08,-2.4567725181305957e-08,
1.6839217475033955e-09},{-0.00023545542333586918,-0.07326169545490067,-0.00022797138171758207,
0.00020677310866798083,1.5035859088712922e-06,-2.127210169359098e-05,-6.62412305120137e-05,-3.0111399131968904e-05,
-1.3643220548058017e-07,5.012223749801704e-08,4.0984059070847206e-08,1.5685273938629895e-08,-4.386410426083579e-09,
-2.0545579290022283e-08,5.0361766518236343e-11}
};
static const double test_corrected[2] = {
0.3903225922364747,0.5807982980735177
};
static const double test_jacobian[2][2] = {
{0.0006379339250966169,0.0009503095167417594},{0.0012675696724229707,0.0010607468461031535}
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
    bad = beta_torus_series_orbit(4, test_times,
        test_amplitudes, test_phases, test_frequencies, Q, P);
    beta_torus_series_corrected_frequencies(test_amplitudes, omega, jacobian);
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
