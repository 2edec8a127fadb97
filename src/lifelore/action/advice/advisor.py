"""`Advisor`: watches agents whose goals it does not know, and advises where they seem lost.

Two advisors of one make. The thesis's pools its experts into one prior and tells models apart by all of the last
steps. The better one keeps the experts' goals apart, leads to one goal at a time, drops goals seen, judges by the
steps that the agent chose itself (an advised step says what the advisor thinks, not what the agent does), and
saves up: it advises a whole way at once, and never more than a share of the steps.
Thesis: §3.7.1, Eq. 3.13-3.16.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.advice.advice import TARGET, Guide, Rule, Watch, consider, new_watch, observe
from lifelore.action.advice.behaviour_models import Behaviour, Experts, Uniform
from lifelore.action.advice.goal_model import Purpose
from lifelore.core.compiled.jit import kernel
from lifelore.core.errors import InputError

TRACE = 1e-12
"""Least probability of an action under any model; without it one step could prove a model wrong for good."""


@dataclass(frozen=True)
class AdviceSettings:
    """When to advise.

    Parameters
    ----------
    kappa : float
        κ, the cost of advice in nats; at least 0. KL is taken to the base e: in bits the same κ is 0.69 of it.
    window : int
        Steps that P(M | H) looks back over, ≥ 1; thesis §3.7.2.3: 300.
    slip : float
        Share in [0, 1) of every model's probability that is spread over all actions; 0 leaves only `TRACE`.
    share : float
        In (0, 1]: advised steps never exceed this share of the steps so far. 1: no limit (the thesis).
    burst : float
        With a limit, advice begins once so many advised steps are saved up, and goes on until they are spent; ≥ 1.
    own_steps_only : bool
        Whether steps that followed advice are left out of H.
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
    """What is said to one agent at one step.

    advise : whether advice is given now
    theta : (n_actions,) the advice, given or not; all zeros where there is none
    p_normal : P(M | H) of the experts' models together
    gain : KL[θ, P(A | s, H)] in nats, 0 where there is no advice
    purpose : which purpose the advice is for; -1 where there is none
    """

    advise: bool
    theta: NDArray[np.float64]
    p_normal: float
    gain: float
    purpose: int


class Assessment(NamedTuple):
    """`Advice` for every step of a recorded trajectory: (n,) advise, p_normal, gain; (n, M) posterior."""

    advise: NDArray[np.bool_]
    p_normal: NDArray[np.float64]
    gain: NDArray[np.float64]
    posterior: NDArray[np.float64]


class Advisor:
    """Tells lost agents the way, by what experts did.

    Parameters
    ----------
    purposes : sequence of Purpose
        One: the thesis's advisor. Several: advice leads to one of them at a time.
    others : sequence of Behaviour, or of sequences of them
        Models of who is no expert, `Uniform` by default. An entry that is itself a sequence has one model for each
        purpose (a bug bound for each goal, say).
    settings : AdviceSettings
    weights : (1 + len(others),) float, optional
        P(M) of the experts and of each of `others`, positive; default equal. Models of one entry share alike.

    Raises
    ------
    InputError
        There is no purpose, they disagree in states or actions, or a model's probabilities are none.

    Notes
    -----
    States are 0 … n_states - 1. In a state that no expert passed it is silent; there the experts' model is
    uniform, so that such a step speaks neither for it nor for `Uniform`.
    """

    def __init__(
        self,
        purposes: Sequence[Purpose],
        others: Sequence[Behaviour | Sequence[Behaviour]] | None = None,
        settings: AdviceSettings | None = None,
        weights: ArrayLike | None = None,
    ) -> None:
        _check_purposes(purposes)
        self.settings = settings or AdviceSettings()
        self.n_actions, self.n_states = purposes[0].prior.n_actions, len(purposes[0].steps)
        experts = [Experts(purpose.prior) for purpose in purposes]
        others = [Uniform(self.n_actions)] if others is None else others
        kinds = [_per_purpose(entry, len(purposes)) for entry in (experts, *others)]
        self.guide = self._guide(purposes, kinds, _checked_weights(weights, len(kinds)))
        chosen = self.settings
        self.rule = Rule(float(chosen.kappa), float(chosen.share), float(chosen.burst), chosen.own_steps_only)

    @classmethod
    def of_thesis(cls, purposes: Sequence[Purpose], settings: AdviceSettings | None = None) -> "Advisor":
        """M₁ from all experts pooled, M₂ uniform (§3.7.1.2)."""
        return cls([Purpose.pooled(purposes)], None, settings)

    def _guide(self, purposes, kinds, weights) -> Guide:
        models = [model for kind in kinds for model in kind]
        bound = [g if len(kind) > 1 else -1 for kind in kinds for g in range(len(kind))]
        prior = np.concatenate([np.full(len(kind), w / len(kind)) for kind, w in zip(kinds, weights, strict=True)])
        goal_of = np.full(self.n_states, -1, np.int32)
        for g, purpose in enumerate(purposes):
            goal_of[list(purpose.goals)] = g
        return Guide(
            np.stack([purpose.theta for purpose in purposes]),
            np.stack([purpose.steps for purpose in purposes]),
            goal_of,
            np.log(np.stack([self._table(model) for model in models])),
            np.log(prior / prior.sum()),
            np.arange(len(models)) < len(purposes),
            np.array(bound, np.int32),
        )

    def _table(self, model: Behaviour) -> NDArray[np.float64]:
        """P(a | s, M) after each last action, (n_states, n_actions + 1, n_actions), slip and trace added."""
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
        kept = np.maximum((1 - slip) * probs + slip / self.n_actions, TRACE)
        return kept.reshape(self.n_states, len(previous), self.n_actions)

    # ---- step by step ----------------------------------------------------------------------------

    def watch(self) -> Watch:
        """A new agent, of whom nothing is known."""
        return new_watch(self.guide, self.settings.window)

    def consider(self, watch: Watch, state: int) -> Advice:
        """What to tell an agent that is in `state` now; once for each step, before `observe`."""
        self._check(state)
        advise, gain = consider(self.guide, self.rule, watch, state)
        purpose = int(watch.cursor[TARGET])
        theta = self.guide.theta[purpose, state].copy() if purpose >= 0 else np.zeros(self.n_actions)
        p_normal = float(watch.posterior[self.guide.normal].sum())
        return Advice(bool(advise), theta, p_normal, float(gain), purpose)

    def observe(self, watch: Watch, state: int, action: int, advised: bool = False) -> None:
        """The agent tried `action` in `state`; -1: something that has no outcome here.

        `advised`: it had been told to.
        """
        self._check(state)
        if not -1 <= action < self.n_actions:
            raise InputError(f"action must lie in [0, {self.n_actions}) or be -1, got {action}")
        observe(self.guide, self.rule, watch, state, action, advised)

    def _check(self, state: int) -> None:
        if not 0 <= state < self.n_states:
            raise InputError(f"state must lie in [0, {self.n_states}), got {state}")

    # ---- at once ---------------------------------------------------------------------------------

    def assess(self, states: ArrayLike, actions: ArrayLike, watch: Watch | None = None) -> Assessment:
        """What would have been said at every step of a trajectory that followed no advice.

        Parameters
        ----------
        states, actions : (n,) int
        watch : Watch, optional
            Go on with what is known of this agent; it is changed in place.
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
        found = Assessment(
            np.zeros(len(states), np.bool_),
            np.zeros(len(states)),
            np.zeros(len(states)),
            np.zeros((len(states), len(self.guide.log_prior))),
        )
        _assess(self.guide, self.rule, watch or self.watch(), states, actions, found)
        return found


@kernel
def _assess(guide, rule, watch, states, actions, found):
    advise, p_normal, gain, posterior = found
    for t in range(states.size):
        advise[t], gain[t] = consider(guide, rule, watch, states[t])
        for m in range(posterior.shape[1]):
            posterior[t, m] = watch.posterior[m]
            if guide.normal[m]:
                p_normal[t] += watch.posterior[m]
        observe(guide, rule, watch, states[t], actions[t], False)


def exploration_rows(purpose: Purpose, kappa: float = 0.5) -> NDArray[np.float64]:
    """Advice for who learns: exploration rows (n_states, n_actions) for its ε branch (Alg. 2).

    An exploring step is uniform without advice, so the gain of advice in a state is KL[θ_s, uniform] whatever was
    seen before; where it is less than κ, or nothing was counted, the row stays uniform.
    """
    theta = purpose.theta
    n_actions = theta.shape[1]
    gain = (theta * (np.log(np.where(theta > 0, theta, 1.0)) + np.log(n_actions))).sum(axis=1)
    told = theta.any(axis=1) & (gain >= kappa)
    return np.where(told[:, None], theta, 1 / n_actions)


def _per_purpose(entry, n_purposes: int) -> list[Behaviour]:
    if not isinstance(entry, Sequence):
        return [entry]
    if len(entry) != n_purposes:
        raise InputError(f"a model for each purpose needs {n_purposes} of them, got {len(entry)}")
    return list(entry)


def _checked_weights(weights: ArrayLike | None, n_kinds: int) -> NDArray[np.float64]:
    weights = np.ones(n_kinds) if weights is None else np.asarray(weights, np.float64)
    if weights.shape != (n_kinds,) or not (weights > 0).all():
        raise InputError(f"weights must be {n_kinds} positive numbers, experts first, got {weights}")
    return weights


def _check_purposes(purposes: Sequence[Purpose]) -> None:
    if not purposes:
        raise InputError("purposes must be at least one, got none; experts are needed to learn from")
    sizes = {(len(purpose.steps), purpose.prior.n_actions) for purpose in purposes}
    if len(sizes) > 1:
        raise InputError(f"purposes must agree in (states, actions), got {sorted(sizes)}")
