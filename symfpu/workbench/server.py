"""The server of the page: this machine only, and nothing without the token of its address."""

from __future__ import annotations

import hmac
import secrets
import socket
from collections.abc import Callable
from importlib import import_module
from typing import Any
from urllib.parse import urlencode

from symfpu.errors import InputError, SymfpuError

HOST = "127.0.0.1"
TITLE = "symfpu workbench"
EXTRA = "pip install 'symfpu[workbench]'"


def panel() -> Any:
    """Panel. Raises SymfpuError where it is not installed."""
    try:
        return import_module("panel")
    except ModuleNotFoundError as error:
        if error.name != "panel":
            raise
        raise SymfpuError(f"panel is not installed; {EXTRA}") from error


def free_port(wanted: int = 0) -> int:
    """The port, or any free one for 0; InputError for one that is none, or that is taken."""
    allowed = "a free port, 1024 .. 65535, or 0 for any"
    if not (wanted == 0 or 1024 <= wanted <= 65535):
        raise InputError("port", wanted, allowed, "leave it out")
    with socket.socket() as tried:
        tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            tried.bind((HOST, wanted))
        except OSError as error:
            raise InputError("port", wanted, allowed, "another program has it") from error
        return int(tried.getsockname()[1])


class Guard:
    """Who may come in: the token is in the address, or in the cookie that an address gave."""

    def __init__(self, port: int) -> None:
        self.token = secrets.token_urlsafe(24)
        self.port = port
        self._cookie = f"symfpu-{port}"

    @property
    def address(self) -> str:
        """What one opens in the browser."""
        return f"http://{HOST}:{self.port}/?{urlencode({'token': self.token})}"

    @property
    def hosts(self) -> tuple[str, ...]:
        """The names of this server, by one of which a browser must call it."""
        return f"{HOST}:{self.port}", f"localhost:{self.port}"

    def admits(self, token: str | None) -> bool:
        """Whether this is the token."""
        return token is not None and hmac.compare_digest(
            token.encode(), self.token.encode()
        )

    def user(self, handler: Any) -> str:
        """The user of a request, page or websocket; error 403 without the token."""
        from tornado.web import HTTPError

        if handler.request.host not in self.hosts:
            raise HTTPError(403, reason="another name of this machine")
        given = handler.get_argument("token", None)
        if self.admits(given):
            options = {"httponly": True, "samesite": "Strict", "path": "/"}
            handler.set_cookie(self._cookie, self.token, **options)
        elif given is not None or not self.admits(handler.get_cookie(self._cookie)):
            raise HTTPError(403, reason="open the address with its token")
        return "user"

    def provider(self) -> Any:
        """The same as Bokeh's server asks for it."""
        from bokeh.server.auth_provider import AuthProvider

        guard = self

        class Provider(AuthProvider):
            @property
            def get_user(self) -> Any:
                return guard.user

            @property
            def get_login_url(self) -> Any:
                return (
                    guard.user
                )  # never reached: a request without a user has ended before

        return Provider()


def server(page: Callable[[], Any], guard: Guard) -> Any:
    """A server of Bokeh that shows the page and is not started yet."""
    pn = panel()
    pn.extension(notifications=False)

    def shown() -> Any:  # Panel calls functions, and shows anything else as it is
        return page()

    return pn.serve(
        {"/": shown},
        port=guard.port,
        address=HOST,
        websocket_origin=list(guard.hosts),
        auth_provider=guard.provider(),
        session_token_expiration=24 * 3600,
        title=TITLE,
        show=False,
        start=False,
        verbose=False,
    )


def run(
    page: Callable[[], Any], guard: Guard, opened: Callable[[str], object], *, browser: bool
) -> None:
    """Serves until the interrupt key; opened : called with the address once it answers.

    browser : whether the system's browser is to show the page.
    """
    import webbrowser

    running = server(page, guard)
    running.start()
    opened(guard.address)
    if browser:
        running.io_loop.add_callback(webbrowser.open, guard.address)
    try:
        running.io_loop.start()
    finally:
        running.stop()
