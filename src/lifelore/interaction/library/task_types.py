"""Types: sets of tasks on which every policy achieves nearly the same, and the landmark that stands for each.

Two tasks are ε-equivalent when no policy's utility differs by more than ε (Def. 4.3.3). That is no equivalence: it
is not transitive, so it does not part tasks by itself. Here tasks are covered greedily, each task is given to one
type (`labels`), and `membership` says to which others it could belong as well.

Playing the landmark's best policy on another member of its type costs up to 2 ε, not ε as printed: the utility of
the policy played may be ε lower than on the landmark, and that of the member's own best ε higher. Thesis: §4.3.3.
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
        The task that stands for each type.
    membership : (n_types, n_tasks) bool
        Whether a task would be in the type with those that are: types may overlap. Holds wherever `labels` does.
    """

    epsilon: float
    labels: NDArray[np.int64]
    landmarks: NDArray[np.int64]
    membership: NDArray[np.bool_]

    @property
    def n_types(self) -> int:
        return len(self.landmarks)

    def type_prior(self, task_prior: ArrayLike | None = None) -> Array:
        """Each type's prior, (n_types,): that of its tasks together, tasks equally likely unless given.

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
        What each policy achieves on each task; finite.
    epsilon : float
        At least 0; 0 joins only tasks that are alike in every policy.
    form : {"pairwise", "ball"}
        ``pairwise``: any two tasks of a type are within ε, as Def. 4.3.3 says. ``ball``: every task is within ε of
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


def every_task(utilities: ArrayLike) -> TaskTypes:
    """The full task space as types: every task is its own landmark (§4.3.3, last paragraph)."""
    every = np.arange(len(_checked(utilities)))
    return TaskTypes(0.0, every, every, np.eye(len(every), dtype=bool))


def landmark_regret_bound(epsilon: float) -> float:
    """The most that the landmark's best policy can cost on a task of its type: 2 ε, and no less."""
    return 2 * epsilon


def landmark_regret(utilities: ArrayLike, types: TaskTypes) -> Array:
    """Regret of playing, on each task, the policy that is best on its type's landmark, (n_tasks,).

    Where several policies are equally good on the landmark, the one that costs most counts.

    Raises
    ------
    InputError
        Utilities are not finite, or of another number of tasks than the types.
    """
    utilities = _checked(utilities, types)
    of_landmark = utilities[types.landmarks[types.labels]]
    best = of_landmark == of_landmark.max(axis=1, keepdims=True)
    return utilities.max(axis=1) - np.where(best, utilities, np.inf).min(axis=1)


def member_regret(utilities: ArrayLike, types: TaskTypes) -> Array:
    """As `landmark_regret`, with whichever member of the type as its landmark costs the task most, (n_tasks,)."""
    utilities = _checked(utilities, types)
    regret = np.zeros(len(utilities))
    for type_ in range(types.n_types):
        members = np.flatnonzero(types.labels == type_)
        own = utilities[members]
        for stands_for_all in own:
            left = own[:, stands_for_all == stands_for_all.max()].min(axis=1)
            regret[members] = np.maximum(regret[members], own.max(axis=1) - left)
    return regret


def landmark_library(library: PolicyLibrary, types: TaskTypes) -> PolicyLibrary:
    """The library whose types are the landmarks of `library`'s, each with the prior of all that it stands for.

    Raises
    ------
    InputError
        `types` covers another number of tasks than the library has types.
    """
    if len(types.labels) != library.n_types:
        raise InputError(f"types must cover the library's {library.n_types} types, covers {len(types.labels)}")
    return library.take(types=types.landmarks.tolist(), prior=types.type_prior(library.prior))


def pooled_samples(samples: ArrayLike, types: TaskTypes, overlapping: bool = False) -> Array:
    """Outcomes of all tasks of a type together (Def. 4.3.4).

    Parameters
    ----------
    samples : (n_tasks, n_policies, n) float
        NaN where missing.
    overlapping : bool
        Whether a task counts in every type that it could belong to (`membership`), or in its own alone (`labels`).

    Returns
    -------
    (n_types, n_policies, m) float
        m is n times the tasks of the largest type; NaN fills up the others.

    Raises
    ------
    InputError
        Samples are of another number of tasks than the types.
    """
    samples = np.asarray(samples, np.float64)
    if samples.ndim != 3 or len(samples) != len(types.labels):
        raise InputError(f"samples must be ({len(types.labels)}, n_policies, n), got {samples.shape}")
    members = types.membership if overlapping else types.labels == np.arange(types.n_types)[:, None]
    pooled = np.full((types.n_types, samples.shape[1], int(members.sum(axis=1).max()) * samples.shape[2]), np.nan)
    for type_, of_type in enumerate(members):
        own = samples[of_type].transpose(1, 0, 2).reshape(samples.shape[1], -1)
        pooled[type_, :, : own.shape[1]] = own
    return pooled


def _checked(utilities: ArrayLike, types: TaskTypes | None = None) -> Array:
    utilities = np.asarray(utilities, np.float64)
    if utilities.ndim != 2 or not utilities.size or not np.isfinite(utilities).all():
        raise InputError(f"utilities must be (n_tasks, n_policies) finite numbers, got {utilities.shape}")
    if types is not None and len(utilities) != len(types.labels):
        raise InputError(f"utilities must be of the {len(types.labels)} tasks of the types, got {len(utilities)}")
    return utilities


def _balls(near: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Labels and landmarks of balls, the one that covers most of what is left first."""
    labels, landmarks = np.full(len(near), -1), []
    while (left := labels < 0).any():
        covers = np.where(left, near[:, left].sum(axis=1), 0)
        landmarks.append(int(covers.argmax()))
        labels[left & near[landmarks[-1]]] = len(landmarks) - 1
    return labels, np.array(landmarks)


def _cliques(utilities: Array, near: NDArray[np.bool_], epsilon: float) -> NDArray[np.int64]:
    """Labels of sets any two of whose tasks are near, grown from their seed outwards."""
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
    """The member whose farthest fellow is nearest."""
    farthest = cdist(utilities[members], utilities[members], "chebyshev").max(axis=1)
    return int(members[farthest.argmin()])
