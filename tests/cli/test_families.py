"""The verbs refine and family, and show and export of what they write."""

import csv
import json

import pytest

from symfpu.bundles.bundle import load, save
from symfpu.chain.chain import Chain
from symfpu.cli.main import main
from symfpu.series.lindstedt import lindstedt
from tests.tolerances import COMMANDED_RESIDUAL, CONDITION, FIXED_ENERGY, PROMISED_RESIDUAL, SHORT_SERIES, SMALL_DISTINCTION, TEN_ROUNDINGS

TORUS = ["-N", "8", "--alpha", "1/3", "--beta", "0.2", "--seeds", "1,3", "--omega", "0.3904,1.1118", "--order", "4"]
FAMILY = ["family", "-N", "8", "--alpha", "0.4", "--beta", "0.1", "--seeds", "3", "--to-energy", "0.05", "--from-energy", "0.01"]


def run(capsys, *argv):
    code = main(list(argv))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    file = str(tmp_path_factory.mktemp("solved") / "torus.symfpu")
    assert main(["solve", *TORUS, "-o", file]) == 0
    return file


@pytest.fixture(scope="module")
def refined(solved):
    file = solved.replace("torus", "refined")
    assert main(["refine", solved, "-o", file]) == 0
    return file


@pytest.fixture
def unseen(monkeypatch):
    """Pictures take most of the time; they are drawn in another test."""
    monkeypatch.setattr("symfpu.cli.families.draw_family", lambda found, folder: [])


def refusal(capsys, *argv, code=2):
    """The one line on standard error; nothing on the other."""
    found, out, err = run(capsys, *argv)
    assert (found, out) == (code, "")
    assert len(err.splitlines()) == 1
    assert err.startswith("symfpu: ")
    assert "Traceback" not in err
    return err


def test_refine_keeps_the_frequencies_and_solves_the_equations(capsys, solved):
    code, out, err = run(capsys, "refine", solved, "--json")
    record = json.loads(out)
    assert (code, err) == (0, "")
    assert {"amplitudes", "energy", "harmonic_energy", "residual", "newton", "smallest_divisors", "verdict", "warnings"} <= set(record)
    assert record["frequencies"] == {"1": "0.3904", "3": "1.1118"}
    assert record["residual"] < PROMISED_RESIDUAL < load(solved).torus.residual()
    assert record["verdict"] == "torus"
    for q, a in load(solved).torus.amplitudes.items():
        assert float(record["amplitudes"][str(q)]) == pytest.approx(a, rel=SHORT_SERIES)
    assert record["energy_error"] < FIXED_ENERGY


def test_refine_prints_the_verdict_first(capsys, solved, tmp_path):
    file = str(tmp_path / "r")
    code, out, err = run(capsys, "refine", solved, "-o", file)
    lines = out.splitlines()
    assert (code, err) == (0, "")
    assert lines[0] == "verdict: torus"
    assert lines[1].startswith("seed 1    omega 0.3904 ")
    assert lines[-1] == f"written: {file}"


@pytest.mark.parametrize("harmonic", [False, True])
def test_refine_at_an_energy(capsys, solved, harmonic):
    code, out, _ = run(capsys, "refine", solved, "--energy", "0.004", *(["--harmonic"] if harmonic else []), "--json")
    record = json.loads(out)
    assert code == 0
    assert float(record["harmonic_energy" if harmonic else "energy"]) == pytest.approx(0.004, rel=CONDITION)
    assert float(record["energy"]) != pytest.approx(float(record["harmonic_energy"]), rel=SMALL_DISTINCTION)


def test_refine_at_amplitudes(capsys, solved):
    code, out, _ = run(capsys, "refine", solved, "--amplitudes", "0.1,0.05", "--tolerance", "1e-8", "--json")
    record = json.loads(out)
    assert code == 0
    assert {q: float(a) for q, a in record["amplitudes"].items()} == pytest.approx({"1": 0.1, "3": 0.05}, rel=CONDITION)
    assert record["residual"] < COMMANDED_RESIDUAL


@pytest.mark.long
def test_refine_to_digits(capsys, solved, tmp_path):
    """From a file of doubles, and on from the file of fewer digits."""
    fewer, more = str(tmp_path / "fewer"), str(tmp_path / "more")
    code, out, err = run(capsys, "refine", solved, "--digits", "18", "--amplitudes", "0.1,0.05", "-o", fewer)
    assert (code, err) == (0, "")
    assert "in 18 digits" in out
    assert "residual below" in out
    code, out, _ = run(capsys, "refine", fewer, "--digits", "22", "-o", more, "--json")
    record = json.loads(out)
    assert (code, record["kind"], record["digits"]) == (0, "PreciseTorus", 22)
    assert record["residual"] < float(record["residual_bound"]) < COMMANDED_RESIDUAL**2
    assert float(record["amplitudes"]["1"]) == 0.1
    assert load(more).torus.frequencies == load(fewer).torus.frequencies
    code, out, _ = run(capsys, "show", more)
    assert "in 22 digits" in out


BAD_REFINE = {
    "energy and digits": (["--energy", "0.01", "--digits", "20"], "energy"),
    "no digits": (["--digits", "0"], "digits"),
    "digits of words": (["--digits", "many"], "digits"),
    "harmonic without energy": (["--harmonic"], "harmonic"),
    "energy and amplitudes": (["--energy", "0.01", "--amplitudes", "0.1,0.1"], "amplitudes"),
    "too few amplitudes": (["--amplitudes", "0.1"], "amplitudes"),
    "too many amplitudes": (["--amplitudes", "0.1,0.1,0.1"], "amplitudes"),
    "an amplitude of words": (["--amplitudes", "0.1,x"], "amplitudes"),
    "an amplitude of zero": (["--amplitudes", "0.1,0"], "amplitudes"),
    "a negative energy": (["--energy", "-1"], "energy"),
    "an energy of words": (["--energy", "x"], "energy"),
    "a tolerance of words": (["--tolerance", "x"], "tolerance"),
    "a tolerance of nothing": (["--tolerance", "0"], "tolerance"),
    "a tolerance that is no number": (["--tolerance", "nan"], "tolerance"),
    "an output in no folder": (["-o", "/no such folder/file"], "output"),
    "an output that is a folder": (["-o", "/"], "output"),
}


@pytest.mark.parametrize("case", BAD_REFINE)
def test_bad_input_of_refine(capsys, solved, case):
    options, named = BAD_REFINE[case]
    assert refusal(capsys, "refine", solved, *options).startswith(f"symfpu: {named}")


def test_files_without_a_torus_are_refused(capsys, tmp_path):
    series = save(tmp_path / "series.symfpu", lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 2))
    assert "FILE" in refusal(capsys, "refine", str(series))
    assert "No such file" in refusal(capsys, "refine", str(tmp_path / "none"))
    foreign = tmp_path / "foreign"
    foreign.write_text("hello")
    assert "not a symfpu bundle" in refusal(capsys, "refine", str(foreign))


def test_a_torus_that_is_not_there_is_an_honest_failure(capsys, solved, tmp_path):
    output = tmp_path / "none.symfpu"
    assert "no torus of the seeds (1, 3)" in refusal(capsys, "refine", solved, "--energy", "1e9", "-o", str(output), code=1)
    assert not output.exists()


def test_show_prints_what_refine_has_written(capsys, refined):
    _, fresh, _ = run(capsys, "refine", refined)
    code, shown, err = run(capsys, "show", refined)
    assert (code, err) == (0, "")
    assert shown.splitlines()[:5] == fresh.splitlines()[:5]
    assert any(line.startswith("command") and f"-o {refined}" in line for line in shown.splitlines())
    code, out, _ = run(capsys, "show", refined, "--json")
    record = json.loads(out)
    assert record["assessment"] == {"verdict": "torus", "reasons": []}
    assert record["residual"] < PROMISED_RESIDUAL
    assert len(record["test_vectors"]) == 3


def test_a_refined_torus_is_exported(capsys, refined, tmp_path):
    code, _, err = run(capsys, "export", refined, "--lang", "numpy", "-o", str(tmp_path / "orbit.py"))
    assert (code, err) == (0, "")
    module = {"__name__": "orbit"}
    exec(compile((tmp_path / "orbit.py").read_text(), "orbit", "exec"), module)
    torus = load(refined).torus
    assert module["positions"]([0.0, 1.7]) == pytest.approx(torus.positions([0.0, 1.7]), abs=TEN_ROUNDINGS)
    assert "series" in refusal(capsys, "export", refined, "--series", "--lang", "numpy", "-o", str(tmp_path / "series.py"))


@pytest.mark.long
def test_family_writes_members_table_and_pictures(capsys, tmp_path):
    code, out, err = run(capsys, *FAMILY, "--multipliers", "-o", str(tmp_path))
    lines = out.splitlines()
    assert (code, err) == (0, "")
    assert lines[0].startswith("Family(N=8, alpha=0.4, beta=0.1, seeds=3, ")
    with (tmp_path / "family.csv").open(newline="") as stream:
        head, *rows = csv.reader(stream)
    assert head == ["H", "sum E_q", "omega_3", "A_3", "residual", "verdict", "largest multiplier"]
    assert lines[-2].startswith(f"  Member(torus, H={float(rows[-1][0]):.10g}")
    assert (float(rows[0][0]), float(rows[-1][0])) == pytest.approx((0.01, 0.05), rel=CONDITION)
    assert lines[-1] == f"written: {tmp_path}: family.csv, {len(rows)} members, 8 pictures"
    members = [load(tmp_path / f"member-{k:04d}.symfpu").torus for k in range(len(rows))]
    assert [f"{m.amplitudes[3]:.15g}" for m in members] == [row[3] for row in rows]
    pictures = {f"family-{name}" for name in ("shifts", "amplitudes", "spectra", "multipliers")}
    for suffix, magic in (("png", b"\x89PNG"), ("pdf", b"%PDF")):
        assert {file.stem for file in tmp_path.glob(f"*.{suffix}")} == pictures
        assert all(file.read_bytes().startswith(magic) for file in tmp_path.glob(f"*.{suffix}"))


def test_family_json_is_alone_on_standard_output(capsys):
    code, out, err = run(capsys, *FAMILY, "--json")
    record = json.loads(out)
    assert (code, err) == (0, "")
    assert record["ending"] == "reached the energy asked for"
    assert (record["N"], record["alpha"], record["beta"], record["seeds"]) == (8, "0.4", "0.1", [3])
    assert float(record["members"][-1]["energy"]) == pytest.approx(0.05, rel=CONDITION)
    assert all(m["residual"] < PROMISED_RESIDUAL and m["verdict"] == "torus" for m in record["members"])
    assert record["events"] == []


def test_a_family_short_of_its_goal_has_code_1_and_goes_on(capsys, tmp_path, unseen):
    """The members there are keep their files; the end is the same as without the interruption."""
    code, out, _ = run(capsys, *FAMILY, "--members", "3", "-o", str(tmp_path), "--json")
    assert code == 1
    part = json.loads(out)
    assert part["ending"] == "was left after 3 members, the most asked for"
    first = (tmp_path / "member-0002.symfpu").read_bytes()
    code, out, _ = run(capsys, *FAMILY, "-o", str(tmp_path), "--json")
    record = json.loads(out)
    assert code == 0
    assert record["members"][:3] == part["members"]
    assert (tmp_path / "member-0002.symfpu").read_bytes() == first
    assert record == json.loads(run(capsys, *FAMILY, "--json")[1])


def test_events_are_in_the_output(capsys):
    """N = 8: mode 7 meets the fifth harmonic of mode 1."""
    options = ["-N", "8", "--alpha", "0.3", "--seeds", "1", "--to-energy", "0.1", "--from-energy", "0.05"]
    code, out, _ = run(capsys, "family", *options, "--json")
    (event,) = json.loads(out)["events"]
    assert code == 0
    assert (event["event"], event["mode"], event["harmonic"]) == ("resonance", 7, [5])
    _, out, _ = run(capsys, "family", *options)
    assert "1 resonance; it reached the energy asked for" in out.splitlines()[0]
    assert out.splitlines()[-1].startswith("  resonance of mode 7 with harmonic (5) at H = 0.09")


def test_normal_frequencies_are_in_the_output(capsys, tmp_path):
    options = ["-N", "4", "--alpha", "0.5", "--seeds", "2", "--from-energy", "0.4", "--to-energy", "0.6", "--normal"]
    code, out, _ = run(capsys, "family", *options, "-o", str(tmp_path), "--json")
    record = json.loads(out)
    [event] = record["normal_events"]
    assert code == 0
    assert (event["event"], event["resonance"]["modes"], event["begins"]) == ("stability", [1], True)
    assert [m["normal"]["stable"] for m in record["members"]][-1] is False
    assert (tmp_path / "family-normal.png").exists()
    _, out, _ = run(capsys, "family", *options)
    assert out.splitlines()[-1].startswith("  stability: 2 sigma_1 = (1).omega, hyperbolic from A_2=")


def test_ratios_go_by_the_seeds_as_they_are_written(capsys):
    options = ["-N", "6", "--beta", "0.3", "--to-energy", "0.01", "--from-energy", "0.009", "--members", "1", "--json"]
    records = [
        json.loads(run(capsys, "family", *options, "--seeds", seeds, "--amplitude-ratio", ratio)[1])
        for seeds, ratio in (("1,3", "2,1"), ("3,1", "1,2"))
    ]
    assert records[0] == records[1]
    amplitudes = {q: float(a) for q, a in records[0]["members"][0]["amplitudes"].items()}
    assert amplitudes["1"] == pytest.approx(2 * amplitudes["3"], rel=CONDITION)


@pytest.mark.long
def test_family_by_appendix_a(capsys):
    options = ["--method", "appendix-a", "--order", "4"]
    code, out, _ = run(capsys, *FAMILY, *options, "--json")
    energies = [float(m["energy"]) for m in json.loads(out)["members"]]
    assert code == 0
    assert energies == sorted(energies)
    assert energies[-1] == pytest.approx(0.05, rel=FIXED_ENERGY)


BAD_FAMILY = {
    "N": (["-N", "x"], "N"),
    "seeds": (["--seeds", "8"], "seeds"),
    "goal": (["--to-energy", "x"], "to_energy"),
    "beginning": (["--from-energy", "1"], "from_energy"),
    "members": (["--members", "0"], "members"),
    "members of words": (["--members", "x"], "members"),
    "method": (["--method", "newton"], "method"),
    "order": (["--order", "4"], "order"),
    "order missing": (["--method", "appendix-a"], "order"),
    "ratio": (["--amplitude-ratio", "1,2"], "amplitude-ratio"),
    "two ratios": (["--amplitude-ratio", "1", "--energy-ratio", "1"], "energy_ratio"),
    "multipliers of series": (["--multipliers", "--method", "appendix-a", "--order", "4"], "multipliers"),
    "multipliers of two seeds": (["--multipliers", "--seeds", "1,2"], "multipliers"),
    "no coupling": (["--alpha", "0", "--beta", "0"], "alpha, beta"),
}


@pytest.mark.parametrize("case", BAD_FAMILY)
def test_bad_input_of_family(capsys, case):
    options, named = BAD_FAMILY[case]
    assert refusal(capsys, *FAMILY, *options).startswith(f"symfpu: {named} = ")


def test_folders_that_cannot_be_used_are_refused(capsys, tmp_path, unseen):
    file = tmp_path / "a file"
    file.write_text("mine")
    assert "output" in refusal(capsys, *FAMILY, "-o", str(file))
    folder = tmp_path / "folder"
    assert run(capsys, *FAMILY, "--members", "1", "-o", str(folder))[0] == 1
    assert "its alpha differs" in refusal(capsys, *FAMILY, "--alpha", "0.3", "-o", str(folder))
    (folder / "family.json").write_text("{")
    assert "family.json is damaged" in refusal(capsys, *FAMILY, "-o", str(folder))


@pytest.mark.parametrize("verb", ["refine", "family"])
def test_help_has_an_example_of_its_verb(capsys, verb):
    code, out, err = run(capsys, verb, "--help")
    assert (code, err) == (0, "")
    assert f"Example: symfpu {verb}" in out
    assert "--json" in out
    assert verb in run(capsys, "--help")[1]
