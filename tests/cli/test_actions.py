"""The verb actions: the numbers of `actions` and `twist`, for machines and for a reader."""

import pytest

import symfpu
from symfpu import Chain, actions, lindstedt, refine, save, solve_amplitudes, twist
from tests.cli.running import answer, shown


def test_every_digit_is_in_the_record_and_lines_are_for_a_reader(tmp_path, capsys):
    orbit = symfpu.torus(Chain(4, alpha="0.3"), (1,), amplitudes={1: "0.3"})
    file = save(tmp_path / "orbit.symfpu", orbit)
    found, expected = answer(capsys, "actions", file), twist(orbit)
    assert found["actions"] == {"1": repr(actions(orbit)[1])}
    assert found["twist"] == [[repr(float(expected.matrix[0, 0]))]]
    assert found["eigenvalues"] == [repr(float(expected.eigenvalues[0]))]
    assert found["isoenergetic_determinant"] == repr(expected.isoenergetic_determinant)
    assert found["signature"] == [1, 0, 0]
    lines = shown(capsys, "actions", file)
    assert "mode 1 " in lines
    assert "positive definite" in lines


@pytest.mark.long
def test_a_ring_has_actions_alone_until_it_is_refined(tmp_path, capsys):
    waves = solve_amplitudes(lindstedt(Chain(8, alpha="0.3", ends="periodic"), (1,), ("0.7658",), 2))
    for torus, keys in ((waves, set()), (refine(waves), {"twist", "twist_method"})):
        found = answer(capsys, "actions", save(tmp_path / f"ring{len(keys)}.symfpu", torus))
        assert {"twist", "twist_method"} & found.keys() == keys
        assert float(found["actions"]["1"]) > 0


def test_a_series_has_actions_alone(tmp_path, capsys):
    torus = symfpu.torus(Chain(4, alpha="0.3"), (1,), amplitudes={1: "0.5"}, method="series", order=2)
    found = answer(capsys, "actions", save(tmp_path / "torus.symfpu", torus))
    assert found["actions"] == {"1": repr(float(actions(torus)[1]))}
    assert "twist" not in found
