"""The settings of a life as JSON data."""

from dataclasses import fields, is_dataclass
from typing import Any

from lifelore.agent.live.life_settings import LIFE_KEYS, LifeSettings
from lifelore.domains.grids.grid_world import GridWorld

_ALWAYS = {"map", "cell", "robot_radius", "start", "density"}
"""Settings that are listed also where they are null."""


def settings_document(settings: LifeSettings, world: GridWorld, location: str) -> dict:
    """All settings in one flat dictionary, with the defaults of the world and the learner filled in."""
    values = _by_key(settings) | {
        "map": None if settings.world.map is None else str(settings.world.map),
        "tasks": settings.n_tasks,
        "memory": location,
        "episodes": settings.episode_cap(world.n_states),
        "max_steps": settings.step_cap,
        "discount": world.discount,
        "goal_reward": world.goal_reward,
        "wall_reward": world.wall_reward,
        "goals": len(settings.goals) or None,
        "busy": settings.in_busy_building if settings.driven else None,
    }
    for switch in ("again", "move_names", "refresh"):
        values[switch] = values[switch] or None
    return {key: value for key, value in values.items() if value is not None or key in _ALWAYS} | world.about


def _by_key(group: Any) -> dict:
    """The fields of settings and of their groups, by key."""
    values = {}
    for one in fields(group):
        value = getattr(group, one.name)
        values |= _by_key(value) if is_dataclass(value) else {LIFE_KEYS.get(one.name, one.name): value}
    return values
