"""Wrong arguments by name: what is given for each, and that it is refused in one line that names it."""

import pytest

from symfpu import InputError


def each(**wrong):
    """Pairs (argument, value) of the wrong values of each argument."""
    return pytest.mark.parametrize(("name", "value"), [(name, value) for name, values in wrong.items() for value in values], ids=str)


def refused(function, name, value, **given):
    """That the function names the argument whose value is wrong, alone or with others that it does not fit."""
    with pytest.raises(InputError) as caught:
        function(**given | {name: value})
    assert name in caught.value.argument.split(", ")
    assert "\n" not in str(caught.value)
