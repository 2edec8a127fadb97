"""Objects of `interaction` through `pickle`: a copy does what the first does."""

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lifelore.interaction.adaptation.beat import EPSILONS, Beat
from lifelore.interaction.baselines import BASELINES
from lifelore.interaction.beliefs.feature_prior import FeaturePrior
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal

from .reuse.families import FAMILIES, PRIOR, Family

Use = Callable[[Any], list[Any]]
"""Uses an object; what it answers on the way."""


def lives(family: Family) -> Use:
    """Episodes of an agent, in the middle of which its library learns."""

    def use(agent: BayesianPolicyReuse) -> list[Any]:
        seen, random = [], np.random.default_rng(0)
        for episode in range(6):
            policy = agent.select() if episode % 2 else agent.select([0])
            agent.update(policy, family.draw(random))
            seen += [policy, agent.probabilities(), agent.log_belief, agent.surprise]
        return [*seen, agent.select_top(2), agent.explain().to_dict(), agent.generator.random()]

    return use


def agent(name: str, **settings: Any) -> BayesianPolicyReuse:
    """An agent in the middle of its task."""
    made = BayesianPolicyReuse(FAMILIES[name].library(), seed=4, horizon=30, **settings)
    lives(FAMILIES[name])(made)
    return made


def users(name: str, **settings: Any) -> UserBeliefs:
    made = UserBeliefs(FAMILIES[name].library(), 20, seed=3, **settings)
    serves(FAMILIES[name])(made)
    return made


def serves(family: Family) -> Use:
    """Choices for many users and what they teach."""

    def use(users: UserBeliefs) -> list[Any]:
        seen, random = [], np.random.default_rng(1)
        for rule in ("sampling", "greedy", "information-directed"):
            chosen = users.select(np.arange(20), rule)
            evidence = users.update(np.arange(20), chosen, [family.draw(random) for _ in range(20)])
            seen += [chosen, evidence, users.log_belief.copy(), users.probabilities([1, 2], rule)]
        return seen

    return use


def models(family: Family) -> Use:
    """Likelihoods and tables of a library, before and after it learns; and its file."""

    def use(library: PolicyLibrary) -> list[Any]:
        signal, seen = family.draw(np.random.default_rng(2)), []
        for part in (library, library.take([2, 0], [1, 0])):
            seen += [part.signal.log_likelihood(1, signal), part.performance.mean, part.performance.deviation]
            if part.has_table:
                seen.append(part.table(4).probs)
        if np.isfinite(getattr(getattr(library.performance, "moments", None), "count", 0)).all() and family.learns:
            library.observe(1, 1, 3.0)
        return [*seen, library.performance.mean, library.performance.to_arrays()]

    return use


def plays(player: Any) -> list[Any]:
    """Payoffs for a baseline with several tasks."""
    seen: list[Any] = []
    for episode in range(25):
        chosen = player.select()
        player.update(chosen, np.cos(chosen + episode))
        seen.append(chosen)
    return [*seen, player._generator.random()]


def adapts(learner: Beat) -> list[Any]:
    seen: list[Any] = []
    for step in range(12):
        policy = learner.select()
        learner.update(policy, step % 3)
        seen += [policy, learner.log_belief.copy()]
    learner.end_episode()
    return seen


MORE: dict[str, dict[str, Any]] = {
    "exp3": {"gamma": 0.2},
    "gp-ucb": {"kernel": np.eye(4), "noise": 0.5},
    "lin-ucb": {"features": np.eye(4)},
    "bpr-plus": {"library": PolicyLibrary.from_means(np.eye(4), 0.5)},
}
HAZARD = TypeDynamics.hazard(0.1, PRIOR)
MAKERS: dict[str, tuple[Callable[[], Any], Use]] = {
    **{f"library, {name}": (family.library, models(family)) for name, family in FAMILIES.items()},
    **{f"agent, {name}": (lambda name=name: agent(name), lives(family)) for name, family in FAMILIES.items()},
    **{f"users, {name}": (lambda name=name: users(name), serves(FAMILIES[name]))
       for name in ("gaussian", "categorical", "exact categories")},
    "agent, plug-in": (lambda: agent("gaussian", models="plug-in"), lives(FAMILIES["gaussian"])),
    "agent, hazard": (lambda: agent("gaussian", dynamics=HAZARD), lives(FAMILIES["gaussian"])),
    "agent, novelty": (lambda: agent("gaussian", novelty=0.05), lives(FAMILIES["gaussian"])),
    "users, f8": (lambda: users("gaussian", dtype="f8", dynamics=HAZARD), serves(FAMILIES["gaussian"])),
    **{f"baseline, {name}": (lambda kind=kind, name=name: kind(4, n_tasks=3, seed=2, **MORE.get(name, {})), plays)
       for name, kind in BASELINES.items()},
    **{f"adaptation, {epsilon}": (lambda epsilon=epsilon: Beat(
        FAMILIES["exact categories"].library(), epsilon=epsilon), adapts) for epsilon in (0.2, *EPSILONS)},
    "feature prior": (
        lambda: FeaturePrior.fit(np.random.default_rng(0).normal(size=(4, 6)), np.arange(4) % 3, PRIOR),
        lambda own: [own.prior(np.ones(6))],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MAKERS)
def test_a_copy_does_what_the_first_does_and_leaves_it_as_it_was(name):
    make, use = MAKERS[name]
    first, expected = make(), use(make())
    copied = pickle.loads(pickle.dumps(first))
    assert type(copied) is type(first)
    np.testing.assert_equal(use(copied), expected)
    np.testing.assert_equal(use(first), expected)


def test_a_copied_agent_learns_with_the_library_that_was_copied_with_it():
    """With plug-in models its likelihood is of the arrays that `observe` changes in place."""
    first = BayesianPolicyReuse(FAMILIES["gaussian"].library(), models="plug-in")
    second = pickle.loads(pickle.dumps(first))
    for one in (first, second):
        one.library.observe(0, 1, 40.0)
        one.update(1, 3.0)
    assert np.array_equal(first.log_belief, second.log_belief)
    assert second.library.signal.outcomes is second.library.performance
    assert not np.array_equal(first.log_belief, BayesianPolicyReuse(FAMILIES["gaussian"].library()).log_belief)


def test_a_callers_lambda_cannot_be_pickled_and_says_so():
    signal = LikelihoodSignal(lambda policy, seen: np.zeros(2), n_types=2)
    with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
        pickle.dumps(signal)
