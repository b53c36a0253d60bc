"""`python -I -S symfpu/checkers FILE ...`: checks certificates with the standard library alone.

Prints what was checked; exit code 0 where all are valid, 1 where one is refused, 2 without a file.
Nothing that is installed is used: the folder of the package is all that is needed.
"""

import sys
from pathlib import Path

sys.path[0] = str(Path(__file__).resolve().parents[2])

from symfpu.checkers.reading import CertificateError  # noqa: E402
from symfpu.checkers.verify import verify  # noqa: E402


def main(files: list[str]) -> int:
    """The exit code."""
    if not files:
        print("usage: python -I -S symfpu/checkers FILE ...", file=sys.stderr)
        return 2
    refused = 0
    for file in files:
        try:
            print("\n".join([*verify(file), f"{file}: the certificate is valid"]))
        except CertificateError as error:
            print(f"{file}: refused: {error}", file=sys.stderr)
            refused = 1
    return refused


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
