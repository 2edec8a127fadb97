"""Learning curves in new factories: without a prior, with the demonstrated prior, and with a self-trained one.

All learners of a factory meet the same random numbers. The self-trained prior comes from the exact policies of the
factories that were demonstrated. Thesis: §3.4.8, Figure 3.16.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.demonstrations.demonstrations import Demonstration
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.agent.factory_lesson.lesson_prior import prior_of, self_trained_prior
from lifelore.agent.factory_lesson.lesson_task import LessonTask, lesson_task
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import Rows
from lifelore.core.streams import stream

EPISODES = 100
"""Episodes of a learner."""
LEARNERS = 8
"""Number of new factories, with a learner of each kind in each; more make the curves smoother and take longer."""
MOST_STEPS = 2000
WITHOUT, SHOWN, SELF = "without a prior", "with your prior", "with a prior from exact policies"


def lesson_curves(
    lesson: str, components: int, seed: int, shown: list[Demonstration], episodes: int
) -> dict[str, Any]:
    """Curves over the first episodes of learners in the test factories of a lesson.

    Parameters
    ----------
    lesson : str
    components, seed : int
        Of the lesson.
    shown : list of Demonstration
        Without any, the learners without a prior alone learn.
    episodes : int
        1 to `EPISODES`; more episodes leave the first ones as they are.

    Returns
    -------
    dict
        ``episodes``, ``most`` (`EPISODES`), ``learners`` (`LEARNERS`), ``demonstrations`` and ``curves``: for each
        kind of learner ``mean`` and ``deviation`` of the reward of an episode, (episodes,).

    Raises
    ------
    InputError
        `episodes` breaks its rule.
    """
    if not 1 <= episodes <= EPISODES:
        raise InputError(f"episodes must lie in [1, {EPISODES}], got {episodes}")
    testing = [lesson_task(seed, lesson, components, "tested", number) for number in range(LEARNERS)]
    priors: dict[str, ActionPrior | None] = {WITHOUT: None}
    if shown:
        demonstrated = {number: lesson_task(seed, lesson, components, "shown", number) for number in _tasks(shown)}
        priors |= {
            SHOWN: prior_of(shown, demonstrated.__getitem__),
            SELF: self_trained_prior(demonstrated.values()),
        }
    curves = {}
    for name, prior in priors.items():
        rewards = np.array([_rewards(task, prior, seed, episodes) for task in testing])
        curves[name] = {
            "mean": np.round(rewards.mean(axis=0), 2).tolist(),
            "deviation": np.round(rewards.std(axis=0, ddof=1), 2).tolist(),
        }
    return {
        "episodes": episodes, "most": EPISODES, "learners": LEARNERS, "demonstrations": len(shown),
        "curves": curves,
    }  # fmt: skip


def _tasks(shown: list[Demonstration]) -> list[int]:
    return sorted({int(one.task) for one in shown})


def _rewards(task: LessonTask, prior: ActionPrior | None, seed: int, episodes: int) -> NDArray[np.float64]:
    """Reward of each episode of a learner, (episodes,)."""
    rows: Rows | None = None if prior is None else prior_rows(task.tables, task.contexts, prior.probs)
    learning = QLearning(episodes, MOST_STEPS, 0.5, 1.0, 0.95, 0.01)  # as the default of claim C3.12
    world, own = (stream(seed, *task.names, name) for name in ("world", "learner"))
    discount = task.task.domain.discount
    return learning.learn(task.tables, discount, world=world, own=own, rows=rows)[1].rewards
