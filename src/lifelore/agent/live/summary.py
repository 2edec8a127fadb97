"""Summary of a life: means of each agent over thirds of the tasks, and comparisons of agents."""

import math
from collections.abc import Callable, Iterable

from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate

SEARCH_MEASURES = ("steps_to_80", "steps_to_goal", "collisions", "episodes_to_80", "first_return")
DRIVE_MEASURES = ("seconds", "metres", "refusals", "replans")


def plain(estimate: Estimate) -> dict:
    """An estimate as JSON data; NaN becomes null."""
    data = estimate.to_dict()
    return {k: None if isinstance(v, float) and math.isnan(v) else v for k, v in data.items()}


def third(tasks: list[dict], which: str) -> list[dict]:
    """The first or last third of the tasks, at least one."""
    size = max(1, len(tasks) // 3)
    return tasks[:size] if which == "first" else tasks[-size:]


def summarise(tasks: list[dict]) -> dict:
    """Summary of searches: ratios to scratch with raw means over the last third, and means of each agent.

    Parameters
    ----------
    tasks : list of dict
        The ``tasks`` of a life's report, at least one.
    """
    agents, last = list(tasks[0]["agents"]), third(tasks, "last")
    others = [name for name in agents if name != "scratch" and "scratch" in agents]
    ratios = {
        f"{name}_vs_scratch": {
            "steps_to_80_ratio": compared(last, name, "scratch", "steps_to_80", ratio_estimate),
            "collisions_ratio": compared(last, name, "scratch", "collisions", ratio_estimate),
            "jumpstart": compared(last, name, "scratch", "first_return", jumpstart),
            "capped": {who: failures(last, who) for who in (name, "scratch")},
        }
        for name in others
    }
    return ratios | {"agents": means_by_third(tasks, SEARCH_MEASURES, "capped")}


def summarise_drives(tasks: list[dict]) -> dict:
    """Summary of driven jobs: the first agent compared with the other, if there is one, and means of each agent.

    ``lore_vs_map_only`` has the ratio of seconds and the number of refusals over all jobs and over the last third.
    """
    agents, summary = list(tasks[0]["agents"]), {}
    if len(agents) > 1:
        parts = {"all": tasks, "last": third(tasks, "last")}
        summary["lore_vs_map_only"] = {which: _compared_drives(part, agents) for which, part in parts.items()}
    return summary | {"agents": means_by_third(tasks, DRIVE_MEASURES, "no_way")}


def _compared_drives(tasks: list[dict], agents: list[str]) -> dict:
    own, others = (column(tasks, name, "seconds") for name in agents)
    return {
        "seconds_ratio": plain(ratio_estimate(own, others)),
        "seconds": {name: sum(column(tasks, name, "seconds")) for name in agents},
        "refusals": {name: sum(column(tasks, name, "refusals")) for name in agents},
    }


def means_by_third(tasks: list[dict], measures: Iterable[str], failed: str | None = None) -> dict:
    """Means of each agent over the first and last third; `failed` names the count of goals not reached."""

    def means(part: list[dict], name: str) -> dict:
        found = {measure: plain(mean_estimate(column(part, name, measure))) for measure in measures}
        return found if failed is None else found | {failed: failures(part, name)}

    return {
        name: {which: means(third(tasks, which), name) for which in ("first", "last")}
        for name in tasks[0]["agents"]
    }


def compared(
    tasks: list[dict], name: str, other: str, measure: str, estimate: Callable[[list, list], Estimate]
) -> dict:
    """A comparison of two agents by a measure of the same tasks, and their ``raw`` means."""
    values = {who: column(tasks, who, measure) for who in (name, other)}
    raw = {who: sum(own) / len(own) for who, own in values.items()}
    return plain(estimate(values[name], values[other])) | {"raw": raw}


def column(tasks: list[dict], agent: str, measure: str) -> list:
    """A measure of an agent in each task."""
    return [task["agents"][agent][measure] for task in tasks]


def failures(tasks: list[dict], agent: str) -> int:
    """Number of tasks in which an agent did not reach its goal."""
    return sum(not reached for reached in column(tasks, agent, "reached"))
