"""Worlds as data: one definition serves the kernels, exact planning and a Gymnasium environment.

Importing this package registers the environments and little else: what needs the compiler comes in when a
public name is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

import gymnasium

if TYPE_CHECKING:
    from lifelore.domains.buildings.building import building_from_map
    from lifelore.domains.buildings.occupancy_map import OccupancyMap, read_occupancy_map, write_occupancy_map
    from lifelore.domains.buildings.office import office_map
    from lifelore.domains.grid_environment import GridEnvironment
    from lifelore.domains.grids.grid_world import Frame, GridWorld
    from lifelore.domains.task_environment import TaskEnvironment
    from lifelore.domains.worlds import WorldSettings, domain_names, make_world, world_from_settings

__all__ = [
    "ENVIRONMENTS",
    "Frame",
    "GridEnvironment",
    "GridWorld",
    "OccupancyMap",
    "TaskEnvironment",
    "WorldSettings",
    "building_from_map",
    "domain_names",
    "make_world",
    "office_map",
    "read_occupancy_map",
    "world_from_settings",
    "write_occupancy_map",
]

_HOME = {
    "Frame": "grids.grid_world",
    "GridEnvironment": "grid_environment",
    "GridWorld": "grids.grid_world",
    "OccupancyMap": "buildings.occupancy_map",
    "TaskEnvironment": "task_environment",
    "WorldSettings": "worlds",
    "building_from_map": "buildings.building",
    "domain_names": "worlds",
    "make_world": "worlds",
    "office_map": "buildings.office",
    "read_occupancy_map": "buildings.occupancy_map",
    "world_from_settings": "worlds",
    "write_occupancy_map": "buildings.occupancy_map",
}

ENVIRONMENTS = {
    "lifelore/AdviceMaze-v0": ("advice_environment:AdviceMazeEnvironment", 5000),
    "lifelore/BallGame-v0": ("ball_game.environment:BallGameEnvironment", 400),
    "lifelore/Building-v0": ("grid_environment:BuildingEnvironment", 2000),
    "lifelore/Factory-v0": ("factory.environment:FactoryEnvironment", 2000),
    "lifelore/Golf-v0": ("golf.environment:GolfEnvironment", 3),
    "lifelore/Lattice-v0": ("grid_environment:LatticeEnvironment", 1000),
    "lifelore/ModifiedFactory-v0": ("factory.environment:ModifiedFactoryEnvironment", 2000),
    "lifelore/NoiseMaze-v0": ("grid_environment:NoiseMazeEnvironment", 1000),
    "lifelore/Pacman-v0": ("pacman.environment:PacmanEnvironment", 200),
    "lifelore/Surveillance-v0": ("surveillance.environment:SurveillanceEnvironment", 50),
    "lifelore/Telephone-v0": ("telephone.environment:TelephoneEnvironment", 3),
}
"""Registered name → where its class lives in this package, and the steps after which an episode is cut."""


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


for _name, (_place, _max_steps) in ENVIRONMENTS.items():
    if _name not in gymnasium.registry:
        gymnasium.register(_name, entry_point=f"{__name__}.{_place}", max_episode_steps=_max_steps)
