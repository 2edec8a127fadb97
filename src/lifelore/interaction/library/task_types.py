"""Types of tasks: sets of tasks on which every policy achieves nearly the same, and a landmark task for each.

Two tasks are ε-equivalent when no policy's utility differs by more than ε (Def. 4.3.3). The relation is not
transitive, so it does not partition tasks. Here types cover tasks greedily, each task has a single type
(`labels`), and `membership` holds the other types that fit it.

Playing the landmark's best policy on another member of its type costs up to 2 ε, not ε as printed: the utility of
this policy may be ε lower than on the landmark, and the utility of the member's own best policy ε higher.
Thesis: §4.3.3.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.distance import cdist

from lifelore.core.errors import InputError
from lifelore.interaction.library.library_names import checked_prior
from lifelore.interaction.library.policy_library import PolicyLibrary

Array = NDArray[np.float64]

Form = Literal["pairwise", "ball"]


@dataclass(frozen=True)
class TaskTypes:
    """Tasks covered by types.

    epsilon : float
    labels : (n_tasks,) int64
        Each task's type.
    landmarks : (n_types,) int64
        The landmark task of each type.
    membership : (n_types, n_tasks) bool
        Whether a task fits the members of the type: types may overlap. True wherever `labels` names the type.
    """

    epsilon: float
    labels: NDArray[np.int64]
    landmarks: NDArray[np.int64]
    membership: NDArray[np.bool_]

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


def epsilon_types(utilities: ArrayLike, epsilon: float, form: Form = "pairwise") -> TaskTypes:
    """Tasks covered by few types of size ε, greedily, the task with most neighbours first.

    Parameters
    ----------
    utilities : (n_tasks, n_policies) float
        Utility of each policy on each task; finite.
    epsilon : float
        At least 0; 0 joins only tasks with equal utilities of every policy.
    form : {"pairwise", "ball"}
        ``pairwise``: any two tasks of a type are within ε, as in Def. 4.3.3. ``ball``: every task is within ε of
        its landmark, which needs fewer types; the bound of 2 ε on the landmark's regret is the same.

    Raises
    ------
    InputError
        Utilities are not finite, ε is negative, or there is no such form.

    Examples
    --------
    >>> types = epsilon_types([[0.0], [1.0], [2.0], [9.0]], epsilon=1.0, form="ball")
    >>> types.labels.tolist(), types.landmarks.tolist()
    ([0, 0, 0, 1], [1, 3])
    """
    utilities = _checked(utilities)
    if not (epsilon >= 0 and np.isfinite(epsilon)):
        raise InputError(f"epsilon must be at least 0 and finite, got {epsilon}")
    if form not in ("pairwise", "ball"):
        raise InputError(f"form must be 'pairwise' or 'ball', got {form!r}")
    near = cdist(utilities, utilities, "chebyshev") <= epsilon
    if form == "ball":
        labels, landmarks = _balls(near)
        return TaskTypes(float(epsilon), labels, landmarks, near[landmarks])
    labels = _cliques(utilities, near, epsilon)
    members = [np.flatnonzero(labels == type_) for type_ in range(labels.max() + 1)]
    landmarks = np.array([_centre(utilities, of_type) for of_type in members])
    fits = np.stack([near[of_type].all(axis=0) for of_type in members])
    return TaskTypes(float(epsilon), labels, landmarks, fits)


def landmark_regret_bound(epsilon: float) -> float:
    """The largest regret of the landmark's best policy on a task of its type: 2 ε, a tight bound."""
    return 2 * epsilon


def landmark_regret(utilities: ArrayLike, types: TaskTypes) -> Array:
    """Regret on each task of the policy that is best on its type's landmark, (n_tasks,).

    Among policies that are equally good on the landmark, the policy with the largest regret counts.

    Raises
    ------
    InputError
        Utilities are not finite, or are for another number of tasks.
    """
    utilities = _checked(utilities, types)
    of_landmark = utilities[types.landmarks[types.labels]]
    best = of_landmark == of_landmark.max(axis=1, keepdims=True)
    return utilities.max(axis=1) - np.where(best, utilities, np.inf).min(axis=1)


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


def _checked(utilities: ArrayLike, types: TaskTypes | None = None) -> Array:
    utilities = np.asarray(utilities, np.float64)
    if utilities.ndim != 2 or not utilities.size or not np.isfinite(utilities).all():
        raise InputError(f"utilities must be (n_tasks, n_policies) finite numbers, got {utilities.shape}")
    if types is not None and len(utilities) != len(types.labels):
        raise InputError(f"utilities must be of the {len(types.labels)} tasks of the types, got {len(utilities)}")
    return utilities


def _balls(near: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Labels and landmarks of balls; the ball that covers most of the remaining tasks is first."""
    labels, landmarks = np.full(len(near), -1), []
    while (left := labels < 0).any():
        covers = np.where(left, near[:, left].sum(axis=1), 0)
        landmarks.append(int(covers.argmax()))
        labels[left & near[landmarks[-1]]] = len(landmarks) - 1
    return labels, np.array(landmarks)


def _cliques(utilities: Array, near: NDArray[np.bool_], epsilon: float) -> NDArray[np.int64]:
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
