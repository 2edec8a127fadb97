"""Features and codes of states, by hand on a small factory, and across tasks."""

import numpy as np
import pytest

from lifelore.core.errors import NotFoundError
from lifelore.domains.factory.contexts import (
    ENCODINGS,
    FEATURE_NAMES,
    FEATURE_SIZES,
    NOTHING_LEFT,
    PHI,
    TO_ASSEMBLE,
    TO_PROCURE,
    configuration_codes,
    feature_codes,
    features,
    items_flag,
    state_contexts,
)
from lifelore.domains.factory.layout import factory
from lifelore.domains.factory.modified_factory import modified_factory

SMALL = """
######
#1S+b#
#a#.2#
######
"""


def test_features_by_hand():
    world = factory(SMALL)
    table = features(world.task([0, 1]))
    assert table.shape == (9 * 7, 10)
    # Seen from the + : above walls, beside it S and b, below a wall, a free cell and a procurement point.
    plus = int(world.floor.state_of[1, 3])
    assert table[plus].tolist() == [1, 1, 1, 0, 0, 3, 1, 0, 2, TO_PROCURE]
    # Both procured (configuration 1 + 3): the same cells, another flag; one assembled beside: the same flag.
    assert table[4 * 7 + plus].tolist() == [*table[plus, :9].tolist(), TO_ASSEMBLE]
    assert table[5 * 7 + plus, 9] == TO_ASSEMBLE
    assert table[8 * 7 + plus, 9] == NOTHING_LEFT
    assert (table >= 0).all()
    assert (table < FEATURE_SIZES).all()


def test_the_flag_by_hand():
    flags = items_flag(factory().task([3, 6])).reshape(3, 3)  # second item by first
    assert flags.tolist() == [[0, 0, 0], [0, 1, 1], [0, 1, 2]]
    assert set(items_flag(factory().task([3, 6]), [4, 8]).tolist()) == {TO_ASSEMBLE, NOTHING_LEFT}


@pytest.mark.parametrize("names", [*PHI, ("Items",), ("PosMR", "PosML")])
def test_codes_tell_exactly_what_the_columns_tell(names):
    table = features(modified_factory(np.random.default_rng(0)).task([0, 5]))
    chosen = PHI.get(names, names)
    rows = table[:, [FEATURE_NAMES.index(name) for name in chosen]].astype(int)
    codes = feature_codes(table, names)
    sizes = [FEATURE_SIZES[FEATURE_NAMES.index(name)] for name in chosen]
    assert np.array_equal(codes, np.ravel_multi_index(tuple(rows.T), sizes))


def test_unknown_names_are_told():
    table = features(factory(SMALL).task([0]))
    for wrong in ("phi5", ("PosUL", "Weather"), ()):
        with pytest.raises(NotFoundError, match="phi1, phi2"):
            feature_codes(table, wrong)
    with pytest.raises(NotFoundError, match="encoding must be one of global, left, listed, phase"):
        configuration_codes(factory(SMALL).task([0]), "local")


def test_encodings_by_hand():
    task = factory().task([2, 5])
    # Configuration 1: component 2 procured, 5 raw. Configuration 5: 2 assembled, 5 procured.
    one, five = 1, 2 + 3
    codes = {name: configuration_codes(task, name)[[0, one, five]].tolist() for name in ENCODINGS}
    assert codes == {
        "global": [0, 3**2, 2 * 3**2 + 3**5],
        "left": [2 * 3**2 + 2 * 3**5, 3**2 + 2 * 3**5, 3**5],
        "listed": [0, 1, 5],
        "phase": [TO_PROCURE, TO_PROCURE, TO_ASSEMBLE],
    }
    assert configuration_codes(task, "global", [five]).tolist() == codes["global"][2:]


def test_places_of_two_layouts_agree():
    one, other = (modified_factory(np.random.default_rng(seed)) for seed in (0, 1))
    at = {
        tuple(cell): int(code)
        for world in (one, other)
        for cell, code in zip(
            world.floor.cells.tolist(), state_contexts(world.task([0]), "global", [0]), strict=True
        )
    }
    for world in (one, other):
        codes = state_contexts(world.task([0]), "global", [0]).tolist()
        assert codes == [at[tuple(cell)] for cell in world.floor.cells.tolist()]
