"""Worlds as data: one definition serves the kernels, exact planning and a Gymnasium environment.

Importing this package registers the environments and little else: what needs the compiler comes in when a
public name is first used.
"""

from typing import TYPE_CHECKING

import gymnasium

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.domains.advice.advice_maze import advice_maze as advice_maze
    from lifelore.domains.advice.advice_maze import maze_goals as maze_goals
    from lifelore.domains.buildings.building import building_from_map as building_from_map
    from lifelore.domains.buildings.floor import floor_of as floor_of
    from lifelore.domains.buildings.occupancy_map import OccupancyMap as OccupancyMap
    from lifelore.domains.buildings.occupancy_map import read_occupancy_map as read_occupancy_map
    from lifelore.domains.buildings.occupancy_map import write_occupancy_map as write_occupancy_map
    from lifelore.domains.buildings.office import office_map as office_map
    from lifelore.domains.factory.modified_factory import modified_factory as modified_factory
    from lifelore.domains.golf.golf import Golf as Golf
    from lifelore.domains.grid_environment import GridEnvironment as GridEnvironment
    from lifelore.domains.grids.grid_world import Frame as Frame
    from lifelore.domains.grids.grid_world import GridWorld as GridWorld
    from lifelore.domains.grids.lattice import lattice as lattice
    from lifelore.domains.grids.noise_maze import noise_maze as noise_maze
    from lifelore.domains.pacman.pacman import PacmanMaze as PacmanMaze
    from lifelore.domains.pacman.pacman import PacmanTask as PacmanTask
    from lifelore.domains.surveillance.surveillance import Surveillance as Surveillance
    from lifelore.domains.task_environment import TaskEnvironment as TaskEnvironment
    from lifelore.domains.task_stream import TaskStream as TaskStream
    from lifelore.domains.telephone.telephone import Telephone as Telephone
    from lifelore.domains.worlds import WorldSettings as WorldSettings
    from lifelore.domains.worlds import domain_names as domain_names
    from lifelore.domains.worlds import make_world as make_world
    from lifelore.domains.worlds import world_from_settings as world_from_settings

__all__, __getattr__, __dir__ = lazy_exports(__name__, "ENVIRONMENTS")  # pyright: ignore[reportUnsupportedDunderAll]

ENVIRONMENTS = {
    "lifelore/AdviceMaze-v0": ("grid_environment:AdviceMazeEnvironment", 5000),
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

for _name, (_place, _max_steps) in ENVIRONMENTS.items():
    if _name not in gymnasium.registry:
        gymnasium.register(_name, entry_point=f"{__name__}.{_place}", max_episode_steps=_max_steps)
