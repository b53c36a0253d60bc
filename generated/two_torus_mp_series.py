"""two_torus_mp_series: a Poincare-Lindstedt series of a Fermi-Pasta-Ulam chain with free amplitudes. Written by a machine.

written by: symfpu 0.1.0
made by: symfpu export two_torus.symfpu --lang mpmath -o two_torus_mp_series --series --order 3 --frequency-order 4
chain: Chain(N=16, alpha=0.33)
seeds: 1, 2
frequencies of the divisors: 0.19626, 0.39046
orders: frequencies 4, coordinates 3
precision: 30 digits
hash of the series: 1978bc5725bd9fa9918f10cf37fc7ccee026a7cb89aa0e44b5289a02f8ed0182

orbit(t, amplitudes, phases, frequencies), positions, momenta, corrected_frequencies: see their docstrings. Arrays end in the
mode axis q = 1 .. N-1, time first; angles in radians, everything else dimensionless. Run this file to test it.
"""

from mpmath import mp

N, DIGITS = 16, 30
SEEDS = (1, 2)
TOLERANCE = mp.mpf('1e-28')
_CHECK_AMPLITUDES = """
0.182861328125 0.06884765625
"""
_CHECK_PHASES = """
0.5 0.125
"""
_CHECK_FREQUENCIES = """
0.1972370147705078125 0.39241313934326171875
"""
_CHECK_TIMES = """
0.0 2.75 -13.0625 160.5
"""
_CHECK_POSITIONS = """
0.14756933146808631054049064018559 0.073203598579172561204294549016604 0.0032371865341353006424473159515961
0.00070990711452824634689287541819119 0.000040872487298711644697240515639449 0.0000066974629388337557750012123437254
0.00000048832480163410778342118505274191 0.000000040483351493464394303731535833488 0.0 0.0 0.0 0.0 0.0 0.0 0.0
0.078461925196820876617223557143709 0.020117360126198514575263066765994 -0.0034758632725270665951605181182657
-0.00083438102682484172249590100107699 -0.000074964718909367909998571288491873
-0.0000073905944562408347943094375558558 -0.000000035705977692847778953265316443966
0.0000000084385299202670478741849835677274 0.0 0.0 0.0 0.0 0.0 0.0 0.0 -0.074982746237819438006039687656717
0.014664471290773599650332861442654 0.0037658052572687938674731867293416 -0.00088561150807295660888356709127249
0.0000661325292037646578624050365095 -0.000005161480036256057274854789902394 -0.00000022772925003915493882021715731503
0.000000027655143601907189698422123317885 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.12257154512285745899428013581214
0.067000433939930320757999202973042 0.001642569080249164793528182850231 0.0004323357884905223178884943106208
-0.0000065690659572436310966802339133091 0.00000035908190795228430061260862179201
-0.00000011528901354948065404775004133311 0.000000015529201196980878139321730934179 0.0 0.0 0.0 0.0 0.0 0.0 0.0
"""
_CHECK_MOMENTA = """
-0.018293958133367806902373287972942 -0.0064052296662361845906304435994221 -0.0018941334653236956743872074806609
-0.00036173950781266521182799194915859 -0.000069229031114028206365465286530385
-0.0000098614496536706857437076625333305 -0.0000010208118122642845145228512260799
-0.000000044232478903611519644472869551662 0.0 0.0 0.0 0.0 0.0 0.0 0.0 -0.03071921776843878393154032644423
-0.028372443100290810668913337715686 -0.001867419146978509780792483803516 -0.00028500310934264713550961397164586
0.000045444713955013251251655471615274 0.000011423481941104009767149446414489 0.000001416972223634133176658469681818
0.00000010000197985706274868923876963484 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.030976134246780824748447943215058
-0.028968375116062573055984834372863 0.0016645665444151503035059725572622 -0.00019176267342690542195525255515204
-0.000057170630602177413015844374003584 0.000013079815310952005725273481887676
-0.0000013852189261740850174603172256455 0.000000091453580155181368838079391064676 0.0 0.0 0.0 0.0 0.0 0.0 0.0
-0.025566967163580699181108752880674 -0.010942105830984037553380330982304 -0.0025381675152384090157509133528406
-0.00050781442284462610028381364977074 -0.000080400969593579609531547926320307 -0.000012168941068547169274219672019181
-0.0000013198021611507604897854530555025 -0.000000081860258330294300897548902612188 0.0 0.0 0.0 0.0 0.0 0.0 0.0
"""
_CHECK_CORRECTED = """
0.19605390888520602458332167486298 0.39018427787984442035971972714657
"""
_CHECK_JACOBIAN = """
0.00022380400734081573238975970204455 -0.000016452492579182645347796173046122 -0.000024322591597605420313141178032022
0.00016550627415271873940175195396255
"""


def _given(name, values):
    numbers = [mp.mpf(x) for x in values]
    if len(numbers) != len(SEEDS):
        raise ValueError("%s must be one number for each of the seeds %s" % (name, SEEDS))
    return numbers


def _numbers(text):
    return [mp.mpf(word) for word in text.split()]


def _rows(items, columns):
    return [items[i : i + columns] for i in range(0, len(items), columns)]


_BLOCK = 1024  # times at once


def _coefficients(amplitudes, frequencies):
    """Coefficients of cosines in Q and of sines in P at these amplitudes."""
    (A1, A2,) = amplitudes
    (omega1, omega2,) = frequencies
    x0 = A1**2
    x1 = A1**4
    x2 = A2**2
    x3 = x0*x2
    x4 = A2**4
    x5 = A2*x0
    x6 = A2**3
    x7 = A1**3
    x8 = A1*x2
    x9 = 2*omega2
    x10 = -omega2
    x11 = A1*A2
    x12 = A2*x7
    x13 = A1*x6
    x14 = 2*omega1
    x15 = 3*omega2
    x16 = -x9
    x17 = 3*omega1
    c0_2 = (
        -mp.mpf("0.0028687032351990724254958818148320")*x0 + mp.mpf("0.000039819757312049280976606346210299")*x1 -
        mp.mpf("0.0035713364733041934177571588324251")*x3
    )
    c0_4 = (
        -mp.mpf("0.00040670825168449101632950380153257")*x1 - mp.mpf("0.0058019067082360719990402831884100")*x2 -
        mp.mpf("0.00010285150267338830582136418778772")*x3 + mp.mpf("0.000076673019504454861395753410644833")*x4
    )
    c0_6 = -mp.mpf("0.0010408166713117287822786724747495")*x3
    c0_8 = -mp.mpf("0.00020060716303406162451933629742243")*x4
    rate1 = omega2
    c1_2 = mp.mpf("1.0000000000000000000000000000000")*A2
    d1_2 = -c1_2*rate1
    c1_4 = -mp.mpf("0.0040397815983494741185704353316958")*x5
    d1_4 = -c1_4*rate1
    c1_6 = -mp.mpf("0.0023202703313428538673464444376295")*x6
    d1_6 = -c1_6*rate1
    rate2 = omega1
    c2_1 = mp.mpf("1.0000000000000000000000000000000")*A1
    d2_1 = -c2_1*rate2
    c2_3 = mp.mpf("0.0096091442222706986741580240205596")*A1*x2 - mp.mpf("0.0023031234259960986743975299127121")*x7
    d2_3 = -c2_3*rate2
    c2_5 = -mp.mpf("0.0050471639768468712045681870991857")*x8
    d2_5 = -c2_5*rate2
    rate3 = x9
    c3_2 = -mp.mpf("0.0047924135583931839520642528615385")*x3
    d3_2 = -c3_2*rate3
    c3_4 = (
        mp.mpf("0.14131948233035062875724867330137")*x2 - mp.mpf("0.14695492167776707746217332627640")*x3 +
        mp.mpf("0.014368474457199321040034306524672")*x4
    )
    d3_4 = -c3_4*rate3
    c3_6 = -mp.mpf("0.0013476891206633246586876669732677")*x3
    d3_6 = -c3_6*rate3
    c3_8 = -mp.mpf("0.00039517868651537174211107941013165")*x4
    d3_8 = -c3_8*rate3
    rate4 = omega1 + x10
    c4_1 = (
        mp.mpf("1.1173455145685154869808760779342")*A1*x6 - mp.mpf("1.0874891895299318633583708868149")*x11 -
        mp.mpf("0.63631851372384749113062987228442")*x12
    )
    d4_1 = -c4_1*rate4
    c4_3 = (
        -mp.mpf("0.0086539762024132355117429308669530")*x11 + mp.mpf("0.0000047364636676905821133701293804990")*x12 +
        mp.mpf("0.000097288058474043134502732271350775")*x13
    )
    d4_3 = -c4_3*rate4
    c4_5 = mp.mpf("0.0062118030949975290756866869381492")*A1*x6 - mp.mpf("0.0013302049702459507312832560635804")*x12
    d4_5 = -c4_5*rate4
    c4_7 = -mp.mpf("0.00092413665549377831634263500390670")*x13
    d4_7 = -c4_7*rate4
    rate5 = omega1 + omega2
    c5_1 = (
        mp.mpf("0.0028611557516560571643186850581606")*x11 - mp.mpf("0.00089703743688479444958692707475900")*x12 +
        mp.mpf("0.0000047217182200629207198323089335895")*x13
    )
    d5_1 = -c5_1*rate5
    c5_3 = (
        mp.mpf("0.36082081426335913168546121244911")*x11 - mp.mpf("0.013108564194709952078715962278200")*x12 +
        mp.mpf("0.031622336240333159900133273840948")*x13
    )
    d5_3 = -c5_3*rate5
    c5_5 = mp.mpf("0.0021334382032927201184773743088483")*A1*x6 - mp.mpf("0.0018278113797905549317731782742365")*x12
    d5_5 = -c5_5*rate5
    c5_7 = -mp.mpf("0.0015661664830180405380942822806490")*x13
    d5_7 = -c5_7*rate5
    rate6 = x14
    c6_2 = (
        mp.mpf("0.27115700844456895154851305043917")*x0 + mp.mpf("0.12035153297272661300566291383612")*x1 -
        mp.mpf("0.22278126771983981867478731280984")*x3
    )
    d6_2 = -c6_2*rate6
    c6_4 = mp.mpf("0.0044697103593031848762068653022213")*x0*x2 - mp.mpf("0.00080956431839020941305570850489330")*x1
    d6_4 = -c6_4*rate6
    c6_6 = -mp.mpf("0.0021846701649282899171036830982025")*x3
    d6_6 = -c6_6*rate6
    rate7 = x15
    c7_2 = mp.mpf("0.00078758783682471376868307742995999")*x6
    d7_2 = -c7_2*rate7
    c7_6 = mp.mpf("0.019895233780180388155719494859436")*x6
    d7_6 = -c7_6*rate7
    rate8 = omega1 + x16
    c8_1 = -mp.mpf("0.0032101429512129936699621527705023")*x8
    d8_1 = -c8_1*rate8
    c8_3 = -mp.mpf("0.44037557830840125335694783174380")*x8
    d8_3 = -c8_3*rate8
    c8_5 = -mp.mpf("0.0019347032245652866266244825016125")*x8
    d8_5 = -c8_5*rate8
    rate9 = omega1 + x9
    c9_1 = mp.mpf("0.0010227658453562675540368583735107")*x8
    d9_1 = -c9_1*rate9
    c9_3 = mp.mpf("0.0011743413403160224152141252986165")*x8
    d9_3 = -c9_3*rate9
    c9_5 = mp.mpf("0.085753466249830507061719414375255")*x8
    d9_5 = -c9_5*rate9
    rate10 = x10 + x14
    c10_2 = mp.mpf("0.0063865913417437353937298592212897")*x5
    d10_2 = -c10_2*rate10
    c10_4 = -mp.mpf("0.0030714067691627327966737320970525")*x5
    d10_4 = -c10_4*rate10
    rate11 = omega2 + x14
    c11_2 = mp.mpf("0.0020347964535708153936066020611483")*x5
    d11_2 = -c11_2*rate11
    c11_4 = mp.mpf("0.13481870681336374939899265893405")*x5
    d11_4 = -c11_4*rate11
    rate12 = x17
    c12_1 = mp.mpf("0.00076972568115814008673394174040592")*x7
    d12_1 = -c12_1*rate12
    c12_3 = mp.mpf("0.073162755812762874793609965223507")*x7
    d12_3 = -c12_3*rate12
    rate13 = 4*omega2
    c13_4 = mp.mpf("0.00021065985386560155777569896118712")*x4
    d13_4 = -c13_4*rate13
    c13_8 = mp.mpf("0.0027180982348453716173422663526471")*x4
    d13_8 = -c13_8*rate13
    rate14 = omega1 - x15
    c14_1 = -mp.mpf("0.0012595569830263697712298973465579")*x13
    d14_1 = -c14_1*rate14
    c14_3 = -mp.mpf("0.0013218139253162946775540548811470")*x13
    d14_3 = -c14_3*rate14
    c14_5 = -mp.mpf("0.10510386728889292437983693708557")*x13
    d14_5 = -c14_5*rate14
    c14_7 = -mp.mpf("0.00034578434218557493639534008856151")*x13
    d14_7 = -c14_7*rate14
    rate15 = omega1 + x15
    c15_1 = mp.mpf("0.00014396810949383098931378959491488")*x13
    d15_1 = -c15_1*rate15
    c15_3 = mp.mpf("0.00070114957121702750293610540073158")*x13
    d15_3 = -c15_3*rate15
    c15_5 = mp.mpf("0.00026112212247840585025432008598937")*x13
    d15_5 = -c15_5*rate15
    c15_7 = mp.mpf("0.016624473866658328923804266201810")*x13
    d15_7 = -c15_7*rate15
    rate16 = x14 + x16
    c16_2 = mp.mpf("0.22587682658901167258977233650908")*x3
    d16_2 = -c16_2*rate16
    c16_4 = mp.mpf("0.0049720735553989534877907984249637")*x3
    d16_4 = -c16_4*rate16
    c16_6 = -mp.mpf("0.00060893541703748148837108870649234")*x3
    d16_6 = -c16_6*rate16
    rate17 = x14 + x9
    c17_2 = mp.mpf("0.00096651398996281460152184485608660")*x3
    d17_2 = -c17_2*rate17
    c17_4 = mp.mpf("0.00092606439658365091773404535815839")*x3
    d17_4 = -c17_4*rate17
    c17_6 = mp.mpf("0.040758134635195147337164837775657")*x3
    d17_6 = -c17_6*rate17
    rate18 = x10 + x17
    c18_1 = -mp.mpf("0.083935147493795422730217701456770")*x12
    d18_1 = -c18_1*rate18
    c18_3 = mp.mpf("0.0025559028660708235763316137779607")*x12
    d18_3 = -c18_3*rate18
    c18_5 = -mp.mpf("0.0010087211758185608438821528295822")*x12
    d18_5 = -c18_5*rate18
    rate19 = omega2 + x17
    c19_1 = mp.mpf("0.00048470538167331154237146781638168")*x12
    d19_1 = -c19_1*rate19
    c19_3 = mp.mpf("0.0011166044853950544247208159755694")*x12
    d19_3 = -c19_3*rate19
    c19_5 = mp.mpf("0.046294440168108966975257766992132")*x12
    d19_5 = -c19_5*rate19
    rate20 = 4*omega1
    c20_2 = mp.mpf("0.00041007492835658429896479288555846")*x1
    d20_2 = -c20_2*rate20
    c20_4 = mp.mpf("0.020381730629727661876170380882789")*x1
    d20_4 = -c20_4*rate20
    return (
        c0_2, c0_4, c0_6, c0_8, c1_2, d1_2, c1_4, d1_4, c1_6, d1_6, c2_1, d2_1, c2_3, d2_3, c2_5, d2_5, c3_2, d3_2,
        c3_4, d3_4, c3_6, d3_6, c3_8, d3_8, c4_1, d4_1, c4_3, d4_3, c4_5, d4_5, c4_7, d4_7, c5_1, d5_1, c5_3, d5_3,
        c5_5, d5_5, c5_7, d5_7, c6_2, d6_2, c6_4, d6_4, c6_6, d6_6, c7_2, d7_2, c7_6, d7_6, c8_1, d8_1, c8_3, d8_3,
        c8_5, d8_5, c9_1, d9_1, c9_3, d9_3, c9_5, d9_5, c10_2, d10_2, c10_4, d10_4, c11_2, d11_2, c11_4, d11_4, c12_1,
        d12_1, c12_3, d12_3, c13_4, d13_4, c13_8, d13_8, c14_1, d14_1, c14_3, d14_3, c14_5, d14_5, c14_7, d14_7,
        c15_1, d15_1, c15_3, d15_3, c15_5, d15_5, c15_7, d15_7, c16_2, d16_2, c16_4, d16_4, c16_6, d16_6, c17_2,
        d17_2, c17_4, d17_4, c17_6, d17_6, c18_1, d18_1, c18_3, d18_3, c18_5, d18_5, c19_1, d19_1, c19_3, d19_3,
        c19_5, d19_5, c20_2, d20_2, c20_4, d20_4,
    )


def _sums(theta, coefficients):
    """Q and P, (times, N-1), at angles (s, times)."""
    (theta1, theta2,) = theta
    (
        c0_2, c0_4, c0_6, c0_8, c1_2, d1_2, c1_4, d1_4, c1_6, d1_6, c2_1, d2_1, c2_3, d2_3, c2_5, d2_5, c3_2, d3_2,
        c3_4, d3_4, c3_6, d3_6, c3_8, d3_8, c4_1, d4_1, c4_3, d4_3, c4_5, d4_5, c4_7, d4_7, c5_1, d5_1, c5_3, d5_3,
        c5_5, d5_5, c5_7, d5_7, c6_2, d6_2, c6_4, d6_4, c6_6, d6_6, c7_2, d7_2, c7_6, d7_6, c8_1, d8_1, c8_3, d8_3,
        c8_5, d8_5, c9_1, d9_1, c9_3, d9_3, c9_5, d9_5, c10_2, d10_2, c10_4, d10_4, c11_2, d11_2, c11_4, d11_4, c12_1,
        d12_1, c12_3, d12_3, c13_4, d13_4, c13_8, d13_8, c14_1, d14_1, c14_3, d14_3, c14_5, d14_5, c14_7, d14_7,
        c15_1, d15_1, c15_3, d15_3, c15_5, d15_5, c15_7, d15_7, c16_2, d16_2, c16_4, d16_4, c16_6, d16_6, c17_2,
        d17_2, c17_4, d17_4, c17_6, d17_6, c18_1, d18_1, c18_3, d18_3, c18_5, d18_5, c19_1, d19_1, c19_3, d19_3,
        c19_5, d19_5, c20_2, d20_2, c20_4, d20_4,
    ) = coefficients
    cos1 = mp.cos(theta2)
    sin1 = mp.sin(theta2)
    cos2 = mp.cos(theta1)
    sin2 = mp.sin(theta1)
    cos3 = mp.cos(2*theta2)
    sin3 = mp.sin(2*theta2)
    cos4 = mp.cos(theta1 - theta2)
    sin4 = mp.sin(theta1 - theta2)
    cos5 = mp.cos(theta1 + theta2)
    sin5 = mp.sin(theta1 + theta2)
    cos6 = mp.cos(2*theta1)
    sin6 = mp.sin(2*theta1)
    cos7 = mp.cos(3*theta2)
    sin7 = mp.sin(3*theta2)
    cos8 = mp.cos(theta1 - 2*theta2)
    sin8 = mp.sin(theta1 - 2*theta2)
    cos9 = mp.cos(theta1 + 2*theta2)
    sin9 = mp.sin(theta1 + 2*theta2)
    cos10 = mp.cos(2*theta1 - theta2)
    sin10 = mp.sin(2*theta1 - theta2)
    cos11 = mp.cos(2*theta1 + theta2)
    sin11 = mp.sin(2*theta1 + theta2)
    cos12 = mp.cos(3*theta1)
    sin12 = mp.sin(3*theta1)
    cos13 = mp.cos(4*theta2)
    sin13 = mp.sin(4*theta2)
    cos14 = mp.cos(theta1 - 3*theta2)
    sin14 = mp.sin(theta1 - 3*theta2)
    cos15 = mp.cos(theta1 + 3*theta2)
    sin15 = mp.sin(theta1 + 3*theta2)
    cos16 = mp.cos(2*theta1 - 2*theta2)
    sin16 = mp.sin(2*theta1 - 2*theta2)
    cos17 = mp.cos(2*theta1 + 2*theta2)
    sin17 = mp.sin(2*theta1 + 2*theta2)
    cos18 = mp.cos(3*theta1 - theta2)
    sin18 = mp.sin(3*theta1 - theta2)
    cos19 = mp.cos(3*theta1 + theta2)
    sin19 = mp.sin(3*theta1 + theta2)
    cos20 = mp.cos(4*theta1)
    sin20 = mp.sin(4*theta1)
    Q = (
        [c12_1*cos12 + c14_1*cos14 + c15_1*cos15 + c18_1*cos18 + c19_1*cos19 + c2_1*cos2 + c4_1*cos4 + c5_1*cos5 +
        c8_1*cos8 + c9_1*cos9, c0_2 + c10_2*cos10 + c11_2*cos11 + c16_2*cos16 + c17_2*cos17 + c1_2*cos1 + c20_2*cos20
        + c3_2*cos3 + c6_2*cos6 + c7_2*cos7, c12_3*cos12 + c14_3*cos14 + c15_3*cos15 + c18_3*cos18 + c19_3*cos19 +
        c2_3*cos2 + c4_3*cos4 + c5_3*cos5 + c8_3*cos8 + c9_3*cos9, c0_4 + c10_4*cos10 + c11_4*cos11 + c13_4*cos13 +
        c16_4*cos16 + c17_4*cos17 + c1_4*cos1 + c20_4*cos20 + c3_4*cos3 + c6_4*cos6, c14_5*cos14 + c15_5*cos15 +
        c18_5*cos18 + c19_5*cos19 + c2_5*cos2 + c4_5*cos4 + c5_5*cos5 + c8_5*cos8 + c9_5*cos9, c0_6 + c16_6*cos16 +
        c17_6*cos17 + c1_6*cos1 + c3_6*cos3 + c6_6*cos6 + c7_6*cos7, c14_7*cos14 + c15_7*cos15 + c4_7*cos4 +
        c5_7*cos5, c0_8 + c13_8*cos13 + c3_8*cos3, 0, 0, 0, 0, 0, 0, 0]
    )
    P = (
        [d12_1*sin12 + d14_1*sin14 + d15_1*sin15 + d18_1*sin18 + d19_1*sin19 + d2_1*sin2 + d4_1*sin4 + d5_1*sin5 +
        d8_1*sin8 + d9_1*sin9, d10_2*sin10 + d11_2*sin11 + d16_2*sin16 + d17_2*sin17 + d1_2*sin1 + d20_2*sin20 +
        d3_2*sin3 + d6_2*sin6 + d7_2*sin7, d12_3*sin12 + d14_3*sin14 + d15_3*sin15 + d18_3*sin18 + d19_3*sin19 +
        d2_3*sin2 + d4_3*sin4 + d5_3*sin5 + d8_3*sin8 + d9_3*sin9, d10_4*sin10 + d11_4*sin11 + d13_4*sin13 +
        d16_4*sin16 + d17_4*sin17 + d1_4*sin1 + d20_4*sin20 + d3_4*sin3 + d6_4*sin6, d14_5*sin14 + d15_5*sin15 +
        d18_5*sin18 + d19_5*sin19 + d2_5*sin2 + d4_5*sin4 + d5_5*sin5 + d8_5*sin8 + d9_5*sin9, d16_6*sin16 +
        d17_6*sin17 + d1_6*sin1 + d3_6*sin3 + d6_6*sin6 + d7_6*sin7, d14_7*sin14 + d15_7*sin15 + d4_7*sin4 +
        d5_7*sin5, d13_8*sin13 + d3_8*sin3, 0, 0, 0, 0, 0, 0, 0]
    )
    return [mp.mpf(q) for q in Q], [mp.mpf(p) for p in P]


def corrected_frequencies(amplitudes):
    """omega(A) of the seeds, shape (s,), and its Jacobian d omega_i / d A_j, shape (s, s)."""
    (A1, A2,) = _given("amplitudes", amplitudes)
    y0 = A1**2
    y1 = A1**4
    y2 = A2**2
    y3 = A2**4
    y4 = y0*y2
    y5 = A1**3
    y6 = A2**3
    y7 = A2*y0
    corrected = (
        [mp.mpf("0.00059216085287022202116225174374199")*y0 + mp.mpf("0.00039529957083372115169769743845304")*y1 -
        mp.mpf("0.000092947425828135976115504054372348")*y2 + mp.mpf("0.0021470587971840756323513737775197")*y3 -
        mp.mpf("0.0014023293054972350548346406318434")*y4 + mp.mpf("0.19603428065912120398839112777728"),
        -mp.mpf("0.000046698579337598624313051154409999")*y0 - mp.mpf("0.00044518236985473339193506266337989")*y1 +
        mp.mpf("0.0011298915795266533269019547098242")*y2 + mp.mpf("0.00018810304175985085359019051160995")*y3 +
        mp.mpf("0.0021023772176948765648062902981850")*y4 + mp.mpf("0.39018064403225653569656973695404")]
    )
    jacobian = (
        [[-mp.mpf("0.0028046586109944701096692812636868")*A1*y2 + mp.mpf("0.0011843217057404440423245034874840")*A1 +
        mp.mpf("0.0015811982833348846067907897538121")*y5, -mp.mpf("0.00018589485165627195223100810874470")*A2 +
        mp.mpf("0.0085882351887363025294054951100787")*y6 - mp.mpf("0.0028046586109944701096692812636868")*y7],
        [mp.mpf("0.0042047544353897531296125805963700")*A1*y2 - mp.mpf("0.000093397158675197248626102308819998")*A1 -
        mp.mpf("0.0017807294794189335677402506535196")*y5, mp.mpf("0.0022597831590533066538039094196484")*A2 +
        mp.mpf("0.00075241216703940341436076204643981")*y6 + mp.mpf("0.0042047544353897531296125805963700")*y7]]
    )
    return [mp.mpf(w) for w in corrected], [[mp.mpf(x) for x in row] for row in jacobian]


def orbit(t, amplitudes, phases=None, frequencies=None):
    """Mode coordinates and momenta at one time, two lists of N-1 mpf; mode q stands at place q-1.

    amplitudes : s numbers A, in the order of SEEDS. phases : s angles in radians; default zeros. frequencies : s rates of the
    angles, theta = omega t + phi; default corrected_frequencies(A). All quantities are dimensionless.
    """
    time, A = mp.mpf(t), _given("amplitudes", amplitudes)
    chosen = [mp.mpf(0)] * len(SEEDS) if phases is None else _given("phases", phases)
    extra = int(max(0, mp.ceil(mp.log(1 + abs(time), 10)))) + 5
    with mp.extradps(extra):
        omega = corrected_frequencies(amplitudes)[0] if frequencies is None else _given("frequencies", frequencies)
        Q, P = _sums([w * time + p for w, p in zip(omega, chosen)], _coefficients(A, omega))
    return [+x for x in Q], [+x for x in P]


def positions(t, amplitudes, phases=None, frequencies=None):
    """Mode coordinates Q_q(t), q = 1 .. N-1; see orbit."""
    return orbit(t, amplitudes, phases, frequencies)[0]


def momenta(t, amplitudes, phases=None, frequencies=None):
    """Mode momenta P_q = dQ_q/dt; see orbit."""
    return orbit(t, amplitudes, phases, frequencies)[1]


def self_test():
    """Largest deviation from the embedded test vectors, each relative to the largest value of its kind."""
    worst = mp.mpf(0)
    with mp.workdps(DIGITS + 5):
        amplitudes, phases, rates = (_numbers(text) for text in (_CHECK_AMPLITUDES, _CHECK_PHASES, _CHECK_FREQUENCIES))
        orbits = [orbit(t, amplitudes, phases, rates) for t in _CHECK_TIMES.split()]
        corrected, jacobian = corrected_frequencies(amplitudes)
        results = [[x for pair in orbits for x in pair[part]] for part in (0, 1)] + [corrected, [x for row in jacobian for x in row]]
        for ours, text in zip(results, (_CHECK_POSITIONS, _CHECK_MOMENTA, _CHECK_CORRECTED, _CHECK_JACOBIAN)):
            known = _numbers(text)
            worst = max(worst, max(abs(a - b) for a, b in zip(ours, known)) / (max(abs(b) for b in known) or 1))
    return worst


if __name__ == "__main__":
    deviation = self_test()
    print("largest deviation %s, allowed %s" % (mp.nstr(deviation, 2), mp.nstr(TOLERANCE, 2)))
    raise SystemExit(0 if deviation <= TOLERANCE else 1)
