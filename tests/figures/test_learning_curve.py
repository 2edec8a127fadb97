"""What is drawn is what was given."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

from lifelore.core.errors import InputError
from lifelore.figures.learning_curve import draw_curve
from lifelore.figures.style import COLOURS, new_figure


@pytest.fixture
def axes():
    return new_figure(3, 2).subplots()


def test_curve_and_interval(axes):
    x, mean = np.arange(5), np.arange(5.0)
    draw_curve(axes, x, mean, (mean - 1, mean + 2), "lore")
    (line,) = axes.lines
    assert line.get_xydata().tolist() == np.column_stack([x, mean]).tolist()
    assert to_hex(line.get_color()) == COLOURS["lore"]
    assert line.get_label() == "lore"
    edge = axes.collections[0].get_paths()[0].vertices
    assert (edge[:, 1].min(), edge[:, 1].max()) == (-1, 6)


def test_shapes_must_agree(axes):
    with pytest.raises(InputError, match="x and mean must agree in shape"):
        draw_curve(axes, [0, 1], [0, 1, 2], None, "lore")
