"""The response surface passes through what is known; the model of interaction shows every part once."""

import numpy as np
import pytest
from matplotlib.patches import Circle, Rectangle

from docs.pictures.figure_graph_models import draw_interaction_model
from docs.pictures.figure_response_surface import draw_response_surface
from lifelore.core.errors import InputError
from lifelore.figures.style import save_figure

MEAN = np.array([[1.0, 3.0, 2.0], [0.0, 2.0, 2.5], [-1.0, 0.5, 4.0]])


def test_dots_stand_where_bands_and_policies_cross(tmp_path):
    figure = draw_response_surface(MEAN, 0.3 * np.ones((3, 3)), ["a", "b", "c"], ["x", "y", "z"], (0, 2))
    dots = [np.array(c._offsets3d) for c in figure.axes[0].collections if hasattr(c, "_offsets3d")]
    on_bands = [d for d in dots if (d[1] >= 0).all()]
    assert [d[1].tolist() for d in on_bands] == [[0, 0, 0], [2, 2, 2]]
    assert [d[2].tolist() for d in on_bands] == [MEAN[0].tolist(), MEAN[2].tolist()]
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == ["a", "c"]
    assert save_figure(figure, tmp_path / "surface.png").stat().st_size > 10_000


def test_what_cannot_be_a_surface():
    with pytest.raises(InputError, match=r"mean must be \(3, 2\)"):
        draw_response_surface(MEAN, MEAN, ["a", "b", "c"], ["x", "y"])
    with pytest.raises(InputError, match="deviation must be finite"):
        draw_response_surface(MEAN, MEAN * np.nan, ["a", "b", "c"], ["x", "y", "z"])


def test_the_model_of_interaction_has_one_choice_and_seven_variables(tmp_path):
    figure = draw_interaction_model()
    patches = figure.axes[0].patches
    assert sum(isinstance(p, Circle) for p in patches) == 7
    assert sum(isinstance(p, Rectangle) for p in patches) == 1
    assert save_figure(figure, tmp_path / "model.png").stat().st_size > 5_000
