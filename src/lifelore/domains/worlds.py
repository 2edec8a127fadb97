"""The worlds by name: settings as data in, a grid world out."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.domains.advice.advice_maze import advice_maze
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.occupancy_map import OccupancyMap, read_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze


@dataclass(frozen=True)
class WorldSettings:
    """Settings of a world; None is the default of the domain.

    Parameters
    ----------
    domain : str
        One of `domain_names()`.
    map : str or Path, optional
        YAML of a ROS map, for ``building``; without it an invented office of this `seed`.
    cell : float, optional
        Side of a grid cell in metres, for ``building``; 0.5.
    robot_radius : float, optional
        Radius of the robot in metres, for ``building``; 0.2.
    min_free : float, optional
        Least share of a cell that must be free, for ``building``; 0.25. See `building_from_map`.
    discount : float, optional
        Discount γ, in (0, 1); 0.99 in buildings, else 0.95.
    goal_reward : float, optional
        Reward at the goal, > 0; 100, in ``advice`` 1000.
    wall_reward : float, optional
        Reward of a move into a wall, ≤ 0; -10, in ``advice`` 0.
    seed : int
        Draws the office, the noise maze or the advice maze.
    density : float, optional
        Share of obstacles, for ``noise``, in (0, 1); drawn from 0.5–0.8.
    size : int, optional
        Number of cells a side, for ``lattice`` and ``noise``, 23, and ``advice``, 30.
    loops : float, optional
        Share of the walls between corridors that are opened, for ``advice``; 0.1. See `advice_maze`.

    Examples
    --------
    >>> WorldSettings("noise", size=9, seed=1).domain
    'noise'
    """

    domain: str = "building"
    map: str | Path | None = None
    cell: float | None = None
    robot_radius: float | None = None
    min_free: float | None = None
    discount: float | None = None
    goal_reward: float | None = None
    wall_reward: float | None = None
    seed: int = 0
    density: float | None = None
    size: int | None = None
    loops: float | None = None


_REWARDS = ("discount", "goal_reward", "wall_reward")


def map_from_settings(settings: WorldSettings) -> OccupancyMap:
    """The map of a ``building``: the one that the settings name, else a generated office of their seed."""
    return office_map(settings.seed) if settings.map is None else read_occupancy_map(settings.map)


def _building(settings: WorldSettings, occupancy: OccupancyMap | None = None, **options) -> GridWorld:
    options.pop("map", None)
    return building_from_map(occupancy or map_from_settings(settings), **options)


def _lattice(settings: WorldSettings, **options) -> GridWorld:
    return lattice(**options)


def _noise(settings: WorldSettings, **options) -> GridWorld:
    return noise_maze(stream(settings.seed, "noise maze"), **options)


def _advice(settings: WorldSettings, **options) -> GridWorld:
    return advice_maze(stream(settings.seed, "advice maze"), **options)


_WORLDS: dict[str, tuple[Callable[..., GridWorld], tuple[str, ...]]] = {
    "building": (_building, ("map", "cell", "robot_radius", "min_free", *_REWARDS)),
    "lattice": (_lattice, ("size", *_REWARDS)),
    "noise": (_noise, ("density", "size", *_REWARDS)),
    "advice": (_advice, ("loops", "size", *_REWARDS)),
}
"""Name → constructor and the settings it takes."""


def domain_names() -> tuple[str, ...]:
    """Names of the domains of `make_world`.

    Examples
    --------
    >>> "lattice" in domain_names()
    True
    """
    return tuple(_WORLDS)


def world_from_settings(settings: WorldSettings, occupancy: OccupancyMap | None = None) -> GridWorld:
    """The world that `settings` describe; the same settings give the same world.

    Parameters
    ----------
    settings : WorldSettings
    occupancy : OccupancyMap, optional
        For ``building``: the map in place of the one that the settings name.

    Raises
    ------
    NotFoundError
        No domain has this name.
    InputError
        A setting is given that the domain has no use for, or one breaks its rule.

    Examples
    --------
    >>> world_from_settings(WorldSettings("lattice", size=9)).n_states
    40
    """
    if settings.domain not in _WORLDS:
        raise NotFoundError(f"domain must be one of {', '.join(_WORLDS)}, got {settings.domain!r}")
    construct, takes = _WORLDS[settings.domain]
    options = {
        field.name: getattr(settings, field.name)
        for field in fields(settings)
        if field.name not in ("domain", "seed") and getattr(settings, field.name) is not None
    }
    unused = [name for name in options if name not in takes]
    if unused:
        raise InputError(
            f"{unused[0]} does not apply to domain {settings.domain!r}, got {options[unused[0]]!r}; leave it out "
            f"(it takes {', '.join(takes)})"
        )
    if occupancy is not None:
        if settings.domain != "building":
            raise InputError(f"occupancy does not apply to domain {settings.domain!r}; leave it out")
        options["occupancy"] = occupancy
    return construct(settings, **options)


def make_world(domain: str = "building", **settings) -> GridWorld:
    """Shorthand: ``world_from_settings(WorldSettings(domain, **settings))``.

    Examples
    --------
    >>> make_world("lattice", size=7).n_states
    21
    """
    return world_from_settings(WorldSettings(domain, **settings))
