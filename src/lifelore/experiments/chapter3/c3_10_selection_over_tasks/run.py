"""The cells of C3.10: which features Alg. 6 chooses after each of 30 tasks, by whose policies count and where.

Thesis: §3.3.3, Alg. 6, §3.4.6, Figure 3.14.
"""

from collections.abc import Mapping
from typing import NamedTuple

from lifelore.action.priors.exploration import TIES
from lifelore.core.errors import InputError
from lifelore.domains.factory.factory import N_COMPONENTS
from lifelore.experiments.chapter3.lattice_learning import schedule_of
from lifelore.experiments.chapter3.modified_factory_tasks import FULL_SET, problem_of
from lifelore.experiments.chapter3.online_selection import Counting, OnlineAgent
from lifelore.experiments.engine.learning_settings import check_among, check_counts, check_learning


class Series(NamedTuple):
    """How one series of an agent's tasks is counted and learnt.

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
"""The first two are those that the claim asks of."""


def cells(settings: Mapping) -> list[dict]:
    """A run each."""
    return [{"run": number} for number in range(settings["runs"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: the features chosen after each task as a bit mask, and states counted of each policy."""
    agents = {
        name: OnlineAgent(True, one.counting, settings["alpha0"], settings["ties"]) for name, one in SERIES.items()
    }
    chosen: dict[str, list[int]] = {name: [] for name in agents}
    for i in range(settings["tasks"]):
        problem = problem_of(settings, (seed, "C3.10", cell["run"], i))
        for name, agent in agents.items():
            _learn_or_count(settings, agent, SERIES[name], problem)
            chosen[name].append(mask_of(agent.chosen))
    return {**cell, "chosen": chosen}


def _learn_or_count(settings: Mapping, agent: OnlineAgent, series: Series, problem) -> None:
    if series.counting.source == "exact":
        agent.count(problem, None)
        return
    episodes = settings["long_episodes"] if series.long else settings["episodes"]
    schedule = schedule_of({**settings, "episodes": episodes}, settings["schedule"])
    agent.learn(problem, schedule, explores=series.explores)


def mask_of(names) -> int:
    """Chosen features as a number: bit i is set where the i-th of φ4 is chosen."""
    return sum(1 << i for i, name in enumerate(FULL_SET.names) if name in names)


def check(settings: Mapping) -> None:
    check_counts(settings, ("runs", "tasks", "last", "episodes", "long_episodes", "max_steps", "components"))
    check_learning({**settings, "schedules": [settings["schedule"]]})
    check_among({"ties": [settings["ties"]]}, "ties", TIES)
    if settings["components"] > N_COMPONENTS:
        raise InputError(f"components must be at most {N_COMPONENTS}, got {settings['components']}")
    if settings["last"] > settings["tasks"]:
        raise InputError(f"last must be at most tasks ({settings['tasks']}), got {settings['last']}")
    if settings["alpha0"] <= 0:
        raise InputError(f"alpha0 must be positive, got {settings['alpha0']}")
