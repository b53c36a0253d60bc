"""`python -m tests.fingerprint`: computes the fingerprint anew and compares it, or writes what has changed."""

import argparse
import sys
import time

from tests.fingerprint.comparison import compared, computed, read, unexplained, written

DESCRIPTION = "Compare the numbers of every function with those of the file; exit code 1 if some differ."


def main() -> int:
    parser = argparse.ArgumentParser("python -m tests.fingerprint", description=DESCRIPTION)
    parser.add_argument("cases", nargs="*", help="those of which the name begins so, as series or stability/families; default all")
    parser.add_argument("--update", action="store_true", help="write the new values; reasons.json names a reason for each change")
    parser.add_argument("--times", action="store_true", help="print the processor time of each case")
    given = parser.parse_args()
    began = time.process_time()
    new = computed(given.cases, print if given.times else None)
    old = read(given.cases)
    differences = compared(old, new)
    for key, lines in differences.items():
        print(key, *lines, sep="\n    ")
    print(f"{len(new)} entries, {len(differences)} differ, {time.process_time() - began:.0f} s of processor time")
    if not given.update:
        return 1 if differences else 0
    missing = unexplained(differences, old)
    if missing:
        print("reasons.json has no reason for:", *missing, sep="\n    ")
        return 1
    written(new, old, differences, whole=not given.cases)
    return 0


if __name__ == "__main__":
    sys.exit(main())
