"""The action prior of a lesson: every step of every demonstration counts, weighted by competence.

Thesis: §3.2.2.1, §3.4.8.
"""

from collections.abc import Callable, Iterable

from lifelore.action.demonstrations.competence import competence_by_steps
from lifelore.action.demonstrations.demonstrations import Demonstration, count_demonstrations
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.factory_lesson.lesson_task import FEATURES, LessonTask
from lifelore.domains.factory.factory import ACTION_NAMES

ALPHA0 = 0.1
"""Pseudo-count of every action, as in claim C3.12."""
KEY = f"factory {FEATURES}; {', '.join(ACTION_NAMES)}"
"""What priors must share to be merged."""
TaskOf = Callable[[int], LessonTask]


def competence_of(shown: Demonstration, task: LessonTask) -> float:
    """w(π) of a demonstration in [0, 1]: its share of best steps, corrected for chance."""
    return competence_by_steps([shown], lambda _: task.best)[shown.agent]


def prior_of(shown: Iterable[Demonstration], task_of: TaskOf) -> ActionPrior:
    """The prior from demonstrations, each weighted by its own competence."""
    prior = ActionPrior(len(ACTION_NAMES), ALPHA0, KEY)
    for one in shown:
        task = task_of(int(one.task))
        weight = {one.agent: competence_of(one, task)}
        count_demonstrations(prior, [one], lambda own, task=task: task.contexts[own.states], weight)
    return prior


def self_trained_prior(tasks: Iterable[LessonTask]) -> ActionPrior:
    """The prior from the exact policies of tasks, every state counted (Eq. 3.7)."""
    prior = ActionPrior(len(ACTION_NAMES), ALPHA0, KEY)
    for task in tasks:
        prior.update(task.contexts, task.best)
    return prior


def advice_in(prior: ActionPrior, task: LessonTask, state: int) -> tuple[dict[str, float], bool]:
    """Probability of each action in a state by its name, and whether the prior has counts there."""
    context = task.contexts[[state]]
    probs = prior.probs(context)[0]
    advice = {name: float(p) for name, p in zip(ACTION_NAMES, probs, strict=True)}
    return advice, not bool(prior.unseen(context)[0])
