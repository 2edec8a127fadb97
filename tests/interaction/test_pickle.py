"""Objects of `interaction` through `pickle`: a copy does what the first does."""

import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lifelore.interaction import BayesianPolicyReuse, LikelihoodSignal, PolicyLibrary

from .reuse.families import FAMILIES, Family

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


MAKERS: dict[str, tuple[Callable[[], Any], Use]] = {
    **{f"library, {name}": (family.library, models(family)) for name, family in FAMILIES.items()},
    **{f"agent, {name}": (lambda name=name: agent(name), lives(family)) for name, family in FAMILIES.items()},
    "agent, plug-in": (lambda: agent("gaussian", models="plug-in"), lives(FAMILIES["gaussian"])),
    "agent, novelty": (lambda: agent("gaussian", novelty=0.05), lives(FAMILIES["gaussian"])),
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
