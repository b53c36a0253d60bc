"""Atlases: packets by name, power laws, rows that fail, files that go on."""

import json
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import symfpu
from symfpu import (
    Atlas,
    Chain,
    InputError,
    SweepRows,
    assess,
    atlas,
    floquet,
    frequency_rank,
    read_atlas,
    sweep,
)
from symfpu.borders import newton_end
from symfpu.borders.column import atlas_column
from symfpu.borders.last_torus import SHARPER, vanishing_divisor
from symfpu.borders.laws import power_law
from symfpu.borders.newton_end import LOSS_WIDTH, NOT_FOLLOWED, TOLERANCE, TOO_MANY, WIDE_FACTOR
from symfpu.borders.packets import packet_modes
from symfpu.borders.search import WIDTH
from symfpu.refinement.resonances import NearResonance
from symfpu.sweeps.rows import SweepRow
from symfpu.sweeps.this_process import ThisProcess
from tests.tolerances import LOCATED, ROUNDING, SIX_DIGITS

HERE = ThisProcess()
BETA = Chain(8, beta=1)
COLUMN = {"packets": ["low:1"], "by": "amplitude", "order": 3, "borders": ["ratio"], "reach": 1, "executor": HERE}


@pytest.mark.parametrize(
    ("N", "packet", "modes"),
    [
        (8, "2", (2,)),
        (8, "5,1", (1, 5)),
        (8, "low:3", (1, 2, 3)),
        (8, "low:1/4", (1, 2)),
        (32, "middle:1/16", (17, 18)),
        (9, "middle:2", (5, 6)),
        (8, "high:2", (6, 7)),
        (8, "high:7", tuple(range(1, 8))),
    ],
)
def test_packets(N, packet, modes):
    assert packet_modes(Chain(N, beta=1), packet) == modes


WRONG = ["", "1,", "1,1", "0", "8", "1.5", "a", "low", "low:", "low:0", "low:-1", "low:8", "low:1/3", "low:3/2"]
WRONG += ["low:1/0", "low:x", "middle:4", "high:8", "top:1", ":1", "low:1:2"]


@pytest.mark.parametrize("packet", WRONG)
def test_wrong_packets_are_refused(packet):
    with pytest.raises(InputError, match=r"packet|seeds") as caught:
        packet_modes(BETA, packet)
    assert "\n" not in str(caught.value)


def test_an_exact_power_has_no_error():
    lengths = (8, 12, 16, 64)
    law = power_law(lengths, [5 * N**-1.5 for N in lengths])
    assert law.exponent == pytest.approx(-1.5, rel=ROUNDING)
    assert law.factor == pytest.approx(5, rel=ROUNDING)
    assert law.error < ROUNDING
    assert law.local == pytest.approx([-1.5] * 3, rel=ROUNDING)


def test_the_error_of_an_exponent_is_that_of_the_closed_formula():
    """Three lengths in equal ratios, the middle one too high by e: slope as without, error e / (sqrt(3) ln 2)."""
    e = 0.1
    law = power_law((8, 16, 32), (1.0, 0.5 * math.exp(e), 0.25))
    assert law.exponent == pytest.approx(-1, rel=ROUNDING)
    assert law.error == pytest.approx(e / (3**0.5 * math.log(2)), rel=10 * ROUNDING)
    assert law.factor == pytest.approx(8 * math.exp(e / 3), rel=10 * ROUNDING)


def test_two_lengths_have_no_law():
    with pytest.raises(InputError, match="3 lengths or more"):
        power_law((8, 16), (1.0, 0.5))


def border_of(chain, packet="high:1", order=4, border="poles", **how):
    return atlas_column(chain, packet, order, (border,), **how)["borders"][border]


@pytest.mark.long
def test_a_border_is_where_the_radius_is_one():
    """By the tori on both sides of it, each computed from rest."""
    found = border_of(BETA)
    below, above = found["between"]
    assert below < found["energy"] < above
    assert math.log(above / below) <= WIDTH
    tori = [symfpu.torus(BETA, (7,), energy=H, method="series", order=4) for H in (below, above)]
    radii = [assess(torus.origin.series, torus).pole_radius for torus in tori]
    assert radii[0] > 1 > radii[1]
    assert tori[0].energy() == pytest.approx(below, rel=SIX_DIGITS)


@pytest.mark.long
@pytest.mark.parametrize(("name", "power"), [("beta", 1), ("alpha", 2)])
def test_borders_scale_as_energies_do(name, power):
    """Units of length make alpha^2 H and beta H the only numbers."""
    packet, order = {"beta": ("high:1", 4), "alpha": ("low:1", 6)}[name]
    weak, strong = (border_of(Chain(6, **{name: size}), packet, order) for size in ("1/2", 1))
    assert weak["energy"] / strong["energy"] == pytest.approx(2**power, rel=LOCATED)
    assert (weak["mode"], weak["harmonic"]) == (strong["mode"], strong["harmonic"])


@pytest.mark.long
def test_by_amplitude_the_border_of_one_seed_is_the_same():
    found = border_of(BETA), border_of(BETA, by="amplitude")
    assert found[1]["energy"] == pytest.approx(found[0]["energy"], rel=LOCATED)
    torus = symfpu.torus(BETA, (7,), energy=found[0]["energy"], method="series", order=4)
    assert found[1]["place"] == pytest.approx(abs(float(torus.amplitudes[7])), rel=LOCATED)


def test_places_are_points_and_may_be_per_particle():
    places = ["0.01", "0.02"]
    energies = atlas_column(BETA, "1", 2, (), places=places)["points"]
    specific = atlas_column(BETA, "1", 2, (), places=places, per_particle=True)["points"]
    amplitudes = atlas_column(BETA, "1", 2, (), places=places, by="amplitude")["points"]
    assert [p["energy"] for p in energies] == pytest.approx([0.01, 0.02], rel=SIX_DIGITS)
    assert [p["energy"] for p in specific] == pytest.approx([0.08, 0.16], rel=SIX_DIGITS)
    assert [p["amplitudes"] for p in amplitudes] == [[0.01], [0.02]]


def test_newton_follows_tori_to_the_end_of_the_search():
    column = atlas_column(BETA, "1,2", 4, ("newton",), places=["0.01"], reach=2)
    found, tori = column["borders"]["newton"], column["newton"]
    assert found["failure"] == NOT_FOLLOWED
    places = np.array([torus["place"] for torus in tori])
    assert places[[0, -1]] == pytest.approx([0.01, 0.02], rel=SIX_DIGITS)
    assert (places[1:] / places[:-1]).max() <= WIDE_FACTOR * (1 + 2 * SIX_DIGITS)
    for torus in tori:
        assert torus["energy"] == pytest.approx(torus["place"], rel=SIX_DIGITS)
        assert torus["residual"] < TOLERANCE
    assert found["energy"] == tori[-1]["energy"]
    confirmed = found["confirmed"]
    assert confirmed["harmonics"] > tori[-1]["harmonics"]
    assert confirmed["residual"] < TOLERANCE * SHARPER
    assert 0 < confirmed["change"] < TOLERANCE
    assert confirmed["failure"] == ""


def test_newton_stops_at_the_most_harmonics():
    column = atlas_column(BETA, "1", 4, ("newton",), places=["0.01"], reach=100, most_harmonics=14)
    assert column["borders"]["newton"]["failure"] == TOO_MANY
    assert all(torus["harmonics"] <= 14 for torus in column["newton"])


def with_divisors(**divisors):
    """What has near resonances of mode 1 to 3, without a torus."""
    near = [NearResonance(int(name[1]), (1,), size, 0.1 * int(name[1])) for name, size in divisors.items()]
    return SimpleNamespace(origin=SimpleNamespace(near_resonances=tuple(near)))


def test_a_divisor_vanishes_where_the_line_through_two_tori_does():
    before = (1.0, with_divisors(q1=0.2, q2=0.2, q3=0.1))
    last = (2.0, with_divisors(q1=0.1, q2=0.11, q3=0.2))
    assert vanishing_divisor(before, last, 4.01).mode == 1
    assert vanishing_divisor(before, last, 3.99) is None
    assert vanishing_divisor(before, last, 6.0).mode == 2  # of both the one with the larger coefficient


def test_a_torus_with_a_residual_above_the_tolerance_is_not_followed(monkeypatch):
    refined = newton_end._Tori.refined

    def doubtful(*arguments):
        torus = refined(*arguments)
        return replace(torus, warnings=("full",)) if float(torus.energy()) > 0.015 else torus

    monkeypatch.setattr(newton_end._Tori, "refined", doubtful)
    column = atlas_column(BETA, "1", 4, ("newton",), places=["0.01"], reach=100)
    found = column["borders"]["newton"]
    assert found["failure"] == newton_end.NOT_SMALL
    assert found["energy"] < 0.015


@pytest.mark.long
def test_newton_begins_below_the_nearest_pole_where_no_point_is_asked_for():
    """And not at the smallest energy at which a ray is begun."""
    column = atlas_column(BETA, "high:1", 4, ("newton",), reach=1)
    border = border_of(BETA)
    assert column["borders"]["newton"]["energy"] > border["energy"] / 2


@pytest.mark.long
def test_the_first_unstable_breather_is_that_of_its_multipliers():
    column = atlas_column(BETA, "1", 8, ("stability",), places=["0.3"], reach=3)
    found = column["borders"]["stability"]
    below, above = found["between"]
    assert above / below <= LOSS_WIDTH * (1 + 2 * SIX_DIGITS)
    sides = [floquet(symfpu.torus(BETA, (1,), energy=symfpu.Energy(H, harmonic=False))).stable for H in (below, above)]
    assert sides == [True, False]


CHAINS = [{"N": 1, "beta": 1}, Chain(8, beta=1), Chain(8, beta=1, ends="periodic"), Chain("N", beta=1)]


def test_impossible_chains_and_packets_are_rows():
    found = atlas(CHAINS, ["low:1", "low:9"], 2, borders=[], places=["0.01"], executor=HERE)
    said = {(row.case["chain"]["N"], "ends" in row.case["chain"], row.case["packet"]): row.failure for row in found.rows.rows}
    assert len(said) == len(found.rows.rows) == 8
    assert said[8, False, "low:1"] is None
    assert {failure.kind for failure in said.values() if failure} == {"InputError"}
    assert "N = 1" in said[1, False, "low:1"].message
    assert "1..7 (N = 8)" in said[8, False, "low:9"].message
    assert "fixed ends" in said[8, True, "low:1"].message
    assert "put a number for N" in said["N", False, "low:1"].message
    assert repr(found) == "Atlas(8 columns, 7 failed, N = 8 .. 8, 1 point, borders: none)"


def test_a_file_is_gone_on_with(tmp_path):
    file, done = tmp_path / "atlas.jsonl", []
    atlas([Chain(4, beta=1), Chain(6, beta=1)], **COLUMN, file=file)
    before = file.read_text()
    found = atlas([Chain(N, beta=1) for N in (4, 6, 8)], **COLUMN, file=file, progress=lambda _, part: done.append(part))
    after = file.read_text()
    assert after.startswith(before)
    assert (len(after.splitlines()), done) == (4, [1.0])
    assert read_atlas(file) == found
    law = found.law("low:1", "ratio")
    assert law.lengths == (4, 6, 8)
    assert law.energies == tuple(b.energy for b in found.borders)
    assert found.laws == {("beta=1", "low:1", "ratio"): law}
    frame = found.to_frame()
    assert list(frame.energy_per_particle) == [b.energy / b.N for b in found.borders]
    with pytest.raises(InputError, match="fixed"):
        atlas([BETA], **COLUMN | {"reach": 2}, file=file)


def test_the_file_of_another_sweep_is_refused(tmp_path):
    file = tmp_path / "rank.jsonl"
    sweep(frequency_rank, [{"N": 8}], executor=HERE, file=file)
    with pytest.raises(InputError, match="the file of an atlas"):
        read_atlas(file)


def test_of_several_orders_the_largest_is_followed_by_newton():
    chains = (Chain(N, beta=1) for N in (4, 6, 8))
    found = atlas(chains, iter(["high:1"]), np.array([4, 2]), borders=["newton"], places=["1e-3"], reach=1, executor=HERE)
    assert [row.case["order"] for row in found.rows.rows] == [4, 2] * 3
    assert [(b.N, b.order, b.border) for b in found.borders] == [(N, 4, "newton") for N in (4, 6, 8)]
    assert all(b.limited for b in found.borders)
    with pytest.raises(InputError, match="3 lengths or more"):
        found.law("high:1", "newton")
    assert found.laws == {}


def made(*laws, orders=(2,)):
    """An atlas with H = N * order for every law, without computing one."""
    cases = [{"chain": {"N": N} | law, "packet": "1", "order": K} for law in laws for N in (8, 16, 32) for K in orders]
    rows = []
    for case in cases:
        border = {"energy": float(case["chain"]["N"] * case["order"])}
        rows.append(SweepRow(case, {"modes": [1], "points": [], "newton": [], "borders": {"ratio": border}}))
    return Atlas(SweepRows("a.function", {}, tuple(rows)))


def test_of_several_models_one_is_named():
    found = made({"alpha": "1", "beta": "0"}, {"potential": "toda:1/2"})
    assert [key[0] for key in found.laws] == ["alpha=1", "potential=toda:1/2"]
    with pytest.raises(InputError, match="model = None: allowed is one of"):
        found.law("1", "ratio")
    assert found.law("1", "ratio", model="alpha=1").exponent == 1


def test_a_law_is_of_the_largest_order_and_in_the_record():
    found = made({"beta": "1"}, orders=(4, 2))
    assert found.law("1", "ratio").energies == (32, 64, 128)
    assert found.law("1", "ratio", order=2).energies == (16, 32, 64)
    record = found.record()
    assert json.loads(json.dumps(record, allow_nan=False)) == record
    assert [(law["model"], law["border"], law["exponent"]) for law in record["laws"]] == [("beta=1", "ratio", 1.0)]
    assert [border["energy"] for border in record["borders"][:2]] == ["32.0", "16.0"]


WRONG_ARGUMENTS = {
    "packets": {"packets": "low:1"},
    "packets, none": {"packets": []},
    "packets, a number": {"packets": [1]},
    "order": {"order": ()},
    "order, text": {"order": "12"},
    "order, none": {"order": 0},
    "borders": {"borders": ["radius"]},
    "by": {"by": "frequency"},
    "places": {"places": ["0"]},
    "reach": {"reach": 0.5},
    "most_harmonics": {"most_harmonics": 0},
}


@pytest.mark.parametrize("name", WRONG_ARGUMENTS)
def test_wrong_arguments_are_refused(name):
    with pytest.raises(InputError) as caught:
        atlas([BETA], **COLUMN | WRONG_ARGUMENTS[name])
    assert caught.value.argument == name.partition(",")[0]
