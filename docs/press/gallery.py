"""The gallery: every file of docs/gallery is run, and what it prints and draws becomes a page.

A file begins with a docstring: a title that ends with a stop, and what there is to see. It may print, and leaves a
figure of matplotlib.
"""

from __future__ import annotations

import ast
import os
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

EXAMPLES = Path(__file__).parents[1] / "gallery"
STYLE, DPI = "symfpu.plots.symfpu", 110

INDEX = """# Gallery

{number} small examples, each a file of [docs/gallery](../docs/gallery) that runs in about a second.

::::{{grid}} 1 2 3 3
:gutter: 3

{cards}
::::

:::{{toctree}}
:hidden:

{names}
:::
"""

CARD = """:::{{grid-item-card}} {title}
:link: {name}
:link-type: doc
:img-top: {name}.png
:img-alt: {title}
:::
"""

PAGE = """# {title}

{words}

![{title}]({name}.png)

```python
{code}
```
{printed}
"""

PRINTED = """
```text
{text}
```
"""


@dataclass(frozen=True)
class Example:
    """An example as it is written: its name, its title, what there is to see, and its statements."""

    name: str
    title: str
    words: str
    code: str


def examples() -> list[Example]:
    """All of them, in the order of their names."""
    return [read(path) for path in sorted(EXAMPLES.glob("*.py"))]


def read(path: Path) -> Example:
    text = path.read_text()
    first = ast.parse(text).body[0]
    title, _, words = str(ast.literal_eval(first.value)).partition("\n")
    code = "\n".join(text.splitlines()[first.end_lineno :]).strip()
    return Example(path.stem, title.rstrip("."), words.strip(), code)


@contextmanager
def _elsewhere() -> Iterator[None]:
    """In an empty folder, for examples that write files."""
    before = Path.cwd()
    with TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            yield
        finally:
            os.chdir(before)


def run(example: Example, picture: Path) -> str:
    """Runs an example, writes its figure, and gives what it printed. Raises ValueError without a figure."""
    import matplotlib.pyplot as plt

    plt.close("all")
    picture, printed = picture.resolve(), StringIO()
    with _elsewhere(), redirect_stdout(printed), plt.style.context(STYLE):
        exec(compile(example.code, f"{example.name}.py", "exec"), {"__name__": "__main__"})  # noqa: S102
        drawn = plt.get_fignums()
        if len(drawn) != 1:
            raise ValueError(
                f"docs/gallery/{example.name}.py draws {len(drawn)} figures, not one"
            )
        plt.gcf().savefig(picture, dpi=DPI)
    plt.close("all")
    return printed.getvalue()


def write(folder: Path) -> None:
    """Pages and pictures of all examples, and the page of cards."""
    folder.mkdir(parents=True, exist_ok=True)
    found = examples()
    for example in found:
        printed = run(example, folder / f"{example.name}.png")
        text = PRINTED.format(text=printed.rstrip()) if printed else ""
        fields = {
            "name": example.name,
            "title": example.title,
            "words": example.words,
            "code": example.code,
        }
        (folder / f"{example.name}.md").write_text(PAGE.format(**fields, printed=text))
    cards = "\n".join(CARD.format(name=one.name, title=one.title) for one in found)
    names = "\n".join(one.name for one in found)
    (folder / "index.md").write_text(
        INDEX.format(number=len(found), cards=cards, names=names)
    )
