"""O3: contexts by hand, and measures of made-up lives."""

import pytest

from reproduction.own.o_03_your_worlds.run import CONSTANT, FALLING, numbers, readings
from reproduction.own.o_03_your_worlds.worlds import WORLDS, cart_pole, slippery_lake, taxi_context, whole_grid


def test_contexts_of_a_taxi_by_hand():
    # Row 0, column 0, passenger at R (0, 0), destination G (0, 4): state ((0·5 + 0)·5 + 0)·4 + 1. Moves are south,
    # north, east and west; the border stops north and west.
    assert taxi_context(1) == (False, 0, 0, (False, True, False, True))
    # Passenger in the taxi (4): the next stop is G, four columns to the east.
    assert taxi_context(4 * 4 + 1) == (True, 0, 1, (False, True, False, True))


def test_tasks_differ_and_repeat():
    lakes = [slippery_lake(number).unwrapped.desc.tobytes() for number in (0, 0, 1)]
    assert lakes[0] == lakes[1] != lakes[2]
    lengths = [cart_pole(number).unwrapped.length for number in (3, 3, 4)]
    assert lengths[0] == lengths[1] != lengths[2]


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
    def life(world, epsilon, lore, scratch):
        returns = {
            f"{key}_{who}": value
            for key in ("first", "all")
            for who, value in (("lore", lore), ("scratch", scratch))
        }
        return {"world": world, "epsilon": epsilon, **returns}

    results = [life("Taxi", FALLING, lore, 0.2) for lore in (0.5, 0.7)]
    results += [life("Taxi", CONSTANT, 0.5, 0.4), life("Taxi", CONSTANT, 0.5, 0.4)]
    results += [life("FourRooms", FALLING, 0.2, 0.2), life("FourRooms", CONSTANT, 0.2, 0.1)]
    found = numbers(results, "Taxi", FALLING)
    assert found["all_gain"].value == pytest.approx(0.4)
    assert found["first_gain"].value == pytest.approx(0.4)
    assert found["all_gain_over_constant"].value == pytest.approx(0.2)
    assert numbers(results, "Taxi", CONSTANT)["all_gain"].value == pytest.approx(0.1)
    settings = {"worlds": ["Taxi", "FourRooms"]}
    assert [cell["world"] for cell, _ in readings(settings, results)] == ["Taxi", "Taxi", "FourRooms", "FourRooms"]
    assert set(settings["worlds"]) <= set(WORLDS)
