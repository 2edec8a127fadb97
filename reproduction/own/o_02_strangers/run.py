"""O2: false alarms of the novelty detector, and how well it tells tasks of unknown types from known ones.

A library lacks eight of the 68 targets of the surveillance reserve. The detector is calibrated on tasks simulated
from the library alone; then it meets true tasks of the library's types, of the targets held out, and of cells near
the hills that are no targets. Policies are chosen by belief sampling.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.novelty.calibration import NoveltyCalibration, known_statistic, watch
from lifelore.interaction.reuse.novelty.known_tasks import normal_tasks
from lifelore.interaction.selection import BeliefSampling

Array = NDArray[np.float64]
AT, SAMPLES = 15, 10
"""Episode of the AUC, and training runs of a learnt pair."""
EXACT, HELD, CELLS, KNOWN = "exact", "held-out targets", "cells that are no targets", "known types"
LAWS = {"10 runs, Gaussian": "gaussian", "10 runs, Student's t": "student-t"}
AGENT = {"models": "plug-in", "dynamics": TypeDynamics.static()}
"""Estimates are taken for the truth, and types do not change."""


def cells(settings: Mapping) -> list[dict]:
    """A library of each kind of models each."""
    return [{"models": m, "library": n} for m, n in product(settings["models"], range(settings["libraries"]))]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """By kind of task: share with an alarm by each episode, the first alarms, and AUCs of two statistics."""
    world, generator = Surveillance(), stream(seed, "O2", cell["models"], cell["library"])
    order = generator.permutation(world.n_targets)
    held, types = np.sort(order[: settings["held_out"]]), np.sort(order[settings["held_out"] :])
    library = _library(world, types, cell["models"], generator)
    rule, horizon = BeliefSampling(), settings["horizon"]
    simulated = known_statistic(library, rule, horizon, settings["simulated"], generator, **AGENT)
    calibration = NoveltyCalibration.of(simulated, settings["false_alarm"], log_odds=True)
    near = world.cells_near_hills
    others = near[(near[:, None] != world.targets).any(axis=-1).all(axis=1)]
    means = {KNOWN: world.mean[types], HELD: world.mean[held], CELLS: world.mean_at(others)}
    found, seen = {}, {}
    for kind, mean in means.items():
        n = settings["known" if kind == KNOWN else "unseen"]
        chosen = mean[generator.integers(len(mean), size=n)]
        tasks = normal_tasks(chosen, np.full_like(chosen, world.deviation), generator)
        seen[kind] = watch(library, rule, tasks, n, horizon, generator, **AGENT)
        raised = calibration.standardised(seen[kind].statistic) > calibration.threshold
        first = raised.argmax(axis=1)[raised.any(axis=1)] + 1
        found[kind] = {
            "alarms": np.logical_or.accumulate(raised, axis=1).mean(axis=0).round(5).tolist(),
            "delay": float(np.median(first)) if len(first) else float(horizon),
            "auc": auc(seen[KNOWN].statistic[:, AT - 1], seen[kind].statistic[:, AT - 1]),
            "auc_of_entropy": auc(seen[KNOWN].entropy[:, AT - 1], seen[kind].entropy[:, AT - 1]),
        }
    return {**cell, "found": found}


def _library(world: Surveillance, types: NDArray, models: str, generator: np.random.Generator) -> PolicyLibrary:
    if models == EXACT:
        return PolicyLibrary.from_means(world.mean[types], world.deviation)
    samples = world.training_samples(generator, SAMPLES)[types]
    return PolicyLibrary.from_samples(samples, model=LAWS[models])


def auc(known: Array, unseen: Array) -> float:
    """Probability that a number of `unseen` exceeds a number of `known`, ties counted by half."""
    order = np.sort(known)
    below = np.searchsorted(order, unseen, side="left") + np.searchsorted(order, unseen, side="right")
    return float(below.mean() / (2 * len(known)))


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same for every kind of models and of unknown tasks."""
    for models, unseen in product(settings["models"], (HELD, CELLS)):
        yield {"models": models, "unknown tasks": unseen}, numbers(results, models, unseen)


def numbers(results: Sequence[Mapping], models: str, unseen: str) -> dict[str, Estimate]:
    """Means over the libraries of a kind of models."""
    own = [result["found"] for result in results if result["models"] == models]
    aucs, entropies = ([one[unseen][key] for one in own] for key in ("auc", "auc_of_entropy"))
    return {
        "false_alarms": mean_estimate([one[KNOWN]["alarms"][-1] for one in own]),
        "power": mean_estimate([one[unseen]["alarms"][-1] for one in own]),
        "delay": mean_estimate([one[unseen]["delay"] for one in own]),
        "auc": mean_estimate(aucs),
        "auc_of_entropy": mean_estimate(entropies),
        "auc_above_entropy": difference_estimate(aucs, entropies),
    }
