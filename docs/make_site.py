"""Builds the site: lays out the pages of docs/, the notebooks, the API and the gallery, and runs Sphinx over them.

    python docs/make_site.py FOLDER [--links]

FOLDER/html/index.html is its first page. --links : ask the network whether links to elsewhere lead somewhere, and build nothing.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

os.environ.setdefault("MPLBACKEND", "agg")
DOCS = Path(__file__).parent
ROOT = DOCS.parent
sys.path.insert(0, str(DOCS))

from press import gallery, topics  # noqa: E402

SAME = ("*.md", "*.png", "conf.py")
CONTENTS = re.compile(r"^:::\{toctree\}\n(.*?)^:::$", re.MULTILINE | re.DOTALL)
STRICT = ["-W", "--keep-going", "-n", "-q"]
TUTORIALS = """# Tutorials

The notebooks of [notebooks/](../notebooks), with the results that are stored in them; tests run them.

:::{{toctree}}
:maxdepth: 1

{names}
:::
"""


def lay_out(folder: Path) -> Path:
    """The sources of the site, new: the pages as they are in docs/, and what is made for it."""
    shutil.rmtree(folder, ignore_errors=True)
    pages = folder / "docs"
    pages.mkdir(parents=True)
    shutil.copy2(ROOT / "README.md", folder)
    for pattern in SAME:
        for path in DOCS.glob(pattern):
            shutil.copy2(path, pages)
    shutil.copytree(DOCS / "_static", pages / "_static")
    _add_pages_of_no_section(pages)
    _write_api(pages / "api")
    _copy_notebooks(pages / "tutorials")
    gallery.write(pages / "gallery")
    return pages


def _add_pages_of_no_section(pages: Path) -> None:
    """A page that no table of contents names goes to the end of the guide's."""
    found = "\n".join(path.read_text() for path in pages.glob("*.md"))
    named = {
        line.strip() for block in CONTENTS.findall(found) for line in block.splitlines()
    }
    others = sorted(
        path.stem for path in pages.glob("*.md") if path.stem not in {*named, "index"}
    )
    guide = pages / "guide.md"
    text = guide.read_text().rstrip().removesuffix(":::")
    guide.write_text("\n".join([text.rstrip(), *others, ":::", ""]))


def _write_api(folder: Path) -> None:
    folder.mkdir()
    for name, text in topics.pages().items():
        (folder / f"{name}.rst").write_text(text)


def _copy_notebooks(folder: Path) -> None:
    folder.mkdir()
    found = sorted((ROOT / "notebooks").glob("*.ipynb"))
    for path in found:
        shutil.copy2(path, folder)
    (folder / "index.md").write_text(
        TUTORIALS.format(names="\n".join(path.stem for path in found))
    )


def build(folder: Path, builder: str = "html") -> int:
    """Sphinx over the pages; warnings are errors. Returns its exit code."""
    pages = lay_out(folder / "pages")
    output = folder / builder
    shutil.rmtree(output, ignore_errors=True)
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-b",
        builder,
        "-d",
        str(folder / "trees"),
        "-E",
        *STRICT,
    ]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(DOCS)])}
    words = [*command, str(pages), str(output)]
    built = subprocess.run(words, env=environment, check=False)  # noqa: S603, our own words
    return built.returncode


if __name__ == "__main__":
    target = Path(sys.argv[1])
    sys.exit(build(target, "linkcheck" if "--links" in sys.argv else "html"))
