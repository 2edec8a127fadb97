"""Records of moves: the packing by hand, and back."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.agent.travel.passes import KIND, UNIT, from_record, joined, observed, to_record
from lifelore.domains.grids.cell_numbers import BuildingGrid
from lifelore.domains.grids.grid_world import Frame, GridWorld

WORLD = GridWorld.from_free("building", np.ones((3, 4), np.bool_), frame=Frame(0.5))
GRID = BuildingGrid("frame", (0, 0), "house")


def test_a_slot_by_hand():
    # State 1 is row 2 from the bottom, column 1; minute 7; twice passed in e² and e³ seconds, once refused.
    passes = observed(WORLD, [1, 1, 1], [2, 2, 2], [420.0, 421.0, 479.9], [np.exp(2), np.exp(3), np.nan])
    record = to_record(WORLD, GRID, passes)
    slot = ((((2 << 17 | 1) * 4 + 2) << 26) | 7) * 4
    assert (record.kind, record.key, record.merge) == (KIND, "house:500", "add")
    assert record.slots.tolist() == [slot, slot + 1, slot + 2]
    assert record.values.tolist() == [2, round(5 / UNIT), 1]


def test_the_farthest_slot_fits_into_63_bits():
    last = (((((2**16 - 1) << 17 | 2**17 - 1) * 4 + 3) << 26) | 2**26 - 1) * 4 + 3
    assert last == 2**63 - 1


def test_moves_that_the_map_lacks_are_left_out():
    passes = observed(WORLD, [0, 0], [0, 1], [0.0, 0.0], [np.nan, 1.0])  # north of the top row is wall
    assert passes.move.tolist() == [1]


@given(st.lists(st.tuples(st.integers(0, 11), st.integers(0, 3), st.integers(0, 4 * 10**9), st.floats(0.1, 100))))
def test_what_is_stored_comes_back(moves):
    states, actions, clock, seconds = np.array(moves, float).reshape(-1, 4).T
    taken = np.where(np.arange(len(moves)) % 3 == 2, np.nan, seconds)
    passes = observed(WORLD, states, actions, clock, taken)
    back = from_record(WORLD, GRID, to_record(WORLD, GRID, passes))
    assert back.passes.sum() == passes.passes.sum()
    assert back.refusals.sum() == passes.refusals.sum()
    assert back.log_seconds.sum() == pytest.approx(passes.log_seconds.sum(), abs=1e-4)
    assert set(zip(back.move, back.minute, strict=True)) == set(zip(passes.move, passes.minute, strict=True))


def test_no_rows():
    assert not len(joined([]).move)
    assert not len(from_record(WORLD, GRID, None).move)
