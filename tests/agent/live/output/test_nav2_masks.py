"""Masks worked by hand, on the grid of the user's own map, and read back as nav2 reads them."""

import csv
import math

import numpy as np
import pytest

from lifelore.agent.live.output.nav2_masks import (
    KEEP_OUT,
    MOST_COST,
    NO_OPINION,
    body_space,
    cost_mask,
    keepout_mask,
    on_map,
    place_costs,
    write_directions,
    write_masks,
)
from lifelore.core.learning.known_world import WorldModel, unknown_world
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.floor import Floor, floor_of
from lifelore.domains.buildings.occupancy_map import FREE, OccupancyMap, read_occupancy_map
from lifelore.domains.grids.grid_world import Frame, GridWorld

NORTH, SOUTH, EAST, WEST = range(4)


@pytest.fixture
def corridor() -> GridWorld:
    return GridWorld.from_free("corridor", np.ones((1, 4), bool), frame=Frame(0.5, (10.0, 20.0, math.pi / 2)))


def seen(world: GridWorld) -> WorldModel:
    """A model in which all moves east and west are known, also the two refused ones at the ends."""
    model = unknown_world(world.n_states, 4)
    model.target[:, [EAST, WEST]] = world.neighbour[:, [EAST, WEST]]
    model.target[0, WEST], model.target[3, EAST] = 0, 3
    model.percept[:] = world.percepts
    return model


def test_bumps_cost_by_their_share_of_the_tried_moves(corridor):
    # In both end places, one of two tried moves was refused: 100 · 0.5 · 1/2.
    assert place_costs(corridor, seen(corridor), None).tolist() == [25, 0, 0, 25]


def test_places_into_which_the_prior_seldom_leads_cost_more(corridor):
    probs = np.zeros((4, 4))
    probs[:, EAST], probs[:, WEST] = 0.75, 0.25
    # Into place 0 leads 0.25 (from 1); into 1: 0.75 + 0.25; into 2 likewise; into 3: 0.75.
    model = seen(corridor)
    model.target[0, WEST] = model.target[3, EAST] = -1
    assert place_costs(corridor, model, probs).tolist() == [38, 0, 0, 12]  # 100 · 0.5 · 0.75, and · 0.25 (rounded)


def test_a_refused_move_that_the_map_allows_costs_most_on_both_sides(corridor):
    model = seen(corridor)
    model.target[1, EAST] = 1
    assert place_costs(corridor, model, None).tolist() == [25, MOST_COST, MOST_COST, 25]


def test_places_never_visited_have_no_cost(corridor):
    model = seen(corridor)
    model.percept[2] = -1
    assert place_costs(corridor, model, None).tolist() == [25, 0, NO_OPINION, 25]


def room(origin=(0.0, 0.0, 0.0)) -> tuple[OccupancyMap, GridWorld, Floor]:
    """A room of 3 x 2 m within a wall of one pixel of 0.1 m."""
    state = np.ones((22, 32), np.uint8)
    state[1:-1, 1:-1] = FREE
    occupancy = OccupancyMap(state, 0.1, origin)
    world = building_from_map(occupancy, 0.5, 0.2)
    return occupancy, world, floor_of(occupancy, world)


def test_the_body_of_a_robot_in_known_places_stays_off_walls():
    occupancy, world, floor = room()
    space = body_space(floor, np.ones(world.n_states, bool))
    # Centres are free from the third pixel off the wall on. A body of two pixels reaches the pixel beside the
    # wall, but not the corner: its distance from the nearest centre is √8 pixels.
    assert space[1, 3:-3].all()
    assert not space[1, 1]
    assert not (space & (occupancy.state != FREE)).any()


def test_masks_of_a_half_known_room():
    occupancy, world, floor = room()
    x = world.positions(np.arange(world.n_states))[:, 0]
    known = x < 1.5
    keepout = keepout_mask(floor, known)
    assert set(np.unique(keepout)) == {0, KEEP_OUT}
    assert keepout[10, 12] == 0
    assert keepout[10, 16] == 0  # the robot's body at 1.45 m reaches to 1.65 m
    assert keepout[10, 17] == KEEP_OUT
    costs = cost_mask(floor, np.where(known, 7, NO_OPINION).astype(np.uint8))
    assert costs[10, 12] == 7
    assert costs[10, 20] == costs[0, 5] == NO_OPINION
    assert ((costs == 7) <= (occupancy.state == FREE)).all()


def test_a_mask_is_laid_on_the_users_own_map():
    """The floor lies on a grid turned by a quarter; the same places are meant."""
    turned, world, floor = room((5.0, 1.0, math.pi / 2))
    mask = np.where(floor.state >= 0, 3, 9).astype(np.uint8)
    # The user's map of the same ground: 22 pixels wide, 32 high, lower left corner at (5 - 2.2, 1).
    own = OccupancyMap(np.rot90(turned.state).copy(), 0.1, (5.0 - 2.2, 1.0, 0.0))
    assert np.array_equal(on_map(mask, floor, own, 1), np.rot90(mask))
    wide = OccupancyMap(np.zeros((34, 22), np.uint8), 0.1, (5.0 - 2.2, 1.0, 0.0))
    assert np.array_equal(on_map(mask, floor, wide, 1), np.vstack([np.full((2, 22), 1), np.rot90(mask)]))
    assert world.n_states > 0


def test_masks_are_written_in_the_scale_of_nav2(tmp_path):
    occupancy, world, floor = room((-1.0, 2.0, 0.0))
    model = unknown_world(world.n_states, 4)
    model.percept[:] = world.percepts
    write_masks(tmp_path, world, model, None, floor, occupancy)
    keepout = read_occupancy_map(tmp_path / "keepout.yaml")
    assert (keepout.state.shape, keepout.resolution, keepout.origin) == ((22, 32), 0.1, (-1.0, 2.0, 0.0))
    assert np.array_equal(keepout.state == FREE, body_space(floor, np.ones(world.n_states, bool)))
    text = (tmp_path / "costs.yaml").read_text(encoding="utf-8")
    assert text.startswith("# Cost of driving here")
    assert "mode: raw" in text
    header, pixels = (tmp_path / "costs.pgm").read_bytes().split(b"\n255\n", 1)
    assert header == b"P5\n32 22"
    assert set(pixels) == {0, NO_OPINION}


def test_directions_turn_with_the_map(corridor, tmp_path):
    probs = np.array([[0.1, 0.2, 0.3, 0.4]] * 4)
    write_directions(tmp_path / "d.csv", corridor, probs, np.array([False, True, False, False]), None)
    with (tmp_path / "d.csv").open(newline="", encoding="utf-8") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    # The map is turned a quarter to the left: its north points to -x, its east to +y.
    assert [(row["dx"], row["dy"], row["probability"]) for row in rows] == [
        (-1, 0, 0.1), (1, 0, 0.2), (0, 1, 0.3), (0, -1, 0.4)
    ]  # fmt: skip
    assert {(row["x"], row["y"]) for row in rows} == {(9.75, 20.75)}
    assert "-0.0000" not in (tmp_path / "d.csv").read_text()
