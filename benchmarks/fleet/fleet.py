"""`bench fleet`: tasks that each robot needs until it is competent, by the number of robots that share a memory.

Robots live in one building that none of them knows, in short tasks of `MOVES` moves. A robot is competent where it
makes at most `COMPETENT` of the refused moves of a robot that knows nothing, over `WINDOW` tasks of each robot.

In each round, every robot takes over what the fleet knew before the round, lives a task with a memory file of its
own, and gives the file to the fleet, as robots do that are offline during a task. So the result does not depend on
the machine. Beside these rounds, real processes live on one memory at the same time, and processes are killed; see
`fleet_processes`. With three repeats or more the figure is written, ``benchmarks/results/fleet.png``.
"""

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from joblib import Parallel, delayed
from numpy.typing import NDArray

from benchmarks.fleet.fleet_audit import added_again, wrong_sums
from benchmarks.fleet.fleet_processes import (
    PROCESS_TASKS,
    PROCESSES,
    killed_processes,
    processes_on,
)
from benchmarks.fleet.fleet_robot import LIFE, LIVES, MOVES, FleetTask, Robot, office
from benchmarks.rounds import at_least, at_most, row
from lifelore.core.metrics import mean_estimate
from lifelore.core.protocols import Progress
from lifelore.memory import open_memory

ROUNDS = {1: 24, 2: 16, 4: 12, 8: 8}
"""Number of robots, and rounds that they live; a fleet that is not competent by then counts with all of them."""
COMPETENT, WINDOW = 0.1, 3
LEAST_REPEATS = 3
OUT = Path("benchmarks/results")
Curve = NDArray[np.float64]
"""(rounds, 2): mean refused moves a task, of the fleet and of robots that know nothing."""


def bench_fleet(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`.

    Beside them ``rounds``: mean refused moves by number of robots and round; ``rounds_to_competence``: by number
    of robots, for each building; ``processes`` and ``kills``: what they left in memory.
    """
    total = repeats * len(ROUNDS) + 3
    cells = [(robots, building) for building in range(repeats) for robots in ROUNDS]
    found = {}
    run = Parallel(-1, return_as="generator_unordered")
    lives: Any = run(delayed(_cell)(robots, building, ROUNDS[robots]) for robots, building in cells)
    for done, (cell, lived) in enumerate(lives):
        found[cell] = lived
        progress(done + 1, total, f"{cell[0]} robots, building {cell[1]}")
    curves = {robots: [found[robots, building][0] for building in range(repeats)] for robots in ROUNDS}
    offline = [sum(problems) for problems in zip(*(lived[1] for lived in found.values()), strict=True)]
    processes = {}
    for place in ("SQLite", "PostgreSQL"):
        if (lived := processes_on(place)) is not None:
            processes[place] = lived
        progress(total - 2 + len(processes), total, f"processes on {place}")
    kills = killed_processes()
    assert kills is not None, "a file needs no server"
    progress(total, total, "kills")
    needed = {robots: [rounds_to_competence(curve) for curve in each] for robots, each in curves.items()}
    result = {
        "rows": [*_rows(needed, curves), *_process_rows(processes), *_kill_rows(kills)],
        "goals": _goals(needed, offline, processes, kills),
        "rounds": {str(robots): np.mean(each, axis=0).tolist() for robots, each in curves.items()},
        "rounds_to_competence": {str(robots): each for robots, each in needed.items()},
        "processes": processes,
        "kills": kills,
    }
    if repeats >= LEAST_REPEATS:
        from benchmarks.fleet.figure_fleet import draw_fleet
        from lifelore.figures.style import save_figure

        save_figure(draw_fleet(curves, needed, COMPETENT), out / "bench_fleet.png")
    return result


# ---- rounds ------------------------------------------------------------------------------------------------


def _cell(robots: int, building: int, rounds: int) -> tuple[tuple[int, int], tuple[Curve, tuple[int, int]]]:
    return (robots, building), lived_in_rounds(robots, building, rounds)


def lived_in_rounds(robots: int, building: int, rounds: int) -> tuple[Curve, tuple[int, int]]:
    """The curve of a fleet in one building; wrong sums in its memory, and contributions a second merge adds."""
    curve = np.zeros((rounds, 2))
    with tempfile.TemporaryDirectory() as folder:
        world, shared = office(Path(folder), building), Path(folder, "fleet.db")
        fleet = [
            Robot(str(Path(folder, f"robot{i}.db")), f"robot {i}", 100 * building + i, world)
            for i in range(robots)
        ]
        open_memory(shared).close()
        for number in range(rounds):
            for robot in fleet:
                with open_memory(robot.memory) as own:
                    own.merge_from(shared)
            tasks: list[FleetTask] = []
            for robot in fleet:
                LIVES[LIFE](robot, 1, tasks.append)
            curve[number] = np.mean([task.refused for task in tasks]), np.mean([task.scratch for task in tasks])
            with open_memory(shared) as memory:
                memory.merge_many([robot.memory for robot in fleet])
        with open_memory(shared) as memory:
            wrong = wrong_sums(memory) + len(memory.check())
        return curve, (wrong, added_again(shared, [Path(robot.memory) for robot in fleet]))


def rounds_to_competence(curve: Curve) -> int:
    """Rounds lived before the first `WINDOW` rounds of a competent fleet; all rounds if there are none."""
    limit = COMPETENT * curve[:, 1].mean()
    for first in range(len(curve) - WINDOW + 1):
        if curve[first : first + WINDOW, 0].mean() <= limit:
            return first
    return len(curve)


# ---- the answer --------------------------------------------------------------------------------------------


def _rows(needed: dict[int, list[int]], curves: dict[int, list[Curve]]) -> list[dict]:
    rows = []
    alone = float(np.mean(needed[min(needed)]))
    scratch = float(np.mean(np.concatenate([curve[:, 1] for each in curves.values() for curve in each])))
    rows.append(row(f"refused moves of {MOVES}, a robot that knows nothing", scratch, "moves"))
    first = f"{min(needed)} robots: rounds to competence"
    for robots, each in needed.items():
        mean, name = float(np.mean(each)), f"{robots} robots: rounds to competence"
        rows.append(row(name, mean, "rounds", first, mean / alone))
        interval = mean_estimate(each).ci95
        for end, value in zip(("lower", "upper"), interval or (), strict=False):
            rows.append(row(f"{name}, {end} end of the 95 % interval", value, "rounds"))
        rows.append(row(f"{robots} robots: tasks of all until then", robots * mean, "tasks"))
        late = sum(value == ROUNDS[robots] for value in each)
        rows.append(row(f"{robots} robots: buildings of {len(each)} without competence", late, "buildings"))
    return rows


def _process_rows(processes: dict[str, dict]) -> list[dict]:
    return [
        row(f"{found['robots']} processes on {place}: tasks stored", sum(map(len, found["tasks"])), "tasks")
        for place, found in processes.items()
    ]


def _kill_rows(kills: dict[str, Any]) -> list[dict]:
    labels = {"tasks": "tasks stored", "lost": "tasks not yet taken again", "twice": "tasks stored twice"}
    return [row(f"{kills['kills']} kills: {text}", kills[name], "tasks") for name, text in labels.items()]


def _goals(
    needed: dict[int, list[int]], offline: Sequence[int], processes: dict[str, dict], kills: dict[str, Any]
) -> list[dict]:
    few, many = min(needed), max(needed)
    ratio = float(np.mean(needed[many]) / np.mean(needed[few]))
    goals = [
        at_most(f"rounds to competence, {many} robots to {few}", 0.25, ratio),
        at_most("offline robots: wrong sums and problems", 0, offline[0]),
        at_most("offline robots: changes by merging everything again", 0, offline[1]),
    ]
    for place, found in processes.items():
        missing = PROCESSES * PROCESS_TASKS - sum(len(set(numbers)) for numbers in found["tasks"])
        wrong = found["failed"] + missing + len(found["problems"]) + found["wrong_sums"]
        goals.append(
            at_most(f"{found['robots']} processes on {place}: failures, missing tasks, wrong sums", 0, wrong)
        )
    wrong = kills["twice"] + kills["missing"] + len(kills["problems"]) + kills["wrong_sums"]
    return [
        *goals,
        at_least("tasks stored a kill", 1, kills["tasks"] / kills["kills"]),
        at_most("tasks not yet taken again, a kill", 1, kills["lost"] / kills["kills"]),
        at_most("after kills: tasks twice or missing, problems, wrong sums", 0, wrong),
    ]
