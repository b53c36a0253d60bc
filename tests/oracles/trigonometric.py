"""From polynomials in z = (A/2) exp(i theta) to cosines: the form in which the slow oracle holds its series."""


def from_monomials(exponents, coefficients):
    """{(powers of A, harmonic): coefficient of A^powers cos(harmonic . theta)}; conjugate monomials are not listed."""
    result = {}
    for row, value in zip(exponents, coefficients, strict=True):
        p, n = [int(e) for e in row[0::2]], [int(e) for e in row[1::2]]
        powers = tuple(a + b for a, b in zip(p, n, strict=True))
        harmonic = tuple(a - b for a, b in zip(p, n, strict=True))
        result[powers, harmonic] = value * (2 if any(harmonic) else 1) / 2 ** sum(powers)
    return result


def from_amplitudes(exponents, coefficients):
    """The same for a polynomial in the amplitudes alone: harmonic zero."""
    zero = (0,) * exponents.shape[1]
    return {(tuple(map(int, row)), zero): value for row, value in zip(exponents, coefficients, strict=True)}
