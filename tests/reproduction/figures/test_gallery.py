"""Galleries place their pictures in rows, with room for charts below."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.figures.scenes import scene_picture
from lifelore.figures.style import save_figure
from reproduction.figures.gallery import draw_gallery, gallery_above

POINTS = np.random.default_rng(0).uniform(0, 0.1, (60, 3))
CLOUD = LabelledCloud(POINTS, np.repeat([1, 2, 3], 20), None, np.array([0.0, -1, 0.5]))
DOCUMENT = {"objects": [], "relations": [], "holes": [], "contact_edges": []}
SCENES = [(CLOUD, DOCUMENT, caption) for caption in ("one", "two", "three")]


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    """Fewer pixels an inch: the pictures stand in the same places, sooner."""
    monkeypatch.setattr(scene_picture, "_RESOLUTION", 60)


def test_a_picture_for_each_scene_row_by_row():
    axes = draw_gallery(SCENES, columns=2, layers=("cloud",)).axes
    assert [each.get_title() for each in axes] == ["one", "two", "three"]
    left, top = zip(*((each.get_position().x0, each.get_position().y1) for each in axes), strict=True)
    assert left[0] == left[2] < left[1]
    assert top[0] == top[1] > top[2]


def test_charts_stand_below_the_pictures(tmp_path):
    figure, below = gallery_above(SCENES, 2.0, layers=("cloud",))
    chart = below.subplots()
    chart.plot([0, 1])
    save_figure(figure, tmp_path / "figure.png")
    pictures = [each for each in figure.axes if each is not chart]
    assert len(pictures) == 3
    assert chart.get_window_extent().y1 < min(each.get_window_extent().y0 for each in pictures)
