"""Joins a lidar's view of a building with the search by sight, and the action prior with its weights."""

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.life_settings import SensorSettings
from lifelore.agent.live.recognition import Place
from lifelore.core.learning.sight_search import UNIT
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.buildings.visibility import visible_places

SightLists = tuple[NDArray[np.int64], NDArray[np.int32]]
"""Begin (n_states + 1,) and states in sight (n_pairs,), as in `SightSearch`."""


def sight_lists(sensor: SensorSettings, place: Place) -> SightLists | None:
    """The places in sight of each place of a building; None without a lidar."""
    if sensor.reach is None:
        return None
    assert place.occupancy is not None, "settings give a lidar in buildings alone"
    visible = visible_places(floor_of(place.occupancy, place.world), place.world, sensor.reach)
    return visible.indptr.astype(np.int64), visible.indices.astype(np.int32)


def move_weights(probs: NDArray[np.float64]) -> NDArray[np.int64]:
    """Weights of places never seen by the move that leads to them, from probabilities (n_contexts, n_actions).

    A move of uniform probability weighs `UNIT`. An action that was often best in its context led to many goals, so
    many places lie behind it.
    """
    return np.maximum(1, np.rint(UNIT * probs.shape[1] * probs)).astype(np.int64)
