"""The drawing of Figure 3.6, and drawings that are refused."""

import numpy as np
import pytest
from scipy import ndimage

from lifelore.core.errors import InputError
from lifelore.domains.factory.layout import PLAN, factory


def test_what_the_thesis_names_is_there():
    world = factory()
    assert (world.n_components, world.floor.discount, world.floor.shape) == (9, 0.99, (20, 20))
    assert len({*world.procure_at.tolist(), *world.assemble_at.tolist()}) == 18
    assert world.express.sum() == PLAN.count("+") + 1
    # Everything can be reached, and the regions lie apart.
    assert ndimage.label(world.floor.state_of >= 0)[1] == 1  # type: ignore[index]
    assert not (world.procure_area & world.assemble_area).any()
    assert world.procure_area[world.procure_at].all()
    assert world.assemble_area[world.assemble_at].all()
    assert not world.procure_area[world.start]
    procure, assemble = (world.floor.cells[area] for area in (world.procure_area, world.assemble_area))
    assert abs(procure[:, None] - assemble).sum(axis=2).min() > 10


def test_signs_are_read_where_they_stand():
    world = factory("######\n#1S+b#\n#a..2#\n######")
    cells = world.floor.cells.tolist()
    assert [cells[i] for i in world.procure_at] == [[1, 1], [2, 4]]
    assert [cells[i] for i in world.assemble_at] == [[2, 1], [1, 4]]
    assert [cells[i] for i in np.flatnonzero(world.express)] == [[1, 2], [1, 3]]
    assert cells[world.start] == [1, 2]


@pytest.mark.parametrize(
    ("plan", "message"),
    [
        ("#####\n#S1a#\n####", "rows of one length"),
        ("#####\n#.1a#\n#####", "one start 'S', got 0"),
        ("######\n#SS1a#\n######", "one start 'S', got 2"),
        ("#####\n#S.a#\n#####", "each of '123456789' once"),
        ("######\n#S11a#\n######", "each of '123456789' once"),
        ("######\n#S13a#\n######", "each of '123456789' once"),
        ("######\n#S12a#\n######", "must be of one length, got 2 and 1"),
    ],
)
def test_drawings_refused(plan, message):
    with pytest.raises(InputError, match=message):
        factory(plan)
