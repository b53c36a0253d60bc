"""An argument of a wrong type is named; errors of ours, and of functions that were passed, stay what they are."""

import inspect
import pickle

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, lindstedt
from symfpu.numbers.public import fits, public


@public
def scaled(numbers: "ArrayLike", factor: "float" = 1.0, *, report: "Callable[[str], None] | None" = None) -> "Any":  # noqa: F821
    """Numbers times a factor, told to a function."""
    if report is not None:
        report("begun")
    return np.asarray(numbers, dtype=float) * float(factor)


@public
def unknown(number: "float") -> "float":
    """What no number is known of."""
    return np.nan * number


def test_the_argument_is_named():
    with pytest.raises(InputError, match=r"numbers = 'x'") as refused:
        scaled("x", 2)
    assert refused.value.argument == "numbers"
    assert isinstance(refused.value.__cause__, ValueError)


def test_a_number_beyond_doubles_is_named():
    with pytest.raises(InputError, match="factor"):
        scaled([1.0], 10**400)


@pytest.mark.parametrize("size", [1e200, 1e300])
def test_an_argument_whose_results_are_beyond_doubles_is_named(size):
    chain, Q = symfpu.Chain(8, alpha=1), [size] * 7
    for call in (lambda: chain.accelerations(Q), lambda: chain.energy(np.array(Q), [0.0] * 7)):
        with pytest.raises(InputError, match=r"^Q = .*within doubles"):
            call()


def test_an_integer_of_numpy_is_one():
    chain = symfpu.Chain(8, alpha=1)
    assert chain.linear_frequency(np.int64(3)) == chain.linear_frequency(3)


def test_errors_of_a_function_that_was_passed_stay():
    def broken(words, fraction):
        raise KeyError(words)

    with pytest.raises(KeyError):
        lindstedt(Chain(4, alpha=1), (1,), order=1, progress=broken)


def test_too_many_arguments_are_pythons_own_error():
    with pytest.raises(TypeError):
        scaled([1.0], 1.0, 1.0)


FUNCTIONS = {name for name in symfpu.__all__ if inspect.isfunction(getattr(symfpu, name))}
WITHOUT_ARGUMENTS = {"init_printing"}


@pytest.mark.parametrize("name", sorted(FUNCTIONS - WITHOUT_ARGUMENTS))
def test_every_public_function_is_public(name):
    """Wrapped once, found by pickle, with its own signature."""
    function = getattr(symfpu, name)
    assert inspect.isfunction(function.__wrapped__)
    assert pickle.loads(pickle.dumps(function)) is function
    assert inspect.signature(function).return_annotation is not inspect.Signature.empty


CASES = [
    (1, int, True),
    (True, int, False),
    (1.5, int, False),
    (np.int64(3), int, True),
    (1, float, True),
    ("1", float, False),
    (10**400, float, False),
    (float("nan"), float, False),
    (None, int | None, True),
    ("1", int | None, False),
    ((1, 2), tuple[int, ...], True),
    ((1, "2"), tuple[int, ...], False),
    ("12", tuple[str, ...], False),
    ({1: 0.5}, dict[int, float], True),
    ({"1": 0.5}, dict[int, float], False),
    (Chain(4, alpha=1), Chain, True),
    ("alpha", Chain, False),
]


@pytest.mark.parametrize(("value", "hint", "expected"), CASES, ids=str)
def test_values_and_types(value, hint, expected):
    assert fits(value, hint) is expected


def test_nan_of_an_argument_that_does_not_fit_is_refused():
    with pytest.raises(InputError, match="numbers"):
        scaled([None])


def test_nan_of_a_function_whose_arguments_fit_is_passed_on():
    assert np.isnan(unknown(1.0))


@public
def outer(size: "int") -> "Any":  # noqa: F821
    """A public function that calls another one wrongly."""
    return scaled("x") * size


def test_a_wrong_call_of_ours_is_no_fault_of_the_reader():
    with pytest.raises(ValueError, match="could not convert") as raw:
        outer(1)
    assert not isinstance(raw.value, InputError)
    with pytest.raises(InputError, match="size"):
        outer("1")
    assert scaled([1.0]).tolist() == [1.0]
