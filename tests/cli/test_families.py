"""The verbs refine and family, and show and export of what they write."""

import csv
import json
from shlex import split

import pytest

from symfpu import Chain, lindstedt, load, refine, save, solve_amplitudes
from tests.cli.running import answer, refusal, run, shown
from tests.tolerances import (
    COMMANDED_RESIDUAL,
    CONDITION,
    FIXED_ENERGY,
    PROMISED_RESIDUAL,
    SHORT_SERIES,
    SMALL_CHANGE,
    SMALL_DISTINCTION,
    TEN_ROUNDINGS,
)

FAMILY = split("family -N 8 --alpha 0.4 --beta 0.1 --seeds 3 --to-energy 0.05 --from-energy 0.01")


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    series = lindstedt(Chain(8, alpha="1/3", beta="0.2"), (1, 3), ("0.3904", "1.1118"), 4)
    return save(tmp_path_factory.mktemp("solved") / "torus.symfpu", solve_amplitudes(series))


@pytest.fixture
def unseen(monkeypatch):
    """Pictures take most of the time; they are drawn in another test."""
    monkeypatch.setattr("symfpu.cli.families.draw_family", lambda found, folder: [])


def test_refine_keeps_the_frequencies_and_solves_the_equations(capsys, solved):
    record = answer(capsys, "refine", solved)
    assert {"amplitudes", "energy", "harmonic_energy", "residual", "newton", "smallest_divisors", "verdict", "warnings"} <= set(record)
    assert record["frequencies"] == {"1": "0.3904", "3": "1.1118"}
    assert record["residual"] < PROMISED_RESIDUAL < load(solved).residual()
    assert record["verdict"] == "torus"
    for q, a in load(solved).amplitudes.items():
        assert float(record["amplitudes"][str(q)]) == pytest.approx(a, rel=SHORT_SERIES)
    assert record["energy_error"] < FIXED_ENERGY


@pytest.mark.parametrize("harmonic", [False, True])
def test_refine_at_an_energy(capsys, solved, harmonic):
    record = answer(capsys, "refine", solved, "--energy", "0.004", *(["--harmonic"] if harmonic else []))
    assert float(record["harmonic_energy" if harmonic else "energy"]) == pytest.approx(0.004, rel=CONDITION)
    assert float(record["energy"]) != pytest.approx(float(record["harmonic_energy"]), rel=SMALL_DISTINCTION)


def test_refine_at_amplitudes(capsys, solved):
    record = answer(capsys, "refine", solved, "--amplitudes", "0.1,0.05", "--tolerance", "1e-8")
    assert {q: float(a) for q, a in record["amplitudes"].items()} == pytest.approx({"1": 0.1, "3": 0.05}, rel=CONDITION)
    assert record["residual"] < COMMANDED_RESIDUAL


def test_refine_at_frequencies_and_at_a_start(capsys, solved):
    record = answer(capsys, "refine", solved, "--frequencies", "0.39041,1.1118", "--tolerance", "1e-8")
    assert record["frequencies"] == {"1": "0.39041", "3": "1.1118"}
    started = answer(capsys, "refine", solved, "--start", "0.1,0.05", "--tolerance", "1e-8")
    assert float(started["amplitudes"]["1"]) == pytest.approx(0.1, rel=SMALL_CHANGE)


@pytest.mark.long
def test_refine_to_digits(capsys, solved, tmp_path):
    """From a file of doubles, and on from the file of fewer digits."""
    fewer, more = str(tmp_path / "fewer"), str(tmp_path / "more")
    out = shown(capsys, "refine", solved, "--digits", "18", "--amplitudes", "0.1,0.05", "-o", fewer)
    assert "in 18 digits" in out
    assert "residual below" in out
    record = answer(capsys, "refine", fewer, "--digits", "22", "-o", more)
    assert (record["origin"], record["digits"]) == ("IterativeRefinement", 22)
    assert record["residual"] < float(record["residual_bound"]) < COMMANDED_RESIDUAL**2
    assert float(record["amplitudes"]["1"]) == 0.1
    assert load(more).frequencies == load(fewer).frequencies
    assert "in 22 digits" in shown(capsys, "show", more)
    at_energy = answer(capsys, "refine", solved, "--digits", "20", "--energy", "0.004")
    assert at_energy["energy"].startswith("0.00400000000000000000"[: len(at_energy["energy"])])


def test_files_without_a_torus_are_refused(capsys, tmp_path):
    series = save(tmp_path / "series.symfpu", lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 2))
    assert "FILE" in refusal(capsys, "refine", series)


def test_a_refined_torus_is_exported(capsys, solved, tmp_path):
    torus = refine(load(solved))
    refined = save(tmp_path / "refined.symfpu", torus)
    shown(capsys, "export", refined, "--lang", "numpy", "-o", tmp_path / "orbit.py")
    module = {"__name__": "orbit"}
    exec(compile((tmp_path / "orbit.py").read_text(), "orbit", "exec"), module)
    assert module["positions"]([0.0, 1.7]) == pytest.approx(torus.Q([0.0, 1.7]), abs=TEN_ROUNDINGS)
    assert "series" in refusal(capsys, "export", refined, "--series", "--lang", "numpy", "-o", str(tmp_path / "series.py"))


@pytest.mark.long
def test_family_writes_members_table_and_pictures(capsys, tmp_path):
    lines = shown(capsys, *FAMILY, "--multipliers", "-o", tmp_path).splitlines()
    assert lines[0].startswith("Family(N=8, alpha=0.4, beta=0.1, seeds=3, ")
    with (tmp_path / "family.csv").open(newline="") as stream:
        head, *rows = csv.reader(stream)
    assert head == ["H", "sum E_q", "omega_3", "A_3", "residual", "verdict", "largest multiplier"]
    assert lines[-2].startswith(f"  Member(torus, H={float(rows[-1][0]):.10g}")
    assert (float(rows[0][0]), float(rows[-1][0])) == pytest.approx((0.01, 0.05), rel=CONDITION)
    assert lines[-1] == f"written: {tmp_path}: family.csv, {len(rows)} members, 8 pictures"
    members = [load(tmp_path / f"member-{k:04d}.symfpu") for k in range(len(rows))]
    assert [f"{m.amplitudes[3]:.15g}" for m in members] == [row[3] for row in rows]
    pictures = {f"family-{name}" for name in ("shifts", "amplitudes", "spectra", "multipliers")}
    for suffix, magic in (("png", b"\x89PNG"), ("pdf", b"%PDF")):
        assert {file.stem for file in tmp_path.glob(f"*.{suffix}")} == pictures
        assert all(file.read_bytes().startswith(magic) for file in tmp_path.glob(f"*.{suffix}"))


def test_family_json_is_alone_on_standard_output(capsys):
    record = answer(capsys, *FAMILY)
    assert record["ending"] == "reached the energy asked for"
    assert (record["N"], record["alpha"], record["beta"], record["seeds"]) == (8, "0.4", "0.1", [3])
    assert float(record["members"][-1]["energy"]) == pytest.approx(0.05, rel=CONDITION)
    assert all(m["residual"] < PROMISED_RESIDUAL and m["verdict"] == "torus" for m in record["members"])
    assert record["events"] == []


def test_a_family_short_of_its_goal_has_code_1_and_goes_on(capsys, tmp_path, unseen):
    """The members there are keep their files; the end is the same as without the interruption."""
    code, out, _ = run(capsys, *FAMILY, "--members", "2", "-o", str(tmp_path), "--json")
    assert code == 1
    part = json.loads(out)
    assert part["ending"] == "was left after 2 members, the most asked for"
    first = (tmp_path / "member-0001.symfpu").read_bytes()
    record = answer(capsys, *FAMILY, "-o", str(tmp_path))
    assert record["members"][:2] == part["members"]
    assert (tmp_path / "member-0001.symfpu").read_bytes() == first
    assert record == answer(capsys, *FAMILY)


def test_events_are_in_the_output(capsys):
    """N = 8: mode 7 meets the fifth harmonic of mode 1."""
    words = split("family -N 8 --alpha 0.3 --seeds 1 --to-energy 0.1 --from-energy 0.05")
    (event,) = [e for e in answer(capsys, *words)["events"] if e["event"] == "resonance"]
    assert (event["event"], event["mode"], event["harmonic"]) == ("resonance", 7, [5])
    out = shown(capsys, *words)
    assert "1 resonance; it reached the energy asked for" in out.splitlines()[0]
    assert "  resonance of mode 7 with harmonic (5) at H = 0.085" in out


@pytest.mark.long
def test_normal_frequencies_are_in_the_output(capsys, tmp_path):
    words = split("family -N 4 --alpha 0.5 --seeds 2 --from-energy 0.4 --to-energy 0.6 --normal")
    record = answer(capsys, *words, "-o", tmp_path)
    [event] = record["normal_events"]
    assert (event["event"], event["resonance"]["modes"], event["begins"]) == ("stability", [1], True)
    assert [m["normal"]["stable"] for m in record["members"]][-1] is False
    assert (tmp_path / "family-normal.png").exists()
    assert shown(capsys, *words, "-o", tmp_path).splitlines()[-2].startswith("  stability: 2 sigma_1 = (1).omega, hyperbolic from A_2=")


def test_ratios_go_by_the_seeds_as_they_are_written(capsys):
    words = split("family -N 6 --beta 0.3 --to-energy 0.01 --from-energy 0.009 --members 1 --json")
    typed = (("--seeds", "1,3", "--amplitude-ratio", "2,1"), ("--seeds", "3,1", "--amplitude-ratio", "1,2"))
    records = [json.loads(run(capsys, *words, *options)[1]) for options in typed]
    assert records[0] == records[1]
    amplitudes = {q: float(a) for q, a in records[0]["members"][0]["amplitudes"].items()}
    assert amplitudes["1"] == pytest.approx(2 * amplitudes["3"], rel=CONDITION)


@pytest.mark.long
def test_family_by_appendix_a(capsys):
    record = answer(capsys, *FAMILY, "--method", "appendix-a", "--order", "4")
    energies = [float(m["energy"]) for m in record["members"]]
    assert energies == sorted(energies)
    assert energies[-1] == pytest.approx(0.05, rel=FIXED_ENERGY)
