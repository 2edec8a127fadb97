"""Summary of driven jobs: means over thirds of the jobs, and memory compared with the map alone."""

from lifelore.agent.live.summary import plain, third
from lifelore.core.metrics import mean_estimate, ratio_estimate

MEASURES = ("seconds", "metres", "refusals", "replans")


def summarise_drives(tasks: list[dict]) -> dict:
    """The key ``summary`` of a report with these jobs, at least one.

    ``agents`` has, for each agent, the means over the first and last third, and the number of jobs without a way.
    ``lore_vs_map_only`` has the ratio of seconds and the mean refusals over all jobs and over the last third.
    """
    agents = list(tasks[0]["agents"])
    summary: dict = {}
    if len(agents) > 1:
        parts = {"all": tasks, "last": third(tasks, "last")}
        summary["lore_vs_map_only"] = {which: _compared(part, *agents) for which, part in parts.items()}
    summary["agents"] = {name: _own(tasks, name) for name in agents}
    return summary


def _column(tasks: list[dict], agent: str, measure: str) -> list[float]:
    return [task["agents"][agent][measure] for task in tasks]


def _compared(tasks: list[dict], name: str, other: str) -> dict:
    own, others = _column(tasks, name, "seconds"), _column(tasks, other, "seconds")
    return {
        "seconds_ratio": plain(ratio_estimate(own, others)),
        "seconds": {name: sum(own), other: sum(others)},
        "refusals": {who: sum(_column(tasks, who, "refusals")) for who in (name, other)},
    }


def _own(tasks: list[dict], name: str) -> dict:
    return {
        which: {m: plain(mean_estimate(_column(third(tasks, which), name, m))) for m in MEASURES}
        | {"no_way": sum(not reached for reached in _column(third(tasks, which), name, "reached"))}
        for which in ("first", "last")
    }
