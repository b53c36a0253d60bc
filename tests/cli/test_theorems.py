"""Every kind of theorem, by the commands of docs/theorems.md; its certificate is checked by a Python that has nothing installed."""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from symfpu.checkers.verify import CHECKERS
from symfpu.cli.main import main

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "theorems.md"
# what opens a certificate where no package is there: its checker by its folder
BARE = """
import json, sys
from importlib import import_module
sys.path.insert(0, sys.argv[1])
for path in sys.argv[2:]:
    format = json.load(open(path))["format"]
    for name in ("propagation", "every_length", "existence", "stability", "torus"):
        checker = import_module(f"symfpu.checkers.{name}")
        if checker.FORMAT == format:
            print(json.dumps([path, *checker.verify(path)]))
foreign = {name.partition(".")[0] for name in sys.modules} - set(sys.stdlib_module_names) - {"symfpu", "__main__"}
assert not foreign, foreign
"""


def commands():
    [block] = re.findall(r"^```shell parsed\n(.*?)^```$", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    return [shlex.split(line)[1:] for line in block.splitlines()]


@pytest.fixture(scope="module")
def certificates(tmp_path_factory):
    """By name, what the commands of the page write."""
    folder = tmp_path_factory.mktemp("theorems")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for words in commands():
            assert main(words) == 0, words
    return {path.stem: path for path in sorted(folder.glob("*.json"))}


@pytest.fixture(scope="module")
def said(certificates):
    """By name, what a checker says that has the standard library alone: no site, no environment."""
    call = [sys.executable, "-I", "-S", "-c", BARE, str(ROOT), *map(str, certificates.values())]
    lines = subprocess.run(call, check=True, capture_output=True, text=True).stdout.splitlines()
    return {Path(path).stem: rest for path, *rest in map(json.loads, lines)}


def test_the_page_has_every_kind(certificates):
    formats = {json.loads(path.read_text())["format"] for path in certificates.values()}
    assert formats == set(CHECKERS)
    rooms = {checker.check.__module__.split(".")[2] for checker in CHECKERS.values()}
    assert all(f"`checkers/{room}/`" in PAGE.read_text() for room in rooms)


THEOREMS = {
    "rule": "theorem: in the alpha chain, N = 8, seeds [1, 2], to order 3, the propagation rule holds",
    "every-n": "for every N and every set of 1 seed, to order 3, the propagation rule holds",
    "frequency": "has a periodic orbit of frequency omega = ",
    "amplitude": "has a periodic orbit of amplitude A = 1/5",
    "energy": "has a periodic orbit of energy H = ",
    "curve": "has for every amplitude A from 199/1000 to 201/1000, on one analytic curve, a periodic orbit",
    "wave": "r^4/4 has a periodic orbit of amplitude A = 1/2, a travelling wave r_j(t) =",
    "stability": "is linearly stable",
    "residual": "leaves |x'' - force| <= ",
    "stay": "leaves |x'' - force| <= ",
}


def test_every_certificate_is_a_theorem_without_any_package(certificates, said):
    assert set(certificates) == set(said) == set(THEOREMS)
    for name, sentence in THEOREMS.items():
        assert sentence in said[name][0], said[name][0]


@pytest.mark.long
def test_the_verb_says_the_same(certificates, said, capsys):
    for name, path in certificates.items():
        assert main(["verify", str(path)]) == 0
        assert capsys.readouterr().out.splitlines()[: len(said[name])] == said[name]
