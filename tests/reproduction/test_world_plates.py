"""The worlds as the thesis draws them: what is on each plate, and the committed picture's titles."""

import numpy as np

from docs.pictures.figure_world_plates import draw_world_plates
from docs.pictures.worlds import pictures, walked
from lifelore.domains.grids.grid_picture import AGENT_COLOUR, GOAL_COLOUR
from lifelore.figures.style import save_figure


def pixels(picture, colour) -> int:
    return int((picture == np.array(colour, np.uint8)).all(axis=2).sum())


def test_every_world_of_the_thesis_has_its_plate(tmp_path):
    plates = list(pictures())
    numbers = "".join(title[title.index("(") :] for title, _ in plates)
    assert numbers == "(3.2)(3.4)(3.4)(3.6)(3.10)(3.10)(3.20)"
    for _, picture in plates[1:3]:
        assert pixels(picture, GOAL_COLOUR) == (640 // 23) ** 2
        assert pixels(picture, AGENT_COLOUR) > 0
    assert pixels(plates[-1][1], GOAL_COLOUR) == 8 * (640 // 30) ** 2
    assert not np.array_equal(plates[4][1], plates[5][1])
    figure = draw_world_plates(plates, walked())
    assert [one.get_title(loc="left") or one.get_title() for one in figure.axes] == [
        *(title for title, _ in plates), "a prior from three walks (3.18)"
    ]  # fmt: skip
    assert save_figure(figure, tmp_path / "worlds.png").stat().st_size > 10_000
