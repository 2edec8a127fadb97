"""Carries what an agent remembers of a building over to a newer map of it, during a life."""

import numpy as np

from lifelore.agent.live import transitions
from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.lore import Lore
from lifelore.core.learning.known_world import UNKNOWN, WorldModel, unknown_world
from lifelore.memory import Memory


def carried_model(old: Lore, place: Place, memory: Memory) -> tuple[WorldModel, float]:
    """The transitions that an agent keeps when its map is replaced, and the share of its cells that agree.

    A cell agrees if its percept in the new map is the remembered one. Transitions of other cells are forgotten,
    except those that memory holds for exactly this map. Nothing is carried to another building.
    """
    world, corner = place.world, place.grid.corner
    n_actions = world.neighbour.shape[1]
    stored = memory.recall(transitions.KIND, world.fingerprint, transitions.VERSION)
    own = transitions.from_record(world, stored, corner)
    if old.grid.frame != place.grid.frame:
        return own, 0.0
    blank = transitions.model_table(old.world, unknown_world(old.world.n_states, n_actions))
    record = transitions.to_record(old.world, transitions.model_table(old.world, old.model), blank, old.grid)
    carried = transitions.from_record(world, record, corner)
    differs = (carried.percept != UNKNOWN) & (carried.percept != world.percepts)
    carried.target[differs], carried.percept[differs] = UNKNOWN, UNKNOWN
    return WorldModel(
        np.where(carried.target == UNKNOWN, own.target, carried.target),
        np.where(carried.percept == UNKNOWN, own.percept, carried.percept),
    ), transitions.agreement(world, record, corner)
