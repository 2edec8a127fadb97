"""A learnt model as a record and back, by cells."""

import numpy as np

from lifelore.agent.live.transitions import (
    agreement,
    cells_of,
    forget_contradicted,
    frame_key,
    from_record,
    model_table,
    to_record,
)
from lifelore.core.learning.known_world import UNKNOWN, unknown_world
from lifelore.domains.grids.grid_world import GridWorld


def world(picture: str) -> GridWorld:
    return GridWorld.from_free("floor", np.array([[mark == "." for mark in row] for row in picture.split()]))


def knowing(floor: GridWorld):
    """A model that knows every move and percept of `floor`."""
    own = np.arange(floor.n_states)[:, None]
    target = np.where(floor.neighbour < 0, own, floor.neighbour).astype(np.int32)
    return unknown_world(floor.n_states, 4)._replace(target=target, percept=floor.percepts.copy())


def record_of(floor: GridWorld, model):
    return to_record(floor, model_table(floor, model), model_table(floor, unknown_world(floor.n_states, 4)))


def test_slots_and_values_by_hand():
    floor = world("..#\n...")
    model = unknown_world(floor.n_states, 4)
    model.target[0, 2] = 1  # from cell 0 east to cell 1
    model.target[1, 1] = 3  # from cell 1 south to the middle of the lower row, which is state 3
    model.percept[3] = 77
    record = record_of(floor, model)
    # slot = cell * 5 + action, the percept being action 4; the upper row is row 1 from the bottom
    upper = 1 << 20
    assert record.slots.tolist() == [1 * 5 + 4, upper * 5 + 2, (upper + 1) * 5 + 1]
    assert record.values.tolist() == [77, upper + 1, 1]
    assert (record.merge, record.key) == ("newest", floor.fingerprint)


def test_round_trip():
    floor = world(".#.\n...\n##.")
    model = knowing(floor)
    back = from_record(floor, record_of(floor, model))
    assert np.array_equal(back.target, model.target)
    assert np.array_equal(back.percept, model.percept)


def test_only_news_are_recorded_and_forgetting_is_news():
    floor = world("...")
    model = knowing(floor)
    before = model_table(floor, model)
    assert len(to_record(floor, before, before).slots) == 0
    model.target[1, 2] = UNKNOWN
    news = to_record(floor, model_table(floor, model), before)
    assert (news.slots.tolist(), news.values.tolist()) == ([1 * 5 + 2], [UNKNOWN])


def test_a_changed_floor_numbers_states_anew_and_keeps_cells():
    old, new = world("...\n..."), world(".#.\n...")
    back = from_record(new, record_of(old, knowing(old)))
    south_west = new.state_of[1, 0]
    assert new.state_of[1, 1] == back.target[south_west, 2]  # still east of it
    assert back.target[new.state_of[0, 0], 2] == UNKNOWN  # led to a cell that is gone
    assert back.percept[new.state_of[0, 0]] == old.percepts[0]  # what was seen there, for the learner to doubt


def test_agreement_is_the_share_of_cells_that_show_the_same():
    old, new = world("....\n...."), world("....\n...#")
    # The corner is gone; its west, north-west and north neighbours see it occupied: 4 of 8 differ.
    assert agreement(new, record_of(old, knowing(old))) == 0.5
    assert agreement(old, record_of(old, knowing(old))) == 1.0
    assert cells_of(new).tolist() == [(1 << 20) + column for column in range(4)] + [0, 1, 2]


def test_a_picture_that_has_grown_is_the_same_place():
    old, new = world("..\n.."), world("....\n..##\n..##")  # a row above and two columns to the right
    assert frame_key(old) == frame_key(new)
    back = from_record(new, record_of(old, knowing(old)))
    corner = new.state_of[2, 0]  # the lower left corner is where it was
    assert back.percept[corner] == old.percepts[old.state_of[1, 0]]
    assert back.target[corner, 0] == new.state_of[1, 0]


def test_moves_of_a_robot_of_another_radius_hold_where_the_map_has_them():
    """A thin robot passes the gap in the middle, a wide one does not; each learns from the other."""
    thin, wide = world(".....\n.#.#.\n....."), world(".....\n.#.#.\n..#..")

    def there(floor):
        return np.where(floor.neighbour < 0, np.arange(floor.n_states)[:, None], floor.neighbour)

    def unknown(own, other):
        model = from_record(own, record_of(other, knowing(other)))
        forget_contradicted(own, model)
        known = model.target != UNKNOWN
        assert (model.target == there(own))[known].all()
        return {(int(state), int(move)) for state, move in np.argwhere(~known)}

    gap = int(thin.state_of[2, 2])
    around = [((2, 1), 2), ((2, 3), 3), ((1, 2), 1)]  # cells beside the gap, and the move into it
    into = {(int(thin.state_of[cell]), move) for cell, move in around}
    assert unknown(thin, wide) == into | {(gap, move) for move in range(4)}
    assert unknown(wide, thin) == {(int(wide.state_of[cell]), move) for cell, move in around}


def test_a_refused_move_holds_for_another_radius_where_the_surroundings_are_the_same():
    floor = world(".....")
    model = knowing(floor)
    model.target[1, 2] = 1  # something that the map does not show
    forget_contradicted(floor, model)
    assert model.target[1, 2] == 1
    model.percept[1] += 1
    forget_contradicted(floor, model)
    assert model.target[1].tolist() == [1, 1, UNKNOWN, 0]
