"""Buildings beyond the first reading's mazes: other sizes and wall densities, closed goals, and α⁰ in the advice.

Each is run beside the default, with experts that walk from anywhere. All agents, learners too, start a task in the
same cell. Thesis: §3.7.2.1; of its maze only the size is printed.
"""

from collections.abc import Mapping, Sequence
from itertools import product

from lifelore.core.errors import InputError
from lifelore.domains.advice.advice_maze import OTHER_GOALS
from reproduction.chapter3.advice.mazes import Maze, maze_of

STARTS = "walker's"
"""Where learners start: in the cell of the agents of fixed policy."""
_KEYS = ("name", "size", "loops", "others")


def building_cells(settings: Mapping) -> list[dict]:
    """A cell for each maze of each building; the first building is the default."""
    return [
        {"building": place, "maze": number}
        for place, number in product(range(len(settings["buildings"])), range(settings["mazes"]))
    ]


def building_of(settings: Mapping, cell: Mapping, seed: int) -> Maze:
    """The maze of a cell; of the default's size and loops it is that of the first reading."""
    building = settings["buildings"][cell["building"]]
    of_size = {**settings, "size": building["size"]}
    return maze_of(of_size, {"loops": building["loops"], "maze": cell["maze"]}, seed, building["others"])


def advised_alpha0(settings: Mapping, cell: Mapping) -> list[float]:
    """The α⁰ that advice is given with: 0, and at the default the others too."""
    return [0.0, *(settings["advised_alpha0"] if cell["building"] == 0 else ())]


def other_choices(settings: Mapping) -> list[tuple[int, float]]:
    """Building and α⁰ of every choice beside the default."""
    others = [(place, 0.0) for place in range(1, len(settings["buildings"]))]
    return others + [(0, alpha0) for alpha0 in settings["advised_alpha0"]]


def name_of(building: Mapping) -> str:
    """A building in the name of a measure."""
    return building["name"].replace(" ", "_")


def check_buildings(buildings: Sequence[Mapping], settings: Mapping) -> None:
    """Refuse buildings that lack a choice, and a first one that is not the default."""
    for building in buildings:
        if tuple(building) != _KEYS or building["others"] not in OTHER_GOALS:
            rule = f"must have {', '.join(_KEYS)} in this order, others among {', '.join(OTHER_GOALS)}"
            raise InputError(f"a building {rule}, got {building}")
    default = {
        "name": "default",
        "size": settings["size"],
        "loops": settings["default"]["loops"],
        "others": "pass",
    }
    if not buildings or buildings[0] != default:
        raise InputError(f"the first building must be the default, {default}, got {buildings[:1]}")
