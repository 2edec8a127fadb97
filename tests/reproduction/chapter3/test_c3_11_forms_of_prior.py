"""Forms of one prior by hand."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from reproduction.chapter3.c3_11_forms_of_prior.run import probs_of


def test_forms_of_four_counts_by_hand():
    # Of eight policies, in one observation: 6 went north, 2 south, none elsewhere; α⁰ = 1/2.
    prior = ActionPrior(6, 0.5)
    prior.update([7] * 6, np.tile(np.eye(6, dtype=bool)[0], (6, 1)))
    prior.update([7] * 2, np.tile(np.eye(6, dtype=bool)[1], (2, 1)))
    random = np.random.default_rng(0)

    def form(name, softmax_of="counts"):
        return probs_of(prior, np.array([7]), name, {"softmax_of": softmax_of, "policies": 8}, random)[0]

    share = np.array([6.5, 2.5, 0.5, 0.5, 0.5, 0.5]) / 11
    np.testing.assert_allclose(form("proportion"), share)
    powers = {"counts": [6, 2, 0, 0, 0, 0], "counts a policy": [6 / 8, 2 / 8, 0, 0, 0, 0], "proportions": share}
    for softmax_of, power in powers.items():
        np.testing.assert_allclose(form("softmax", softmax_of), np.exp(power) / np.exp(power).sum())
    draws = np.array([form("dirichlet") for _ in range(4000)])
    # The deviation of a share of mean 6.5 / 11 is sqrt(p (1 - p) / 12) = 0.142, of the mean of 4000 0.0022.
    assert draws[:, 0].mean() == pytest.approx(share[0], abs=0.01)
    assert draws[:, 0].std() == pytest.approx(0.142, abs=0.01)
