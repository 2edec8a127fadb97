"""Summary of a life: means of each agent over thirds of the tasks, and ratios to `scratch`."""

import math

from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate

MEASURES = ("steps_to_80", "steps_to_goal", "collisions", "episodes_to_80", "first_return")


def plain(estimate: Estimate) -> dict:
    """An estimate as JSON data; NaN becomes null."""
    data = estimate.to_dict()
    return {k: None if isinstance(v, float) and math.isnan(v) else v for k, v in data.items()}


def third(tasks: list[dict], which: str) -> list[dict]:
    """The first or last third of the tasks, at least one."""
    size = max(1, len(tasks) // 3)
    return tasks[:size] if which == "first" else tasks[-size:]


def summarise(tasks: list[dict]) -> dict:
    """Ratios to scratch with raw means over the last third, and means of each agent over the first and last third.

    Parameters
    ----------
    tasks : list of dict
        The ``tasks`` of a life's report, at least one.
    """
    agents = list(tasks[0]["agents"])
    last = third(tasks, "last")
    summary: dict = {}
    if "scratch" in agents:
        for name in agents:
            if name != "scratch":
                summary[f"{name}_vs_scratch"] = _compared_with_scratch(last, name)
    summary["agents"] = {name: _own(tasks, name) for name in agents}
    return summary


def _column(tasks: list[dict], agent: str, measure: str) -> list[float]:
    return [task["agents"][agent][measure] for task in tasks]


def _compared_with_scratch(tasks: list[dict], name: str) -> dict:
    steps, other_steps = _column(tasks, name, "steps_to_80"), _column(tasks, "scratch", "steps_to_80")
    hits, other_hits = _column(tasks, name, "collisions"), _column(tasks, "scratch", "collisions")
    first, other_first = _column(tasks, name, "first_return"), _column(tasks, "scratch", "first_return")
    return {
        "steps_to_80_ratio": plain(ratio_estimate(steps, other_steps)) | _raw(name, steps, other_steps),
        "collisions_ratio": plain(ratio_estimate(hits, other_hits)) | _raw(name, hits, other_hits),
        "jumpstart": plain(jumpstart(first, other_first)) | _raw(name, first, other_first),
        "capped": {who: sum(not t["agents"][who]["reached"] for t in tasks) for who in (name, "scratch")},
    }


def _raw(name: str, own: list[float], scratch: list[float]) -> dict:
    return {"raw": {name: sum(own) / len(own), "scratch": sum(scratch) / len(scratch)}}


def _own(tasks: list[dict], name: str) -> dict:
    return {
        which: {m: plain(mean_estimate(_column(third(tasks, which), name, m))) for m in MEASURES}
        | {"capped": sum(not reached for reached in _column(third(tasks, which), name, "reached"))}
        for which in ("first", "last")
    }
