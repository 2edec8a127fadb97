"""Ways on a plan: each starts and ends where it should, and tasks do not hide each other."""

import numpy as np
import pytest

from lifelore.domains.grids.grid_world import GridWorld
from lifelore.figures.lives.floor_plan import FloorPlan
from lifelore.figures.lives.map_plan import MapPlan
from lifelore.figures.lives.world_map import draw_world_map
from lifelore.figures.style import save_figure


def plan_of(free) -> FloorPlan:
    world = GridWorld.from_free("hall", free)
    return FloorPlan(world.shape, world.cells, world.neighbour)


@pytest.fixture
def corridor() -> FloorPlan:
    return plan_of(np.ones((1, 4), bool))


def _paths(figure) -> list:
    return [line for line in figure.axes[0].lines if len(line.get_xdata()) > 1 and line.get_linestyle() == "-"]


def test_a_way_leads_from_start_to_goal(corridor, tmp_path):
    line = [(0.5, 0.5), (1.5, 0.5), (2.5, 0.5), (3.5, 0.5)]
    way = {"label": "task 0", "goal": (3.5, 0.5), "paths": [line]}
    figure = draw_world_map(corridor, [way], goals=[(1.5, 0.5)])
    (path,) = _paths(figure)
    assert (path.get_xdata().tolist(), path.get_ydata().tolist()) == ([0, 1, 2, 3], [0, 0, 0, 0])
    star = next(line for line in figure.axes[0].lines if line.get_marker() == "*")
    assert (star.get_xdata()[0], star.get_ydata()[0]) == (3, 0)
    assert save_figure(figure, tmp_path / "world.png").stat().st_size > 3_000


def test_ways_over_a_map_are_drawn_at_their_metres():
    """Ways of two tasks along one line: over a map no way moves aside, for it would run through a wall."""
    plan = MapPlan(np.full((20, 40), 254, np.uint8), 0.05, (-3.0, 1.0, 0.0))
    line = [(-2.5, 1.5), (-1.5, 1.8)]
    ways = [{"label": f"task {i}", "goal": (-1.5, 1.8), "paths": [line]} for i in range(2)]
    figure = draw_world_map(plan, ways)
    for path in _paths(figure):
        np.testing.assert_allclose(np.column_stack(path.get_data()), line)


def test_ways_of_several_tasks_keep_apart_within_their_cells(corridor):
    line = [(0.5, 0.5), (1.5, 0.5)]
    ways = [{"label": f"task {i}", "goal": (1.5, 0.5), "paths": [line]} for i in range(4)]
    heights = [path.get_ydata()[0] for path in _paths(draw_world_map(corridor, ways))]
    assert len(set(heights)) == 4
    assert max(np.abs(heights)) < 0.4


def test_a_task_without_a_way_shows_its_goal(corridor, tmp_path):
    figure = draw_world_map(corridor, [{"label": "task 0", "goal": (3.5, 0.5), "paths": []}])
    assert any(line.get_marker() == "*" for line in figure.axes[0].lines)
    save_figure(figure, tmp_path / "world.png")


@pytest.mark.parametrize(("shape", "over_map"), [((60, 3), True), ((20, 20), False), ((3, 90), False)])
def test_title_and_legend_fit_into_the_picture(shape, over_map):
    plan = MapPlan(np.full(shape, 254, np.uint8), 0.5, (0, 0, 0)) if over_map else plan_of(np.ones(shape, bool))
    ways = [
        {"label": f"task {i}, reached from 100 % of starts", "goal": (0, 0), "paths": []} for i in range(26, 30)
    ]
    title = "second_floor_of_the_old_library.yaml: paths of lore in its last 4 tasks"
    figure = draw_world_map(plan, ways, goals=[(0, 1)], title=title)
    figure.draw_without_rendering()
    for part in (figure.legends[0], figure.texts[0]):
        box = part.get_window_extent()
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1
