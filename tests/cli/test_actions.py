"""The verb actions: the numbers of `actions` and `twist`, for machines and for a reader."""

import json

import pytest

from symfpu import Chain, actions, breather_at_amplitude, refine, save, travelling_torus, travelling_waves, twist
from symfpu.cli.main import main


@pytest.fixture
def kept(tmp_path):
    orbit = breather_at_amplitude(Chain(4, alpha="0.3"), 1, "0.3")
    return orbit, str(save(tmp_path / "orbit.symfpu", orbit))


def test_json_has_every_digit(kept, capsys):
    orbit, file = kept
    assert main(["actions", file, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    expected = twist(orbit)
    assert found["actions"] == {"1": repr(actions(orbit)[1])}
    assert found["twist"] == [[repr(float(expected.matrix[0, 0]))]]
    assert found["eigenvalues"] == [repr(float(expected.eigenvalues[0]))]
    assert found["isoenergetic_determinant"] == repr(expected.isoenergetic_determinant)
    assert found["signature"] == [1, 0, 0]


def test_lines_for_a_reader(kept, capsys):
    assert main(["actions", kept[1]]) == 0
    lines = capsys.readouterr().out
    assert "mode 1 " in lines
    assert "positive definite" in lines


@pytest.mark.long
def test_a_ring_has_actions_alone_until_it_is_refined(tmp_path, capsys):
    waves = travelling_torus(travelling_waves(Chain(8, alpha="0.3", ends="periodic"), (1,), ("0.7658",), 2))
    for torus, keys in ((waves, set()), (refine(waves), {"twist", "twist_method"})):
        file = save(tmp_path / f"ring{len(keys)}.symfpu", torus)
        assert main(["actions", str(file), "--json"]) == 0
        found = json.loads(capsys.readouterr().out)
        assert {"twist", "twist_method"} & found.keys() == keys
        assert float(found["actions"]["1"]) > 0
