"""Every tolerance of the suite, each with its reason. EPS is the spacing of doubles at one."""

EPS = 2.0**-52

# Sums of a few dozen products of numbers of order one, each rounded once.
ROUNDING = 256 * EPS

# Couplings are integers; the sums over bonds that give them are rounded about N times.
INTEGER = 1e-12

# A coefficient of order k <= 12 went through 2k transforms over up to nine bonds, sums over tens of monomials, and k
# multipliers: some hundred EPS, relative to the largest coefficient of the order, since bonds mix the modes.
COEFFICIENT = 1024 * EPS

# Next to resonances that multiply a small harmonic by 10 at each of some 20 orders, k <= 60: 6e-12 for beta with omega_1 =
# 0.0990 (harmonic 19 in mode 25), as bonds mix its modes. Products in the angle, which mix harmonics, leave 1e-8 there.
HIGH_ORDER = 2**17 * EPS

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

# What a torus of a given energy, or of a given ratio of energies, promises, with some rounding of H.
FIXED_ENERGY = 1e-12

# Amplitudes and energies of one exact torus by two solvers, or with two sets of harmonics: the twelve digits that are promised.
CONVERGED_DIGITS = 5e-13

# The slope between the last two of tori whose amplitudes are halved: the next order changes it by some mu A / 16.
RATE_OF_MU = 0.01

# Roundings of doubles, by how many there are.

# One number by two ways of a rounding or two: a mean, a quotient, a frequency that is read back.
LAST_DIGIT = 1e-15

# Some ten roundings, or a number written with fifteen digits.
TEN_ROUNDINGS = 1e-14

# Some hundred operations on numbers of order one, each rounded once, or so many sums in another order.
HUNDRED_ROUNDINGS = 1e-13

# Sums of a thousand terms in another order, loops of a thousand steps and products of matrices, each rounded once.
THOUSAND_ROUNDINGS = 1e-12

# Least squares with a condition of some 1e3, of data that are rounded once; twice, where the fits are fitted.
LEAST_SQUARES = 1e-10

# Quotients and logarithms of numbers up to 1e5 against whole ones: 1e5 EPS.
WHOLE_NUMBERS = 1e-9

# Shifts omega - Omega are some 1e-4 of the frequencies, or less, and differences of them: EPS over that, and what follows from it.
RELATIVE_SHIFT = 1e-9

# The same with shifts of some 1e-6.
SMALL_SHIFT = 1e-8

# Differences that are some 1e-9 of the numbers they are taken of, relative to themselves.
DIFFERENCE_OF_DOUBLES = 1e-6

# Solutions: residuals, conditions and what they are known to.

# What `refine` promises by default.
PROMISED_RESIDUAL = 1e-13

# Newton ends at steps of 1e-14; small divisors, some 1e-4, and times between the grid points magnify the rounding of the equations.
NEWTON_RESIDUAL = 1e-12

# Energies and amplitudes that are conditions of Newton's method are met to the rounding of doubles.
CONDITION = 1e-13

# What `refine` is asked for where few harmonics are to do, what its longest ones leave out, and what errors of that size change.
LOW_ACCURACY = 1e-6

# The residual that is asked for on the command line.
COMMANDED_RESIDUAL = 1e-8

# What `refine` is asked for where harmonics are counted.
HIGH_ACCURACY = 1e-11

# Coefficients are rounded once to doubles; before, they are solved to 1e-17 times the condition of Newton's matrix, that of
# amplitudes by frequencies: omega over its shift, some 1e4.
REFINED_COEFFICIENT = 1e-13

# What forces in doubles change of amplitudes and coefficients, where `refine` takes them: they are expected to be off by 1e-14 at most.
FORCES_IN_DOUBLES = 2e-14

# What they would lose of a torus with amplitudes of 1e-4: 1e-12 were met.
LOST_IN_DOUBLES = 1e-13

# The longest of the harmonics that are left out are below 1e-3 of the tolerance; those and small divisors, some 1e-2, leave this.
BREATHER_HARMONICS = 1e-12

# Shifts feel left out harmonics by the square of their coefficients.
FEW_HARMONICS = 1e-9

# Residuals in long doubles are not zero: below this there would be nothing that was computed.
LONG_DOUBLE_RESIDUAL = 1e-17

# Amplitudes that stand with fourteen digits.
FOURTEEN_DIGITS = 6e-15

# Two solvers of one orbit, each to its rounding over the smallest divisor, some 1e-4.
SAME_ORBIT = 1e-11

# Frequencies of one mode in its potential: rounding of sigma and of the energy, both relative.
ONE_MODE_FREQUENCY = 1e-12

# DOP853 at rtol 1e-13 over one period; the breathers are stable, so that errors grow linearly.
PERIOD_RETURN = 1e-12

# Central differences of second order with step h = 6e-4 of rates about 1: h^2 / 6, for a few harmonics.
CENTRAL_DIFFERENCE = 1e-6

# What rounding leaves of a difference over a step of some 1e-5: EPS over the step.
DIFFERENCE_ROUNDING = 1e-10

# An orbit in doubles, relative to its largest coefficient: its Newton steps end at 1e-14, small divisors magnify rounding.
ORBIT_IN_DOUBLES = 1e-13

# An amplitude by shooting: omega - Omega is magnified in A; a relative error of the period of 1e-16 is 1e-16 omega / (2 (omega - Omega))
# in A, 1e-11 at the smallest amplitude looked at, that of seed 25.
SHOT_AMPLITUDE = 2e-11

# Shooting: half a period, relative to its largest number, some roundings; the relative Newton step that ends the search at once, and
# the one that ends it when residuals shrink no more, whose square is below rounding.
SHOT_HALF_PERIOD = 1e-15
SHOT_STEP = 1e-14
SHOT_LAST_STEP = 1e-9

# Members of a family at an energy and by harmonic balance, with harmonics to a tolerance of 1e-10.
LOOSE_MEMBER = 1e-8

# The shift is known to 1e-18, some 1e-11 of itself; the place of its minimum to the root of that at worst, in relation to H.
FOLD = 1e-6

# The oracle has 48 harmonics of dt/dphi; the 48th of the slowest orbit looked at leaves some 3e-12 of the amplitude.
OSCILLATOR = 1e-11

# Energies of located resonances, relative; Newton's method solves for the divisor itself, to some 1e-15.
RESONANCE_ENERGY = 1e-8

# The resonant amplitude at the energy of the resonance as doubles have it: it changes by 1e4 of the energy's change.
RESONANT_AMPLITUDE = 1e-4

# The way back to the linear limit: what other modes still take part, of the shift.
LINEAR_LIMIT = 1e-5

# Maps of a period.

# DOP853 at rtol 1e-13 along an unstable orbit: errors grow with the largest multiplier, here below 2, in some hundred steps.
VARIATIONS = 1e-11

# Eigenvalues of a map that is known to VARIATIONS: a condition of some ten.
EIGENVALUES = 1e-9

# The error of half a period is held to 1e-12; a period and 62 columns make some of it.
MONODROMY = 1e-11

# Sums of multipliers and of their squares against traces of such a map: ten times that.
TRACES = 1e-10

# Multipliers at amplitude 1e-4 differ from those of rest by (alpha A)^2 / N and the like, times T.
MAP_AT_REST = 1e-7

# Multipliers of two schemes: five halvings of the step leave 1e-10 of the map by a scheme of order 4, and some tens of that.
MAP_BY_SCHEME = 1e-8

# Angles of multipliers that meet at 1 are roots of what rounding leaves there: half of the digits.
DOUBLE_MULTIPLIER = 1e-5

# Orbits.

# Accuracies of the peer's steps that tests ask for, relative and absolute.
PEER_RELATIVE, PEER_ABSOLUTE = 1e-13, 1e-16

# The same where it only has to find when an orbit escapes.
ESCAPE_RELATIVE, ESCAPE_ABSOLUTE = 1e-10, 1e-12

# Coefficients of schemes are rounded to doubles; up to 18 of them, the largest 1.7.
SCHEME_COEFFICIENTS = 4e-16

# What a tangent map promises: some dozen stages with rounded products of matrices of norm about one.
TANGENT_MAP = 1e-13

# Relative change of H by steps that are short against the periods: rounding alone, a random walk.
ENERGY_WALK = 1e-12

# The same with the errors of the scheme, by how long its steps are.
ENERGY_SHORT_STEPS, ENERGY_STEPS, ENERGY_LONG_STEPS = 1e-11, 1e-8, 1e-5

# A scheme far below the rounding of the largest mode follows tails in mode space: relative errors of every mode.
TAIL = 1e-8

# Errors of one mode at forty times as many steps.
FORTY_TIMES_THE_STEPS = 1e-7

# Orbits of a torus against the torus where the step leaves more than rounding.
STEP_ERROR = 1e-10

# The same with steps that a command of a test can afford.
COARSE_STEP_ERROR = 1e-5

# Logarithms of volumes after a thousand blocks, each of whose factors is right to 1e-16 times a squeeze of 1e5 at most.
SAME_VOLUME = 1e-8

# The same where runs were cut elsewhere, and vectors have aligned in between.
CUT_VOLUME = 1e-6

# The same by two schemes, each with its own error of the step.
VOLUME_BY_SCHEME = 1e-4

# Slopes of the indices of tori over the last decades.
GALI_SLOPE = 0.25

# Exponents of two frames at one finite time.
LYAPUNOV = 0.01

# The exponent of a regular orbit falls as log t / t, up to a factor of order one.
REGULAR_EXPONENT = 0.5

# The observed order of a scheme between two steps: the next order takes part.
OBSERVED_ORDER = 0.5

# Times are whole steps: differences of their logarithms are even to so much.
LOG_SPACING = 0.1

# The same of the last of fifty samples.
LATE_LOG_SPACING = 0.03

# Seconds of a machine that others use, too: a factor of about two; by the command line, and of loops alone.
COMMANDED_SECONDS, SECONDS = 0.9, 1

# The energy of an escape where the peer sees it, a step away.
ESCAPE_ENERGY = 0.1

# Lengths of time in decades, by some 70 samples in each; where a bend falls on a sample.
DECADES, LATE_DECADES = 0.1, 0.01

# Numbers that are stated, by their digits or decimal places: half a unit of the last, or one unit where both sides are rounded.
TWO_DIGITS = 0.02
FOUR_DIGITS = 1e-3
FIVE_DIGITS = 1e-4
SEVEN_DIGITS = 1e-6
EIGHT_DIGITS = 1e-7
TWELVE_DIGITS = 5e-12
ONE_PLACE = 0.05
FOUR_PLACES = 1e-4
FIVE_PLACES = 1e-5
SIX_PLACES = 1e-6
TEN_PLACES = 1e-10
THIRTEEN_PLACES = 1e-13

# Bounds that tell what is there from what is not.

# Two numbers that must not be the same differ by more than a thousandth; energies with and without a small anharmonic part by less.
DISTINCTION, SMALL_DISTINCTION = 1e-3, 1e-4

# Changes by terms that are some ten times smaller than this.
SMALL_CHANGE = 1e-3

# Errors and terms that must be there, far above rounding.
PRESENCE = 1e-5

# Errors of a coarse step that must be there.
COARSE_STEP = 1e-6

# Random points that would hide a term: a bound of the probability.
ERROR_PROBABILITY = 1e-6

# Near resonances that tests choose: 2 omega_1 = Omega_2 to eight digits.
CHOSEN_RESONANCE = 2e-9

# Bounds are radii and the rounding of the sums that made them, in units of the last place.
RADIUS_ROUNDING = 1e-9

# Radii of moduli that are enlarged by 2^-20 each, against radii of the moduli themselves: two factors in each of up to 30
# products on the way to an order.
RADIUS_ENLARGED = 1 + 2.0**-13

# Radii by differential equations and by powers of the stretch, both enlarged as doubles round; the
# measured ones of the former are 0.01 to 2 times the latter.
RADIUS_OF_GROWTHS = 3

# Modes of tails that a test is about lie below these.
FAR_TAIL, TAIL_MODE = 1e-35, 1e-30

# Energies of rounding over those of the truth: a tail that doubles do not see, in squares.
UNSEEN_TAIL = 1e-20

# Errors of coefficients that are known, of the amplitude.
KNOWN_ERROR = 1e-10

# Many digits, by how many are asked for and what the test's own arithmetic leaves.

# 80 digits of a test of an orbit of 40.
BOUND_OF_FORTY = 1e-40

# A bound after the last digits were spoilt in the 28th to 30th place: between these.
SPOILT_LEAST, SPOILT_MOST = 1e-31, 1e-27

# A vector of 40 digits in and out of modes loses two of them, products of matrices three.
TRANSFORM_OF_FORTY, PRODUCT_OF_FORTY = 1e-38, 1e-37

# Energies of states in 50 digits from a torus of 45.
ENERGY_OF_FIFTY = 1e-44

# Sources of 30 digits with sums in another order.
SOURCE_OF_THIRTY = 1e-28

# Amplitudes to 28 digits, the series to order 16.
AMPLITUDE_OF_TWENTY_EIGHT = 1e-26

# Residuals of short series with many digits, far below doubles: the first order that is left out.
SERIES_RESIDUAL, LONG_SERIES_RESIDUAL = 1e-20, 1e-24

# Series, sums and limits.

# Issue 5: of the largest coordinate, momentum or energy; rounded sums leave some 1e-15.
OF_LARGEST = 1e-13

# V at 45 digits: the closed form adds the digits that it loses, and the last one is rounded.
BOND_OF_FORTY_FIVE = 1e-44

# Issue 5: of a mode's own largest value; cancelling terms cost a digit or two.
OF_TAIL = 1e-12

# Residuals of doubles above 1e-9 of the accelerations: cancellations leave 1e-13 of these.
DOUBLE_RESIDUAL = 1e-4

# The sum of moduli of order 14 with mu^k in it, by Fig. 1(c) some 1e-6: between these.
STATED_LEAST, STATED_MOST = 1e-6, 1e-5

# Poles of Pade sums of ten terms: roots of a denominator of doubles.
POLES = 1e-6

# What one rounding of a small double leaves; on another machine it may be 0.
LEAST_OF_DOUBLES = 1e-22

# Amplitudes of given resummed frequencies: a root finder in doubles on quotients of polynomials.
RESUMMED_AMPLITUDE = 1e-9

# Slopes of the frequencies of waves by central differences of squares of amplitudes: the cube of the step, and rounding over it.
WAVE_SLOPE, WAVE_SLOPE_ROUNDING = 1e-6, 1e-8

# The divergent torus of Fig. 1, summed, at order 30; at order 42.
SUMMED_FIG1, SUMMED_FIG1_FURTHER = 1e-5, 1e-7

# Corrections by two routes with the divisors of one set of frequencies: rounding of these over the smallest divisor.
SAME_SHIFT = 1e-11

# The end of a square root from the ratios of its terms; its exponent; limits of sequences made by formula.
SERIES_END, EXPONENT, SEQUENCE_LIMIT = 1e-4, 1e-6, 1e-9

# The spread of ends that are fitted to ratios of many orders.
END_SPREAD = 1e-7

# Ratios of terms at orders 36 to 42 against their limit, in many digits.
LATE_TERM_RATIO = 1e-5

# Amplitudes of short series against those of exact tori, and energies of tori against linear ones.
SHORT_SERIES, LONGER_SERIES = 0.05, 0.02
TRIAL_AMPLITUDE = 0.03
LINEAR_ENERGY = 0.01

# Forward differences over an increment of a tenth: first order.
INCREMENT = 0.05

# The same of H, with its anharmonic part.
INCREMENT_OF_H = 0.1

# Slopes of errors in Newton's method: the last ones are near rounding.
NEWTON_SLOPE = 0.25

# The part of the error that rounding keeps in a step of Newton's method.
NEWTON_LINEAR = 1e-6

# Profiles, growth and returns.

# First-order theory at amplitudes of 1e-5.
FIRST_ORDER_THEORY = 1e-4

# Exponents of groups of modes that are measured over windows of a decade.
GROWTH_EXPONENT = 0.15

# Rates of random phases: six realisations of three sizes.
RANDOM_RATE = 0.3

# The standard deviation of some dozen samples.
SCATTER = 0.25

# Sums of mode energies against H, which has anharmonic terms.
HARMONIC_SHARE = 0.03

# Minima between samples, by parabolas: their values, times, and what is read off at them.
RETURN_VALUE, RETURN_TIME, RETURN_PLACE = 1e-6, 1e-5, 1e-4

# The same of values with more samples a period.
FINE_RETURN_VALUE = 1e-7

# Times of returns in units of the fast wiggles of the energies, or of the samples.
WIGGLE = 1

# Pictures of a long orbit and of its series: the step leaves 1e-6.
PICTURE = 1e-5

# Allowances of certificates against rounded estimates of them.
ALLOWANCE_ESTIMATE = 0.01

# The growth of terms at order 30, squared, against its limit.
GROWTH_OF_TERMS = 0.01

# A formula in N typed in doubles beside the one derived: powers of pi, sines and quotients, each rounded once.
TYPED_LAW = 1e-12

# The law of q-breathers with its first correction, at N = 32 and amplitude 0.01: (pi/N)^4 and the squared amplitude are left.
SMALL_BREATHER = 5e-3

# Group energies at N = 200 by the leading power of 1/N alone, typed and derived: the same formula, rounded.
LIMIT_OF_LONG_CHAINS = 1e-9

# A frequency of amplitude 0.2 by its series in the amplitude: the next power is left.
SMALL_SHIFT_ERROR = 1e-6

# Edges of the bands of Toda's matrices of order ten: eigenvalues of symmetric matrices in doubles.
GAP = 64 * EPS

# Gaps along orbits of thirty time units, integrated with relative tolerance 1e-13.
GAP_DRIFT = 1e-11

# The lowest term of an expansion in amplitudes of 1e-6, or actions of 1e-10 and less.
TODA_LINEAR = 1e-5

# Actions by frequencies of the fourth order, in units of the actions themselves: the sixth order is divided by the twist.
NEXT_ORDER_OF_ACTIONS = 15

# A number printed with twelve decimal places.
LAST_OF_TWELVE = 0.5001e-12

# What `digits=30` promises of numbers of order ten, one of them a difference of two.
THIRTY_DIGITS = 1e-28

# A period of a Toda torus, integrated with relative tolerance 1e-13, stretched by the shear of the torus.
RETURN_OF_TODA = 1e-10

# Eigenvalues of a tangent map over one period that was integrated like that.
FLOQUET_OF_TODA = 1e-9

# Shifts by an action of 1e-12.
SMALL_ACTION = 1e-11

# Coefficients of 50 digits, rounded to nearest.
FIFTY_DIGITS = 1e-49

# Actions are squares of gaps of order 0.1, whose edges carry GAP.
ACTIONS_IN_DOUBLES = 1e-12

# Dormand and Prince, relative to the state and absolutely, of one step: what SciPy can do in doubles.
ORBIT_STEP = 1e-13

# Angles of Floquet multipliers of breathers up to N = 8 over one period, against the normal frequencies of Toda's curve: N EPS
# of the integration, times the period of 16.
FLOQUET_PHASE = 1e-12

# Powers of the error of a truncated series between two scales that are not zero: the next term but one adds scale^2, times
# its coefficient of some ten, relative to the power.
TODA_RATE = 0.06

# Energies to twenty digits, by series with 35 and curves with 30.
TWENTY_DIGITS = 1e-20

# Two waves of amplitude 1e-4 on a ring, without the third harmonics: the next order is mu A^2 of them.
ONLY_THE_SEEDS = 1e-4

# Errors of a series at orders 4, 6, ..., 12: each is the last one times nearly the same number.
RATE_OF_ORDERS = 0.3

# That number for waves of amplitudes 0.17 and 0.12 on a ring of eight: two orders are (A Omega/2)^2 or so.
TWO_ORDERS = 0.025

# The coefficient of a Toda torus 2e-6 of omega_2 further: its slope of 0.66, relative to 1.2e-5, is a tenth.
SMOOTH_SCAN = 0.15

# A fitted pole whose coefficients are exact to EPS, from points some 1e-6 away: the background of second degree is exact too.
SCAN_FIT = 1e-12

# Tori of some thousand coefficients, each rounded relative to the seeds'; their states have gaps of rounding at the seeds' gaps' size
# (1e-2), times the 2N edges.
CLOSED_GAP_OF_A_TORUS = 1e-12

# Decades between tails of Toda and alpha tori of Fig. 1, modes 3 to 13: measured 0.15 at most, the bump at 14 has 1.4.
SAME_TAIL = 0.2

# Gaps along orbits of 1e4 steps of Toda's chain: rounding of the edges of the bands, of order 1.
DRIFT_OF_TODA = 1e-14

# Times of returns from energies every 0.5 beside those from every 0.2.
RECURRENCE_TIME = 0.02

# Coefficients of 1.2e-5 on tori of residual 1e-13, fitted 3e-7 and more from the pole: beside alpha's residue of 3e-11.
NO_RESIDUE = 1e-5

# Pictures without words, averaged over squares of four pixels, from 0 to 1: fonts do not count, other edges of the same curves
# differ by up to 0.002 between releases of matplotlib, one marker at another place by some 0.01.
DRAWING = 0.004
# Closed formulas of two seeds at 40 digits: their long polynomials cancel some ten digits.
CLOSED_OF_FORTY = 1e-25

# Integrators keep phases to some 1e-14 a unit of frequency at these steps; lines of the window's lobe add less.
FREQUENCY_OF_LINE = 1e-12

# Sums over the strongest lines of each mode: the weakest taken are 1e-9 of the strongest, the next ones not many times that.
ACTION_OF_LINES = 1e-4

# Coefficients of a line in a channel and in the whole signal: neighbours that only one of them has taken out.
CHANNEL_LINE = 1e-6

# Kaiser's window over sixteen hops beyond its half width.
CHANNEL_LEAK = 1e-12

# Made of exact exponentials: the window's lobes at these distances, and rounding of phases up to some hundred turns.
LINE_OF_RECORD = 1e-12

# Amplitudes follow the frequencies, which carry some 1e-14 of the integrator, by dA / domega of some hundred.
AMPLITUDE_FROM_LINES = 1e-10
# Actions and twist of a torus whose residual is some 1e-14 of the largest acceleration, over divisors of some 1e-2.
NEWTON_TWIST = 1e-11

# Central differences of frequencies with step 1e-8 in actions of some 1e-3, at 30 digits; the actions are those of doubles.
TWIST_DIFFERENCE = 1e-9

# Lambda dI against domega of two tori of 40 digits whose amplitude differs by 2e-12 of itself: the square of that, times 1e4.
PRECISE_TWIST = 1e-20

# Ends of a definite range are 2/3 - 2/(3 g), g an eigenvalue in doubles: 1e-16 of the largest, which is a hundred times the
# least, in an end of 165.
RANGE_END = 1e-11
# A normal frequency is exact to the square of the eigenfunction's residual, 1e-20; what is left is the rounding of divisors
# and of the frequencies of the torus, some EPS, over the part of the eigenfunction in its mode.
NORMAL_CONVERGED = 1e-12

# The eigenfunction has the residual 1e-10, of which a hundred time units make as much as they are long times the frequency.
NORMAL_VARIATION = 1e-8

# The multipliers of both routes: the integrated map's error of 1e-12, and some hundred EPS of the largest multiplier.
NORMAL_MULTIPLIER = 1e-11

# What a frequency of a long regular orbit is known to: the integrator's phase.
EXACT_LINE = 1e-13

# What a box of four or eight harmonics an angle cuts off of powers of a small torus: third powers of stretches of 0.1 with three angles.
KRONECKER_BOUND = 1e-2
# Products of the torus' derivatives, each a solution with Newton's matrix to some 1e-12, and normal modes of residual 1e-10.
CANONICAL = 1e-9

# log10 of volumes: the integrator's tori with step 0.1 are off by some 1e-9 in frequencies and shapes, over 3e4 time units.
FORETOLD = 1e-7

# Normal directions as modes at rest are off by their coupling, some percent to a third in these volumes.
FORETOLD_AT_REST = 0.6
# energies of the leading terms beside those of a torus of specific energy 1e-7: small divisors
# make the next terms larger than lambda
LEADING_ORDER_SLACK = 0.05
# the power of N after those that a formula keeps, at N in the hundreds and thousands
NEXT_IN_LENGTH = 0.02
# Rounding of 1e-14 a step against a perturbation that grows from 1e-8 to 1e-4, over nine times the rate in all: a part of 1e-7.
GROWTH_OF_ORBIT = 1e-7
# Prover and checker bound the same three numbers: one in doubles and balls, the other in 60 binary places, both upwards.
SAME_BOUNDS = 0.02
# What a multiplier of an integrated tangent map may be off: its map is good to 1e-12, a pair near 1 or -1 to some hundred times that.
MULTIPLIER_OF_PROOF = 1e-9
# Of a proof of stability with 38 binary places: bounds of the rounding of doubles are a part of its Y, up to a half.
ROUNDING_OF_RESIDUAL = 2.0
# A frequency that moves by 1e-6 moves the rounded inverse of the block, too: |I - A DF| by some 1e-5 of itself.
MOVED_INVERSE = 1.0001
# The checker's inverse of a block has 32 binary places: five entries of a product with one of size 10 or so.
INVERSE_OF_BLOCK = 2.0**-24

# Asked of the breathers of the figures: far beyond doubles, within the 30 digits that their orbits have.
PROVED_RADIUS = 1e-25

# Of the frequency at a given amplitude or energy of an orbit of doubles: 22 digits of it are kept, so its ball is far below theirs.
PROVED_FREQUENCY = 1e-18

# Radius of uniqueness at a fold in omega, with the frequency given and with the amplitude: it is squeezed by the second orbit, or not.
SQUEEZED, FREE = 1e-6, 1e-2

# A frequency that proof and harmonic balance have of the same digits of A.
SAME_FREQUENCY = 1e-15

# An onset by inverse interpolation of its discriminant: 1e-14 of D over its slope, some 0.02 an amplitude.
ONSET = 1e-10

# An onset extrapolated by a polynomial of degree four through squares from 2e-3 to 1e-2 of an amplitude before it: measured 7e-9.
EXTRAPOLATED_ONSET = 3e-8

# An event by Newton's method from several starts: some roundings of an amplitude of 0.4.
EVENT = 2e-15

# The same against tori of 30 digits: what a residual of 2e-15 makes of the frequencies, over the change of their distance
# with the amplitude, 0.05 in a narrow tongue.
EVENT_BY_DIGITS = 5e-14

# Between two routes to an end of a narrow tongue, each with tori whose residual is below 1e-13: that over 0.05.
NARROW_EVENT = 2e-12

# A growth of 1e-3 by a multiplier of orbits of a residual of 1e-10, whose square root at 1 is rounded.
GROWTH_BY_FLOQUET = 1e-3

# Central differences with steps of 1e-4 of a discriminant of 1e-4, known to 1e-17: 1e-9, and the step's square.
CENTRAL_GRADIENT = 1e-6

# An amplitude beside an onset at which Floquet's multipliers, whose own threshold is some 1e-8 of the square, have decided.
BESIDE_AN_ONSET = 1e-6

# An amplitude beside a crossing where the modes can be told apart; the mean of both distances is of its square.
BESIDE_A_CROSSING = 1e-3

# Ratio of what two tori of small waves, one twice the other, miss of a normal frequency: the next
# power is the fourth, at amplitudes of 0.02 a part of 1e-3.
PHANTOM_WAVE = 1e-2
# Frequencies of a map over 500 units of time, relative: the lines of one mode are far apart there, and step 0.1 of the eighth order is
# below it.
MAP_FREQUENCY = 1e-10

# The shift of mode 1 beside its lowest order, relative: the next order at alpha = 0.3, N = 8, H = 4e-6 is 2e-3 of it.
MAP_SHIFT = 1e-2

# Two normal frequencies that are one at rest and differ on a torus: those of the tests by 2e-6 and more.
SPLIT = 1e-6

# What a frame of eigenfunctions in doubles leaves of the linearised equations: 6e-15 to 9e-13 were met.
FRAME_RESIDUAL = 1e-11

# What sigma wrong by 1e-6 leaves of them, less a factor of 20 for the part of it that its direction has.
FRAME_SEEN = 1e-7

# Distances that a torus with some residual is sure to keep: a torus off by 1e-10 over 16 units of time, one in doubles over half
# of the longest time, and one of 30 digits, 1e-33 times 1e9 times what couples.
COARSE_STAY, DOUBLES_STAY, DIGITS_STAY = 1e-7, 1e-3, 1e-18

# The first step of a KAM iteration for N = 3, as a part of what it may be: 0.07 in doubles, 8e-20 with 30 digits.
KAM_DOUBLES, KAM_DIGITS = 1e-3, 1e-15

# Radius of convergence from terms of order 58 to 64 fitted to k^(-3/2) R^-k at a fold: the next term of the fit, of relative size
# 1/k, changes its slope by about 1/k^2 = 2.4e-4.
FOLD_RADIUS = 1e-3

# ln of a determinant of some 100 rows by differences with a step of 1e-6: each entry to 1e-9, times the inverse near the fold.
SHEET_DETERMINANT = 1e-5
# Numbers in the rows of an atlas are rounded to six digits.
SIX_DIGITS = 5e-6

# A hundred steps of two loops that round in another order: 1e-14 of the largest deviation, times its growth.
ONSET_STEPS = 1e-10

# Two borders that are the same: each lies between points whose logarithms differ by at most 0.01, and is located within.
LOCATED = 0.01

# An angle more takes 13 to 52 times off the distance of the trajectory at H = 0.001: at least tenfold.
FALL_BY_AN_ANGLE = 10.0
# Height of a line of Fig. 9's trajectory and its coefficient on the 4-torus, which is 1e-3 of the largest coordinate away, 1/9
# of it by the fifth angle: 2.3e-3 measured.
COMBINATION_HEIGHT = 0.02

# Radius of a proved energy over the bound of the residual: speeds, summed over particles, over the least |nu.omega| of the box
# of harmonics that H can have: 19 to 114 measured.
ENERGY_OF_TORUS = 300.0
# Units in the last place of e^x - 1 and log(1 + x) of compiled loops: their last sum 0.5, rounding of squares and of reduced
# arguments up to 0.5 at x = 0.35, where the result is a quarter of what is rounded; 1.04 measured there, below 0.8 elsewhere.
PLACES_OF_EXPONENTIALS = 1.1

# Amplitude of a proved orbit of doubles: its radius is some roundings, times the weight of the norm.
OF_DOUBLES = 1e-12
# What a wave does not have, by 128 points of a function that is analytic: exp(-128) of it would be left, and fifty digits.
NO_HARMONIC = 1e-20
# Forces by differences of neighbours in a ring of 1024: rounding of positions over Omega_1^2 = 4e-5, 1e-11; well beyond doubles' own.
LEAST_BY_NEIGHBOURS, MOST_BY_NEIGHBOURS = 1e-13, 1e-9

# Coefficients of tori of two choices of harmonics: both solve the equations to 1e-13 of the largest acceleration, and the
# smallest divisor of the cases magnifies it ten times.
SAME_TORUS = 1e-12

# Coordinates of seeds at t = 0 of tori with some thousand harmonics, each coefficient rounded.
AT_THE_START = 1e-12

# Rates of growth along the torus of five angles near Fig. 9's trajectory, with 2500 and more harmonics: the fourth differs by 3.5e-2
# from that of 6000, the residuals being 3e-5 and 1.5e-6.
KEPT_RATES = 0.05

# Squares of logarithms of multipliers next to 1, where two pairs nearly meet: rounding of the torus and of the monodromy matrix.
BESIDE_MULTIPLIER = 1e-12

# A torus at energies 1.25 apart: amplitudes grow as the power 0.36 of the energy, fitted over 0.06 .. 0.1, to a percent.
GROWTH_WITH_ENERGY = 1e-2

# A series at its best order and the torus by Newton's method: residuals of 1e-13 over the smallest divisors, some 1e-3.
SERIES_AND_TORUS = 1e-9
