"""Measures of a task in an external world, and the summary of a life: each agent over thirds of its tasks."""

from collections.abc import Sequence

from lifelore.agent.live.summary import compared, failures, means_by_third, third
from lifelore.core.metrics import difference_estimate

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
    last, (subject, *others) = third(tasks, "last"), agents
    differences = {
        f"{subject}_vs_{other}": {
            "jumpstart": compared(last, subject, other, "first_return", difference_estimate),
            "mean_return_difference": compared(last, subject, other, "mean_return", difference_estimate),
            "final_return_difference": compared(last, subject, other, "final_return", difference_estimate),
            "never_reached": {who: failures(last, who) for who in (subject, other)},
        }
        for other in others
    }
    return differences | {"agents": means_by_third(tasks, MEASURES)}
