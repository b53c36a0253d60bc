"""Folders of families: stopped, killed, damaged and gone on with."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from symfpu.chain.chain import Chain
from symfpu.errors import InputError, RunInterrupted
from symfpu.families.following import family
from symfpu.files.archive import BundleError
from symfpu.refinement.ring_tori import RefinedRingTorus
from symfpu.refinement.tori import RefinedTorus
from tests.bundles.test_bundle import same
from tests.families.cases import ROUND, RUNS, whole
from tests.tolerances import FIXED_ENERGY


def energies(found):
    return [m.energy for m in found.members]


def alike(found, other):
    """Members bit for bit: tori, energies, residuals, multipliers; and the events."""
    assert len(found.members) == len(other.members)
    for m, n in zip(found.members, other.members, strict=True):
        if isinstance(m.torus, RefinedTorus | RefinedRingTorus):
            assert same(m.torus, n.torus)
        else:
            assert same((m.torus.frequencies, m.torus.cosines), (n.torus.frequencies, n.torus.cosines))
        assert (m.amplitudes, m.energy, m.harmonic_energy, m.residual, m.warnings) == (
            n.amplitudes,
            n.energy,
            n.harmonic_energy,
            n.residual,
            n.warnings,
        )
        assert (m.multipliers is None) == (n.multipliers is None)
        assert m.multipliers is None or (m.multipliers.pairs == n.multipliers.pairs).all()
    assert found.events == other.events
    assert found.ending == other.ending


def test_the_interrupt_key_leaves_a_family_in_its_folder_and_says_so(tmp_path):
    def stop(label, done):
        if label.startswith("member 3"):
            raise KeyboardInterrupt

    message = f"after 2 members; kept in {tmp_path}: the same call, or command, goes on from there"
    with pytest.raises(RunInterrupted, match=re.escape(message)):
        family(ROUND, (3,), "0.02", folder=tmp_path, progress=stop)
    alike(family(ROUND, (3,), "0.02", folder=tmp_path), family(ROUND, (3,), "0.02"))
    with pytest.raises(KeyboardInterrupt) as bare:
        family(ROUND, (3,), "0.02", progress=stop)
    assert not isinstance(bare.value, RunInterrupted)


@pytest.mark.long
@pytest.mark.parametrize("run", RUNS)
def test_a_stopped_family_goes_on_as_if_it_had_not_been(run, tmp_path):
    arguments, options = RUNS[run]
    for members in (1, 5):
        part = family(*arguments, **options, members=members, folder=tmp_path)
        count = "1 member" if members == 1 else f"{members} members"
        assert part.ending == f"was left after {count}, the most asked for"
        assert len(part.members) == members
    alike(family(*arguments, **options, folder=tmp_path), whole(run))
    alike(family(*arguments, **options, folder=tmp_path), whole(run))
    assert len(list(tmp_path.glob("member-*.symfpu"))) == len(whole(run).members)


def test_a_family_goes_on_to_another_goal(tmp_path):
    """Where it began is in the folder, and what was followed beyond a goal stays there."""
    near = family(ROUND, (3,), "0.01", folder=tmp_path)
    far = family(ROUND, (3,), "0.05", folder=tmp_path)
    assert [m.energy for m in far.members[: len(near.members)]] == [m.energy for m in near.members]
    assert far.members[-1].energy == pytest.approx(0.05, rel=FIXED_ENERGY)
    alike(family(ROUND, (3,), "0.01", folder=tmp_path), near)
    files = sorted(tmp_path.iterdir())
    nearer = family(ROUND, (3,), "0.005", folder=tmp_path)
    assert nearer.members[-1].energy == pytest.approx(0.005, rel=FIXED_ENERGY)
    assert [m.energy for m in nearer.members[:-1]] == [m.energy for m in far.members if m.energy < 0.005]
    assert sorted(tmp_path.iterdir()) == files
    alike(family(ROUND, (3,), "0.05", folder=tmp_path), far)
    with pytest.raises(InputError, match=r"^to_energy = .*more than 1e-05, where the family in the folder begins"):
        family(ROUND, (3,), "0.000009", folder=tmp_path)


def test_a_family_of_version_01_is_gone_on_with(tmp_path):
    """It began at about a thousandth of its goal and ended beyond it; its members stay, and the goal is met."""
    folder, start = Path(__file__).parents[1] / "data" / "version-0.1" / "family", Chain(8, alpha="0.33")
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    facts = json.loads((folder.parent / "facts.json").read_text())["family"]["energies"]
    known = family(start, (1,), "0.01", folder=tmp_path)
    assert known.ending == "reached the energy asked for"
    assert energies(known)[:-1] == pytest.approx([float(e) for e in facts[:-1]], rel=FIXED_ENERGY)
    assert energies(known)[-1] == pytest.approx(0.01, rel=FIXED_ENERGY)
    on = family(start, (1,), "0.012", folder=tmp_path)
    assert energies(on)[:-1] == pytest.approx([float(e) for e in facts], rel=FIXED_ENERGY)
    assert energies(on)[-1] == pytest.approx(0.012, rel=FIXED_ENERGY)


class Killed(BaseException):
    pass


@pytest.mark.long
@pytest.mark.parametrize("moment", [0, 1, 6, 7])
def test_a_family_stopped_while_writing_goes_on(moment, tmp_path, monkeypatch):
    """Every member is two files put in place; before any of them."""
    (arguments, options), replace, calls = RUNS["breather"], os.replace, iter(range(10**6))

    def stopping(*paths):
        if next(calls) == moment:
            raise Killed
        replace(*paths)

    with monkeypatch.context() as patched:
        patched.setattr(os, "replace", stopping)
        with pytest.raises(Killed):
            family(*arguments, **options, folder=tmp_path)
    alike(family(*arguments, **options, folder=tmp_path), whole("breather"))


@pytest.mark.long
def test_a_killed_family_goes_on(tmp_path):
    code = (
        "from symfpu.chain.chain import Chain; from symfpu.families.following import family\n"
        "family(Chain(8, alpha='0.4', beta='0.1'), (3,), '0.1', multipliers=True, from_energy='0.001', folder='.')"
    )
    process = subprocess.Popen([sys.executable, "-c", code], cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(Path.cwd())})
    while process.poll() is None and not (tmp_path / "member-0003.symfpu").exists():
        time.sleep(0.001)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert (tmp_path / "family.json").exists()
    arguments, options = RUNS["breather"]
    alike(family(*arguments, **options, folder=tmp_path), whole("breather"))


OTHERS = {
    "N": ((Chain(9, alpha="0.4", beta="0.1"), (3,)), {}),
    "alpha": ((Chain(8, alpha="0.3", beta="0.1"), (3,)), {}),
    "beta": ((Chain(8, alpha="0.4", beta="0.2"), (3,)), {}),
    "seeds": ((ROUND, (1,)), {}),
    "start": ((ROUND, (3,)), {"from_energy": "0.002"}),
    "order": ((ROUND, (3,)), {"method": "appendix-a", "order": 4}),
    "multipliers": ((ROUND, (3,)), {"multipliers": False}),
    "tolerance": ((ROUND, (3,)), {"tolerance": 1e-12}),
    "ratio_of": ((ROUND, (3,)), {"amplitude_ratio": {3: 1}}),
}


@pytest.fixture(scope="module")
def begun(tmp_path_factory):
    folder = tmp_path_factory.mktemp("begun")
    arguments, options = RUNS["breather"]
    family(*arguments, **options, members=3, folder=folder)
    return folder


@pytest.fixture
def copy(begun, tmp_path):
    for file in begun.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    return tmp_path


@pytest.mark.parametrize("differs", OTHERS)
def test_a_folder_of_another_family_is_refused(differs, begun):
    arguments, options = OTHERS[differs]
    before = {file.name: file.read_bytes() for file in begun.iterdir()}
    chosen = {"multipliers": "method" not in options, "from_energy": "0.001"} | options
    with pytest.raises(InputError, match=rf"^folder = .*its {differs} differs"):
        family(*arguments, "0.1", folder=begun, **chosen)
    assert {file.name: file.read_bytes() for file in begun.iterdir()} == before


def changed(**entries):
    return lambda text: json.dumps(json.loads(text) | entries)


DAMAGE = {
    "empty": lambda text: "",
    "half": lambda text: text[: len(text) // 2],
    "a list": lambda text: "[]",
    "no plan": changed(plan=None),
    "a plan of words": changed(plan="x"),
    "a plan without seeds": changed(plan={}),
    "no count": changed(members=None),
    "a step of words": changed(step="long"),
    "events of words": changed(events=["fold"]),
    "an event of another kind": changed(events=[{"harmonic": [1], "colour": "red"}]),
    "no events": changed(events=None),
}


def test_resonances_of_older_records_are_known_to_be_interpolated(copy):
    """Records did not say so when no resonance was located."""
    (arguments, options), record = RUNS["breather"], json.loads((copy / "family.json").read_text())
    fold = {"kind": "fold", "what": "H", "after": 1, "energy": 0.05, "value": 0.05, "mode": 0, "harmonic": []}
    record["events"] = [fold, fold | {"kind": "resonance", "what": "divisor", "mode": 7, "harmonic": [5]}]
    (copy / "family.json").write_text(json.dumps(record))
    known = family(*arguments, **options, members=3, folder=copy).events
    assert [(e.kind, e.interpolated) for e in known] == [("fold", False), ("resonance", True)]


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_record_is_refused(damage, copy):
    record = copy / "family.json"
    record.write_text(DAMAGE[damage](record.read_text()))
    arguments, options = RUNS["breather"]
    with pytest.raises(InputError, match=r"^folder = .*family\.json is damaged"):
        family(*arguments, **options, folder=copy)


def test_damaged_missing_and_foreign_members_are_refused(copy, tmp_path_factory):
    (arguments, options), file = RUNS["breather"], copy / "member-0001.symfpu"
    data = file.read_bytes()
    file.write_bytes(data[: len(data) // 2])
    with pytest.raises(BundleError, match=r"member-0001\.symfpu is damaged"):
        family(*arguments, **options, folder=copy)
    file.unlink()
    with pytest.raises(InputError, match=r"^folder = .*member-0001\.symfpu"):
        family(*arguments, **options, folder=copy)
    other = tmp_path_factory.mktemp("other")
    family(ROUND, (1,), "0.1", members=1, folder=other)
    file.write_bytes((other / "member-0000.symfpu").read_bytes())
    with pytest.raises(InputError, match=r"^folder = .*member-0001\.symfpu is another torus"):
        family(*arguments, **options, folder=copy)


def test_a_folder_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(InputError, match=r"^folder = .*a folder that can be written"):
        family(ROUND, (3,), "0.1", folder=tmp_path / "file")
    assert (tmp_path / "file").read_text() == "mine"
