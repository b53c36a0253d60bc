"""Every tolerance of the suite, each with its reason. EPS is the spacing of doubles at one."""

EPS = 2.0**-52

# Sums of a few dozen products of numbers of order one, each rounded once.
ROUNDING = 256 * EPS

# Couplings are integers; the sums over bonds that give them are rounded about N times.
INTEGER = 1e-12

# A coefficient of order k <= 12 went through 2k transforms over up to nine bonds, sums over tens of monomials, and k
# multipliers: some hundred EPS, relative to the largest coefficient of the order, since bonds mix the modes.
COEFFICIENT = 1024 * EPS

# The reference values were made from decimal frequencies; omega - Omega, some 1e-4, is known to full accuracy, but
# the sum of the frequency series is rounded and its derivative by A is about 2 (omega - Omega) / A.
AMPLITUDE = 1e-13

# The periodic orbits are printed with 12 and 11 digits; at orders 50 and 20 the series has converged.
PERIODIC_ORBIT = 1e-11

# Both factors of a divisor keep their remainders: a multiplier is rounded a few times, however high the series goes.
MULTIPLIER = 1e-14

# Eighth-order central differences with step h = 0.02 of functions with rates up to about 4: (4 h)^8 and EPS / h.
DIFFERENCE = 1e-9

# Integration with relative tolerance 1e-12 over some hundred time units: the error grows linearly with the time.
ORBIT = 1e-9

# A fitted slope against an integer: the next order changes it by about mu.
SLOPE = 0.1

# Simpson quadrature with a thousand points a period: (2 pi / 1000)^4.
QUADRATURE = 1e-8

# Averages over an equidistant grid of angles are exact for trigonometric polynomials that it resolves.
GRID_AVERAGE = 1e-12

# The series of the one-mode reductions at amplitude 0.1 and order 20: the first term left out is below EPS.
ELLIPTIC = 1e-13

# Both routes at 40 digits; a few of them go into cancellations between the largest terms.
HIGH_PRECISION = 1e-32

# Omega - nu.omega of 1e-13 keeps its digits, since both are split on a grid on which the difference is exact; what is
# left is the rounding of the sum of the two frequencies, of the quotient and of the stored remainders.
NEAR_RESONANCE = 1e-14

# Rounding by balanced limbs, in units of the last place: one half, and the limbs below the next one.
NEAREST = 0.5 + 2.0**-18

# What `digits=40` promises: coefficients to so many digits of the largest one of their order. Ours are divided by Omega_q
# and multiplied by powers of Omega_i <= 2, and largest ones of two different modes are compared: one digit.
FORTY_DIGITS = 1e-39

# A printed number of 40 decimal places, correctly rounded: half of the last one, and what a longer print would show.
LAST_PLACE = 0.5001e-40

# A torus of many digits against the one of doubles: its amplitudes carry AMPLITUDE, and everything else follows from them
# with factors of a few.
SAME_AS_DOUBLES = 16 * AMPLITUDE

# Small amplitudes and high orders: the next order of a beta breather at A = 0.01 is some (beta A^2 Omega^2 / 8)^9.
TINY_RESIDUAL = 1e-25

# Wynn's table of seven columns in doubles against mpmath's linear system: each column loses about a digit in its differences.
PADE_TABLE = 1e-9

# A torus that has converged to the rounding of doubles, and its Pade sums: the last column of a table of twenty is rounded
# in differences of converged sums, some thousand EPS.
RESUMMED = 1e-12

# Poles line the cut from a branch point on: the nearest one of [n/n] lies beyond it by some (1/n)^2 to 1/n.
BRANCH_POINT = 0.03

# Residuals of some 1e-5 of the accelerations, from coefficients summed in another order: EPS / 1e-5.
RESIDUAL_ROUNDING = 1e-9

# Ratios of terms at order 30 against their limit: they alternate around it and come nearer by 0.6 every two orders.
TERM_RATIO = 1e-3

# Frequencies changed in their eleventh digit, with a divisor of 3e-5 among those of the series.
ALIKE = 1e-3

# Domb and Sykes' fit to ratios of doubles at order 150.
SINGULARITY = 2e-6

# Amplitudes to frequencies and back: both are solved to some hundred EPS of the shift, and the matrix between shifts and A^2 has
# a condition of up to some ten.
THERE_AND_BACK = 1e-12

# What a torus of a given energy promises, with some rounding of H.
FIXED_ENERGY = 1e-12

# Amplitudes and energies of one exact torus by two solvers, or with two sets of harmonics: the twelve digits that are promised.
CONVERGED_DIGITS = 5e-13

# The slope between the last two of tori whose amplitudes are halved: the next order changes it by some mu A / 16.
RATE_OF_MU = 0.01
