! Machine-written: quasi-periodic solutions of an FPU chain with free amplitudes A, one a seed,
!
!     Q_q(t) = sum over nu of c_q[nu](A) cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1,
!
! and their frequencies corrected by the amplitudes, omega(A).
!
!  written by: symfpu 0.1.0
!  made by: symfpu export beta_torus.symfpu --lang fortran -o beta_torus_series --series --order 3 --frequency-order
!      4
!  chain: Chain(N=16, beta=0.6)
!  seeds: 2, 3
!  frequencies of the divisors: 0.3925, 0.5845
!  orders: frequencies 4, coordinates 3
!  precision: 30 digits
!  hash of the series: 5e6359b305a6978828c49c95d096b2ffc089f1aff62c088fc538117ba5ae9a9b
!
! How to call. Compile this file before your program, which says
!
!     use beta_torus_series, only: positions, momenta, orbit, corrected_frequencies
!     use, intrinsic :: iso_fortran_env, only: real64
!     real(real64) :: t(n), Q(15, n), P(15, n), amplitudes(2), phases(2), frequencies(2)
!     real(real64) :: omega(2), jacobian(2, 2)
!     call corrected_frequencies(amplitudes, omega)   ! or corrected_frequencies(amplitudes, omega, jacobian)
!     call positions(t, amplitudes, Q)                ! or positions(t, amplitudes, Q, phases, frequencies)
!     call momenta(t, amplitudes, P)                  ! or momenta(t, amplitudes, P, phases, frequencies)
!     call orbit(t, amplitudes, Q, P)                 ! or orbit(t, amplitudes, Q, P, phases, frequencies)
!
!   t            n times, any real numbers
!   Q, P         (N-1, n) = (15, n): Q(q, i) is mode q at time t(i); in memory the time is slowest, as in the C files
!   amplitudes   (2): A, one a seed in the order above; Q_q = A_q cos(omega_q t + phi_q) + ... for a seed q
!   phases       (2): angles phi in radians; left out, they are zero
!   frequencies  (2): the omega with which the angles turn, radians a unit of time; left out, they are omega(A). The
!                divisors have the frequencies named above, whatever these are
!   omega        (2): the corrected frequencies omega(A)
!   jacobian     (2, 2): jacobian(i, j) is the derivative of omega(i) by amplitudes(j)
!
! Two such modules in one program:
! use beta_torus_series, only: beta_torus_series_positions => positions.
! All quantities are dimensionless. How well the equations of motion hold depends on the amplitudes, and on frequencies
! being omega(A). Arrays of other shapes stop the program.
! A call sums the powers of the amplitudes in all 543 coefficients first: give it many times at once. Tables are
! only read and work arrays are allocated by each call.
! The procedures may be called from several threads.
!
! Accuracy: omega t, with omega the doubles of this call, is reduced to one turn without loss up to |t| of about 1e14.
! The sums are those of doubles, some 1e-15 of the largest coordinate while higher powers of the amplitudes are smaller
! than lower ones. Left out, frequencies have the rounding of doubles: after a time t, angles are off by some 1e-16 |t|.
! A time that is not finite, or above 1e38, gives NaN. Compile without -ffast-math.
!
! Self-test: gfortran -std=f2008 -O2 -DBETA_TORUS_SERIES_SELF_TEST FILE.F90 && ./a.out
! prints the largest deviation from embedded vectors and fails above 1d-13.

module beta_torus_series
  use, intrinsic :: iso_fortran_env, only: rk => real64, single => real32
  implicit none
  private
  public :: positions, momenta, orbit, corrected_frequencies

  integer, parameter :: modes = 15, seeds = 2
  real(rk), parameter :: two_pi = 6.283185307179586d0
  ! 1 / (2 pi) in three parts, exact in doubles
  real(rk), parameter :: radian(3) = [0.15915493667125702d0, 6.4206382432985265d-09, 7.34273885092955d-17]
  integer, parameter :: highest = 7  ! largest number in a harmonic
  integer, parameter :: degree = 8  ! largest power of an amplitude
  integer, parameter :: monomials = 20, corrections = 14
  integer, parameter :: times = 64, tile = 256  ! evaluated together, and harmonics of one matrix product
  integer :: i  ! of the tables

  ! x = scales A; exponents of x in the coefficients of harmonics;
  ! omega(A) = linear + sum over f of correction(f, :) x^even_powers(f, :)
  integer, save :: exponents(monomials, seeds), even_powers(corrections, seeds)
  real(rk), save :: scales(seeds), linear(seeds), correction(corrections, seeds)
  data (scales(i), i = 1, 2) / &
    0.584466494136728d0,0.8696570176479649d0 /
  data (linear(i), i = 1, 2) / &
    0.39018064403225655d0,0.5805693545089248d0 /
  data (exponents(i, 1), i = 1, 20) / &
    0,0,0,0,1,1,1,1,2,2,2,3,3,3,4,4,5,5,6,7 /
  data (exponents(i, 2), i = 1, 20) / &
    1,3,5,7,0,2,4,6,1,3,5,0,2,4,1,3,0,2,1,0 /
  data (even_powers(i, 1), i = 1, 14) / &
    0,2,0,2,4,0,2,4,6,0,2,4,6,8 /
  data (even_powers(i, 2), i = 1, 14) / &
    2,0,4,2,0,6,4,2,0,8,6,4,2,0 /
  data (correction(i, 1), i = 1, 14) / &
    0.00489069361059761d0,0.003668020207948207d0,0.00019490294531185223d0,0.0002389422426901928d0, &
    -1.990274238097673d-05,0.00021635519458816063d0,0.000942383684268711d0,0.00030161466895159026d0, &
    5.168944311824107d-06,0.00017777739467668652d0,0.0013799251042064576d0,0.0015196976919415563d0, &
    0.00021325938835412765d0,8.8587324503835d-07 /
  data (correction(i, 2), i = 1, 14) / &
    0.005457831281548994d0,0.007277108375398658d0,-4.807603280703011d-05,0.0006028153491451335d0, &
    0.0001663652704592263d0,2.8808669803948566d-06,0.0009717416076450349d0,0.0014012938446772852d0, &
    0.00014801040355992632d0,-5.4277456425477874d-08,0.0010654693171952487d0,0.0030857101204708995d0, &
    0.0015009513736843458d0,7.841392654177493d-05 /

  ! Harmonics of the even modes: nu; their first rows in a, and the end; monomial of every row; coefficients
  integer, save :: nu_even(16, seeds), starts_even(17), which_even(50)
  real(rk), save :: a_even(50, 7)
  data (nu_even(i, 1), i = 1, 16) / &
    1,1,1,1,1,1,1,3,3,3,3,3,5,5,5,7 /
  data (nu_even(i, 2), i = 1, 16) / &
    -6,-4,-2,0,2,4,6,-4,-2,0,2,4,-2,0,2,0 /
  data (starts_even(i), i = 1, 17) / &
    1,2,5,11,21,27,30,31,32,35,41,44,45,46,49,50,51 /
  data (which_even(i), i = 1, 50) / &
    8,7,8,14,6,7,8,13,14,18,5,6,7,8,12,13,14,17,18,20,6,7,8,13,14,18,7,8,14,8,14,13,14,18,12,13,14,17,18,20,13,14,18, &
    14,18,17,18,20,18,20 /
  data (a_even(i, 1), i = 1, 50) / &
    6.979866798947515d-07,9.733550388522214d-05,8.121947957066062d-05,0.0001537814457261982d0,0.007273288636438459d0, &
    0.0013902876122248108d0,0.0012663789348974952d0,0.0006899210181329601d0,0.002505367973257222d0, &
    0.00048151585663780075d0,1.7109620654594164d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0.001429346385052389d0, &
    2.4059836300734977d-05,3.429205821109349d-06,5.276726278147977d-05,5.697247830701376d-05,9.097233910523794d-06, &
    7.901980519003311d-06,5.171641271156756d-07,6.442332504192633d-06,8.722915534906275d-08,0.00018639366119820958d0, &
    -0.002304793649275954d0,-0.0029528193472755115d0,-0.0017615660783809528d0,0.0013245771332478715d0, &
    0.0003845504106570438d0,0.0003695025505165028d0,3.858159811455979d-05,0.000249906051221987d0, &
    6.588271095336114d-06,2.784064973289521d-05,7.496200246151247d-06,3.950358301834779d-06,7.35189672913262d-07, &
    0.00011653685228407712d0,8.523813018826834d-06,1.2304045292088296d-05,1.4153902761280567d-06, &
    9.502022857689556d-07,1.5952275814448626d-07 /
  data (a_even(i, 2), i = 1, 50) / &
    1.988311415596763d-06,0.00044854899471722065d0,0.00036466397601587184d0,0.0006422997371768461d0, &
    0.18654608381001372d0,0.15510860445148963d0,0.1317355662832163d0,0.20842074805028143d0,0.38472912367454243d0, &
    0.20358636067564256d0,0d0,-0.01483433480165009d0,-0.0025182137355665964d0,-0.002537771506669365d0,0d0, &
    -0.0008405660853608734d0,-0.005047411758187794d0,0d0,-0.0012028923060462828d0,0d0,0.0017285950403937698d0, &
    -3.9597981818285155d-05,-8.046674197677835d-06,0.0008519225931923145d0,0.0006302917645488518d0, &
    0.0008945993483898559d0,9.757213745236447d-06,6.228274627078093d-07,1.4613851302322105d-05, &
    1.3506465472572493d-07,0.00044480029190167d0,-0.003627638771363674d0,-0.003807617251187078d0, &
    -0.0034536897458006875d0,0d0,0.0008146732266347507d0,0.0009785600591848817d0,0d0,0.0006736850001633668d0,0d0, &
    2.5452044034149695d-05,1.0128092367129838d-05,1.375080705897901d-05,1.0326769379830996d-06, &
    0.0029326010668346224d0,0d0,4.14494157091973d-05,0d0,1.1797621957953177d-06,0d0 /
  data (a_even(i, 3), i = 1, 50) / &
    0d0,0d0,0d0,0.0003482807854381274d0,0d0,0d0,0d0,-0.0016598232440025794d0,-0.0023397089633997474d0, &
    -0.0009935991264881444d0,0d0,0d0,0d0,0d0,-0.004302235031381684d0,-0.0010731130169016163d0, &
    -0.0016660602187841028d0,3.538366185795958d-05,-0.0007212383897700012d0,-2.5096019231886437d-05,0d0,0d0,0d0, &
    0.00015124084991500762d0,0.0002805472757306545d0,5.328470389458344d-05,0d0,0d0,2.6657148195004336d-05,0d0, &
    0.009335500452665972d0,-0.0011198168200524435d0,-0.0017197671225275372d0,-0.0005576486012350809d0, &
    0.010203464337468899d0,0.012345043788984298d0,0.011659559837074182d0,0.001688416704119413d0, &
    0.008408222187195238d0,0.00034274296456036153d0,0.00012081304167559436d0,8.477279769380189d-05, &
    2.0740556274723643d-05,1.2558060448697919d-06,-8.964856679951056d-05,6.171800482247129d-05, &
    0.00013549637357123748d0,1.1192441460919682d-05,2.085794572692974d-06,3.9363577162875524d-07 /
  data (a_even(i, 4), i = 1, 50) / &
    9.119402808640352d-07,8.089557630571547d-06,-5.51569421636937d-06,9.986184794639793d-06,-0.0042353040047702385d0, &
    0.000224634816101567d0,1.0420833822847853d-05,-0.0016023099486573633d0,-0.0013990245059607013d0, &
    -0.00200788967645477d0,0d0,-0.006410728312203719d0,0.000125751261555187d0,-3.0131318808683652d-05,0d0, &
    0.0004987122425962393d0,-0.00021179010858123892d0,0d0,-3.565727624094263d-05,0d0,0.013500254528743181d0, &
    0.0012206190449172221d0,0.00019506388053886568d0,0.0049129054907151625d0,0.004700258179710831d0, &
    0.004113689868580609d0,8.043804519358607d-05,6.827680243695332d-06,6.773498776024037d-05,3.8376156576741545d-07, &
    -0.0004307040032705917d0,-0.0004609839966042593d0,-0.0006458391829745498d0,-0.000637822680602946d0,0d0, &
    1.9843784804640853d-05,-0.00015040643950960908d0,0d0,-0.00013581692784517927d0,0d0,0.00023863536679885665d0, &
    5.4316766039556386d-05,7.530901189989052d-05,2.86716950289005d-06,-2.2176851849433402d-05,0d0, &
    4.6473738871194934d-05,0d0,2.6887962499626197d-06,0d0 /
  data (a_even(i, 5), i = 1, 50) / &
    1.199790309211563d-05,0.00155894832727701d0,0.0012848797389865573d0,0.003140440923996439d0,0d0, &
    -0.0013214121956375286d0,-0.0010952346938213882d0,0d0,-0.0018070972823867935d0,2.313976977567924d-05,0d0,0d0, &
    -0.0004065540397375715d0,-0.00043920303565512554d0,0d0,0d0,-0.0007579836917694284d0,1.1987987280219369d-05, &
    -4.008770868718185d-06,-8.049666512928422d-06,0d0,0.00027824422496047947d0,-4.702737938433818d-05,0d0, &
    0.00019488867093052936d0,-0.0001786133915026552d0,2.45793802942348d-05,2.635005181252224d-06, &
    6.923995423036765d-05,1.9181578442441924d-07,-0.0007735994759435497d0,0d0,-0.00017539697114261104d0, &
    -8.224217928383846d-06,0d0,0d0,-1.6993949948274666d-05,-0.0001352546428389541d0,-0.00029822950835418194d0, &
    -2.3104251754947978d-05,0d0,3.2973040570011656d-05,-2.7996446903410324d-06,8.937907566201126d-07, &
    -7.808618927170913d-05,0.00010879831180291874d0,0.0003977185652040505d0,2.2334598526017525d-05, &
    3.961946399229252d-06,1.3955681027660072d-06 /
  data (a_even(i, 6), i = 1, 50) / &
    2.6508093797265297d-06,0d0,9.824616206398052d-05,3.7008227845787046d-05,0d0,0d0,-2.8244124510869606d-06, &
    0.00011325298867228622d0,1.0485698444077756d-05,9.02003955128439d-06,0d0,0d0,0d0,2.3258181198232944d-06,0d0, &
    0.00013189839952537096d0,-2.270089868251734d-05,0d0,-4.534307525218833d-05,0d0,0d0,0d0,-1.7340383469462388d-05, &
    -0.0006747783132746656d0,-0.0001381574806680973d0,-0.00018447681601576138d0,0d0,1.5349732142475964d-06, &
    -8.665228047413775d-06,-5.494916708499865d-07,1.9237815315294284d-05,1.097012285050994d-05, &
    -2.0338131111999427d-06,-1.0239208843934518d-05,0d0,-0.0003182376980905307d0,-0.00021565923253609256d0,0d0, &
    -4.405948615077425d-05,0d0,0.00044910871724671345d0,0.0002237100766717974d0,0.000127761241933239d0, &
    6.690426386864721d-06,-1.413994928354752d-05,0d0,-4.7353385367356236d-05,0d0,1.0368831695694732d-05,0d0 /
  data (a_even(i, 7), i = 1, 50) / &
    -5.9094071495081276d-06,-0.0007340155277822909d0,0.0009725903550895344d0,-0.0018593633958978208d0,0d0, &
    7.982832619360657d-05,4.170925342104466d-07,0d0,9.064220352124106d-05,0d0,0d0,0d0,8.172957619452413d-05, &
    -1.1593488645284852d-05,0d0,0d0,1.9154708603424645d-05,0d0,0d0,-5.335028990731746d-07,0d0, &
    -0.00025375715034992973d0,-2.1095293806051198d-05,0d0,-0.0002861891688229227d0,0d0,9.823912925108438d-05, &
    6.491316905253625d-06,0.00015319262954673277d0,1.0018121380573444d-06,4.8035717642893445d-05,0d0, &
    1.519357862409607d-05,0d0,0d0,0d0,-8.850339411369497d-05,0d0,0d0,2.6946593935245304d-06,0d0, &
    -1.2898126289489346d-05,0d0,-1.6915062839355492d-06,0d0,0d0,0d0,0.0005632559673549528d0,0d0, &
    1.2405463068561448d-06 /

  ! Harmonics of the odd modes: nu; their first rows in a, and the end; monomial of every row; coefficients
  integer, save :: nu_odd(16, seeds), starts_odd(17), which_odd(50)
  real(rk), save :: a_odd(50, 8)
  data (nu_odd(i, 1), i = 1, 16) / &
    0,0,0,0,2,2,2,2,2,2,4,4,4,4,6,6 /
  data (nu_odd(i, 2), i = 1, 16) / &
    1,3,5,7,-5,-3,-1,1,3,5,-3,-1,1,3,-1,1 /
  data (starts_odd(i), i = 1, 17) / &
    1,11,17,20,21,22,25,31,37,40,41,42,45,48,49,50,51 /
  data (which_odd(i), i = 1, 50) / &
    1,2,3,4,9,10,11,15,16,19,2,3,4,10,11,16,3,4,11,4,11,10,11,16,9,10,11,15,16,19,9,10,11,15,16,19,10,11,16,11,16,15, &
    16,19,15,16,19,16,19,19 /
  data (a_odd(i, 1), i = 1, 50) / &
    0d0,0d0,0d0,0d0,0.005410011379124535d0,0.0009079242592353203d0,0.0008973446203084002d0,0.0006457658323512312d0, &
    0.0021074863646413857d0,0.00038843931849321116d0,0d0,0d0,0d0,0.00011633928504664656d0,9.823666597936748d-05, &
    0.00014918949094418834d0,0d0,0d0,1.493840932524506d-06,0d0,1.1417748062893117d-05,0.0006406077673136705d0, &
    0.0006716564928490624d0,0.0007147848318079309d0,0.4631702976827162d0,0.4500343854291488d0,0.44088311832364774d0, &
    0.25028488482767186d0,0.60713197874246d0,0.14142834125740547d0,0.00044645724586459397d0,0.00014004222864397528d0, &
    0.0001287903708169865d0,1.3573619908172651d-05,0.00011169689734870887d0,1.683622152980671d-06, &
    5.7158005971684595d-06,1.4935220783225336d-06,4.566356057777404d-06,8.879836396055359d-08, &
    -0.023063950277129572d0,0.00025808616289760327d0,0.0002993635788049711d0,0.00015182059908937475d0, &
    6.86492697103418d-06,9.867370649748856d-06,1.1604171725472173d-06,3.6245521760635186d-07,3.1650377382805764d-06, &
    1.62831752812008d-07 /
  data (a_odd(i, 2), i = 1, 50) / &
    1.1498786069760638d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0.0008887424637014205d0,8.526647698611387d-06, &
    5.751947868066146d-07,0.000436641675990056d0,0.00032693810109337334d0,0.0004508981344135604d0, &
    2.847705513285098d-06,1.0414110587947528d-07,5.585831770639417d-06,2.4337872051934457d-08,5.6103248468157786d-05, &
    0.001573458856569919d0,0.0017247972891764728d0,0.0020383744279328115d0,-0.016116252520412377d0, &
    -0.0026740125751768965d0,-0.002661045805790524d0,-0.001997900218131126d0,-0.0057281647742176535d0, &
    -0.0011898418460394241d0,0.0031671652854853394d0,-4.8229496373475616d-05,-5.95199870126757d-06, &
    0.00010289600255685413d0,0.00013947037756880754d0,2.3186012663611328d-05,2.9579959760162796d-05, &
    2.1884172689909303d-06,1.0426833516924296d-05,5.43462085912931d-07,-0.0006015194781860019d0, &
    0.0004037525268715705d0,0.0006043995737528794d0,0.00027829796116282175d0,2.638286569840342d-05, &
    1.531386887535959d-05,3.643684976241d-06,1.5707754532595737d-06,5.042397615703901d-06,6.988126580342836d-07 /
  data (a_odd(i, 3), i = 1, 50) / &
    0d0,0d0,0d0,0d0,0d0,-0.002550429389049733d0,-0.00292400980095204d0,-0.0007977782828423099d0, &
    -0.0045532082258904465d0,-0.0004958696944645766d0,0d0,0d0,0d0,0.0008082171436306321d0,0.0006335474219874454d0, &
    0.0011774044278056023d0,0d0,0d0,6.574975976493299d-06,0d0,0.00020211509540133811d0,0.045845317410093914d0, &
    0.06277318447343495d0,0.0673526805958048d0,0d0,-0.003060979486600142d0,-0.00329812061866441d0, &
    -0.0013630205880446427d0,-0.003979515545515355d0,-0.0007532053926835357d0,0d0,0.00039541706089236484d0, &
    0.0004814881498143094d0,8.5933851642821d-05,0.0006366711826372068d0,3.1787612548011025d-05,8.086722764136753d-06, &
    3.5302772341762126d-06,2.8941203784045678d-05,2.4092454851090655d-07,-0.0009456797142795032d0, &
    0.008141669712635385d0,0.011453755678213953d0,0.0059460328189251035d0,3.583696133473631d-05,9.25440908088544d-05, &
    6.568459991276992d-06,1.2934353232417763d-06,4.9530247938499445d-05,4.962463558345477d-07 /
  data (a_odd(i, 4), i = 1, 50) / &
    0d0,0d0,0d0,0d0,-0.00837179944366146d0,0.0004001568311743342d0,-7.834077790547438d-06,0.0001693775998696097d0, &
    -0.0002770543729719465d0,-5.691696931409394d-05,0d0,0d0,0d0,7.51505133205173d-05,3.728714760900149d-05, &
    4.1237652076196924d-05,0d0,0d0,1.1441135030017723d-05,0d0,-2.807342050886771d-06,-0.000904599687926032d0, &
    -0.0008894192092993597d0,-0.0008940269612620331d0,-0.003382011945903908d0,-0.0009664933063921881d0, &
    -0.0009472504102443814d0,0.00021770631546660915d0,-0.0005168568783511007d0,-4.904978599968892d-06, &
    0.01997837004852909d0,0.006133437003613427d0,0.0039057113550134436d0,0.002932019130007617d0, &
    0.005512678972821207d0,0.0006447956088451786d0,0.00014902875149399057d0,3.476847496436016d-05, &
    4.7000094645667555d-05,9.28304172249559d-07,-0.0001655501800134619d0,-7.184508968299486d-05, &
    -0.000170829605926407d0,-5.8450833425849903d-05,0.0001999549671095648d0,0.00013007307624778166d0, &
    3.401587221063637d-05,3.471696979122892d-06,1.4521915393231646d-05,1.6319641088662708d-06 /
  data (a_odd(i, 5), i = 1, 50) / &
    0d0,-0.003157560436735104d0,9.003413115274546d-05,-6.580937321148392d-06,0d0,-0.0010083886444433097d0, &
    -0.0010785244559127873d0,0d0,-0.0014459704863846565d0,1.9866940612670614d-06,0.003149558818049213d0, &
    0.00015209074967819606d0,1.5168883447452334d-05,0.00472559270430846d0,0.0038553920817855736d0, &
    0.0058817151530472156d0,1.6153738549459205d-05,7.807133733962935d-07,4.3440450930662836d-05, &
    6.309979658872427d-08,-1.3634916516364294d-05,-0.0018278751501550662d0,-0.0014578242975025306d0, &
    -0.0025760805610050147d0,0d0,-0.0008497570216632526d0,-0.0009195589193968935d0,0d0,-0.001192394552498642d0, &
    -5.1072277330130025d-06,0d0,0.00029090471597244537d0,-0.00010029957492554982d0,0d0,-9.823164474131066d-05, &
    -3.780231399303351d-05,0.00012526328637954762d0,1.2523860002675868d-05,0.00010615581734161036d0, &
    1.175935796204984d-06,-9.430664270659937d-05,0d0,-3.653669555756787d-05,-0.00010676890751338492d0,0d0, &
    5.692896078008398d-05,-2.7551304180057174d-07,2.1998631429237163d-06,0.00014725127520194488d0, &
    9.163810703332781d-07 /
  data (a_odd(i, 6), i = 1, 50) / &
    0d0,0d0,0d0,6.868356563220691d-07,0d0,0d0,-0.0001770836682609037d0,7.706881619740112d-05,2.580731581364804d-06, &
    -1.693779622044248d-05,0d0,0d0,-8.667658853761808d-05,0d0,0.0018579230361394819d0,-0.0015528887860535607d0,0d0, &
    2.420151321711951d-07,1.784393237378454d-05,-5.021834306179765d-08,0.0006246714248362427d0,0d0, &
    -0.0005475275753914304d0,3.9466171348902384d-05,0d0,0d0,-8.454843504000882d-05,2.1921799442847762d-05, &
    -7.733256469685714d-06,-1.9112803728044726d-05,0d0,0d0,-3.983045213221539d-06,-0.0004758529251763336d0, &
    -0.0003090048592193651d0,-7.144829907659624d-05,0d0,7.815694867981513d-06,-7.152725239763975d-06, &
    1.4445815540775276d-07,-3.0539508703822035d-06,-9.496703785635733d-05,-0.0002132644281363984d0, &
    -1.3653860349815632d-05,0.0003468067813127862d0,0.00042538575012397234d0,6.489139020568414d-05, &
    7.071758761104191d-06,-0.00017843477844738573d0,5.910229012242176d-06 /
  data (a_odd(i, 7), i = 1, 50) / &
    0d0,0d0,0d0,0d0,0d0,0.00018667118961051483d0,-2.247443801084666d-05,0d0,-4.661656790214277d-06,0d0,0d0,0d0,0d0, &
    -0.0005163875675954658d0,-9.341254772110104d-05,-0.00037662386475206165d0,0d0,0d0,-1.5131982115783428d-06,0d0, &
    4.716602079885391d-06,5.0185136063225175d-05,1.009427446187154d-05,5.87614160402291d-05,0d0, &
    6.034866306011516d-05,-5.751743875442107d-06,0d0,-1.4006771378400253d-05,0d0,0d0,-0.0004132165264094225d0, &
    -0.00012004140564839629d0,0d0,-0.0001221013248870991d0,0d0,0.0002950197243677654d0,6.173147380672512d-05, &
    0.00017967382489409673d0,9.65157577083743d-07,1.4721752466610398d-06,0d0,-4.959652401155428d-05,0d0,0d0, &
    -3.666457050532383d-05,0d0,9.67323570306563d-06,0d0,0d0 /
  data (a_odd(i, 8), i = 1, 50) / &
    0d0,0d0,3.368644528215712d-05,-3.0926285234181836d-06,0d0,0d0,3.9427606614753255d-05,0d0,9.768788136971393d-06, &
    -2.4893478344818403d-06,0d0,-6.831860921770245d-05,-2.188682701458237d-06,0d0,-0.00016904563513303047d0, &
    -6.831055192262742d-05,1.3263604350547352d-05,2.261062819801562d-07,5.616706899653524d-05,1.179349301255772d-07, &
    -2.405097531217726d-05,0d0,7.228641447055683d-05,2.8473126515878782d-06,0d0,0d0,2.015594271328636d-05,0d0, &
    3.9148325088557396d-06,-8.998370575933411d-07,0d0,0d0,-5.094612588283795d-05,0d0,-5.070300916755103d-05, &
    1.5245923579409232d-05,0d0,-1.9122031608327445d-06,1.1721946815361116d-05,1.4201938393787567d-06, &
    1.1308797965693078d-07,0d0,-8.581002488196918d-06,4.137165084787386d-06,0d0,-1.148084646102274d-05, &
    4.967248619011219d-06,-1.0674782724165068d-05,-3.6376389003077184d-06,5.4040257582759836d-06 /

contains

  ! Mode coordinates Q(q, i) = Q_q(t(i)).
  subroutine positions(t, amplitudes, Q, phases, frequencies)
    real(rk), intent(in) :: t(:), amplitudes(:)
    real(rk), intent(out) :: Q(:, :)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(in), optional :: frequencies(:)
    call evaluate(t, amplitudes, phases, frequencies, Q=Q)
  end subroutine positions

  ! Mode momenta P(q, i) = dQ_q/dt at t(i).
  subroutine momenta(t, amplitudes, P, phases, frequencies)
    real(rk), intent(in) :: t(:), amplitudes(:)
    real(rk), intent(out) :: P(:, :)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(in), optional :: frequencies(:)
    call evaluate(t, amplitudes, phases, frequencies, P=P)
  end subroutine momenta

  ! Coordinates and momenta at the cost of little more than one of them.
  subroutine orbit(t, amplitudes, Q, P, phases, frequencies)
    real(rk), intent(in) :: t(:), amplitudes(:)
    real(rk), intent(out) :: Q(:, :), P(:, :)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(in), optional :: frequencies(:)
    call evaluate(t, amplitudes, phases, frequencies, Q, P)
  end subroutine orbit

  ! Frequencies omega(A), and their derivatives: jacobian(i, j) = d omega(i) / d amplitudes(j).
  subroutine corrected_frequencies(amplitudes, omega, jacobian)
    real(rk), intent(in) :: amplitudes(:)
    real(rk), intent(out) :: omega(:)
    real(rk), intent(out), optional :: jacobian(:, :)
    real(rk) :: power(0:degree, seeds), slope
    integer :: f, j, k
    if (size(amplitudes) /= seeds) error stop 'beta_torus_series: amplitudes must have size 2'
    if (size(omega) /= seeds) error stop 'beta_torus_series: omega must have size 2'
    if (present(jacobian)) then
      if (any(shape(jacobian) /= seeds)) error stop 'beta_torus_series: jacobian must have shape (2, 2)'
    end if
    call fill_amplitude_powers(amplitudes, power)
    omega = linear
    if (present(jacobian)) jacobian = 0
    do f = 1, corrections
      omega = omega + correction(f, :) * product([(power(even_powers(f, j), j), j = 1, seeds)])
      if (.not. present(jacobian)) cycle
      do k = 1, seeds
        if (even_powers(f, k) == 0) cycle
        slope = even_powers(f, k) * scales(k)
        do j = 1, seeds
          slope = slope * power(even_powers(f, j) - merge(1, 0, j == k), j)
        end do
        jacobian(:, k) = jacobian(:, k) + correction(f, :) * slope
      end do
    end do
  end subroutine corrected_frequencies

  ! The sums over all harmonics, at blocks of times.
  subroutine evaluate(t, amplitudes, phases, frequencies, Q, P)
    real(rk), intent(in) :: t(:)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(out), optional :: Q(:, :), P(:, :)
    real(rk), allocatable :: re(:, :, :), im(:, :, :), cosine_sums(:, :), sine_sums(:, :)
    real(rk), intent(in) :: amplitudes(:)
    real(rk), intent(in), optional :: frequencies(:)
    real(rk), allocatable :: monomial(:)
    real(rk), allocatable :: c_even(:, :), rates_even(:)
    real(rk), allocatable :: c_odd(:, :), rates_odd(:)
    real(rk) :: phi(seeds), omega(seeds), turns(3, seeds), power(0:degree, seeds)
    integer :: j
    integer :: first, last, n, seed, k
    logical :: moving(2)
    moving = [present(Q), present(P)]
    if (size(amplitudes) /= seeds) error stop 'beta_torus_series: amplitudes must have size 2'
    if (present(frequencies)) then
      if (size(frequencies) /= seeds) error stop 'beta_torus_series: frequencies must have size 2'
      omega = frequencies
    else
      call corrected_frequencies(amplitudes, omega)
    end if
    phi = 0
    do seed = 1, seeds
      turns(:, seed) = turns_of(omega(seed))
    end do
    call fill_amplitude_powers(amplitudes, power)
    allocate (monomial(monomials))
    do k = 1, monomials
      monomial(k) = product([(power(exponents(k, j), j), j = 1, seeds)])
    end do
    allocate (c_even(16, 7), rates_even(16))
    call collapse(monomial, starts_even, which_even, a_even, nu_even, omega, c_even, rates_even)
    allocate (c_odd(16, 8), rates_odd(16))
    call collapse(monomial, starts_odd, which_odd, a_odd, nu_odd, omega, c_odd, rates_odd)
    if (present(phases)) then
      if (size(phases) /= seeds) error stop 'beta_torus_series: phases must have size 2'
      phi = phases
    end if
    if (present(Q)) then
      if (size(Q, 1) /= modes .or. size(Q, 2) /= size(t)) &
        error stop 'beta_torus_series: Q must have shape (15, size(t))'
    end if
    if (present(P)) then
      if (size(P, 1) /= modes .or. size(P, 2) /= size(t)) &
        error stop 'beta_torus_series: P must have shape (15, size(t))'
    end if
    n = min(times, size(t))
    allocate (re(n, -highest:highest, seeds), im(n, -highest:highest, seeds), cosine_sums(n, modes), sine_sums(n, modes))
    do first = 1, size(t), times
      last = min(first + times - 1, size(t))
      n = last - first + 1
      do seed = 1, seeds
        do k = 1, n
          re(k, 0, seed) = angle(t(first + k - 1), phi(seed), turns(:, seed))
        end do
        call fill_powers(re(1:n, :, seed), im(1:n, :, seed))
      end do
      cosine_sums = 0
      sine_sums = 0
      call add_harmonics(nu_even, rates_even, c_even, re, im, &
        cosine_sums(1:n, 2::2), sine_sums(1:n, 2::2), moving)
      call add_harmonics(nu_odd, rates_odd, c_odd, re, im, &
        cosine_sums(1:n, 1::2), sine_sums(1:n, 1::2), moving)
      if (present(Q)) Q(:, first:last) = transpose(cosine_sums(1:n, :))
      if (present(P)) P(:, first:last) = transpose(sine_sums(1:n, :))
    end do
  end subroutine evaluate

  ! omega t + phi, modulo 2 pi.
  function angle(t, phi, turns_per_time) result(theta)
    real(rk), intent(in) :: t, phi, turns_per_time(3)
    real(rk) :: theta, turn
    turn = fraction_of(t, turns_per_time) + fraction_of(phi, radian)
    theta = two_pi * (turn - anint(turn))
  end function angle

  ! x times a factor in three parts, modulo 1: x is cut in two, so that the large products are exact.
  function fraction_of(x, factor) result(turn)
    real(rk), intent(in) :: x, factor(3)
    real(rk) :: turn, high, low, part(4)
    high = real(real(x, single), rk)
    low = x - high
    part = [high * factor(1), low * factor(1), high * factor(2), low * factor(2)]
    part = part - anint(part)
    turn = part(1) + (part(2) + (part(3) + (part(4) + x * factor(3))))
    turn = turn - anint(turn)
  end function fraction_of

  ! omega / (2 pi) in three parts; the first two are short, so that their products with halves of a time are exact.
  function turns_of(omega) result(turns)
    real(rk), intent(in) :: omega
    real(rk) :: turns(3), high, low, unit, part(5), whole(5)
    integer :: k
    high = real(real(omega, single), rk)
    low = omega - high
    part = [high * radian(1), low * radian(1), high * radian(2), low * radian(2), omega * radian(3)]
    unit = scale(1d0, exponent(omega) - 26)
    do k = 1, 2
      whole = unit * anint(part / unit)
      turns(k) = sum(whole)
      part = part - whole
      unit = unit / 4194304
    end do
    turns(3) = sum(part)
  end function turns_of

  ! x^n for n = 0 .. degree, x the scaled amplitudes, in which the coefficients are of moderate size.
  subroutine fill_amplitude_powers(amplitudes, power)
    real(rk), intent(in) :: amplitudes(:)
    real(rk), intent(out) :: power(0:degree, seeds)
    integer :: n
    power(0, :) = 1
    do n = 1, degree
      power(n, :) = power(n - 1, :) * (scales * amplitudes)
    end do
  end subroutine fill_amplitude_powers

  ! Harmonics c(h, :) = sum over the rows r of h of a(r, :) times monomial which(r), and their rates nu.omega.
  subroutine collapse(monomial, starts, which, a, nu, omega, c, rates)
    real(rk), intent(in) :: monomial(:), a(:, :), omega(:)
    integer, intent(in) :: starts(:), which(:), nu(:, :)
    real(rk), intent(out) :: c(:, :), rates(:)
    integer :: h, r, m, j
    c = 0
    do m = 1, size(c, 2)
      do h = 1, size(c, 1)
        do r = starts(h), starts(h + 1) - 1
          c(h, m) = c(h, m) + monomial(which(r)) * a(r, m)
        end do
      end do
    end do
    rates = 0
    do j = 1, seeds
      rates = rates + nu(:, j) * omega(j)
    end do
  end subroutine collapse

  ! e^(i m theta) for |m| <= highest, from theta in re(:, 0).
  subroutine fill_powers(re, im)
    real(rk), intent(inout) :: re(:, -highest:), im(:, -highest:)
    integer :: m, a, b
    re(:, 1) = cos(re(:, 0))
    im(:, 1) = sin(re(:, 0))
    do m = 2, highest
      a = m / 2
      b = m - a
      re(:, m) = re(:, a) * re(:, b) - im(:, a) * im(:, b)
      im(:, m) = re(:, a) * im(:, b) + im(:, a) * re(:, b)
    end do
    re(:, 0) = 1
    im(:, 0) = 0
    do m = 1, highest
      re(:, -m) = re(:, m)
      im(:, -m) = -im(:, m)
    end do
  end subroutine fill_powers

  ! Adds the harmonics of one parity: c cos(nu.theta) to Q, and -(nu.omega) c sin(nu.theta) to P, as asked for.
  subroutine add_harmonics(nu, rates, c, re, im, Q, P, wanted)
    integer, intent(in) :: nu(:, :)
    real(rk), intent(in) :: rates(:), c(:, :)
    real(rk), intent(in) :: re(:, -highest:, :), im(:, -highest:, :)
    real(rk), intent(inout) :: Q(:, :), P(:, :)
    logical, intent(in) :: wanted(2)
    real(rk), allocatable :: cosine(:, :), sine(:, :), a(:, :), b(:, :)
    integer :: first, last, n, h, j, k, m
    n = size(Q, 1)
    allocate (cosine(n, tile), sine(n, tile), a(n, seeds), b(n, seeds))
    do first = 1, size(nu, 1), tile
      last = min(first + tile - 1, size(nu, 1))
      do h = first, last
        j = 1  ! the first seed whose number differs from the harmonic before
        if (h > 1) then
          do while (j < seeds .and. nu(h, j) == nu(h - 1, j))
            j = j + 1
          end do
        end if
        if (j == 1) then
          a(:, 1) = re(1:n, nu(h, 1), 1)
          b(:, 1) = im(1:n, nu(h, 1), 1)
          j = 2
        end if
        do j = j, seeds
          m = nu(h, j)
          do k = 1, n
            a(k, j) = a(k, j - 1) * re(k, m, j) - b(k, j - 1) * im(k, m, j)
            b(k, j) = a(k, j - 1) * im(k, m, j) + b(k, j - 1) * re(k, m, j)
          end do
        end do
        cosine(:, h - first + 1) = a(:, seeds)
        sine(:, h - first + 1) = -rates(h) * b(:, seeds)
      end do
      if (wanted(1)) Q = Q + matmul(cosine(:, :last - first + 1), c(first:last, :))
      if (wanted(2)) P = P + matmul(sine(:, :last - first + 1), c(first:last, :))
    end do
  end subroutine add_harmonics

end module beta_torus_series

#ifdef BETA_TORUS_SERIES_SELF_TEST
program beta_torus_series_self_test
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use beta_torus_series, only: orbit, corrected_frequencies
  implicit none
  real(rk), save :: t(4), positions_of_t(15, 4), momenta_of_t(15, 4)
  real(rk), save :: amplitudes(2), phases(2), frequencies(2), exact_omega(2), exact_slopes(2, 2)
  real(rk) :: Q(15, 4), P(15, 4), omega(2), slopes(2, 2), found(4)
  integer :: i
  data (t(i), i = 1, 4) / &
    0d0,2.75d0,-13.0625d0,160.5d0 /
  data (amplitudes(i), i = 1, 2) / &
    0.25439453125d0,0.128173828125d0 /
  data (phases(i), i = 1, 2) / &
    0.5d0,0.125d0 /
  data (frequencies(i), i = 1, 2) / &
    0.3934764862060547d0,0.5864534378051758d0 /
  data (exact_omega(i), i = 1, 2) / &
    0.3903225922364747d0,0.5807982980735177d0 /
  data (positions_of_t(i, 1), i = 1, 15) / &
    0.0007634460509301834d0,0.22326749815351632d0,0.127152748999394d0,0.0003242039604266192d0,8.51768599929871d-07, &
    -1.0109821515804954d-05,-4.446886441023421d-06,3.9853674154002814d-07,-2.2847023570915476d-07, &
    -3.3315744413955284d-09,-1.5097513122259932d-08,-1.518461241584868d-08,-1.05700451672185d-08, &
    -1.7868602987400648d-08,-3.9027925066734196d-10 /
  data (positions_of_t(i, 2), i = 1, 15) / &
    0.00016628466202986707d0,-0.00286870793615945d0,-0.021303135907921978d0,-0.00011186697010533983d0, &
    -7.22823445856218d-07,1.3202000635814112d-06,1.1571897627134912d-05,1.1141722161569662d-05, &
    2.9220897638965134d-06,3.4305503205903724d-08,-8.803000232273546d-09,-1.7891119465396978d-08, &
    -1.6121526797295257d-08,-1.4856488827488497d-08,-9.330090193827453d-10 /
  data (positions_of_t(i, 3), i = 1, 15) / &
    -0.0001978614100803048d0,-0.018458017631426824d0,0.04013098143027455d0,-0.0001869322023803936d0, &
    1.043042144984591d-06,8.427805474406224d-06,-2.7199464852087692d-05,2.145856676678359d-05,-5.102621929977346d-06, &
    5.1412484362892294d-08,2.3583901257029196d-08,-3.758112917524491d-08,2.9632634155460427d-08, &
    -2.3982774026566005d-08,1.5385167950856827d-09 /
  data (positions_of_t(i, 4), i = 1, 15) / &
    -6.667654942845726d-05,0.1733520813722706d0,0.12817661958990903d0,0.0002284437078257197d0,-6.373358380940141d-07, &
    -3.6297815465842816d-05,-2.3728460466034857d-05,3.5893106712144513d-06,1.1583660058142818d-07, &
    6.5450055259343656d-09,-8.191293205386868d-09,-1.6591390803068574d-08,-1.0358321429495342d-08, &
    -1.2495161707813481d-08,-4.291273342866579d-10 /
  data (momenta_of_t(i, 1), i = 1, 15) / &
    -0.00018233812549022627d0,-0.047995036479096934d0,-0.009375882855269626d0,7.056114102761198d-05, &
    3.9937415396430295d-07,-3.760242864421288d-05,-5.86981628070412d-05,-2.6198914592678795d-05, &
    -2.637504763303559d-06,-1.0718197042001297d-08,2.0611793193421416d-09,2.097893572320556d-09, &
    3.551831896110832d-09,3.294681711866335d-11,4.114557601038758d-10 /
  data (momenta_of_t(i, 2), i = 1, 15) / &
    -0.00023830564587465366d0,-0.10009283945281024d0,-0.07410250628304202d0,-0.0002483481288887493d0, &
    -6.566920077731828d-07,4.5941847581354466d-05,8.044759304201435d-05,4.756482321643334d-05,9.572049195995568d-06, &
    6.526799131171247d-08,-8.352179809453371d-08,-1.0261966674917262d-07,-6.731227652100448d-08, &
    -4.482684582741538d-08,-2.916905653441316d-09 /
  data (momenta_of_t(i, 3), i = 1, 15) / &
    0.00023708200690003708d0,-0.09983527770769532d0,0.0713703368038318d0,-0.0002205200276183809d0, &
    3.8704773171652755d-07,4.499524397317009d-05,-7.403177809892439d-05,3.973679052344927d-05,-7.089077863776016d-06, &
    3.1264326644718935d-08,7.390206823985598d-08,-8.191515321117061d-08,4.7225577127027496d-08, &
    -2.4567725181305957d-08,1.6839217475033955d-09 /
  data (momenta_of_t(i, 4), i = 1, 15) / &
    -0.00023545542333586918d0,-0.07326169545490067d0,-0.00022797138171758207d0,0.00020677310866798083d0, &
    1.5035859088712922d-06,-2.127210169359098d-05,-6.62412305120137d-05,-3.0111399131968904d-05, &
    -1.3643220548058017d-07,5.012223749801704d-08,4.0984059070847206d-08,1.5685273938629895d-08, &
    -4.386410426083579d-09,-2.0545579290022283d-08,5.0361766518236343d-11 /
  data (exact_slopes(1, i), i = 1, 2) / &
    0.0006379339250966169d0,0.0009503095167417594d0 /
  data (exact_slopes(2, i), i = 1, 2) / &
    0.0012675696724229707d0,0.0010607468461031535d0 /
  call orbit(t, amplitudes, Q, P, phases, frequencies)
  call corrected_frequencies(amplitudes, omega, slopes)
  found = [deviation(reshape(Q, [size(Q)]), reshape(positions_of_t, [size(Q)])), &
    deviation(reshape(P, [size(P)]), reshape(momenta_of_t, [size(P)])), deviation(omega, exact_omega), &
    deviation(reshape(slopes, [size(slopes)]), reshape(exact_slopes, [size(slopes)]))]
  print '(a, 4(es9.2, a))', 'largest deviation: ', found(1), ' of the largest coordinate, ', found(2), &
    ' of the largest momentum, ', found(3), ' of the largest frequency, ', found(4), ' of the largest derivative'
  if (.not. all(found <= 1d-13)) error stop 'the deviation is above 1d-13'

contains

  ! Largest deviation relative to the largest expected value; NaN if a value is none.
  function deviation(values, expected) result(worst)
    real(rk), intent(in) :: values(:), expected(:)
    real(rk) :: worst
    worst = maxval(abs(values - expected))
    if (.not. all(abs(values) <= huge(worst))) worst = sum(values)
    if (maxval(abs(expected)) > 0) worst = worst / maxval(abs(expected))
  end function deviation
end program beta_torus_series_self_test
#endif
