"""Ways on a floor plan: each starts and ends where it should, and tasks do not hide each other."""

import numpy as np
import pytest

from lifelore.domains.grids.grid_world import GridWorld
from lifelore.figures.lives.world_map import draw_world_map
from lifelore.figures.style import save_figure


@pytest.fixture
def corridor() -> GridWorld:
    return GridWorld.from_free("corridor", np.ones((1, 4), bool))


def _paths(figure) -> list:
    return [line for line in figure.axes[0].lines if len(line.get_xdata()) > 1 and line.get_linestyle() == "-"]


def test_a_way_leads_from_start_to_goal(corridor, tmp_path):
    way = {"label": "task 0", "goal": (0, 3), "paths": [[(0, 0), (0, 1), (0, 2), (0, 3)]]}
    figure = draw_world_map(corridor.shape, corridor.cells, corridor.neighbour, [way], goals=[(0, 1)], cell=0.5)
    (path,) = _paths(figure)
    assert (path.get_xdata().tolist(), path.get_ydata().tolist()) == ([0, 1, 2, 3], [0, 0, 0, 0])
    star = next(line for line in figure.axes[0].lines if line.get_marker() == "*")
    assert (star.get_xdata()[0], star.get_ydata()[0]) == (3, 0)
    assert save_figure(figure, tmp_path / "world.png").stat().st_size > 3_000


def test_ways_of_several_tasks_keep_apart_within_their_cells(corridor):
    cells = [(0, 0), (0, 1)]
    ways = [{"label": f"task {i}", "goal": (0, 1), "paths": [cells]} for i in range(4)]
    figure = draw_world_map(corridor.shape, corridor.cells, corridor.neighbour, ways)
    heights = [path.get_ydata()[0] for path in _paths(figure)]
    assert len(set(heights)) == 4
    assert max(np.abs(heights)) < 0.4


def test_a_task_without_a_way_shows_its_goal(corridor, tmp_path):
    way = {"label": "task 0", "goal": (0, 3), "paths": []}
    figure = draw_world_map(corridor.shape, corridor.cells, corridor.neighbour, [way])
    assert any(line.get_marker() == "*" for line in figure.axes[0].lines)
    save_figure(figure, tmp_path / "world.png")


@pytest.mark.parametrize("shape", [(60, 3), (20, 20), (3, 90)])
def test_title_and_legend_fit_into_the_picture(shape):
    world = GridWorld.from_free("hall", np.ones(shape, bool))
    ways = [
        {"label": f"task {i}, reached from 100 % of starts", "goal": (0, 0), "paths": []} for i in range(26, 30)
    ]
    title = "second_floor_of_the_old_library.yaml: paths of lore in its last 4 tasks"
    figure = draw_world_map(world.shape, world.cells, world.neighbour, ways, goals=[(0, 1)], cell=0.5, title=title)
    figure.draw_without_rendering()
    for part in (figure.legends[0], figure.texts[0]):
        box = part.get_window_extent()
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1
