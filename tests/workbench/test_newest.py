"""The newest wish counts: stale answers are dropped, of each kind one wish waits."""

from hypothesis import given, settings
from hypothesis import strategies as st

from symfpu.workbench.newest import PATIENCE, Newest, Wishes


@settings(max_examples=12)
@given(st.lists(st.tuples(st.sampled_from("abc"), st.integers()), max_size=12))
def test_of_each_kind_the_newest_wish_stands_in_order_of_arrival(arrivals):
    wishes = Wishes()
    for kind, wish in arrivals:
        wishes.add(kind, wish)
    last = {kind: i for i, (kind, _) in enumerate(arrivals)}
    assert list(wishes.taken()) == [arrivals[i] for i in sorted(last.values())]
    assert not any(kind in wishes for kind in "abc")


@settings(max_examples=4)
@given(st.integers(1, 8))
def test_one_ticket_is_current(count):
    newest = Newest()
    tickets = [newest.ask(now=float(i)) for i in range(count)]
    assert [newest.current(ticket) for ticket in tickets] == [False] * (count - 1) + [True]


def test_time_runs_from_the_newest_wish_until_it_is_done():
    newest = Newest()
    old = newest.ask(now=1.0)
    new = newest.ask(now=2.0)
    assert newest.seconds(now=5.0) == 3.0
    newest.done(old)
    assert newest.seconds(now=5.0) == 3.0
    newest.done(new)
    assert newest.seconds(now=5.0) == 0.0


def test_a_wish_behind_an_older_one_is_stuck_only_after_a_while():
    newest = Newest()
    old = newest.ask(now=0.0)
    newest.begun(old)
    assert not newest.stuck(now=10 * PATIENCE)  # it is the newest: slow, and nothing waits
    newest.ask(now=0.0)
    assert not newest.stuck(now=PATIENCE / 2)
    assert newest.stuck(now=2 * PATIENCE)
    newest.done(old)
    assert not newest.stuck(now=2 * PATIENCE)


def test_what_is_forgotten_is_stale_and_takes_no_time():
    newest = Newest()
    ticket = newest.ask(now=0.0)
    newest.begun(ticket)
    newest.forget()
    assert not newest.current(ticket)
    assert newest.seconds(now=9.0) == 0.0
    assert not newest.stuck(now=9.0)
