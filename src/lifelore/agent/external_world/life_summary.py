"""Measures of a task in an external world, and the summary of a life: each agent over thirds of its tasks."""

from collections.abc import Sequence

from lifelore.agent.live.summary import plain, third
from lifelore.core.metrics import difference_estimate, mean_estimate

MEASURES = ("first_return", "mean_return", "final_return")


def task_measures(returns: Sequence[float], reached: bool) -> dict:
    """The measures of an agent in a task as JSON data.

    Parameters
    ----------
    returns : sequence of float
        Discounted return of each episode, at least one.
    reached : bool
        Whether an episode was terminated with a positive reward.
    """
    last = returns[-max(1, len(returns) // 10) :]
    return {
        "first_return": returns[0],
        "reached": reached,
        "final_return": sum(last) / len(last),
        "mean_return": sum(returns) / len(returns),
        **dict.fromkeys(("collisions", "steps_to_80", "episodes_to_80")),
    }


def summarise_life(tasks: list[dict], agents: Sequence[str]) -> dict:
    """Paired differences of the first agent and each other over the last third of the tasks, and their own means.

    Parameters
    ----------
    tasks : list of dict
        The ``tasks`` of a report, at least one.
    agents : sequence of str
        Their names; the first is compared with the others.
    """
    last = third(tasks, "last")
    subject, *others = agents
    return {
        **{f"{subject}_vs_{other}": _compared(last, subject, other) for other in others},
        "agents": {
            name: {which: _means(third(tasks, which), name) for which in ("first", "last")} for name in agents
        },
    }


def _compared(tasks: list[dict], subject: str, other: str) -> dict:
    return {
        "jumpstart": _difference(tasks, subject, other, "first_return"),
        "mean_return_difference": _difference(tasks, subject, other, "mean_return"),
        "final_return_difference": _difference(tasks, subject, other, "final_return"),
        "never_reached": {who: sum(not t["agents"][who]["reached"] for t in tasks) for who in (subject, other)},
    }


def _difference(tasks: list[dict], subject: str, other: str, measure: str) -> dict:
    """The paired difference of two agents, and their means."""
    values = {who: [float(task["agents"][who][measure]) for task in tasks] for who in (subject, other)}
    raw = {who: sum(own) / len(own) for who, own in values.items()}
    return plain(difference_estimate(values[subject], values[other])) | {"raw": raw}


def _means(tasks: list[dict], name: str) -> dict:
    return {m: plain(mean_estimate([task["agents"][name][m] for task in tasks])) for m in MEASURES}
