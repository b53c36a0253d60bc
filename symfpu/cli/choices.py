"""Options with a few words to choose from: seen in the help, completed by the shell."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import typer


def choice(name: str, words: Sequence[str], text: str) -> Any:
    """An option of one of these words.

    Other words reach the function behind the verb, whose error says what is allowed for the chain
    at hand.
    """
    shown = f"[{'|'.join(words)}]"
    return typer.Option(name, help=text, metavar=shown, autocompletion=_completed(words))


def _completed(words: Sequence[str]) -> Callable[[str], list[str]]:
    def begun(incomplete: str) -> list[str]:
        return [word for word in words if word.startswith(incomplete)]

    return begun
