"""Figures of chapter 2 show the numbers they are given."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.figures.scenes import scene_picture
from lifelore.figures.style import house_style, new_figure
from reproduction.chapter2.c2_01_nearest_displacements.run import PRINTED, draw_confusion
from reproduction.chapter2.c2_03_displacements_by_relation.run import draw_displacements
from reproduction.chapter2.scenes import scene_example


def axes_with(draw, *arguments):
    with house_style():
        axes = new_figure(4, 3).subplots()
        draw(axes, *arguments)
    return axes


def test_the_printed_matrix_has_its_recalls():
    axes = axes_with(draw_confusion, np.array(PRINTED), "thesis")
    assert axes.get_title("left") == "thesis\n96 of 132 right"
    ticks = [tick.get_text() for tick in axes.get_xticklabels()]
    # 64 of 70, 20 of 32, 12 of 30, and no pair that is none.
    assert ticks == ["on\n91 %", "adjacent\n62 %", "both\n40 %", "none\n–"]
    assert [text.get_text() for text in axes.texts] == [str(n) for row in PRINTED for n in row]


ROWS = [
    {"relation": "on", "mm": [[0, -8], [0, -9]], "middle_of_on": [0, -8.5]},
    {"relation": "adjacent", "mm": [[90, 0], [-20, 1]], "middle_of_on": [0, -8.5]},
]


def test_displacements_lie_where_they_are_given_and_the_band_begins_a_fifth_of_the_way():
    axes = axes_with(draw_displacements, ROWS, "close", 25)
    clouds = [np.asarray(dots.get_offsets()).tolist() for dots in axes.collections]
    assert [at for at in clouds if at] == [[[0, -8], [0, -9]], [[90, 0], [-20, 1]]]
    assert axes.get_xlim() == axes.get_ylim() == (-25, 25)
    (band,) = axes.patches
    low, high = band.get_path().get_extents(band.get_patch_transform()).intervaly
    assert low == pytest.approx(-1.7)
    assert high > 25


def test_a_picture_for_each_scene_row_by_row(monkeypatch):
    monkeypatch.setattr(scene_picture, "_RESOLUTION", 60)
    points = np.random.default_rng(0).uniform(0, 0.1, (60, 3))
    cloud = LabelledCloud(points, np.repeat([1, 2, 3], 20), None, np.array([0.0, -1, 0.5]))
    document = {"objects": [], "relations": [], "holes": [], "contact_edges": []}
    monkeypatch.setattr(scene_example, "scene_of_row", lambda row: (cloud, document, row["example"]))
    rows = [{"example": caption} for caption in ("one", "two", "three")]
    axes = scene_example.draw_examples({"rows": rows}, ("cloud",)).axes
    assert [each.get_title() for each in axes] == ["one", "two", "three"]
    left, top = zip(*((each.get_position().x0, each.get_position().y1) for each in axes), strict=True)
    assert left[0] == left[2] < left[1]
    assert top[0] == top[1] > top[2]
