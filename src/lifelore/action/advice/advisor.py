"""`Advisor`: watches agents whose goals are unknown and advises them when they seem lost.

The settings give two advisors. The thesis's advisor pools all experts into one prior and uses all of the last
steps as evidence. The better advisor (`BETTER`) keeps the experts' goals separate, leads to one goal at a time and
drops goals that the agent has left. It uses only the steps that the agent chose itself as evidence. It limits the
share of advised steps, and saves them up so that it can advise a whole path. Thesis: §3.7.1, Eq. 3.13-3.16.
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.advice.advice import (
    TARGET,
    AdviceRule,
    Guide,
    WatchedAgent,
    consider,
    new_watched_agent,
    observe,
)
from lifelore.action.advice.behaviour_models import Behaviour, Experts, Uniform
from lifelore.action.advice.goal_model import GoalModel
from lifelore.core.compiled.jit import kernel
from lifelore.core.errors import InputError

TRACE = 1e-12
"""Least probability of an action under any model; at 0, one step could exclude a model for ever."""


@dataclass(frozen=True)
class AdviceSettings:
    """Conditions under which an advisor gives advice.

    Parameters
    ----------
    kappa : float
        Cost of advice κ in nats; at least 0. A κ in bits is 0.69 times as many nats.
    window : int
        Number of last steps in the evidence H, ≥ 1; thesis §3.7.2.3: 300.
    slip : float
        Share in [0, 1) of every model's probability that is spread over all actions; 0 leaves only `TRACE`.
    share : float
        In (0, 1]: largest share of advised steps so far. 1: no limit (the thesis).
    burst : float
        With a limit: number of saved steps at which advice begins; it continues until they are spent; ≥ 1.
    own_steps_only : bool
        Whether steps that followed advice are excluded from H.

    Examples
    --------
    >>> AdviceSettings(kappa=0.2).window
    300
    """

    kappa: float = 0.5
    window: int = 300
    slip: float = 0.0
    share: float = 1.0
    burst: float = 120.0
    own_steps_only: bool = False

    def __post_init__(self) -> None:
        for name, holds, rule in (
            ("kappa", self.kappa >= 0, "at least 0"),
            ("window", self.window >= 1, "at least 1"),
            ("slip", 0 <= self.slip < 1, "a share in [0, 1)"),
            ("share", 0 < self.share <= 1, "a share in (0, 1]"),
            ("burst", self.burst >= 1, "at least 1"),
        ):
            if not holds:
                raise InputError(f"{name} must be {rule}, got {getattr(self, name)}")


BETTER = AdviceSettings(slip=0.05, share=0.4, own_steps_only=True)
"""Settings of the better advisor: at most 40 advised steps in 100."""


class Advice(NamedTuple):
    """Advice for one agent at one step.

    advise : whether advice is given now
    theta : (n_actions,) the advised probabilities, also if advice is not given; all zeros if there are none
    p_normal : P(M | H) of the experts' models together
    gain : KL[θ, P(A | s, H)] in nats, 0 without advice
    goal : number of the goal model that the advice leads to; -1: none
    """

    advise: bool
    theta: NDArray[np.float64]
    p_normal: float
    gain: float
    goal: int


class Assessment(NamedTuple):
    """`Advice` for every step of a recorded trajectory: (n,) advise, p_normal, gain; (n, M) posterior."""

    advise: NDArray[np.bool_]
    p_normal: NDArray[np.float64]
    gain: NDArray[np.float64]
    posterior: NDArray[np.float64]


class Advisor:
    """Advises lost agents by the actions of experts.

    Parameters
    ----------
    goal_models : sequence of GoalModel
        One model: the thesis's advisor. Several: advice leads to one of their goals at a time.
    others : sequence of Behaviour, or of sequences of them
        Models of agents that are no experts, `Uniform` by default. An entry that is itself a sequence has one
        model for each goal (for example a bug algorithm that walks to it).
    settings : AdviceSettings
    weights : (1 + len(others),) float, optional
        P(M) of the experts and of each of `others`, positive; default equal. The models of an entry share its
        probability by `goal_weights`.
    goal_weights : (len(goal_models),) float, optional
        How likely each goal is beforehand, for experts and all others, in any positive scale; default equal.

    Raises
    ------
    InputError
        There is no goal model, the goal models differ in states or actions, or a behaviour model does not give
        probabilities.

    Notes
    -----
    States are 0 … n_states - 1. In states that no expert passed there is no advice, and the experts' model is
    uniform, so that a step there is no evidence for or against `Uniform`.

    Examples
    --------
    >>> from lifelore.action import Trajectory
    >>> walk = Trajectory(np.arange(12), np.zeros(11, int))
    >>> advisor = Advisor.of_thesis([GoalModel.from_trajectories([walk] * 20, 12, 3, goals=[11])])
    >>> watched = advisor.watch()
    >>> for _ in range(6):
    ...     advisor.observe(watched, state=5, action=2)
    >>> advisor.consider(watched, state=5).advise
    True
    """

    def __init__(
        self,
        goal_models: Sequence[GoalModel],
        others: Sequence[Behaviour | Sequence[Behaviour]] | None = None,
        settings: AdviceSettings | None = None,
        weights: ArrayLike | None = None,
        goal_weights: ArrayLike | None = None,
    ) -> None:
        _check_goal_models(goal_models)
        self.settings = settings or AdviceSettings()
        self.n_actions, self.n_states = goal_models[0].prior.n_actions, len(goal_models[0].steps)
        experts = [Experts(model.prior) for model in goal_models]
        others = [Uniform(self.n_actions)] if others is None else others
        kinds = [_per_goal(entry, len(goal_models)) for entry in (experts, *others)]
        self._kind_sizes = [len(kind) for kind in kinds]
        self._kind_weights = _checked_weights(weights, len(kinds), "weights", "experts first")
        self.guide = self._guide(goal_models, kinds, _checked_goal_weights(goal_weights, len(goal_models)))
        chosen = self.settings
        self.rule = AdviceRule(
            float(chosen.kappa), float(chosen.share), float(chosen.burst), chosen.own_steps_only
        )

    @classmethod
    def of_thesis(cls, goal_models: Sequence[GoalModel], settings: AdviceSettings | None = None) -> "Advisor":
        """Condition 3.16 as printed: one θ over all goals, with its α⁰, is advised and is M₁; M₂ is uniform."""
        pooled = GoalModel.pooled(goal_models)
        return cls([replace(pooled, advised_alpha0=pooled.prior.uniform_alpha0)], None, settings)

    def with_goal_weights(self, goal_weights: ArrayLike) -> "Advisor":
        """An advisor that finds other goals likely beforehand and shares this one's tables.

        What one of them has observed of an agent is evidence for the other, too.
        """
        weights = _checked_goal_weights(goal_weights, len(self.guide.theta))
        log_prior, goal_share = self._beforehand(weights)
        other = copy(self)
        other.guide = self.guide._replace(log_prior=log_prior, goal_share=goal_share)
        return other

    def _beforehand(self, goal_weights: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """`log_prior` and `goal_share` of the guide."""
        of_goals, alone = goal_weights / goal_weights.sum(), np.ones(1)
        prior = np.concatenate(
            [
                weight * (of_goals if size > 1 else alone)
                for size, weight in zip(self._kind_sizes, self._kind_weights, strict=True)
            ]
        )
        return np.log(prior / prior.sum()), goal_weights / goal_weights.mean()

    def _guide(self, goal_models, kinds, goal_weights) -> Guide:
        models = [model for kind in kinds for model in kind]
        goal_of_model = [g if len(kind) > 1 else -1 for kind in kinds for g in range(len(kind))]
        log_prior, goal_share = self._beforehand(goal_weights)
        goal_of_state = np.full(self.n_states, -1, np.int32)
        for g, model in enumerate(goal_models):
            goal_of_state[list(model.goals)] = g
        return Guide(
            np.stack([model.theta for model in goal_models]),
            np.stack([model.steps for model in goal_models]),
            goal_of_state,
            np.log(np.stack([self._table(model) for model in models])),
            log_prior,
            np.arange(len(models)) < len(goal_models),
            np.array(goal_of_model, np.int32),
            goal_share,
        )

    def _table(self, model: Behaviour) -> NDArray[np.float64]:
        """P(a | s, M) for each last action, (n_states, n_actions + 1, n_actions), with `slip` and `TRACE`."""
        previous = np.arange(-1, self.n_actions)
        states = np.repeat(np.arange(self.n_states), len(previous))
        probs = np.asarray(model.probs(np.column_stack([states, np.tile(previous, self.n_states)])), np.float64)
        if probs.shape != (len(states), self.n_actions) or not (probs >= 0).all():
            raise InputError(
                f"a model must give non-negative probabilities of shape ({len(states)}, {self.n_actions}) for as "
                f"many contexts, got {probs.shape} from {type(model).__name__}"
            )
        if not np.allclose(probs.sum(axis=1), 1, atol=1e-6):
            raise InputError(
                f"a model's probabilities must sum to 1 in every context, {type(model).__name__}'s do not"
            )
        slip = self.settings.slip
        probs = np.maximum((1 - slip) * probs + slip / self.n_actions, TRACE)
        return probs.reshape(self.n_states, len(previous), self.n_actions)

    # ---- step by step ----------------------------------------------------------------------------

    def watch(self) -> WatchedAgent:
        """Begin to watch an agent, without any evidence yet."""
        return new_watched_agent(self.guide, self.settings.window)

    def consider(self, agent: WatchedAgent, state: int) -> Advice:
        """Advice for the agent in `state`; call it once for each step, before `observe`."""
        self._check(state)
        advise, gain = consider(self.guide, self.rule, agent, state)
        goal = int(agent.cursor[TARGET])
        theta = self.guide.theta[goal, state].copy() if goal >= 0 else np.zeros(self.n_actions)
        p_normal = float(agent.posterior[self.guide.is_expert].sum())
        return Advice(bool(advise), theta, p_normal, float(gain), goal)

    def observe(self, agent: WatchedAgent, state: int, action: int, advised: bool = False) -> None:
        """The agent tried `action` in `state`; -1: an action without a known outcome.

        `advised`: whether the action followed advice.
        """
        self._check(state)
        if not -1 <= action < self.n_actions:
            raise InputError(f"action must lie in [0, {self.n_actions}) or be -1, got {action}")
        observe(self.guide, self.rule, agent, state, action, advised)

    def _check(self, state: int) -> None:
        if not 0 <= state < self.n_states:
            raise InputError(f"state must lie in [0, {self.n_states}), got {state}")

    # ---- whole trajectories ---------------------------------------------------------------------------------

    def assess(self, states: ArrayLike, actions: ArrayLike, agent: WatchedAgent | None = None) -> Assessment:
        """The advice at every step of a trajectory that followed no advice.

        Parameters
        ----------
        states, actions : (n,) int
        agent : WatchedAgent, optional
            Continue with the evidence about this agent; changed in place.
        """
        states, actions = np.asarray(states, np.int64), np.asarray(actions, np.int64)
        if states.shape != actions.shape or states.ndim != 1:
            raise InputError(f"states and actions must be as many, got shapes {states.shape} and {actions.shape}")
        if states.size and not (states.min() >= 0 and states.max() < self.n_states):
            raise InputError(f"states must lie in [0, {self.n_states}), got {states.min()}..{states.max()}")
        if actions.size and not (actions.min() >= -1 and actions.max() < self.n_actions):
            raise InputError(
                f"actions must lie in [0, {self.n_actions}) or be -1, got {actions.min()}..{actions.max()}"
            )
        assessment = Assessment(
            np.zeros(len(states), np.bool_),
            np.zeros(len(states)),
            np.zeros(len(states)),
            np.zeros((len(states), len(self.guide.log_prior))),
        )
        _assess(self.guide, self.rule, agent or self.watch(), states, actions, assessment)
        return assessment


@kernel
def _assess(guide, rule, agent, states, actions, assessment):
    advise, p_normal, gain, posterior = assessment
    for t in range(states.size):
        advise[t], gain[t] = consider(guide, rule, agent, states[t])
        for m in range(posterior.shape[1]):
            posterior[t, m] = agent.posterior[m]
            if guide.is_expert[m]:
                p_normal[t] += agent.posterior[m]
        observe(guide, rule, agent, states[t], actions[t], False)


def _per_goal(entry, n_goals: int) -> list[Behaviour]:
    if not isinstance(entry, Sequence):
        return [entry]
    if len(entry) != n_goals:
        raise InputError(f"others must have one model for each of the {n_goals} goals, got {len(entry)}")
    return list(entry)


def _checked_weights(weights: ArrayLike | None, n: int, name: str, order: str) -> NDArray[np.float64]:
    weights = np.ones(n) if weights is None else np.asarray(weights, np.float64)
    if weights.shape != (n,) or not (weights > 0).all():
        raise InputError(f"{name} must be {n} positive numbers, {order}, got {weights}")
    return weights


def _checked_goal_weights(weights: ArrayLike | None, n_goals: int) -> NDArray[np.float64]:
    return _checked_weights(weights, n_goals, "goal_weights", "one for each goal model")


def _check_goal_models(goal_models: Sequence[GoalModel]) -> None:
    if not goal_models:
        raise InputError("goal_models must have at least one model, got none; make it from experts' trajectories")
    sizes = {(len(model.steps), model.prior.n_actions) for model in goal_models}
    if len(sizes) > 1:
        raise InputError(f"goal_models must agree in (states, actions), got {sorted(sizes)}")
