"""Policy reuse and its peers in the surveillance reserve, for C4.5 to C4.8.

Tasks come in groups of the thesis's number, ten. A group has tasks and noise of its own and, where models are
learnt, a library of its own; all methods meet the same groups. Regret is expected library regret; `realised`
is the regret of one draw of the chosen policy's pay against another draw of the best policy's.

Rules know exact models, or models learnt from `samples` deployments a pair, and observe the pay of each
deployment; `peers.GIVEN` states what peers know. No method knows where the poachers are.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import NOISES, Surveillance
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.regret import library_regret
from reproduction.chapter4.reuse import many_tasks
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT
from reproduction.chapter4.reuse.rules import RULES
from reproduction.chapter4.surveillance.peers import PEERS, TUNING, kernel_of, make_peer

Array = NDArray[np.float64]
WORLD = {"layout": "X", "metric": "chebyshev", "noise": "deviation 20"}
DEFAULT = {"models": LEARNT, **WORLD}
AFTER = (5, 10, 20, 50)
"""Episodes after which Table 4.3 gives regret."""
DRAWN = (10, 50)
"""Tasks in Figures 4.10 and 4.11: curves are of so many."""
READ = ("tasks", "episodes", "samples")
"""Settings that `run_method` reads: claims that run the same methods share their cells."""


class Tasks(NamedTuple):
    """Tasks of one group.

    mean : (n_tasks, 68) float64, expected pay of each policy
    noise : (n_tasks, n_episodes) float64, standard normal, of the pay in each episode
    other_noise : (n_tasks, n_episodes) float64, of the best policy's pay that realised regret compares with
    """

    mean: Array
    noise: Array
    other_noise: Array


def worlds(settings: Mapping) -> list[dict[str, str]]:
    """The default reserve, and all others of the settings."""
    every = product(*(settings[f"{key}s"] for key in WORLD))
    found = [dict(zip(WORLD, choices, strict=True)) for choices in every]
    return [WORLD, *(world for world in found if world != WORLD)]


def places(settings: Mapping) -> list[dict[str, str]]:
    """Where methods are compared: learnt models in the default reserve, and exact models in every reserve."""
    return [DEFAULT, *({"models": EXACT, **world} for world in worlds(settings))]


def reserve_cells(settings: Mapping, methods: Iterable[str]) -> list[dict]:
    """Every method in each of the `places`."""
    return [
        {
            "method": name,
            **place,
            "groups": settings["groups" if WORLD.items() <= place.items() else "grid_groups"],
        }
        for place in places(settings)
        for name in methods
    ]


def draw_tasks(world: Surveillance, n: int, n_episodes: int, seed: int, group: int) -> Tasks:
    """One group's tasks: the same places in the order of targets for every reserve, and the same noise."""
    cells = world.draw_cells(stream(seed, "tasks", group), n)
    noise = stream(seed, "noise", group).standard_normal((2, n, n_episodes))
    return Tasks(world.mean_at(cells), *noise)


def library_of(world: Surveillance, models: str, samples: int, seed: int, group: int) -> PolicyLibrary:
    """Exact models, or Gaussian ones with shrunk deviations from `samples` deployments a pair."""
    if models == EXACT:
        return PolicyLibrary.from_means(world.mean, world.deviation)
    training = world.training_samples(stream(seed, "training deployments", group), samples)
    return PolicyLibrary.from_samples(training)


def run_method(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """A rule or peer on all groups of one place.

    `cell`: ``method``, a place, ``groups``. Returns of every task ``sums``, ``ended`` and ``late``, and regret
    after the episodes of `AFTER` in four readings, each (n_tasks, 4); ``curves`` of the first `DRAWN` tasks, and
    of rules ``entropy`` of the first; ``tuned``, the settings of least regret where there were some to choose.
    """
    name = cell["method"]
    world = Surveillance(cell["layout"], cell["metric"], NOISES[cell["noise"]])
    groups = [
        draw_tasks(world, settings["tasks"], settings["episodes"], seed, group) for group in range(cell["groups"])
    ]
    tasks = Tasks(*(np.concatenate(arrays) for arrays in zip(*groups, strict=True)))
    batches = [tasks] if cell["models"] == EXACT else groups
    libraries = [library_of(world, cell["models"], settings["samples"], seed, g) for g in range(len(batches))]
    kernels = [kernel_of(name, library) for library in libraries]
    best: dict = {}
    for tuned in TUNING.get(name, [{}]):
        played = [
            _play(name, library, world, batch, stream(seed, "chooser", name, group), kernel, tuned)
            for group, (library, batch, kernel) in enumerate(zip(libraries, batches, kernels, strict=True))
        ]
        found = _regrets(world, tasks, np.concatenate([policies for policies, _ in played]))
        if name in RULES:
            entropy = np.concatenate([entropies for _, entropies in played if entropies is not None])[: DRAWN[0]]
            found["entropy"] = entropy.mean(axis=0).round(4).tolist()
        if not best or np.mean(found["sums"]) < np.mean(best["sums"]):
            best = {**found, "tuned": tuned}
    return {**cell, **best}


def _play(
    name: str, library: PolicyLibrary, world: Surveillance, tasks: Tasks, generator, kernel, tuned: Mapping
) -> tuple[NDArray[np.int64], Array | None]:
    """Policies that a rule or peer chooses, (n_tasks, n_episodes), and the entropy of a rule's belief."""
    n_tasks, n_episodes = tasks.noise.shape
    every = np.arange(n_tasks)

    def pays(episode: int, policies: NDArray[np.int64]) -> Array:
        return tasks.mean[every, policies] + world.deviation * tasks.noise[:, episode]

    if name in PEERS:
        peer = make_peer(name, library, n_tasks, generator, kernel, **tuned)
        return many_tasks.play_baseline(peer, pays, n_episodes), None
    played = many_tasks.play_rule(RULES[name], library, pays, n_tasks, n_episodes, generator)
    return played.policies, played.entropy


def _regrets(world: Surveillance, tasks: Tasks, policies: NDArray) -> dict:
    expected = library_regret(tasks.mean, policies)
    against_mean = expected - world.deviation * tasks.noise
    realised = against_mean + world.deviation * tasks.other_noise
    after = [min(k, expected.shape[1]) - 1 for k in AFTER]
    readings = {
        "size of realised": np.abs(realised),
        "realised": realised,
        "against mean": against_mean,
        "expected": expected,
    }
    return {
        "sums": expected.sum(axis=1).round(2).tolist(),
        "ended": many_tasks.converged_after(expected).tolist(),
        "late": many_tasks.late_regret(expected).round(3).tolist(),
        "after": {reading: regret[:, after].round(2).tolist() for reading, regret in readings.items()},
        "curves": [
            {"mean": part.mean(axis=0).round(2).tolist(), "deviation": part.std(axis=0).round(2).tolist()}
            for part in (expected[:n] for n in DRAWN)
        ],
    }


def by_method(results: Sequence[Mapping], place: Mapping[str, str]) -> dict[str, Mapping]:
    """The results of a place by method."""
    return {result["method"]: result for result in results if place.items() <= result.items()}


def by_group(result: Mapping, key: str) -> Array:
    """Numbers of every task, (n_groups, n_tasks)."""
    return np.array(result[key], float).reshape(result["groups"], -1)


def each_place(
    settings: Mapping, results: Sequence[Mapping]
) -> Iterator[tuple[dict[str, str], dict[str, Mapping]]]:
    """Each place with its results by method."""
    for place in places(settings):
        yield place, by_method(results, place)
