"""Pictures of families as files."""

from functools import lru_cache

import pytest
from matplotlib.figure import Figure

from symfpu.chain.chain import Chain
from symfpu.families.following import family
from symfpu.figures.family import draw_family


@lru_cache
def unstable():
    return family(Chain(6, beta=1), (5,), "3", from_energy="0.05", multipliers=True)


@lru_cache
def pair():
    """A fold of omega_2 is on its way."""
    return family(Chain(8, alpha="0.3"), (1, 2), "0.005", from_energy="0.001")


@pytest.mark.long
def test_there_is_a_panel_more_with_multipliers(tmp_path, monkeypatch):
    """Drawn, and not written: tests of the command line do that."""

    def drawn(panel, title, stem):
        ax = Figure().add_subplot()
        assert panel(ax) is ax
        titles.append(title)
        return [stem.with_suffix(".png"), stem.with_suffix(".pdf")]

    monkeypatch.setattr("symfpu.figures.family.save_panel", drawn)
    titles: list[str] = []
    names = {"shifts", "amplitudes", "spectra"}
    for found, panels in ((pair(), names), (unstable(), names | {"multipliers"})):
        paths = draw_family(found, tmp_path, stem=f"seeds-{len(found.seeds)}")
        expected = {f"seeds-{len(found.seeds)}-{panel}.{suffix}" for panel in panels for suffix in ("png", "pdf")}
        assert {path.name for path in paths} == expected
    assert titles[0] == "Energy against relative frequency shift (N=8, alpha=0.3, seeds 1, 2)"
    assert len(set(titles)) == 7
