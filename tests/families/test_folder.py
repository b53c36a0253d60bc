"""Folders of families: stopped, killed, damaged and gone on with."""

import os
import re
import shutil
from pathlib import Path

import pytest

from symfpu import BundleError, Chain, InputError, Newton, family
from symfpu.errors import RunInterrupted
from symfpu.files.sealed import document_in, write_sealed
from tests.families.cases import ROUND, RUNS, whole
from tests.store.test_saved_file import same
from tests.tolerances import FIXED_ENERGY


def energies(found):
    return [m.energy for m in found.members]


def alike(found, other):
    """Members bit for bit: tori, energies, residuals, multipliers; and the events."""
    assert len(found.members) == len(other.members)
    for m, n in zip(found.members, other.members, strict=True):
        if isinstance(m.torus.origin, Newton):
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


def test_a_record_without_a_digest_is_refused(tmp_path):
    """As records were that no release has written."""
    folder = Path(__file__).parents[1] / "data" / "version-0.1" / "family"
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    with pytest.raises(InputError, match=r"^folder = .*family\.json is damaged, or of an older"):
        family(Chain(8, alpha="0.33"), (1,), "0.01", folder=tmp_path)


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
    """A record with other entries and with the digest of these: no run writes it."""

    def written(text, path):
        document = document_in(text.encode()) | entries
        write_sealed(path, document)
        return path.read_text()

    return written


def flipped(text, path):
    """One bit in a number of the record."""
    place = text.index('"largest": ') + len('"largest": ')
    return text[:place] + chr(ord(text[place]) ^ 1) + text[place + 1 :]


DAMAGE = {
    "empty": lambda text, path: "",
    "half": lambda text, path: text[: len(text) // 2],
    "a list": lambda text, path: "[]",
    "a flipped bit": flipped,
    "no plan": changed(plan=None),
    "a plan of words": changed(plan="x"),
    "a plan without seeds": changed(plan={}),
    "no count": changed(members=None),
    "a step of words": changed(step="long"),
    "events of words": changed(events=["fold"]),
    "an event of another kind": changed(events=[{"harmonic": [1], "colour": "red"}]),
    "no events": changed(events=None),
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_record_is_refused(damage, copy):
    record = copy / "family.json"
    record.write_text(DAMAGE[damage](record.read_text(), record))
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


def test_a_second_run_in_one_folder_is_refused(tmp_path):
    def second(label, done):
        with pytest.raises(InputError, match=r"^folder = .*process [0-9]+ on .*the other family"):
            family(ROUND, (3,), "0.02", folder=tmp_path)
        heard.append(label)

    heard = []
    family(ROUND, (3,), "0.02", members=1, folder=tmp_path, progress=second)
    assert heard
    assert {file.name for file in tmp_path.iterdir()} == {"family.json", "member-0000.symfpu"}


def test_a_record_that_might_never_end_is_not_read(tmp_path):
    os.mkfifo(tmp_path / "family.json")
    with pytest.raises(InputError, match=r"^folder = .*allowed is a regular file"):
        family(ROUND, (3,), "0.1", folder=tmp_path)


def test_a_folder_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(InputError, match=r"^folder = .*a folder that can be written"):
        family(ROUND, (3,), "0.1", folder=tmp_path / "file")
    assert (tmp_path / "file").read_text() == "mine"
