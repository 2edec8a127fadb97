"""Summary of a life: means of each agent over thirds of the tasks, and comparisons of agents."""

import math

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
    compared = {f"{name}_vs_scratch": _compared_with_scratch(last, name) for name in others}
    return compared | _means(tasks, SEARCH_MEASURES, "capped")


def summarise_drives(tasks: list[dict]) -> dict:
    """Summary of driven jobs: the first agent compared with the other, if there is one, and means of each agent.

    ``lore_vs_map_only`` has the ratio of seconds and the number of refusals over all jobs and over the last third.
    """
    agents, summary = list(tasks[0]["agents"]), {}
    if len(agents) > 1:
        parts = {"all": tasks, "last": third(tasks, "last")}
        summary["lore_vs_map_only"] = {which: _compared_drives(part, *agents) for which, part in parts.items()}
    return summary | _means(tasks, DRIVE_MEASURES, "no_way")


def _means(tasks: list[dict], measures: tuple[str, ...], failed: str) -> dict:
    """``agents``: means over the first and last third; `failed` names the count of goals that were not reached."""
    return {
        "agents": {
            name: {
                which: {m: plain(mean_estimate(_column(third(tasks, which), name, m))) for m in measures}
                | {failed: _failures(third(tasks, which), name)}
                for which in ("first", "last")
            }
            for name in tasks[0]["agents"]
        }
    }


def _column(tasks: list[dict], agent: str, measure: str) -> list[float]:
    return [task["agents"][agent][measure] for task in tasks]


def _failures(tasks: list[dict], agent: str) -> int:
    return sum(not reached for reached in _column(tasks, agent, "reached"))


def _compared_with_scratch(tasks: list[dict], name: str) -> dict:
    def compared(measure: str, compare=ratio_estimate) -> dict:
        own, scratch = _column(tasks, name, measure), _column(tasks, "scratch", measure)
        raw = {name: sum(own) / len(own), "scratch": sum(scratch) / len(scratch)}
        return plain(compare(own, scratch)) | {"raw": raw}

    return {
        "steps_to_80_ratio": compared("steps_to_80"),
        "collisions_ratio": compared("collisions"),
        "jumpstart": compared("first_return", jumpstart),
        "capped": {who: _failures(tasks, who) for who in (name, "scratch")},
    }


def _compared_drives(tasks: list[dict], name: str, other: str) -> dict:
    own, others = _column(tasks, name, "seconds"), _column(tasks, other, "seconds")
    return {
        "seconds_ratio": plain(ratio_estimate(own, others)),
        "seconds": {name: sum(own), other: sum(others)},
        "refusals": {who: sum(_column(tasks, who, "refusals")) for who in (name, other)},
    }
