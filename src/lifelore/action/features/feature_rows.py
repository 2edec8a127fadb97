"""Exploration rows for Q-learning from a prior over features, also of the last reward (Alg. 4; thesis §3.3.2)."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.features.feature_function import FeatureFunction, context_codes
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import Rows
from lifelore.core.mdp import Tables

MOST_CLASSES = 256
"""Largest number of classes of rewards; the learner stores a class in a byte."""


def feature_rows(
    tables: Tables,
    phi: FeatureFunction,
    probs_of: Callable[[NDArray[np.int64]], ArrayLike],
    ties: str = "uniform",
    task: Any = None,
) -> Rows:
    """Rows of a task for `QLearning`, whose contexts are the features of state, task and last reward.

    Rewards after which φ is the same in every state are one class; the learner remembers the class alone.

    Parameters
    ----------
    tables : Tables
    phi : FeatureFunction
    probs_of : callable
        (n,) codes to (n, n_actions) probabilities, e.g. ``prior.probs``.
    ties : {"uniform", "prior"}
        As for `prior_rows`.
    task : any, optional
        Passed to `phi`.

    Raises
    ------
    InputError
        φ tells more than 256 classes of rewards apart.

    Examples
    --------
    >>> from lifelore import ActionPrior, QLearning
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2)
    >>> from lifelore.action import FeatureSet, StateFeatures
    >>> phi = StateFeatures(FeatureSet(("odd",), (2,)), np.array([[0], [1], [0]]))
    >>> QLearning(20).learn(tables, 0.9, rows=feature_rows(tables, phi, ActionPrior(2).probs))[1].returns.shape
    (20,)
    """
    rewards, reward_of = np.unique(np.append(0.0, tables.reward), return_inverse=True)
    states = np.arange(tables.n_states)
    codes = np.stack([context_codes(phi, states, task, reward) for reward in rewards], axis=1)
    contexts, class_of = np.unique(codes, axis=1, return_inverse=True)
    reward_class = class_of.ravel()[reward_of.ravel()]
    if contexts.shape[1] > MOST_CLASSES:
        raise InputError(
            f"phi must tell at most {MOST_CLASSES} classes of rewards apart, got {contexts.shape[1]}: "
            "use fewer edges in LastReward"
        )
    # An episode starts without a reward, in class 0: that of the reward 0.
    first = int(reward_class[0])
    order = np.r_[first, np.delete(np.arange(contexts.shape[1]), first)]
    number = np.argsort(order)[reward_class[1:]].reshape(tables.reward.shape)
    return prior_rows(tables, contexts[:, order], probs_of, ties, number)
