"""The computing process of a page: the newest wish counts, and a process that dies is replaced."""

import os
import queue
import signal
from threading import Event
from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symfpu.workbench import worker
from symfpu.workbench.newest import PATIENCE, Newest, Wishes
from symfpu.workbench.page import Page
from symfpu.workbench.worker import DONE, FILE, TERM, TORUS, Asker, Died, Spares
from tests.workbench.answering import answer

WAIT = 60  # seconds on a busy machine, never reached


@pytest.fixture
def page(monkeypatch):
    """An asker, and what it hears."""
    monkeypatch.setattr(worker, "work", answer)
    heard, spares = queue.Queue(), Spares()
    asker = Asker(lambda *told: heard.put(told), spares)
    yield asker, heard, spares
    asker.end()
    spares.end()
    assert heard.empty()


def answers(heard, count):
    return [heard.get(timeout=WAIT) for _ in range(count)]


def check_answer(asker, heard, kind, word):
    """A wish has its one part, and the end."""
    asker.ask(kind, word)
    assert [part for _, _, part in answers(heard, 2)] == [(word,), DONE]


def pid_of(process):
    return process._process.pid


def test_a_process_that_dies_at_work_is_replaced_at_the_next_wish(page):
    asker, heard, _ = page
    asker.ask(TORUS, "die")
    (kind, ticket, part), (told, newest, died) = answers(heard, 2)
    assert (kind, part, told) == (TORUS, DONE, TORUS)
    assert ticket == newest
    assert asker.current(told, newest), "the page shows it"
    assert isinstance(died, Died)
    assert died.message == "the computing process has died (killed by signal 9); another one takes its place at the next choice"
    assert asker.seconds() == 0.0, "nothing is computed any more"
    check_answer(asker, heard, TERM, "again")


def test_a_process_that_dies_idle_is_replaced_at_the_next_wish(page):
    asker, heard, _ = page
    check_answer(asker, heard, FILE, "first")
    os.kill(pid_of(asker._process), signal.SIGKILL)
    [(_, _, died)] = answers(heard, 1)
    assert isinstance(died, Died)
    check_answer(asker, heard, FILE, "second")


def test_a_wish_that_comes_before_the_death_is_heard_of_is_answered(page, monkeypatch):
    asker, heard, _ = page
    monkeypatch.setattr(asker, "_died", lambda process: None)
    dead = asker._process
    os.kill(pid_of(dead), signal.SIGKILL)
    dead._process.join()
    asker.ask(TORUS, "new")
    (_, _, died), *told = answers(heard, 3)
    assert isinstance(died, Died)
    assert [part for _, _, part in told] == [("new",), DONE]


def test_a_connection_is_closed_by_who_listens_to_it_alone(page):
    """Closed between two reads, its number would be the next connection's, and a message of that one lost."""
    asker, heard, _ = page
    process, busy, goes_on = asker._process, Event(), Event()
    answered = asker._answered

    def wait(*told):
        busy.set()
        goes_on.wait(WAIT)
        answered(*told)

    asker._answered = wait
    asker.ask(FILE, "first")
    assert busy.wait(WAIT)
    asker.cancel()
    assert not process.alive
    assert not process.connection.closed
    goes_on.set()
    check_answer(asker, heard, FILE, "second")


def test_the_page_says_that_its_process_has_died_and_asks_for_the_formula_again():
    shown = object.__new__(Page)
    shown.problem, shown._asked_term = SimpleNamespace(object=""), "asked before"
    shown._show_part(TORUS, Died("killed by signal 9"))
    assert "killed by signal 9" in shown.problem.object
    assert shown._asked_term is None


def test_a_spare_process_that_has_died_is_not_taken(page):
    asker, heard, spares = page
    dead = spares._spare
    os.kill(pid_of(dead), signal.SIGKILL)
    dead._process.join()
    asker.cancel()  # takes the spare
    check_answer(asker, heard, TORUS, "again")


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
