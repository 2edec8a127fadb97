"""An agent of policy reuse among the available policies: what it selects, ranks, explains and refuses."""

from itertools import pairwise

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction import BayesianPolicyReuse, PolicyLibrary
from lifelore.interaction.selection import RULES, rule_named

NAMES = ["a", "b", "c", "d"]


def learnt_library(seed: int = 0, n_types: int = 5, model: str = "gaussian") -> PolicyLibrary:
    random = np.random.default_rng(seed)
    samples = random.normal(random.normal(scale=5, size=(n_types, 4, 1)), 2, (n_types, 4, 8))
    samples = np.round(samples / 4) if model == "categorical" else samples
    return PolicyLibrary.from_samples(samples, policies=NAMES, model=model)


@pytest.mark.parametrize("name", sorted(RULES))
def test_the_best_k_are_ranked_by_score_and_begin_with_the_selected(name):
    library = learnt_library(4)
    ranking, selecting = (BayesianPolicyReuse(library, rule_named(name), seed=8) for _ in range(2))
    ranked = ranking.select_top(4)
    assert ranked[0].policy == selecting.select()
    assert sorted(one.policy for one in ranked) == [0, 1, 2, 3]
    assert [NAMES[one.policy] for one in ranked] == [one.name for one in ranked]
    scores = [one.score for one in ranked]
    assert all(first >= second - 1e-9 * abs(first) for first, second in pairwise(scores))
    assert len(ranking.select_top(2, ["a", "d"])) == 2
    explained = ranking.explain()
    assert {explained.selected, explained.runner_up} == {"a", "d"}


@pytest.mark.parametrize(("k", "available"), [(0, None), (5, None), (3, ["a", "b"])])
def test_a_k_that_there_is_not_is_refused(k, available):
    with pytest.raises(InputError, match="k must be 1 to"):
        BayesianPolicyReuse(learnt_library()).select_top(k, available)
