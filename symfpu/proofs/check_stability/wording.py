"""Numbers in decimals, rounded to one side."""

from fractions import Fraction

from symfpu.proofs.check_stability.fixed_point import up


def scientific_below(x: Fraction, digits: int = 3) -> str:
    """A positive number in decimals, rounded down."""
    return scientific(x, digits, down=True)


def scientific(x: Fraction, digits: int = 3, *, down: bool = False) -> str:
    """A number that is not negative in decimals, rounded up."""
    if not x:
        return "0"
    exponent = len(str(x.numerator)) - len(str(x.denominator))
    if x < Fraction(10) ** exponent:
        exponent -= 1
    scaled = x / Fraction(10) ** (exponent - digits + 1)
    text = str(scaled.numerator // scaled.denominator if down else up(scaled))
    if len(text) > digits:
        exponent += 1
        text = text[:digits]
    return f"{text[0]}.{text[1:]}e{exponent}" if exponent else f"{text[0]}.{text[1:]}"
