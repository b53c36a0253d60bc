"""20,000 calls of the public face and of the verbs with odd types and sizes: no raw error, no hang, no NaN without a word."""

import inspect
import random

import pytest

from symfpu import Chain
from tests.fuzz import calls, commands, run, values

PORTIONS, EACH = 8, 2500


@pytest.mark.long
@pytest.mark.parametrize("portion", range(PORTIONS))
def test_no_call_ends_in_a_raw_error(portion, tmp_path):
    found = run.outcomes(range(portion * EACH, (portion + 1) * EACH), tmp_path)
    kinds, returned = run.counts(found)
    faults = [f"{number} {where}: {what}" for number, where, kind, what, _ in found if kind == "fault"]
    assert not faults, "\n".join(faults)
    assert kinds.total() == EACH
    assert kinds["returned"] > EACH // 10  # the calls get past the checks of their arguments
    assert len(returned) > 100


def test_a_call_is_repeated_by_its_number():
    assert calls.described(4) == calls.described(4)
    assert len({calls.described(number) for number in range(20)}) > 10


def test_a_raw_error_is_a_fault(monkeypatch):
    def broken():
        return 1 // 0

    monkeypatch.setattr(calls, "chosen", lambda number: ("broken", broken, ([], {})))
    assert calls.called(1).kind == "fault"
    monkeypatch.setattr(calls, "chosen", lambda number: ("nan", lambda: float("nan"), ([], {})))
    assert calls.called(1).kind == "fault"
    monkeypatch.setattr(calls, "chosen", lambda number: ("refused", lambda: Chain(1, alpha=1), ([], {})))
    assert calls.called(1).kind == "refused"


def test_every_parameter_of_the_face_has_sound_values():
    """But those of a few functions, which are called with what is odd alone."""
    names = {name for function in calls.functions().values() for name in inspect.signature(function).parameters}
    assert len(names - values.by_name.keys()) < len(names) / 4


def test_no_odd_word_leads_out_of_the_folder():
    draw = random.Random(0)
    words = {commands.odd(draw) for _ in range(2000)}
    assert not any(word.startswith(("/", "~")) or ".." in word for word in words)
