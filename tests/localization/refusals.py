"""Bad arguments, by name."""

import pytest

from symfpu import InputError


def refused(argument, call, *arguments, **options):
    with pytest.raises(InputError) as raised:
        call(*arguments, **options)
    assert raised.value.argument == argument
