"""Advice by class of agent, such as staff and visitors: a prior for each class, and the class inferred from steps.

    P(c | H) ∝ P(c) Π P(a | s, M_c)  over the window H

Each class has its own experts, whose actions give the model M_c and the advice θ_c. An agent gets the advice of
the class that is most probable for it. Where a uniform or a name tag shows the class, P(c) says so. The thesis
names "hospital staff vs visitors" and their uniforms, and measures neither way (§3.7).
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.advice import WatchedAgent
from lifelore.action.advice.advisor import AdviceSettings, Advisor
from lifelore.action.advice.goal_model import GoalModel
from lifelore.core.errors import InputError

OWN_STEPS = AdviceSettings(slip=0.05, share=0.4, own_steps_only=True)
"""Settings for classes. Steps that followed advice are no evidence of a class, or a wrong class would confirm
itself; so some steps must be without advice."""


def class_advisor(
    experts: Mapping[str, Sequence[GoalModel]],
    settings: AdviceSettings | None = None,
    shares: Mapping[str, float] | None = None,
) -> Advisor:
    """An advisor with a pooled prior for each class of agents; goals within a class are not kept apart.

    Parameters
    ----------
    experts : mapping of str to sequence of GoalModel
        By class, at least one model each.
    settings : AdviceSettings, optional
        Default `OWN_STEPS`.
    shares : mapping of str to float, optional
        P(c), > 0, in any positive scale; default equal.

    Raises
    ------
    InputError
        A class has no experts, or `shares` names other classes.

    Notes
    -----
    The classes keep the order of `experts`. Goal number g of the advisor's advice is the class that it is for.
    """
    empty = [name for name, models in experts.items() if not models]
    if not experts or empty:
        raise InputError(
            f"experts must have at least one goal model for each class, got none for {empty or 'any'}"
        )
    if shares is not None and set(shares) != set(experts):
        raise InputError(f"shares must name the classes {', '.join(experts)}, got {', '.join(shares)}")
    pooled = [GoalModel.pooled(models) for models in experts.values()]
    weights = None if shares is None else [shares[name] for name in experts]
    return Advisor(pooled, None, settings or OWN_STEPS, goal_weights=weights)


def class_probs(advisor: Advisor, agent: WatchedAgent) -> NDArray[np.float64]:
    """P(class | H) as the last advice knew it, (n_classes,); sums to 1.

    It leaves open whether the agent knows its way: that probability is `Advice.p_normal`.
    """
    of_classes = agent.posterior[advisor.guide.is_expert]
    total = of_classes.sum()
    return of_classes / total if total > 0 else np.full(len(of_classes), 1 / len(of_classes))
