"""The verb workbench: a page in the browser on which tori are chosen and looked at."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from symfpu.cli.terminal import say, whole
from symfpu.cli.verbs import app
from symfpu.workbench.server import Guard, free_port, panel, run


@app.command(epilog="Example: symfpu workbench --port 8050 --no-browser")
def workbench(
    port: Annotated[
        str,
        typer.Option(
            "--port", help="Port of the page.  Default: any free one.", metavar="P"
        ),
    ] = "0",
    no_browser: Annotated[
        bool,
        typer.Option("--no-browser", help="Print the address, and open no browser."),
    ] = False,
) -> None:
    """A page of this machine's browser: choose a torus by sliders, see it at once.

    Nobody else can open it: it answers this machine only, and only with the token of its address.
    Ends with the interrupt key.
    """
    guard = Guard(free_port(whole("port", port)))
    panel()  # says what to install before anything is started

    # lazy: pages need panel, which is an extra
    from symfpu.workbench.page import page
    from symfpu.workbench.worker import Spares

    spares = Spares()
    try:
        run(lambda: page(spares), guard, _say_address, browser=not no_browser)
    finally:
        spares.end()


def _say_address(address: str) -> None:
    say(f"workbench: {address}")
    sys.stdout.flush()  # whoever reads a pipe waits for it
