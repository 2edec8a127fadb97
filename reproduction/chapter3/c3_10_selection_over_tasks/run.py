"""C3.10: features that Alg. 6 chooses after each of 30 tasks, by the policies and states that count.

Thesis: §3.3.3, Alg. 6, §3.4.6, Figure 3.14.
"""

from collections.abc import Mapping
from typing import NamedTuple

from reproduction.chapter3.factory.modified_tasks import FULL_SET, problem_of
from reproduction.chapter3.factory.online_selection import Counting, OnlineAgent
from reproduction.chapter3.learning.schedules import schedule_of


class Series(NamedTuple):
    """Counting and learning of one series of tasks.

    explores : whether it explores by its own prior; else uniformly
    long : whether it learns each task for ``long_episodes`` rather than ``episodes``
    """

    counting: Counting
    explores: bool = True
    long: bool = False


SERIES = {
    "exact": Series(Counting("exact", "all")),
    "learnt": Series(Counting("learnt", "tried")),
    "learnt, promising": Series(Counting("learnt", "visited")),
    "exact, on the way": Series(Counting("exact", "way")),
    "learnt, all states": Series(Counting("learnt", "all")),
    "learnt longer": Series(Counting("learnt", "tried"), long=True),
    "learnt, explored uniformly": Series(Counting("learnt", "tried"), explores=False),
}
"""The first reading reads the first two; the second the third, which counts as E4 says, and all as a grid."""


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: the features chosen after each task as a bit mask, and states counted of each policy."""
    agents = {
        name: OnlineAgent(True, use.counting, settings["alpha0"], settings["ties"]) for name, use in SERIES.items()
    }
    chosen: dict[str, list[int]] = {name: [] for name in agents}
    for i in range(settings["tasks"]):
        problem = problem_of(settings, (seed, "C3.10", cell["run"], i))
        for name, agent in agents.items():
            series = SERIES[name]
            if series.counting.source == "exact":
                agent.count(problem, None)
            else:
                episodes = settings["long_episodes" if series.long else "episodes"]
                schedule = schedule_of({**settings, "episodes": episodes}, settings["schedule"])
                agent.learn(problem, schedule, explores=series.explores)
            chosen[name].append(mask_of(agent.chosen))
    return {**cell, "chosen": chosen}


def mask_of(names) -> int:
    """Chosen features as a number: bit i is set where the i-th of φ4 is chosen."""
    return sum(1 << i for i, name in enumerate(FULL_SET.names) if name in names)
