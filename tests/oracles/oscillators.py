"""One-mode reductions of the chain: frequency and first Fourier amplitude of a Duffing and of a cubic oscillator.

Both follow from the potential V(x) of the one mode alone. The Duffing oscillator by elliptic functions, the cubic one by
quadrature of its period; amplitudes are those of cos(omega t), not of the turning points.
"""

import mpmath

DIGITS = 30


def duffing(linear_squared, cubic, turning):
    """(omega, A) of x'' + a x + b x^3 = 0 that swings between +-turning; A is the coefficient of cos(omega t).

    x = X cn(W t, m), W^2 = a + b X^2, m = b X^2 / (2 W^2) (b > 0): omega = pi W / (2 K), and the first coefficient of cn is
    (2 pi / (sqrt(m) K)) sqrt(nome) / (1 + nome).
    """
    with mpmath.workdps(DIGITS):
        W2 = linear_squared + cubic * turning**2
        m = cubic * turning**2 / (2 * W2)
        K = mpmath.ellipk(m)
        nome = mpmath.exp(-mpmath.pi * mpmath.ellipk(1 - m) / K)
        first = 2 * mpmath.pi / (mpmath.sqrt(m) * K) * mpmath.sqrt(nome) / (1 + nome)
        return mpmath.pi * mpmath.sqrt(W2) / (2 * K), turning * first


def cubic_oscillator(linear_squared, quadratic, turning):
    """(omega, A) of x'' + a x + b x^2 = 0 with the upper turning point given, by quadrature over the phase of the swing.

    x = c + d cos(phi) between the turning points; dt/dphi is smooth, so that the trapezoidal rule converges geometrically.
    """
    with mpmath.workdps(DIGITS):
        a, b, top = map(mpmath.mpf, (linear_squared, quadratic, turning))
        # a x^2 / 2 + b x^3 / 3 - E = (b / 3) (x - top) (x^2 + p x + r), p = top + 3a / 2b, r = p top
        p = top + 3 * a / (2 * b)
        roots = [(-p + s * mpmath.sqrt(p**2 - 4 * p * top)) / 2 for s in (1, -1)]
        bottom, far = sorted(roots, key=abs)
        centre, half = (top + bottom) / 2, (top - bottom) / 2
        points = 256
        phases = [2 * mpmath.pi * (j + mpmath.mpf(1) / 2) / points for j in range(points)]
        x = [centre + half * mpmath.cos(phi) for phi in phases]
        rate = [1 / mpmath.sqrt(2 * b / 3 * (position - far)) for position in x]  # dt / dphi
        mean = mpmath.fsum(rate) / points
        omega = 1 / mean
        times = _times(phases, rate, mean)
        first = (
            mpmath.fsum(2 * position * mpmath.cos(omega * t) * r for position, t, r in zip(x, times, rate, strict=True)) / points * omega
        )
        return omega, first


def _times(phases, rate, mean):
    """t(phi) from dt/dphi by its Fourier series, which is even in phi."""
    points = len(phases)

    def cosine(n):
        return 2 * mpmath.fsum(r * mpmath.cos(n * phi) for r, phi in zip(rate, phases, strict=True)) / points

    cosines = [cosine(n) for n in range(1, 48)]
    return [mean * phi + mpmath.fsum(c / n * mpmath.sin(n * phi) for n, c in enumerate(cosines, 1)) for phi in phases]
