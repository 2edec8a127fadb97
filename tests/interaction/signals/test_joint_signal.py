"""Several signals of one episode."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction import CategorySignal, JointSignal, LikelihoodSignal, ReturnSignal
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes

COIN = CategorySignal([[[0.5, 0.5]], [[0.9, 0.1]]])
RETURN = ReturnSignal(GaussianOutcomes([[0.0], [1.0]], 1.0))


def test_factors_add():
    joint = JointSignal([RETURN, COIN])
    expected = RETURN.log_likelihood(0, 0.3) + COIN.log_likelihood(0, 1)
    np.testing.assert_allclose(joint.log_likelihood(0, (0.3, 1)), expected)
    assert (joint.n_types, joint.n_policies) == (2, 1)
    assert joint.take(types=[1]).log_likelihood(0, (0.3, 1)).shape == (1,)


def test_table_is_the_product():
    table = JointSignal([COIN, COIN]).table(4)
    np.testing.assert_allclose(table.probs[1, 0], [0.81, 0.09, 0.09, 0.01])
    # Entropies of independent factors add.
    np.testing.assert_allclose(table.conditional_entropy, 2 * COIN.table().conditional_entropy)
    assert JointSignal([RETURN, COIN]).table(8).n_signals == 4


def test_bad_input_is_refused():
    joint = JointSignal([RETURN, COIN])
    for bad in ((0.3,), 0.3, (0.3, 1, 2)):
        with pytest.raises(InputError, match="must have 2 parts"):
            joint.log_likelihood(0, bad)
    with pytest.raises(InputError, match="at least one"):
        JointSignal([])
    with pytest.raises(InputError, match="agree in n_types"):
        JointSignal([COIN, CategorySignal([[[1.0]]])])
    with pytest.raises(InputError, match="no finite alphabet"):
        JointSignal([COIN, LikelihoodSignal(lambda policy, signal: [0, 0], 2)]).table()
