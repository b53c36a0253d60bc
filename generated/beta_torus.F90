! Machine-written: a quasi-periodic solution of an FPU chain,
!
!     Q_q(t) = sum over nu of c_q[nu] cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1.
!
!  written by: symfpu 0.1.0
!  made by: symfpu export beta_torus.symfpu --lang fortran -o beta_torus
!  orders: frequencies 4, coordinates 4
!  amplitudes: A_2 = 1.0698561286266385574614614919, A_3 = 0.475072727565501947642675048312
!  chain: Chain(N=16, beta=0.6)
!  seeds: 2, 3
!  frequencies: 0.3925, 0.5845
!  precision: 30 digits
!  hash of the coefficients: 816ffccbf87cd120a22414d1e438a6fc46961271b76e7510d561bae48db510b3
!
! How to call. Compile this file before your program, which says
!
!     use beta_torus, only: positions, momenta, orbit, harmonic_energies, energy
!     use, intrinsic :: iso_fortran_env, only: real64
!     real(real64) :: t(n), Q(15, n), P(15, n), E(15, n), H(n), phases(2)
!     call positions(t, Q)                 ! or positions(t, Q, phases)
!     call momenta(t, P)                   ! or momenta(t, P, phases)
!     call orbit(t, Q, P)                  ! or orbit(t, Q, P, phases)
!     call harmonic_energies(t, E)         ! or harmonic_energies(t, E, phases)
!     call energy(t, H)                    ! or energy(t, H, phases)
!
!   t        n times, any real numbers
!   Q, P, E  (N-1, n) = (15, n): Q(q, i) is mode q at time t(i); in memory the time is slowest, as in the C files
!   H        (n)
!   phases   (2): angles phi in radians, one a seed in the order above; left out, they are
!     0.0, 0.0
!
! Two such modules in one program:
! use beta_torus, only: beta_torus_positions => positions.
! All quantities are dimensionless. E_q = (P_q**2 + Omega_q**2 Q_q**2) / 2 is the energy of mode q, H the total energy.
! Arrays of other shapes stop the program. Tables are only read and work arrays are allocated by each call: the
! procedures may be called from several threads.
!
! Accuracy: omega t is reduced to one turn without loss up to |t| of about 1e14; the sums are those of doubles, some
! 1e-15 of the largest coordinate. A time that is not finite, or above 1e38, gives NaN. Compile without -ffast-math.
!
! Self-test: gfortran -std=f2008 -O2 -DBETA_TORUS_SELF_TEST FILE.F90 && ./a.out
! prints the largest deviation from embedded vectors and fails above 1d-13.

module beta_torus
  use, intrinsic :: iso_fortran_env, only: rk => real64, single => real32
  implicit none
  private
  public :: positions, momenta, orbit, harmonic_energies, energy

  integer, parameter :: bonds = 16, modes = 15, seeds = 2
  integer, parameter :: highest = 9  ! largest number in a harmonic
  integer, parameter :: times = 64, tile = 256  ! evaluated together, and harmonics of one matrix product
  real(rk), parameter :: two_pi = 6.283185307179586d0
  real(rk), parameter :: cubic = 0d0  ! alpha / 3
  real(rk), parameter :: quartic = 0.15d0  ! beta / 4
  integer :: i  ! of the tables

  ! omega / (2 pi) of every seed and 1 / (2 pi), in three parts each, exact in doubles
  real(rk), save :: turns(3, seeds), radian(3), default_phases(seeds), norm, omega(15)
  real(rk), save :: cosines(0:63)
  data (turns(i, 1), i = 1, 3) / &
    0.06246831640601158d0,-1.2424427042745378d-09,4.2142926285400364d-17 /
  data (turns(i, 2), i = 1, 3) / &
    0.0930260643362999d0,-9.908707188088783d-11,-6.024339816229183d-19 /
  data (radian(i), i = 1, 3) / &
    0.15915493667125702d0,6.4206382432985265d-09,7.34273885092955d-17 /
  data (default_phases(i), i = 1, 2) / &
    0d0,0d0 /
  ! sqrt(2/N), linear frequencies Omega_q, cos(k pi / 2N)
  data norm / 0.3535533905932738d0 /
  data (omega(i), i = 1, 15) / &
    0.1960342806591212d0,0.39018064403225655d0,0.5805693545089248d0,0.7653668647301796d0,0.9427934736519953d0, &
    1.1111404660392044d0,1.268786568327291d0,1.4142135623730951d0,1.546020906725474d0,1.6629392246050905d0, &
    1.76384252869671d0,1.8477590650225735d0,1.9138806714644176d0,1.9615705608064609d0,1.9903694533443939d0 /
  data (cosines(i), i = 0, 63) / &
    1d0,0.9951847266721969d0,0.9807852804032304d0,0.9569403357322088d0,0.9238795325112867d0,0.881921264348355d0, &
    0.8314696123025452d0,0.773010453362737d0,0.7071067811865476d0,0.6343932841636455d0,0.5555702330196022d0, &
    0.47139673682599764d0,0.3826834323650898d0,0.2902846772544624d0,0.19509032201612828d0,0.0980171403295606d0,0d0, &
    -0.0980171403295606d0,-0.19509032201612828d0,-0.2902846772544624d0,-0.3826834323650898d0,-0.47139673682599764d0, &
    -0.5555702330196022d0,-0.6343932841636455d0,-0.7071067811865476d0,-0.773010453362737d0,-0.8314696123025452d0, &
    -0.881921264348355d0,-0.9238795325112867d0,-0.9569403357322088d0,-0.9807852804032304d0,-0.9951847266721969d0, &
    -1d0,-0.9951847266721969d0,-0.9807852804032304d0,-0.9569403357322088d0,-0.9238795325112867d0, &
    -0.881921264348355d0,-0.8314696123025452d0,-0.773010453362737d0,-0.7071067811865476d0,-0.6343932841636455d0, &
    -0.5555702330196022d0,-0.47139673682599764d0,-0.3826834323650898d0,-0.2902846772544624d0,-0.19509032201612828d0, &
    -0.0980171403295606d0,0d0,0.0980171403295606d0,0.19509032201612828d0,0.2902846772544624d0,0.3826834323650898d0, &
    0.47139673682599764d0,0.5555702330196022d0,0.6343932841636455d0,0.7071067811865476d0,0.773010453362737d0, &
    0.8314696123025452d0,0.881921264348355d0,0.9238795325112867d0,0.9569403357322088d0,0.9807852804032304d0, &
    0.9951847266721969d0 /

  ! Harmonics of the even modes: nu, rates nu.omega, and coefficients of cos(nu.theta)
  integer, save :: nu_even(25, seeds)
  real(rk), save :: rates_even(25), c_even(25, 7)
  data (nu_even(i, 1), i = 1, 25) / &
    1,1,1,1,1,1,1,1,1,3,3,3,3,3,3,3,5,5,5,5,5,7,7,7,9 /
  data (nu_even(i, 2), i = 1, 25) / &
    -8,-6,-4,-2,0,2,4,6,8,-6,-4,-2,0,2,4,6,-4,-2,0,2,4,-2,0,2,0 /
  data (rates_even(i), i = 1, 25) / &
    -4.2835d0,-3.1145d0,-1.9455d0,-0.7765d0,0.3925d0,1.5615d0,2.7305d0,3.8995d0,5.0685d0,-2.3295d0,-1.1605d0, &
    0.0085d0,1.1775d0,2.3465d0,3.5155d0,4.6845d0,-0.3755d0,0.7935d0,1.9625d0,3.1315d0,4.3005d0,1.5785d0,2.7475d0, &
    3.9165d0,3.5325d0 /
  data (c_even(i, 1), i = 1, 25) / &
    2.8302238645434437d-12,4.980840942274048d-09,4.083386143622958d-06,0.0008748527521014925d0,1.0698561286266386d0, &
    0.00015616360920068525d0,2.2243671074463058d-07,5.113057553662059d-10,4.480187735897143d-13, &
    1.0652430162815639d-08,2.960595564387645d-06,-0.0001702384139898851d0,0.00035341054605683464d0, &
    1.320552447632199d-06,6.813313437661335d-09,1.5458661199630528d-11,-9.340230199554065d-06,3.431480537216844d-06, &
    1.1749247245010143d-06,1.962195442823033d-08,1.0383243917847236d-10,1.5790006420700413d-08, &
    1.0012140871614876d-08,1.5203296947858315d-10,3.470148020894801d-11 /
  data (c_even(i, 2), i = 1, 25) / &
    1.1991668604142802d-11,1.2951097495414267d-08,1.7333352233706366d-05,0.04149818785445686d0, &
    -0.001759396198140792d0,0.0002490905506518396d0,3.579435063455107d-07,8.807089238284664d-10, &
    7.085210087500059d-13,3.3131678898079446d-08,5.8498001966132635d-06,-0.0002802947943986869d0, &
    5.9845569878516725d-05,1.5405869286538477d-06,1.0959017741270891d-08,2.292042842946128d-11, &
    -3.318390116304304d-07,9.02660273664372d-05,1.0583485329712518d-06,2.800687229750416d-08,1.5699675405368226d-10, &
    1.1815684252480749d-07,7.428246465513957d-09,2.0197494248960037d-10,0d0 /
  data (c_even(i, 3), i = 1, 25) / &
    5.6444404461950915d-12,7.2322343550657104d-09,4.856237181096689d-06,-0.00011861667746938282d0, &
    -0.0011302707527465479d0,1.1175331351266614d-05,3.3157545244089587d-07,5.675696915547771d-10, &
    -1.0451545212671757d-12,8.707619602627386d-08,0.00013940059923382798d0,-7.920176752797836d-05, &
    0.0035007303841861183d0,6.319869530348747d-06,1.3046509965900474d-08,2.817362045262367d-11, &
    -3.850686195200686d-07,-1.9691888321354624d-06,9.605214577381939d-06,4.42927643390508d-08,2.6636237562889883d-10, &
    5.53266105891842d-08,2.0965182568491855d-08,4.509575490293856d-10,1.213740287854052d-10 /
  data (c_even(i, 4), i = 1, 25) / &
    -7.191867219761109d-13,1.1610164570607939d-08,2.4639349753312074d-07,-0.0005811466553832342d0, &
    -0.0006640074162311713d0,0.0018266030733849541d0,2.2640280525846628d-06,2.2495417084788124d-09, &
    1.9643074259425673d-12,-6.202091782998592d-09,-6.401092995949138d-06,-4.318163271063003d-05, &
    -3.0913799184634456d-06,1.2251366108941273d-05,2.5744089291530857d-08,8.331194149731643d-13, &
    -9.718901048525326d-08,-9.567824783547923d-07,1.2573168014227335d-06,6.254841383943915d-08,4.124878627329909d-10, &
    5.988266071391369d-07,1.209544764356208d-08,5.263761043519167d-10,0d0 /
  data (c_even(i, 5), i = 1, 25) / &
    4.187075353260169d-12,8.442189593040542d-08,7.323427680331526d-05,-4.946767675924288d-05,-1.8075401463140064d-05, &
    3.7831231156514445d-06,1.2973564161846178d-06,1.5488683711949387d-09,7.738860862355865d-13, &
    -5.911973641311906d-09,-1.0813325258725579d-05,-2.7375293512313928d-06,-2.124536285895287d-05, &
    3.1582563150254525d-07,1.4686865738447244d-08,3.2389518918416615d-11,-3.1983260303335005d-08, &
    -2.0170851071442853d-06,2.1500255999588858d-05,9.591353151412356d-08,-3.3807667121297066d-10, &
    2.245797265453711d-07,1.3177227950799216d-07,5.183144816162941d-10,1.689840434121323d-10 /
  data (c_even(i, 6), i = 1, 25) / &
    1.811618401882488d-11,2.704254236287319d-08,8.575621319606264d-07,5.178185817926572d-06,4.5825068681227415d-06, &
    -3.394841172937906d-05,-8.16697266792394d-08,-3.231935545945086d-09,-3.5994500394333412d-12, &
    2.4977450565549606d-07,2.4823283750471288d-08,2.4714793406078357d-07,-1.6233227225191674d-05, &
    2.4059441743512017d-05,6.18640256097962d-08,9.743142067955855d-12,-6.027835193931115d-09,-4.2468552446968934d-07, &
    -1.636589308329886d-06,2.0363586926848677d-07,6.235725165881385d-10,5.3276134758937136d-08, &
    -5.907577756299058d-09,-2.9701788456276883d-10,0d0 /
  data (c_even(i, 7), i = 1, 25) / &
    -4.918255811024869d-12,-3.4197772396439364d-08,-3.100505186200855d-05,2.5469846799117657d-06, &
    1.759103549344113d-06,-7.654207535519238d-06,3.6579309583370264d-06,6.4282981662010615d-09, &
    3.2115676974471955d-12,3.493460351787117d-09,6.453737794181994d-07,1.8144344200920993d-07,-8.960854626738402d-07, &
    -1.8325497266862355d-07,-1.4844575053507146d-08,-4.755709506453521d-11,-1.315805019684188d-09, &
    -7.311402393646674d-08,0.00024058804365274802d0,3.590858183219837d-08,-4.895623941996867d-10, &
    -2.3931825213310692d-08,1.6493991437518551d-07,5.417565862171922d-10,1.3369274288429567d-10 /

  ! Harmonics of the odd modes: nu, rates nu.omega, and coefficients of cos(nu.theta)
  integer, save :: nu_odd(25, seeds)
  real(rk), save :: rates_odd(25), c_odd(25, 8)
  data (nu_odd(i, 1), i = 1, 25) / &
    0,0,0,0,0,2,2,2,2,2,2,2,2,4,4,4,4,4,4,6,6,6,6,8,8 /
  data (nu_odd(i, 2), i = 1, 25) / &
    1,3,5,7,9,-7,-5,-3,-1,1,3,5,7,-5,-3,-1,1,3,5,-3,-1,1,3,-1,1 /
  data (rates_odd(i), i = 1, 25) / &
    0.5845d0,1.7535d0,2.9225d0,4.0915d0,5.2605d0,-3.3065d0,-2.1375d0,-0.9685d0,0.2005d0,1.3695d0,2.5385d0,3.7075d0, &
    4.8765d0,-1.3525d0,-0.1835d0,0.9855d0,2.1545d0,3.3235d0,4.4925d0,0.6015d0,1.7705d0,2.9395d0,4.1085d0,2.5555d0, &
    3.7245d0 /
  data (c_odd(i, 1), i = 1, 25) / &
    0.0009953635181760812d0,6.5149803912517255d-06,1.4482686430012026d-08,1.7496609805124955d-11,0d0, &
    1.0127392313002968d-10,1.1788069711715153d-07,3.493117081472463d-05,0.12085018845807008d0,7.961726619606619d-05, &
    2.4859929210365006d-07,7.986126043406925d-10,9.455460597937719d-13,6.03113674280751d-08, &
    -0.00046188147979332885d0,2.6406750550294628d-05,6.266974227820934d-07,5.33190083690273d-09, &
    1.869149133520751d-11,2.854122134320058d-08,1.3059425346348047d-07,6.588879083381528d-09,6.286478730431726d-11, &
    7.033722251326846d-10,3.325873953993893d-11 /
  data (c_odd(i, 2), i = 1, 25) / &
    0.47507272756550195d0,8.481492852437997d-05,8.055249067706336d-08,1.1678620304231895d-10,6.453728759560904d-14, &
    4.225496521527254d-10,5.967828775481525d-07,9.20905713628213d-05,-0.0029584662601610627d0, &
    0.0005201307886881595d0,1.0001418811028621d-06,3.734279380632517d-09,5.515737087920731d-12, &
    1.0891348522036124d-07,-1.2554047643560782d-05,4.5181734878291805d-05,2.025148735608004d-06, &
    2.112799349497293d-08,7.198583407804192d-11,4.58852251637184d-06,2.4315241659257655d-07,2.4945520311387698d-08, &
    2.1886626156282077d-10,1.700180160020992d-09,1.1976860505027806d-10 /
  data (c_odd(i, 3), i = 1, 25) / &
    -0.00023856921361186772d0,4.741095673391732d-05,6.539953356486206d-08,9.518819951093406d-11, &
    -4.333165264508764d-14,8.54366383818074d-10,1.8723817768151149d-06,0.002956851896509229d0, &
    -0.0002854428194644343d0,3.161382699317015d-05,7.799548892754158d-07,2.991271402613176d-09,2.770762865435438d-12, &
    7.245725950150871d-08,-1.861844389564753d-05,0.0009144039961961977d0,3.9206739262528386d-06, &
    2.1025866241011502d-08,7.255413747562109d-11,2.2696926374156594d-07,1.9583091929876805d-06, &
    2.3482447207916845d-08,2.661352918520233d-10,3.766067167601426d-09,1.3871897019758222d-10 /
  data (c_odd(i, 4), i = 1, 25) / &
    -0.0013375729998029555d0,3.057120805255016d-06,1.1059249898776605d-07,1.2928179755723584d-10,0d0, &
    2.3540353350946717d-11,1.9301599477709478d-07,-4.704778060185328d-05,-0.0005732411943593463d0, &
    0.0037185253449564986d0,5.062486258009248d-06,6.442533618935761d-09,-1.5689185650118984d-12, &
    3.2549529230664093d-06,-3.843471674355999d-06,-8.825623742604376d-06,1.5623200615841362d-05, &
    4.419091402756946d-08,1.7310587659540771d-10,-8.162460339697948d-08,6.32778452131202d-07,5.212487900429932d-08, &
    5.956016360303394d-10,-3.0949131198498935d-09,3.826522850236695d-10 /
  data (c_odd(i, 5), i = 1, 25) / &
    -0.0002811562393769177d0,0.00048406088616783656d0,5.55348108063357d-07,3.228331576572243d-10, &
    1.697442953620819d-13,1.4620582983927197d-09,-1.1479069636050233d-07,-0.00010577076721201259d0, &
    -5.0466867196192407d-05,5.266666749510718d-06,5.337088714488328d-06,9.274070572854422d-09,1.3759289892119817d-11, &
    -3.8939385078919517d-07,-2.0684852673771035d-06,-4.961133829543576d-06,1.0126982167652324d-06, &
    3.401192471426043d-08,-9.262626937440935d-11,-1.4426423624091982d-07,6.519971856222066d-06,8.366056190449163d-08, &
    4.5029506365139727d-10,1.922778739330407d-08,1.487846470631188d-10 /
  data (c_odd(i, 6), i = 1, 25) / &
    2.588002756212151d-06,2.0847935488983406d-07,1.7970442075056825d-07,-3.292605520369455d-10, &
    -1.9408980458885258d-13,5.939898287811301d-09,6.3927420695702d-06,-4.3602370870641405d-06, &
    -1.0361784114189189d-07,-3.682525579700871d-05,-5.6168487708882135d-08,3.746979390117346d-09, &
    -4.755916625704242d-12,-5.114533083147251d-07,-1.2935229212692226d-07,-9.650721736602926d-06, &
    3.0567805968382414d-05,1.0013362202225814d-07,1.659507609349946d-10,-3.6818358754527626d-08, &
    -1.625400990682938d-05,2.0249176202460143d-07,-3.02121922116108d-10,-1.688538883523966d-08,5.827927053250652d-10 /
  data (c_odd(i, 7), i = 1, 25) / &
    5.233747046496365d-06,-2.1565722933876097d-05,-5.197323022888742d-09,1.9929856646126717d-10,0d0, &
    -8.332706119415648d-10,5.865960794365492d-08,2.542950555286815d-06,1.6069324987741608d-06, &
    -1.3989075360497566d-05,1.1640080274532302d-05,4.0711736075900385d-09,-9.191680695900018d-12, &
    3.95976140563538d-08,2.213322347199751d-08,-9.131584113379427d-07,-5.725900461676669d-07,1.3524941746305954d-07, &
    1.914030149189337d-11,-1.3483893581001808d-08,-3.421874614899323d-08,6.72475032538973d-09,6.877149492263201d-10, &
    2.3435841858592774d-08,-5.666334299111087d-10 /
  data (c_odd(i, 8), i = 1, 25) / &
    7.777584924432812d-07,-2.910085780405204d-06,6.773398875033675d-07,7.379654536412667d-10,2.2042122454919518d-13, &
    -5.605442108340877d-09,-1.3646806531006528d-07,6.669804174611093d-07,1.8946141166543047d-07, &
    -5.323034479728007d-07,7.773321833281631d-08,1.3865182157445287d-08,1.2912535558524093d-11,4.915579377843706d-08, &
    5.098225839451471d-09,-6.937686542961933d-08,4.0281366008930695d-07,-1.5125966558332745d-07, &
    -2.94437532509943d-10,-9.286813050023111d-10,-4.507737197656399d-07,2.7805725432412127d-07, &
    -6.930977828492761d-10,-1.5810871398821956d-08,1.1611250890171977d-09 /

contains

  ! Mode coordinates Q(q, i) = Q_q(t(i)).
  subroutine positions(t, Q, phases)
    real(rk), intent(in) :: t(:)
    real(rk), intent(out) :: Q(:, :)
    real(rk), intent(in), optional :: phases(:)
    call evaluate(t, phases, Q=Q)
  end subroutine positions

  ! Mode momenta P(q, i) = dQ_q/dt at t(i).
  subroutine momenta(t, P, phases)
    real(rk), intent(in) :: t(:)
    real(rk), intent(out) :: P(:, :)
    real(rk), intent(in), optional :: phases(:)
    call evaluate(t, phases, P=P)
  end subroutine momenta

  ! Coordinates and momenta at the cost of little more than one of them.
  subroutine orbit(t, Q, P, phases)
    real(rk), intent(in) :: t(:)
    real(rk), intent(out) :: Q(:, :), P(:, :)
    real(rk), intent(in), optional :: phases(:)
    call evaluate(t, phases, Q, P)
  end subroutine orbit

  ! Harmonic energies E(q, i) = (P_q**2 + Omega_q**2 Q_q**2) / 2 at t(i).
  subroutine harmonic_energies(t, E, phases)
    real(rk), intent(in) :: t(:)
    real(rk), intent(out) :: E(:, :)
    real(rk), intent(in), optional :: phases(:)
    real(rk), allocatable :: Q(:, :), P(:, :)
    integer :: first, last, k
    if (size(E, 1) /= modes .or. size(E, 2) /= size(t)) error stop 'harmonic_energies: E must have shape (15, size(t))'
    allocate (Q(modes, times), P(modes, times))
    do first = 1, size(t), times
      last = min(first + times - 1, size(t))
      call evaluate(t(first:last), phases, Q(:, :last - first + 1), P(:, :last - first + 1))
      do k = first, last
        E(:, k) = (P(:, k - first + 1)**2 + (omega * Q(:, k - first + 1))**2) / 2
      end do
    end do
  end subroutine harmonic_energies

  ! Total energy H(i) at t(i), by the stretches of the bonds
  ! r_j = sqrt(2/N) sum_q Omega_q Q_q cos(q (2j - 1) pi / 2N).
  subroutine energy(t, H, phases)
    real(rk), intent(in) :: t(:)
    real(rk), intent(out) :: H(:)
    real(rk), intent(in), optional :: phases(:)
    real(rk), allocatable :: Q(:, :), P(:, :), stretch(:, :)
    real(rk) :: r(bonds)
    integer :: first, last, j, k, mode
    if (size(H) /= size(t)) error stop 'energy: H must have the size of t'
    allocate (Q(modes, times), P(modes, times), stretch(bonds, modes))
    do mode = 1, modes
      do j = 1, bonds
        stretch(j, mode) = norm * omega(mode) * cosines(mod(mode * (2 * j - 1), 4 * bonds))
      end do
    end do
    do first = 1, size(t), times
      last = min(first + times - 1, size(t))
      call evaluate(t(first:last), phases, Q(:, :last - first + 1), P(:, :last - first + 1))
      do k = 1, last - first + 1
        r = matmul(stretch, Q(:, k))
        H(first + k - 1) = sum(P(:, k)**2) / 2 + sum(r**2 * (0.5_rk + r * (cubic + r * quartic)))
      end do
    end do
  end subroutine energy

  ! The sums over all harmonics, at blocks of times.
  subroutine evaluate(t, phases, Q, P)
    real(rk), intent(in) :: t(:)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(out), optional :: Q(:, :), P(:, :)
    real(rk), allocatable :: re(:, :, :), im(:, :, :), cosine_sums(:, :), sine_sums(:, :)
    real(rk) :: phi(seeds)
    integer :: first, last, n, seed, k
    logical :: moving(2)
    moving = [present(Q), present(P)]
    phi = default_phases
    if (present(phases)) then
      if (size(phases) /= seeds) error stop 'beta_torus: phases must have size 2'
      phi = phases
    end if
    if (present(Q)) then
      if (size(Q, 1) /= modes .or. size(Q, 2) /= size(t)) &
        error stop 'beta_torus: Q must have shape (15, size(t))'
    end if
    if (present(P)) then
      if (size(P, 1) /= modes .or. size(P, 2) /= size(t)) &
        error stop 'beta_torus: P must have shape (15, size(t))'
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

end module beta_torus

#ifdef BETA_TORUS_SELF_TEST
program beta_torus_self_test
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use beta_torus, only: orbit, energy
  implicit none
  real(rk), save :: t(3), positions_of_t(15, 3), momenta_of_t(15, 3), energies_of_t(3)
  real(rk) :: Q(15, 3), P(15, 3), H(3), found(3)
  integer :: i
  data (t(i), i = 1, 3) / &
    0d0,5.921875d0,661.140625d0 /
  data (positions_of_t(i, 1), i = 1, 15) / &
    0.12153238142864169d0,1.071074238957232d0,0.4728526209590643d0,0.039883719111257494d0,0.003416599040645137d0, &
    0.002342205134851312d0,0.0017759477637466152d0,0.0005444478422317647d0,5.782919776596873d-05, &
    -3.7101283261972815d-06,-2.7695360961871712d-05,-1.679413919104885d-05,-1.5780367652721243d-05, &
    0.00020970378310515578d0,-1.1334243074999728d-06 /
  data (positions_of_t(i, 2), i = 1, 15) / &
    0.04408417268585588d0,-0.7321613842742701d0,-0.4521704778899922d0,-0.00398471988516082d0,0.003428332014773975d0, &
    0.0035225158335643937d0,7.284811220165109d-05,-0.0013268968035132513d0,-0.00013321656793747815d0, &
    3.427919458371313d-05,3.8812825138250485d-05,2.2974720070171557d-05,3.4174769215455755d-06, &
    0.0001280714411193124d0,2.0065313446092123d-06 /
  data (positions_of_t(i, 3), i = 1, 15) / &
    0.09817826378200359d0,-0.3329144074489002d0,-0.4769966102868333d0,-0.011058289552538937d0, &
    0.0021855615641016616d0,0.0032657874724035013d0,0.0037802268244002874d0,-0.0003075362069777145d0, &
    -0.00032447927153819137d0,-4.6365195971256456d-05,-3.092465408708311d-05,1.8171195582402622d-05, &
    1.806480042360915d-05,-0.00023349353789375464d0,1.6474725053028719d-06 /
  data (momenta_of_t(i, 1), i = 1, 15) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (momenta_of_t(i, 2), i = 1, 15) / &
    -0.02228060806925355d0,-0.3058580142042001d0,0.08733075637341797d0,0.0324997507786882d0,0.0019196639683479264d0, &
    -0.0024763859675428846d0,-0.005105683886145811d0,-0.0007796961391469021d0,0.0005940181852116886d0, &
    0.0001459103244427382d0,5.990581733835577d-06,-3.275760634764902d-05,-2.958769164804685d-05, &
    0.0003393514239772625d0,-8.882339656958589d-07 /
  data (momenta_of_t(i, 3), i = 1, 15) / &
    -0.013847413747081533d0,-0.3984140660571915d0,0.005784458493870334d0,0.03137391580922297d0, &
    0.002416792351640725d0,0.0026293577880176252d0,-0.003058552747238747d0,-0.002845568868191084d0, &
    -2.5728804152690148d-05,9.393558126942361d-05,0.00011753586460495745d0,7.322348828892282d-05, &
    -9.950259365740138d-06,-5.21298066790258d-05,5.418317693728114d-07 /
  data (energies_of_t(i), i = 1, 3) / &
    0.1271824483018574d0,0.12717340170807748d0,0.127170966335134d0 /
  call orbit(t, Q, P)
  call energy(t, H)
  found = [deviation(reshape(Q, [size(Q)]), reshape(positions_of_t, [size(Q)])), &
    deviation(reshape(P, [size(P)]), reshape(momenta_of_t, [size(P)])), deviation(H, energies_of_t)]
  print '(a, 3(es9.2, a))', 'largest deviation: ', found(1), ' of the largest coordinate, ', found(2), &
    ' of the largest momentum, ', found(3), ' of the energy'
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
end program beta_torus_self_test
#endif
