"""The ideal hand: what it may pick up, where objects end, and what is true after; and the puzzles of blocks."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, ON
from lifelore.domains.tabletop import pick_and_place
from lifelore.domains.tabletop.block_puzzle import HIGHEST, BlockPuzzle, block_puzzle
from lifelore.domains.tabletop.layout import stand, top
from lifelore.domains.tabletop.photograph import FIRST_OBJECT
from lifelore.domains.tabletop.pick_and_place import CLEAR, COVERED, FELL, NO_ROOM, ON_TABLE, PickAndPlace
from lifelore.domains.tabletop.shapes import box

pytest.importorskip("mujoco")
CUBE = box(0.06, 0.06, 0.06)


@pytest.fixture
def hand() -> PickAndPlace:
    """Block 1 on block 0, and block 2 apart."""
    base = stand(CUBE)
    group = [base, stand(CUBE, height=top([base])), stand(CUBE).moved(0.2, 0.0)]
    return PickAndPlace(group, np.random.default_rng(0))


def test_what_is_true_of_a_tower(hand):
    assert hand.holds(ON, 1, 0)
    assert not hand.holds(ON, 0, 1)
    assert hand.holds(ON_TABLE, 0)
    assert not hand.holds(ON_TABLE, 1)
    assert [hand.holds(CLEAR, block) for block in range(3)] == [False, True, True]
    assert not hand.holds(ADJACENT, 0, 2)
    assert hand.resting_on(0) == (1,)
    with pytest.raises(InputError, match="relation must be on, on-table"):
        hand.holds("left of", 0, 1)


def test_a_covered_block_is_not_picked_up(hand):
    assert hand.pick_up(0) == COVERED
    assert hand.held is None
    assert hand.pick_up(1) is None
    assert hand.held == 1
    assert not hand.holds(ON, 1, 0)
    assert hand.holds(CLEAR, 0)


def test_blocks_go_where_they_are_put(hand):
    assert hand.pick_up(1) is None
    assert hand.put_on(1, 2) is None
    assert hand.holds(ON, 1, 2)
    assert hand.holds(CLEAR, 0)
    # At rest on the middle of the lower block, but for what the hand misses.
    across, height = hand.poses[1].position - hand.poses[2].position, 0.06
    assert np.hypot(*across[:2]) < 5 * pick_and_place.MISS
    assert across[2] == pytest.approx(height, abs=1e-3)
    assert hand.pick_up(1) is None
    assert hand.put_beside(1, 0) is None
    assert hand.holds(ADJACENT, 1, 0)
    assert hand.holds(ON_TABLE, 1)
    assert hand.pick_up(1) is None
    assert hand.put_on_table(1) is None
    assert hand.holds(ON_TABLE, 1)
    assert not any(hand.holds(ADJACENT, 1, other) for other in (0, 2))


def test_a_block_is_put_beside_a_tower(hand):
    # The upper block stands over the lower one and reaches over its edge.
    hand.poses[1] = hand.poses[1].moved(np.array([0.01, 0.0, 0.0]))
    assert hand.pick_up(2) is None
    assert hand.put_beside(2, 0) is None
    assert hand.holds(ADJACENT, 2, 0)
    assert hand.holds(ON, 1, 0)


def test_a_block_that_misses_the_other_falls(hand, monkeypatch):
    # More than half of the block hangs in the air.
    monkeypatch.setattr(hand, "_missed", lambda place: (place[0] + 0.035, place[1]))
    hand.pick_up(1)
    assert hand.put_on(1, 2) == FELL


def test_a_full_table_has_no_room(hand, monkeypatch):
    monkeypatch.setattr(pick_and_place, "ROOM", 2.0)
    monkeypatch.setattr(pick_and_place, "BESIDE", 2.0)
    hand.pick_up(1)
    assert hand.put_on_table(1) == NO_ROOM
    assert hand.put_beside(1, 0) == NO_ROOM


def test_blocks_that_fall_at_the_start_are_refused():
    group = [stand(CUBE), stand(CUBE, height=0.5)]
    with pytest.raises(InputError, match="must stay where they start"):
        PickAndPlace(group, np.random.default_rng(0))


def test_the_camera_sees_the_blocks_that_are_not_held(hand):
    whole = hand.photograph(np.random.default_rng(1))
    assert whole is not None
    assert set(np.unique(whole.cloud.labels)) == {TABLE, *range(FIRST_OBJECT, FIRST_OBJECT + 3)}
    # From half-way around the table, the same blocks stand on the other side.
    turned = hand.photograph(np.random.default_rng(1), yaw=np.pi)
    assert turned is not None
    middle = [photo.cloud.points[photo.cloud.labels == 4].mean(axis=0) for photo in (whole, turned)]
    assert middle[0][0] == pytest.approx(-middle[1][0], abs=0.03)


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 2**32 - 1))
def test_a_puzzle_has_each_block_once_and_something_to_do(seed):
    puzzle = block_puzzle(np.random.default_rng(seed))
    n = len(puzzle.cubes)
    for towers in (puzzle.start, puzzle.goal):
        assert sorted(block for tower in towers for block in tower) == list(range(n))
        assert max(map(len, towers)) <= HIGHEST
    already = BlockPuzzle(puzzle.cubes, puzzle.start, puzzle.start, None).wishes()
    assert len(set(puzzle.wishes()) - set(already)) >= 2
    assert len([wish for wish in puzzle.wishes() if wish[0] != ADJACENT]) == n


def test_puzzles_stand_as_they_say():
    for seed in range(3):
        drawn = np.random.default_rng(seed)
        puzzle = block_puzzle(drawn)
        hand = PickAndPlace(puzzle.placed(drawn), drawn)
        begun = BlockPuzzle(puzzle.cubes, puzzle.start, puzzle.start, None)
        assert all(hand.holds(relation, *blocks) for relation, blocks in begun.wishes())
        assert not all(hand.holds(relation, *blocks) for relation, blocks in puzzle.wishes())
