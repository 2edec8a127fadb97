"""Libraries, known tasks and tasks of unseen types for `bench novelty`: surveillance, telephone and golf.

A library knows some types, exactly or from ten runs a pair. Known tasks are of its types with their true
distributions. Unseen tasks are of types that were held out of the library, or lie between its types.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.golf.golf import CATEGORIES, Golf
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.domains.telephone.telephone import UTILITIES, Telephone
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.novelty.known_tasks import CategoryTasks, NormalTasks, Tasks
from lifelore.interaction.selection import BeliefSampling, ExpectedImprovement, SelectionRule
from reproduction.chapter4.c4_03_telephone_signals.run import exact_library, learnt_library
from reproduction.chapter4.golf.rounds import exact_library as exact_golf
from reproduction.chapter4.golf.rounds import learnt_library as learnt_golf

Array = NDArray[np.float64]
Draw = Callable[[np.random.Generator, int], Tasks]
"""``draw(generator, n)``: n tasks."""

SAMPLES, PSEUDO_COUNT = 10, 0.5
HELD_TARGETS, HELD_CALLERS = 8, 2
"""Types that are held out of the library: of 68 targets and of 10 callers."""
APART = 10.0
"""Least distance of an unseen hole from the training holes, yards."""
EXACT, GAUSSIAN, STUDENT, LEARNT = "exact", "10 runs, Gaussian", "10 runs, Student's t", "10 runs"
PATHS_SIGNAL, RETURNS_SIGNAL = "(s, a, s′)", "U"


@dataclass(frozen=True)
class Setting:
    """A library with its tasks.

    Parameters
    ----------
    library : PolicyLibrary
    known : callable
        Draws tasks of the library's types.
    unseen : dict of str to callable
        Draws tasks of other types, by their kind.
    signal_count : float, optional
        Signals behind each row of a learnt category signal, pseudo-counts included.
    """

    library: PolicyLibrary
    known: Draw
    unseen: Mapping[str, Draw]
    signal_count: float | None = None


@dataclass(frozen=True)
class Case:
    """A domain with a kind of models and a rule; `make(generator)` draws a setting."""

    name: str
    rule: SelectionRule
    make: Callable[[np.random.Generator], Setting]


def surveillance(generator: np.random.Generator, models: str) -> Setting:
    """The reserve without eight of its 68 targets as types; unseen: those eight, and cells that are no targets."""
    world = Surveillance()
    order = generator.permutation(world.n_targets)
    held, types = np.sort(order[:HELD_TARGETS]), np.sort(order[HELD_TARGETS:])
    if models == EXACT:
        library = PolicyLibrary.from_means(world.mean[types], world.deviation)
    else:
        samples = world.training_samples(generator, SAMPLES)[types]
        library = PolicyLibrary.from_samples(samples, model="gaussian" if models == GAUSSIAN else "student-t")
    near = world.cells_near_hills
    cells = near[(near[:, None] != world.targets).any(axis=-1).all(axis=1)]

    def drawn(means: Array) -> Draw:
        def draw(generator: np.random.Generator, n: int) -> Tasks:
            chosen = means[generator.integers(len(means), size=n)]
            return NormalTasks(chosen, np.full_like(chosen, world.deviation), generator)

        return draw

    unseen = {
        "held-out targets": drawn(world.mean[held]),
        "cells that are no targets": drawn(world.mean_at(cells)),
    }
    return Setting(library, drawn(world.mean[types]), unseen)


def telephone(generator: np.random.Generator, models: str, signal: str) -> Setting:
    """Ten language models, eight types of caller in the library; unseen: the two others."""
    phone = Telephone()
    order = generator.permutation(phone.n_models)
    held, types = np.sort(order[:HELD_CALLERS]), np.sort(order[HELD_CALLERS:])
    count = None
    if models == EXACT:
        library = exact_library(phone, signal)
    else:
        library = learnt_library(phone, signal, generator, SAMPLES, PSEUDO_COUNT)
        count = SAMPLES + PSEUDO_COUNT * library.signal.n_categories  # pyright: ignore[reportAttributeAccessIssue]
    library = library.take(types.tolist())
    if signal == RETURNS_SIGNAL:
        library = PolicyLibrary(library.performance, policies=library.policies, types=library.types)
    probs = phone.path_probs if signal == PATHS_SIGNAL else phone.utility_probs
    values = np.array(UTILITIES) if signal == RETURNS_SIGNAL else None

    def drawn(some: NDArray[np.int64]) -> Draw:
        return lambda generator, n: CategoryTasks(probs[generator.choice(some, n)], generator, values)

    return Setting(library, drawn(types), {"held-out callers": drawn(held)}, count)


def golf(generator: np.random.Generator, models: str) -> Setting:
    """Four training holes; unseen: holes of 120 to 220 yards, at least ten yards from all of them."""
    world, known = Golf(), Golf().category_probs
    library = exact_golf() if models == EXACT else learnt_golf(generator, SAMPLES, PSEUDO_COUNT)

    def unseen(generator: np.random.Generator, n: int) -> Tasks:
        holes = world.draw_holes(generator, 8 * n)
        far = np.abs(holes[:, None] - np.array(world.holes)).min(axis=1) >= APART
        return CategoryTasks(world.category_probs_at(holes[far][:n]), generator)

    return Setting(
        library,
        lambda generator, n: CategoryTasks(known[generator.integers(len(known), size=n)], generator),
        {"other holes": unseen},
        None if models == EXACT else SAMPLES + PSEUDO_COUNT * len(CATEGORIES),
    )


def cases() -> list[Case]:
    """Every case, the most important first."""
    sampling = BeliefSampling()
    found = [
        Case(f"surveillance, {models}", sampling, lambda generator, models=models: surveillance(generator, models))
        for models in (EXACT, GAUSSIAN, STUDENT)
    ]
    for signal in (PATHS_SIGNAL, RETURNS_SIGNAL):
        for models in (EXACT, LEARNT):
            make = lambda generator, models=models, signal=signal: telephone(generator, models, signal)  # noqa: E731
            found.append(Case(f"telephone {signal}, {models}", sampling, make))
    for models in (EXACT, LEARNT):
        found.append(Case(f"golf, {models}", sampling, lambda generator, models=models: golf(generator, models)))
    improvement = ExpectedImprovement(of="outcome")
    for models in (EXACT, GAUSSIAN):
        make = lambda generator, models=models: surveillance(generator, models)  # noqa: E731
        found.append(Case(f"surveillance, {models}, expected improvement", improvement, make))
    return found
