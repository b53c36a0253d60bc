"""python -m symfpu: the command line."""

from symfpu.cli.main import run

run()
