"""A map as the ground of a picture lies where its frame says, turned maps too, without its unknown rim."""

import numpy as np
import pytest

from lifelore.figures.lives.map_plan import MARGIN, MapPlan
from lifelore.figures.style import house_style, new_figure


def test_limits_leave_out_what_is_unknown():
    grey = np.full((10, 20), 205, np.uint8)
    grey[2:5, 4:10] = 254
    grey[2, 4] = 0
    limits = MapPlan(grey, 0.5, (-1.0, 2.0, 0.0)).limits
    np.testing.assert_allclose(limits, [(1.0 - MARGIN, 4.5 - MARGIN), (4.0 + MARGIN, 6.0 + MARGIN)])


def test_a_map_without_a_known_pixel_is_shown_whole():
    plan = MapPlan(np.full((4, 6), 205, np.uint8), 1.0, (0.0, 0.0, 0.0))
    assert plan.size == pytest.approx((4 + 2 * MARGIN, 6 + 2 * MARGIN))


def test_a_turned_map_is_drawn_turned():
    """One black pixel at the lower left of a map turned by a quarter about (3, 1): x of the map goes up."""
    grey = np.full((4, 8), 254, np.uint8)
    grey[3, 0:2] = 0
    plan = MapPlan(grey, 0.5, (3.0, 1.0, np.pi / 2))
    np.testing.assert_allclose(plan.limits, [(1.0 - MARGIN, 1.0 - MARGIN), (3.0 + MARGIN, 5.0 + MARGIN)])
    with house_style():
        figure = new_figure(4.0, 6.0)
        axes = figure.subplots()
        plan.draw(axes)
        figure.canvas.draw()
        seen = np.asarray(figure.canvas.buffer_rgba())  # type: ignore[attr-defined]

    def shade(x, y):
        column, up = axes.transData.transform((x, y))
        return int(seen[seen.shape[0] - 1 - int(up), int(column), 0])

    assert shade(2.75, 1.5) < 50
    assert shade(1.25, 1.5) > 200
    assert shade(2.75, 4.5) > 200
