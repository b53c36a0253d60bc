"""Panels as files; the style of others is left alone."""

from symfpu.figures.drawing import save_panel


def test_a_panel_is_written_as_png_and_pdf(tmp_path):
    paths = save_panel(lambda ax: ax.plot([1.0, 0.1]), "title", tmp_path / "panel")
    assert [path.suffix for path in paths] == [".png", ".pdf"]
    assert paths[0].read_bytes().startswith(b"\x89PNG")
    assert paths[1].read_bytes().startswith(b"%PDF")


def test_the_style_does_not_leak(tmp_path):
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    save_panel(lambda ax: ax, "title", tmp_path / "panel")
    assert dict(mpl.rcParams) == before
