"""The Fortran of exported series that no torus has; words after a dollar are filled in by symfpu.codegen.languages.fortran_series."""

HEADER = """\
! Machine-written: quasi-periodic solutions of an FPU chain with free amplitudes A, one a seed,
!
!     Q_q(t) = sum over nu of c_q[nu]($of) cos(nu.(omega t + phi)),   P_q = dQ_q/dt,   q = 1 .. N-1,
!
! and their frequencies corrected by the amplitudes, omega(A).
!
@FACTS@
!
! How to call. Compile this file before your program, which says
!
!     use $name, only: positions, momenta, orbit, corrected_frequencies
!     use, intrinsic :: iso_fortran_env, only: real64
!     real(real64) :: t(n), Q($modes, n), P($modes, n), amplitudes($seeds), phases($seeds), frequencies($seeds)
!     real(real64) :: omega($seeds), jacobian($seeds, $seeds)
$examples
!
!   t            n times, any real numbers
!   Q, P         (N-1, n) = ($modes, n): Q(q, i) is mode q at time t(i); in memory the time is slowest, as in the C files
!   amplitudes   ($seeds): A, one a seed in the order above; Q_q = A_q cos(omega_q t + phi_q) + ... for a seed q
!   phases       ($seeds): angles phi in radians; left out, they are zero
$frequencies
!   omega        ($seeds): the corrected frequencies omega(A)
!   jacobian     ($seeds, $seeds): jacobian(i, j) is the derivative of omega(i) by amplitudes(j)$fixed
!
! Two such modules in one program: use $name, only: ${name}_positions => positions.
! All quantities are dimensionless. How well the equations of motion hold depends on the amplitudes, and on frequencies
! being omega(A). Arrays of other shapes stop the program.
! $form
! The procedures may be called from several threads.
!
! Accuracy: omega t, with omega the doubles of this call, is reduced to one turn without loss up to |t| of about 1e14.
! The sums are those of doubles, some 1e-15 of the largest coordinate while higher powers of the amplitudes are smaller
! than lower ones. $rounded
! A time that is not finite, or above 1e38, gives NaN. Compile without -ffast-math.
!
! Self-test: gfortran -std=f2008 -O2 -D$macro FILE.F90 && ./a.out
! prints the largest deviation from embedded vectors and fails above $tolerance.
"""

NUMERIC_EXAMPLES = """\
!     call corrected_frequencies(amplitudes, omega)   ! or corrected_frequencies(amplitudes, omega, jacobian)
!     call positions(t, amplitudes, Q)                ! or positions(t, amplitudes, Q, phases, frequencies)
!     call momenta(t, amplitudes, P)                  ! or momenta(t, amplitudes, P, phases, frequencies)
!     call orbit(t, amplitudes, Q, P)                 ! or orbit(t, amplitudes, Q, P, phases, frequencies)"""

NUMERIC_FREQUENCIES = """\
!   frequencies  ($seeds): the omega with which the angles turn, radians a unit of time; left out, they are omega(A). The
!                divisors have the frequencies named above, whatever these are"""

UNIVERSAL_EXAMPLES = """\
!     call corrected_frequencies(amplitudes, frequencies, omega)   ! or (amplitudes, frequencies, omega, jacobian)
!     call positions(t, amplitudes, frequencies, Q)                ! or positions(t, amplitudes, frequencies, Q, phases)
!     call momenta(t, amplitudes, frequencies, P)                  ! or momenta(t, amplitudes, frequencies, P, phases)
!     call orbit(t, amplitudes, frequencies, Q, P)                 ! or orbit(t, amplitudes, frequencies, Q, P, phases)"""

UNIVERSAL_FREQUENCIES = """\
!   frequencies  ($seeds): the omega with which the angles turn, radians a unit of time, and of the divisors. A solution has
!                frequencies equal to the corrected ones"""

ROUNDED = "Left out, frequencies have the rounding of doubles: after a time t, angles are off by some 1e-16 |t|."

STRAIGHT_FORM = "A call computes the coefficients of all harmonics first: give it many times at once."

TABLE_FORM = """\
A call sums the powers of the amplitudes in all $coefficients coefficients first: give it many times at once. Tables are
! only read and work arrays are allocated by each call."""

MODULE = """
module $name
  use, intrinsic :: iso_fortran_env, only: rk => real64, single => real32
  implicit none
  private
  public :: positions, momenta, orbit, corrected_frequencies

  integer, parameter :: modes = $modes, seeds = $seeds
  real(rk), parameter :: two_pi = 6.283185307179586d0
  ! 1 / (2 pi) in three parts, exact in doubles
  real(rk), parameter :: radian(3) = [$radian]
"""

TABLE_SIZES = """\
  integer, parameter :: highest = $highest  ! largest number in a harmonic
  integer, parameter :: degree = $degree  ! largest power of an amplitude
  integer, parameter :: monomials = $monomials, corrections = $corrections
  integer, parameter :: times = $times, tile = $tile  ! evaluated together, and harmonics of one matrix product
  integer :: i  ! of the tables
"""

FUNCTIONS = """
contains

  ! Mode coordinates Q(q, i) = Q_q(t(i)).
  subroutine positions(t, amplitudes, ${before}Q, phases$after)
    real(rk), intent(in) :: t(:), amplitudes(:)
    real(rk), intent(out) :: Q(:, :)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(in)$optional :: frequencies(:)
    call evaluate(t, amplitudes, phases, frequencies, Q=Q)
  end subroutine positions

  ! Mode momenta P(q, i) = dQ_q/dt at t(i).
  subroutine momenta(t, amplitudes, ${before}P, phases$after)
    real(rk), intent(in) :: t(:), amplitudes(:)
    real(rk), intent(out) :: P(:, :)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(in)$optional :: frequencies(:)
    call evaluate(t, amplitudes, phases, frequencies, P=P)
  end subroutine momenta

  ! Coordinates and momenta at the cost of little more than one of them.
  subroutine orbit(t, amplitudes, ${before}Q, P, phases$after)
    real(rk), intent(in) :: t(:), amplitudes(:)
    real(rk), intent(out) :: Q(:, :), P(:, :)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(in)$optional :: frequencies(:)
    call evaluate(t, amplitudes, phases, frequencies, Q, P)
  end subroutine orbit

  ! Frequencies omega(A), and their derivatives: jacobian(i, j) = d omega(i) / d amplitudes(j).
  subroutine corrected_frequencies(amplitudes, ${before}omega, jacobian)
    real(rk), intent(in) :: amplitudes(:)$given
    real(rk), intent(out) :: omega(:)
    real(rk), intent(out), optional :: jacobian(:, :)
$locals
    if (size(amplitudes) /= seeds) error stop '$name: amplitudes must have size $seeds'
$given_check    if (size(omega) /= seeds) error stop '$name: omega must have size $seeds'
    if (present(jacobian)) then
      if (any(shape(jacobian) /= seeds)) error stop '$name: jacobian must have shape ($seeds, $seeds)'
    end if
$corrected
  end subroutine corrected_frequencies
"""

CORRECTED_LOCALS = """\
    real(rk) :: power(0:degree, seeds), slope
    integer :: f, j, k"""

GIVEN_CHECK = "    if (size(frequencies) /= seeds) error stop '$name: frequencies must have size $seeds'\n"

CORRECTED = """\
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
    end do"""

FREQUENCIES = {
    False: """\
    if (size(amplitudes) /= seeds) error stop '$name: amplitudes must have size $seeds'
    if (present(frequencies)) then
      if (size(frequencies) /= seeds) error stop '$name: frequencies must have size $seeds'
      omega = frequencies
    else
      call corrected_frequencies(amplitudes, omega)
    end if
""",
    True: """\
    if (size(amplitudes) /= seeds) error stop '$name: amplitudes must have size $seeds'
    if (size(frequencies) /= seeds) error stop '$name: frequencies must have size $seeds'
    omega = frequencies
""",
}

TURNING = """\
    phi = 0
    do seed = 1, seeds
      turns(:, seed) = turns_of(omega(seed))
    end do"""

TABLE_DECLARATIONS = """\
    real(rk), intent(in) :: amplitudes(:)
    real(rk), intent(in)$optional :: frequencies(:)
    real(rk), allocatable :: monomial(:)
$arrays
    real(rk) :: phi(seeds), omega(seeds), turns(3, seeds), power(0:degree, seeds)
    integer :: j"""

TABLE_START = """
    call fill_amplitude_powers(amplitudes, power)
    allocate (monomial(monomials))
    do k = 1, monomials
      monomial(k) = product([(power(exponents(k, j), j), j = 1, seeds)])
    end do
$collapses"""

STRAIGHT_HEAD = """
  ! Coefficients at these amplitudes, once; then waves and their sums at every time.
  subroutine evaluate(t, amplitudes, phases, frequencies, Q, P)
    real(rk), intent(in) :: t(:), amplitudes(:)
    real(rk), intent(in), optional :: phases(:)
    real(rk), intent(in)$optional :: frequencies(:)
    real(rk), intent(out), optional :: Q(:, :), P(:, :)
    real(rk) :: phi(seeds), omega(seeds), turns(3, seeds)
$declarations
    integer :: k, seed
$start
"""

STRAIGHT_LOOP = """\
$coefficients
    do k = 1, size(t)
$waves
      if (present(Q)) then
$positions
      end if
      if (present(P)) then
$momenta
      end if
    end do
  end subroutine evaluate
"""

POWERS = """
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
"""

TURNS = """
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
"""

SELF_TEST_HEAD = """
#ifdef $macro
program ${name}_self_test
  use, intrinsic :: iso_fortran_env, only: rk => real64
  use $name, only: orbit, corrected_frequencies
  implicit none
  real(rk), save :: t($checks), positions_of_t($modes, $checks), momenta_of_t($modes, $checks)
  real(rk), save :: amplitudes($seeds), phases($seeds), frequencies($seeds), exact_omega($seeds), exact_slopes($seeds, $seeds)
  real(rk) :: Q($modes, $checks), P($modes, $checks), omega($seeds), slopes($seeds, $seeds), found(4)
  integer :: i
@DATA@
  call orbit(t, amplitudes, ${before}Q, P, phases$after)
  call corrected_frequencies(amplitudes, ${before}omega, slopes)
  found = [deviation(reshape(Q, [size(Q)]), reshape(positions_of_t, [size(Q)])), &
    deviation(reshape(P, [size(P)]), reshape(momenta_of_t, [size(P)])), deviation(omega, exact_omega), &
    deviation(reshape(slopes, [size(slopes)]), reshape(exact_slopes, [size(slopes)]))]
  print '(a, 4(es9.2, a))', 'largest deviation: ', found(1), ' of the largest coordinate, ', found(2), &
    ' of the largest momentum, ', found(3), ' of the largest frequency, ', found(4), ' of the largest derivative'
  if (.not. all(found <= $tolerance)) error stop 'the deviation is above $tolerance'
"""

SELF_TEST_END = """\
end program ${name}_self_test
#endif
"""
