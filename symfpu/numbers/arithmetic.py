"""Arrays of numbers in two precisions under one set of names.

They are doubles, or mpmath's numbers at the precision of the context.

Functions of a torus and of the chain are written once and take their cosines and dot products
from here. Multiprecision arrays are object arrays of mpf. A float in them is read by its shortest
decimal: 0.1 means one tenth. What is handed to users are mpf that print their digits
(`with_digits`); they compute as any others.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from typing import Any, TypeVar, cast

import gmpy2
import mpmath
import numpy as np
from mpmath import libmp
from numpy.typing import NDArray

Numbers = NDArray[Any]  # doubles, or mpf
Value = TypeVar("Value")

GUARD_DIGITS = 15  # carried beyond the asked digits by every evaluation


@contextmanager
def working_digits(digits: int) -> Iterator[None]:
    """The same working precision for mpmath and for MPFR, restored afterwards."""
    with mpmath.workdps(digits), mpfr_as_mpf():
        yield


def mpfr_as_mpf() -> AbstractContextManager[Any]:
    """MPFR's working precision is mpmath's; restored afterwards."""
    return gmpy2.context(gmpy2.get_context(), precision=mpmath.mp.prec)  # type: ignore[no-any-return]


class Arithmetic:
    """Arrays of float64; Multiprecision overrides what differs."""

    def context(self, digits: int | None) -> AbstractContextManager[Any]:
        """Nothing to set and to restore."""
        return nullcontext()

    def number(self, value: Fraction) -> Any:
        """An exact number, rounded."""
        return float(value)

    def array(self, values: Any) -> NDArray[Any]:
        """The values as an array; TypeError or ValueError where they are no real numbers."""
        array = np.asarray(values)
        if array.dtype.kind == "c":
            raise TypeError("complex numbers are no doubles")
        return array.astype(np.float64, copy=False)

    def zeros(self, shape: tuple[int, ...]) -> NDArray[Any]:
        """An array of zeros."""
        return np.zeros(shape)

    def cos(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(np.cos(values))

    def sin(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(np.sin(values))

    def sqrt(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(np.sqrt(values))

    def dot(self, left: NDArray[Any], right: NDArray[Any]) -> NDArray[Any]:
        """Product of an array (..., n) with a matrix (n, m)."""
        return np.asarray(left @ right)

    def finite(self, values: NDArray[Any]) -> bool:
        return bool(np.isfinite(values).all())

    @property
    def pi(self) -> Any:
        return np.pi


class Multiprecision(Arithmetic):
    """Object arrays of mpf at mpmath's working precision; `context` sets it and restores it."""

    def context(self, digits: int | None) -> AbstractContextManager[Any]:
        assert digits is not None
        return working_digits(digits + GUARD_DIGITS)

    def number(self, value: Fraction) -> Any:
        return mpmath.mpf(value.numerator) / value.denominator

    def array(self, values: Any) -> NDArray[Any]:
        return np.asarray(_MPF(np.asarray(values, dtype=object)), dtype=object)

    def zeros(self, shape: tuple[int, ...]) -> NDArray[Any]:
        return np.full(shape, mpmath.mpf(0), dtype=object)

    def cos(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(_COS(values), dtype=object)

    def sin(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(_SIN(values), dtype=object)

    def sqrt(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(_SQRT(values), dtype=object)

    def dot(self, left: NDArray[Any], right: NDArray[Any]) -> NDArray[Any]:
        """The product of matrices by integers.

        Every row of left and every column of right has its own power of two, so small ones keep
        their digits.
        """
        shape = (*left.shape[:-1], right.shape[1])
        if left.size == 0 or right.size == 0:
            return np.full(shape, mpmath.mpf(0), dtype=object)
        matrix = left.reshape(-1, left.shape[-1])
        rows, row_exponents = integers(matrix.T)
        columns, column_exponents = integers(right)
        sums = rows.T.dot(columns)
        exponents = row_exponents[:, None] + column_exponents[None, :]
        return from_integers(sums, exponents).reshape(shape)

    def finite(self, values: NDArray[Any]) -> bool:
        return all(mpmath.isfinite(x) for x in values.flat)

    @property
    def pi(self) -> Any:
        return +mpmath.pi


DOUBLES, MULTIPRECISION = Arithmetic(), Multiprecision()


class NumberWithDigits(mpmath.mpf):  # type: ignore[misc]
    """An mpf that prints all digits it was asked for, whatever the precision of mpmath's context.

    In arithmetic it is an mpf like any other: results are plain mpf, rounded to the precision of
    the context.
    """

    __slots__ = ("digits",)

    def __str__(self) -> str:
        return str(libmp.to_str(self._mpf_, self.digits))

    def __repr__(self) -> str:
        return f"mpf('{self}')"

    def __format__(self, form: str) -> str:
        """By the format specifications of Python's decimal numbers.

        From as many digits as are carried.
        """
        if not form:
            return str(self)
        carried = libmp.to_str(self._mpf_, self.digits + GUARD_DIGITS)
        return format(Decimal(carried), form)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (libmp.to_pickable(self._mpf_), self.digits)


class ComplexWithDigits(mpmath.mpc):  # type: ignore[misc]
    """An mpc whose parts print all digits they were asked for, as a NumberWithDigits does."""

    __slots__ = ("digits",)

    @property
    def real(self) -> Any:
        return _number_with_digits(self._mpc_[0], self.digits)

    @property
    def imag(self) -> Any:
        return _number_with_digits(self._mpc_[1], self.digits)

    def __str__(self) -> str:
        return f"({self.real} + {self.imag}j)"

    def __repr__(self) -> str:
        return f"mpc(real='{self.real}', imag='{self.imag}')"

    def __reduce__(self) -> tuple[Any, ...]:
        parts = tuple(libmp.to_pickable(x) for x in self._mpc_)
        return _restored_complex, (parts, self.digits)


def _restored_complex(parts: Any, digits: int) -> ComplexWithDigits:
    numbers = tuple(libmp.from_pickable(x) for x in parts)
    return _complex_with_digits(numbers, digits)


def _complex_with_digits(parts: Any, digits: int) -> ComplexWithDigits:
    """The mpc of these parts, unrounded."""
    number: ComplexWithDigits = object.__new__(ComplexWithDigits)
    number._mpc_ = parts
    number.digits = digits
    return number


def _restored(number: Any, digits: int) -> NumberWithDigits:
    return _number_with_digits(libmp.from_pickable(number), digits)


def _number_with_digits(parts: Any, digits: int) -> NumberWithDigits:
    """The mpf of these parts, unrounded."""
    number: NumberWithDigits = object.__new__(NumberWithDigits)
    number._mpf_ = parts
    number.digits = digits
    return number


def with_digits(values: Value, digits: int | None) -> Value:
    """Results as users see them: every mpf and mpc in them prints so many digits.

    In a number, array, tuple or mapping.

    All else is as it was; None leaves everything.
    """
    return values if digits is None else cast(Value, _dressed(values, digits))


def _dressed(values: Any, digits: int) -> Any:
    if isinstance(values, mpmath.mpf):
        return _number_with_digits(values._mpf_, digits)
    if isinstance(values, mpmath.mpc):
        return _complex_with_digits(values._mpc_, digits)
    if isinstance(values, np.ndarray) and values.dtype == object:
        entries = np.frompyfunc(lambda x: _dressed(x, digits), 1, 1)
        return np.asarray(entries(values), dtype=object)
    if isinstance(values, tuple):
        return tuple(_dressed(x, digits) for x in values)
    if isinstance(values, Mapping):
        return {key: _dressed(x, digits) for key, x in values.items()}
    return values


def arithmetic_of(values: Any) -> Arithmetic:
    """Multiprecision for arrays with an mpf or mpc in them, else doubles."""
    array = np.asarray(values)
    if array.dtype != object:
        return DOUBLES
    kinds = mpmath.mpf, mpmath.mpc
    has_digits = any(isinstance(x, kinds) for x in array.flat)
    return MULTIPRECISION if has_digits else DOUBLES


def integers(values: NDArray[Any]) -> tuple[NDArray[np.object_], NDArray[np.int64]]:
    """Columns of mpf as integers times 2^exponent: (n, m) and exponents (m,).

    Each at the working precision of its largest entry.
    """
    precision = int(mpmath.mp.prec)
    table = np.empty(values.shape, dtype=object)
    exponents = np.zeros(values.shape[1], dtype=np.int64)
    for j in range(values.shape[1]):
        parts = [x._mpf_ for x in values[:, j]]
        top = max((e + b for _, man, e, b in parts if man), default=precision)
        exponents[j] = top - precision
        table[:, j] = [libmp.to_fixed(x, precision - top) for x in parts]
    return table, exponents


def from_integers(
    values: NDArray[np.object_], exponents: NDArray[Any]
) -> NDArray[np.object_]:
    """Integers times 2^exponents as mpf, rounded to the working precision.

    Shapes that broadcast.
    """
    whole_exponents = np.asarray(exponents).astype(object)
    return np.asarray(_LDEXP(values, whole_exponents), dtype=object)


def doubles_as_integers(values: NDArray[np.float64], exponent: int) -> NDArray[np.object_]:
    """Doubles times 2^exponent as integers, rounded down."""
    mantissas, exponents = np.frexp(values)
    shifts = exponents.astype(object) + (exponent - 53)
    whole = np.ldexp(mantissas, 53).astype(np.int64).astype(object)
    pairs = zip(whole.flat, shifts.flat, strict=True)
    shifted = [m << s if s >= 0 else m >> -s for m, s in pairs]
    return np.array(shifted, dtype=object).reshape(np.shape(values))


def fraction_of(value: Any) -> Fraction:
    """An mpf as the fraction it is."""
    sign, mantissa, exponent, _ = value._mpf_
    return Fraction((-1) ** sign * int(mantissa)) * Fraction(2) ** int(exponent)


def mpf(value: Any) -> Any:
    """One number as mpf at the working precision.

    Floats by their shortest decimal, fractions exactly.
    """
    if isinstance(value, Fraction):
        return mpmath.mpf(value.numerator) / value.denominator
    if isinstance(value, (float, np.floating)):
        return mpmath.mpf(repr(float(value)))
    return mpmath.mpf(int(value) if isinstance(value, np.integer) else value)


def text(value: Any, digits: int) -> str:
    """A double, an mpf or an mpc with so many significant digits; of mpc as complex numbers are."""
    if isinstance(value, mpmath.mpc):
        real, imaginary = text(value.real, digits), text(value.imag, digits)
        sign = "" if imaginary.startswith("-") else "+"
        return f"({real}{sign}{imaginary}j)"
    if isinstance(value, mpmath.mpf):
        return str(mpmath.nstr(value, digits))
    return f"{float(value):.{digits}g}"


def _from_integer(value: int, exponent: int) -> Any:
    rounded = libmp.from_man_exp(value, exponent, mpmath.mp.prec, "n")
    return mpmath.mp.make_mpf(rounded)


@lru_cache(maxsize=8)
def _sines(N: int, precision: int) -> NDArray[np.object_]:
    root = mpmath.sqrt(mpmath.mpf(2) / N)
    one_period = [root * mpmath.sinpi(mpmath.mpf(n) / N) for n in range(2 * N)]
    table = np.array(one_period, dtype=object)
    q = np.arange(1, N)
    phases = np.outer(q, q) % (2 * N)
    return table[phases]


def sine_matrix(N: int) -> NDArray[np.object_]:
    """sqrt(2/N) sin(q k pi / N), q, k = 1 .. N-1, at the working precision."""
    return _sines(N, int(mpmath.mp.prec))


_MPF, _COS, _SIN, _SQRT = (
    np.frompyfunc(f, 1, 1) for f in (mpf, mpmath.cos, mpmath.sin, mpmath.sqrt)
)
_LDEXP = np.frompyfunc(_from_integer, 2, 1)
