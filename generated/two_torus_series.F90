! Machine-written: quasi-periodic solutions of an FPU chain with free amplitudes A, one a seed,
!
!     Q_q(t) = sum over nu of c_q[nu](A) cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1,
!
! and their frequencies corrected by the amplitudes, omega(A).
!
!  written by: symfpu 0.1.0
!  made by: symfpu export two_torus.symfpu --lang fortran -o two_torus_series --series --order 3 --frequency-order 4
!  chain: Chain(N=16, alpha=0.33)
!  seeds: 1, 2
!  frequencies of the divisors: 0.19626, 0.39046
!  orders: frequencies 4, coordinates 3
!  precision: 30 digits
!  hash of the series: 1978bc5725bd9fa9918f10cf37fc7ccee026a7cb89aa0e44b5289a02f8ed0182
!
! How to call. Compile this file before your program, which says
!
!     use two_torus_series, only: positions, momenta, orbit, corrected_frequencies
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
! use two_torus_series, only: two_torus_series_positions => positions.
! All quantities are dimensionless. How well the equations of motion hold depends on the amplitudes, and on frequencies
! being omega(A). Arrays of other shapes stop the program.
! A call computes the coefficients of all harmonics first: give it many times at once.
! The procedures may be called from several threads.
!
! Accuracy: omega t, with omega the doubles of this call, is reduced to one turn without loss up to |t| of about 1e14.
! The sums are those of doubles, some 1e-15 of the largest coordinate while higher powers of the amplitudes are smaller
! than lower ones. Left out, frequencies have the rounding of doubles: after a time t, angles are off by some 1e-16 |t|.
! A time that is not finite, or above 1e38, gives NaN. Compile without -ffast-math.
!
! Self-test: gfortran -std=f2008 -O2 -DTWO_TORUS_SERIES_SELF_TEST FILE.F90 && ./a.out
! prints the largest deviation from embedded vectors and fails above 1d-13.

module two_torus_series
  use, intrinsic :: iso_fortran_env, only: rk => real64, single => real32
  implicit none
  private
  public :: positions, momenta, orbit, corrected_frequencies

  integer, parameter :: modes = 15, seeds = 2
  real(rk), parameter :: two_pi = 6.283185307179586d0
  ! 1 / (2 pi) in three parts, exact in doubles
  real(rk), parameter :: radian(3) = [0.15915493667125702d0, 6.4206382432985265d-09, 7.34273885092955d-17]

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
    real(rk) :: A1, A2, y0, y1, y2, y3, y4, y5, y6, y7
    if (size(amplitudes) /= seeds) error stop 'two_torus_series: amplitudes must have size 2'
    if (size(omega) /= seeds) error stop 'two_torus_series: omega must have size 2'
    if (present(jacobian)) then
      if (any(shape(jacobian) /= seeds)) error stop 'two_torus_series: jacobian must have shape (2, 2)'
    end if
    A1 = amplitudes(1)
    A2 = amplitudes(2)
    y0 = A1**2
    y1 = A1**4
    y2 = A2**2
    y3 = A2**4
    y4 = y0*y2
    y5 = A1**3
    y6 = A2**3
    y7 = A2*y0
    omega(1) = 0.000592160852870222d0*y0 + 0.00039529957083372116d0*y1 - 9.294742582813598d-05*y2 + &
      0.0021470587971840756d0*y3 - 0.001402329305497235d0*y4 + 0.1960342806591212d0
    omega(2) = -4.6698579337598625d-05*y0 - 0.0004451823698547334d0*y1 + 0.0011298915795266533d0*y2 + &
      0.00018810304175985085d0*y3 + 0.0021023772176948768d0*y4 + 0.39018064403225655d0
    if (present(jacobian)) then
      jacobian(1, 1) = -0.00280465861099447d0*A1*y2 + 0.001184321705740444d0*A1 + 0.0015811982833348847d0*y5
      jacobian(1, 2) = -0.00018589485165627196d0*A2 + 0.008588235188736302d0*y6 - 0.00280465861099447d0*y7
      jacobian(2, 1) = 0.0042047544353897535d0*A1*y2 - 9.339715867519725d-05*A1 - 0.0017807294794189336d0*y5
      jacobian(2, 2) = 0.0022597831590533066d0*A2 + 0.0007524121670394034d0*y6 + 0.0042047544353897535d0*y7
    end if
  end subroutine corrected_frequencies

  ! Coefficients at these amplitudes, once; then waves and their sums at every time.
  subroutine evaluate(t, amplitudes, phases, frequencies, Q, P)
    real(rk), intent(in) :: t(:), amplitudes(:)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(in), optional :: frequencies(:)
    real(rk), intent(out), optional :: Q(:, :), P(:, :)
    real(rk) :: phi(seeds), omega(seeds), turns(3, seeds)
    real(rk) :: A1, A2, omega1, omega2, x0, x1, x2, x3, x4, x5, x6, x7, x8, x9, x10, x11, x12, x13, x14, x15, x16
    real(rk) :: x17, c0_2, c0_4, c0_6, c0_8, rate1, c1_2, d1_2, c1_4, d1_4, c1_6, d1_6, rate2, c2_1, d2_1, c2_3
    real(rk) :: d2_3, c2_5, d2_5, rate3, c3_2, d3_2, c3_4, d3_4, c3_6, d3_6, c3_8, d3_8, rate4, c4_1, d4_1, c4_3
    real(rk) :: d4_3, c4_5, d4_5, c4_7, d4_7, rate5, c5_1, d5_1, c5_3, d5_3, c5_5, d5_5, c5_7, d5_7, rate6, c6_2
    real(rk) :: d6_2, c6_4, d6_4, c6_6, d6_6, rate7, c7_2, d7_2, c7_6, d7_6, rate8, c8_1, d8_1, c8_3, d8_3, c8_5
    real(rk) :: d8_5, rate9, c9_1, d9_1, c9_3, d9_3, c9_5, d9_5, rate10, c10_2, d10_2, c10_4, d10_4, rate11, c11_2
    real(rk) :: d11_2, c11_4, d11_4, rate12, c12_1, d12_1, c12_3, d12_3, rate13, c13_4, d13_4, c13_8, d13_8, rate14
    real(rk) :: c14_1, d14_1, c14_3, d14_3, c14_5, d14_5, c14_7, d14_7, rate15, c15_1, d15_1, c15_3, d15_3, c15_5
    real(rk) :: d15_5, c15_7, d15_7, rate16, c16_2, d16_2, c16_4, d16_4, c16_6, d16_6, rate17, c17_2, d17_2, c17_4
    real(rk) :: d17_4, c17_6, d17_6, rate18, c18_1, d18_1, c18_3, d18_3, c18_5, d18_5, rate19, c19_1, d19_1, c19_3
    real(rk) :: d19_3, c19_5, d19_5, rate20, c20_2, d20_2, c20_4, d20_4, theta1, theta2, cos1, sin1, cos2, sin2
    real(rk) :: cos3, sin3, cos4, sin4, cos5, sin5, cos6, sin6, cos7, sin7, cos8, sin8, cos9, sin9, cos10, sin10
    real(rk) :: cos11, sin11, cos12, sin12, cos13, sin13, cos14, sin14, cos15, sin15, cos16, sin16, cos17, sin17
    real(rk) :: cos18, sin18, cos19, sin19, cos20, sin20
    integer :: k, seed
    if (size(amplitudes) /= seeds) error stop 'two_torus_series: amplitudes must have size 2'
    if (present(frequencies)) then
      if (size(frequencies) /= seeds) error stop 'two_torus_series: frequencies must have size 2'
      omega = frequencies
    else
      call corrected_frequencies(amplitudes, omega)
    end if
    phi = 0
    do seed = 1, seeds
      turns(:, seed) = turns_of(omega(seed))
    end do
    if (present(phases)) then
      if (size(phases) /= seeds) error stop 'two_torus_series: phases must have size 2'
      phi = phases
    end if
    if (present(Q)) then
      if (size(Q, 1) /= modes .or. size(Q, 2) /= size(t)) &
        error stop 'two_torus_series: Q must have shape (15, size(t))'
    end if
    if (present(P)) then
      if (size(P, 1) /= modes .or. size(P, 2) /= size(t)) &
        error stop 'two_torus_series: P must have shape (15, size(t))'
    end if
    A1 = amplitudes(1)
    A2 = amplitudes(2)
    omega1 = omega(1)
    omega2 = omega(2)
    x0 = A1**2
    x1 = A1**4
    x2 = A2**2
    x3 = x0*x2
    x4 = A2**4
    x5 = A2*x0
    x6 = A2**3
    x7 = A1**3
    x8 = A1*x2
    x9 = 2d0*omega2
    x10 = -omega2
    x11 = A1*A2
    x12 = A2*x7
    x13 = A1*x6
    x14 = 2d0*omega1
    x15 = 3d0*omega2
    x16 = -x9
    x17 = 3d0*omega1
    c0_2 = -0.0028687032351990722d0*x0 + 3.981975731204928d-05*x1 - 0.0035713364733041936d0*x3
    c0_4 = -0.000406708251684491d0*x1 - 0.005801906708236072d0*x2 - 0.0001028515026733883d0*x3 + &
      7.667301950445486d-05*x4
    c0_6 = -0.0010408166713117288d0*x3
    c0_8 = -0.00020060716303406162d0*x4
    rate1 = omega2
    c1_2 = 1d0*A2
    d1_2 = -c1_2*rate1
    c1_4 = -0.004039781598349474d0*x5
    d1_4 = -c1_4*rate1
    c1_6 = -0.002320270331342854d0*x6
    d1_6 = -c1_6*rate1
    rate2 = omega1
    c2_1 = 1d0*A1
    d2_1 = -c2_1*rate2
    c2_3 = 0.009609144222270698d0*A1*x2 - 0.002303123425996099d0*x7
    d2_3 = -c2_3*rate2
    c2_5 = -0.005047163976846871d0*x8
    d2_5 = -c2_5*rate2
    rate3 = x9
    c3_2 = -0.004792413558393184d0*x3
    d3_2 = -c3_2*rate3
    c3_4 = 0.14131948233035063d0*x2 - 0.14695492167776708d0*x3 + 0.014368474457199321d0*x4
    d3_4 = -c3_4*rate3
    c3_6 = -0.0013476891206633246d0*x3
    d3_6 = -c3_6*rate3
    c3_8 = -0.0003951786865153717d0*x4
    d3_8 = -c3_8*rate3
    rate4 = omega1 + x10
    c4_1 = 1.1173455145685154d0*A1*x6 - 1.087489189529932d0*x11 - 0.6363185137238475d0*x12
    d4_1 = -c4_1*rate4
    c4_3 = -0.008653976202413236d0*x11 + 4.7364636676905825d-06*x12 + 9.728805847404313d-05*x13
    d4_3 = -c4_3*rate4
    c4_5 = 0.006211803094997529d0*A1*x6 - 0.0013302049702459508d0*x12
    d4_5 = -c4_5*rate4
    c4_7 = -0.0009241366554937783d0*x13
    d4_7 = -c4_7*rate4
    rate5 = omega1 + omega2
    c5_1 = 0.002861155751656057d0*x11 - 0.0008970374368847945d0*x12 + 4.721718220062921d-06*x13
    d5_1 = -c5_1*rate5
    c5_3 = 0.36082081426335916d0*x11 - 0.013108564194709953d0*x12 + 0.03162233624033316d0*x13
    d5_3 = -c5_3*rate5
    c5_5 = 0.00213343820329272d0*A1*x6 - 0.0018278113797905548d0*x12
    d5_5 = -c5_5*rate5
    c5_7 = -0.0015661664830180406d0*x13
    d5_7 = -c5_7*rate5
    rate6 = x14
    c6_2 = 0.27115700844456897d0*x0 + 0.12035153297272662d0*x1 - 0.22278126771983983d0*x3
    d6_2 = -c6_2*rate6
    c6_4 = 0.004469710359303185d0*x0*x2 - 0.0008095643183902094d0*x1
    d6_4 = -c6_4*rate6
    c6_6 = -0.00218467016492829d0*x3
    d6_6 = -c6_6*rate6
    rate7 = x15
    c7_2 = 0.0007875878368247138d0*x6
    d7_2 = -c7_2*rate7
    c7_6 = 0.019895233780180387d0*x6
    d7_6 = -c7_6*rate7
    rate8 = omega1 + x16
    c8_1 = -0.003210142951212994d0*x8
    d8_1 = -c8_1*rate8
    c8_3 = -0.44037557830840124d0*x8
    d8_3 = -c8_3*rate8
    c8_5 = -0.0019347032245652866d0*x8
    d8_5 = -c8_5*rate8
    rate9 = omega1 + x9
    c9_1 = 0.0010227658453562675d0*x8
    d9_1 = -c9_1*rate9
    c9_3 = 0.0011743413403160225d0*x8
    d9_3 = -c9_3*rate9
    c9_5 = 0.0857534662498305d0*x8
    d9_5 = -c9_5*rate9
    rate10 = x10 + x14
    c10_2 = 0.006386591341743735d0*x5
    d10_2 = -c10_2*rate10
    c10_4 = -0.0030714067691627327d0*x5
    d10_4 = -c10_4*rate10
    rate11 = omega2 + x14
    c11_2 = 0.002034796453570815d0*x5
    d11_2 = -c11_2*rate11
    c11_4 = 0.13481870681336375d0*x5
    d11_4 = -c11_4*rate11
    rate12 = x17
    c12_1 = 0.0007697256811581401d0*x7
    d12_1 = -c12_1*rate12
    c12_3 = 0.07316275581276288d0*x7
    d12_3 = -c12_3*rate12
    rate13 = 4d0*omega2
    c13_4 = 0.00021065985386560155d0*x4
    d13_4 = -c13_4*rate13
    c13_8 = 0.0027180982348453714d0*x4
    d13_8 = -c13_8*rate13
    rate14 = omega1 - x15
    c14_1 = -0.0012595569830263697d0*x13
    d14_1 = -c14_1*rate14
    c14_3 = -0.0013218139253162947d0*x13
    d14_3 = -c14_3*rate14
    c14_5 = -0.10510386728889293d0*x13
    d14_5 = -c14_5*rate14
    c14_7 = -0.00034578434218557493d0*x13
    d14_7 = -c14_7*rate14
    rate15 = omega1 + x15
    c15_1 = 0.00014396810949383098d0*x13
    d15_1 = -c15_1*rate15
    c15_3 = 0.0007011495712170275d0*x13
    d15_3 = -c15_3*rate15
    c15_5 = 0.00026112212247840586d0*x13
    d15_5 = -c15_5*rate15
    c15_7 = 0.01662447386665833d0*x13
    d15_7 = -c15_7*rate15
    rate16 = x14 + x16
    c16_2 = 0.22587682658901168d0*x3
    d16_2 = -c16_2*rate16
    c16_4 = 0.004972073555398954d0*x3
    d16_4 = -c16_4*rate16
    c16_6 = -0.0006089354170374815d0*x3
    d16_6 = -c16_6*rate16
    rate17 = x14 + x9
    c17_2 = 0.0009665139899628146d0*x3
    d17_2 = -c17_2*rate17
    c17_4 = 0.0009260643965836509d0*x3
    d17_4 = -c17_4*rate17
    c17_6 = 0.04075813463519515d0*x3
    d17_6 = -c17_6*rate17
    rate18 = x10 + x17
    c18_1 = -0.08393514749379542d0*x12
    d18_1 = -c18_1*rate18
    c18_3 = 0.0025559028660708237d0*x12
    d18_3 = -c18_3*rate18
    c18_5 = -0.0010087211758185608d0*x12
    d18_5 = -c18_5*rate18
    rate19 = omega2 + x17
    c19_1 = 0.00048470538167331154d0*x12
    d19_1 = -c19_1*rate19
    c19_3 = 0.0011166044853950544d0*x12
    d19_3 = -c19_3*rate19
    c19_5 = 0.04629444016810897d0*x12
    d19_5 = -c19_5*rate19
    rate20 = 4d0*omega1
    c20_2 = 0.0004100749283565843d0*x1
    d20_2 = -c20_2*rate20
    c20_4 = 0.020381730629727663d0*x1
    d20_4 = -c20_4*rate20
    do k = 1, size(t)
      theta1 = angle(t(k), phi(1), turns(:, 1))
      theta2 = angle(t(k), phi(2), turns(:, 2))
      cos1 = cos(theta2)
      sin1 = sin(theta2)
      cos2 = cos(theta1)
      sin2 = sin(theta1)
      cos3 = cos(2d0*theta2)
      sin3 = sin(2d0*theta2)
      cos4 = cos(theta1 - theta2)
      sin4 = sin(theta1 - theta2)
      cos5 = cos(theta1 + theta2)
      sin5 = sin(theta1 + theta2)
      cos6 = cos(2d0*theta1)
      sin6 = sin(2d0*theta1)
      cos7 = cos(3d0*theta2)
      sin7 = sin(3d0*theta2)
      cos8 = cos(theta1 - 2d0*theta2)
      sin8 = sin(theta1 - 2d0*theta2)
      cos9 = cos(theta1 + 2d0*theta2)
      sin9 = sin(theta1 + 2d0*theta2)
      cos10 = cos(2d0*theta1 - theta2)
      sin10 = sin(2d0*theta1 - theta2)
      cos11 = cos(2d0*theta1 + theta2)
      sin11 = sin(2d0*theta1 + theta2)
      cos12 = cos(3d0*theta1)
      sin12 = sin(3d0*theta1)
      cos13 = cos(4d0*theta2)
      sin13 = sin(4d0*theta2)
      cos14 = cos(theta1 - 3d0*theta2)
      sin14 = sin(theta1 - 3d0*theta2)
      cos15 = cos(theta1 + 3d0*theta2)
      sin15 = sin(theta1 + 3d0*theta2)
      cos16 = cos(2d0*theta1 - 2d0*theta2)
      sin16 = sin(2d0*theta1 - 2d0*theta2)
      cos17 = cos(2d0*theta1 + 2d0*theta2)
      sin17 = sin(2d0*theta1 + 2d0*theta2)
      cos18 = cos(3d0*theta1 - theta2)
      sin18 = sin(3d0*theta1 - theta2)
      cos19 = cos(3d0*theta1 + theta2)
      sin19 = sin(3d0*theta1 + theta2)
      cos20 = cos(4d0*theta1)
      sin20 = sin(4d0*theta1)
      if (present(Q)) then
        Q(1, k) = c12_1*cos12 + c14_1*cos14 + c15_1*cos15 + c18_1*cos18 + c19_1*cos19 + c2_1*cos2 + c4_1*cos4 + &
          c5_1*cos5 + c8_1*cos8 + c9_1*cos9
        Q(2, k) = c0_2 + c10_2*cos10 + c11_2*cos11 + c16_2*cos16 + c17_2*cos17 + c1_2*cos1 + c20_2*cos20 + c3_2* &
          cos3 + c6_2*cos6 + c7_2*cos7
        Q(3, k) = c12_3*cos12 + c14_3*cos14 + c15_3*cos15 + c18_3*cos18 + c19_3*cos19 + c2_3*cos2 + c4_3*cos4 + &
          c5_3*cos5 + c8_3*cos8 + c9_3*cos9
        Q(4, k) = c0_4 + c10_4*cos10 + c11_4*cos11 + c13_4*cos13 + c16_4*cos16 + c17_4*cos17 + c1_4*cos1 + c20_4* &
          cos20 + c3_4*cos3 + c6_4*cos6
        Q(5, k) = c14_5*cos14 + c15_5*cos15 + c18_5*cos18 + c19_5*cos19 + c2_5*cos2 + c4_5*cos4 + c5_5*cos5 + &
          c8_5*cos8 + c9_5*cos9
        Q(6, k) = c0_6 + c16_6*cos16 + c17_6*cos17 + c1_6*cos1 + c3_6*cos3 + c6_6*cos6 + c7_6*cos7
        Q(7, k) = c14_7*cos14 + c15_7*cos15 + c4_7*cos4 + c5_7*cos5
        Q(8, k) = c0_8 + c13_8*cos13 + c3_8*cos3
        Q(9, k) = 0d0
        Q(10, k) = 0d0
        Q(11, k) = 0d0
        Q(12, k) = 0d0
        Q(13, k) = 0d0
        Q(14, k) = 0d0
        Q(15, k) = 0d0
      end if
      if (present(P)) then
        P(1, k) = d12_1*sin12 + d14_1*sin14 + d15_1*sin15 + d18_1*sin18 + d19_1*sin19 + d2_1*sin2 + d4_1*sin4 + &
          d5_1*sin5 + d8_1*sin8 + d9_1*sin9
        P(2, k) = d10_2*sin10 + d11_2*sin11 + d16_2*sin16 + d17_2*sin17 + d1_2*sin1 + d20_2*sin20 + d3_2*sin3 + &
          d6_2*sin6 + d7_2*sin7
        P(3, k) = d12_3*sin12 + d14_3*sin14 + d15_3*sin15 + d18_3*sin18 + d19_3*sin19 + d2_3*sin2 + d4_3*sin4 + &
          d5_3*sin5 + d8_3*sin8 + d9_3*sin9
        P(4, k) = d10_4*sin10 + d11_4*sin11 + d13_4*sin13 + d16_4*sin16 + d17_4*sin17 + d1_4*sin1 + d20_4*sin20 + &
          d3_4*sin3 + d6_4*sin6
        P(5, k) = d14_5*sin14 + d15_5*sin15 + d18_5*sin18 + d19_5*sin19 + d2_5*sin2 + d4_5*sin4 + d5_5*sin5 + &
          d8_5*sin8 + d9_5*sin9
        P(6, k) = d16_6*sin16 + d17_6*sin17 + d1_6*sin1 + d3_6*sin3 + d6_6*sin6 + d7_6*sin7
        P(7, k) = d14_7*sin14 + d15_7*sin15 + d4_7*sin4 + d5_7*sin5
        P(8, k) = d13_8*sin13 + d3_8*sin3
        P(9, k) = 0d0
        P(10, k) = 0d0
        P(11, k) = 0d0
        P(12, k) = 0d0
        P(13, k) = 0d0
        P(14, k) = 0d0
        P(15, k) = 0d0
      end if
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

end module two_torus_series

#ifdef TWO_TORUS_SERIES_SELF_TEST
program two_torus_series_self_test
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use two_torus_series, only: orbit, corrected_frequencies
  implicit none
  real(rk), save :: t(4), positions_of_t(15, 4), momenta_of_t(15, 4)
  real(rk), save :: amplitudes(2), phases(2), frequencies(2), exact_omega(2), exact_slopes(2, 2)
  real(rk) :: Q(15, 4), P(15, 4), omega(2), slopes(2, 2), found(4)
  integer :: i
  data (t(i), i = 1, 4) / &
    0d0,2.75d0,-13.0625d0,160.5d0 /
  data (amplitudes(i), i = 1, 2) / &
    0.182861328125d0,0.06884765625d0 /
  data (phases(i), i = 1, 2) / &
    0.5d0,0.125d0 /
  data (frequencies(i), i = 1, 2) / &
    0.1972370147705078d0,0.3924131393432617d0 /
  data (exact_omega(i), i = 1, 2) / &
    0.19605390888520602d0,0.39018427787984444d0 /
  data (positions_of_t(i, 1), i = 1, 15) / &
    0.14756933146808632d0,0.07320359857917257d0,0.0032371865341353006d0,0.0007099071145282463d0, &
    4.087248729871165d-05,6.6974629388337556d-06,4.883248016341078d-07,4.04833514934644d-08,0d0,0d0,0d0,0d0,0d0,0d0, &
    0d0 /
  data (positions_of_t(i, 2), i = 1, 15) / &
    0.07846192519682088d0,0.020117360126198514d0,-0.0034758632725270665d0,-0.0008343810268248418d0, &
    -7.49647189093679d-05,-7.3905944562408346d-06,-3.5705977692847776d-08,8.438529920267048d-09,0d0,0d0,0d0,0d0,0d0, &
    0d0,0d0 /
  data (positions_of_t(i, 3), i = 1, 15) / &
    -0.07498274623781943d0,0.0146644712907736d0,0.003765805257268794d0,-0.0008856115080729567d0, &
    6.613252920376465d-05,-5.161480036256058d-06,-2.2772925003915494d-07,2.765514360190719d-08,0d0,0d0,0d0,0d0,0d0, &
    0d0,0d0 /
  data (positions_of_t(i, 4), i = 1, 15) / &
    0.12257154512285746d0,0.06700043393993033d0,0.0016425690802491647d0,0.00043233578849052233d0, &
    -6.569065957243631d-06,3.590819079522843d-07,-1.1528901354948065d-07,1.5529201196980878d-08,0d0,0d0,0d0,0d0,0d0, &
    0d0,0d0 /
  data (momenta_of_t(i, 1), i = 1, 15) / &
    -0.018293958133367805d0,-0.006405229666236184d0,-0.0018941334653236957d0,-0.0003617395078126652d0, &
    -6.922903111402821d-05,-9.861449653670686d-06,-1.0208118122642846d-06,-4.423247890361152d-08,0d0,0d0,0d0,0d0,0d0, &
    0d0,0d0 /
  data (momenta_of_t(i, 2), i = 1, 15) / &
    -0.030719217768438785d0,-0.02837244310029081d0,-0.0018674191469785098d0,-0.0002850031093426471d0, &
    4.5444713955013254d-05,1.142348194110401d-05,1.4169722236341332d-06,1.0000197985706274d-07,0d0,0d0,0d0,0d0,0d0, &
    0d0,0d0 /
  data (momenta_of_t(i, 3), i = 1, 15) / &
    0.030976134246780824d0,-0.028968375116062574d0,0.0016645665444151502d0,-0.0001917626734269054d0, &
    -5.717063060217741d-05,1.3079815310952006d-05,-1.385218926174085d-06,9.145358015518136d-08,0d0,0d0,0d0,0d0,0d0, &
    0d0,0d0 /
  data (momenta_of_t(i, 4), i = 1, 15) / &
    -0.0255669671635807d0,-0.010942105830984037d0,-0.002538167515238409d0,-0.000507814422844626d0, &
    -8.040096959357961d-05,-1.216894106854717d-05,-1.3198021611507606d-06,-8.18602583302943d-08,0d0,0d0,0d0,0d0,0d0, &
    0d0,0d0 /
  data (exact_slopes(1, i), i = 1, 2) / &
    0.00022380400734081573d0,-1.6452492579182644d-05 /
  data (exact_slopes(2, i), i = 1, 2) / &
    -2.432259159760542d-05,0.00016550627415271873d0 /
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
end program two_torus_series_self_test
#endif
