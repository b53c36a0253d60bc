! Machine-written: a quasi-periodic solution of an FPU chain,
!
!     Q_q(t) = sum over nu of c_q[nu] cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1.
!
!  written by: symfpu 0.1.0
!  made by: symfpu export breather_25.symfpu --lang fortran -o breather_25
!  orders: frequencies 12, coordinates 12
!  amplitudes: A_25 = 0.0512121591740189630941015617021
!  chain: Chain(N=32, alpha=0.33)
!  seeds: 25
!  frequencies: 1.8830741847088537
!  precision: 30 digits
!  hash of the coefficients: 1dcd398567a325e662ff3b53541cc134d88044b6eb5a24368358e04cb7f01601
!
! How to call. Compile this file before your program, which says
!
!     use breather_25, only: positions, momenta, orbit, harmonic_energies, energy
!     use, intrinsic :: iso_fortran_env, only: real64
!     real(real64) :: t(n), Q(31, n), P(31, n), E(31, n), H(n), phases(1)
!     call positions(t, Q)                 ! or positions(t, Q, phases)
!     call momenta(t, P)                   ! or momenta(t, P, phases)
!     call orbit(t, Q, P)                  ! or orbit(t, Q, P, phases)
!     call harmonic_energies(t, E)         ! or harmonic_energies(t, E, phases)
!     call energy(t, H)                    ! or energy(t, H, phases)
!
!   t        n times, any real numbers
!   Q, P, E  (N-1, n) = (31, n): Q(q, i) is mode q at time t(i); in memory the time is slowest, as in the C files
!   H        (n)
!   phases   (1): angles phi in radians, one a seed in the order above; left out, they are
!     0.0
!
! Two such modules in one program:
! use breather_25, only: breather_25_positions => positions.
! All quantities are dimensionless. E_q = (P_q**2 + Omega_q**2 Q_q**2) / 2 is the energy of mode q, H the total energy.
! Arrays of other shapes stop the program. Tables are only read and work arrays are allocated by each call: the
! procedures may be called from several threads.
!
! Accuracy: omega t is reduced to one turn without loss up to |t| of about 1e14; the sums are those of doubles, some
! 1e-15 of the largest coordinate. A time that is not finite, or above 1e38, gives NaN. Compile without -ffast-math.
!
! Self-test: gfortran -std=f2008 -O2 -DBREATHER_25_SELF_TEST FILE.F90 && ./a.out
! prints the largest deviation from embedded vectors and fails above 1d-13.

module breather_25
  use, intrinsic :: iso_fortran_env, only: rk => real64, single => real32
  implicit none
  private
  public :: positions, momenta, orbit, harmonic_energies, energy

  integer, parameter :: bonds = 32, modes = 31, seeds = 1
  integer, parameter :: highest = 13  ! largest number in a harmonic
  integer, parameter :: times = 64, tile = 256  ! evaluated together, and harmonics of one matrix product
  real(rk), parameter :: two_pi = 6.283185307179586d0
  real(rk), parameter :: cubic = 0.11d0  ! alpha / 3
  real(rk), parameter :: quartic = 0d0  ! beta / 4
  integer :: i  ! of the tables

  ! omega / (2 pi) of every seed and 1 / (2 pi), in three parts each, exact in doubles
  real(rk), save :: turns(3, seeds), radian(3), default_phases(seeds), norm, omega(31)
  real(rk), save :: cosines(0:127)
  data (turns(i, 1), i = 1, 3) / &
    0.2997005581855774d0,6.519577322450232d-09,1.0167201944968003d-16 /
  data (radian(i), i = 1, 3) / &
    0.15915493667125702d0,6.4206382432985265d-09,7.34273885092955d-17 /
  data (default_phases(i), i = 1, 1) / &
    0d0 /
  ! sqrt(2/N), linear frequencies Omega_q, cos(k pi / 2N)
  data norm / 0.25d0 /
  data (omega(i), i = 1, 31) / &
    0.09813534865483603d0,0.1960342806591212d0,0.2934609489107235d0,0.39018064403225655d0,0.4859603598065278d0, &
    0.5805693545089248d0,0.6737797067844401d0,0.7653668647301796d0,0.8551101868605642d0,0.9427934736519953d0, &
    1.0282054883864435d0,1.1111404660392044d0,1.1913986089848667d0,1.268786568327291d0,1.3431179096940369d0, &
    1.4142135623730951d0,1.4819022507099182d0,1.546020906725474d0,1.6064150629612899d0,1.6629392246050905d0, &
    1.7154572200005442d0,1.76384252869671d0,1.8079785862468867d0,1.8477590650225735d0,1.8830881303660416d0, &
    1.9138806714644176d0,1.940062506389088d0,1.9615705608064609d0,1.978353019929562d0,1.9903694533443939d0, &
    1.9975909124103448d0 /
  data (cosines(i), i = 0, 127) / &
    1d0,0.9987954562051724d0,0.9951847266721969d0,0.989176509964781d0,0.9807852804032304d0,0.970031253194544d0, &
    0.9569403357322088d0,0.9415440651830208d0,0.9238795325112867d0,0.9039892931234433d0,0.881921264348355d0, &
    0.8577286100002721d0,0.8314696123025452d0,0.8032075314806449d0,0.773010453362737d0,0.7409511253549591d0, &
    0.7071067811865476d0,0.6715589548470184d0,0.6343932841636455d0,0.5956993044924334d0,0.5555702330196022d0, &
    0.5141027441932218d0,0.47139673682599764d0,0.4275550934302821d0,0.3826834323650898d0,0.33688985339222005d0, &
    0.2902846772544624d0,0.2429801799032639d0,0.19509032201612828d0,0.14673047445536175d0,0.0980171403295606d0, &
    0.049067674327418015d0,0d0,-0.049067674327418015d0,-0.0980171403295606d0,-0.14673047445536175d0, &
    -0.19509032201612828d0,-0.2429801799032639d0,-0.2902846772544624d0,-0.33688985339222005d0,-0.3826834323650898d0, &
    -0.4275550934302821d0,-0.47139673682599764d0,-0.5141027441932218d0,-0.5555702330196022d0,-0.5956993044924334d0, &
    -0.6343932841636455d0,-0.6715589548470184d0,-0.7071067811865476d0,-0.7409511253549591d0,-0.773010453362737d0, &
    -0.8032075314806449d0,-0.8314696123025452d0,-0.8577286100002721d0,-0.881921264348355d0,-0.9039892931234433d0, &
    -0.9238795325112867d0,-0.9415440651830208d0,-0.9569403357322088d0,-0.970031253194544d0,-0.9807852804032304d0, &
    -0.989176509964781d0,-0.9951847266721969d0,-0.9987954562051724d0,-1d0,-0.9987954562051724d0, &
    -0.9951847266721969d0,-0.989176509964781d0,-0.9807852804032304d0,-0.970031253194544d0,-0.9569403357322088d0, &
    -0.9415440651830208d0,-0.9238795325112867d0,-0.9039892931234433d0,-0.881921264348355d0,-0.8577286100002721d0, &
    -0.8314696123025452d0,-0.8032075314806449d0,-0.773010453362737d0,-0.7409511253549591d0,-0.7071067811865476d0, &
    -0.6715589548470184d0,-0.6343932841636455d0,-0.5956993044924334d0,-0.5555702330196022d0,-0.5141027441932218d0, &
    -0.47139673682599764d0,-0.4275550934302821d0,-0.3826834323650898d0,-0.33688985339222005d0,-0.2902846772544624d0, &
    -0.2429801799032639d0,-0.19509032201612828d0,-0.14673047445536175d0,-0.0980171403295606d0, &
    -0.049067674327418015d0,0d0,0.049067674327418015d0,0.0980171403295606d0,0.14673047445536175d0, &
    0.19509032201612828d0,0.2429801799032639d0,0.2902846772544624d0,0.33688985339222005d0,0.3826834323650898d0, &
    0.4275550934302821d0,0.47139673682599764d0,0.5141027441932218d0,0.5555702330196022d0,0.5956993044924334d0, &
    0.6343932841636455d0,0.6715589548470184d0,0.7071067811865476d0,0.7409511253549591d0,0.773010453362737d0, &
    0.8032075314806449d0,0.8314696123025452d0,0.8577286100002721d0,0.881921264348355d0,0.9039892931234433d0, &
    0.9238795325112867d0,0.9415440651830208d0,0.9569403357322088d0,0.970031253194544d0,0.9807852804032304d0, &
    0.989176509964781d0,0.9951847266721969d0,0.9987954562051724d0 /

  ! Harmonics of the even modes: nu, rates nu.omega, and coefficients of cos(nu.theta)
  integer, save :: nu_even(7, seeds)
  real(rk), save :: rates_even(7), c_even(7, 15)
  data (nu_even(i, 1), i = 1, 7) / &
    0,2,4,6,8,10,12 /
  data (rates_even(i), i = 1, 7) / &
    0d0,3.7661483694177074d0,7.532296738835415d0,11.298445108253123d0,15.06459347767083d0,18.830741847088536d0, &
    22.596890216506246d0 /
  data (c_even(i, 1), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_even(i, 2), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_even(i, 3), i = 1, 7) / &
    -2.7675140646771417d-22,6.475573571247884d-24,-5.076568596010796d-27,3.1250813276403224d-29, &
    -3.404492072400157d-32,1.0417857514940804d-35,1.4304130218360944d-42 /
  data (c_even(i, 4), i = 1, 7) / &
    4.2461145535150117d-19,-1.1054425924466878d-20,-6.547434405602579d-22,1.2259705351549925d-24, &
    -5.188629273502791d-28,-6.110739151851142d-35,-5.547002995267631d-42 /
  data (c_even(i, 5), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_even(i, 6), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_even(i, 7), i = 1, 7) / &
    0.00015117757854294937d0,-1.9354829168338714d-05,-1.4244560699063556d-12,-1.183771896274435d-19, &
    -8.135185521021295d-27,-5.504373572318875d-34,-3.58516483825606d-41 /
  data (c_even(i, 8), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_even(i, 9), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_even(i, 10), i = 1, 7) / &
    -1.0786315577174035d-26,3.0277387632139386d-27,-8.798943565472705d-31,1.1935546690289248d-33, &
    -2.9553264933332913d-36,2.1473604921341954d-39,-4.951770626469579d-43 /
  data (c_even(i, 11), i = 1, 7) / &
    3.5508781926641617d-15,4.278296790564035d-15,-4.001853415188579d-17,3.0741888457648474d-20,2.932636965630418d-27, &
    2.4194676631029753d-34,1.7909980366397718d-41 /
  data (c_even(i, 12), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_even(i, 13), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_even(i, 14), i = 1, 7) / &
    4.504624101242449d-10,-5.292931896694843d-10,9.551077410701395d-13,7.692810797179155d-20,5.968105559678107d-27, &
    4.184160810296171d-34,2.839524050376225d-41 /
  data (c_even(i, 15), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /

  ! Harmonics of the odd modes: nu, rates nu.omega, and coefficients of cos(nu.theta)
  integer, save :: nu_odd(7, seeds)
  real(rk), save :: rates_odd(7), c_odd(7, 16)
  data (nu_odd(i, 1), i = 1, 7) / &
    1,3,5,7,9,11,13 /
  data (rates_odd(i), i = 1, 7) / &
    1.8830741847088537d0,5.6492225541265615d0,9.415370923544268d0,13.181519292961976d0,16.947667662379683d0, &
    20.71381603179739d0,24.4799644012151d0 /
  data (c_odd(i, 1), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_odd(i, 2), i = 1, 7) / &
    1.0085362127709726d-12,-4.41680461344106d-14,3.592700000494951d-17,3.953076109854066d-24,3.277552578540149d-31, &
    2.407459837840973d-38,1.6707763393820603d-45 /
  data (c_odd(i, 3), i = 1, 7) / &
    -3.0009165730556703d-29,4.119927956461746d-31,-8.821734306051385d-35,1.4941832672044366d-37, &
    -2.6891346357676717d-40,1.64993122821882d-43,-3.307432135185679d-47 /
  data (c_odd(i, 4), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_odd(i, 5), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_odd(i, 6), i = 1, 7) / &
    5.901180334736764d-07,-3.255064309203764d-09,-3.170787737648405d-16,-2.4000856282382192d-23, &
    -1.666762440682117d-30,-1.1151673796019302d-37,-7.255980735885705d-45 /
  data (c_odd(i, 7), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_odd(i, 8), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_odd(i, 9), i = 1, 7) / &
    -6.263956347261713d-17,-2.8137710311924094d-18,8.298014009276822d-21,-4.18925397951177d-24, &
    -5.066825016153425d-31,-4.464623590164244d-38,-3.4421120634491285d-45 /
  data (c_odd(i, 10), i = 1, 7) / &
    -3.0478218234177374d-24,2.8204532207813212d-27,-4.2381937600831196d-30,1.4397579899091643d-32, &
    -1.232681963069093d-35,3.06140035403912d-39,4.595750834750287d-46 /
  data (c_odd(i, 11), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_odd(i, 12), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_odd(i, 13), i = 1, 7) / &
    0.051212159174018966d0,6.484677900176531d-09,5.078046961673205d-16,3.6674735063896916d-23,2.488274267685113d-30, &
    1.6174572296711147d-37,1.0284125712579862d-44 /
  data (c_odd(i, 14), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_odd(i, 15), i = 1, 7) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0 /
  data (c_odd(i, 16), i = 1, 7) / &
    1.9848962258524294d-20,-9.677505243551741d-24,2.3109989565631162d-25,-3.393665481940952d-28, &
    1.1402004196781838d-31,1.5188423173611879d-38,1.4511214638955135d-45 /

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
    if (size(E, 1) /= modes .or. size(E, 2) /= size(t)) error stop 'harmonic_energies: E must have shape (31, size(t))'
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
      if (size(phases) /= seeds) error stop 'breather_25: phases must have size 1'
      phi = phases
    end if
    if (present(Q)) then
      if (size(Q, 1) /= modes .or. size(Q, 2) /= size(t)) &
        error stop 'breather_25: Q must have shape (31, size(t))'
    end if
    if (present(P)) then
      if (size(P, 1) /= modes .or. size(P, 2) /= size(t)) &
        error stop 'breather_25: P must have shape (31, size(t))'
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

end module breather_25

#ifdef BREATHER_25_SELF_TEST
program breather_25_self_test
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use breather_25, only: orbit, energy
  implicit none
  real(rk), save :: t(3), positions_of_t(31, 3), momenta_of_t(31, 3), energies_of_t(3)
  real(rk) :: Q(31, 3), P(31, 3), H(3), found(3)
  integer :: i
  data (t(i), i = 1, 3) / &
    0d0,1.234375d0,137.796875d0 /
  data (positions_of_t(i, 1), i = 1, 31) / &
    0d0,0d0,9.6440409364052d-13,0d0,-2.959726100310401d-29,-2.7028087824828355d-22,0d0,4.129035114381462d-19,0d0,0d0, &
    5.86862968847394d-07,0d0,0d0,0.00013182274795015445d0,0d0,0d0,-6.544504067905475d-17,0d0,-3.04500559400546d-24, &
    -7.759455517715154d-27,0d0,7.7891871909677d-15,0d0,0d0,0.05121216565869737d0,0d0,0d0,-7.787567172724107d-11,0d0, &
    0d0,1.9839515513923868d-20 /
  data (positions_of_t(i, 2), i = 1, 31) / &
    0d0,0d0,-7.241679553402571d-13,0d0,2.085251235081777d-29,-2.7715760804947482d-22,0d0,4.259631807399359d-19,0d0, &
    0d0,-4.06319492161124d-07,0d0,0d0,0.0001524067436239879d0,0d0,0d0,4.069823385205482d-17,0d0, &
    2.087752789484391d-24,-1.0977724620074538d-26,0d0,3.318878725767714d-15,0d0,0d0,-0.035043730852875585d0,0d0,0d0, &
    4.83128734278628d-10,0d0,0d0,-1.3589683746960516d-20 /
  data (positions_of_t(i, 3), i = 1, 31) / &
    0d0,0d0,-3.330365598752126d-13,0d0,9.201257395678256d-30,-2.8209523602299377d-22,0d0,4.3349463894918926d-19,0d0, &
    0d0,-1.771376638489641d-07,0d0,0d0,0.00016714428250076417d0,0d0,0d0,1.6317659798916568d-17,0d0, &
    9.039102548579908d-25,-1.328435642606408d-26,0d0,7.06830281146286d-18,0d0,0d0,-0.01515105813937161d0,0d0,0d0, &
    8.874460005629892d-10,0d0,0d0,-5.880112226135846d-21 /
  data (momenta_of_t(i, 1), i = 1, 31) / &
    0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0,0d0, &
    0d0,0d0,0d0 /
  data (momenta_of_t(i, 2), i = 1, 31) / &
    0d0,0d0,-1.2257722678242292d-12,0d0,3.972521578464938d-29,2.4343241552803087d-23,0d0,-4.0937039815554095d-20,0d0, &
    0d0,-7.986230819540658d-07,0d0,0d0,-7.274601515061997d-05,0d0,0d0,9.619674303442335d-17,0d0, &
    4.1749854608382265d-24,1.1380722383753839d-26,0d0,1.611804303999065d-14,0d0,0d0,-0.07032274297416995d0,0d0,0d0, &
    -1.9902847337896515d-09,0d0,0d0,-2.721932753244561d-20 /
  data (momenta_of_t(i, 3), i = 1, 31) / &
    0d0,0d0,-1.969055196177369d-12,0d0,5.542475596871481d-29,1.382033677472267d-23,0d0,-1.891868102921784d-20,0d0, &
    0d0,-1.072906910497186d-06,0d0,0d0,-4.119995946184042d-05,0d0,0d0,1.0280128098752744d-16,0d0, &
    5.49224856465438d-24,6.451238643622989d-27,0d0,9.3884995959541d-15,0d0,0d0,-0.09211927600971585d0,0d0,0d0, &
    -1.1333973049153177d-09,0d0,0d0,-3.5737961449745376d-20 /
  data (energies_of_t(i), i = 1, 3) / &
    0.004649999361129205d0,0.004649999361129205d0,0.004649999361129205d0 /
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
end program breather_25_self_test
#endif
