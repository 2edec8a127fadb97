"""O3: contexts by hand, and measures of made-up lives."""

import pytest

from reproduction.own.o_03_your_worlds.grids import whole_grid
from reproduction.own.o_03_your_worlds.gymnasium_tasks import MOVES, cliff, taxi_context
from reproduction.own.o_03_your_worlds.run import measure, numbers, readings
from reproduction.own.o_03_your_worlds.worlds import WORLDS


def test_contexts_of_a_taxi_by_hand():
    # Row 0, column 0, passenger at R (0, 0), destination G (0, 4): state ((0·5 + 0)·5 + 0)·4 + 1. Moves are south,
    # north, east and west; the border stops north and west.
    assert taxi_context(1) == (False, 0, 0, (False, True, False, True))
    # Passenger in the taxi (4): the next stop is G, four columns to the east.
    assert taxi_context(4 * 4 + 1) == (True, 0, 1, (False, True, False, True))


def test_a_cliff_is_where_the_context_says():
    env = cliff(5)
    (place, beside), _ = env.reset(seed=0)
    for action, kind in enumerate(beside):
        env.reset(seed=0)
        (there, _), reward, terminated, _, _ = env.step(action)
        row, column = divmod(place, 12)
        moved = 12 * (row + MOVES[action][0]) + column + MOVES[action][1]
        assert (there, reward, terminated) == {
            0: (moved, -1, False), 1: (place, -100, False), 2: (place, -1, False), 3: (moved, -1, True),
        }[kind]  # fmt: skip


def test_state_and_context_of_a_grid():
    env = whole_grid("DoorKey-5x5")
    (x, y, facing, carried, changing), context = env.reset(seed=0)[0]
    base = env.unwrapped
    assert (x, y, facing, carried) == (*base.agent_pos, base.agent_dir, False)
    assert len(changing) == 2  # a key and a closed door
    kinds = {direction: (one.type if one else "free") for direction, one in around(base).items()}
    assert [kind.split()[0] for kind in context[:3]] == [kinds[(facing + turn) % 4] for turn in (0, 3, 1)]
    turned = env.step(base.actions.left)[0]
    assert turned[0] == (x, y, (facing - 1) % 4, carried, changing)
    assert turned[1][0] == context[1]  # what was to the left is in front


def around(base):
    """What lies to the east, south, west and north of the agent of MiniGrid."""
    x, y = base.agent_pos
    return {n: base.grid.get(x + dx, y + dy) for n, (dx, dy) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1)))}


def test_measures_by_hand():
    def life(world, lore, textbook):
        agents = {"lore": lore, "scratch": 0.2, "textbook": textbook}
        return {
            "world": world,
            **{f"{key}_{who}": value for key in ("first", "all", "last") for who, value in agents.items()},
        }

    results = [life("Taxi", lore, 0.4) for lore in (0.5, 0.7, 0.9)]
    results += [life("FourRooms", lore, 0.3) for lore in (0.1, 0.2, 0.25)]
    found = numbers(results, "Taxi")
    assert found["all_over_scratch"].value == pytest.approx(0.5)
    assert found["first_over_textbook"].value == pytest.approx(0.3)
    settings = {"worlds": ["Taxi", "FourRooms"]}
    assert measure(settings, results)["below_last"].value == 1
    assert measure({"worlds": ["Taxi"]}, results)["below_all"].value == 0
    assert [cell["world"] for cell, _ in readings(settings, results)] == ["Taxi", "FourRooms"]
    assert set(settings["worlds"]) <= set(WORLDS)
