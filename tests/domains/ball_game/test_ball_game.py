"""The ball game by hand, against naive twins, and its simulated player."""

from functools import cache

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import SIDE, LossScale, ball_game, check_place, step
from lifelore.domains.ball_game.layouts import Layout, layout_names, s_maze
from lifelore.domains.ball_game.paths import CELL, MARGIN, cost_to_go
from lifelore.domains.ball_game.simulated_player import choose_heading

GAME = ball_game()
FIELD = GAME.field
STAYS = ball_game(blocked="stays").field
NORTH, SOUTH, EAST, WEST = range(4)
NO_SLIP, NO_PUSH = 0.999, (0.0, 0.0)


@cache
def places(kind):
    """Free places of a ball, some of them touching almost."""
    free = np.argwhere(FIELD.clearance > FIELD.radius[kind])
    return st.integers(0, len(free) - 1).map(lambda i: (int(free[i, 1]), int(free[i, 0])))


def test_the_s_maze_by_hand():
    layout = s_maze(160)
    # Walls: under the first corridor from the left, open for 160 at the right; then the other way round.
    assert layout.polygons[0] == ((0, 160), (840, 160), (840, 420), (0, 420))
    assert layout.polygons[1] == ((160, 580), (1000, 580), (1000, 840), (160, 840))
    assert layout.start == (80, 80)
    assert layout.goal == (840, 840, 1000, 1000)
    clearance = FIELD.clearance
    assert clearance[80, 80] == 80  # mid corridor: the border at y = 0 and the wall at y = 160
    assert clearance[160, 500] == 0
    assert clearance[500, 500] == 80
    assert clearance[0, 500] == clearance[500, SIDE] == 0
    assert clearance[120, 869] == pytest.approx(50)  # from the corner (839, 160): a triangle of 30, 40, 50


@pytest.mark.slow
@pytest.mark.parametrize("name", layout_names())
def test_every_layout_can_be_played_by_every_size(name):
    game = ball_game(name)
    for kind in range(game.n_types):
        check_place(game, kind, *game.layout.start)
        x, y = (place // CELL for place in game.layout.start)
        assert np.isfinite(game.field.cost[kind, y, x])


def test_games_that_cannot_be_played():
    with pytest.raises(InputError, match="size 60 and radius 60 cannot get from the start to the goal"):
        ball_game("s-maze 110", 1.0)
    with pytest.raises(InputError, match=r"radius_share must lie in \(0, 1\], got 2"):
        ball_game(radius_share=2.0)
    with pytest.raises(InputError, match="care must be finite"):
        ball_game(care=-1.0)
    with pytest.raises(InputError, match="blocked must be one of slides, stays, got 'bounces'"):
        ball_game(blocked="bounces")
    with pytest.raises(InputError, match="place must be free for a ball of size 60"):
        check_place(GAME, 5, 20, 20)


def test_moves_by_hand():
    # Size 20, radius 10, in mid corridor; no slip, no push (v = 0 makes the normal number 0).
    assert step(FIELD, 3, 500, 80, EAST, 50, 4.0, NO_SLIP, *NO_PUSH) == (550, 80, False, False)
    assert step(FIELD, 3, 500, 80, NORTH, 50, 4.0, NO_SLIP, *NO_PUSH) == (500, 30, False, False)
    # To the border there are 80 units, less the radius and the place that would touch: 69.
    assert step(FIELD, 3, 500, 80, NORTH, 70, 4.0, NO_SLIP, *NO_PUSH) == (500, 11, True, False)
    # A slip (20 / 200 = 10 %): u in thirds of it tells the other way; north slips to south, east, west.
    for u, expected in ((0.01, (500, 110)), (0.05, (530, 80)), (0.09, (470, 80))):
        assert step(FIELD, 3, 500, 80, NORTH, 30, 4.0, u, *NO_PUSH)[:2] == expected
    # A push of one deviation: sqrt(-2 log(1 - v)) = 1 at v = 1 - e^-½; 4 units across the way of the ball.
    one = 1 - np.exp(-0.5)
    assert step(FIELD, 3, 500, 80, EAST, 30, 4.0, NO_SLIP, one, 0.0)[:2] == (530, 84)
    assert step(FIELD, 3, 500, 80, EAST, 30, 4.0, NO_SLIP, one, 0.5)[:2] == (530, 76)
    # Pushed against a wall it stops there, and that is a collision too.
    assert step(FIELD, 3, 500, 12, EAST, 30, 4.0, NO_SLIP, one, 0.5)[:3] == (530, 11, True)


@pytest.mark.slow
def test_a_blocked_ball_that_stays_by_hand():
    # As above: 69 units of room to the north. Of a move of 70 nothing is made, and it is a collision all the same.
    assert step(STAYS, 3, 500, 80, NORTH, 70, 4.0, NO_SLIP, *NO_PUSH) == (500, 80, True, False)
    assert step(STAYS, 3, 500, 80, NORTH, 69, 4.0, NO_SLIP, *NO_PUSH) == (500, 11, False, False)
    # A blocked push is not made, and the move before it is: pushed by 4 units there, with 1 unit of room.
    one = 1 - np.exp(-0.5)
    assert step(STAYS, 3, 500, 12, EAST, 30, 4.0, NO_SLIP, one, 0.5) == (530, 12, True, False)
    # A blocked move leaves the push: 4 units to the east, across the way to the north.
    assert step(STAYS, 3, 500, 80, NORTH, 70, 4.0, NO_SLIP, one, 0.5) == (504, 80, True, False)
    # A slip to the east, where the border at x = 1000 stops it: 1000 less the radius, less 1.
    assert step(STAYS, 3, 950, 80, NORTH, 50, 4.0, 0.05, *NO_PUSH) == (950, 80, True, False)
    assert step(FIELD, 3, 950, 80, NORTH, 50, 4.0, 0.05, *NO_PUSH) == (989, 80, True, False)
    assert step(STAYS, 5, 830, 960, SOUTH, 30, 0.0, NO_SLIP, *NO_PUSH) == (830, 960, True, False)
    # The goal comes before the border that the move would touch: the game is over there.
    below = Layout("below", (), (100, 100), (0, 960, 1000, 1000))
    for blocked in ("slides", "stays"):
        field = ball_game(below, blocked=blocked).field
        assert step(field, 3, 500, 940, SOUTH, 70, 0.0, NO_SLIP, *NO_PUSH) == (500, 989, True, True)


@pytest.mark.slow
@given(st.data())
@settings(deadline=None, max_examples=100)
def test_no_step_ends_in_an_obstacle_and_a_free_one_is_no_collision(data):
    kind = data.draw(st.integers(0, 5))
    x, y = data.draw(places(kind))
    uniform = st.floats(0, 1, exclude_max=True)
    u, v, w = (data.draw(uniform) for _ in range(3))
    heading, speed, sigma = (data.draw(s) for s in (st.integers(0, 3), st.integers(30, 70), st.floats(0.3, 8)))
    x1, y1, hit, _ = step(FIELD, kind, x, y, heading, speed, sigma, u, v, w)
    assert FIELD.clearance[y1, x1] > FIELD.radius[kind]
    if hit:  # something is right beside it
        around = FIELD.clearance[y1 - 1 : y1 + 2, x1 - 1 : x1 + 2]
        assert around.min() <= FIELD.radius[kind] or abs(x1 - x) + abs(y1 - y) > 0
    else:
        assert speed in (abs(x1 - x), abs(y1 - y))


def naive_costs(clearance, radius, goal, care):
    """Dijkstra over a graph of cells, from the cells of the goal."""
    n, half = SIDE // CELL + 1, CELL // 2
    room = np.full((n, n), -1.0)
    for i, j in np.ndindex(n, n):
        y, x = CELL * i, CELL * j
        room[i, j] = clearance[max(0, y - half) : y + half + 1, max(0, x - half) : x + half + 1].max() - radius
    weight = 1 + care * np.clip(1 - room / MARGIN, 0, 1)
    graph = nx.Graph()
    for a in map(tuple, np.argwhere(room > 0)):
        for b in ((a[0] + di, a[1] + dj) for di, dj in ((0, 1), (1, 0), (1, 1), (1, -1))):
            if 0 <= b[0] < n and 0 <= b[1] < n and room[b] > 0:
                graph.add_edge(
                    a, b, weight=CELL * np.hypot(a[0] - b[0], a[1] - b[1]) * (weight[a] + weight[b]) / 2
                )
    left, top, right, bottom = goal
    goals = {(i, j) for i, j in graph if left <= CELL * j <= right and top <= CELL * i <= bottom}
    cost = np.full((n, n), np.inf)
    for cell, length in nx.multi_source_dijkstra_path_length(graph, goals).items():
        cost[cell] = length
    return cost


@pytest.mark.slow
@pytest.mark.parametrize(("name", "radius", "care"), [("blobs", 20.0, 3.0), ("s-maze 130", 30.0, 0.0)])
def test_costs_equal_a_plain_dijkstra(name, radius, care):
    game = ball_game(name)
    found = cost_to_go(game.field.clearance, radius, game.layout.goal, care)
    np.testing.assert_allclose(found, naive_costs(game.field.clearance, radius, game.layout.goal, care), rtol=1e-5)


def test_she_goes_along_the_corridor_and_never_aims_through_a_wall():
    assert choose_heading(FIELD, 3, 300, 80, 50) == EAST
    assert choose_heading(FIELD, 3, 920, 300, 50) == SOUTH
    assert choose_heading(FIELD, 3, 500, 500, 50) == WEST
    # Above a wall of 20 units, with the goal right behind it: a move of 70 would leap over, and the ball cannot.
    thin = Layout("thin", (((0, 500), (900, 500), (900, 520), (0, 520)),), (500, 100), (450, 600, 550, 700))
    field = ball_game(thin, care=0.0).field
    assert choose_heading(field, 0, 500, 480, 70) == EAST
    assert choose_heading(field, 0, 800, 480, 70) == EAST


def test_loss_by_hand():
    assert LossScale().loss([100, 400], [5, 20]).tolist() == [0.5, 2.0]
    scale = LossScale.from_episodes([[50, 80]], [[2, 4]])
    assert (scale.time, scale.hits) == (80, 4)
    assert LossScale.from_episodes([50], [0]).hits == 1
    with pytest.raises(InputError, match="time and hits must be positive"):
        LossScale(0.0, 1.0)
