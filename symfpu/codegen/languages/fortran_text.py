"""The Fortran that is the same in every exported file; words after a dollar are filled in by symfpu.codegen.languages.fortran."""

HEADER = """\
! Machine-written: a quasi-periodic solution of an FPU chain,
!
!     Q_q(t) = sum over nu of c_q[nu] cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1.
!
$facts
!
! How to call. Compile this file before your program, which says
!
!     use $name, only: positions, momenta, orbit, harmonic_energies, energy
!     use, intrinsic :: iso_fortran_env, only: real64
!     real(real64) :: t(n), Q($modes, n), P($modes, n), E($modes, n), H(n), phases($seeds)
!     call positions(t, Q)                 ! or positions(t, Q, phases)
!     call momenta(t, P)                   ! or momenta(t, P, phases)
!     call orbit(t, Q, P)                  ! or orbit(t, Q, P, phases)
!     call harmonic_energies(t, E)         ! or harmonic_energies(t, E, phases)
!     call energy(t, H)                    ! or energy(t, H, phases)
!
!   t        n times, any real numbers
!   Q, P, E  (N-1, n) = ($modes, n): Q(q, i) is mode q at time t(i); in memory the time is slowest, as in the C files
!   H        (n)
!   phases   ($seeds): angles phi in radians, one a seed in the order above; left out, they are
$default
!
! Two such modules in one program: use $name, only: ${name}_positions => positions.
! All quantities are dimensionless. E_q = (P_q**2 + Omega_q**2 Q_q**2) / 2 is the energy of mode q, H the total energy.
! Arrays of other shapes stop the program. Tables are only read and work arrays are allocated by each call: the
! procedures may be called from several threads.
!
! Accuracy: omega t is reduced to one turn without loss up to |t| of about 1e14; the sums are those of doubles, some
! 1e-15 of the largest coordinate. A time that is not finite, or above 1e38, gives NaN. Compile without -ffast-math.
!
! Self-test: gfortran -std=f2008 -O2 -D$macro FILE.F90 && ./a.out
! prints the largest deviation from embedded vectors and fails above $tolerance.
"""

MODULE = """
module $name
  use, intrinsic :: iso_fortran_env, only: rk => real64, single => real32
  implicit none
  private
  public :: positions, momenta, orbit, harmonic_energies, energy

  integer, parameter :: bonds = $bonds, modes = $modes, seeds = $seeds
  integer, parameter :: highest = $highest  ! largest number in a harmonic
  integer, parameter :: times = $times, tile = $tile  ! evaluated together, and harmonics of one matrix product
  real(rk), parameter :: two_pi = 6.283185307179586d0
  real(rk), parameter :: cubic = $cubic  ! alpha / 3
  real(rk), parameter :: quartic = $quartic  ! beta / 4
  integer :: i  ! of the tables
"""

FUNCTIONS = """
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
    if (size(E, 1) /= modes .or. size(E, 2) /= size(t)) error stop 'harmonic_energies: E must have shape ($modes, size(t))'
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
"""

CHECKS = """\
    if (present(phases)) then
      if (size(phases) /= seeds) error stop '$name: phases must have size $seeds'
      phi = phases
    end if
    if (present(Q)) then
      if (size(Q, 1) /= modes .or. size(Q, 2) /= size(t)) error stop '$name: Q must have shape ($modes, size(t))'
    end if
    if (present(P)) then
      if (size(P, 1) /= modes .or. size(P, 2) /= size(t)) error stop '$name: P must have shape ($modes, size(t))'
    end if
"""

EVALUATE = (
    """
  ! The sums over all harmonics, at blocks of times.
  subroutine evaluate(t, $arguments, Q, P)
    real(rk), intent(in) :: t(:)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(out), optional :: Q(:, :), P(:, :)
    real(rk), allocatable :: re(:, :, :), im(:, :, :), cosine_sums(:, :), sine_sums(:, :)
$declarations
    integer :: first, last, n, seed, k
    logical :: moving(2)
    moving = [present(Q), present(P)]
$start
"""
    + CHECKS
    + """\
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
$calls
      if (present(Q)) Q(:, first:last) = transpose(cosine_sums(1:n, :))
      if (present(P)) P(:, first:last) = transpose(sine_sums(1:n, :))
    end do
  end subroutine evaluate
"""
)

ANGLES = """
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
"""

HARMONICS = """
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
"""

END = """
end module $name
"""

DEVIATION = """
contains

  ! Largest deviation relative to the largest expected value; NaN if a value is none.
  function deviation(values, expected) result(worst)
    real(rk), intent(in) :: values(:), expected(:)
    real(rk) :: worst
    worst = maxval(abs(values - expected))
    if (.not. all(abs(values) <= huge(worst))) worst = sum(values)
    if (maxval(abs(expected)) > 0) worst = worst / maxval(abs(expected))
  end function deviation
"""

SELF_TEST = (
    """
#ifdef $macro
program ${name}_self_test
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use $name, only: orbit, energy
  implicit none
  real(rk), save :: t($checks), positions_of_t($modes, $checks), momenta_of_t($modes, $checks), energies_of_t($checks)
  real(rk) :: Q($modes, $checks), P($modes, $checks), H($checks), found(3)
  integer :: i
@DATA@
  call orbit(t, Q, P)
  call energy(t, H)
  found = [deviation(reshape(Q, [size(Q)]), reshape(positions_of_t, [size(Q)])), &
    deviation(reshape(P, [size(P)]), reshape(momenta_of_t, [size(P)])), deviation(H, energies_of_t)]
  print '(a, 3(es9.2, a))', 'largest deviation: ', found(1), ' of the largest coordinate, ', found(2), &
    ' of the largest momentum, ', found(3), ' of the energy'
  if (.not. all(found <= $tolerance)) error stop 'the deviation is above $tolerance'
"""
    + DEVIATION
    + """\
end program ${name}_self_test
#endif
"""
)
