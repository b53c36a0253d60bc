"""A process that answers a page at once and loads nothing; `work` of symfpu.workbench.worker loads all."""

import os
import signal


def answer(connection):
    """Each wish has one part, its arguments; the argument "die" ends the process as the system does."""
    try:
        while True:
            kind, ticket, arguments = connection.recv()
            connection.send((kind, ticket, None))
            if arguments == ("die",):
                os.kill(os.getpid(), signal.SIGKILL)
            connection.send((kind, ticket, arguments))
            connection.send((kind, ticket, "done"))
    except EOFError:
        return
