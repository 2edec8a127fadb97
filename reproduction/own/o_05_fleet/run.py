"""O5: rounds until a fleet is competent in an office that no robot knows, by the number of robots.

In every round each robot takes over what the fleet knew before the round, lives one short task with a memory file
of its own, and gives the file to the fleet, as robots do that are offline during a task. A fleet is competent
where its tasks have at most a tenth of the refused moves (into a wall) of robots that know nothing.
"""

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.buildings.occupancy_map import write_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.worlds import WorldSettings
from lifelore.memory import open_memory


def cells(settings: Mapping) -> list[dict]:
    """A fleet in a building each."""
    buildings = range(settings["buildings"])
    return [{"robots": int(robots), "building": n} for n in buildings for robots in settings["rounds"]]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean refused moves a task by round, of the fleet and of robots that know nothing."""
    number, robots = settings["buildings"] * seed + cell["building"], cell["robots"]
    rounds = settings["rounds"][str(robots)]
    refused = np.zeros((rounds, robots, 2))
    with tempfile.TemporaryDirectory() as folder:
        world, shared = str(Path(folder, "office.yaml")), Path(folder, "fleet.db")
        write_occupancy_map(Path(world), office_map(number, settings["width_m"], settings["height_m"]))
        own = [Path(folder, f"robot{robot}.db") for robot in range(robots)]
        open_memory(shared).close()
        for round_ in range(rounds):
            for robot, path in enumerate(own):
                with open_memory(path) as memory:
                    memory.merge_from(shared)
                refused[round_, robot] = _task(world, path, robot, 100 * number + robot, settings["moves"])
            with open_memory(shared) as memory:
                memory.merge_many(own)
    fleet, nothing = refused.mean(axis=1).T.tolist()
    return {**cell, "fleet": fleet, "nothing": nothing}


def _task(world: str, memory: Path, robot: int, seed: int, moves: int) -> tuple[int, int]:
    """Refused moves in the robot's next task, of the robot and of one that knows nothing."""
    found: list[tuple[int, int]] = []
    settings = LifeSettings(
        WorldSettings("building", world, seed=seed),
        episodes=1,
        max_steps=moves,
        memory=MemorySettings(str(memory), f"robot {robot}", refresh=True),
        tasks=1,
        jobs=1,
    )

    def watch(task: dict, results: Mapping[str, Any]) -> None:
        found.append((results["lore"].collisions, results["scratch"].collisions))

    live(settings, watch=watch)
    return found[0]


def rounds_to_competence(fleet: Sequence[float], nothing: Sequence[float], competent: float, window: int) -> int:
    """Rounds lived before the first `window` rounds of a competent fleet; all rounds if there are none."""
    limit = competent * np.mean(nothing)
    for first in range(len(fleet) - window + 1):
        if np.mean(fleet[first : first + window]) <= limit:
            return first
    return len(fleet)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same for every level of competence."""
    for competent in settings["competent"]:
        yield {"competent at": competent}, numbers(settings, results, competent)


def numbers(settings: Mapping, results: Sequence[Mapping], competent: float) -> dict[str, Estimate]:
    """Rounds and tasks until `competent` by number of robots, and ratios to those of the fewest robots."""
    needed: dict[int, NDArray[np.int64]] = {}
    for robots in map(int, settings["rounds"]):
        own = [result for result in results if result["robots"] == robots]
        curves = [(result["fleet"], result["nothing"]) for result in own]
        needed[robots] = np.array([rounds_to_competence(*each, competent, settings["window"]) for each in curves])
    found = {f"rounds_of_{robots}": mean_estimate(own) for robots, own in needed.items()}
    found |= {f"tasks_of_{robots}": mean_estimate(robots * own) for robots, own in needed.items()}
    few = min(needed)
    return found | {f"ratio_{robots}_to_{few}": ratio_estimate(own, needed[few]) for robots, own in needed.items()}
