"""Types of tasks: sets of tasks on which every policy achieves nearly the same, and a landmark task for each.

Two tasks are ε-equivalent when no policy's utility differs by more than ε (Def. 4.3.3). The relation is not
transitive, so it does not partition tasks: others could fit a type, too. Here types cover tasks greedily, and each
task has a single type.

Playing the landmark's best policy on another member of its type costs up to 2 ε, not ε as printed: the utility of
this policy may be ε lower than on the landmark, and the utility of the member's own best policy ε higher.
Thesis: §4.3.3.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.distance import cdist

from lifelore.core.errors import InputError
from lifelore.interaction.library.library_names import checked_prior
from lifelore.interaction.library.policy_library import PolicyLibrary

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TaskTypes:
    """Tasks covered by types.

    epsilon : float
    labels : (n_tasks,) int64
        Each task's type.
    landmarks : (n_types,) int64
        The landmark task of each type.
    """

    epsilon: float
    labels: NDArray[np.int64]
    landmarks: NDArray[np.int64]

    @property
    def n_types(self) -> int:
        return len(self.landmarks)

    def type_prior(self, task_prior: ArrayLike | None = None) -> Array:
        """Each type's prior, (n_types,): the sum over its tasks, which are equally likely by default.

        Raises
        ------
        InputError
            `task_prior` (n_tasks,) is no distribution.
        """
        weights = checked_prior(task_prior, len(self.labels))
        return np.bincount(self.labels, weights, minlength=self.n_types).astype(np.float64)


def epsilon_types(utilities: ArrayLike, epsilon: float) -> TaskTypes:
    """Tasks covered by few types, greedily, the task with most neighbours first.

    Any two tasks of a type are within ε. The landmark is the task in the middle of its type.

    Parameters
    ----------
    utilities : (n_tasks, n_policies) float
        Utility of each policy on each task; finite.
    epsilon : float
        At least 0; 0 joins only tasks with equal utilities of every policy.

    Raises
    ------
    InputError
        Utilities are not finite, or ε is negative.

    Examples
    --------
    >>> types = epsilon_types([[0.0], [1.0], [2.0], [9.0]], epsilon=2.0)
    >>> types.labels.tolist(), types.landmarks.tolist()
    ([0, 0, 0, 1], [1, 3])
    """
    utilities = np.asarray(utilities, np.float64)
    if utilities.ndim != 2 or not utilities.size or not np.isfinite(utilities).all():
        raise InputError(f"utilities must be (n_tasks, n_policies) finite numbers, got {utilities.shape}")
    if not (epsilon >= 0 and np.isfinite(epsilon)):
        raise InputError(f"epsilon must be at least 0 and finite, got {epsilon}")
    near = cdist(utilities, utilities, "chebyshev") <= epsilon
    labels = _cliques(utilities, near)
    landmarks = [_centre(utilities, np.flatnonzero(labels == type_)) for type_ in range(labels.max() + 1)]
    return TaskTypes(float(epsilon), labels, np.array(landmarks))


def landmark_library(library: PolicyLibrary, types: TaskTypes) -> PolicyLibrary:
    """The library of the landmarks of `library`'s types, each with the prior of all types that it represents.

    Raises
    ------
    InputError
        `types` covers another number of tasks than the library has types.

    Examples
    --------
    >>> from lifelore import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0], [8.5, 5.0], [4.0, 8.0]], 2.0)
    >>> landmark_library(library, epsilon_types(library.performance.mean, 1.0)).n_types
    2
    """
    if len(types.labels) != library.n_types:
        raise InputError(f"types must cover the library's {library.n_types} types, covers {len(types.labels)}")
    return library.take(types=types.landmarks.tolist(), prior=types.type_prior(library.prior))


def _cliques(utilities: Array, near: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Labels of sets of tasks that are near in pairs, grown outwards from a seed."""
    labels, found = np.full(len(near), -1), 0
    for seed in np.argsort(-near.sum(axis=1), kind="stable"):
        if labels[seed] >= 0:
            continue
        candidates = np.flatnonzero(near[seed] & (labels < 0))
        distances = np.abs(utilities[candidates] - utilities[seed]).max(axis=1)
        fits = near[seed].copy()
        for task in candidates[np.argsort(distances, kind="stable")]:
            if fits[task]:
                labels[task] = found
                fits &= near[task]
        found += 1
    return labels


def _centre(utilities: Array, members: NDArray[np.int64]) -> int:
    """The member with the smallest largest distance to the other members."""
    farthest = cdist(utilities[members], utilities[members], "chebyshev").max(axis=1)
    return int(members[farthest.argmin()])
