"""`bench customer_fleet`: time to competence of fleets of long-lived agents that serve hidden customers.

The robots of a fleet have the same customers and contexts and share one memory on a PostgreSQL server. An SQLite
file gets the same contributions and must hold the same in the end. In every round, each robot recalls what the
fleet knew before the round, lives through one order and stores it. After each round, the fleet's knowledge is
tested on orders that nobody learns from. A fleet is competent once first episodes miss at most `COMPETENT` of what
those of an agent that knows nothing miss, in `WINDOW` tests in a row. Beside these rounds, real processes live on
one memory, and processes are killed. With three repeats or more, the figure
``benchmarks/results/customer_fleet.png``.
"""

import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.fleet.fleet_audit import contents, wrong_sums
from benchmarks.fleet.fleet_processes import killed_processes, processes_on
from benchmarks.fleet.fleet_robot import (
    CUSTOMERS_LIFE,
    EPISODES,
    MOST_ROBOTS,
    RobotOrders,
    robot_orders,
)
from benchmarks.fleet.postgresql_server import new_place, postgresql_server
from benchmarks.rounds import at_least, at_most, estimated_row, row
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, attempt_task, live_task
from lifelore.agent.long_lived.long_life import recalled
from lifelore.agent.long_lived.task_family import AGENTS
from lifelore.core.metrics import mean_estimate
from lifelore.core.protocols import Progress
from lifelore.memory import Memory, open_memory

Array = NDArray[np.float64]

ROUNDS = {1: 32, 2: 16, 4: 9, 8: 6}
"""Number of robots, and rounds that they live; a fleet that is not competent by then counts with all of them."""
COMPETENT, WINDOW = 0.5, 2
TESTS = 8
"""Orders of a test, the same for all fleets of a world."""
PROCESSES, PROCESS_TASKS = 2, 3
"""Robots that run at the same time on one memory, and tasks of each."""
KILLS, KILL_PROCESSES = 3, 2
"""Kills, and processes of the robot that live at a time and are killed in the end."""
PLACES = ("SQLite", "PostgreSQL")
LEAST_REPEATS = 3
LIVING, ONCE = LivingSettings(n_episodes=EPISODES), LivingSettings(n_episodes=1)
FULL = AGENTS["full"]
OUT = Path("benchmarks/results")


def bench_customer_fleet(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`.

    Beside them ``rounds``: mean points missed by number of robots and round; ``rounds_to_competence``: by number
    of robots, for each world; ``processes`` and ``kills``: what they left in memory, by place.
    """
    total = repeats * len(ROUNDS) + 2 * len(PLACES)
    curves: dict[int, list[Array]] = {robots: [] for robots in ROUNDS}
    scratch, wrong, done = [], 0, 0
    with postgresql_server() as server, tempfile.TemporaryDirectory() as folder:
        for world in range(repeats):
            tests = robot_orders(str(world), MOST_ROBOTS - 1)
            best = [tests.best_return(number) for number in range(TESTS)]
            scratch.append(tested(Knowledge.empty(tests), tests, best))
            for robots, rounds in ROUNDS.items():
                name = f"fleet_{world}_{robots}"
                places = [] if server is None else [new_place(server, name)]
                places.append(str(Path(folder, f"{name}.db")))
                curve, problems = lived_in_rounds(robots, world, rounds, tests, best, places)
                curves[robots].append(curve)
                wrong += problems
                done += 1
                progress(done, total, f"{robots} robots, world {world}")
    processes, kills = {}, {}
    for place in PLACES:
        if (lived := processes_on(place, CUSTOMERS_LIFE, PROCESSES, PROCESS_TASKS)) is not None:
            processes[place] = lived
        if (killed := killed_processes(place, CUSTOMERS_LIFE, KILLS, KILL_PROCESSES)) is not None:
            kills[place] = killed
        done += 2
        progress(done, total, f"processes and kills on {place}")
    needed = {
        robots: [rounds_to_competence(curve, one) for curve, one in zip(each, scratch, strict=True)]
        for robots, each in curves.items()
    }
    result = {
        "rows": _rows(needed, scratch, processes, kills),
        "goals": _goals(needed, wrong, processes, kills),
        "rounds": {str(robots): np.mean(each, axis=0).tolist() for robots, each in curves.items()},
        "rounds_to_competence": {str(robots): each for robots, each in needed.items()},
        "processes": processes,
        "kills": kills,
    }
    if repeats >= LEAST_REPEATS:
        from benchmarks.fleet.figure_fleet import draw_fleet
        from lifelore.figures.style import save_figure

        drawn = {
            robots: [
                np.column_stack([curve, np.full(len(curve), one)])
                for curve, one in zip(each, scratch, strict=True)
            ]
            for robots, each in curves.items()
        }
        words = "A fleet learns its customers", "points missed, first episode"
        out.mkdir(parents=True, exist_ok=True)
        save_figure(draw_fleet(drawn, needed, COMPETENT, *words), out / "bench_customer_fleet.png")
    return result


# ---- rounds ------------------------------------------------------------------------------------------------


def lived_in_rounds(
    robots: int, world: int, rounds: int, tests: RobotOrders, best: list[float], places: Sequence[str]
) -> tuple[Array, int]:
    """Points missed in the test after each round, (rounds,); wrong sums, problems and differences of places."""
    families = [robot_orders(str(world), robot) for robot in range(robots)]
    curve = np.zeros(rounds)
    with ExitStack() as stack:
        memories = [stack.enter_context(open_memory(where)) for where in places]
        for number in range(rounds):
            _round(memories, families, number)
            curve[number] = tested(recalled(tests, memories[0]), tests, best)
        wrong = sum(wrong_sums(memory) + len(memory.check()) for memory in memories)
        left = [contents(memory) for memory in memories]
    return curve, wrong + sum(one != left[0] for one in left)


def _round(memories: list[Memory], families: list[RobotOrders], number: int) -> None:
    """An order of each robot, which knows what the first memory held before the round."""
    before = [recalled(family, memories[0]) for family in families]
    for robot, (family, knowledge) in enumerate(zip(families, before, strict=True)):
        drawn, task = family.meet(number, FULL)
        name = f"robot {robot}"
        lived, records = live_task(knowledge, drawn, task, FULL, LIVING, f"{name}.{number}", robot)
        document = {"task": number, "returns": lived.returns}
        for memory in memories:
            memory.contribute(name, records, process=name, seq=number, task=document)


def tested(knowledge: Knowledge, tests: RobotOrders, best: list[float]) -> float:
    """Mean points that first episodes of the test's orders miss; nothing is learnt from them."""
    missed = []
    for number, possible in enumerate(best):
        drawn, task = tests.meet(number, FULL)
        lived, _ = attempt_task(knowledge, drawn, task, FULL, ONCE, "test")
        missed.append(possible - lived.returns[0])
    return float(np.mean(missed))


def rounds_to_competence(curve: Array, scratch: float) -> int:
    """Rounds lived until the last of the first `WINDOW` tests in a row that are competent; all if there are none.

    Examples
    --------
    >>> rounds_to_competence(np.array([9.0, 5.0, 6.0, 4.0, 4.0]), 10.0)
    5
    """
    good = curve <= COMPETENT * scratch
    for first in range(len(good) - WINDOW + 1):
        if good[first : first + WINDOW].all():
            return first + WINDOW
    return len(curve)


# ---- the answer --------------------------------------------------------------------------------------------


def _rows(needed: dict[int, list[int]], scratch: list[float], processes: dict, kills: dict) -> list[dict]:
    alone = float(np.mean(needed[min(needed)]))
    rows = [row("points missed by an agent that knows nothing", float(np.mean(scratch)), "points")]
    first = f"{min(needed)} robots: rounds to competence"
    for robots, each in needed.items():
        mean, name = float(np.mean(each)), f"{robots} robots: rounds to competence"
        line = estimated_row(name, mean_estimate(each), "rounds")
        rows.append(line | {"ratio_to": first, "ratio": mean / alone})
        rows.append(row(f"{robots} robots: tasks of all until then", robots * mean, "tasks"))
        late = sum(value == ROUNDS[robots] for value in each)
        rows.append(row(f"{robots} robots: worlds of {len(each)} that took all rounds or more", late, "worlds"))
    for place, found in processes.items():
        stored = sum(map(len, found["tasks"]))
        rows.append(row(f"{found['robots']} processes on {place}: tasks stored", stored, "tasks"))
    labels = {"tasks": "tasks stored", "lost": "tasks not yet taken again", "twice": "tasks stored twice"}
    for place, found in kills.items():
        rows += [
            row(f"{found['kills']} kills on {place}: {text}", found[name], "tasks")
            for name, text in labels.items()
        ]
    return rows


def _goals(
    needed: dict[int, list[int]],
    wrong: int,
    processes: dict[str, dict[str, Any]],
    kills: dict[str, dict[str, Any]],
) -> list[dict]:
    few, many = min(needed), max(needed)
    ratio = float(np.mean(needed[many]) / np.mean(needed[few]))
    goals = [
        at_most(f"rounds to competence, {many} robots to {few}", 0.25, ratio),
        at_most("wrong sums, problems, differences between PostgreSQL and SQLite", 0, wrong),
    ]
    for place, found in processes.items():
        missing = PROCESSES * PROCESS_TASKS - sum(len(set(numbers)) for numbers in found["tasks"])
        bad = found["failed"] + missing + len(found["problems"]) + found["wrong_sums"]
        goals.append(
            at_most(f"{found['robots']} processes on {place}: failures, missing tasks, wrong sums", 0, bad)
        )
    for place, found in kills.items():
        bad = found["twice"] + found["missing"] + len(found["problems"]) + found["wrong_sums"]
        goals += [
            at_least(f"tasks stored a kill on {place}", 1, found["tasks"] / found["kills"]),
            at_most(f"tasks not yet taken again, a kill on {place}", 1, found["lost"] / found["kills"]),
            at_most(f"after kills on {place}: tasks twice or missing, problems, wrong sums", 0, bad),
        ]
    return goals
