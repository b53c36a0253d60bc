"""Who is let in, at which port, and what is said where Panel is missing."""

import socket
import sys
from types import SimpleNamespace

import pytest

from symfpu import InputError, SymfpuError
from symfpu.cli.main import main
from symfpu.workbench.server import HOST, Guard, free_port, panel


def request(guard, *, host=None, token=None, cookie=None):
    """What Bokeh's server hands to the guard."""
    given = {}
    return given, SimpleNamespace(
        request=SimpleNamespace(host=host or guard.hosts[0]),
        get_argument=lambda name, default: token,
        get_cookie=lambda name: cookie,
        set_cookie=lambda name, value, **options: given.update(options, **{name: value}),
    )


@pytest.fixture
def guard():
    return Guard(4321)


def test_the_token_of_the_address_lets_in_and_becomes_a_cookie(guard):
    token = guard.address.partition("token=")[2]
    cookies, handler = request(guard, token=token)
    assert guard.user(handler)
    assert cookies == {"symfpu-4321": token, "httponly": True, "samesite": "Strict", "path": "/"}
    assert guard.user(request(guard, cookie=token)[1])


@pytest.mark.parametrize("how", [{}, {"token": ""}, {"token": "x"}, {"cookie": "x"}, {"host": "evil.example:4321"}], ids=str)
def test_nobody_else_is_let_in(guard, how):
    web = pytest.importorskip("tornado.web")
    if "host" in how:
        how = how | {"token": guard.token}
    if how == {"token": "x"}:
        how = how | {"cookie": guard.token}  # a wrong token is refused whatever else is there
    cookies, handler = request(guard, **how)
    with pytest.raises(web.HTTPError) as caught:
        guard.user(handler)
    assert caught.value.status_code == 403
    assert cookies == {}


def test_tokens_differ_and_are_long(guard):
    assert guard.token != Guard(4321).token
    assert len(guard.token) >= 32
    assert guard.admits(guard.token)
    assert not guard.admits(None)


def test_ports():
    with socket.socket() as taken:
        taken.bind((HOST, 0))
        taken.listen()
        port = taken.getsockname()[1]
        for wanted in (port, 80, -1, 65536):
            with pytest.raises(InputError):
                free_port(wanted)
    assert 1024 <= free_port() <= 65535


def test_a_missing_panel_names_the_extra(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "panel", None)
    with pytest.raises(SymfpuError, match=r"symfpu\[workbench\]"):
        panel()
    assert main(["workbench"]) == 1
    assert "pip install 'symfpu[workbench]'" in capsys.readouterr().err
