"""symfpu reproduce: report, pictures and data of every panel; long runs that are stopped and go on; bad arguments."""

import csv
from functools import partial

import numpy as np
import pytest

from symfpu import NoRecurrence, SymfpuError, alignment_indices, fpu_trajectory, packet_amplitudes
from symfpu.paper import dimensions, fig2, fig3, targets
from symfpu.paper.claims import VERDICTS, PaperFigure
from symfpu.paper.starts import printed_row
from tests.cli.running import refusal, run, shown, strict
from tests.paper.cases import shorter_figure_9
from tests.system import raising

LONG = 1e3  # in place of 1e9
RUNS = {"every": 0.0}  # a checkpoint at every look


@pytest.fixture
def alone(monkeypatch):
    """All targets in this process, where they may be replaced."""
    monkeypatch.setattr("symfpu.paper.side_by_side.available_cores", lambda: 1)


@pytest.fixture
def short(alone, monkeypatch):
    monkeypatch.setattr(fig2, "TIME", 2e3)
    monkeypatch.setattr(fig3, "TIME", 2e3)
    shorter_figure_9(monkeypatch)


@pytest.mark.long
def test_reproduce_writes_claims_pictures_and_data(short, capsys, tmp_path):
    out = shown(capsys, "reproduce", "section5", "fig6", "fig3", "-o", str(tmp_path))
    panels = ("fig3a", "fig3b", "fig6a", "fig6b", "fig6c")
    expected = {f"{panel}.{suffix}" for panel in panels for suffix in ("png", "pdf", "csv")}
    assert {path.name for path in tmp_path.iterdir()} == expected | {"report.md", "report.json"}
    page = (tmp_path / "report.md").read_text()
    record = strict((tmp_path / "report.json").read_text())
    assert list(record["figures"]) == ["section5", "fig3", "fig6"]
    claims = [claim for part in record["figures"].values() for claim in part["claims"]]
    counts = {verdict: sum(claim["verdict"] == verdict for claim in claims) for verdict in VERDICTS}
    summary = ", ".join(f"{n} {verdict}" for verdict, n in counts.items() if n)
    assert f"## Claims\n\n{summary}.\n" in page
    assert all(page.count(f"({panel}.png)") == 1 for panel in panels)
    assert all(len(row) == 7 for row in cells(page, "| section |"))
    assert all(claim["ours"] in out and f"{claim['verdict']}: section {claim['section']}, {claim['text']}" in out for claim in claims)
    assert out.splitlines()[-1].endswith("report.json, fig3a..b, fig6a..c as PNG, PDF and CSV")
    header, *rows = csv.reader((tmp_path / "fig3a.csv").read_text().splitlines())
    assert header == ["curve", "t", "average_energy_over_H"]
    assert len({name for name, _, _ in rows}) == 31


def cells(page, header):
    """Rows of all tables with this header, split where a cell ends."""
    lines = page.replace(r"\|", "").splitlines()
    starts = [i for i, line in enumerate(lines) if line.startswith(header)]
    return [line.split("|") for i in starts for line in lines[i : i + 3]]


@pytest.fixture
def lost(monkeypatch):
    """No figure 3."""
    monkeypatch.setitem(targets.TARGETS, "fig3", raising(NoRecurrence(1e4, 0.9)))


@pytest.mark.long
def test_a_target_that_fails_costs_no_other(alone, lost, capsys, tmp_path):
    code, out, err = run(capsys, "reproduce", "fig3", "section5", "fig6", "-o", str(tmp_path))
    assert code == 1
    assert "no figures of fig3 (NoRecurrence: no recurrence" in err.splitlines()[-1]
    assert "Fig. 6: orders of first excitation" in out
    assert "Fig. 6" in (tmp_path / "report.md").read_text()
    assert list(strict((tmp_path / "report.json").read_text())["figures"]) == ["section5", "fig6"]


def test_one_target_alone_fails_with_its_own_error(lost, capsys, tmp_path):
    assert "no recurrence" in refusal(capsys, "reproduce", "fig3", "-o", str(tmp_path), "--json", code=1)
    assert not list(tmp_path.iterdir())


@pytest.fixture
def full(short, monkeypatch):
    monkeypatch.setattr(dimensions, "FULL_TIME", LONG)
    monkeypatch.setattr(targets, "draw_panels", lambda figure, folder: [])  # pictures of these panels are drawn in other tests
    monkeypatch.setattr(dimensions, "alignment_indices", partial(alignment_indices, **RUNS))


@pytest.mark.long
def test_full_says_how_long_and_goes_on_where_it_was_stopped(full, monkeypatch, capsys, tmp_path):
    """Stopped after a third by the interrupt key; the second run starts there, and ends in the bits of one that was never stopped."""
    fractions = []

    def watched(stop_at, *given, progress, **options):
        def hear(label, done):
            fractions.append(done)
            progress(label, done)
            if done > stop_at:
                raise KeyboardInterrupt

        return alignment_indices(*given, progress=hear, **options, **RUNS)

    monkeypatch.setattr(dimensions, "alignment_indices", partial(watched, 1 / 3))
    code, out, err = run(capsys, "reproduce", "fig9", "--full", "-o", str(tmp_path))
    assert (code, out) == (130, "")
    assert "--full, about: fig9 0.0 h; stopped and started again, alignment indices go on from" in err
    assert str(tmp_path) in err
    assert err.splitlines()[-1].startswith("symfpu: interrupted: at t = ")
    assert str(tmp_path / "fig9-gali.checkpoint") in err.splitlines()[-1]
    assert [path.name for path in tmp_path.iterdir()] == ["fig9-gali.checkpoint"]
    reached = max(fractions)
    fractions.clear()
    monkeypatch.setattr(dimensions, "alignment_indices", partial(watched, 2.0))
    out = shown(capsys, "reproduce", "fig9", "--full", "-o", str(tmp_path), "--json", quiet=False)
    assert list(strict(out)["figures"]) == ["fig9"]
    assert min(fractions) > 0.9 * reached > 0.3
    row = printed_row("Fig. 9")
    start = fpu_trajectory(row.chain, packet_amplitudes(row.chain, (1,), row.energy))
    whole = alignment_indices(row.chain, *start, LONG, vectors=7, step=dimensions.GALI_STEP, frames=1)
    rows = [line for line in csv.reader((tmp_path / "fig9d.csv").read_text().splitlines()) if line[0] == "G_7"]
    assert [float(value) for _, _, value in rows] == whole.log10_gali[:, -1].tolist()


def test_a_checkpoint_of_another_run_is_refused_by_name(tmp_path):
    file = tmp_path / "fig9-gali.checkpoint"
    file.write_bytes(b"something else")
    with pytest.raises(SymfpuError, match=r"fig9-gali\.checkpoint"):
        dimensions.figure_alignment("fig9", (np.ones(31), np.zeros(31)), print, tmp_path, print, full=True)
    assert file.read_bytes() == b"something else"


def test_targets_are_done_once_and_written_in_order_of_the_paper(alone, monkeypatch, capsys, tmp_path):
    done = []
    page = PaperFigure("fig0", "Page", (), ())
    for name in targets.TARGETS:
        monkeypatch.setitem(targets.TARGETS, name, lambda folder, progress, *, full=False, name=name: done.append((name, full)) or page)
    assert run(capsys, "reproduce", "fig9", "table", "fig9", "-o", str(tmp_path))[0] == 0
    assert sorted(done) == [("fig9", False), ("table", False)]
    assert list(strict((tmp_path / "report.json").read_text())["figures"]) == ["table", "fig9"]
    done.clear()
    monkeypatch.setattr("symfpu.cli.reproduce.full_seconds_of", lambda chosen: dict.fromkeys(chosen, 1.0))
    assert run(capsys, "reproduce", "all", "--full", "-o", str(tmp_path))[0] == 0
    assert sorted(done) == sorted((name, True) for name in targets.TARGETS)
    assert list(strict((tmp_path / "report.json").read_text())["figures"]) == list(targets.TARGETS)


@pytest.mark.parametrize(("figure", "N", "vectors"), [("fig1", 16, 5), ("fig9", 32, 7)])
def test_the_estimate_is_that_of_the_figure_s_own_chain(monkeypatch, figure, N, vectors):
    asked = []
    monkeypatch.setattr(dimensions, "seconds_needed", lambda chain, T, **options: asked.append((chain.N, options["vectors"])))
    dimensions.full_seconds(figure)
    assert asked == [(N, vectors)]


def test_the_estimate_names_what_takes_long(monkeypatch, tmp_path):
    monkeypatch.setattr(targets, "full_seconds", lambda figure: {"fig1": 3600.0, "fig2": 7200.0, "fig9": 9000.0}[figure])
    assert targets.full_estimate(targets.full_seconds_of(["fig2", "fig3", "fig9"]), tmp_path).startswith(
        "--full, about: fig2 2.0 h, fig9 2.5 h; stopped"
    )
    assert targets.full_estimate(targets.full_seconds_of(["table"]), tmp_path) == "--full, about: table 25 s"
    assert set(targets.LONG_TARGETS) == {"table", *dimensions.VECTORS}
