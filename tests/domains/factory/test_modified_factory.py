"""Random layouts keep what the thesis says of them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

from lifelore.domains.factory.modified_factory import SIDE, modified_factory

ROWS, COLUMNS = np.indices((SIDE, SIDE))
BETWEEN = ((ROWS % 7 == 0) | (COLUMNS % 7 == 0)) & (ROWS % 21 > 0) & (COLUMNS % 21 > 0)


def zones_of(cells) -> list[tuple[int, int]]:
    return [(int(row) // 7, int(column) // 7) for row, column in cells]


@pytest.mark.slow
@given(st.integers(0, 10**6))
def test_every_layout(seed):
    world = modified_factory(np.random.default_rng(seed))
    free = world.floor.state_of >= 0
    assert free.shape == (22, 22)
    assert not free[[0, -1]].any()
    assert not free[:, [0, -1]].any()
    # Connected; gaps of one cell in 8 to 11 of the 12 walls, none where walls cross.
    assert ndimage.label(free)[1] == 1  # type: ignore[index]
    gaps = np.argwhere(free & BETWEEN)
    assert 8 <= len(gaps) <= 11
    assert not (gaps % 7 == 0).all(axis=1).any()
    across = [(row // 7, column // 7, row % 7 == 0) for row, column in gaps.tolist()]
    assert len(set(across)) == len(gaps)
    # Four zones have points: four in one of a pair, five in the other, all in zones and on different cells.
    zones = {}
    for kind, points, area in (
        ("procure", world.procure_at, world.procure_area),
        ("assemble", world.assemble_at, world.assemble_area),
    ):
        cells = world.floor.cells[points]
        assert not (cells % 7 == 0).any()
        inside = zones_of(cells)
        zones[kind] = set(inside)
        assert sorted(inside.count(zone) for zone in zones[kind]) == [4, 5]
        assert area[points].all()
        assert set(zones_of(world.floor.cells[area])) == zones[kind]
    assert not zones["procure"] & zones["assemble"]
    assert len({*world.procure_at.tolist(), *world.assemble_at.tolist()}) == 18
    assert world.start not in {*world.procure_at.tolist(), *world.assemble_at.tolist()}
    assert not world.express.any()
