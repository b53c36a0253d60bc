"""Tolerances stand in one table, tests/tolerances.py, each with its reason, and nowhere else."""

import ast
import re
from collections import Counter
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
TABLE = TESTS / "tolerances.py"
FILES = sorted(path for path in TESTS.rglob("*.py") if path != TABLE)
KEYWORDS = {"rel", "abs", "rtol", "atol"}
ORDERINGS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
LARGEST = 1e-4  # a number below it that something is compared with is a tolerance


def number(node):
    """The value of a literal, else 0."""
    known = isinstance(node, ast.Constant) and isinstance(node.value, (int, float))
    return abs(node.value) if known else 0


def arithmetic(node):
    """The leaves of sums, products and choices, without what stands inside of calls and lists."""
    if isinstance(node, ast.BinOp):
        return arithmetic(node.left) + arithmetic(node.right)
    if isinstance(node, ast.UnaryOp):
        return arithmetic(node.operand)
    if isinstance(node, ast.IfExp):
        return arithmetic(node.body) + arithmetic(node.orelse)
    return [node]


def is_small(leaf):
    return 0 < number(leaf) < LARGEST


def compared(tree):
    """What assertions compare by order."""
    claims = [claim for claim in ast.walk(tree) if isinstance(claim, ast.Assert)]
    comparisons = [node for claim in claims for node in ast.walk(claim) if isinstance(node, ast.Compare)]
    ordered = [node for node in comparisons if isinstance(node.ops[0], ORDERINGS)]
    return [side for node in ordered for side in (node.left, *node.comparators)]


def literals(text):
    """Lines with a tolerance that is a literal.

    A small number that an assertion compares with, or a number other than 0 as rel=, abs=, rtol=, atol=. A multiple of a
    name, such as 2 * EPS, is none.
    """
    tree = ast.parse(text)
    small = [side.lineno for side in compared(tree) if any(map(is_small, arithmetic(side)))]
    named = []
    for keyword in (node for node in ast.walk(tree) if isinstance(node, ast.keyword) and node.arg in KEYWORDS):
        leaves = arithmetic(keyword.value)
        if any(map(is_small, leaves)) or (any(map(number, leaves)) and all(isinstance(leaf, ast.Constant) for leaf in leaves)):
            named.append(keyword.value.lineno)
    constants = [node.lineno for node in tree.body if isinstance(node, ast.Assign) and any(map(is_small, arithmetic(node.value)))]
    return sorted({*small, *named, *constants})


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(TESTS)))
def test_no_tolerance_is_a_literal(path):
    assert literals(path.read_text()) == []


FOUND = [
    "assert x < 1e-12",
    "assert 1e-9 > x",
    "assert all(e <= 3 * s + 1e-9 for e in errors)",
    "assert x == pytest.approx(y, rel=0.05)",
    "assert np.allclose(x, y, rtol=1e-13, atol=0)",
    "run = solve_ivp(field, (0, 1), start, atol=1e-5 * scale)",
    "CLOSE = 1e-10",
]
NONE = [
    "assert x < ROUNDING",
    "assert x == pytest.approx(y, rel=2 * ROUNDING, abs=0)",
    "assert x == pytest.approx(1e-5, rel=ROUNDING)",
    "assert energies == [1.0, 1e-8]",
    "assert energy > 0.5",
    "def limit(scale):\n    return 1e-10 * scale",
]


@pytest.mark.parametrize("line", FOUND + NONE)
def test_literals_are_found_and_other_numbers_may_stand(line):
    assert literals(line) == [1] * (line in FOUND)


def test_every_entry_of_the_table_has_its_reason_and_is_used():
    """Entries of one reason stand in lines below each other."""
    texts = [path.read_text() for path in FILES]
    paragraphs = TABLE.read_text().split("\n\n")[2:]
    entries = [paragraph.strip() for paragraph in paragraphs if re.search("^[A-Z]", paragraph, re.MULTILINE)]
    assert len(entries) > 100
    assert [entry for entry in entries if not entry.startswith("# ")] == []
    names = [node.id for node in ast.walk(ast.parse(TABLE.read_text())) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)]
    table = re.sub(r"^#.*\n", "", TABLE.read_text(), flags=re.MULTILINE)
    uses = Counter(re.findall(r"\b[A-Z]\w*\b", "\n".join([table, *texts])))
    assert [name for name in names if uses[name] < 2] == []
    assert len(names) == len(set(names))
