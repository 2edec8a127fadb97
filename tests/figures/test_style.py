"""The house style: applied inside its context only, small files, one colour a name."""

from io import BytesIO

import matplotlib
import numpy as np
import pytest
from PIL import Image

from lifelore.core.errors import NotFoundError, StoreError
from lifelore.figures import style
from lifelore.figures.style import colour_of, house_style, new_figure, save_figure


def test_style_is_put_back():
    before = dict(matplotlib.rcParams)
    with house_style():
        assert matplotlib.rcParams["axes.spines.top"] is False
    assert dict(matplotlib.rcParams) == before


def test_a_name_without_a_colour_says_where_to_give_it_one():
    with pytest.raises(NotFoundError, match=r"no colour for 'nobody'; add it to figures/style\.py"):
        colour_of("nobody")


def plain_figure():
    with house_style():
        figure = new_figure(3, 2)
        figure.subplots().plot([0, 1], [0, 1])
    return figure


def test_save_writes_a_png_and_nothing_else(tmp_path):
    path = save_figure(plain_figure(), tmp_path / "deep" / "figure.png")
    assert [p.name for p in path.parent.iterdir()] == ["figure.png"]
    with Image.open(path) as image:
        assert image.size == (540, 360)


def noisy_figure():
    figure = new_figure(2, 2)
    figure.subplots().imshow(np.random.default_rng(0).random((200, 200, 3)))
    return figure


@pytest.mark.parametrize(("limit", "width"), [(100_000, 360), (30_000, 200)], ids=["fewer colours", "coarser"])
def test_a_rich_figure_is_made_to_fit(limit, width, tmp_path, monkeypatch):
    monkeypatch.setattr(style, "MAX_BYTES", limit)
    full = BytesIO()
    noisy_figure().savefig(full, format="png", dpi=180)
    path = save_figure(noisy_figure(), tmp_path / "figure.png")
    assert full.tell() > limit >= path.stat().st_size
    with Image.open(path) as image:
        assert image.size == (width, width)


def test_what_cannot_fit_or_be_written_is_one_line(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(StoreError, match=r"the picture cannot be written to .*; choose another place"):
        save_figure(plain_figure(), tmp_path / "file" / "figure.png")
    monkeypatch.setattr(style, "MAX_BYTES", 100)
    with pytest.raises(StoreError, match="exceeds 100 bytes"):
        save_figure(plain_figure(), tmp_path / "figure.png")
    assert not (tmp_path / "figure.png").exists()


def test_drawing_leaves_no_pyplot_state():
    import sys

    plain_figure()
    assert "matplotlib.pyplot" not in sys.modules or not sys.modules["matplotlib.pyplot"].get_fignums()
