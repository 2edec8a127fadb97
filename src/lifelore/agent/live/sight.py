"""Lists the places of a building that a lidar sees from each place, for the search by sight."""

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.life_settings import SensorSettings
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
