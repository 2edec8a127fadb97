"""Advice by class of agent, such as staff and visitors: models of each class, and the class inferred from steps.

    P(c | H) ∝ P(c) Σ_{M of c} P(M | c) Π P(a | s, M)  over the window H

Where a uniform or a name tag shows the class, P(c) says so (`ClassAdvisor.showing`). The thesis names "hospital
staff vs visitors" and their uniforms, and measures neither way (§3.7). Its own advisor has one prior over all
goals, and advice from a prior over several goals leads to none of them; `classes_with_goals` leads to one goal at
a time, and the class says which goals are likely.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.advice.advice import WatchedAgent
from lifelore.action.advice.advisor import BETTER, AdviceSettings, Advisor
from lifelore.action.advice.behaviour_models import Behaviour
from lifelore.action.advice.goal_model import GoalModel, extend_goal_models
from lifelore.core.errors import InputError, NotFoundError

Experts = Mapping[str, Sequence[GoalModel]]
"""The goal models of each class."""
SURE = 0.99
"""P(class) of agents that show their class: a name tag may be borrowed. Nearer 1 takes longer to see that."""


@dataclass(frozen=True, eq=False)
class ClassAdvisor:
    """An advisor, its classes, and the class of each of its goal models.

    names : tuple of str
    advisor : Advisor
    class_of_goal : (n_goals,) int64, numbers of `names`

    Examples
    --------
    >>> from lifelore.action import GoalModel, Trajectory
    >>> walks = [Trajectory(np.arange(4), np.zeros(3, int)), Trajectory(np.arange(4)[::-1], np.ones(3, int))]
    >>> models = [GoalModel.from_trajectories([walk] * 9, 4, 2, goals=[walk.states[-1]]) for walk in walks]
    >>> advisor = ClassAdvisor(("staff", "visitor"), Advisor(models), np.array([0, 1]))
    >>> advisor.names
    ('staff', 'visitor')
    """

    names: tuple[str, ...]
    advisor: Advisor
    class_of_goal: NDArray[np.int64]

    def probs(self, agent: WatchedAgent) -> dict[str, float]:
        """P(class | H) as the last advice knew it; sums to 1.

        It leaves open whether the agent knows its way: that probability is `Advice.p_normal`.
        """
        of_goals = agent.posterior[self.advisor.guide.is_expert]
        weights = np.bincount(self.class_of_goal, of_goals, len(self.names))
        total = weights.sum()
        weights = weights / total if total > 0 else np.full(len(weights), 1 / len(weights))
        return dict(zip(self.names, weights.tolist(), strict=True))

    def showing(self, name: str) -> Advisor:
        """The advisor of agents that show a class, which is `SURE`; it shares the tables of `advisor`.

        Evidence about an agent counts on when it shows its class later.

        Raises
        ------
        NotFoundError
            There is no such class.
        """
        if name not in self.names:
            raise NotFoundError(f"class must be one of {', '.join(self.names)}, got '{name}'")
        if len(self.names) == 1:
            return self.advisor
        goals = self.advisor.guide.goal_share
        before = np.bincount(self.class_of_goal, goals)
        others = np.array([one != name for one in self.names])
        after = np.where(others, (1 - SURE) * before / before[others].sum(), SURE)
        return self.advisor.with_goal_weights(goals * (after / before)[self.class_of_goal])


def classes_with_goals(
    experts: Experts,
    moves: ArrayLike,
    settings: AdviceSettings | None = None,
    shares: Mapping[str, float] | None = None,
    others: Sequence[Behaviour | Sequence[Behaviour]] | None = None,
) -> ClassAdvisor:
    """Goals kept apart, each as likely as its class; advice leads to one goal at a time.

    Parameters
    ----------
    experts : mapping of str to sequence of GoalModel
        At least one for each class; each model has its goals.
    moves : (n_states, n_actions) int
        The map, see `extend_goal_models`.
    settings : AdviceSettings, optional
        Default `BETTER`. With evidence from advised steps, advice of a wrong class would confirm it.
    shares : mapping of str to float, optional
        P(c), positive, in any scale; default equal.
    others : sequence, optional
        As of `Advisor`; a sequence of models has one for each goal, class by class.

    Raises
    ------
    InputError
        A class has no experts, or `shares` names other classes or is not positive.

    Notes
    -----
    A goal of two classes stands twice, each time with the ways of its class.
    """
    weights = _checked(experts, shares)
    counts = np.array([len(models) for models in experts.values()])
    every = extend_goal_models([model for models in experts.values() for model in models], moves)
    class_of_goal = np.repeat(np.arange(len(counts)), counts)
    advisor = Advisor(every, others, settings or BETTER, goal_weights=(weights / counts)[class_of_goal])
    return ClassAdvisor(tuple(experts), advisor, class_of_goal)


def _checked(experts: Experts, shares: Mapping[str, float] | None) -> NDArray[np.float64]:
    """P(c) of the classes in their order."""
    empty = [name for name, models in experts.items() if not models]
    if not experts or empty:
        raise InputError(f"experts must have a goal model for each class, got none for {empty or 'any class'}")
    if shares is None:
        return np.ones(len(experts))
    if set(shares) != set(experts) or not all(share > 0 for share in shares.values()):
        raise InputError(f"shares must be positive numbers of {', '.join(experts)}, got {dict(shares)}")
    return np.array([shares[name] for name in experts], np.float64)
