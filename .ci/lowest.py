"""The lowest version that pyproject.toml allows of every package, one constraint for pip a line."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

PROJECT = Path(__file__).parents[1] / "pyproject.toml"
REQUIREMENT = re.compile(
    r"([\w.-]+)>=([\w.]+)"
)  # a name and its lowest version, no other bound


def lowest(project: Path = PROJECT) -> Iterator[str]:
    """name==version for the requirements of the package and of its extras, each once."""
    table = tomllib.loads(project.read_text())["project"]
    extras = table["optional-dependencies"].values()
    requirements = {*table["dependencies"], *(line for extra in extras for line in extra)}
    for requirement in sorted(requirements):
        found = REQUIREMENT.fullmatch(requirement)
        if found is None:
            raise ValueError(f"{requirement}: not of the form name>=version")
        yield f"{found[1]}=={found[2]}"


if __name__ == "__main__":
    print("\n".join(lowest()))
