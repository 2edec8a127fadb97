"""Measures and rows of claim C5.6: paired differences between agents on a robot, unmeasured without a trial."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter5.c5_06_robot_hardware.run import AGENTS
from reproduction.engine.estimates import UNMEASURED, exact_share, exact_value

LIKELY = 0.9
"""Power at which a trial is long enough."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Numbers of a trial, and tasks needed for each size of effect."""
    found = hardware_measures([record for result in results for record in result.get("trials", [])])
    for result in results:
        if "power" in result:
            enough = [n for n, p in zip(settings["tasks"], result["power"], strict=True) if p >= LIKELY]
            name = f"tasks_needed_{result['effect']:g}".replace(".", "_")
            found[name] = exact_value(enough[0]) if enough else UNMEASURED
    return found


def hardware_measures(records: Sequence[Mapping]) -> dict[str, Estimate]:
    """Points and spills of the full agent less those of the others, task by task; share of targets brought."""
    tasks = sorted({record["task"] for record in records})
    if len(tasks) < 2:
        names = ("points_less_scratch", "points_less_no_perception", "points_less_no_prior")
        return dict.fromkeys((*names, "spills_less_scratch", "brought"), UNMEASURED)
    by = {(record["task"], record["agent"]): record for record in records}

    def less(key: str, agent: str) -> Estimate:
        found = mean_estimate([by[task, "full"][key] - by[task, agent][key] for task in tasks])
        # Differences that are all the same, such as no spill at all, have an interval without width.
        return found if found.ci95 else replace(found, ci95=(found.value, found.value))

    return {
        **{f"points_less_{agent.replace('-', '_')}": less("points", agent) for agent in AGENTS[1:]},
        "spills_less_scratch": less("spills", "scratch"),
        "brought": exact_share(by[task, "full"]["brought"] == 1 for task in tasks),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Power by number of tasks, a row for each effect; the records of a trial."""
    power = [
        {"effect": result["effect"], "tasks": settings["tasks"], "power": result["power"]}
        for result in results
        if "power" in result
    ]
    return power + [record for result in results for record in result.get("trials", [])]
