"""Figures of chapter 2's numbers show the numbers they are given."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.experiments.chapter2.c2_03_displacements_by_relation.figure import draw_displacements
from lifelore.experiments.chapter2.c2_05_discarded_points.figure import draw_robustness
from lifelore.experiments.chapter2.confusion_matrix import draw_confusions
from lifelore.experiments.chapter2.method_bars import draw_method_bars
from lifelore.experiments.chapter2.scene_gallery import draw_gallery
from lifelore.figures.object_palette import method_palette, mixed, object_palette, relation_palette
from lifelore.figures.separation_curve import draw_separation
from lifelore.perception.peers import PEERS

THESIS = [[64, 6, 13, 0], [2, 20, 5, 0], [4, 5, 12, 0], [0, 1, 0, 0]]
LABELS = ["on", "adjacent", "both", "none"]


def test_the_thesis_matrix_has_its_recalls():
    (axes,) = draw_confusions({"thesis": THESIS}, LABELS).axes
    assert axes.get_title("left") == "thesis\n96 of 132 right"
    ticks = [tick.get_text() for tick in axes.get_xticklabels()]
    # 64 of 70, 20 of 32, 12 of 30, and no pair that is none.
    assert ticks == ["on\n91 %", "adjacent\n62 %", "both\n40 %", "none\n–"]
    assert [text.get_text() for text in axes.texts] == [str(n) for row in THESIS for n in row]


def test_a_matrix_of_another_size_is_refused():
    with pytest.raises(InputError, match=r"'wrong' must have shape \(4, 4\), got \(2, 2\)"):
        draw_confusions({"wrong": np.eye(2)}, LABELS)


def test_displacements_lie_where_they_are_given():
    at = np.array([[0, 8], [20, 0], [-20, 1], [0, 9]])
    names = ["on", "adjacent", "adjacent", "on"]
    figure = draw_displacements(at, names, centres={"on": (0, 8.5)}, bands={"adjacent": (-5, 5)})
    (axes,) = figure.axes
    clouds = {c.get_label(): np.asarray(c.get_offsets()) for c in axes.collections}
    np.testing.assert_array_equal(clouds["on (2)"], at[[0, 3]])
    np.testing.assert_array_equal(clouds["adjacent (2)"], at[[1, 2]])
    assert [text.get_text() for text in axes.texts] == ["(0, 8.5)"]
    assert axes.get_aspect() == 1


def test_displacements_without_relations_are_refused():
    with pytest.raises(InputError, match=r"displacements must have shape \(1, 2\)"):
        draw_displacements(np.zeros((2, 2)), ["on"])


def test_robustness_in_per_cent_by_method():
    curve = {"x": [0, 70], "mean": [0.9, 0.8], "low": [0.85, 0.7], "high": [0.95, 0.9]}
    panel = {"title": "t", "xlabel": "x", "methods": {"lifelore": curve, "thesis": curve}, "mark": 70}
    figure = draw_robustness([panel, panel | {"methods": {"mine": curve}}])
    lines = {line.get_label(): line for line in figure.axes[0].lines}
    np.testing.assert_allclose(lines["lifelore"].get_xydata(), [[0, 90], [70, 80]])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["lifelore", "thesis", "mine"]


@pytest.mark.parametrize("panels", [[], [{"title": "t", "xlabel": "x", "methods": {"m": {
    "x": [0], "mean": [0, 1], "low": [0], "high": [0]}}}]])  # fmt: skip
def test_robustness_refuses(panels):
    with pytest.raises(InputError, match="must"):
        draw_robustness(panels)


def test_separation_in_millimetres():
    curve = {"gap": [0, 0.1], "support_vectors": [[30, 20, 40], [10, 5, 15]], "nodes": [2, 0]}
    above, below = draw_separation({"l = 60 mm": curve}, near=0.08).axes
    np.testing.assert_allclose(above.lines[0].get_xydata(), [[0, 30], [100, 10]])
    np.testing.assert_allclose(below.lines[0].get_xydata(), [[0, 2], [100, 0]])
    with pytest.raises(InputError, match="one row a gap"):
        draw_separation({"l": curve | {"nodes": [1]}})


def test_bars_are_shares_with_intervals_and_goals():
    measured = {"value": 0.9, "ci95": [0.8, 0.95], "n": 52}
    figure = draw_method_bars(
        {"real": {"lifelore": measured, "thesis": measured | {"value": 0.7}}}, goals={"real": 0.75}
    )
    (axes,) = figure.axes
    np.testing.assert_allclose([bar.get_width() for bar in axes.patches], [90, 70])
    assert [tick.get_text() for tick in axes.get_yticklabels()] == ["lifelore", "thesis"]
    assert axes.get_title("left") == "real (52 pairs)"
    assert any(list(line.get_xdata()) == [75, 75] for line in axes.lines)
    with pytest.raises(InputError):
        draw_method_bars({})


def test_an_empty_gallery_is_refused():
    with pytest.raises(InputError, match="got 0 scenes"):
        draw_gallery([])


def test_colours_are_fixed_and_differ():
    assert mixed("#000000", "#ffffff", 0.5) == "#808080"
    assert len(set(object_palette(range(2, 17)).values())) == 15
    assert relation_palette(["left_of"])["on"] == relation_palette([])["on"]
    palette = method_palette(["lifelore", "mine", "yours"])
    assert palette["lifelore"] == method_palette(["lifelore"])["lifelore"]
    assert len(set(palette.values())) == 3
    assert method_palette(["thesis", "mine"])["mine"] != method_palette(["thesis"])["thesis"]
    everybody = [*PEERS, "thesis", "lifelore"]
    assert len(set(method_palette(everybody).values())) == len(everybody)
